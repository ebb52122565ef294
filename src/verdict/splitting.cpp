// SPDX-License-Identifier: MIT
#include "splitting.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/proof/slice.h"
#include "puppetri/verdict/figure_lowering.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {
namespace {

// The lowered draft numbers places and transitions as the net does.
bool same_numbers(const net::NetDraft& lowered, const net::Net& net) {
    if (lowered.places.size() != net.place_count() ||
        lowered.transitions.size() != net.transition_count()) {
        return false;
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (lowered.places[p].path != net.place(net::PlaceIndex{p}).path) {
            return false;
        }
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (lowered.transitions[t].path != net.transition(net::TransitionIndex{t}).path) {
            return false;
        }
    }
    return true;
}

}  // namespace

Splitting::Splitting(const net::Net& net, const net::NetDraft& draft, const stage::Play* play,
                     const std::vector<const Asked*>& rules)
    : net_(&net), play_(play) {
    parts_.count = 1;
    auto lowered = net::lower(draft);
    if (!lowered || !same_numbers(*lowered, net)) {
        return;
    }
    lowered_ = std::move(*lowered);
    parts_ = proof::components(lowered_);
    std::vector<std::uint32_t> to(parts_.count);
    for (std::uint32_t i = 0; i < parts_.count; ++i) {
        to[i] = i;
    }
    const auto root = [&](std::uint32_t i) {
        while (to[i] != i) {
            i = to[i] = to[to[i]];
        }
        return i;
    };
    const auto join = [&](const std::vector<std::uint32_t>& list) {
        for (const std::uint32_t i : list) {
            to[root(i)] = root(list[0]);
        }
    };
    Asked ends;
    for (const net::NetTables::FinalMarking& f : net.tables().finals) {
        ends.rule.operands.push_back(f.condition);
    }
    const std::vector<std::uint32_t> of_ends = read_by(ends);
    join(of_ends);
    for (const Asked* asked : rules) {
        if (reads_everything(*asked)) {
            continue;
        }
        std::vector<std::uint32_t> read = read_by(*asked);
        // Who rests in an end is not frozen.
        if (asked->rule.kind == net::RuleKind::kNobodyFreezes) {
            read.insert(read.end(), of_ends.begin(), of_ends.end());
        }
        join(read);
    }
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> number(parts_.count, kNone);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < parts_.count; ++i) {
        if (root(i) == i) {
            number[i] = count++;
        }
    }
    for (std::uint32_t& p : parts_.of_place) {
        p = number[root(p)];
    }
    for (std::uint32_t& t : parts_.of_transition) {
        t = number[root(t)];
    }
    for (std::uint32_t& d : parts_.of_datum) {
        d = number[root(d)];
    }
    for (std::uint32_t& e : parts_.of_event) {
        e = number[root(e)];
    }
    parts_.count = count;
}

std::vector<Splitting::Group> Splitting::groups(const std::vector<const Asked*>& rules) const {
    std::vector<Group> of_part(count());
    Group everywhere;
    for (std::uint32_t i = 0; i < rules.size(); ++i) {
        const std::vector<std::uint32_t> read =
            count() <= 1 ? std::vector<std::uint32_t>() : read_by(*rules[i]);
        (read.size() == 1 ? of_part[read[0]] : everywhere).rules.push_back(i);
    }
    std::vector<Group> out;
    for (std::uint32_t p = 0; p < count(); ++p) {
        if (!of_part[p].rules.empty()) {
            of_part[p].part = p;
            out.push_back(std::move(of_part[p]));
        }
    }
    if (!everywhere.rules.empty()) {
        out.push_back(std::move(everywhere));
    }
    return out;
}

bool Splitting::reads_everything(const Asked& asked) {
    return (asked.question != Question::kRule && asked.question != Question::kJoins) ||
           reads_whole_net(asked.rule);
}

bool Splitting::one_is_enough(const Asked& asked) {
    return asked.question == Question::kRule && asked.rule.kind == net::RuleKind::kDeadlockFree;
}

bool Splitting::splits(const Asked& asked) {
    if (asked.question == Question::kOneOfEach || asked.question == Question::kJoins) {
        return false;
    }
    if (asked.question != Question::kRule) {
        return true;
    }
    switch (asked.rule.kind) {
        case net::RuleKind::kDeadlockFree:
        case net::RuleKind::kEnds:
            return true;
        case net::RuleKind::kLive:
        case net::RuleKind::kQuasiLive:
            return asked.rule.transitions.empty();
        case net::RuleKind::kBounded:
            return asked.rule.operands.empty();
        default:
            return false;
    }
}

net::NetDraft Splitting::draft_of(std::uint32_t part, const std::vector<net::Rule>& rules) const {
    return proof::component(lowered_, parts_, part, rules).draft;
}

std::vector<std::uint32_t> Splitting::read_by(const Asked& asked) const {
    std::vector<std::uint32_t> out;
    if (reads_everything(asked)) {
        return out;
    }
    const proof::SliceRoots roots = proof::roots_of(asked.rule);
    for (const std::uint32_t p : roots.places) {
        out.push_back(parts_.of_place[p]);
    }
    for (const std::uint32_t t : roots.transitions) {
        out.push_back(parts_.of_transition[t]);
    }
    // Whoever reads data, events or figures is left with the whole net unless places say more.
    if (!roots.data.empty() || !roots.events.empty()) {
        for (std::uint32_t t = 0; t < parts_.of_transition.size(); ++t) {
            out.push_back(parts_.of_transition[t]);
        }
    }
    for (const net::Formula& f : asked.rule.operands) {
        for (const net::Formula::Node& n : f.nodes) {
            if (n.op == net::FormulaOp::kHost) {
                add_figures(n.index, out);
            }
        }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// All parts with movements of the actor or the prop that the atom speaks of.
void Splitting::add_figures(std::uint32_t atom, std::vector<std::uint32_t>& out) const {
    const std::vector<net::HostAtom>& atoms = net_->declarations().host_atoms;
    if (play_ == nullptr || atom >= atoms.size()) {
        return;
    }
    for (std::uint32_t p = 0; p < net_->place_count(); ++p) {
        const net::ActionIndex action = net_->action(net::PlaceIndex{p});
        if (!action.valid() || action.value >= play_->actions.size()) {
            continue;
        }
        const motion::BoundCall& call = play_->actions[action.value].call;
        const bool prop = call.subject.kind == motion::SubjectKind::kProp;
        const std::string& who = prop ? play_->cast.props[call.subject.prop.value].name
                                      : play_->cast.actors[call.subject.actor.value].name;
        const motion::PropIndex claimed = claimed_prop(call);
        if (atoms[atom].subject.starts_with(who + ".") || atoms[atom].subject == who ||
            (claimed.valid() && atoms[atom].kind == net::HostAtom::Kind::kHolder)) {
            out.push_back(parts_.of_place[p]);
        }
    }
}

}  // namespace puppetri::verdict
