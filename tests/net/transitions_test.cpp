// SPDX-License-Identifier: MIT
// Transitions: SEMANTICS section 4, sentence by sentence.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "maker.h"

namespace puppetri::net {
namespace {

AssignmentDraft set(DatumIndex d, Expr value) { return {d, std::move(value), {}}; }

TEST_CASE("the highest priority fires, in the whole net, any integer, default 1 [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1);
    m.place("c", 1);
    m.place("d", 1);
    m.place("clock", 1, lasts(9));
    m.t("ta", {"a"}, {});
    m.t("tb", {"b"}, {}).priority = 7;
    m.t("tc", {"c"}, {}).priority = -2;
    m.t("td", {"d"}, {}).priority = 0;
    Run run(m.net());
    run.until(1);
    CHECK(run.log.text == "0:tb 0:ta 0:td 0:tc");
}

TEST_CASE(
    "priority compares fireable transitions only: a delay that runs or an event that is away "
    "blocks nobody [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1);
    m.place("c", 1);
    TransitionDraft& delayed = m.t("delayed", {"a"}, {});
    delayed.priority = 5;
    delayed.delay = DelayDraft{lasts(3)};
    const EventIndex e = m.event("e");
    m.at(2, e);
    TransitionDraft& waiting = m.t("waiting", {"b"}, {});
    waiting.priority = 9;
    waiting.events = {e};
    m.t("low", {"c"}, {});
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:low 2:waiting 3:delayed");
}

TEST_CASE("assignments are simultaneous and guards see the state before [unit]") {
    Maker m;
    const DatumIndex x = m.integer("x", 1);
    const DatumIndex y = m.integer("y", 2);
    m.place("a", 1);
    TransitionDraft& t = m.t("swap", {"a"}, {"b"});
    t.guard = expr(ExprOp::kLess, m.read(x), m.read(y));
    t.assignments = {set(x, m.read(y)), set(y, m.read(x))};
    Run run(m.net());
    run.until(1);
    CHECK(run.datum("x") == 2);
    CHECK(run.datum("y") == 1);
}

TEST_CASE("a guard is looked at again when a datum or a count that it reads changes [unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 0);
    m.place("tick", 1, lasts(1));
    TransitionDraft& count = m.t("count", {"tick"}, {"tick", "heap"});
    count.assignments = {set(n, expr(ExprOp::kAdd, m.read(n), Expr::integer(1)))};
    m.place("a", 1);
    m.place("b", 1);
    m.t("by_datum", {"a"}, {}).guard = expr(ExprOp::kEqual, m.read(n), Expr::integer(3));
    m.t("by_count", {"b"}, {}).guard =
        expr(ExprOp::kGreaterEqual, m.count("heap"), Expr::integer(4));
    Run run(m.net());
    run.until(5);
    CHECK(run.log.text == "1:count 2:count 3:count 3:by_datum 4:count 4:by_count 5:count");
}

TEST_CASE(
    "leaving a datum's range and dividing by zero stop the run, with element and time [unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 2, 0, 3);
    m.place("a", 1, lasts(1));
    SUBCASE("range") {
        m.t("up", {"a"}, {"a"}).assignments = {
            set(n, expr(ExprOp::kAdd, m.read(n), Expr::integer(1)))};
        Run run(m.net());
        CHECK(run.until(10) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().code == "range-left");
        CHECK(run.engine.fault().element == "transition up");
        CHECK(run.engine.state().now == 2 * kSecond);
        CHECK(run.datum("n") == 3);
    }
    SUBCASE("division") {
        m.t("odd", {"a"}, {"a"}).guard =
            expr(ExprOp::kGreater,
                 expr(ExprOp::kDivide, Expr::integer(1),
                      expr(ExprOp::kSubtract, m.read(n), Expr::integer(2))),
                 Expr::integer(0));
        Run run(m.net());
        CHECK(run.until(10) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().code == "evaluation-fault");
    }
}

TEST_CASE("negative durations and the end of time stop the run and name the element [unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 0);
    m.place("a", 1, lasts(1));
    m.place("b", 0, computed(expr(ExprOp::kMultiply, Expr::time({kSecond}), m.read(n))));
    TransitionDraft& t = m.t("t", {"a"}, {"b"});
    SUBCASE("negative") {
        t.assignments = {set(n, Expr::integer(-1))};
        Run run(m.net());
        CHECK(run.until(10) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().code == "negative-duration");
        CHECK(run.engine.fault().element == "place b");
        CHECK(run.engine.state().now == kSecond);
    }
    SUBCASE("overflow") {
        m.draft.data[0].high = 20'000'000'000;
        t.assignments = {set(n, Expr::integer(13'000'000'000))};
        m.t("again", {"b"}, {"b"});
        Run run(m.net());
        CHECK(run.engine.run(SimTime::never().ticks, 100) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().code == "time-overflow");
        CHECK(run.engine.state().firings == 2);
    }
}

// -- ties --

std::map<std::string, int> first_winners(const Maker& m, int runs) {
    std::map<std::string, int> wins;
    for (int seed = 1; seed <= runs; ++seed) {
        EngineOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        Run run(m.net(), nullptr, options);
        run.until(0, 1);
        ++wins[std::string(run.net.transition({run.engine.state().last}).path)];
    }
    return wins;
}

// Within five standard deviations of the binomial law.
void check_share(int times, int runs, double p) {
    CHECK(std::fabs(times - runs * p) < 5 * std::sqrt(runs * p * (1 - p)));
}

TEST_CASE("a tie is drawn with the weights of the odds [law]") {
    Maker m;
    m.place("a", 1);
    m.t("one", {"a"}, {}).odds = Expr::integer(1);
    m.t("two", {"a"}, {}).odds = Expr::integer(2);
    m.t("half", {"a"}, {}).odds = Expr::real(0.5);
    const int runs = 4000;
    auto wins = first_winners(m, runs);
    check_share(wins["one"], runs, 1 / 3.5);
    check_share(wins["two"], runs, 2 / 3.5);
    check_share(wins["half"], runs, 0.5 / 3.5);
}

// Weighted draws without replacement, with newcomers and changing odds: the law of each order of
// firing must be that of a fresh draw at every firing, though losers keep their tickets and lone
// candidates draw none.
TEST_CASE("the race has the law of a fresh weighted draw each time [law]") {
    Maker m;
    const DatumIndex w = m.integer("w", 1);
    for (const char* name : {"a", "b", "c", "d"}) {
        m.place(name, 1);
    }
    m.place("clock", 1, lasts(9));
    m.t("A", {"a"}, {"e"});  // makes E fireable
    TransitionDraft& b = m.t("B", {"b"}, {});
    b.assignments = {set(w, Expr::integer(5))};  // changes C's odds
    m.t("C", {"c"}, {}).odds = m.read(w);
    m.t("D", {"d"}, {}).odds = Expr::integer(3);
    m.t("E", {"e"}, {}).odds = Expr::integer(2);
    const Net net = m.net();

    // The exact law, by hand over all orders.
    std::map<std::string, double> law;
    struct Walk {
        static double odds(char t, const std::string& done) {
            const auto fired = [&](char c) { return done.find(c) != std::string::npos; };
            if (fired(t)) {
                return 0;
            }
            switch (t) {
                case 'A':
                case 'B':
                    return 1;
                case 'C':
                    return fired('B') ? 5 : 1;
                case 'D':
                    return 3;
                default:
                    return fired('A') ? 2 : 0;
            }
        }
        static void from(const std::string& done, double p, std::map<std::string, double>& out) {
            double sum = 0;
            for (const char t : {'A', 'B', 'C', 'D', 'E'}) {
                sum += odds(t, done);
            }
            if (sum == 0) {
                out[done] += p;
                return;
            }
            for (const char t : {'A', 'B', 'C', 'D', 'E'}) {
                if (odds(t, done) > 0) {
                    from(done + t, p * odds(t, done) / sum, out);
                }
            }
        }
    };
    Walk::from("", 1, law);
    CHECK(law.size() == 60);  // 5! orders, A before E

    const int runs = 60000;
    std::map<std::string, int> seen;
    RandomChooser random;
    for (int seed = 1; seed <= runs; ++seed) {
        EngineOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        Engine engine(net, random, options);
        engine.start();
        std::string order;
        while (engine.step(0) == Engine::Outcome::kFired) {
            order += net.transition({engine.state().last}).path;
        }
        ++seen[order];
    }
    double chi2 = 0;
    for (const auto& [order, p] : law) {
        const double expected = runs * p;
        chi2 += (seen[order] - expected) * (seen[order] - expected) / expected;
    }
    CHECK(chi2 < 59 + 5 * std::sqrt(2.0 * 59));  // 59 degrees of freedom, five deviations
}

TEST_CASE("an unrelated transition elsewhere changes nobody's luck [law]") {
    const auto order = [](bool with_others, std::uint64_t seed) {
        Maker m;
        if (with_others) {
            for (int i = 0; i < 5; ++i) {
                m.place("other" + std::to_string(i), 1);
                m.t("o" + std::to_string(i), {"other" + std::to_string(i)}, {});
            }
        }
        for (int i = 0; i < 6; ++i) {
            m.place("mine" + std::to_string(i), 1);
            m.t("t" + std::to_string(i), {"mine" + std::to_string(i)}, {});
        }
        m.place("clock", 1, lasts(9));
        EngineOptions options;
        options.seed = seed;
        Run run(m.net(), nullptr, options);
        std::string mine;
        while (run.engine.step(0) == Engine::Outcome::kFired) {
            const auto path = run.net.transition({run.engine.state().last}).path;
            if (path[0] == 't') {
                mine += path;
            }
        }
        return mine;
    };
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CHECK(order(false, seed) == order(true, seed));
    }
}

TEST_CASE("the log does not depend on the order of declarations [law]") {
    const auto run_in_order = [](bool reversed) {
        Maker m;
        for (int k = 0; k < 6; ++k) {
            const int i = reversed ? 5 - k : k;
            const std::string n = std::to_string(i);
            m.place("p" + n, 1, exponential(0.5));
            m.t("t" + n, {"p" + n, "fork"}, {"p" + n, "fork"}).priority = i % 2;
        }
        m.place("fork", 1, lasts(0.1));
        Run run(m.net());
        run.until(100, 300);
        return run.log.text;
    };
    CHECK(run_in_order(false) == run_in_order(true));
}

// -- delays --

TEST_CASE(
    "a delay runs while the transition is marked; enabling memory forgets, age remembers [unit]") {
    for (const DelayMemory memory : {DelayMemory::kEnabling, DelayMemory::kAge}) {
        Maker m;
        m.place("a", 1);
        m.place("steal", 1, lasts(2));
        m.place("away", 0, lasts(3));
        TransitionDraft& t = m.t("t", {"a"}, {});
        t.delay = DelayDraft{lasts(4), memory, 1};
        m.t("take", {"steal", "a"}, {"away"});
        m.t("back", {"away"}, {"a"});
        Run run(m.net());
        run.until(100);
        CHECK(run.log.text ==
              (memory == DelayMemory::kAge ? "2:take 5:back 7:t" : "2:take 5:back 9:t"));
    }
}

TEST_CASE(
    "a firing restarts a clock if its transition was not marked in the intermediate marking "
    "[unit]") {
    // `touch` takes the only token of `a` and gives it back in the same firing.
    for (const bool touches : {false, true}) {
        Maker m;
        m.place("a", 1);
        m.place("tick", 1, lasts(3));
        m.t("t", {"a"}, {}).delay = DelayDraft{lasts(4)};
        m.t("touch",
            touches ? std::vector<std::string>{"tick", "a"}
                    : std::vector<std::string>{"tick", "with a"},
            touches ? std::vector<std::string>{"a"} : std::vector<std::string>{});
        Run run(m.net());
        run.until(100);
        CHECK(run.log.text == (touches ? "3:touch 7:t" : "3:touch 4:t"));
    }
    // Giving before it is enough: two tokens, one is touched.
    Maker two;
    two.place("a", 2);
    two.place("tick", 1, lasts(3));
    two.place("stop", 1);
    two.t("t", {"a", "stop"}, {}).delay = DelayDraft{lasts(4)};
    two.t("touch", {"tick", "a"}, {"a"});
    Run run(two.net());
    run.until(100);
    CHECK(run.log.text == "3:touch 4:t");
}

TEST_CASE(
    "a guard in the intermediate marking decides too, and its faults are no faults there [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("b", 1);
    m.place("tick", 1, lasts(3));
    TransitionDraft& t = m.t("t", {"b"}, {});
    t.delay = DelayDraft{lasts(4)};
    t.guard = expr(ExprOp::kGreater, expr(ExprOp::kDivide, Expr::integer(1), m.count("a")),
                   Expr::real(0));
    m.t("touch", {"tick", "a"}, {"a"});
    Run run(m.net());
    CHECK(run.until(100) == Engine::Outcome::kDead);
    CHECK(run.log.text == "3:touch 7:t");
}

TEST_CASE("a firing restarts its own clock [unit]") {
    Maker m;
    m.place("a", 3);
    m.t("t", {"a"}, {}).delay = DelayDraft{lasts(2)};
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "2:t 4:t 6:t");
}

TEST_CASE("servers: single, k, infinite [unit]") {
    const auto log = [](std::uint32_t servers) {
        Maker m;
        m.place("a", 3);
        m.place("more", 1, lasts(1));
        m.t("more_", {"more"}, {"a"});
        m.t("t", {"a"}, {}).delay = DelayDraft{lasts(4), DelayMemory::kEnabling, servers};
        Run run(m.net());
        run.until(100);
        return run.log.text;
    };
    CHECK(log(1) == "1:more_ 4:t 8:t 12:t 16:t");
    CHECK(log(2) == "1:more_ 4:t 4:t 8:t 8:t");
    CHECK(log(DelayDraft::kInfiniteServers) == "1:more_ 4:t 4:t 4:t 5:t");
}

TEST_CASE("with several servers the youngest clock stops first [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("later", 1, lasts(1));
    m.place("thief", 1, lasts(2));
    m.t("t", {"a"}, {}).delay = DelayDraft{lasts(4), DelayMemory::kEnabling, 2};
    m.t("second", {"later"}, {"a"});
    m.t("steal", {"thief", "a"}, {});
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "1:second 2:steal 4:t");
}

TEST_CASE("memory resample: every firing anywhere draws the delay again [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("tick", 2, lasts(3));
    m.t("t", {"a"}, {}).delay = DelayDraft{lasts(4), DelayMemory::kResample, 1};
    m.t("elsewhere", {"2*tick"}, {});
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "3:elsewhere 7:t");
}

TEST_CASE("a .. b is drawn uniformly at enabling, both ends included [law]") {
    Maker m;
    m.place("a", 1);
    m.t("t", {"a"}, {}).delay = DelayDraft{between(3, 6)};
    std::map<std::int64_t, int> seen;
    const int runs = 2000;
    const Net net = m.net();
    RandomChooser random;
    for (int seed = 1; seed <= runs; ++seed) {
        EngineOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        Engine engine(net, random, options);
        engine.start();
        engine.step();
        ++seen[engine.state().now];
    }
    CHECK(seen.size() == 4);
    for (const std::int64_t at : {3, 4, 5, 6}) {
        check_share(seen[at], runs, 0.25);
    }
}

TEST_CASE("exponential delays race with their rates [law]") {
    Maker m;
    m.place("a", 1);
    m.t("fast", {"a"}, {}).delay = DelayDraft{exponential(1)};
    m.t("slow", {"a"}, {}).delay = DelayDraft{exponential(3)};
    const Net net = m.net();
    RandomChooser random;
    int fast = 0;
    double sum = 0;
    const int runs = 4000;
    for (int seed = 1; seed <= runs; ++seed) {
        EngineOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        Engine engine(net, random, options);
        engine.start();
        engine.step();
        fast += net.transition({engine.state().last}).path == "fast" ? 1 : 0;
        sum += SimTime{engine.state().now}.seconds();
    }
    check_share(fast, runs, 0.75);
    CHECK(std::fabs(sum / runs - 0.75) < 5 * 0.75 / std::sqrt(runs));
}

TEST_CASE("M/M/1: the mean number in the system is rho / (1 - rho) [oracle]") {
    Maker m;
    m.place("idle", 1);
    m.place("busy", 0, exponential(0.5));
    m.t("arrive", {}, {"queue"}).delay = DelayDraft{exponential(1)};
    m.t("start", {"queue", "idle"}, {"busy"});
    m.t("end", {"busy"}, {"idle"});
    const Net net = m.net();
    RandomChooser random;
    Engine engine(net, random, {});
    engine.start();
    const std::uint32_t queue = net.find_place("queue").value;
    const std::uint32_t busy = net.find_place("busy").value;
    double area = 0;
    std::int64_t before = 0;
    std::uint32_t inside = 0;
    for (int i = 0; i < 600000; ++i) {
        engine.step();
        area += static_cast<double>(engine.state().now - before) * inside;
        before = engine.state().now;
        inside = engine.state().counts[queue].total + engine.state().counts[busy].total;
    }
    CHECK(std::fabs(area / static_cast<double>(before) - 1) < 0.05);
}

}  // namespace
}  // namespace puppetri::net
