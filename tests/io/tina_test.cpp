// SPDX-License-Identifier: MIT
// TINA's .net: each construct of its manual page, and what the intervals mean.
#include "puppetri/io/tina.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "puppetri/net/net.h"

using namespace puppetri;
using namespace puppetri::io;

namespace {

NetFile read(const std::string& text) {
    const Checked<NetFile> file = read_tina(text, "n.net");
    if (!file) {
        FAIL(file.error()[0].code << ": " << file.error()[0].message);
    }
    return *file;
}

std::string code_of(const std::string& text) {
    const Checked<NetFile> file = read_tina(text, "n.net");
    return file ? "fine" : file.error()[0].code;
}

const net::TransitionDraft& transition(const NetFile& file, const std::string& path) {
    return file.draft.transitions.at(file.ids.find_transitions(path)->at(0).value);
}

std::string place_of(const NetFile& file, net::PlaceIndex p) {
    return file.draft.places.at(p.value).path;
}

constexpr std::int64_t kSecond = kTicksPerSecond;

}  // namespace

TEST_CASE("declarations superpose, in any order [unit]") {
    const NetFile file = read(
        "# a comment\n"
        "net {my net}\n"
        "tr t1 : go [1,2] p1*2 {a \\} b} -> p2 p3*4\n"
        "pl p1 : start (3K)\n"
        "pl {a \\} b} (1)\n"
        "pl p4 t1*5 -> t2?2 t3?-3\n"
        "tr t2 p1?1 p2?-7 -> \n"
        "tr t1 p4 -> \n"
        "tr t3 [0,w[ -> p1\n"
        "nt n1 0 {a note}\n"
        "lb p2 named\n");
    CHECK(file.draft.name == "my net");
    const net::TransitionDraft& t1 = transition(file, "t1");
    CHECK(t1.caption == "go");
    REQUIRE(t1.inputs.size() == 3);
    CHECK(place_of(file, t1.inputs[0].place) == "p1");
    CHECK(t1.inputs[0].weight == 2);
    CHECK(place_of(file, t1.inputs[1].place) == "a } b");
    CHECK(place_of(file, t1.inputs[2].place) == "p4");
    REQUIRE(t1.outputs.size() == 3);
    CHECK(t1.outputs[1].weight == 4);
    CHECK(place_of(file, t1.outputs[2].place) == "p4");
    CHECK(t1.outputs[2].weight == 5);
    const net::TransitionDraft& t2 = transition(file, "t2");
    REQUIRE(t2.inputs.size() == 3);
    CHECK(t2.inputs[0].kind == net::ArcKind::kRead);
    CHECK(t2.inputs[0].weight == 2);
    CHECK(t2.inputs[1].kind == net::ArcKind::kRead);
    CHECK(t2.inputs[2].kind == net::ArcKind::kUnless);
    CHECK(t2.inputs[2].weight == 7);
    const net::TransitionDraft& t3 = transition(file, "t3");
    CHECK(t3.inputs.at(0).kind == net::ArcKind::kUnless);
    CHECK(t3.inputs.at(0).weight == 3);
    CHECK(file.draft.places.at(file.ids.find_places("p1")->at(0).value).tokens.at(0).count == 3000);
    CHECK(file.draft.places.at(file.ids.find_places("p2")->at(0).value).caption == "named");
    CHECK(net::compile(file.draft).has_value());
}

TEST_CASE("intervals become delays [unit]") {
    const NetFile file = read(
        "tr exact [2,2] p -> p\n"
        "tr closed [1,3] p -> p\n"
        "tr open ]1,3[ p -> p\n"
        "tr late [4,w[ p -> p\n"
        "tr any p -> p\n"
        "tr now [0,0] p -> p\n");
    const auto& exact = transition(file, "exact").delay->duration;
    CHECK(exact.kind == net::DurationKind::kConstant);
    CHECK(exact.a.literal_value() == 2 * kSecond);
    const auto& closed = transition(file, "closed").delay->duration;
    CHECK(closed.kind == net::DurationKind::kInterval);
    CHECK(closed.a.literal_value() == kSecond);
    CHECK(closed.b.literal_value() == 3 * kSecond);
    const auto& open = transition(file, "open").delay->duration;
    CHECK(open.a.literal_value() == kSecond + 1);
    CHECK(open.b.literal_value() == 3 * kSecond - 1);
    SimTime low;
    CHECK(is_at_least(transition(file, "late").delay->duration, low));
    CHECK(low.ticks == 4 * kSecond);
    CHECK(is_at_least(transition(file, "any").delay->duration, low));
    CHECK(low.ticks == 0);
    CHECK(!transition(file, "now").delay);
    const Checked<net::Net> net = net::compile(file.draft);
    REQUIRE(net.has_value());
    CHECK(!net->paced());
    // Every value from the bound on, and none below it.
    const std::vector<double> p = {4, 1, 4, std::numeric_limits<double>::infinity()};
    REQUIRE(check(DistributionKind::kNormal, p).has_value());
    CHECK(support(DistributionKind::kNormal, p).low == 4);
    CHECK(support(DistributionKind::kNormal, p).high > 1e300);
}

TEST_CASE("a file without intervals has no time, and its unit may be told [unit]") {
    CHECK(net::compile(read("tr t [0,w[ p -> q\ntr u q -> p\ntr source -> p\n").draft)->paced());
    const NetFile file = read("# unit 250 ms\ntr t [2,2] p -> q\n");
    CHECK(transition(file, "t").delay->duration.a.literal_value() == kSecond / 2);
}

TEST_CASE("priorities that are levels become levels [unit]") {
    const NetFile file = read(
        "tr a p -> q\ntr b p -> q\ntr c p -> q\ntr d p -> q\n"
        "pr a > b c\npr d < c b\n");
    CHECK(transition(file, "a").priority == 3);
    CHECK(transition(file, "b").priority == 2);
    CHECK(transition(file, "c").priority == 2);
    CHECK(transition(file, "d").priority == 1);
}

TEST_CASE("priorities that are no levels forbid while the higher one is enabled [unit]") {
    const NetFile file = read(
        "tr high p*2 -> \ntr two p q ->\ntr low r ->\ntr beside s ->\n"
        "pr high > low\npr two > low\n");
    const net::TransitionDraft& low = transition(file, "low");
    CHECK(low.priority == 1);
    REQUIRE(low.inputs.size() == 2);
    CHECK(low.inputs[1].kind == net::ArcKind::kUnless);
    CHECK(place_of(file, low.inputs[1].place) == "p");
    CHECK(low.inputs[1].weight == 2);
    CHECK(low.guard.has_value());
    CHECK(!transition(file, "beside").guard);
    CHECK(net::compile(file.draft).has_value());
    CHECK(code_of("tr a [1,1] p ->\ntr b p ->\ntr c p ->\npr a > b\n") == "priorities-not-levels");
    CHECK(code_of("tr a p ->\ntr b p ->\npr a > b\npr b > a\n") == "priorities-in-a-circle");
}

namespace {

// By definition: enabled, and no transition that is higher, directly or not, is enabled.
bool holds(const Expr& e, std::uint32_t at, const std::vector<std::int64_t>& marking) {
    const Expr::Node& n = e.nodes()[at];
    const auto number = [&](std::uint32_t i) {
        const Expr::Node& x = e.nodes()[i];
        return x.op == ExprOp::kSlot ? marking[x.slot.index] : x.literal;
    };
    switch (n.op) {
        case ExprOp::kLess:
            return number(n.a) < number(n.b);
        case ExprOp::kGreaterEqual:
            return number(n.a) >= number(n.b);
        case ExprOp::kAnd:
            return holds(e, n.a, marking) && holds(e, n.b, marking);
        case ExprOp::kOr:
            return holds(e, n.a, marking) || holds(e, n.b, marking);
        default:
            return n.literal != 0;
    }
}
bool enabled(const net::TransitionDraft& t, const std::vector<std::int64_t>& marking) {
    std::vector<std::int64_t> takes(marking.size(), 0);
    for (const net::ArcDraft& a : t.inputs) {
        const std::int64_t tokens = marking[a.place.value];
        takes[a.place.value] += a.kind == net::ArcKind::kTake ? a.weight : 0;
        if ((a.kind == net::ArcKind::kUnless && tokens >= a.weight) ||
            (a.kind == net::ArcKind::kRead && tokens < a.weight) || takes[a.place.value] > tokens) {
            return false;
        }
    }
    return !t.guard ||
           holds(*t.guard, static_cast<std::uint32_t>(t.guard->nodes().size()) - 1, marking);
}

}  // namespace

TEST_CASE("on random nets priorities let fire what TINA lets fire, in every marking [law]") {
    std::mt19937 random(7);
    std::size_t levels = 0, conditions = 0;
    for (int round = 0; round < 400; ++round) {
        const int transitions = 2 + static_cast<int>(random() % 4);
        std::string plain = "pl a\npl b\npl c\n", priorities;
        std::vector<std::vector<bool>> above(
            static_cast<std::size_t>(transitions),
            std::vector<bool>(static_cast<std::size_t>(transitions), false));
        for (int t = 0; t < transitions; ++t) {
            plain += "tr t" + std::to_string(t);
            for (const char* place : {"a", "b", "c"}) {
                const char* arcs[] = {"", "", "*1", "*2", "?1", "?-1", "?-2"};
                const char* arc = arcs[random() % 7];
                plain += *arc != 0 ? std::string(" ") + place + arc : "";
            }
            plain += " ->\n";
            for (int u = 0; u < t; ++u) {
                if (random() % 3 != 0) {
                    above[static_cast<std::size_t>(u)][static_cast<std::size_t>(t)] = true;
                    priorities += "pr t" + std::to_string(u) + " > t" + std::to_string(t) + "\n";
                }
            }
        }
        for (std::size_t k = 0; k < above.size(); ++k) {
            for (std::size_t i = 0; i < above.size(); ++i) {
                for (std::size_t j = 0; j < above.size(); ++j) {
                    above[i][j] = above[i][j] || (above[i][k] && above[k][j]);
                }
            }
        }
        const NetFile without = read(plain), with = read(plain + priorities);
        const bool by_levels =
            std::none_of(with.draft.transitions.begin(), with.draft.transitions.end(),
                         [](const auto& t) { return t.guard.has_value(); });
        levels += by_levels ? 1 : 0;
        conditions += by_levels ? 0 : 1;
        for (int m = 0; m < 64; ++m) {
            const std::vector<std::int64_t> marking = {m % 4, m / 4 % 4, m / 16};
            std::int64_t highest = std::numeric_limits<std::int64_t>::min();
            for (const net::TransitionDraft& t : with.draft.transitions) {
                highest = enabled(t, marking) ? std::max(highest, t.priority) : highest;
            }
            for (std::size_t i = 0; i < above.size(); ++i) {
                bool expected = enabled(without.draft.transitions[i], marking);
                for (std::size_t h = 0; h < above.size(); ++h) {
                    expected = expected &&
                               !(above[h][i] && enabled(without.draft.transitions[h], marking));
                }
                const net::TransitionDraft& t = with.draft.transitions[i];
                const bool fires = enabled(t, marking) && t.priority == highest;
                CHECK(fires == expected);
            }
        }
    }
    CHECK(levels > 20);
    CHECK(conditions > 20);
}

TEST_CASE("priorities of many transitions are settled in no time [hostile]") {
    std::string text, high, low;
    for (int i = 0; i < 3000; ++i) {
        text += "tr t" + std::to_string(i) + " p -> p\n";
        (i % 2 == 0 ? high : low) += " t" + std::to_string(i);
    }
    CHECK(transition(read(text + "pr" + high + " >" + low + "\n"), "t0").priority == 2);
    CHECK(code_of(text + "tr alone p ->\npr" + high + " >" + low + "\n") == "net-too-large");
    CHECK(code_of(text + "pr t1 > t1\n") == "priorities-in-a-circle");
}

TEST_CASE("what is not understood is refused, with its line [unit]") {
    CHECK(code_of("tr t p!2 -> q\n") == "unknown-arc-type");
    CHECK(code_of("tr t p -> q?1\n") == "arc-type-backwards");
    CHECK(code_of("tr t p*0 -> q\n") == "number-too-small");
    CHECK(code_of("tr t p*9E -> q\n") == "number-too-large");
    CHECK(code_of("tr t p*x -> q\n") == "not-a-number");
    CHECK(code_of("tr t p q\n") == "unknown-element");
    CHECK(code_of("tr t [3,2] p -> q\n") == "bad-interval");
    CHECK(code_of("tr t ]2,2] p -> q\n") == "bad-interval");
    CHECK(code_of("tr t [1,1] p ->\ntr t [2,2] q ->\n") == "bad-interval");
    CHECK(code_of("tr t [1,99999999999999999] p ->\n") == "number-too-large");
    CHECK(code_of("pl p (1)\npl p (2)\n") == "duplicate-label");
    CHECK(code_of("tr x -> x\n") == "duplicate-id");
    CHECK(code_of("pl {p (1)\n") == "unclosed-name");
    CHECK(code_of("lb nobody x\n") == "unknown-id");
    CHECK(code_of("sc x\n") == "unknown-element");
    CHECK(code_of("pr a\n") == "unknown-element");
    const Checked<NetFile> bad = read_tina("tr t p -> q\n\ntr u p!1 -> q\npl p (x)\n", "n.net");
    REQUIRE(!bad.has_value());
    CHECK(bad.error().size() == 2);
    CHECK(bad.error()[0].where.line == 3);
    CHECK(bad.error()[1].where.line == 4);
}

TEST_CASE("parallel tests: the strictest counts [unit]") {
    const NetFile file = read("tr t p?2 p?5 q?-3 q?-1 r -> p\n");
    const net::TransitionDraft& t = transition(file, "t");
    REQUIRE(t.inputs.size() == 3);
    CHECK(t.inputs[0].weight == 5);
    CHECK(t.inputs[1].weight == 1);
    CHECK(t.inputs[2].kind == net::ArcKind::kTake);
    CHECK(file.notes.size() == 1);
}
