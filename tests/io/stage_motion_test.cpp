// SPDX-License-Identifier: MIT
// Every example on the stage, each figure measured at 480 Hz over the whole performance against the
// table of good motion: walks, turns, throws and catches as the nets string them together, joins
// included.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "support/example_motion.h"
#include "support/motion_table.h"

using namespace puppetri;
using test::Example;
using test::Measures;
using test::Stretch;

namespace {

constexpr const char* kWalks[] = {
    "02_walk/figure.pup", "02_walk/limbs.pup",        "02_walk/legs.pup",       "02_walk/twice.pup",
    "02_walk/duty.pup",   "10_two_legs/two_legs.pup", "10_two_legs/waiting.pup"};
constexpr const char* kGames[] = {
    "01_toss/toss.pup",    "03_ball/ball.pup",      "03_ball/figure5.pup", "03_ball/impatient.pup",
    "03_ball/no_ball.pup", "03_ball/two_balls.pup", "03_ball/waits.pup"};

bool walks(const Stretch& s) {
    return s.movement == "step" || s.movement == "half_step" || s.movement == "walk" ||
           s.movement == "support";
}
// A step in the middle of a walk; its place is one of those that all walks name so.
bool whole_step(const Stretch& s) {
    return s.place.find("P4") != std::string::npos || s.place.find("P6") != std::string::npos ||
           s.place.find("lifted") != std::string::npos;
}

// What holds for whatever the net strings together.
void check_always(const Example& e, std::uint32_t actor, const Measures& m) {
    test::check_rows(e.name, e.actor(actor), test::table_of_stage(m));
}

const Stretch* stretch_at(const std::vector<Stretch>& list, double t_s) {
    for (const Stretch& s : list) {
        if (s.begin_s <= t_s && t_s < s.end_s) {
            return &s;
        }
    }
    return nullptr;
}

// Swings of walks. Gives how many there were.
int check_swings(const Measures& m, const std::vector<Stretch>& stretches) {
    int swings = 0;
    for (const test::Step& step : m.steps) {
        const Stretch* s = stretch_at(stretches, (step.begin_s + step.end_s) / 2);
        if (s == nullptr || !walks(*s)) {
            continue;
        }
        ++swings;
        CAPTURE(step.begin_s);
        CHECK(step.knee_deg >= 50);
        CHECK(step.knee_deg <= 70);
        CHECK(step.clearance_mm >= 10);
        CHECK(step.highest_mm <= 60);
    }
    return swings;
}

}  // namespace

TEST_CASE("every walk of the examples keeps the table of good motion [law]") {
    for (const char* name : kWalks) {
        const Example& e = test::example(name);
        for (std::uint32_t actor = 0; actor < e.actors(); ++actor) {
            const Measures m = test::measured_on_stage(e, actor, 0, e.end_s());
            const std::vector<Stretch> stretches = test::stretches_of(e, actor, e.end_s());
            CAPTURE(name);
            CAPTURE(e.actor(actor));
            INFO(test::report(m));
            check_always(e, actor, m);
            CHECK(m.arm.acceleration_rad_s2.value <= 400);
            CHECK(m.knee_stance_deg.value <= 25);
            CHECK(m.sway_mm >= 20);
            CHECK(m.sway_mm <= 50);
            CHECK(check_swings(m, stretches) >= 4);
            // From the middle of a whole step to the middle of the next.
            int rises = 0;
            for (std::size_t i = 0; i + 1 < m.steps.size(); ++i) {
                auto whole = [&](const test::Step& step) {
                    const Stretch* s = stretch_at(stretches, (step.begin_s + step.end_s) / 2);
                    return s != nullptr && whole_step(*s);
                };
                if (whole(m.steps[i]) && whole(m.steps[i + 1])) {
                    ++rises;
                    CAPTURE(m.steps[i].begin_s);
                    CHECK(m.steps[i].pelvis_rise_mm >= 20);
                    CHECK(m.steps[i].pelvis_rise_mm <= 60);
                }
            }
            CHECK(rises >= 1);
            // Steady: whole steps after a whole step and before one.
            for (std::size_t i = 1; i + 1 < stretches.size(); ++i) {
                if (whole_step(stretches[i - 1]) && whole_step(stretches[i]) &&
                    whole_step(stretches[i + 1])) {
                    CHECK(
                        test::measured_on_stage(e, actor, stretches[i].begin_s, stretches[i].end_s)
                            .pelvis_acceleration.value <= 2.5);
                }
            }
        }
    }
}

TEST_CASE(
    "legs of a script that pause in the middle of a stride come to rest within the table [law]") {
    const Example& e = test::example("10_two_legs/sampled.pup");
    const Measures m = test::measured_on_stage(e, 0, 0, e.end_s());
    const std::vector<Stretch> stretches = test::stretches_of(e, 0, e.end_s());
    INFO(test::report(m));
    check_always(e, 0, m);
    CHECK(check_swings(m, stretches) == 4);
    CHECK(m.knee_stance_deg.value <= 40);  // over the front foot, the other one on its toes
}

TEST_CASE(
    "feet stand for the duty factor's part of the period, to a frame, as seen and as told "
    "[law]") {
    struct Walker {
        const char* name;
        std::uint32_t actor;
        double n_s, duty;
    };
    for (const Walker& w : {Walker{"02_walk/duty.pup", 0, 20.0 / 24, 0.5},
                            Walker{"02_walk/duty.pup", 1, 20.0 / 24, 0.62},
                            Walker{"02_walk/duty.pup", 2, 20.0 / 24, 0.75},
                            Walker{"02_walk/twice.pup", 0, 16.0 / 24, 0.62}}) {
        const Example& e = test::example(w.name);
        const std::vector<Stretch> stretches = test::stretches_of(e, w.actor, e.end_s());
        const Measures m = test::measured_on_stage(e, w.actor, 0, e.end_s());
        CAPTURE(w.name);
        CAPTURE(w.actor);
        constexpr double kFrame_s = 1.0 / 24;
        int steady = 0;
        for (const test::Planted& p : test::planted_of(e, w.actor, e.end_s())) {
            const bool seen =
                std::any_of(m.detected.begin(), m.detected.end(), [&](const test::Planted& d) {
                    return d.side == p.side && std::fabs(d.begin_s - p.begin_s) <= kFrame_s &&
                           std::fabs(d.end_s - p.end_s) <= kFrame_s;
                });
            CAPTURE(p.begin_s);
            CHECK(seen);
            // It struck in a whole step, stood through the next and left in the one after that.
            const Stretch* struck = stretch_at(stretches, p.begin_s - 0.01);
            const Stretch* left = stretch_at(stretches, p.end_s + 0.01);
            if (struck != nullptr && left != nullptr && whole_step(*struck) && whole_step(*left) &&
                std::fabs(struck->end_s - struck->begin_s - w.n_s) < 1e-6 &&
                p.end_s < e.end_s() - 0.1) {
                CHECK(std::fabs(p.end_s - p.begin_s - 2 * w.n_s * w.duty) <= kFrame_s);
                ++steady;
            }
        }
        CHECK(steady >= 1);
    }
}

TEST_CASE(
    "every ball game of the examples keeps the table: walks, turns, throws and catches join "
    "without a jerk or a slip [law]") {
    for (const char* name : kGames) {
        const Example& e = test::example(name);
        for (std::uint32_t actor = 0; actor < e.actors(); ++actor) {
            const Measures m = test::measured_on_stage(e, actor, 0, e.end_s());
            const std::vector<Stretch> stretches = test::stretches_of(e, actor, e.end_s());
            CAPTURE(name);
            CAPTURE(e.actor(actor));
            {
                INFO(test::report(m));
                check_always(e, actor, m);
                CHECK(check_swings(m, stretches) >=
                      (name == std::string("01_toss/toss.pup") ? 0 : 3));
            }
            // Throwing and catching leaves what is not the arms slow.
            for (const Stretch& s : stretches) {
                if ((s.movement != "throw" && s.movement != "catch") || s.end_s >= e.end_s()) {
                    continue;
                }
                const Measures part = test::measured_on_stage(e, actor, s.begin_s, s.end_s);
                CAPTURE(s.begin_s);
                for (const test::JointMeasures* j :
                     {&part.knee, &part.hip, &part.ankle, &part.toes, &part.neck}) {
                    CHECK(j->speed_rad_s.value <= 6);
                }
            }
        }
    }
}

TEST_CASE("whoever is in an example keeps what the table asks of every movement and join [law]") {
    // Without PUPPETRI_LONG the first figures of a crowd and the first seconds.
    const bool every = std::getenv("PUPPETRI_LONG") != nullptr;
    const auto listed = [](const std::string& name, const auto& list) {
        return std::find(std::begin(list), std::end(list), name) != std::end(list);
    };
    for (const std::string& name : test::example_scenes()) {
        if (listed(name, kWalks) || listed(name, kGames)) {
            continue;  // above, by the whole of it
        }
        const Example& e = test::example(name);
        const std::uint32_t actors = every ? e.actors() : std::min(e.actors(), 5u);
        for (std::uint32_t actor = 0; actor < actors; ++actor) {
            if (e.is_humanoid(actor)) {
                const double end_s = every ? e.end_s() : std::fmin(e.end_s(), 16);
                check_always(e, actor, test::measured_on_stage(e, actor, 0, end_s));
            }
        }
    }
}
