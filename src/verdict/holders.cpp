// SPDX-License-Identifier: MIT
#include "holders.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::verdict {

using net::Formula;
using net::FormulaOp;

Formula any_of(std::vector<Formula> parts) {
    if (parts.empty()) {
        return Formula::constant(false);
    }
    Formula out = std::move(parts[0]);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        out = Formula::binary(FormulaOp::kOr, std::move(out), std::move(parts[i]));
    }
    return out;
}

// The places of an invariant that has one token in all and covers these places.
std::optional<std::vector<std::uint32_t>> Holders::one_token(
    const std::set<std::uint32_t>& places) {
    if (!single_) {
        single_.emplace();
        const proof::Plain plain = proof::plain(net_);
        if (!plain.unsound) {
            proof::Budget budget;
            budget.seconds = 0.5;
            budget.states = 5000;
            const std::vector<std::uint8_t> emptied = proof::emptied_places(net_);
            for (const proof::Flow& flow :
                 proof::place_semiflows(plain.net, budget, emptied).flows) {
                const auto total = proof::weighted_tokens(flow, plain.net.initial);
                if (total && *total == 1) {
                    std::vector<std::uint32_t> support;
                    for (const proof::Flow::Term& term : flow.terms) {
                        support.push_back(term.index);
                    }
                    // What counts more than once can never be marked.
                    if (std::all_of(flow.terms.begin(), flow.terms.end(),
                                    [](const proof::Flow::Term& t) { return t.factor == 1; })) {
                        single_->push_back(std::move(support));
                    }
                }
            }
        }
    }
    for (const std::vector<std::uint32_t>& support : *single_) {
        if (std::includes(support.begin(), support.end(), places.begin(), places.end())) {
            return support;
        }
    }
    return std::nullopt;
}

const std::optional<Holders::Way>& Holders::way(std::uint32_t prop) {
    const auto known = ways_.find(prop);
    return known != ways_.end() ? known->second : ways_.emplace(prop, find_way(prop)).first->second;
}

std::optional<Holders::Way> Holders::find_way(std::uint32_t prop) {
    const net::NetTables& tables = net_.tables();
    enum class Does : std::uint8_t { kNothing, kCatches, kThrows, kFlies };
    std::map<std::uint32_t, std::pair<Does, std::string>> changes;  // who: of catches, throws
    std::set<std::uint32_t> changing, to_somebody;
    for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
        const net::ActionIndex action = net_.action(net::PlaceIndex{p});
        if (!action.valid() || action.value >= play_.actions.size()) {
            continue;
        }
        const motion::BoundCall& call = play_.actions[action.value].call;
        if (call.movement == "pick_up" || call.movement == "hand_over" || call.movement == "take" ||
            call.movement == "lay") {
            return std::nullopt;  // the hands change in the middle of it
        }
        const bool flies = call.subject.kind == motion::SubjectKind::kProp;
        const bool catches = call.movement == "catch", throws = call.movement == "throw";
        if (!flies && !catches && !throws) {
            continue;
        }
        std::optional<std::uint32_t> which;
        if (flies) {
            which = call.subject.prop.value;
        } else if (const motion::ArgumentValue* ball = call.find("ball")) {
            if (const auto* index = std::get_if<motion::PropIndex>(ball)) {
                which = index->value;
            }
        }
        if (!which) {
            return std::nullopt;  // a token says which
        }
        if (*which != prop) {
            continue;
        }
        // A release that comes after the token has gone on would take it from the next.
        const std::uint32_t duration = tables.place[p].duration;
        if (throws && (duration == net::kNoIndex ||
                       tables.durations[duration].kind != net::DurationKind::kAuto)) {
            return std::nullopt;
        }
        if (flies) {
            if (call.movement != "fly") {
                return std::nullopt;
            }
            const motion::ArgumentValue* to = call.find("to");
            if (to != nullptr && std::get_if<motion::ActorIndex>(to) != nullptr) {
                to_somebody.insert(p);
            }
        }
        changing.insert(p);
        changes[p] = {
            flies     ? Does::kFlies
            : catches ? Does::kCatches
                      : Does::kThrows,
            flies ? std::string() : play_.cast.actors[call.subject.actor.value].name + ".hands"};
    }
    for (const net::Special& s : tables.specials) {
        for (const net::OutputTable& out : s.outputs) {
            if (out.lasts.valid() && changing.contains(out.place)) {
                return std::nullopt;  // a time of its own
            }
        }
    }
    Way way;
    const stage::Prop& declared = play_.cast.props[prop];
    const std::string at_first = declared.held_by.valid()
                                     ? play_.cast.actors[declared.held_by.value].name + ".hands"
                                     : "floor";
    if (changing.empty()) {
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            way.holders[p] = {at_first};
        }
        return way;
    }
    const auto support = one_token(changing);
    if (!support) {
        return std::nullopt;
    }
    const std::set<std::uint32_t> inside(support->begin(), support->end());
    std::map<std::uint32_t, std::set<std::uint32_t>> next;
    for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
        std::vector<std::uint32_t> from, to;
        for (const net::Weighted& w : tables.takes(t)) {
            from.push_back(w.place);
        }
        for (const net::Weighted& w : tables.gives(t)) {
            to.push_back(w.place);
        }
        const std::uint32_t special = tables.transition[t].special;
        if (special != net::kNoIndex) {
            for (const net::ArcTable& arc : tables.specials[special].arcs) {
                from.push_back(arc.place);  // reads too: ways too many do no harm
            }
            for (const net::OutputTable& out : tables.specials[special].outputs) {
                to.push_back(out.place);
            }
        }
        for (const std::uint32_t a : from) {
            for (const std::uint32_t b : to) {
                if (inside.contains(a) && inside.contains(b)) {
                    next[a].insert(b);
                }
            }
        }
    }
    std::set<std::uint32_t> once_aloft, fell_before;
    std::vector<std::pair<std::uint32_t, std::set<std::string>>> open;
    for (const net::NetTables::Initial& i : tables.initial) {
        if (inside.contains(i.place)) {
            open.push_back({i.place, {at_first}});
        }
    }
    while (!open.empty()) {
        auto [p, before] = std::move(open.back());
        open.pop_back();
        const auto change = changes.find(p);
        std::set<std::string> here = before;
        if (change != changes.end()) {
            switch (change->second.first) {
                case Does::kCatches:
                    here = {change->second.second};
                    way.catches.insert(p);
                    break;
                case Does::kThrows:
                    if (here.contains(change->second.second)) {
                        here.insert("air");  // at its very end
                        once_aloft.insert(p);
                    }
                    break;
                case Does::kFlies:
                    here = {"air"};
                    if (to_somebody.contains(p)) {
                        once_aloft.insert(p);
                    }
                    break;
                case Does::kNothing:
                    break;
            }
        }
        if (here.contains("air")) {
            here.insert("floor");  // what nobody catches falls
        }
        if (before.contains("floor")) {
            fell_before.insert(p);
        }
        std::set<std::string>& known = way.holders[p];
        const std::size_t size = known.size();
        known.insert(here.begin(), here.end());
        if (known.size() == size) {
            continue;
        }
        for (const std::uint32_t to : next[p]) {
            open.push_back({to, known});
        }
    }
    for (const std::uint32_t p : once_aloft) {
        // A throw of what may lie somewhere already says nothing.
        const bool throws = changes.at(p).first == Does::kThrows;
        if (!throws || !fell_before.contains(p)) {
            way.aloft.insert(p);
        }
    }
    return way;
}

// Time does not pass here: the token is taken first.
Formula Holders::goes_on_at_once(std::uint32_t place) const {
    std::vector<Formula> takers;
    for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
        const net::NetTables& tables = net_.tables();
        const auto takes = tables.takes(t);
        bool taker = std::any_of(takes.begin(), takes.end(),
                                 [&](const net::Weighted& w) { return w.place == place; });
        const std::uint32_t special = tables.transition[t].special;
        if (special != net::kNoIndex) {
            const auto& arcs = tables.specials[special].arcs;
            taker = taker || std::any_of(arcs.begin(), arcs.end(), [&](const net::ArcTable& arc) {
                        return arc.place == place && arc.kind == net::ArcKind::kTake;
                    });
        }
        if (taker) {
            takers.push_back(Formula::fireable(net::TransitionIndex{t}));
        }
    }
    return any_of(std::move(takers));
}

Formula Holders::may_hold(std::uint32_t prop, const std::set<std::string>& wanted, bool others) {
    const std::optional<Way>& known = way(prop);
    if (!known) {
        return Formula::constant(true);
    }
    const auto meant = [&](const std::string& who) { return wanted.contains(who) != others; };
    std::vector<Formula> places;
    std::size_t all = 0;
    for (const auto& [p, holders] : known->holders) {
        Formula here = Formula::marked(net::PlaceIndex{p});
        // Before the token is ready, and if it goes on at once, what is aloft has not come down.
        const bool aloft = known->aloft.contains(p);
        bool some = false;
        for (const std::string& who : holders) {
            some = some || (meant(who) && (!aloft || who != "floor"));
        }
        if (some) {
            places.push_back(std::move(here));
            ++all;
        } else if (aloft && meant("floor")) {
            Formula rests = Formula::binary(FormulaOp::kAnd, Formula::ready(net::PlaceIndex{p}),
                                            Formula::unary(FormulaOp::kNot, goes_on_at_once(p)));
            places.push_back(Formula::binary(FormulaOp::kAnd, std::move(here), std::move(rests)));
        }
    }
    // The token is always in one of the places.
    return all == known->holders.size() ? Formula::constant(true) : any_of(std::move(places));
}

std::vector<std::string> Holders::assumptions(std::uint32_t prop) {
    std::vector<std::string> out;
    if (const std::optional<Way>& known = way(prop)) {
        for (const std::uint32_t p : known->catches) {
            out.push_back("place " + std::string(net_.place(net::PlaceIndex{p}).path) + ": " +
                          play_.cast.props[prop].name +
                          " is between the hands when its movement begins");
        }
    }
    return out;
}

}  // namespace puppetri::verdict
