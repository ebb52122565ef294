// SPDX-License-Identifier: MIT
#include "builtin_rules.h"

#include <algorithm>
#include <map>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/verdict/figure_lowering.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;

// True at each firing that begins a movement of this actor; never, if none does.
Formula moves_of(const net::Net& net, const stage::Play& play, std::uint32_t actor) {
    const net::NetTables& tables = net.tables();
    const auto begins = [&](std::uint32_t place) {
        const net::ActionIndex action = net.action(net::PlaceIndex{place});
        if (!action.valid() || action.value >= play.actions.size()) {
            return false;
        }
        const motion::Subject& subject = play.actions[action.value].call.subject;
        return subject.kind != motion::SubjectKind::kProp && subject.actor.value == actor;
    };
    Formula any = Formula::constant(false);
    bool first = true;
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        bool moves = false;
        for (const net::Weighted& w : tables.gives(t)) {
            moves = moves || begins(w.place);
        }
        const std::uint32_t special = tables.transition[t].special;
        if (special != net::kNoIndex) {
            for (const net::OutputTable& out : tables.specials[special].outputs) {
                moves = moves || begins(out.place);
            }
        }
        if (moves) {
            Formula fires = Formula::fires(net::TransitionIndex{t});
            any = first ? std::move(fires)
                        : Formula::binary(FormulaOp::kOr, std::move(any), std::move(fires));
            first = false;
        }
    }
    return any;
}

Asked asked(const char* path, const char* caption, Question question) {
    Asked a;
    a.rule.path = path;
    a.rule.caption = caption;
    a.rule.kind = net::RuleKind::kDeadlockFree;  // no moment of its own breaks it
    a.question = question;
    a.built_in = true;
    return a;
}

// Places whose tokens name a member of the cast; each is named once at the start.
void add_identities(const net::Net& net, const net::NetDraft& draft, std::vector<Asked>& out) {
    for (const ValueKind kind : {ValueKind::kActor, ValueKind::kProp}) {
        Asked a = asked(
            kind == ValueKind::kActor ? "builtin.one_of_each_actor" : "builtin.one_of_each_prop",
            kind == ValueKind::kActor ? "each actor's token is in exactly one place"
                                      : "each prop's token is in exactly one place",
            Question::kOneOfEach);
        std::vector<Value> named;
        bool clear = true;
        for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
            const net::PlaceDraft& place = draft.places[p];
            const net::PlaceIndex index = net.place_of_draft(net::PlaceIndex{p});
            std::size_t of_kind = 0;
            for (std::uint32_t i = 0; i < place.attributes.size(); ++i) {
                if (place.attributes[i].type.kind != kind) {
                    continue;
                }
                ++of_kind;
                for (const net::InitialToken& token : place.tokens) {
                    for (std::uint32_t k = 0; k < token.count; ++k) {
                        named.push_back(token.attributes[i]);
                    }
                }
                if (std::find(a.places.begin(), a.places.end(), index.value) == a.places.end()) {
                    a.places.push_back(index.value);
                    a.attributes.push_back(i);
                }
            }
            clear = clear && of_kind <= 1;
        }
        std::sort(named.begin(), named.end());
        clear = clear && std::adjacent_find(named.begin(), named.end()) == named.end();
        if (!a.places.empty() && clear) {
            out.push_back(std::move(a));
        }
    }
}

// Computing it may fail: overflow, division by zero, no number.
bool may_fail(const Expr& e) {
    return std::any_of(e.nodes().begin(), e.nodes().end(), [](const Expr::Node& n) {
        switch (n.op) {
            case ExprOp::kLiteral:
            case ExprOp::kSlot:
            case ExprOp::kNot:
            case ExprOp::kLess:
            case ExprOp::kLessEqual:
            case ExprOp::kGreater:
            case ExprOp::kGreaterEqual:
            case ExprOp::kEqual:
            case ExprOp::kNotEqual:
            case ExprOp::kAnd:
            case ExprOp::kOr:
            case ExprOp::kImplies:
            case ExprOp::kIf:
                return false;
            default:
                return true;
        }
    });
}
// A time that is computed may be negative.
bool may_fail(const net::DurationDraft& d) {
    const auto computed = [](const Expr& e) { return !e.is_literal(); };
    return computed(d.a) || computed(d.b) ||
           std::any_of(d.parameters.begin(), d.parameters.end(), computed);
}

// Something in the net can stop a run, beside modules that do not end clean, data that leave their
// ranges, instants without end, and the end of all time.
bool may_stop(const net::NetDraft& draft) {
    for (const net::PlaceDraft& p : draft.places) {
        if ((p.duration && may_fail(*p.duration)) || may_fail(p.key)) {
            return true;
        }
    }
    for (const net::TransitionDraft& t : draft.transitions) {
        const bool fails = (t.guard && may_fail(*t.guard)) || (t.odds && !t.odds->is_literal()) ||
                           (t.delay && may_fail(t.delay->duration)) ||
                           (t.holding && may_fail(*t.holding));
        if (fails || std::any_of(t.assignments.begin(), t.assignments.end(),
                                 [](const net::AssignmentDraft& a) { return may_fail(a.value); })) {
            return true;
        }
        for (const net::OutputDraft& out : t.outputs) {
            if (out.lasts || std::any_of(out.attributes.begin(), out.attributes.end(),
                                         [](const Expr& e) { return may_fail(e); })) {
                return true;
            }
        }
        for (const net::ArcDraft& arc : t.inputs) {
            for (const net::PatternDraft& pattern : arc.pattern) {
                if (may_fail(pattern.equals)) {
                    return true;
                }
            }
        }
    }
    return false;
}

}  // namespace

std::vector<Asked> built_in_rules(const net::Net& net, const net::NetDraft& draft,
                                  const stage::Play* play) {
    std::vector<Asked> out;
    const net::NetTables& tables = net.tables();
    if (!net.paced()) {  // else there is one firing per beat
        out.push_back(
            asked("builtin.time_goes_on", "no instant lasts for ever", Question::kTimeGoesOn));
    }
    if (!tables.refinements.empty()) {
        out.push_back(asked("builtin.modules_end_clean", "nothing is left in a module that ends",
                            Question::kModulesEndClean));
    }
    const std::vector<net::DatumDraft>& data = net.declarations().data;
    if (std::any_of(data.begin(), data.end(),
                    [](const net::DatumDraft& d) { return d.low || d.high; })) {
        out.push_back(
            asked("builtin.data_in_range", "no datum leaves its range", Question::kDataInRange));
    }
    if (may_stop(draft)) {
        out.push_back(
            asked("builtin.nothing_stops", "no run stops with a fault", Question::kNothingStops));
    }
    add_identities(net, draft, out);
    if (play == nullptr) {
        return out;
    }
    for (std::uint32_t a = 0; a < play->cast.actors.size(); ++a) {
        Formula moves = moves_of(net, *play, a);
        if (moves.nodes.size() == 1 && moves.nodes[0].op == FormulaOp::kConstant) {
            continue;  // it never moves, and is not meant to
        }
        Asked freezes;
        freezes.rule.path = "builtin.nobody_freezes." + play->cast.actors[a].name;
        freezes.rule.caption =
            play->cast.actors[a].name + " can always move again, or rests in an end";
        freezes.rule.kind = net::RuleKind::kNobodyFreezes;
        freezes.rule.operands.push_back(std::move(moves));
        freezes.rule.subjects.push_back(play->cast.actors[a].name);
        freezes.built_in = true;
        out.push_back(std::move(freezes));
    }
    for (net::Rule& rule : figure_rules(net, *play)) {
        Asked a;
        a.rule = std::move(rule);
        a.built_in = true;
        out.push_back(std::move(a));
    }
    for (std::uint32_t a = 0; a < play->cast.actors.size(); ++a) {
        const stage::Actor& actor = play->cast.actors[a];
        Formula moves = moves_of(net, *play, a);
        if (!actor.humanoid() ||
            (moves.nodes.size() == 1 && moves.nodes[0].op == FormulaOp::kConstant)) {
            continue;
        }
        Asked joins;
        joins.rule.path = "builtin.movements_join." + actor.name;
        joins.rule.caption = actor.name + " goes from each movement to the next without a jump";
        joins.rule.kind = net::RuleKind::kNever;
        joins.rule.operands.push_back(std::move(moves));  // where they are; not what must not be
        joins.rule.subjects.push_back(actor.name);
        joins.question = Question::kJoins;
        joins.built_in = true;
        out.push_back(std::move(joins));
    }
    return out;
}

bool concerns(Question question, const std::string& code) {
    switch (question) {
        case Question::kTimeGoesOn:
            return code == "endless-instant";
        case Question::kModulesEndClean:
            return code == "module-not-clean";
        case Question::kDataInRange:
            return code == "range-left";
        case Question::kNothingStops:
            return code != "endless-instant" && code != "module-not-clean" && code != "range-left";
        default:
            return false;
    }
}

}  // namespace puppetri::verdict
