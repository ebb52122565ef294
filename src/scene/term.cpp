// SPDX-License-Identifier: MIT
#include "term.h"

#include <cmath>

#include "puppetri/base/rational.h"

namespace puppetri::scene {
namespace {

lang::Dimension combined(const lang::Dimension& a, const lang::Dimension& b, int sign) {
    const auto sum = [sign](std::int8_t x, std::int8_t y) {
        return static_cast<std::int8_t>(x + sign * y);
    };
    return {.length = sum(a.length, b.length),
            .time = sum(a.time, b.time),
            .mass = sum(a.mass, b.mass),
            .angle = sum(a.angle, b.angle),
            .frame = sum(a.frame, b.frame)};
}

constexpr double kPi = 3.14159265358979323846;

// Multiplications one by one, so that the bits are the same everywhere.
double times_pi(double x, int pi_power) {
    for (; pi_power > 0; --pi_power) {
        x *= kPi;
    }
    for (; pi_power < 0; ++pi_power) {
        x /= kPi;
    }
    return x;
}

Number from_exact(std::optional<Rational> exact, int pi_power, lang::Dimension dimension,
                  double otherwise) {
    if (!exact) {
        return from_double(otherwise, dimension);
    }
    return {.exact = *exact,
            .pi_power = exact->numerator == 0 ? 0 : pi_power,
            .is_exact = true,
            .value = times_pi(to_double(*exact), pi_power),
            .dimension = dimension};
}

// Zero has every power of pi.
bool same_pi(const Number& a, const Number& b) {
    return a.is_exact && b.is_exact &&
           (a.pi_power == b.pi_power || a.exact.numerator == 0 || b.exact.numerator == 0);
}

int pi_of(const Number& a, const Number& b) {
    return a.exact.numerator == 0 ? b.pi_power : a.pi_power;
}

struct Describe {
    std::string operator()(const Nothing&) const { return "nothing"; }
    std::string operator()(const Number& n) const {
        return n.is_integer() ? "a whole number" : lang::to_text(n.dimension);
    }
    std::string operator()(bool) const { return "yes or no"; }
    std::string operator()(const Text&) const { return "a text"; }
    std::string operator()(const Word& w) const { return "the word " + w.text; }
    std::string operator()(const PointTerm&) const { return "a point"; }
    std::string operator()(const ActorTerm&) const { return "an actor"; }
    std::string operator()(const LimbTerm&) const { return "a limb"; }
    std::string operator()(const PropTerm&) const { return "a prop"; }
    std::string operator()(const SetTerm&) const { return "a set"; }
    std::string operator()(const HolderOfTerm&) const { return "the holder of a prop"; }
    std::string operator()(const HolderTerm&) const { return "a holder"; }
    std::string operator()(const InstanceTerm&) const { return "an instance of a net"; }
    std::string operator()(const PlaceTerm&) const { return "a place"; }
    std::string operator()(const TransitionTerm&) const { return "a transition"; }
    std::string operator()(const EventTerm&) const { return "an event"; }
    std::string operator()(const DatumTerm&) const { return "data"; }
    std::string operator()(const ChannelTerm&) const { return "a channel"; }
    std::string operator()(const EnumTerm&) const { return "a value of an enumeration"; }
    std::string operator()(const EnumerationTerm&) const { return "an enumeration"; }
    std::string operator()(const QuantityTerm& q) const {
        return "what figures are asked, `" + q.text + "`";
    }
    std::string operator()(const MovementTerm&) const { return "a movement"; }
    std::string operator()(const Expr& e) const {
        return std::string("a value of type ") + name_of(e.type().kind);
    }
    std::string operator()(const net::Formula&) const { return "a statement about the net"; }
};

}  // namespace

std::string describe(const Term& term) { return std::visit(Describe{}, term); }

Number from_double(double value, lang::Dimension dimension) {
    return {.is_exact = false, .value = value, .dimension = dimension};
}

Number add(const Number& a, const Number& b) {
    return from_exact(same_pi(a, b) ? puppetri::add(a.exact, b.exact) : std::nullopt, pi_of(a, b),
                      a.dimension, a.value + b.value);
}

Number subtract(const Number& a, const Number& b) { return add(a, negate(b)); }

Number multiply(const Number& a, const Number& b) {
    const bool exact = a.is_exact && b.is_exact;
    return from_exact(exact ? puppetri::multiply(a.exact, b.exact) : std::nullopt,
                      a.pi_power + b.pi_power, combined(a.dimension, b.dimension, 1),
                      a.value * b.value);
}

Number divide(const Number& a, const Number& b) {
    const bool exact = a.is_exact && b.is_exact;
    return from_exact(exact ? puppetri::divide(a.exact, b.exact) : std::nullopt,
                      a.pi_power - b.pi_power, combined(a.dimension, b.dimension, -1),
                      a.value / b.value);
}

Number power(const Number& a, int exponent) {
    Number result = Number::whole(1);
    for (int i = 0; i < (exponent < 0 ? -exponent : exponent); ++i) {
        result = exponent < 0 ? divide(result, a) : multiply(result, a);
    }
    return result;
}

Number negate(const Number& a) {
    Number result = a;
    const std::optional<Rational> exact = a.is_exact ? puppetri::negate(a.exact) : std::nullopt;
    result.is_exact = exact.has_value();
    result.exact = exact.value_or(Rational{});
    result.value = -a.value;
    return result;
}

int compare(const Number& a, const Number& b) {
    if (same_pi(a, b)) {
        const auto order = puppetri::compare(a.exact, b.exact);
        return order < 0 ? -1 : order > 0 ? 1 : 0;
    }
    return a.value < b.value ? -1 : a.value > b.value ? 1 : 0;
}

}  // namespace puppetri::scene
