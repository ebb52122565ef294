// SPDX-License-Identifier: MIT
#include "puppetri/proof/components.h"

#include <doctest/doctest.h>

#include <set>

#include "net/maker.h"
#include "puppetri/proof/slice.h"
#include "small_nets.h"

using namespace puppetri;
using namespace puppetri::proof;
using namespace puppetri::proof::test;
using net::Maker;

namespace {

PlainNet beside(const PlainNet& a, const PlainNet& b) {
    PlainNet net = a;
    net.initial.insert(net.initial.end(), b.initial.begin(), b.initial.end());
    for (std::uint32_t t = 0; t < b.transition_count(); ++t) {
        const auto row = [&](std::span<const net::Weighted> arcs) {
            std::map<std::uint32_t, std::uint32_t> out;
            for (const net::Weighted& w : arcs) {
                out[a.place_count() + w.place] = w.weight;
            }
            return out;
        };
        add_transition(net, row(b.takes.row(t)), row(b.gives.row(t)), row(b.reads.row(t)),
                       row(b.unless.row(t)), b.optional[t] != 0);
    }
    return net;
}

}  // namespace

TEST_CASE(
    "the state space of a net is the product of its components', and nothing else connects them "
    "[law]") {
    Chance chance(61);
    for (int round = 0; round < 800; ++round) {
        const SmallNetShape shape{.places = 3, .transitions = 3, .reads = true, .inhibitors = true};
        const PlainNet a = small_net(chance, shape), b = small_net(chance, shape);
        const PlainNet net = beside(a, b);
        const Components parts = components(net);
        const Space whole = whole_space(net, 20000);
        REQUIRE(whole.complete);
        std::uint64_t product = 1;
        std::uint32_t places = 0, transitions = 0;
        for (std::uint32_t c = 0; c < parts.count; ++c) {
            const SubNet part = component(net, parts, c);
            places += static_cast<std::uint32_t>(part.places.size());
            transitions += static_cast<std::uint32_t>(part.transitions.size());
            product *= whole_space(part.net).markings.size();
        }
        CHECK(product == whole.markings.size());
        CHECK(places == net.place_count());
        CHECK(transitions == net.transition_count());
        CHECK(parts.of_place[0] != parts.of_place[a.place_count()]);
    }
}

TEST_CASE("a slice reaches the same markings of the places it is for [law]") {
    Chance chance(62);
    int smaller = 0;
    for (int round = 0; round < 3000; ++round) {
        const PlainNet net = small_net(
            chance,
            {.places = 6, .transitions = 5, .weights = true, .reads = true, .inhibitors = true});
        const std::vector<std::uint32_t> roots = {chance.below(net.place_count())};
        const SubNet part = slice(net, roots);
        smaller += part.transitions.size() < net.transition_count() ? 1 : 0;
        const auto at = static_cast<std::uint32_t>(
            std::find(part.places.begin(), part.places.end(), roots[0]) - part.places.begin());
        REQUIRE(at < part.places.size());
        const Space whole = whole_space(net), less = whole_space(part.net);
        if (!whole.complete || !less.complete) {
            continue;
        }
        std::set<Marking> a, b;
        for (const Marking& m : whole.markings) {
            Marking seen;
            for (const std::uint32_t p : part.places) {
                seen.push_back(m[p]);
            }
            a.insert(seen);
        }
        b.insert(less.markings.begin(), less.markings.end());
        CHECK(a == b);
    }
    CHECK(smaller > 300);
}

TEST_CASE("parts of a draft are connected by arcs, data and events [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1);
    m.place("c", 1);
    m.t("t", {"a"}, {"a"});
    m.t("u", {"b"}, {"b"});
    m.t("v", {"c"}, {"c"});
    CHECK(components(m.draft).count == 3);
    net::DatumDraft datum;
    datum.path = "x";
    datum.type.kind = ValueKind::kBool;
    m.draft.data.push_back(datum);
    m.draft.transitions[0].assignments.push_back({net::DatumIndex{0}, Expr::boolean(true), {}});
    m.draft.transitions[1].guard =
        Expr::slot(net::slot(net::SlotKind::kDatum, 0), {ValueKind::kBool, 0});
    Components parts = components(m.draft);
    CHECK(parts.count == 2);
    CHECK(parts.of_transition[0] == parts.of_transition[1]);
    CHECK(parts.of_datum[0] == parts.of_transition[0]);
    net::EventDraft event;
    event.path = "e";
    m.draft.events.push_back(event);
    m.draft.transitions[1].raises.push_back(net::EventIndex{0});
    m.draft.transitions[2].events.push_back(net::EventIndex{0});
    CHECK(components(m.draft).count == 1);
}

TEST_CASE("priorities connect everything only where there is no time [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1);
    m.t("t", {"a"}, {"a"});
    m.t("u", {"b"}, {"b"});
    m.draft.transitions[0].priority = 2;
    CHECK(components(m.draft).count == 1);
    m.draft.places[0].duration = net::DurationDraft::constant({kTicksPerSecond});
    CHECK(components(m.draft).count == 2);
}

TEST_CASE(
    "a slice of a draft keeps who writes what its transitions read, and its indices are its own "
    "[unit]") {
    Maker m;
    m.place("far", 1);
    m.place("a", 1);
    m.place("b");
    m.place("w", 1);
    m.t("elsewhere", {"far"}, {"far"});
    m.t("t", {"a"}, {"b"});
    m.t("writer", {"w"}, {"w"});
    net::DatumDraft unread, datum;
    unread.path = "unread";
    datum.path = "x";
    m.draft.data = {unread, datum};
    m.draft.transitions[1].guard =
        Expr::slot(net::slot(net::SlotKind::kDatum, 1), {ValueKind::kBool, 0});
    m.draft.transitions[2].assignments.push_back({net::DatumIndex{1}, Expr::boolean(true), {}});
    net::Rule rule;
    rule.path = "r";
    rule.operands = {net::Formula::marked(net::PlaceIndex{2})};
    m.draft.rules.push_back(rule);
    net::Rule other = rule;
    other.operands = {net::Formula::marked(net::PlaceIndex{0})};
    m.draft.rules.push_back(other);
    const DraftSlice part = slice(m.draft, roots_of(rule));
    CHECK(part.places == std::vector<std::uint32_t>{1, 2, 3});
    CHECK(part.transitions == std::vector<std::uint32_t>{1, 2});
    CHECK(part.rules == std::vector<std::uint32_t>{0});
    REQUIRE(part.draft.data.size() == 1);
    CHECK(part.draft.data[0].path == "x");
    CHECK(part.draft.transitions[1].assignments[0].datum.value == 0);
    CHECK(part.draft.rules[0].operands[0].nodes[0].index == 1);
    const auto compiled = net::compile(part.draft);
    REQUIRE(compiled);
    CHECK(compiled->find_place("b").value == 1);
}
