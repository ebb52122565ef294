// SPDX-License-Identifier: MIT
// `solver stiff by sundials`: against published values, closed forms and our own stiff method where
// the build has the part; what is said where it has not; and scenes that play off baked courses.
#include "puppetri/scene/sundials.h"

#include <cmath>

#include "files.h"
#include "math/formula_system.h"
#include "puppetri/run/course_book.h"
#include "puppetri/scene/perform.h"
#include "run/equate.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

bool skipped() {
    if (sundials_version().empty()) {
        MESSAGE("skipped: this build has no SUNDIALS");
        return true;
    }
    return false;
}

struct Went {
    std::vector<double> x;
    int steps = 0;
    double end_s = 0;
    bool good = true;
    double gap = 0;  // the greatest jump of the course between two steps
};

template <class F>
Went integrate(FormulaSystem<F>& system, const std::vector<double>& x, double until,
               OdeOptions options, double (*truth)(double) = nullptr, double* worst = nullptr) {
    run::EquationSystem equations;
    equations.variables.resize(system.n);
    equations.options = options;
    equations.options.method = OdeMethod::kGiven;
    const auto source = sundials_sources()->source(equations);
    Went out;
    REQUIRE(source->start(system, 0, until, x, {}) == run::StepSource::Outcome::kStepped);
    out.x = x;
    while (out.good && source->now_s() < until) {
        OdeStep step;
        out.good = source->step(system, step) == run::StepSource::Outcome::kStepped;
        for (std::uint32_t i = 0; out.good && i < system.n; ++i) {
            out.gap = std::max(out.gap, std::fabs(step.at(0, i) - out.x[i]));
            out.x[i] = step.at(1, i);
        }
        for (int i = 0; out.good && truth != nullptr && i <= 8; ++i) {
            const double t = step.begin_s + step.length_s * i / 8;
            *worst = std::max(*worst, std::fabs(step.at(i / 8.0, 0) - truth(t)));
        }
        ++out.steps;
    }
    out.end_s = source->now_s();
    return out;
}

TEST_CASE("CVODE's courses are closed forms, between the steps too, and have no gaps [oracle]") {
    if (skipped()) {
        return;
    }
    FormulaSystem decay(1, [](double, auto x, auto out) { out[0] = -x[0]; });
    double worst = 0;
    Went w = integrate(
        decay, {1}, 5, {.relative = 1e-9, .absolute = 1e-12}, [](double t) { return std::exp(-t); },
        &worst);
    CHECK(worst < 1e-7);
    CHECK(w.gap == 0);
    CHECK(w.end_s == 5);
    FormulaSystem spring(2, [](double, auto x, auto out) {
        out[0] = x[1];
        out[1] = -x[0];
    });
    worst = 0;
    w = integrate(
        spring, {0, 1}, 20, {.relative = 1e-9, .absolute = 1e-12},
        [](double t) { return std::sin(t); }, &worst);
    CHECK(worst < 1e-5);
    CHECK(w.gap == 0);
}

// The references of math/ode_test.
TEST_CASE("Robertson's reaction and van der Pol's oscillator end at published values [oracle]") {
    if (skipped()) {
        return;
    }
    FormulaSystem reaction(3, [](double, auto y, auto out) {
        out[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        out[2] = 3e7 * y[1] * y[1];
        out[1] = -out[0] - out[2];
    });
    const Went late =
        integrate(reaction, {1, 0, 0}, 1e11, {.relative = 1e-8, .absolute = 1e-18, .most_s = 1e12});
    REQUIRE(late.good);
    CHECK(late.x[0] == doctest::Approx(0.2083340149701255e-7).epsilon(1e-4));
    CHECK(late.x[1] == doctest::Approx(0.8333360770334713e-13).epsilon(1e-4));
    CHECK(late.x[2] == doctest::Approx(0.9999999791665050).epsilon(1e-9));
    CHECK(late.steps < 5000);
    FormulaSystem oscillator(2, [](double, auto y, auto out) {
        out[0] = y[1];
        out[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6;
    });
    const Went w = integrate(oscillator, {2, 0}, 2, {.relative = 1e-9, .absolute = 1e-11});
    REQUIRE(w.good);
    CHECK(w.x[0] == doctest::Approx(1.706167732170483).epsilon(1e-5));
    CHECK(w.x[1] == doctest::Approx(-0.8928097010247975).epsilon(1e-5));
}

TEST_CASE("a solution that leaves for infinity is told at its pole by CVODE [hostile]") {
    if (skipped()) {
        return;
    }
    FormulaSystem pole(1, [](double, auto x, auto out) { out[0] = x[0] * x[0]; });
    const Went w = integrate(pole, {1}, 5, {});
    CHECK_FALSE(w.good);
    CHECK(w.end_s == doctest::Approx(1).epsilon(1e-6));
}

// A rod of 202 points whose ends are held at 0, begun as a sine: it stays one and fades with the
// greatest eigenvalue of the difference equation, which is known in closed form.
struct Rod {
    static constexpr std::uint32_t kPoints = 200;
    run::Maker m;
    run::Equate q;
    double eigenvalue = 0;
    explicit Rod(OdeMethod method) {
        m.event("cool");
        m.place("p", 1);
        m.t("cools", {"p"}, {"p"}).events = {{0}};
        q.s.path = "rod";
        q.s.options = {.method = method, .relative = 1e-7, .absolute = 1e-10};
        const double h = 1.0 / (kPoints + 1), pi = std::acos(-1.0);
        eigenvalue = 4 / (h * h) * std::pow(std::sin(pi * h / 2), 2);
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            q.variable("u", std::sin(pi * h * (i + 1)));
        }
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const run::X left = i == 0 ? run::X(0.0) : run::var(i - 1);
            const run::X right = i + 1 == kPoints ? run::X(0.0) : run::var(i + 1);
            q.rate(i, run::X(1 / (h * h)) * (left + right - run::X(2) * run::var(i)));
        }
        // The middle of the rod comes down to half its height.
        q.event({0}, run::var(kPoints / 2) - run::X(0.5 * std::sin(pi * h * (kPoints / 2 + 1))),
                run::CrossingDirection::kFalls);
    }
};

TEST_CASE("a rod of 200 points cools by its closed form, with a banded matrix [oracle]") {
    if (skipped()) {
        return;
    }
    Rod rod(OdeMethod::kGiven);
    const net::Net n = run::timed(rod.m);
    const auto sources = sundials_sources();
    run::Equations e({rod.q.s}, {.sources = sources.get()});
    const run::Ran ran = run::play(n, e, net::seconds(0.2));
    CHECK(ran.stop == run::Stop::kLimit);
    const double pi = std::acos(-1.0);
    for (const double t : {0.0, 0.01, 0.07, 0.2}) {
        for (const std::uint32_t i : {0u, 17u, 100u, 199u}) {
            const double truth = std::exp(-rod.eigenvalue * t) * std::sin(pi * (i + 1) / 201);
            CHECK(std::fabs(e.value(0, i, net::seconds(t)) - truth) < 1e-5);
        }
    }
    // The crossing is the root of the exponential, at the next millisecond.
    REQUIRE(ran.times.size() == 1);
    CHECK(ran.times[0] == run::crossing_time(std::log(2.0) / rod.eigenvalue));
}

const char* const kReaction =
    "language 1\nscene \"r\"\nuntil 40 s\ncast { ball: sphere }\n"
    "equations reaction(what: prop, scale = 1) {\n"
    " a starts at 1\n b starts at 0\n c starts at 0\n"
    " one = 0.04 Hz*a*scale\n two = 1e4 Hz*b*c\n three = 3e7 Hz*b*b\n"
    " a.rate = two - one\n b.rate = one - two - three\n c.rate = three\n"
    " event half when c rises through 0.2\n what.position = (0 m, 1 m + a*1 m, 0 m)\n"
    " SOLVER\n}\n"
    "place waits tokens 1\nplace done\ngoes: waits -> done on r.half\n"
    "use reaction(ball, SCALE) as r\n";

std::string reaction(const std::string& solver, const std::string& scale = "1") {
    std::string text = kReaction;
    text.replace(text.find("SOLVER"), 6, solver);
    text.replace(text.find("SCALE"), 5, scale);
    return text;
}

Checked<Scene> loaded(const std::string& text, const std::string& courses = "") {
    MemoryFiles files;
    files.add("scene.pup", text);
    if (!courses.empty()) {
        files.add("r.courses", courses);
    }
    return load(files, "scene.pup");
}

TEST_CASE("without the part a scene that asks for it is refused at its line [unit]") {
    const auto scene = loaded(reaction("solver stiff by sundials"));
    if (!sundials_version().empty()) {
        CHECK(scene);
        return;
    }
    REQUIRE_FALSE(scene);
    CHECK(scene.error()[0].code == "no-sundials");
    CHECK(scene.error()[0].where.line == 17);
    CHECK_FALSE(scene.error()[0].remedy.empty());
}

TEST_CASE("lines of solvers that make no sense are told at their place [hostile]") {
    const auto code = [](const std::string& solver) {
        const auto scene = loaded(reaction(solver));
        REQUIRE_FALSE(scene);
        CHECK(scene.error()[0].where.line >= 17);
        return scene.error()[0].code;
    };
    CHECK(code("baked \"r.courses\"") == "wrong-type");
    CHECK(code("solver stiff\n baked \"r.courses\"") == "wrong-type");
    CHECK(code("solver stiff by magic") == "syntax");
    CHECK(code("solver by sundials") == "syntax");
    CHECK(code("solver stiff by sundials\n baked 3") == "syntax");
    CHECK(
        code("solver stiff by sundials\n baked \"r.courses\"\n d starts at 0\n d.rate = past(a, 1 "
             "s)*1 Hz") == "wrong-type");
    // A file that is there and is none.
    const auto scene =
        loaded(reaction("solver stiff by sundials\n baked \"r.courses\""), "nonsense");
    REQUIRE_FALSE(scene);
    CHECK(scene.error()[0].code == "bad-course");
    CHECK(scene.error()[0].where.line == 18);
}

TEST_CASE("a scene names a file that is not baked yet: told, and not run [unit]") {
    const auto scene = loaded(reaction("solver stiff by sundials\n baked \"r.courses\""));
    REQUIRE(scene);
    REQUIRE(scene->notes.size() == 1);
    CHECK(scene->notes[0].code == "not-baked");
    CHECK(scene->notes[0].where.line == 18);
    const auto run = perform(*scene);
    REQUIRE(run);
    REQUIRE(run->fault);
    CHECK(run->fault->code == "not-baked");
}

TEST_CASE("baked once, a scene plays everywhere as it played there, hash for hash [law]") {
    if (skipped()) {
        return;
    }
    const std::string text = reaction("solver stiff by sundials\n baked \"r.courses\"");
    run::CourseBook book;
    const auto fresh = loaded(text);
    const auto made = perform(*fresh, {.bake = &book});
    REQUIRE(made);
    REQUIRE_FALSE(made->fault);
    const std::string bytes = run::write_courses(book);
    const auto scene = loaded(text, bytes);
    REQUIRE(scene);
    CHECK(scene->notes.empty());
    const auto played = perform(*scene);
    REQUIRE(played);
    REQUIRE_FALSE(played->fault);
    CHECK(played->firings == 1);
    CHECK(played->log_hash == made->log_hash);
    // As the part makes it where no file is named.
    const auto live_scene = loaded(reaction("solver stiff by sundials"));
    REQUIRE(live_scene);
    const auto live = perform(*live_scene);
    REQUIRE(live);
    CHECK(live->log_hash == made->log_hash);
    // The built-in method agrees on what happens; the hash says that another made it.
    const auto own_scene = loaded(reaction("solver stiff"));
    REQUIRE(own_scene);
    const auto own = perform(*own_scene);
    REQUIRE(own);
    CHECK(own->firings == 1);
    CHECK(own->log_hash != made->log_hash);
    for (const double t : {1.0, 10.0, 40.0}) {
        CHECK(own->performance->world_from_prop({0}, net::seconds(t)).translation.y ==
              doctest::Approx(
                  played->performance->world_from_prop({0}, net::seconds(t)).translation.y)
                  .epsilon(1e-6));
    }
    // Another parameter, another tolerance: stale, told when it is loaded and when it is run.
    for (const std::string& other :
         {reaction("solver stiff by sundials\n baked \"r.courses\"", "0.9"),
          reaction("solver stiff by sundials\n baked \"r.courses\"\n tolerance 1e-5")}) {
        const auto stale = loaded(other, bytes);
        REQUIRE(stale);
        REQUIRE(stale->notes.size() == 1);
        CHECK(stale->notes[0].code == "stale-course");
        const auto run = perform(*stale);
        REQUIRE(run);
        REQUIRE(run->fault);
        CHECK(run->fault->code == "stale-course");
    }
    // Longer than baked.
    const auto longer = perform(*scene, {.horizon = {.time = net::seconds(4000)}});
    REQUIRE(longer);
    REQUIRE(longer->fault);
    CHECK(longer->fault->code == "not-baked");
}

}  // namespace
