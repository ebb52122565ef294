// SPDX-License-Identifier: MIT
// Baked courses: another integrator makes them, a file brings them, and everything goes as it went.
// The other integrator is our own stiff one, behind the interface of foreign ones, so that every
// build can tell that nothing changes on the way.
#include "puppetri/run/course_book.h"

#include <cmath>

#include "puppetri/base/hash.h"
#include "puppetri/base/random.h"
#include "run/equate.h"

namespace puppetri::run {
namespace {

class Disguised final : public StepSource {
 public:
    explicit Disguised(const EquationSystem& s)
        : solver_([&] {
              OdeOptions o = s.options;
              o.method = OdeMethod::kRodas;
              o.watched_from = static_cast<std::uint32_t>(s.variables.size());
              return o;
          }()) {}
    Outcome start(OdeSystem& system, double t_s, double until_s, std::span<const double> x,
                  std::span<const double>) override {
        until_s_ = until_s;
        return solver_.start(system, t_s, x) ? Outcome::kStepped : Outcome::kBlewUp;
    }
    Outcome step(OdeSystem& system, OdeStep& out) override {
        const auto outcome = solver_.step(system, until_s_, out);
        out.method = OdeMethod::kGiven;
        return outcome == OdeSolver::Outcome::kStepped ? Outcome::kStepped : Outcome::kBlewUp;
    }
    double now_s() const override { return solver_.now_s(); }
    Why why() const override { return {}; }

 private:
    OdeSolver solver_;
    double until_s_ = 0;
};

struct Sources final : StepSources {
    std::unique_ptr<StepSource> source(const EquationSystem& s) override {
        return std::make_unique<Disguised>(s);
    }
};

// A ball that bounces off a spring's end, which a datum of the net switches off after a while; a
// difference equation beside it, and a watched quantity of two variables.
struct Machine {
    Maker m;
    Equate q;
    explicit Machine(OdeMethod method, double kept = 0.8) {
        m.event("impact");
        m.event("meets");
        m.place("air", 1);
        m.t("bounce", {"air"}, {"air"}).events = {{0}};
        m.t("met", {"air"}, {"air"}).events = {{1}};
        q.s.path = "fall";
        const auto h = q.variable("h", 2), v = q.variable("v", 0), fast = q.variable("fast", 5),
                   steps = q.variable("steps", 0);
        q.rate(h, var(v));
        q.rate(v, X(-9.81));
        q.rate(fast, X(-500) * (var(fast) - var(h)));
        q.s.variables[steps].next = q.add(var(steps) + X(1));
        q.s.variables[steps].every_ticks = kTicksPerSecond / 4;
        q.event({0}, var(h), CrossingDirection::kFalls);
        q.event({1}, var(fast) - X(0.3) * var(steps), CrossingDirection::kPasses, false);
        q.s.resets.push_back({{0}, v, q.add(X(-kept) * var(v))});
        q.s.options = {.method = method, .relative = 1e-7, .absolute = 1e-10};
    }
};

const SimTime kUntil = seconds(4);

void same_courses(const Equations& a, const Equations& b, SimTime until) {
    bool all = true;
    for (std::int64_t k = 0; k <= 400; ++k) {
        for (std::uint32_t v = 0; v < 4; ++v) {
            const SimTime at{until.ticks / 400 * k};
            all = all && a.value(0, v, at) == b.value(0, v, at);
        }
    }
    CHECK(all);
}

TEST_CASE("steps from elsewhere go the way of our own, bit for bit, in slices too [law]") {
    Machine own(OdeMethod::kRodas), other(OdeMethod::kGiven);
    const net::Net n = timed(own.m), n2 = timed(other.m);
    Equations a({own.q.s});
    const Ran ran = play(n, a, kUntil);
    REQUIRE(ran.times.size() >= 8);
    CHECK(a.given_hash(kUntil) == 0);
    Sources sources;
    for (const SimTime slice : {SimTime{0}, seconds(0.05), seconds(0.7)}) {
        Equations b({other.q.s}, {.sources = &sources});
        const Ran again = play(n2, b, kUntil, slice);
        CHECK(again.times == ran.times);
        CHECK(b.given_hash(kUntil) != 0);
        same_courses(a, b, kUntil);
    }
}

CourseBook bake(Machine& machine, SimTime until, std::vector<SimTime>& times) {
    machine.q.s.baked_in = "fall.courses";
    CourseBook book;
    Sources sources;
    const net::Net n = timed(machine.m);
    Equations e({machine.q.s}, {.sources = &sources, .bake = &book});
    times = play(n, e, until).times;
    return book;
}

TEST_CASE("a baked run plays off its file, in any slices, without the integrator [law]") {
    std::vector<SimTime> times;
    Machine machine(OdeMethod::kGiven);
    const std::string bytes = write_courses(bake(machine, kUntil, times));
    REQUIRE(times.size() >= 8);
    auto book = read_courses(bytes, "fall.courses");
    REQUIRE(book);
    CHECK(write_courses(*book) == bytes);
    machine.q.s.baked = std::make_shared<const CourseBook>(std::move(*book));
    CHECK_FALSE(not_baked(machine.q.s));
    const net::Net n = timed(machine.m);
    Machine own(OdeMethod::kRodas);
    const net::Net n_own = timed(own.m);
    Equations reference({own.q.s});
    play(n_own, reference, kUntil);
    for (const SimTime slice : {SimTime{0}, seconds(0.05), seconds(0.7)}) {
        Equations e({machine.q.s});
        const Ran ran = play(n, e, kUntil, slice);
        CHECK(ran.stop == Stop::kLimit);
        CHECK(ran.times == times);
        same_courses(e, reference, kUntil);
    }
    // A snapshot of such a run goes on as the run.
    Equations e({machine.q.s}), f({machine.q.s});
    Log log, log2;
    Player p(n, {.sink = &log, .coupled = {&e}}), p2(n, {.sink = &log2, .coupled = {&f}});
    p.run({.until = seconds(1.3)});
    REQUIRE(p2.restore(p.snapshot()));
    CHECK(p2.snapshot() == p.snapshot());
    p.run({.until = kUntil});
    CHECK(p2.run({.until = kUntil}) == Stop::kLimit);
    CHECK(p2.log_hash() == p.log_hash());
    // Longer than it was baked: it says so.
    Equations longer({machine.q.s});
    const Ran ran = play(n, longer, seconds(40));
    CHECK(ran.stop == Stop::kFault);
    CHECK(ran.fault.code == "not-baked");
}

TEST_CASE("a snapshot of foreign steps comes to the same step again [law]") {
    Machine machine(OdeMethod::kGiven);
    const net::Net n = timed(machine.m);
    Sources sources;
    for (const double at : {0.1, 0.64, 0.75, 1.9, 3.3}) {
        Equations e({machine.q.s}, {.sources = &sources}), f({machine.q.s}, {.sources = &sources});
        Player p(n, {.coupled = {&e}}), p2(n, {.coupled = {&f}});
        p.run({.until = seconds(at)});
        REQUIRE(p2.restore(p.snapshot()));
        p.run({.until = kUntil});
        p2.run({.until = kUntil});
        CHECK(p2.log_hash() == p.log_hash());
        CHECK(p2.snapshot() == p.snapshot());
        CHECK(e.value(0, 2, kUntil) == f.value(0, 2, kUntil));
    }
}

TEST_CASE("what was baked of something else is refused [hostile]") {
    std::vector<SimTime> times;
    Machine machine(OdeMethod::kGiven);
    const auto book = std::make_shared<const CourseBook>(bake(machine, kUntil, times));
    const auto why = [&](EquationSystem s) {
        s.baked = book;
        const auto found = not_baked(s);
        return found ? found->code : std::string();
    };
    CHECK(why(machine.q.s) == "");
    EquationSystem s = machine.q.s;
    s.variables[0].initial = std::nextafter(2.0, 3.0);
    CHECK(why(s) == "stale-course");
    s = machine.q.s;
    s.options.relative = 1e-6;
    CHECK(why(s) == "stale-course");
    s = machine.q.s;
    s.path = "other";
    CHECK(why(s) == "not-baked");
    Machine kept(OdeMethod::kGiven, 0.7);
    kept.q.s.baked_in = "fall.courses";
    CHECK(why(kept.q.s) == "stale-course");
    s = machine.q.s;
    s.baked = nullptr;
    REQUIRE(not_baked(s));
    CHECK(not_baked(s)->code == "not-baked");
    // The same equations in a run that takes another way: the bounce that was baked is not heard.
    machine.q.s.baked = book;
    machine.q.s.resets[0].transition = {1};
    const net::Net n = timed(machine.m);
    Equations e({machine.q.s});
    const Ran ran = play(n, e, kUntil);
    CHECK(ran.stop == Stop::kFault);
    CHECK(ran.fault.code == "not-baked");
    CHECK_FALSE(ran.fault.remedy.empty());
}

TEST_CASE("no bytes make a book that is none, nor stop the program [hostile]") {
    std::vector<SimTime> times;
    Machine machine(OdeMethod::kGiven);
    const std::string good = write_courses(bake(machine, seconds(0.7), times));
    REQUIRE(read_courses(good, "x"));
    for (std::size_t n = 0; n < good.size(); n += n < 200 ? 1 : 97) {
        const auto cut = read_courses(std::string_view(good).substr(0, n), "x");
        REQUIRE_FALSE(cut);
        CHECK(cut.error()[0].code == "bad-course");
    }
    // Whoever knows the hash can write anything: it is read or refused, and what is read is played
    // or refused.
    RandomStream random{7, 0};
    const net::Net n = timed(machine.m);
    int read = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string bytes = good.substr(0, good.size() - 8);
        const std::size_t at =
            19 + static_cast<std::size_t>(random.below(
                     static_cast<std::uint64_t>(i % 2 == 0 ? 400 : bytes.size() - 19)));
        bytes[at] = static_cast<char>(random.below(256));
        const std::uint64_t hash = hash_text(bytes);
        for (int k = 0; k < 8; ++k) {
            bytes += static_cast<char>(hash >> (8 * k));
        }
        auto book = read_courses(bytes, "x");
        if (!book) {
            CHECK(book.error()[0].code == "bad-course");
            continue;
        }
        ++read;
        machine.q.s.baked = std::make_shared<const CourseBook>(std::move(*book));
        Equations e({machine.q.s});
        const Ran ran = play(n, e, seconds(0.7));
        CHECK((ran.stop == Stop::kLimit || ran.stop == Stop::kFault));
    }
    CHECK(read > 100);
}

}  // namespace
}  // namespace puppetri::run
