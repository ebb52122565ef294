// SPDX-License-Identifier: MIT
#include "formula_compiler.h"

#include <algorithm>

#include "functions.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

using lang::ExprKind;
using lang::Op;
using motion::FormulaSlot;

namespace {

constexpr lang::Dimension kPlain = lang::dimension::kNone;

lang::Dimension times(lang::Dimension a, lang::Dimension b, int sign) {
    const auto sum = [&](std::int8_t x, std::int8_t y) {
        return static_cast<std::int8_t>(std::clamp(x + sign * y, -99, 99));
    };
    return {sum(a.length, b.length), sum(a.time, b.time), sum(a.mass, b.mass),
            sum(a.angle, b.angle), sum(a.frame, b.frame)};
}

bool is_zero(const Expr& e) { return e.is_literal() && real_of_value(e.literal_value()) == 0; }
bool is_real_literal(const Expr& e) { return e.is_literal() && e.type().kind == ValueKind::kReal; }

}  // namespace

void FormulaCompiler::add_number(const std::string& name, lang::Dimension dimension) {
    numbers_[name] = {static_cast<std::uint32_t>(out_.inputs.size()), dimension};
    out_.inputs.push_back({name, -1});
}

void FormulaCompiler::add_thing(const std::string& name) {
    things_[name] = static_cast<std::uint32_t>(out_.inputs.size());
    for (int k = 0; k < 3; ++k) {
        out_.inputs.push_back({name, k});
    }
}

void FormulaCompiler::add_local(const lang::Name& name, const lang::Expr& e) {
    about(name.text);
    const bool taken = name.text == "t" || name.text == "pi" || numbers_.count(name.text) != 0 ||
                       things_.count(name.text) != 0 || locals_.count(name.text) != 0;
    if (taken) {
        e_.error("name-twice", name.span, name.text + " has a meaning already",
                 "choose another name");
        return;
    }
    const auto value = number(e);
    if (!value) {
        locals_[name.text] = {~std::uint32_t{0}, kPlain};  // what reads it is told nothing more
        return;
    }
    const auto index = compiled(value->value, e);
    if (index) {
        locals_[name.text] = {static_cast<std::uint32_t>(out_.locals.size()), value->dimension};
        out_.locals.push_back(*index);
    }
}

std::optional<std::pair<std::uint32_t, lang::Dimension>> FormulaCompiler::local(
    std::string_view name) const {
    const auto found = locals_.find(name);
    if (found == locals_.end() || found->second.first == ~std::uint32_t{0}) {
        return std::nullopt;
    }
    return found->second;
}

std::optional<ProgramIndex> FormulaCompiler::compiled(const Expr& value, const lang::Expr& e) {
    auto index = out_.code.add(value);
    if (!index) {
        e_.error("too-deep", e.span, index.error().message, "give a part of it a name of its own");
        return std::nullopt;
    }
    return *index;
}

std::optional<ProgramIndex> FormulaCompiler::program(const lang::Expr& e, lang::Dimension wanted) {
    return program_of(e, wanted, wanted);
}

std::optional<ProgramIndex> FormulaCompiler::program_of(const lang::Expr& e, lang::Dimension wanted,
                                                        lang::Dimension other) {
    const auto value = number(e);
    if (!value) {
        return std::nullopt;
    }
    if (!value->fits(counted(wanted)) && !value->fits(counted(other))) {
        const std::string unit(lang::example_unit(wanted));
        e_.error("wrong-unit", e.span,
                 element_ + " is " + lang::to_text(wanted) + ", and this is " +
                     lang::to_text(value->dimension),
                 unit.empty() ? "divide it by a unit: `x / 1 s`"
                              : "give it a unit: multiply by 1 " + unit +
                                    ", or divide what it is made of by units");
        return std::nullopt;
    }
    return compiled(value->value, e);
}

std::optional<std::array<ProgramIndex, 3>> FormulaCompiler::path(const lang::Expr& e,
                                                                 lang::Dimension wanted) {
    const auto at = point(e);
    if (!at) {
        return std::nullopt;
    }
    std::array<ProgramIndex, 3> out;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!(*at)[k].fits(wanted)) {
            e_.error("wrong-unit", e.span,
                     "three coordinates of " + element_ + " are wanted, each " +
                         lang::to_text(wanted) + ", and this has " +
                         lang::to_text((*at)[k].dimension),
                     "write it as (x, y, z) " + std::string(lang::example_unit(wanted)));
            return std::nullopt;
        }
        const auto index = compiled((*at)[k].value, e);
        if (!index) {
            return std::nullopt;
        }
        out[k] = *index;
    }
    return out;
}

std::optional<Expr> FormulaCompiler::apply(ExprOp op, std::vector<Expr> operands,
                                           const lang::Expr& e) {
    auto value = e_.apply(op, std::move(operands), e.span);
    if (value && value->type().kind == ValueKind::kInt) {
        value = e_.apply(ExprOp::kToReal, {std::move(*value)}, e.span);
    }
    return value;
}

void FormulaCompiler::danger(const Expr& value, bool negative, const lang::Expr& e,
                             std::string what) {
    if (is_real_literal(value) && real_of_value(value.literal_value()) > 0) {
        return;
    }
    // Outside the branches that lead here it does not matter.
    std::optional<Expr> guarded = value;
    for (auto g = guards_.rbegin(); guarded && g != guards_.rend(); ++g) {
        const Expr one = Expr::real(1);
        guarded = g->holds ? apply(ExprOp::kIf, {g->condition, *guarded, one}, e)
                           : apply(ExprOp::kIf, {g->condition, one, *guarded}, e);
    }
    if (!guarded) {
        return;
    }
    if (const auto program = compiled(*guarded, e)) {
        out_.dangers.push_back({*program, negative, element_, e_.at(e.span), std::move(what)});
    }
}

std::optional<Formula> FormulaCompiler::number(const lang::Expr& e) {
    constexpr int kDeepest = 200;
    if (depth_ > kDeepest) {
        e_.error("too-deep", e.span, "this formula is nested too deeply",
                 "give a part of it a name of its own");
        return std::nullopt;
    }
    ++depth_;
    std::optional<Formula> out;
    switch (e.kind) {
        case ExprKind::kNumber: {
            const Term term = e_.number_of(e, e.number, e.unit, e.span);
            if (const Number* n = std::get_if<Number>(&term)) {
                out = Formula{Expr::real(n->value), counted(n->dimension), n->value == 0};
            }
            break;
        }
        case ExprKind::kPath:
            out = name(e);
            break;
        case ExprKind::kUnary:
            out = unary(e);
            break;
        case ExprKind::kBinary:
            out = binary(e);
            break;
        case ExprKind::kConditional:
            out = conditional(e);
            break;
        case ExprKind::kCall:
            out = call(e);
            break;
        default:
            e_.error("wrong-type", e.span, "this is no number", "write a formula of t");
            break;
    }
    --depth_;
    return out;
}

std::optional<Formula> FormulaCompiler::name(const lang::Expr& e) {
    const auto& steps = e.path.steps;
    Formula known_elsewhere;
    if (names_ != nullptr) {
        const FormulaNames::Found found = names_->find(e, known_elsewhere);
        if (found != FormulaNames::Found::kNo) {
            known_elsewhere.dimension = counted(known_elsewhere.dimension);
            return found == FormulaNames::Found::kYes ? std::optional(std::move(known_elsewhere))
                                                      : std::nullopt;
        }
    }
    if (steps.size() <= 3 && steps[0].index.empty()) {
        const std::string& first = steps[0].text;
        // ball.position.y
        if (const auto thing = things_.find(first); thing != things_.end() && steps.size() > 1) {
            const std::string axis = steps.back().text;
            const int k = axis == "x" ? 0 : axis == "y" ? 1 : axis == "z" ? 2 : -1;
            const bool short_form = steps.size() == 2;
            if (k >= 0 && (short_form || steps[1].text == "position")) {
                return Formula{
                    slot(FormulaSlot::kInput, thing->second + static_cast<std::uint32_t>(k)),
                    lang::dimension::kLength};
            }
            e_.unknown(steps.back().span, "coordinate of " + first, axis,
                       {"position.x", "position.y", "position.z"});
            return std::nullopt;
        }
        if (steps.size() == 1) {
            if (first == "t" && without_time_) {
                e_.error("wrong-type", e.span, "the value of a key does not depend on the time",
                         "write a formula without `at`, or more keys");
                return std::nullopt;
            }
            if (first == "t") {
                return Formula{slot(FormulaSlot::kTime, 0), lang::dimension::kTime};
            }
            if (const auto n = numbers_.find(first); n != numbers_.end()) {
                return Formula{slot(FormulaSlot::kInput, n->second.first), n->second.second};
            }
            if (const auto l = locals_.find(first); l != locals_.end()) {
                if (l->second.first == ~std::uint32_t{0}) {
                    return std::nullopt;
                }
                return Formula{slot(FormulaSlot::kLocal, l->second.first), l->second.second};
            }
            if (first == "pi") {
                return Formula{Expr::real(3.14159265358979323846), kPlain};
            }
            std::vector<std::string> known{"t", "pi"};
            for (const auto& [text, n] : numbers_) {
                known.push_back(text);
            }
            for (const auto& [text, l] : locals_) {
                known.push_back(text);
            }
            if (names_ != nullptr) {
                const std::vector<std::string> more = names_->names();
                known.insert(known.end(), more.begin(), more.end());
            }
            if (things_.count(first) != 0) {
                e_.error("wrong-type", e.span, first + " is no number",
                         "write one of its coordinates: " + first + ".position.y");
                return std::nullopt;
            }
            e_.unknown(e.span, "name", first, known);
            return std::nullopt;
        }
    }
    e_.error("wrong-type", e.span, lang::to_text(e.path) + " is nothing that a formula knows",
             names_ != nullptr
                 ? "equations read t, pi, their own variables, parameters, data given to them, and "
                   "names defined before"
                 : "a formula reads t, pi, the parameters of its movement and names defined before "
                   "it");
    return std::nullopt;
}

std::optional<Formula> FormulaCompiler::unary(const lang::Expr& e) {
    auto a = number(e.args[0].value);
    if (!a || e.op == Op::kPlus) {
        return a;
    }
    if (e.op != Op::kNegate) {
        e_.error("wrong-type", e.span, "`not` is for conditions", "use it before `?`");
        return std::nullopt;
    }
    if (is_real_literal(a->value)) {
        a->value = Expr::real(-real_of_value(a->value.literal_value()));
        return a;
    }
    auto value = apply(ExprOp::kNegate, {std::move(a->value)}, e);
    return value ? std::optional(Formula{std::move(*value), a->dimension}) : std::nullopt;
}

bool FormulaCompiler::same_unit(const lang::Expr& e, const Formula& a, const Formula& b) {
    if (a.dimension == b.dimension || a.zero || b.zero) {
        return true;
    }
    e_.error("wrong-unit", e.span,
             "these are " + lang::to_text(a.dimension) + " and " + lang::to_text(b.dimension),
             "give both the same kind of unit");
    return false;
}

std::optional<Formula> FormulaCompiler::binary(const lang::Expr& e) {
    auto result = number(e.args[0].value);
    for (std::size_t i = 1; result && i < e.args.size(); ++i) {
        auto next = number(e.args[i].value);
        if (!next) {
            return std::nullopt;
        }
        result = fold(e, std::move(*result), e.args[i].value, std::move(*next));
    }
    return result;
}

std::optional<Formula> FormulaCompiler::fold(const lang::Expr& e, Formula a,
                                             const lang::Expr& right, Formula b) {
    const bool constant = is_real_literal(a.value) && is_real_literal(b.value);
    const double x = constant ? real_of_value(a.value.literal_value()) : 0;
    const double y = constant ? real_of_value(b.value.literal_value()) : 0;
    const auto made = [&](ExprOp op, double folded, lang::Dimension dimension) {
        std::optional<Formula> out;
        if (constant) {
            out = Formula{Expr::real(folded), dimension, folded == 0};
        } else if (auto value = apply(op, {std::move(a.value), std::move(b.value)}, e)) {
            out = Formula{std::move(*value), dimension};
        }
        return out;
    };
    switch (e.op) {
        case Op::kAdd:
        case Op::kSubtract: {
            if (!same_unit(e, a, b)) {
                return std::nullopt;
            }
            const lang::Dimension dimension = a.zero ? b.dimension : a.dimension;
            return e.op == Op::kAdd ? made(ExprOp::kAdd, x + y, dimension)
                                    : made(ExprOp::kSubtract, x - y, dimension);
        }
        case Op::kMultiply:
            return made(ExprOp::kMultiply, x * y, times(a.dimension, b.dimension, 1));
        case Op::kDivide:
            if (is_zero(b.value)) {
                e_.error("division-by-zero", right.span, "this divides by zero",
                         "use another divisor");
                return std::nullopt;
            }
            if (!is_real_literal(b.value)) {
                danger(b.value, false, right, "it divides by `" + lang::to_text(right) + "`");
            }
            return made(ExprOp::kDivide, x / (y == 0 ? 1 : y), times(a.dimension, b.dimension, -1));
        case Op::kPower:
            return power(e, std::move(a), right, std::move(b));
        default:
            e_.error("wrong-type", e.span, "a formula of a movement has no such operator",
                     "use + - * / ^, functions and conditions `a < b ? x : y`");
            return std::nullopt;
    }
}

std::optional<Formula> FormulaCompiler::power(const lang::Expr& e, Formula a,
                                              const lang::Expr& right, Formula b) {
    if (!b.fits(kPlain)) {
        e_.error("wrong-unit", right.span, "an exponent is a number without unit",
                 "divide it by a unit");
        return std::nullopt;
    }
    const bool literal = is_real_literal(b.value);
    const double n = literal ? real_of_value(b.value.literal_value()) : 0.5;
    const bool whole = literal && n == static_cast<int>(n) && n >= -9 && n <= 9;
    if (!whole && a.dimension != kPlain) {
        e_.error("wrong-unit", e.span, "only whole powers of quantities have a unit",
                 "divide the base by a unit, or write a whole exponent");
        return std::nullopt;
    }
    if (literal && n < 0) {
        danger(a.value, false, e,
               "it divides by a power of `" + lang::to_text(e.args[0].value) + "`");
    }
    if (!whole) {
        danger(a.value, true, e, "a negative number has no such power");
    }
    lang::Dimension dimension = kPlain;
    for (int k = 0; whole && k < (n < 0 ? -n : n); ++k) {
        dimension = times(dimension, a.dimension, n < 0 ? -1 : 1);
    }
    auto value = apply(ExprOp::kPow, {std::move(a.value), std::move(b.value)}, e);
    return value ? std::optional(Formula{std::move(*value), dimension}) : std::nullopt;
}

std::optional<Expr> FormulaCompiler::truth(const lang::Expr& e) {
    if (e.kind == ExprKind::kBool) {
        return Expr::boolean(e.number.numerator != 0);
    }
    if (e.kind == ExprKind::kUnary && e.op == Op::kNot) {
        auto a = truth(e.args[0].value);
        return a ? e_.apply(ExprOp::kNot, {std::move(*a)}, e.span) : std::nullopt;
    }
    if (e.kind == ExprKind::kBinary) {
        if (e.op == Op::kAnd || e.op == Op::kOr || e.op == Op::kImplies) {
            auto result = truth(e.args[0].value);
            for (std::size_t i = 1; result && i < e.args.size(); ++i) {
                auto next = truth(e.args[i].value);
                result =
                    next ? e_.apply(kernel_op(e.op), {std::move(*result), std::move(*next)}, e.span)
                         : std::nullopt;
            }
            return result;
        }
        if (e.op >= Op::kEqual && e.op <= Op::kGreaterEqual && e.args.size() == 2) {
            auto a = number(e.args[0].value);
            auto b = number(e.args[1].value);
            if (!a || !b || !same_unit(e, *a, *b)) {
                return std::nullopt;
            }
            return e_.apply(kernel_op(e.op), {std::move(a->value), std::move(b->value)}, e.span);
        }
    }
    // A parameter of type bool is the number 1 or 0.
    if (e.kind == ExprKind::kPath) {
        if (auto a = number(e)) {
            return e_.apply(ExprOp::kNotEqual, {std::move(a->value), Expr::real(0)}, e.span);
        }
        return std::nullopt;
    }
    e_.error("wrong-type", e.span, "this is no condition", "write one such as `t < 0.5 s`");
    return std::nullopt;
}

std::optional<Formula> FormulaCompiler::conditional(const lang::Expr& e) {
    const auto condition = truth(e.args[0].value);
    if (!condition) {
        return std::nullopt;
    }
    guards_.push_back({*condition, true});
    auto yes = number(e.args[1].value);
    guards_.back().holds = false;
    auto no = number(e.args[2].value);
    guards_.pop_back();
    if (!yes || !no || !same_unit(e, *yes, *no)) {
        return std::nullopt;
    }
    const lang::Dimension dimension = yes->zero ? no->dimension : yes->dimension;
    const bool zero = yes->zero && no->zero;
    auto value = apply(ExprOp::kIf, {*condition, std::move(yes->value), std::move(no->value)}, e);
    return value ? std::optional(Formula{std::move(*value), dimension, zero}) : std::nullopt;
}

std::optional<Formula> FormulaCompiler::call(const lang::Expr& e) {
    Formula known_elsewhere;
    if (names_ != nullptr) {
        const FormulaNames::Found found = names_->call(e, known_elsewhere);
        if (found != FormulaNames::Found::kNo) {
            known_elsewhere.dimension = counted(known_elsewhere.dimension);
            return found == FormulaNames::Found::kYes ? std::optional(std::move(known_elsewhere))
                                                      : std::nullopt;
        }
    }
    const Function* f = e.path.steps.size() == 1 ? find_function(e.path.steps[0].text) : nullptr;
    if (f == nullptr) {
        std::vector<std::string> known;
        for (const Function& g : functions()) {
            known.emplace_back(g.name);
        }
        e_.unknown(e.path.span, "function", lang::to_text(e.path), known);
        return std::nullopt;
    }
    const bool many = f->op == ExprOp::kMin || f->op == ExprOp::kMax;
    if (e.args.size() < static_cast<std::size_t>(f->operands) ||
        (!many && e.args.size() > static_cast<std::size_t>(f->operands))) {
        e_.error(e.args.size() < static_cast<std::size_t>(f->operands) ? "missing-argument"
                                                                       : "too-many-arguments",
                 e.span,
                 std::string(f->name) + " takes " + std::to_string(f->operands) +
                     (f->operands == 1 ? " argument" : " arguments"),
                 "give exactly these");
        return std::nullopt;
    }
    std::vector<Formula> args;
    for (const lang::Argument& a : e.args) {
        auto value = number(a.value);
        if (!value) {
            return std::nullopt;
        }
        args.push_back(std::move(*value));
    }
    lang::Dimension dimension = args[0].dimension;
    if (many || f->op == ExprOp::kAtan2) {
        for (std::size_t i = 1; i < args.size(); ++i) {
            if (!same_unit(e.args[i].value, args[0], args[i])) {
                return std::nullopt;
            }
            dimension = args[0].zero ? args[i].dimension : dimension;
        }
    } else if (f->op != ExprOp::kAbs && f->op != ExprOp::kSqrt) {
        for (std::size_t i = 0; i < args.size(); ++i) {
            const bool angle = takes_angle(f->op) && args[i].dimension == lang::dimension::kAngle;
            if (!args[i].fits(kPlain) && !angle) {
                e_.error("wrong-unit", e.args[i].value.span,
                         std::string(f->name) + " wants " +
                             (takes_angle(f->op) ? "an angle" : "a number without unit") +
                             ", and this is " + lang::to_text(args[i].dimension),
                         "divide it by a unit: `x / 1 s`");
                return std::nullopt;
            }
        }
        dimension = kPlain;
    }
    const lang::Expr& first = e.args[0].value;
    const std::string text = lang::to_text(first);
    switch (f->op) {
        case ExprOp::kSqrt: {
            danger(args[0].value, true, first, "the root of a negative number, `" + text + "`");
            const lang::Dimension d = dimension;
            if (d.length % 2 != 0 || d.time % 2 != 0 || d.mass % 2 != 0 || d.angle % 2 != 0) {
                e_.error("wrong-unit", e.span, "the root of " + lang::to_text(d) + " has no unit",
                         "divide it by a unit");
                return std::nullopt;
            }
            dimension = {static_cast<std::int8_t>(d.length / 2),
                         static_cast<std::int8_t>(d.time / 2), static_cast<std::int8_t>(d.mass / 2),
                         static_cast<std::int8_t>(d.angle / 2), 0};
            break;
        }
        case ExprOp::kLog:
            danger(args[0].value, false, first, "the logarithm of 0, `" + text + "`");
            danger(args[0].value, true, first,
                   "the logarithm of a negative number, `" + text + "`");
            break;
        case ExprOp::kTan: {
            if (auto cosine = apply(ExprOp::kCos, {args[0].value}, e)) {
                danger(*cosine, false, first, "the tangent of a right angle, `" + text + "`");
            }
            break;
        }
        case ExprOp::kAsin:
        case ExprOp::kAcos: {
            auto size = apply(ExprOp::kAbs, {args[0].value}, e);
            auto rest = size ? apply(ExprOp::kSubtract, {Expr::real(1), *size}, e) : std::nullopt;
            if (rest) {
                danger(*rest, true, first, "`" + text + "` is beyond 1");
            }
            break;
        }
        case ExprOp::kPow:
            danger(args[0].value, true, first, "a negative number has no such power");
            break;
        default:
            break;
    }
    if (gives_angle(f->op)) {
        dimension = counted(lang::dimension::kAngle);
    }
    std::optional<Expr> value = std::move(args[0].value);
    if (f->operands == 1) {
        value = apply(f->op, {std::move(*value)}, e);
    }
    for (std::size_t i = 1; value && i < args.size(); ++i) {
        value = apply(f->op, {std::move(*value), std::move(args[i].value)}, e);
    }
    return value ? std::optional(Formula{std::move(*value), dimension}) : std::nullopt;
}

bool FormulaCompiler::is_point(const lang::Expr& e) const {
    switch (e.kind) {
        case ExprKind::kTuple:
            return true;
        case ExprKind::kPath: {
            const auto& steps = e.path.steps;
            return things_.count(steps[0].text) != 0 &&
                   (steps.size() == 1 || (steps.size() == 2 && steps[1].text == "position"));
        }
        case ExprKind::kUnary:
        case ExprKind::kBinary:
            return std::any_of(e.args.begin(), e.args.end(),
                               [this](const lang::Argument& a) { return is_point(a.value); });
        case ExprKind::kConditional:
            return is_point(e.args[1].value);
        default:
            return false;
    }
}

std::optional<Formula3> FormulaCompiler::point(const lang::Expr& e) {
    const auto each = [&](auto make) -> std::optional<Formula3> {
        Formula3 out;
        for (std::size_t k = 0; k < 3; ++k) {
            auto value = make(k);
            if (!value) {
                return std::nullopt;
            }
            out[k] = std::move(*value);
        }
        return out;
    };
    if (e.kind == ExprKind::kTuple && e.args.size() == 3) {
        return each([&](std::size_t k) -> std::optional<Formula> {
            auto value = number(e.args[k].value);
            if (!value || e.unit.empty()) {
                return value;
            }
            const Term unit = e_.number_of(e, Rational{1}, e.unit, e.unit_span);
            const Number* u = std::get_if<Number>(&unit);
            if (u == nullptr || value->dimension != kPlain) {
                return value;
            }
            lang::Expr product = e.args[k].value;
            product.op = Op::kMultiply;
            product.kind = ExprKind::kBinary;
            return fold(product, std::move(*value), e,
                        Formula{Expr::real(u->value), counted(u->dimension)});
        });
    }
    if (e.kind == ExprKind::kPath && is_point(e)) {
        const std::uint32_t first = things_.find(e.path.steps[0].text)->second;
        return each([&](std::size_t k) -> std::optional<Formula> {
            return Formula{slot(FormulaSlot::kInput, first + static_cast<std::uint32_t>(k)),
                           lang::dimension::kLength};
        });
    }
    if (e.kind == ExprKind::kUnary && e.op == Op::kNegate) {
        auto a = point(e.args[0].value);
        return !a ? std::nullopt : each([&](std::size_t k) -> std::optional<Formula> {
            auto value = apply(ExprOp::kNegate, {(*a)[k].value}, e);
            return value ? std::optional(Formula{*value, (*a)[k].dimension}) : std::nullopt;
        });
    }
    if (e.kind == ExprKind::kConditional && is_point(e)) {
        const auto condition = truth(e.args[0].value);
        if (!condition) {
            return std::nullopt;
        }
        guards_.push_back({*condition, true});
        auto yes = point(e.args[1].value);
        guards_.back().holds = false;
        auto no = point(e.args[2].value);
        guards_.pop_back();
        if (!yes || !no) {
            return std::nullopt;
        }
        return each([&](std::size_t k) -> std::optional<Formula> {
            auto value = apply(ExprOp::kIf, {*condition, (*yes)[k].value, (*no)[k].value}, e);
            return value ? std::optional(Formula{*value, (*yes)[k].dimension}) : std::nullopt;
        });
    }
    if (e.kind == ExprKind::kBinary && is_point(e)) {
        const bool sum = e.op == Op::kAdd || e.op == Op::kSubtract;
        const bool product = e.op == Op::kMultiply || e.op == Op::kDivide;
        std::optional<Formula3> result;
        std::optional<Formula> factor;
        if (sum || product) {
            bool good = true;
            for (std::size_t i = 0; good && i < e.args.size(); ++i) {
                const lang::Expr& part = e.args[i].value;
                const bool vector = is_point(part);
                if (sum || (vector && !result && e.op == Op::kMultiply) || (vector && i == 0)) {
                    auto next = point(part);
                    good = next.has_value();
                    if (good && sum && result) {
                        auto before = std::move(*result);
                        result = each([&](std::size_t k) {
                            return fold(e, std::move(before[k]), part, std::move((*next)[k]));
                        });
                    } else if (good) {
                        result = std::move(next);
                        if (factor) {
                            auto before = std::move(*result);
                            result = each([&](std::size_t k) {
                                return fold(e, *factor, part, std::move(before[k]));
                            });
                        }
                    }
                } else if (vector) {
                    good = false;
                } else {
                    auto next = number(part);
                    good = next.has_value();
                    if (good && result) {
                        auto before = std::move(*result);
                        result = each([&](std::size_t k) {
                            return fold(e, std::move(before[k]), part, *next);
                        });
                    } else if (good) {
                        factor = factor ? fold(e, std::move(*factor), part, std::move(*next))
                                        : std::move(next);
                        good = factor.has_value();
                    }
                }
                good = good && (result || factor);
            }
            if (good && result) {
                return result;
            }
        }
    }
    e_.error("wrong-type", e.span, "this is no place",
             "write it as (x, y, z) m, with formulas for x, y and z");
    return std::nullopt;
}

}  // namespace puppetri::scene
