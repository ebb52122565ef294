// SPDX-License-Identifier: MIT
// The plain picture of a net: exactly its arcs where nothing else is there, an over-approximation
// elsewhere, which thousands of runs of random nets never leave.
#include "puppetri/proof/plain_net.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "net/maker.h"
#include "puppetri/base/hash.h"
#include "support/random_net.h"

namespace puppetri::proof {
namespace {

using net::exponential;
using net::lasts;
using net::Maker;

bool mentions(const Plain& p, const std::string& text) {
    return std::any_of(p.net.left_out.begin(), p.net.left_out.end(),
                       [&](const std::string& s) { return s.find(text) != std::string::npos; });
}

TEST_CASE("a net of counts is its own picture: arcs add up, the strictest test counts [unit]") {
    Maker m;
    m.place("a", 5);
    m.place("c", 1);
    m.t("t", {"a", "2*a", "with 4*a", "unless 3*b", "unless b", "with c"}, {"b", "2*b", "a"});
    const Plain p = plain(m.net());
    CHECK(p.net.exact());
    CHECK_FALSE(p.unsound);
    CHECK(p.net.initial == Marking{5, 1, 0});
    CHECK(p.net.takes.items == std::vector<net::Weighted>{{0, 3}});
    CHECK(p.net.gives.items == std::vector<net::Weighted>{{0, 1}, {2, 3}});
    CHECK(p.net.reads.items == std::vector<net::Weighted>{{0, 4}, {1, 1}});
    CHECK(p.net.unless.items == std::vector<net::Weighted>{{2, 4}});
    Marking marking = p.net.initial;
    REQUIRE(p.net.enabled(marking, 0));
    CHECK(p.net.fire(marking, 0));
    CHECK(marking == Marking{3, 1, 3});
    CHECK_FALSE(p.net.enabled(marking, 0));  // only three to read, where four are wanted
    marking = {9, 1, 4};
    CHECK_FALSE(p.net.enabled(marking, 0));  // inhibited
    marking = {9, 0, 0};
    CHECK_FALSE(p.net.enabled(marking, 0));
}

TEST_CASE("a firing that would pass the largest count is refused and leaves the marking [unit]") {
    Maker m;
    m.place("a", 1);
    m.t("t", {"a"}, {"a", "2*b"});
    const Plain p = plain(m.net());
    Marking marking = {1, ~std::uint32_t{0} - 1};
    CHECK_FALSE(p.net.fire(marking, 0));
    CHECK(marking == Marking{1, ~std::uint32_t{0} - 1});
    marking[1] = 7;
    CHECK(p.net.fire(marking, 0));
    CHECK(marking == Marking{1, 9});
}

TEST_CASE("a full place inhibits its producers [unit]") {
    Maker m;
    m.place("a", 9);
    m.place("b").capacity = 3;
    m.t("t", {"a"}, {"2*b"});
    const Plain p = plain(m.net());
    CHECK(p.net.exact());
    CHECK(p.net.enabled(Marking{9, 1}, 0));
    CHECK_FALSE(p.net.enabled(Marking{9, 2}, 0));
}

TEST_CASE("what the picture leaves out is named, and proves nobody alive [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("timed", 0, lasts(1));
    SUBCASE("durations") {
        m.t("t", {"a"}, {"timed"});
        const Plain p = plain(m.net());
        CHECK(mentions(p, "place timed has a duration"));
        CHECK(p.net.optional[0] == 0);
    }
    SUBCASE("delays: a constant one ends, an exponential one has no bound") {
        m.t("t", {"a"}, {}).delay = net::DelayDraft{lasts(1)};
        m.t("u", {"a"}, {}).delay = net::DelayDraft{exponential(1)};
        const Plain p = plain(m.net());
        CHECK(mentions(p, "transition t has a delay"));
        CHECK(p.net.optional == std::vector<std::uint8_t>{0, 1});
    }
    SUBCASE("guards and events") {
        m.t("t", {"a"}, {}).guard = Expr::boolean(false);
        m.t("u", {"a"}, {}).events = {m.event("e")};
        const Plain p = plain(m.net());
        CHECK(mentions(p, "transition t has a guard"));
        CHECK(mentions(p, "transition u waits for an event"));
        CHECK(p.net.optional == std::vector<std::uint8_t>{1, 1});
        CHECK(p.net.enabled(p.net.initial, 0));
    }
    SUBCASE("ready tokens that inhibit may be unready") {
        m.t("t", {"a", "unless ready timed"}, {});
        m.t("u", {"a"}, {"a", "timed"});
        const Plain p = plain(m.net());
        CHECK(p.net.enabled(Marking{1, 1}, 0));
        CHECK(p.net.optional == std::vector<std::uint8_t>{1, 0});
    }
    SUBCASE("a token that nobody may ever make ready") {
        m.place("open", 1).duration = net::of_kind(net::DurationKind::kOpen);
        m.t("t", {"open"}, {});
        const Plain p = plain(m.net());
        CHECK(p.net.enabled(p.net.initial, 0));
        CHECK(p.net.optional[0] == 1);
    }
    SUBCASE("all has no picture") {
        m.t("t", {"a", "all timed"}, {});
        const Plain p = plain(m.net());
        CHECK(p.unsound);
        CHECK(mentions(p, "transition t takes all tokens of place timed"));
    }
}

TEST_CASE("priorities block in the picture only where they block at every time [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1, lasts(1));
    SUBCASE("no times: they do") {
        m.t("high", {"a"}, {}).priority = 7;
        m.t("low", {"a"}, {}).priority = -2;
        m.t("middle", {"a"}, {});
        const Plain p = plain(m.net());
        CHECK(p.net.has_levels);
        CHECK(p.net.level == std::vector<std::uint32_t>{2, 0, 1});
        CHECK_FALSE(mentions(p, "priority"));
    }
    SUBCASE("the higher one waits for a token that may be unready") {
        m.t("high", {"b"}, {}).priority = 2;
        m.t("low", {"a"}, {});
        const Plain p = plain(m.net());
        CHECK_FALSE(p.net.has_levels);
        CHECK(mentions(p, "priority 2 does not block"));
    }
    SUBCASE("both wait for it") {
        m.t("high", {"b"}, {}).priority = 2;
        m.t("low", {"a", "with b"}, {});
        const Plain p = plain(m.net());
        CHECK(p.net.level == std::vector<std::uint32_t>{1, 0});
    }
    SUBCASE("the higher one waits for more of them") {
        m.t("high", {"2*b"}, {}).priority = 2;
        m.t("low", {"a", "b"}, {});
        CHECK_FALSE(plain(m.net()).net.has_levels);
    }
    SUBCASE("a delay, a guard or an event on either side") {
        net::TransitionDraft& high = m.t("high", {"a"}, {});
        high.priority = 2;
        SUBCASE("guard above") { high.guard = Expr::boolean(true); }
        SUBCASE("delay above") { high.delay = net::DelayDraft{lasts(1)}; }
        SUBCASE("event above") { high.events = {m.event("e")}; }
        m.t("low", {"a"}, {});
        CHECK_FALSE(plain(m.net()).net.has_levels);
    }
    SUBCASE("one boundary falls, the other stands") {
        m.t("top", {"a"}, {}).priority = 3;
        m.t("high", {"b"}, {}).priority = 2;
        m.t("low", {"a"}, {});
        const Plain p = plain(m.net());
        CHECK(p.net.level == std::vector<std::uint32_t>{1, 0, 0});
        CHECK_FALSE(p.net.exact());
    }
}

TEST_CASE("no run of a random net leaves its picture [law]") {
    std::uint64_t firings = 0, deaths = 0, with_levels = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        RandomStream stream{.key = Hash64(0x91A1).add_u64(i).value(), .count = 0};
        const Checked<net::Net> compiled = net::compile(test::random_net(stream));
        REQUIRE(compiled.has_value());
        const net::Net& n = *compiled;
        const Plain p = plain(n);
        if (p.unsound) {
            continue;
        }
        with_levels += p.net.has_levels ? 1 : 0;
        net::RandomChooser chooser;
        net::Engine engine(n, chooser, {.seed = i, .firings_per_instant = 200});
        engine.start();
        const auto counts = [&] {
            Marking m;
            for (const auto& c : engine.state().counts) {
                m.push_back(c.total);
            }
            return m;
        };
        Marking marking = p.net.initial;
        REQUIRE(marking == counts());
        for (int step = 0; step < 60; ++step) {
            const net::Engine::Outcome outcome = engine.step(100 * test::kRandomNetUnit);
            if (outcome == net::Engine::Outcome::kDead) {
                ++deaths;
                for (std::uint32_t t = 0; t < p.net.transition_count(); ++t) {
                    INFO("net " << i << ", transition " << t);
                    CHECK_FALSE((p.net.enabled(marking, t) && p.net.optional[t] == 0));
                }
            }
            if (outcome != net::Engine::Outcome::kFired) {
                break;
            }
            ++firings;
            const std::uint32_t t = engine.state().last;
            INFO("net " << i << ", transition " << t);
            REQUIRE(p.net.enabled(marking, t));
            for (std::uint32_t u = 0; u < p.net.transition_count(); ++u) {
                REQUIRE_FALSE((p.net.level[u] > p.net.level[t] && p.net.enabled(marking, u)));
            }
            REQUIRE(p.net.fire(marking, t));
            REQUIRE(marking == counts());
        }
    }
    CHECK(firings > 10000);
    CHECK(deaths > 100);
    CHECK(with_levels > 20);
}

}  // namespace
}  // namespace puppetri::proof
