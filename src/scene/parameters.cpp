// SPDX-License-Identifier: MIT
// Parameters of nets: their types, and their values, bound when somebody first asks. So instances
// may name each other in any order, and a ring of defaults is found instead of followed.
#include "elaboration.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

struct QuantityType {
    const char* name;
    lang::Dimension dimension;
};
constexpr QuantityType kQuantities[] = {
    {"real", lang::dimension::kNone},     {"time", lang::dimension::kTime},
    {"length", lang::dimension::kLength}, {"angle", lang::dimension::kAngle},
    {"speed", lang::dimension::kSpeed},   {"mass", lang::dimension::kMass},
    {"number", lang::dimension::kNone},
};
const char* const kOthers[] = {"actor", "prop",     "set",     "int",   "bool",
                               "side",  "movement", "point",   "place", "transition",
                               "event", "data",     "channel", "text"};

std::vector<std::string> type_names() {
    std::vector<std::string> names;
    for (const QuantityType& q : kQuantities) {
        names.emplace_back(q.name);
    }
    names.insert(names.end(), std::begin(kOthers), std::end(kOthers));
    return names;
}

bool is_thing_of(std::string_view type, const Term& value) {
    if (type == "actor") {
        return std::holds_alternative<ActorTerm>(value);
    }
    if (type == "prop") {
        return std::holds_alternative<PropTerm>(value);
    }
    if (type == "set") {
        return std::holds_alternative<SetTerm>(value);
    }
    if (type == "bool") {
        return std::holds_alternative<bool>(value);
    }
    if (type == "movement") {
        return std::holds_alternative<MovementTerm>(value);
    }
    if (type == "point") {
        return std::holds_alternative<PointTerm>(value);
    }
    if (type == "place") {
        return std::holds_alternative<PlaceTerm>(value);
    }
    if (type == "transition") {
        return std::holds_alternative<TransitionTerm>(value);
    }
    if (type == "event") {
        return std::holds_alternative<EventTerm>(value);
    }
    if (type == "data") {
        return std::holds_alternative<DatumTerm>(value);
    }
    if (type == "channel") {
        return std::holds_alternative<ChannelTerm>(value);
    }
    if (type == "text") {
        return std::holds_alternative<Text>(value);
    }
    return false;
}

std::string with_article(std::string_view type) {
    const bool vowel =
        !type.empty() && std::string_view("aeiou").find(type[0]) != std::string_view::npos;
    return (vowel ? "an " : "a ") + std::string(type);
}

}  // namespace

Term Elaboration::parameter_value(std::uint32_t number, std::size_t index) {
    Instance& instance = instances_[number];
    auto& [bound, value] = instance.values[index];
    const lang::Parameter& parameter = instance.net->parameters[index];
    if (bound == Instance::Bound::kYes) {
        return value;
    }
    const lang::Expr* argument = instance.arguments[index];
    About about(*this,
                "parameter " + parameter.name.text + " of " +
                    (instance.path.empty() ? instance.net->name.text : instance.path),
                argument != nullptr ? argument->span : parameter.span);
    if (bound == Instance::Bound::kNow) {
        error("parameter-cycle", argument != nullptr ? argument->span : parameter.span,
              "its value depends on itself",
              "give one of the parameters in the ring a value of its own");
        bound = Instance::Bound::kYes;
        return Nothing{};
    }
    bound = Instance::Bound::kNow;
    Term result = Nothing{};
    if (argument != nullptr) {
        result = fit_parameter(parameter, evaluate(*argument, instance.argument_scope),
                               argument->span, {.instance = number});
    } else if (parameter.default_value) {
        const Scope own{.instance = number};
        result = fit_parameter(parameter, evaluate(parameter.default_value, own),
                               parameter.default_value.span, own);
    }
    if (bound == Instance::Bound::kYes) {
        return Nothing{};  // the ring was found below
    }
    bound = Instance::Bound::kYes;
    value = result;
    return result;
}

Term Elaboration::fit_parameter(const lang::Parameter& parameter, Term value, lang::Span where,
                                const Scope& scope) {
    if (is_nothing(value)) {
        return value;
    }
    const lang::Expr& type = parameter.type;
    Number* number = std::get_if<Number>(&value);
    if (!type) {
        if (!parameter.default_value) {
            return value;
        }
        // Without a type, a value must be of the kind of the default.
        const Term standard = evaluate(parameter.default_value, {.instance = scope.instance});
        const Number* n = std::get_if<Number>(&standard);
        if (n != nullptr && number != nullptr && n->dimension == lang::dimension::kTime) {
            *number = in_time_unit(*number, where);
        }
        const bool same =
            value.index() == standard.index() &&
            (n == nullptr || (number != nullptr && n->dimension == number->dimension));
        if (!same) {
            wrong(where, describe(standard) + " (as its default is)", value);
            return is_nothing(standard) ? value : Term{Nothing{}};
        }
        return value;
    }
    if (type.kind == lang::ExprKind::kRange) {
        const auto low = constant_integer(type.args[0].value, {.instance = scope.instance},
                                          "the range of a parameter");
        const auto high = constant_integer(type.args[1].value, {.instance = scope.instance},
                                           "the range of a parameter");
        if (number == nullptr || !number->is_integer()) {
            wrong(where, "a whole number", value);
            return Nothing{};
        }
        if (low && high && (number->exact.numerator < *low || number->exact.numerator > *high)) {
            error("out-of-range", where,
                  "the value " + std::to_string(number->exact.numerator) + " is outside " +
                      lang::to_text(type),
                  "choose one inside");
            return Nothing{};
        }
        return value;
    }
    if (type.kind != lang::ExprKind::kPath || type.path.steps.size() != 1) {
        error("unknown-type", type.span, "this is not a type",
              "write one such as `actor`, `int` or `time`");
        return Nothing{};
    }
    const std::string& name = type.path.steps[0].text;
    for (const QuantityType& q : kQuantities) {
        if (name == q.name) {
            if (number != nullptr && q.dimension == lang::dimension::kTime) {
                *number = in_time_unit(*number, where);
            }
            if (number == nullptr || number->dimension != q.dimension) {
                const std::string unit(lang::example_unit(q.dimension));
                wrong(where, lang::to_text(q.dimension), value,
                      unit.empty() ? "" : "write it with a unit such as " + unit);
                return Nothing{};
            }
            return value;
        }
    }
    if (name == "int") {
        if (number == nullptr || !number->is_integer()) {
            wrong(where, "a whole number", value);
            return Nothing{};
        }
        return value;
    }
    if (name == "side") {
        const Word* word = std::get_if<Word>(&value);
        if (word == nullptr || (word->text != "left" && word->text != "right")) {
            wrong(where, "left or right", value);
            return Nothing{};
        }
        return value;
    }
    for (const char* other : kOthers) {
        if (name == other) {
            if (!is_thing_of(name, value)) {
                wrong(where, with_article(name), value);
                return Nothing{};
            }
            return value;
        }
    }
    const auto& visible = library_.visible[type.span.file];
    const auto found = visible.find(name);
    if (found == visible.end()) {
        std::vector<std::string> known = type_names();
        for (const auto& [text, d] : visible) {
            known.push_back(text);
        }
        unknown(type.span, "type", name, known);
        return Nothing{};
    }
    const Declaration& d = found->second;
    if (d.net != nullptr) {
        const auto* instance = std::get_if<InstanceTerm>(&value);
        if (instance == nullptr || instances_[instance->instance].net != d.net) {
            wrong(where, "an instance of net " + name, value);
            return Nothing{};
        }
    } else if (d.enumeration != nullptr) {
        const auto* e = std::get_if<EnumTerm>(&value);
        if (e == nullptr || e->enumeration != enumeration_index(*d.enumeration)) {
            wrong(where, "a value of " + name, value);
            return Nothing{};
        }
    }
    return value;
}

Number Elaboration::in_time_unit(const Number& n, lang::Span where) {
    if (!n.plain() || where.file >= library_.files.size()) {
        return n;
    }
    const lang::Expr& unit = library_.files[where.file].header.time_unit;
    if (!unit) {
        return n;
    }
    const Term one = evaluate(unit, {});
    const Number* seconds = std::get_if<Number>(&one);
    if (seconds == nullptr || seconds->dimension != lang::dimension::kTime) {
        wrong(unit.span, "a time", one);
        return n;
    }
    return multiply(n, *seconds);
}

std::optional<ValueType> Elaboration::value_type(const lang::Expr& type, const Scope& scope,
                                                 std::optional<Value>* low,
                                                 std::optional<Value>* high) {
    if (type.kind == lang::ExprKind::kRange && low != nullptr) {
        const Term a = evaluate(type.args[0].value, scope);
        const Term b = evaluate(type.args[1].value, scope);
        const Number* first = std::get_if<Number>(&a);
        const Number* last = std::get_if<Number>(&b);
        if (first == nullptr || last == nullptr || first->dimension != last->dimension) {
            wrong(type.span, "a range of numbers", first == nullptr ? a : b);
            return std::nullopt;
        }
        if (first->is_integer() && last->is_integer()) {
            *low = first->exact.numerator;
            *high = last->exact.numerator;
            return ValueType{ValueKind::kInt};
        }
        if (first->plain()) {
            *low = value_of_real(first->value);
            *high = value_of_real(last->value);
            return ValueType{ValueKind::kReal};
        }
        const auto from = ticks(*first, type.args[0].value.span);
        const auto to = ticks(*last, type.args[1].value.span);
        if (!from || !to) {
            return std::nullopt;
        }
        *low = from->ticks;
        *high = to->ticks;
        return ValueType{ValueKind::kTime};
    }
    std::vector<std::string> known = {"bool", "int", "real", "time", "actor", "prop"};
    if (type.kind == lang::ExprKind::kPath && type.path.steps.size() == 1) {
        const std::string& name = type.path.steps[0].text;
        constexpr std::pair<const char*, ValueKind> kKinds[] = {
            {"bool", ValueKind::kBool}, {"int", ValueKind::kInt},     {"real", ValueKind::kReal},
            {"time", ValueKind::kTime}, {"actor", ValueKind::kActor}, {"prop", ValueKind::kProp}};
        for (const auto& [text, kind] : kKinds) {
            if (name == text) {
                return ValueType{kind};
            }
        }
        const auto own = instances_[scope.instance].members.find(name);
        if (own != instances_[scope.instance].members.end() &&
            own->second.kind == MemberKind::kEnumeration) {
            return ValueType{ValueKind::kEnum, own->second.index};
        }
        const auto& visible = library_.visible[type.span.file];
        const auto found = visible.find(name);
        if (found != visible.end() && found->second.enumeration != nullptr) {
            return ValueType{ValueKind::kEnum, enumeration_index(*found->second.enumeration)};
        }
        for (const auto& [text, d] : visible) {
            if (d.enumeration != nullptr) {
                known.push_back(text);
            }
        }
    }
    unknown(type.span, "type", lang::to_text(type), known);
    return std::nullopt;
}

}  // namespace puppetri::scene
