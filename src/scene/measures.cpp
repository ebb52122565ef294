// SPDX-License-Identifier: MIT
// Measures: what the author wants to know of a run as a number, resolved to places, transitions and
// expressions of the net.
#include "elaboration.h"

namespace puppetri::scene {
namespace {

using net::Seen;
using net::Statistic;

constexpr Statistic kStatistics[] = {
    Statistic::kMean,       Statistic::kMost,  Statistic::kLeast,
    Statistic::kTotal,      Statistic::kFinal, Statistic::kShare,
    Statistic::kPercentile, Statistic::kCount, Statistic::kRate,
};

bool counts(Statistic s) { return s == Statistic::kCount || s == Statistic::kRate; }

// `leave or lose`: the paths of a disjunction; false where it is anything else.
bool paths_of(const lang::Expr& e, std::vector<const lang::Expr*>& out) {
    if (e.kind == lang::ExprKind::kPath) {
        out.push_back(&e);
        return true;
    }
    if (e.kind != lang::ExprKind::kBinary || e.op != lang::Op::kOr) {
        return false;
    }
    for (const lang::Argument& a : e.args) {
        if (!paths_of(a.value, out)) {
            return false;
        }
    }
    return true;
}

// In metres, kilograms, seconds and radians: "m/s^2".
std::string unit_text(const lang::Dimension& d) {
    const std::pair<const char*, int> units[] = {
        {"m", d.length}, {"kg", d.mass}, {"rad", d.angle}, {"frames", d.frame}, {"s", d.time}};
    std::string above, below;
    for (const auto& [unit, power] : units) {
        std::string& text = power > 0 ? above : below;
        if (power != 0) {
            text += std::string(text.empty() ? "" : "*") + unit;
            text += power * power > 1 ? "^" + std::to_string(power < 0 ? -power : power) : "";
        }
    }
    if (below.empty()) {
        return above;
    }
    const bool several = below.find('*') != std::string::npos;
    return (above.empty() ? "1" : above) + "/" + (several ? "(" + below + ")" : below);
}

}  // namespace

// `fall.h`: a variable of equations, or a part of them that has a name.
const Elaboration::Course* Elaboration::course_of(const lang::Expr& e, const Scope& scope) {
    if (e.kind != lang::ExprKind::kPath || e.path.steps.size() < 2 ||
        !e.path.steps.back().index.empty()) {
        return nullptr;
    }
    const std::string& name = e.path.steps.back().text;
    if (std::none_of(courses_.begin(), courses_.end(),
                     [&](const auto& c) { return c.first.second == name; })) {
        return nullptr;
    }
    lang::Path before = e.path;
    before.steps.pop_back();
    const Term term = resolve(before, scope);
    const auto* instance = std::get_if<InstanceTerm>(&term);
    const auto found =
        instance == nullptr ? courses_.end() : courses_.find({instance->instance, name});
    return found == courses_.end() ? nullptr : &found->second;
}

// What is seen: a truth where a share is wanted, else a number or a time.
std::optional<Expr> Elaboration::seen_value(const lang::Expr& e, const Scope& scope, bool truth) {
    const Term term = evaluate(e, scope);
    if (truth) {
        return as_expr_of(term, {ValueKind::kBool}, e.span);
    }
    auto value = std::holds_alternative<PlaceTerm>(term) ? std::optional<Expr>(Expr::boolean(true))
                                                         : as_expr(term, e.span);
    if (!value) {
        return std::nullopt;
    }
    switch (value->type().kind) {
        case ValueKind::kInt:
        case ValueKind::kReal:
        case ValueKind::kTime:
            return value;
        default:
            wrong(e.span, "a number or a time", term,
                  "write #PLACE for how many tokens there are, or `share of` for how often "
                  "something is true");
            return std::nullopt;
    }
}

// A transition that is named, and its variables; of `t.end` those of t.
std::optional<net::TransitionIndex> Elaboration::moment_of(const lang::Path& path,
                                                           const Scope& scope, Locals& locals) {
    const Term term = resolve(path, scope);
    const auto* t = std::get_if<TransitionTerm>(&term);
    if (t == nullptr) {
        wrong(path.span, "a transition", term);
        return std::nullopt;
    }
    const auto& transitions = draft().transitions;
    locals.names = transitions[t->transition.value].variables;
    for (const net::TransitionDraft& begin : transitions) {
        if (begin.holding && begin.end == t->transition) {
            locals.names = begin.variables;
        }
    }
    return t->transition;
}

std::vector<net::Moment> Elaboration::moments_of(const std::vector<lang::Moment>& list,
                                                 const Scope& scope) {
    std::vector<net::Moment> out;
    for (const lang::Moment& node : list) {
        Locals locals;
        const auto transition = moment_of(node.transition, scope, locals);
        if (!transition) {
            continue;
        }
        net::Moment& moment = out.emplace_back();
        moment.transition = *transition;
        if (node.key) {
            Scope inner = scope;
            inner.locals = &locals;
            moment.keyed = true;
            if (auto key = as_expr(evaluate(node.key, inner), node.key.span)) {
                moment.value = std::move(*key);
            }
        }
    }
    return out;
}

void Elaboration::complete_measures() {
    std::set<std::string> names;
    for (const Element<lang::Measure>& measure : measures_) {
        About about(*this, "measure " + measure.path, measure.node->span);
        if (!names.insert(measure.path).second) {
            error("name-twice", measure.node->name.span,
                  "there is already a measure " + measure.path, "choose another name");
        }
        complete_measure(measure);
    }
}

void Elaboration::complete_measure(const Element<lang::Measure>& measure) {
    const lang::Measure& node = *measure.node;
    const Scope& scope = measure.scope;
    net::MeasureDraft out{
        .path = measure.path, .caption = node.caption.text, .where = at(node.span)};
    std::vector<std::string> known;
    bool found = false;
    for (const Statistic s : kStatistics) {
        known.emplace_back(net::name_of(s));
        if (node.statistic.text == known.back()) {
            out.statistic = s;
            found = true;
        }
    }
    if (!found) {
        unknown(node.statistic.span, "statistic", node.statistic.text, known);
        return;
    }
    if ((out.statistic == Statistic::kPercentile) != static_cast<bool>(node.percent)) {
        error("wrong-form", node.statistic.span,
              node.percent ? "only a percentile has a number" : "which percentile is not said",
              node.percent ? "leave the number out" : "write `percentile 90 of`");
        return;
    }
    if (node.percent) {
        const auto percent =
            constant_number(node.percent, scope, lang::dimension::kNone, "a percentile");
        if (!percent) {
            return;
        }
        out.percent = percent->value;
        if (!(out.percent > 0 && out.percent <= 100)) {
            error("out-of-range", node.percent.span, "a percentile is above 0 and at most 100",
                  "write 90");
            return;
        }
    }
    const bool share = out.statistic == Statistic::kShare;
    const auto refuse = [&](const char* what, const char* remedy) {
        error("wrong-form", node.statistic.span,
              "there is no " + node.statistic.text + " of " + what, remedy);
    };
    if (node.seen != lang::Seen::kExpr) {
        out.seen = node.seen == lang::Seen::kStay ? Seen::kStays : Seen::kPassages;
        if (share != static_cast<bool>(node.above)) {
            error(
                "wrong-form", node.span,
                share ? "a share of times needs a time that they are above"
                      : "only a share has a time that is compared with",
                share ? "write `share of time in P > 5 min`" : "leave it out, or write `share of`");
            return;
        }
        if (share) {
            out.above = constant_time(node.above, scope, "the time of a measure");
            if (!out.above) {
                return;
            }
        }
        if (node.seen == lang::Seen::kStay) {
            const auto place = place_of(node.place, scope);
            if (!place) {
                return;
            }
            out.place = *place;
        } else {
            out.from = moments_of(node.from, scope);
            out.to = moments_of(node.to, scope);
            std::optional<ValueType> key;
            for (const auto* list : {&out.from, &out.to}) {
                for (const net::Moment& moment : *list) {
                    if (moment.keyed != (out.from.empty() || out.from[0].keyed)) {
                        error("wrong-form", node.span,
                              "some of its firings say in ( ) to whom they "
                              "belong and some do not",
                              "say it of all, or of none");
                        return;
                    }
                    if (moment.keyed && key && *key != moment.value.type()) {
                        error("wrong-type", node.span,
                              "what says to whom a firing belongs has different types",
                              "give both the same attribute of a token");
                        return;
                    }
                    key = moment.value.type();
                }
            }
        }
        draft().measures.push_back(std::move(out));
        return;
    }
    if (const Course* course = node.from.empty() ? course_of(node.value, scope) : nullptr) {
        if (share) {
            refuse("what changes all the time",
                   "let a sensor of the equations say when: `sensor high when h > 1 m`, and "
                   "`share of x.high`");
            return;
        }
        if (counts(out.statistic) || out.statistic == Statistic::kPercentile) {
            refuse("what changes all the time",
                   "let an event of the equations say when, and count what fires on it");
            return;
        }
        out.seen = Seen::kCourse;
        out.course = course->quantity;
        lang::Dimension d = course->dimension;
        d.time = static_cast<std::int8_t>(d.time + (out.statistic == Statistic::kTotal ? 1 : 0));
        out.unit = unit_text(d);
        draft().measures.push_back(std::move(out));
        return;
    }
    if (!node.from.empty()) {
        out.seen = Seen::kFirings;
        for (const lang::Moment& moment : node.from) {
            Locals locals;
            if (moment.key) {
                error("wrong-form", moment.span, "what is seen stands before `at`",
                      "write `EXPRESSION at TRANSITION`");
                continue;
            }
            const auto transition = moment_of(moment.transition, scope, locals);
            if (!transition) {
                continue;
            }
            Scope inner = scope;
            inner.locals = &locals;
            auto value = seen_value(node.value, inner, share || counts(out.statistic));
            if (value && !out.from.empty() && value->type() != out.from[0].value.type() &&
                value->type().kind != ValueKind::kInt && value->type().kind != ValueKind::kReal) {
                error("wrong-type", moment.span, "what is seen has different types at its firings",
                      "make two measures");
                continue;
            }
            if (value) {
                out.from.push_back({*transition, std::move(*value), true});
            }
        }
        draft().measures.push_back(std::move(out));
        return;
    }
    if (counts(out.statistic)) {
        out.seen = Seen::kFirings;
        std::vector<const lang::Expr*> paths;
        if (!paths_of(node.value, paths)) {
            refuse("what is no firing", "name transitions: `count of leave or lose`");
            return;
        }
        for (const lang::Expr* e : paths) {
            Locals locals;
            if (const auto transition = moment_of(e->path, scope, locals)) {
                out.from.push_back({*transition, {}, false});
            }
        }
        draft().measures.push_back(std::move(out));
        return;
    }
    if (out.statistic == Statistic::kPercentile) {
        refuse("what is there all the time", "say when it is seen: `EXPRESSION at TRANSITION`");
        return;
    }
    auto value = seen_value(node.value, scope, share);
    if (value) {
        out.value = std::move(*value);
        draft().measures.push_back(std::move(out));
    }
}

}  // namespace puppetri::scene
