// SPDX-License-Identifier: MIT
// Liveness with time by theorem, against all runs with exact time (timed_exact.h).
// Longer: PUP_TIMED_LIVENESS_ROUNDS=20000.
#include <doctest/doctest.h>

#include <cstdlib>

#include "net/maker.h"
#include "puppetri/proof/structural_liveness.h"
#include "puppetri/proof/timed_exact.h"
#include "small_nets.h"

using namespace puppetri;
using namespace puppetri::proof;
using puppetri::proof::test::Chance;

namespace {

int rounds(int usual) {
    const char* text = std::getenv("PUP_TIMED_LIVENESS_ROUNDS");
    return text != nullptr ? std::atoi(text) : usual;
}

// A free choice net, nearly always bounded, with durations, delays and priorities that sometimes
// spoil the choice.
net::NetDraft random_draft(Chance& chance) {
    net::Maker m;
    const std::uint32_t clusters = 2 + chance.below(3);
    std::vector<std::vector<std::string>> places(clusters);
    std::vector<std::string> all;
    for (std::uint32_t c = 0; c < clusters; ++c) {
        const std::uint32_t size = chance.one_in(3) ? 2 : 1;
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::string name = "p" + std::to_string(all.size());
            const std::uint32_t tokens = chance.one_in(2) ? 1 : 0;
            if (chance.one_in(4)) {
                m.place(name, tokens);
            } else {
                m.place(name, tokens, net::lasts(1 + chance.below(2)));
            }
            places[c].push_back(name);
            all.push_back(name);
        }
    }
    std::uint32_t t = 0;
    std::vector<std::string> unfed = all;
    for (std::uint32_t c = 0; c < clusters; ++c) {
        const std::uint32_t choices = chance.one_in(2) ? 2 : 1;
        for (std::uint32_t i = 0; i < choices; ++i) {
            std::vector<std::string> outputs;
            for (std::size_t k = 0; k < places[c].size(); ++k) {
                const bool feed = !unfed.empty() && !chance.one_in(4);
                const std::uint32_t at =
                    chance.below(static_cast<std::uint32_t>(feed ? unfed.size() : all.size()));
                outputs.push_back(feed ? unfed[at] : all[at]);
                if (feed) {
                    unfed.erase(unfed.begin() + at);
                }
            }
            net::TransitionDraft& draft = m.t("t" + std::to_string(t++), places[c], outputs);
            if (chance.one_in(6)) {
                draft.delay = net::DelayDraft{net::lasts(1)};
            }
            draft.priority = chance.one_in(8) ? 2 : 1;
            if (chance.one_in(12)) {
                draft.inputs.push_back(
                    m.arc("while " + all[chance.below(static_cast<std::uint32_t>(all.size()))]));
            }
            if (chance.one_in(16)) {
                draft.inputs.push_back(
                    m.arc("unless 2*" + all[chance.below(static_cast<std::uint32_t>(all.size()))]));
            }
        }
    }
    return m.draft;
}

bool all_live(const Graph& graph, std::uint32_t transitions) {
    for (std::uint32_t t = 0; t < transitions; ++t) {
        std::vector<std::uint8_t> can(graph.size(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t s = 0; s < graph.size(); ++s) {
                for (const Edge& e : graph.edges.row(s)) {
                    if (can[s] == 0 && (e.label == t || can[e.target] != 0)) {
                        can[s] = 1;
                        changed = true;
                    }
                }
            }
        }
        if (std::find(can.begin(), can.end(), 0) != can.end()) {
            return false;
        }
    }
    return true;
}

// A cycle in which no time passes.
bool instant_may_never_end(const Graph& graph) {
    std::vector<std::uint8_t> endless(graph.size(), 1);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::uint32_t s = 0; s < graph.size(); ++s) {
            bool goes_on = false;
            for (const Edge& e : graph.edges.row(s)) {
                goes_on = goes_on || (e.label != Edge::kPass && endless[e.target] != 0);
            }
            if (endless[s] != 0 && !goes_on) {
                endless[s] = 0;
                changed = true;
            }
        }
    }
    return std::find(endless.begin(), endless.end(), 1) != endless.end();
}

}  // namespace

TEST_CASE("what is live in time by theorem is live in the graph of all timed runs [law]") {
    Chance chance(101);
    int live = 0, not_claimed = 0;
    for (int round = 0; round < rounds(1500); ++round) {
        const auto net = net::compile(random_draft(chance));
        if (!net) {
            continue;
        }
        const TimedLiveness answer = timed_liveness(*net, {});
        if (!answer.live_unless_stopped) {
            ++not_claimed;
            continue;
        }
        Budget budget;
        budget.states = 3000;
        const TimedGraph timed = timed_exact_graph({.net = *net, .budget = budget});
        if (timed.graph.ended != Ended::kDone || !timed.stops.empty()) {
            CHECK((timed.graph.ended != Ended::kDone || !answer.live));
            continue;
        }
        if (!answer.live && instant_may_never_end(timed.graph)) {
            continue;
        }
        CAPTURE(answer.theorem);
        CAPTURE(answer.live);
        CHECK(all_live(timed.graph, net->transition_count()));
        ++live;
    }
    CHECK(live > 30);
    CHECK(not_claimed > 100);
}

TEST_CASE("where every circuit takes time no instant goes round [law]") {
    Chance chance(102);
    int ends = 0, goes_round = 0;
    for (int round = 0; round < rounds(1000); ++round) {
        const auto net = net::compile(random_draft(chance));
        if (!net) {
            continue;
        }
        Budget budget;
        budget.states = 300;
        const TimedGraph timed = timed_exact_graph({.net = *net, .budget = budget});
        const bool endless = instant_may_never_end(timed.graph);
        CHECK_FALSE((endless && instants_end(*net)));
        (endless ? goes_round : ends) += instants_end(*net) || endless ? 1 : 0;
    }
    CHECK(ends > 50);
    CHECK(goes_round > 20);
}

TEST_CASE("a delay or a priority in a choice forbids the theorem, elsewhere it does not [unit]") {
    net::Maker m;
    m.place("a", 1, net::lasts(1));
    m.place("b", 0, net::lasts(1));
    m.t("t", {"a"}, {"b"});
    m.t("u", {"a"}, {"b"});
    m.t("v", {"b"}, {"a"});
    CHECK(timed_liveness(m.net(), {}).live);
    m.draft.transitions[2].delay = net::DelayDraft{net::lasts(2)};
    m.draft.transitions[2].priority = 5;
    CHECK(timed_liveness(m.net(), {}).live);
    m.draft.transitions[0].delay = net::DelayDraft{net::lasts(2)};
    CHECK_FALSE(timed_liveness(m.net(), {}).live_unless_stopped);
    m.draft.transitions[0].delay.reset();
    m.draft.transitions[0].priority = 2;
    CHECK_FALSE(timed_liveness(m.net(), {}).live_unless_stopped);
    m.draft.transitions[0].priority = 1;
    m.draft.places[0].duration = net::of_kind(net::DurationKind::kOpen);
    CHECK_FALSE(timed_liveness(m.net(), {}).live_unless_stopped);
}

TEST_CASE("a circuit without time is live only if time goes on [unit]") {
    net::Maker m;
    m.place("a", 1);
    m.place("b", 0, net::lasts(1));
    m.t("t", {"a"}, {"b"});
    m.t("v", {"b"}, {"a"});
    CHECK(timed_liveness(m.net(), {}).live);
    m.t("w", {"b"}, {"b"});
    CHECK(timed_liveness(m.net(), {}).live);
    m.t("x", {"a"}, {"a"});
    const TimedLiveness answer = timed_liveness(m.net(), {});
    CHECK_FALSE(answer.live);
    CHECK(answer.live_unless_stopped);
    CHECK(answer.needs_time_goes_on);
}

TEST_CASE(
    "a hundred players in a ring pass ten balls that keep their identity, and nobody freezes "
    "[unit]") {
    net::NetDraft draft;
    const std::uint32_t players = 100;
    const auto place = [&](const std::string& path, bool ball) {
        net::PlaceDraft p;
        p.path = path;
        if (ball) {
            p.attributes.push_back({"b", {ValueKind::kProp, 0}});
            p.duration = net::lasts(0.7);
        }
        draft.places.push_back(p);
        return net::PlaceIndex{static_cast<std::uint32_t>(draft.places.size()) - 1};
    };
    std::vector<net::PlaceIndex> idle, has, air;
    std::vector<std::uint32_t> holders;
    for (std::uint32_t i = 0; i < players; ++i) {
        const std::string name = "player" + std::to_string(i);
        idle.push_back(place(name + ".idle", false));
        has.push_back(place(name + ".has", true));
        air.push_back(place(name + ".air", true));
        holders.insert(holders.end(), {has.back().value, air.back().value});
        draft.places[idle.back().value].tokens.push_back({});
        if (i % 10 == 0) {
            net::InitialToken ball;
            ball.attributes = {i / 10};
            draft.places[air.back().value].tokens.push_back(ball);
        }
    }
    const auto hand_on = [&](const std::string& path, net::PlaceIndex from,
                             net::PlaceIndex to) -> net::TransitionDraft& {
        net::TransitionDraft t;
        t.path = path;
        t.variables.push_back({"b", {ValueKind::kProp, 0}});
        net::ArcDraft in;
        in.place = from;
        net::PatternDraft pattern;
        pattern.binds = 0;
        in.pattern.push_back(pattern);
        t.inputs.push_back(in);
        net::OutputDraft out;
        out.place = to;
        out.attributes.push_back(
            Expr::slot(net::slot(net::SlotKind::kVariable, 0), {ValueKind::kProp, 0}));
        t.outputs.push_back(out);
        draft.transitions.push_back(t);
        return draft.transitions.back();
    };
    for (std::uint32_t i = 0; i < players; ++i) {
        net::ArcDraft free_hands;
        free_hands.place = idle[i];
        net::OutputDraft again;
        again.place = idle[i];
        hand_on("player" + std::to_string(i) + ".catch", air[i], has[i])
            .inputs.push_back(free_hands);
        hand_on("player" + std::to_string(i) + ".throw", has[i], air[(i + 1) % players])
            .outputs.push_back(again);
    }
    const auto net = net::compile(draft);
    REQUIRE(net);
    const std::vector<std::uint32_t> attribute(holders.size(), 0);
    CHECK(conserves_identity(*net, holders, attribute).conserved);
    const TimedLiveness answer = timed_liveness(*net, {});
    CAPTURE(answer.theorem);
    CHECK(answer.live);

    // Without asking whose ball it is, or making one, identity is lost.
    net::NetDraft copies = draft;
    copies.transitions[0].outputs.push_back(copies.transitions[0].outputs[0]);
    CHECK_FALSE(conserves_identity(net::compile(copies).value(), holders, attribute).conserved);
    net::NetDraft forged = draft;
    forged.transitions[0].outputs[0].attributes[0] = Expr::prop(3);
    CHECK_FALSE(conserves_identity(net::compile(forged).value(), holders, attribute).conserved);
    net::NetDraft lost = draft;
    lost.transitions[1].outputs.erase(lost.transitions[1].outputs.begin());
    CHECK_FALSE(conserves_identity(net::compile(lost).value(), holders, attribute).conserved);
}
