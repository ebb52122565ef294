// SPDX-License-Identifier: MIT
#include "make.h"

namespace puppetri::notation {

using lang::Expr;
using lang::ExprKind;
using lang::Name;
using lang::Path;
using lang::Span;

Name make_name(std::string text, Span span) { return {std::move(text), {}, span}; }

Name make_name(std::string text, std::int64_t index, Span span) {
    return {std::move(text), {make_number(Rational{index}, span)}, span};
}

Path make_path(std::string text, Span span) { return {{make_name(std::move(text), span)}, span}; }

Path make_path(std::vector<Name> steps, Span span) { return {std::move(steps), span}; }

Expr make_number(Rational number, Span span, std::string unit) {
    Expr e;
    e.kind = ExprKind::kNumber;
    e.number = number;
    e.unit = std::move(unit);
    e.span = e.unit_span = span;
    return e;
}

Expr make_bool(bool value, Span span) {
    Expr e = make_number(Rational{value ? 1 : 0}, span);
    e.kind = ExprKind::kBool;
    return e;
}

Expr make_reference(Path path) {
    Expr e;
    e.kind = ExprKind::kPath;
    e.span = path.span;
    e.path = std::move(path);
    return e;
}

Expr make_reference(std::string text, Span span) {
    return make_reference(make_path(std::move(text), span));
}

Expr make_count(Path place) {
    Expr e = make_reference(std::move(place));
    e.kind = ExprKind::kCount;
    return e;
}

Expr make_unary(lang::Op op, Expr a) {
    Expr e;
    e.kind = ExprKind::kUnary;
    e.op = op;
    e.span = a.span;
    e.args.push_back({{}, std::move(a)});
    return e;
}

Expr make_binary(lang::Op op, Expr a, Expr b) {
    Expr e = make_unary(op, std::move(a));
    e.kind = ExprKind::kBinary;
    e.args.push_back({{}, std::move(b)});
    return e;
}

Expr make_both(Expr a, Expr b) {
    if (!a || !b) {
        return a ? a : b;
    }
    return make_binary(lang::Op::kAnd, std::move(a), std::move(b));
}

Expr make_any(const std::vector<std::string>& names, Span span) {
    Expr any;
    for (const std::string& name : names) {
        Expr e = make_reference(name, span);
        if (!any) {
            any = std::move(e);
        } else if (any.kind != ExprKind::kBinary) {
            any = make_binary(lang::Op::kOr, std::move(any), std::move(e));
        } else {
            any.args.push_back({{}, std::move(e)});
        }
    }
    return any;
}

Expr make_choice(Expr condition, Expr yes, Expr no) {
    Expr e;
    e.kind = ExprKind::kConditional;
    e.span = condition.span;
    e.args.push_back({{}, std::move(condition)});
    e.args.push_back({{}, std::move(yes)});
    e.args.push_back({{}, std::move(no)});
    return e;
}

Expr make_call(Path path, std::vector<Expr> positional, Span span) {
    Expr e = make_reference(std::move(path));
    e.kind = ExprKind::kCall;
    e.span = span;
    for (Expr& argument : positional) {
        e.args.push_back({{}, std::move(argument)});
    }
    return e;
}

lang::Arc make_arc(lang::ArcKind kind, Path place, Expr weight) {
    lang::Arc arc;
    arc.kind = kind;
    arc.span = place.span;
    arc.place = std::move(place);
    arc.weight = std::move(weight);
    return arc;
}

lang::Place make_place(Name name) {
    lang::Place place;
    place.span = name.span;
    place.name = std::move(name);
    return place;
}

void give_token(lang::Place& place) {
    lang::InitialTokens tokens;
    tokens.count = make_number(Rational{1}, place.span);
    tokens.span = place.span;
    place.tokens.push_back(std::move(tokens));
}

lang::Duration make_duration(const Expr& value) {
    lang::Duration out;
    out.kind = lang::DurationKind::kValue;
    out.span = value.span;
    if (value.kind == ExprKind::kPath && value.path.steps.size() == 1) {
        const std::string& word = value.path.steps[0].text;
        if (word == "auto" || word == "open") {
            out.kind = word == "auto" ? lang::DurationKind::kAuto : lang::DurationKind::kOpen;
            return out;
        }
    }
    out.value = value;
    return out;
}

lang::Transition make_transition(Name name, std::vector<Path> from, std::vector<Path> to) {
    lang::Transition out;
    out.span = name.span;
    out.name = std::move(name);
    for (Path& p : from) {
        out.inputs.push_back(make_arc(lang::ArcKind::kTake, std::move(p)));
    }
    for (Path& p : to) {
        out.outputs.push_back(make_arc(lang::ArcKind::kGive, std::move(p)));
    }
    return out;
}

lang::Transition make_clock(lang::Body& body, const Expr& period) {
    lang::Place clock = make_place(make_name("clock", period.span));
    clock.is_public = true;
    clock.takes = make_duration(period);
    give_token(clock);
    body.places.push_back(std::move(clock));
    lang::Transition step =
        make_transition(make_name("step", period.span), {make_path("clock", period.span)},
                        {make_path("clock", period.span)});
    step.is_public = true;
    return step;
}

lang::Binding make_assignment(Path datum, Expr value) {
    const Span span = datum.span;
    return {std::move(datum), std::move(value), span};
}

}  // namespace puppetri::notation
