// SPDX-License-Identifier: MIT
// Calls inside expressions: functions of numbers, folded where their arguments are constant, and
// movements as values.
#include "functions.h"

#include <cmath>

#include "elaboration.h"
#include "puppetri/base/elementary.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

namespace {

double round_to_even(double x) { return std::nearbyint(x); }

const Function kFunctions[] = {
    {"abs", ExprOp::kAbs, 1, nullptr},
    {"min", ExprOp::kMin, 2, nullptr},
    {"max", ExprOp::kMax, 2, nullptr},
    {"floor", ExprOp::kFloor, 1, [](double x, double) { return std::floor(x); }},
    {"ceil", ExprOp::kCeil, 1, [](double x, double) { return std::ceil(x); }},
    {"round", ExprOp::kRound, 1, [](double x, double) { return round_to_even(x); }},
    {"sqrt", ExprOp::kSqrt, 1, [](double x, double) { return std::sqrt(x); }},
    {"sin", ExprOp::kSin, 1, [](double x, double) { return sin(x); }},
    {"cos", ExprOp::kCos, 1, [](double x, double) { return cos(x); }},
    {"tan", ExprOp::kTan, 1, [](double x, double) { return tan(x); }},
    {"asin", ExprOp::kAsin, 1, [](double x, double) { return asin(x); }},
    {"acos", ExprOp::kAcos, 1, [](double x, double) { return acos(x); }},
    {"exp", ExprOp::kExp, 1, [](double x, double) { return exp(x); }},
    {"log", ExprOp::kLog, 1, [](double x, double) { return log(x); }},
    {"atan2", ExprOp::kAtan2, 2, [](double y, double x) { return atan2(y, x); }},
    {"pow", ExprOp::kPow, 2, [](double x, double y) { return pow(x, y); }},
};

}  // namespace

std::span<const Function> functions() { return kFunctions; }

const Function* find_function(std::string_view name) {
    for (const Function& f : kFunctions) {
        if (name == f.name) {
            return &f;
        }
    }
    return nullptr;
}

Term Elaboration::evaluate_call(const lang::Expr& e, const Scope& scope) {
    if (e.path.steps.size() == 1) {
        const std::string& name = e.path.steps[0].text;
        if (const Function* f = find_function(name)) {
            if (e.args.size() < static_cast<std::size_t>(f->operands)) {
                error("missing-argument", e.span,
                      name + " takes " + std::to_string(f->operands) + " arguments", "give all");
                return Nothing{};
            }
            const bool variadic = f->op == ExprOp::kMin || f->op == ExprOp::kMax;
            if (!variadic && e.args.size() > static_cast<std::size_t>(f->operands)) {
                error("too-many-arguments", e.args.back().value.span,
                      name + " takes " + std::to_string(f->operands) + " arguments",
                      "remove this one");
                return Nothing{};
            }
            return call_function(e, *f, scope);
        }
        if (is_sensor_function(name)) {
            return sensor_quantity(e, scope);
        }
        if (const OwnDefinition* own = own_movement(name, e.span.file)) {
            // What is wrong with it has been told.
            return own->movement != nullptr ? movement_value(e, e.path, scope) : Term{Nothing{}};
        }
        if (motion::find_movement(name, motion::SubjectKind::kActor) != nullptr) {
            return movement_value(e, e.path, scope);
        }
    }
    std::vector<std::string> known;
    for (const Function& f : kFunctions) {
        known.emplace_back(f.name);
    }
    known.insert(known.end(), {"distance", "height", "speed", "angle", "inside"});
    for (const motion::MovementSignature& m : motion::movement_library()) {
        if (motion::find_movement(m.name, motion::SubjectKind::kActor) != nullptr) {
            known.emplace_back(m.name);
        }
    }
    unknown(e.path.span, "function or movement", lang::to_text(e.path), known);
    return Nothing{};
}

Term Elaboration::call_function(const lang::Expr& e, const Function& f, const Scope& scope) {
    std::vector<Term> terms;
    bool constant = true;
    for (const lang::Argument& a : e.args) {
        terms.push_back(evaluate(a.value, scope));
        if (is_nothing(terms.back())) {
            return Nothing{};
        }
        constant = constant && std::holds_alternative<Number>(terms.back());
    }
    if (!constant) {
        std::optional<Expr> result;
        std::vector<Expr> operands;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto x = as_expr(terms[i], e.args[i].value.span);
            if (!x) {
                return Nothing{};
            }
            operands.push_back(std::move(*x));
            if (operands.size() == static_cast<std::size_t>(f.operands)) {
                result = apply(f.op, std::move(operands), e.span);
                if (!result) {
                    return Nothing{};
                }
                operands = {*result};
            }
        }
        return std::move(*result);
    }
    const Number& x = std::get<Number>(terms[0]);
    if (f.op == ExprOp::kAbs) {
        return x.value < 0 ? negate(x) : x;
    }
    if (f.op == ExprOp::kMin || f.op == ExprOp::kMax) {
        Number best = x;
        for (std::size_t i = 1; i < terms.size(); ++i) {
            const Number& y = std::get<Number>(terms[i]);
            if (y.dimension != best.dimension) {
                error("wrong-unit", e.args[i].value.span, "cannot compare different kinds of units",
                      "give all the same");
                return Nothing{};
            }
            if ((compare(y, best) < 0) == (f.op == ExprOp::kMin)) {
                best = y;
            }
        }
        return best;
    }
    const bool angle = takes_angle(f.op);
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const Number& n = std::get<Number>(terms[i]);
        if (!n.plain() && !(angle && n.dimension == lang::dimension::kAngle)) {
            wrong(e.args[i].value.span, angle ? "an angle" : "a number without unit", terms[i]);
            return Nothing{};
        }
    }
    const double y = terms.size() > 1 ? std::get<Number>(terms[1]).value : 0;
    const double value = f.fold(x.value, y);
    if (!(value - value == 0)) {
        error("not-a-number", e.span, "this has no value", "look at the range of the arguments");
        return Nothing{};
    }
    if (f.op == ExprOp::kFloor || f.op == ExprOp::kCeil || f.op == ExprOp::kRound) {
        if (value >= -9e15 && value <= 9e15) {
            return Number::whole(static_cast<std::int64_t>(value));
        }
    }
    return from_double(value, gives_angle(f.op) ? lang::dimension::kAngle : lang::dimension::kNone);
}

}  // namespace puppetri::scene
