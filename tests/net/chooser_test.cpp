// SPDX-License-Identifier: MIT
// The interface of choice and its implementations; states that are kept, compared and given back.
#include <doctest/doctest.h>

#include <set>

#include "maker.h"

namespace puppetri::net {
namespace {

// Philosophers with eating times from an interval and a tie for every fork.
Net philosophers(int n) {
    Maker m;
    for (int i = 0; i < n; ++i) {
        const std::string a = std::to_string(i);
        const std::string b = std::to_string((i + 1) % n);
        m.place("fork" + a, 1);
        m.place("eat" + a, 0, between(1, 3));
        m.t("take" + a, {"fork" + a, "fork" + b}, {"eat" + a});
        m.t("put" + a, {"eat" + a}, {"fork" + a, "fork" + b});
    }
    return m.net();
}

TEST_CASE("exhaustive: all sequences of answers, each once [unit]") {
    Maker m;
    for (const char* name : {"a", "b", "c"}) {
        m.place(name, 1);
        m.t(std::string("t") + name, {name}, {});
    }
    m.place("clock", 1, lasts(9));
    const Net net = m.net();
    ExhaustiveChooser all;
    std::set<std::string> seen;
    int runs = 0;
    do {
        Engine engine(net, all);
        engine.start();
        std::string order;
        while (engine.step(0) == Engine::Outcome::kFired) {
            order += net.transition({engine.state().last}).path;
        }
        seen.insert(order);
        ++runs;
    } while (all.next());
    CHECK(runs == 6);
    CHECK(seen.size() == 6);
}

TEST_CASE("exhaustive: an interval is taken at evenly spread points, both ends included [unit]") {
    Maker m;
    m.place("a", 1, between(10, 20));
    m.t("t", {"a"}, {});
    const Net net = m.net();
    for (const std::uint32_t points : {1u, 2u, 3u, 100u}) {
        ExhaustiveChooser all;
        all.interval_points(points);
        std::set<std::int64_t> times;
        do {
            Engine engine(net, all);
            engine.start();
            engine.step();
            times.insert(engine.state().now);
        } while (all.next());
        CHECK(*times.begin() == 10);
        CHECK(times.size() == std::min<std::size_t>(points, 11));
        CHECK((points == 1 || *times.rbegin() == 20));
    }
}

TEST_CASE(
    "free runs: the chooser says which outside events occur, and what free sensors see [unit]") {
    Maker m;
    m.event("b");
    m.event("a");
    m.draft.events[0].outside = true;
    const EventIndex inner = m.event("inner");
    m.draft.events[2].outside = false;
    (void)inner;
    m.place("p", 1);
    m.place("q", 1);
    m.place("clock", 1, lasts(1));
    m.t("on_a", {"p"}, {}).events = {{1}};
    m.t("on_b", {"p"}, {}).events = {{0}};
    const DatumIndex near = m.datum("near", {ValueKind::kBool, 0}, 0);
    m.draft.data[0].sensor = true;
    m.t("seen", {"q", "clock"}, {}).guard = m.read(near);
    m.t("tick", {"clock", "unless q"}, {});
    const Net net = m.net();
    EngineOptions options;
    options.free = true;
    options.free_events = 1;
    ExhaustiveChooser all;
    std::set<std::string> seen;
    do {
        Run run(net, &all, options);
        run.until(10);
        seen.insert(run.log.text);
    } while (all.next());
    // Nothing, a or b, now or when the clock rings, before or after the sensor sees; ties included.
    CHECK(seen.count("") == 1);
    CHECK(seen.count("0:on_a 1:seen") == 1);
    CHECK(seen.count("1:seen 1:on_b") == 1);
    CHECK(seen.count("1:on_a 1:seen") == 1);
    CHECK(seen.count("1:seen") == 1);
    CHECK(seen.count("0:on_b") == 1);
    for (const std::string& text : seen) {
        const bool both =
            text.find("on_a") != std::string::npos && text.find("on_b") != std::string::npos;
        CHECK_FALSE(both);  // one event at most
    }
}

TEST_CASE("scripted: what was recorded replays to the same log and the same state [law]") {
    const Net net = philosophers(5);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        // Answers that differ from run to run.
        class Dice final : public Chooser {
         public:
            explicit Dice(std::uint64_t key) : stream_{key, 0} {}
            std::int64_t choose(const Choice& c) override {
                return c.options != 0 ? static_cast<std::int64_t>(stream_.below(c.options))
                                      : stream_.between(c.low.ticks, c.high.ticks);
            }

         private:
            RandomStream stream_;
        } dice(seed);
        RecordingChooser recorder(dice);
        Engine first(net, recorder);
        first.start();
        first.run(1000, 200);
        ScriptedChooser script(recorder.answers());
        Engine second(net, script);
        second.start();
        second.run(1000, 200);
        CHECK(script.exhausted());
        CHECK_FALSE(script.misfit());
        CHECK(first.state().log_hash == second.state().log_hash);
        CHECK(hash(net, first.state()) == hash(net, second.state()));
    }
}

TEST_CASE("a script that does not fit is told [unit]") {
    const Net net = philosophers(3);
    ScriptedChooser script({99, -5, 7});
    Engine engine(net, script);
    engine.start();
    engine.run(100, 20);
    CHECK(script.misfit());
}

TEST_CASE(
    "a state that is kept and given back has the same future, at any instant and within one "
    "[law]") {
    const Net net = philosophers(7);
    RandomChooser random;
    EngineOptions options;
    options.seed = 5;
    Engine engine(net, random, options);
    engine.start();
    for (int step = 0; step < 150; ++step) {
        Engine copy(net, random, options);
        copy.restore(engine.save());
        Engine decoded(net, random, options);
        const std::vector<std::uint8_t> bytes = write_state(net, engine.save());
        Checked<State> read = read_state(net, bytes);
        REQUIRE(read);
        CHECK(hash(net, *read) == hash(net, engine.state()));
        decoded.restore(std::move(read).value());
        Engine original(net, random, options);
        original.start();
        original.run(1'000'000, engine.state().firings + 50);
        copy.run(1'000'000, engine.state().firings + 50);
        decoded.run(1'000'000, engine.state().firings + 50);
        CHECK(copy.state().log_hash == original.state().log_hash);
        CHECK(decoded.state().log_hash == original.state().log_hash);
        CHECK(write_state(net, decoded.save()) == write_state(net, original.save()));
        engine.step();
    }
}

TEST_CASE("states with the same future have the same bytes, whatever the time [unit]") {
    Maker m;
    m.place("a", 1, lasts(2));
    m.place("b", 0, lasts(3));
    m.t("t", {"a"}, {"b"});
    m.t("u", {"b"}, {"a"});
    const Net net = m.net();
    RandomChooser random;
    Engine engine(net, random);
    engine.start();
    const std::uint64_t start = hash(net, engine.state());
    engine.step();
    CHECK(hash(net, engine.state()) != start);
    engine.step();
    CHECK(engine.state().now == 5 * kSecond);
    CHECK(hash(net, engine.state()) == start);
}

TEST_CASE("damaged bytes are refused, never a crash [hostile]") {
    const Net net = philosophers(4);
    RandomChooser random;
    Engine engine(net, random);
    engine.start();
    engine.run(1000, 9);
    const std::vector<std::uint8_t> good = write_state(net, engine.save());
    CHECK(read_state(net, good));
    CHECK_FALSE(read_state(philosophers(5), good));
    for (std::size_t cut = 0; cut < good.size(); ++cut) {
        CHECK_FALSE(read_state(net, {good.data(), cut}));
    }
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const int flip : {1, 0x55, 0x80}) {
            std::vector<std::uint8_t> bad = good;
            bad[i] = static_cast<std::uint8_t>(bad[i] ^ flip);
            Checked<State> state = read_state(net, bad);
            if (state) {
                Engine other(net, random);
                other.restore(std::move(state).value());
                other.run(other.state().now + 100, other.state().firings + 20);
            }
        }
    }
}

TEST_CASE("of a discrete distribution nothing between its values can be chosen [unit]") {
    Maker m;
    m.place("P", 1,
            drawn(DistributionKind::kDiscrete,
                  {Expr::time(seconds(1)), Expr::real(1), Expr::time(seconds(3)), Expr::real(2)}));
    m.t("t", {"P"}, {"Q"});
    for (const auto& [answer, lasts] : {std::pair{1.9, 1}, {2.1, 3}, {3.0, 3}}) {
        ScriptedChooser script({seconds(answer).ticks});
        Run run(m.net(), &script);
        run.until(10);
        CHECK(run.log.text == std::to_string(lasts) + ":t");
    }
}

}  // namespace
}  // namespace puppetri::net
