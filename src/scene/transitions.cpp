// SPDX-License-Identifier: MIT
// Transitions: arcs with their patterns and variables, clauses, and rendezvous.
#include "elaboration.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

constexpr const char* kLeft = "left";  // `now P(left = r)`, `-> Q(left = r)`

net::ArcKind kind_of(lang::ArcKind kind) {
    switch (kind) {
        case lang::ArcKind::kTakeNow:
            return net::ArcKind::kTakeNow;
        case lang::ArcKind::kTakeAll:
            return net::ArcKind::kTakeAll;
        case lang::ArcKind::kTakeAllNow:
            return net::ArcKind::kTakeAllNow;
        case lang::ArcKind::kWith:
            return net::ArcKind::kRead;
        case lang::ArcKind::kWhile:
            return net::ArcKind::kReadNow;
        case lang::ArcKind::kUnless:
            return net::ArcKind::kUnless;
        case lang::ArcKind::kUnlessReady:
            return net::ArcKind::kUnlessReady;
        default:
            return net::ArcKind::kTake;
    }
}

// The variable `name` of the transition; made if need be.
std::uint32_t variable(Locals& locals, const std::string& name, ValueType type) {
    for (std::size_t i = 0; i < locals.names.size(); ++i) {
        if (locals.names[i].name == name) {
            return static_cast<std::uint32_t>(i);
        }
    }
    locals.names.push_back({name, type});
    return static_cast<std::uint32_t>(locals.names.size() - 1);
}

// A name alone, without index: `d` in `due = d`.
const lang::Name* single_name(const lang::Expr& e) {
    return e.kind == lang::ExprKind::kPath && e.path.steps.size() == 1 &&
                   e.path.steps[0].index.empty()
               ? &e.path.steps[0]
               : nullptr;
}

}  // namespace

void Elaboration::complete_transitions() {
    for (std::size_t i = 0; i < transitions_.size(); ++i) {
        About about(*this, "transition " + transitions_[i].path, transitions_[i].node->span);
        complete_transition(i);
    }
    complete_rendezvous();
}

void Elaboration::bind_patterns(const lang::Arc& arc, Locals& locals, const Scope& scope,
                                net::ArcDraft& out) {
    const net::PlaceDraft& place = draft().places[out.place.value];
    std::vector<std::string> known;
    for (const net::AttributeDraft& a : place.attributes) {
        known.push_back(a.name);
    }
    for (const lang::Binding& b : arc.pattern) {
        const std::string name = attribute_name(b.name);
        const lang::Name* single = single_name(b.value);
        if (name == kLeft && out.kind == net::ArcKind::kTakeNow && single != nullptr) {
            out.time_left = variable(locals, single->text, {ValueKind::kTime});
            continue;
        }
        std::size_t i = 0;
        while (i < known.size() && known[i] != name) {
            ++i;
        }
        if (i == known.size()) {
            unknown(b.name.span, "attribute of " + place.path, name, known);
            continue;
        }
        net::PatternDraft pattern{.attribute = static_cast<std::uint32_t>(i)};
        const ValueType type = place.attributes[i].type;
        bool is_variable = false;
        if (single != nullptr) {
            for (const net::VariableDraft& v : locals.names) {
                is_variable = is_variable || v.name == single->text;
            }
            is_variable = is_variable || !resolve_first(*single, scope);
        }
        if (is_variable) {
            pattern.binds = variable(locals, single->text, type);
            if (locals.names[*pattern.binds].type != type) {
                error("wrong-type", b.value.span,
                      single->text + " was bound to a value of another type before",
                      "use another name");
                continue;
            }
        } else {
            auto value = expr_of(b.value, scope, type);
            if (!value) {
                continue;
            }
            pattern.equals = std::move(*value);
        }
        out.pattern.push_back(std::move(pattern));
    }
}

void Elaboration::complete_arcs(std::size_t index, Locals& locals) {
    const Element<lang::Transition>& t = transitions_[index];
    Scope scope = t.scope;
    scope.locals = &locals;
    const auto weight_of = [&](const lang::Arc& arc) {
        return arc.weight
                   ? constant_integer(arc.weight, t.scope, "the weight of an arc").value_or(1)
                   : 1;
    };
    for (const std::vector<lang::Arc>* arcs : {&t.node->inputs, &t.node->tests}) {
        for (const lang::Arc& arc : *arcs) {
            const auto place = place_of(arc.place, t.scope);
            const std::int64_t weight = weight_of(arc);
            if (!place) {
                continue;
            }
            net::ArcDraft out{.kind = kind_of(arc.kind),
                              .place = *place,
                              .weight = weight,
                              .where = at(arc.span)};
            bind_patterns(arc, locals, scope, out);
            draft().transitions[index].inputs.push_back(std::move(out));
        }
    }
    // `for left`: what was still to wait goes on in the new places.
    std::optional<Expr> left;
    if (t.node->holding_left) {
        for (net::ArcDraft& arc : draft().transitions[index].inputs) {
            if (arc.kind == net::ArcKind::kTakeNow && !left) {
                if (!arc.time_left) {
                    arc.time_left = variable(locals, kLeft, {ValueKind::kTime});
                }
                left = Expr::slot(net::slot(net::SlotKind::kVariable, *arc.time_left),
                                  {ValueKind::kTime});
            }
        }
        if (!left) {
            error("left-without-now", t.node->span, "`for left` needs a token that is taken `now`",
                  "write `now` before an input place");
        }
    }
    for (const lang::Arc& arc : t.node->outputs) {
        const auto place = place_of(arc.place, t.scope);
        const std::int64_t weight = weight_of(arc);
        if (!place) {
            continue;
        }
        net::OutputDraft out{
            .place = *place, .weight = weight, .lasts = left, .where = at(arc.span)};
        auto attributes = bind_attributes(arc.pattern, *place, scope, arc.span, kLeft);
        if (attributes) {
            out.attributes = std::move(*attributes);
        }
        for (const lang::Binding& b : arc.pattern) {
            if (lang::to_text(b.name) == kLeft) {
                out.lasts = expr_of(b.value, scope, {ValueKind::kTime});
            }
        }
        draft().transitions[index].outputs.push_back(std::move(out));
    }
}

void Elaboration::complete_transition(std::size_t index) {
    const lang::Transition& node = *transitions_[index].node;
    const Scope& outer = transitions_[index].scope;
    Locals locals;
    complete_arcs(index, locals);
    Scope scope = outer;
    scope.locals = &locals;
    net::TransitionDraft& out = draft().transitions[index];
    if (node.priority) {
        out.priority = constant_integer(node.priority, outer, "a priority").value_or(1);
    }
    if (node.guard) {
        out.guard = expr_of(node.guard, scope, {ValueKind::kBool});
    }
    if (node.odds) {
        if (auto odds = as_expr(evaluate(node.odds, scope), node.odds.span)) {
            out.odds = std::move(*odds);
        }
    }
    for (const lang::Path& path : node.events) {
        const Term term = resolve(path, outer);
        if (const auto* e = std::get_if<EventTerm>(&term)) {
            out.events.push_back(e->event);
        } else {
            wrong(path.span, "an event", term);
        }
    }
    out.next_event = node.next_event;
    for (const lang::Path& path : node.raises) {
        const Term term = resolve(path, outer);
        if (const auto* e = std::get_if<EventTerm>(&term)) {
            out.raises.push_back(e->event);
        } else {
            wrong(path.span, "an event", term);
        }
    }
    if (node.delay) {
        net::DelayDraft delay{.duration = duration_of(node.delay, scope)};
        switch (node.memory) {
            case lang::Memory::kDefault:
            case lang::Memory::kEnabling:
                break;
            case lang::Memory::kAge:
                delay.memory = net::DelayMemory::kAge;
                break;
            case lang::Memory::kResample:
                delay.memory = net::DelayMemory::kResample;
                break;
        }
        if (node.servers) {
            const lang::Name* word = single_name(node.servers);
            if (word != nullptr && word->text == "infinite") {
                delay.servers = net::DelayDraft::kInfiniteServers;
            } else if (const auto k =
                           constant_integer(node.servers, outer, "the number of servers")) {
                if (*k < 1 || *k > 1'000'000'000) {
                    error("out-of-range", node.servers.span, "there is at least one server",
                          "write 1 or more");
                } else {
                    delay.servers = static_cast<std::uint32_t>(*k);
                }
            }
        }
        out.delay = std::move(delay);
    }
    if (node.holding) {
        out.holding = duration_of(node.holding, scope);
    }
    for (const lang::Binding& b : node.assignments) {
        const Term term = resolve(b.name, outer);
        const auto* datum = std::get_if<DatumTerm>(&term);
        if (datum == nullptr) {
            wrong(b.name.span, "data", term);
            evaluate(b.value, scope);  // its defects, too
            continue;
        }
        if (auto value = expr_of(b.value, scope, draft().data[datum->datum.value].type)) {
            out.assignments.push_back({datum->datum, std::move(*value), at(b.span)});
        }
    }
    out.variables = std::move(locals.names);
}

void Elaboration::complete_rendezvous() {
    // Groups of transitions that name each other, in any direction.
    std::vector<std::uint32_t> group(transitions_.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) {
        group[i] = i;
    }
    const auto root = [&](std::uint32_t i) {
        while (group[i] != i) {
            i = group[i];
        }
        return i;
    };
    for (std::uint32_t i = 0; i < transitions_.size(); ++i) {
        const lang::Transition& node = *transitions_[i].node;
        About about(*this, "transition " + transitions_[i].path, node.span);
        for (const lang::Path& path : node.together_with) {
            const Term term = resolve(path, transitions_[i].scope);
            if (const auto* t = std::get_if<TransitionTerm>(&term)) {
                const std::uint32_t a = root(i), b = root(t->transition.value);
                group[a < b ? b : a] = a < b ? a : b;
            } else {
                wrong(path.span, "a transition", term);
            }
        }
    }
    std::map<std::uint32_t, std::vector<net::TransitionIndex>> groups;
    for (std::uint32_t i = 0; i < group.size(); ++i) {
        groups[root(i)].push_back({i});
    }
    for (auto& [first, members] : groups) {
        if (members.size() > 1) {
            draft().rendezvous.push_back(std::move(members));
        }
    }
}

}  // namespace puppetri::scene
