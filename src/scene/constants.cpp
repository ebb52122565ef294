// SPDX-License-Identifier: MIT
// Constants: exact numbers with checked units, folded as far as they go, and the checks of places
// in a file where only a constant will do.
#include <cmath>

#include "elaboration.h"
#include "puppetri/base/elementary.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

bool comparison(lang::Op op) { return op >= lang::Op::kEqual && op <= lang::Op::kGreaterEqual; }

bool holds(lang::Op op, int order) {
    switch (op) {
        case lang::Op::kEqual:
            return order == 0;
        case lang::Op::kNotEqual:
            return order != 0;
        case lang::Op::kLess:
            return order < 0;
        case lang::Op::kLessEqual:
            return order <= 0;
        case lang::Op::kGreater:
            return order > 0;
        default:
            return order >= 0;
    }
}

}  // namespace

Term Elaboration::number_of(const lang::Expr& e, const Rational& written, const std::string& unit,
                            lang::Span where) {
    const std::optional<lang::Quantity> q = lang::to_quantity(written, unit);
    if (!q) {
        error("number-too-large", where, "this number does not fit",
              "use a smaller one, or another unit");
        return Nothing{};
    }
    Number n{.exact = q->number,
             .pi_power = q->pi_power,
             .is_exact = true,
             .value = q->value(),
             .dimension = q->dimension};
    if (n.dimension.frame == 0) {
        return n;
    }
    const std::optional<FrameRate> rate = frame_rate_of(where.file);
    if (!rate) {
        error("wrong-unit", where, "a frame rate cannot be counted in frames",
              "write `frames 24 per second`");
        return Nothing{};
    }
    // One frame is denominator / numerator seconds.
    const int frames = n.dimension.frame;
    n.dimension.time = static_cast<std::int8_t>(n.dimension.time + frames);
    n.dimension.frame = 0;
    const std::optional<Rational> frame_s = make_rational(rate->denominator, rate->numerator);
    const lang::Dimension dimension = n.dimension;
    n = multiply(n, power({.exact = *frame_s, .value = to_double(*frame_s)}, frames));
    n.dimension = dimension;
    (void)e;
    return n;
}

Term Elaboration::fold_numbers(const lang::Expr& e, lang::Op op, const Number& a, const Number& b) {
    using lang::Op;
    const bool sum = op == Op::kAdd || op == Op::kSubtract || comparison(op);
    if (sum && a.dimension != b.dimension) {
        error("wrong-unit", e.span,
              std::string(comparison(op) ? "cannot compare " : "cannot add or subtract ") +
                  lang::to_text(a.dimension) + " and " + lang::to_text(b.dimension),
              "give both the same kind of unit");
        return Nothing{};
    }
    if ((op == Op::kDivide || op == Op::kDiv || op == Op::kMod) && b.value == 0) {
        error("division-by-zero", e.span, "this divides by zero", "use another divisor");
        return Nothing{};
    }
    switch (op) {
        case Op::kAdd:
            return add(a, b);
        case Op::kSubtract:
            return subtract(a, b);
        case Op::kMultiply:
            return multiply(a, b);
        case Op::kDivide:
            return divide(a, b);
        case Op::kDiv:
        case Op::kMod: {
            if (!a.is_integer() || !b.is_integer()) {
                error("wrong-type", e.span, "div and mod are for whole numbers",
                      "use / for others");
                return Nothing{};
            }
            // Towards minus infinity; the remainder has the sign of the divisor.
            const std::int64_t x = a.exact.numerator, y = b.exact.numerator;
            if (y == -1) {
                return op == Op::kDiv ? Term{negate(a)} : Term{Number::whole(0)};
            }
            std::int64_t quotient = x / y;
            std::int64_t rest = x % y;
            if (rest != 0 && (rest < 0) != (y < 0)) {
                --quotient;
                rest += y;
            }
            return Number::whole(op == Op::kDiv ? quotient : rest);
        }
        case Op::kPower: {
            if (b.is_integer() && b.exact.numerator >= -64 && b.exact.numerator <= 64) {
                if (a.value == 0 && b.exact.numerator < 0) {
                    error("division-by-zero", e.span, "zero to a negative power",
                          "use another base");
                    return Nothing{};
                }
                if (a.plain() || (b.exact.numerator >= -9 && b.exact.numerator <= 9)) {
                    return power(a, static_cast<int>(b.exact.numerator));
                }
            }
            if (!a.plain() || !b.plain() || a.value <= 0) {
                error("wrong-type", e.span, "this power has no real value or no unit",
                      "use a positive number without unit, or a small whole exponent");
                return Nothing{};
            }
            return from_double(pow(a.value, b.value));
        }
        default:
            return holds(op, compare(a, b));
    }
}

std::optional<Number> Elaboration::constant_number(const lang::Expr& e, const Scope& scope,
                                                   lang::Dimension dimension,
                                                   std::string_view what) {
    const Term term = evaluate(e, scope);
    const Number* n = std::get_if<Number>(&term);
    if (n == nullptr) {
        if (std::holds_alternative<Expr>(term) || std::holds_alternative<DatumTerm>(term)) {
            error("not-constant", e.span, std::string(what) + " must be known before the run",
                  "use numbers and parameters only, no data");
        } else {
            wrong(e.span, lang::to_text(dimension), term);
        }
        return std::nullopt;
    }
    Number result = *n;
    if (dimension == lang::dimension::kTime) {
        result = in_time_unit(result, e.span);
    }
    if (result.dimension != dimension) {
        const std::string unit(lang::example_unit(dimension));
        wrong(
            e.span, lang::to_text(dimension), term,
            unit.empty() ? "write a number without unit" : "write it with a unit such as " + unit);
        return std::nullopt;
    }
    return result;
}

std::optional<std::int64_t> Elaboration::constant_integer(const lang::Expr& e, const Scope& scope,
                                                          std::string_view what) {
    const Term term = evaluate(e, scope);
    if (is_nothing(term)) {
        return std::nullopt;
    }
    const std::optional<Number> n = constant_number(e, scope, lang::dimension::kNone, what);
    if (!n) {
        return std::nullopt;
    }
    if (!n->is_integer()) {
        error("wrong-type", e.span, std::string(what) + " must be a whole number",
              "round it, or use another one");
        return std::nullopt;
    }
    return n->exact.numerator;
}

std::optional<SimTime> Elaboration::ticks(const Number& seconds, lang::Span where) {
    const bool exact = seconds.is_exact && seconds.pi_power == 0;
    const std::optional<Ticks> t = exact ? to_ticks(seconds.exact) : to_ticks(seconds.value);
    if (!t) {
        error("number-too-large", where, "this time does not fit",
              "use a shorter one: at most 400 years");
        return std::nullopt;
    }
    if (!t->exact && !reading_distribution_) {
        tell(Severity::kNote, "rounded", where,
             "this is no whole number of ticks of 1/705600000 s and was rounded to one", "");
    }
    return t->time;
}

std::optional<SimTime> Elaboration::constant_time(const lang::Expr& e, const Scope& scope,
                                                  std::string_view what) {
    const std::optional<Number> n = constant_number(e, scope, lang::dimension::kTime, what);
    return n ? ticks(*n, e.span) : std::nullopt;
}

std::optional<FrameRate> Elaboration::frame_rate_of(std::uint32_t file) {
    // The rate that the file declares, else the scene's, else 24.
    for (const std::uint32_t f : {file, std::uint32_t{0}}) {
        if (f >= library_.files.size()) {
            continue;
        }
        const lang::Expr& e = library_.files[f].header.frames_per_second;
        if (!e) {
            continue;
        }
        // The header is a number, perhaps a fraction such as 30000/1001; a rate in frames would ask
        // for itself.
        if (reading_rate_) {
            return std::nullopt;
        }
        reading_rate_ = true;
        const Term term = evaluate(e, {});
        reading_rate_ = false;
        const Number* n = std::get_if<Number>(&term);
        if (n == nullptr || !n->is_exact || n->pi_power != 0 || !n->plain() || n->value <= 0 ||
            n->value > 1e6) {
            wrong(e.span, "a positive number of frames per second", term);
            return FrameRate{};  // told; go on with a usual one
        }
        return FrameRate{n->exact.numerator, n->exact.denominator};
    }
    return FrameRate{};
}

}  // namespace puppetri::scene
