// SPDX-License-Identifier: MIT
// Statements of nets: places, transitions, data, events, instances.
#include "build.h"
#include "puppetri/base/text.h"

namespace puppetri::lang {

bool Builder::once(bool& given, std::uint32_t node) {
    if (given) {
        report_.error(span(first(node)), "repeated-clause", element,
                      "'" + std::string(text(first(node))) + "' is given twice in one statement",
                      "keep one of them");
        return false;
    }
    given = true;
    return true;
}

Parameter Builder::parameter(std::uint32_t node) {
    Parameter out;
    out.name = name(child(node, NodeKind::kName));
    if (const std::uint32_t type = child(node, NodeKind::kType); type != 0) {
        out.type = child_expr(type);
    }
    if (const std::uint32_t value = child(node, NodeKind::kDefault); value != 0) {
        out.default_value = child_expr(value);
    }
    out.span = span(node);
    return out;
}

std::vector<Parameter> Builder::parameters(std::uint32_t parent) {
    std::vector<Parameter> out;
    for (const std::uint32_t c : children(parent)) {
        if (kind(c) == NodeKind::kParameter) {
            out.push_back(parameter(c));
        }
    }
    return out;
}

Binding Builder::binding(std::uint32_t node) {
    return {child_path(node), child_expr(node), span(node)};
}

Arc Builder::arc(std::uint32_t node, ArcKind arc_kind) {
    Arc out;
    out.kind = arc_kind;
    const std::uint32_t first_child = nodes_[node + 1].begin;
    if (nodes_[node].begin < first_child) {
        switch (first(node).kind) {
            case Kind::kNow:
                out.kind = ArcKind::kTakeNow;
                break;
            case Kind::kAll:
                out.kind =
                    nodes_[node].begin + 1 < first_child ? ArcKind::kTakeAllNow : ArcKind::kTakeAll;
                break;
            default:
                out.kind = ArcKind::kUnlessReady;
                break;
        }
    }
    for (const std::uint32_t c : children(node)) {
        switch (kind(c)) {
            case NodeKind::kWeight:
                out.weight = operand(c + 1).expr;
                break;
            case NodeKind::kBinding:
                out.pattern.push_back(binding(c));
                break;
            default:
                out.place = path(c);
        }
    }
    out.span = span(node);
    if ((out.kind == ArcKind::kTakeAll || out.kind == ArcKind::kTakeAllNow) && out.weight) {
        report_.error(out.weight.span, "misplaced-weight", element,
                      "'all' takes however many there are",
                      "leave the weight out, or leave 'all' out");
    }
    return out;
}

Duration Builder::duration(std::uint32_t node) {
    Duration out;
    out.span = span(node);
    const std::uint32_t value = child(node, NodeKind::kExpr);
    if (value != 0) {
        out.kind = DurationKind::kValue;
        out.value = expr(value);
    } else if (const std::uint32_t as = child(node, NodeKind::kPath); as != 0) {
        out.kind = DurationKind::kAs;
        out.as = path(as);
    } else {
        out.kind = token(node, 1).kind == Kind::kAuto ? DurationKind::kAuto : DurationKind::kOpen;
    }
    return out;
}

std::vector<InitialTokens> Builder::initial_tokens(std::uint32_t node) {
    std::vector<InitialTokens> out;
    for (const std::uint32_t group : children(node)) {
        InitialTokens tokens;
        tokens.count = child_expr(group);
        for (const std::uint32_t c : children(group)) {
            if (kind(c) == NodeKind::kBinding) {
                tokens.attributes.push_back(binding(c));
            }
        }
        tokens.ready = has_token(group, Kind::kReady);
        tokens.span = span(group);
        out.push_back(std::move(tokens));
    }
    return out;
}

void Builder::place_clause(std::uint32_t node, Place& out) {
    const auto call = [&](const char* example) {
        Expr e = child_expr(node);
        if (e.kind != ExprKind::kCall && e.kind != ExprKind::kPath) {
            report_.error(e.span, "syntax", element, "a call is wanted here",
                          std::string("write ") + example);
        }
        return e;
    };
    switch (first(node).kind) {
        case Kind::kDoes:
            out.does = call("does ana.step(left)");
            break;
        case Kind::kRuns:
            out.runs = call("runs walk(ana)");
            break;
        case Kind::kTakes:
            out.takes = duration(node);
            break;
        case Kind::kTokens:
            out.tokens = initial_tokens(node);
            break;
        case Kind::kHolds:
            out.capacity = child_expr(node);
            break;
        case Kind::kKeeps:
            out.keeps_order = true;
            break;
        case Kind::kIs:
            out.same_as = child_path(node);
            break;
        case Kind::kStarts:
            out.starts = true;
            break;
        case Kind::kFinal:
            out.final = true;
            break;
        case Kind::kOf:
            out.of_type = child_path(node);
            out.attributes = parameters(node);
            break;
        default:
            switch (token(node, 1).kind) {
                case Kind::kOldest:
                    out.discipline = Discipline::kOldest;
                    break;
                case Kind::kFirst:
                    out.discipline = Discipline::kOldest;
                    out.by_arrival = true;
                    break;
                case Kind::kNewest:
                    out.discipline = Discipline::kNewest;
                    break;
                case Kind::kLast:
                    out.discipline = Discipline::kNewest;
                    out.by_arrival = true;
                    break;
                case Kind::kLeast:
                    out.discipline = Discipline::kLeast;
                    break;
                case Kind::kMost:
                    out.discipline = Discipline::kMost;
                    break;
                default:
                    out.discipline = Discipline::kAny;
            }
            out.discipline_key = child_expr(node);
            out.by_arrival = out.by_arrival || has_token(node, Kind::kFirst);
    }
}

Place Builder::place(std::uint32_t node) {
    Place out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.is_public = has_token(node, Kind::kPublic);
    out.role = has_token(node, Kind::kStart)    ? Role::kStart
               : has_token(node, Kind::kFinish) ? Role::kFinish
                                                : Role::kInner;
    out.span = span(node);
    std::array<bool, 256> given{};
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == NodeKind::kClause &&
            once(given[static_cast<std::size_t>(first(c).kind)], c)) {
            place_clause(c, out);
        }
    }
    if (out.does && out.runs) {
        report_.error(out.runs.span, "conflicting-clauses", element,
                      "a place cannot both do a movement and run a net",
                      "use two places, or let the net do the movement");
    }
    return out;
}

void Builder::transition_clause(std::uint32_t node, Transition& out) {
    const auto arcs = [&](ArcKind arc_kind) {
        for (const std::uint32_t c : children(node)) {
            out.tests.push_back(arc(c, arc_kind));
        }
    };
    const auto paths = [&](std::vector<Path>& to) {
        for (const std::uint32_t c : children(node)) {
            to.push_back(path(c));
        }
    };
    switch (first(node).kind) {
        case Kind::kPriority:
            out.priority = child_expr(node);
            break;
        case Kind::kWhen:
            out.guard = child_expr(node);
            break;
        case Kind::kWith:
            arcs(ArcKind::kWith);
            break;
        case Kind::kWhile:
            arcs(ArcKind::kWhile);
            break;
        case Kind::kUnless:
            arcs(ArcKind::kUnless);
            break;
        case Kind::kOn:
            out.next_event = nodes_[node].begin + 1 < nodes_[node + 1].begin;
            paths(out.events);
            break;
        case Kind::kAfter:
            out.delay = child_expr(node);
            break;
        case Kind::kMemory:
            out.memory = token(node, 1).kind == Kind::kAge        ? Memory::kAge
                         : token(node, 1).kind == Kind::kResample ? Memory::kResample
                                                                  : Memory::kEnabling;
            break;
        case Kind::kServers:
            if (const std::uint32_t count = child(node, NodeKind::kExpr); count != 0) {
                out.servers = expr(count);
            } else if (token(node, 1).kind == Kind::kInfinite) {
                out.servers.kind = ExprKind::kPath;
                out.servers.path.steps.push_back({"infinite", {}, span(token(node, 1))});
                out.servers.path.span = out.servers.span = span(token(node, 1));
            } else {
                out.servers.kind = ExprKind::kNumber;
                out.servers.number = Rational{1};
                out.servers.span = span(token(node, 1));
            }
            break;
        case Kind::kFor:
            out.holding = child_expr(node);
            out.holding_left = !out.holding;
            break;
        case Kind::kSet:
            for (const std::uint32_t c : children(node)) {
                out.assignments.push_back(binding(c));
            }
            break;
        case Kind::kOdds:
            out.odds = child_expr(node);
            break;
        case Kind::kRaises:
            paths(out.raises);
            break;
        case Kind::kSend:
            out.send = child_path(node);
            out.message = child_expr(node);
            break;
        case Kind::kReceive:
            out.receive = child_path(node);
            out.received = child_expr(node);
            break;
        case Kind::kPoll:
            out.poll = child_expr(node);
            break;
        default:
            paths(out.together_with);
    }
}

Transition Builder::transition(std::uint32_t node) {
    Transition out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.is_public = has_token(node, Kind::kPublic);
    out.span = span(node);
    for (const std::uint32_t c : children(child(node, NodeKind::kInputs))) {
        out.inputs.push_back(arc(c, ArcKind::kTake));
    }
    for (const std::uint32_t c : children(child(node, NodeKind::kOutputs))) {
        out.outputs.push_back(arc(c, ArcKind::kGive));
    }
    std::array<bool, 256> given{};
    std::uint32_t memory = 0, servers = 0;
    for (const std::uint32_t c : children(node)) {
        if (kind(c) != NodeKind::kClause) {
            continue;
        }
        const Kind which = first(c).kind;
        // Tests add: `unless A unless ready B with C` is three of them.
        const bool adds = which == Kind::kWith || which == Kind::kWhile || which == Kind::kUnless;
        if (adds || once(given[static_cast<std::size_t>(which)], c)) {
            transition_clause(c, out);
        }
        memory = which == Kind::kMemory ? c : memory;
        servers = which == Kind::kServers ? c : servers;
    }
    if (!out.send.empty() && !out.receive.empty()) {
        report_.error(out.receive.span, "conflicting-clauses", element,
                      "a transition either sends or receives",
                      "use two transitions, with a state between them");
    }
    if (out.poll && !out.events.empty()) {
        report_.error(out.poll.span, "conflicting-clauses", element,
                      "'poll' waits for an instant of its own, and 'on' for an event",
                      "keep one of them");
    }
    for (const std::uint32_t c : {memory, servers}) {
        if (c != 0 && !out.delay) {
            report_.error(span(c), "conflicting-clauses", element,
                          "'" + std::string(text(first(c))) +
                              "' says how a delay behaves, and there is no delay",
                          "add: after 1 s");
        }
    }
    return out;
}

State Builder::state(std::uint32_t node) {
    return {name(child(node, NodeKind::kName)), caption(node), has_token(node, Kind::kPublic),
            child_expr(node), span(node)};
}

Channel Builder::channel(std::uint32_t node) {
    const std::uint32_t type = child(node, NodeKind::kType);
    return {name(child(node, NodeKind::kName)), caption(node), has_token(node, Kind::kPublic),
            type != 0 ? child_expr(type) : Expr{}, span(node)};
}

Data Builder::data(std::uint32_t node) {
    Data out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.is_public = has_token(node, Kind::kPublic);
    out.type = child_expr(child(node, NodeKind::kType));
    if (const std::uint32_t value = child(node, NodeKind::kDefault); value != 0) {
        out.initial = child_expr(value);
    }
    out.span = span(node);
    return out;
}

Enumeration Builder::enumeration(std::uint32_t node) {
    return {name(child(node, NodeKind::kName)), {}, span(node)};
}

Name Builder::enum_value(std::uint32_t node) { return name(child(node, NodeKind::kName)); }

TokenType Builder::token_type(std::uint32_t node) {
    return {name(child(node, NodeKind::kName)), parameters(node), span(node)};
}

Event Builder::event(std::uint32_t node) {
    Event out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.is_public = has_token(node, Kind::kPublic);
    out.is_consumed = has_token(node, Kind::kConsumed);
    out.span = span(node);
    for (const std::uint32_t c : children(node)) {
        if (kind(c) != NodeKind::kClause) {
            continue;
        }
        switch (first(c).kind) {
            case Kind::kAt:
                for (const std::uint32_t time : children(c)) {
                    out.at.push_back(expr(time));
                }
                break;
            case Kind::kEvery:
                out.every = child_expr(c);
                break;
            case Kind::kFrom:
                out.from = child_expr(c);
                break;
            default:
                out.until = child_expr(c);
        }
    }
    return out;
}

EventFile Builder::event_file(std::uint32_t node) {
    return {quoted(first(child(node, NodeKind::kString))), span(node)};
}

Use Builder::use(std::uint32_t node) {
    Use out;
    if (const std::uint32_t file = child(node, NodeKind::kString); file != 0) {
        out.path = quoted(first(file));
        out.net.span = span(file);
        out.net.steps.push_back({std::string(stem_of(out.path)), {}, span(file)});
    } else {
        out.net = child_path(node);
    }
    std::uint32_t depth = 0;
    if (const std::uint32_t given = child(node, NodeKind::kArguments); given != 0) {
        out.args = arguments(given, depth);
    }
    const std::uint32_t as = child(node, NodeKind::kName);
    out.name = as != 0 ? name(as) : out.net.steps.back();
    out.span = span(node);
    return out;
}

}  // namespace puppetri::lang
