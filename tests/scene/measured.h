// SPDX-License-Identifier: MIT
// A scene performed and measured against the table of good motion.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "files.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/scene/perform.h"
#include "support/measure.h"

namespace puppetri::scene {

inline Performed performed(const Scene& scene) {
    auto p = perform(scene);
    if (!p) {
        FAIL(told(p.error()));
    }
    return std::move(*p);
}

// One mannequin of a performance, between two times; joins are the starts of its movements.
inline test::Measures measured(const Performed& p, const Scene& scene, std::uint32_t actor = 0,
                               double begin_s = 0, double end_s = -1) {
    const stage::Performance& performance = *p.performance;
    const figure::Figure figure = figure::make_mannequin(scene.play.cast.actors[actor].height_m);
    figure::Pose pose;
    std::set<SimTime> joins;
    const double end = end_s < 0 ? performance.duration().seconds() : end_s;
    for (const stage::ScoreEntry& row : performance.score()) {
        if (row.actor == scene.play.cast.actors[actor].name && row.start > SimTime{0} &&
            row.start.seconds() > begin_s && row.start.seconds() < end) {
            joins.insert(row.start);
        }
    }
    std::vector<test::Planted> planted;
    for (int side = 0; side < 2; ++side) {
        const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
        constexpr double kStep_s = 0.004;
        double since = -1;
        for (double t = begin_s; t <= end; t += kStep_s) {
            const bool stands =
                performance.phase({actor}, leg,
                                  SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)}) ==
                motion::Phase::kSupport;
            if (stands && since < 0) {
                since = t;
            } else if (!stands && since >= 0) {
                planted.push_back({side, since, t - kStep_s});
                since = -1;
            }
        }
        if (since >= 0) {
            planted.push_back({side, since, end});
        }
    }
    std::vector<double> at;
    for (const SimTime t : joins) {
        at.push_back(t.seconds());
    }
    return test::measure(
        {.figure = figure,
         .sample =
             [&](double t_s, std::span<Transform> out) {
                 performance.pose({actor},
                                  SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond + 0.5)},
                                  pose);
                 figure::to_model_space(figure.skeleton, pose, out);
             },
         .begin_s = begin_s,
         .end_s = end,
         .planted = planted,
         .joins_s = at});
}

// What every movement holds: limits, floor, and joins.
inline void check_good(const test::Measures& m, const std::string& what) {
    const auto small = [&](const test::Worst& w, double most, const char* quantity) {
        CHECK_MESSAGE(w.value <= most, what << ": " << std::string(quantity) << " " << w.value
                                            << " at " << w.at_s << " s, " << w.where);
    };
    small(m.limit_excess_deg, 0.01, "beyond a limit by degrees");
    small(m.slip_mm, 1, "slip mm");
    small(m.sink_mm, 2, "sink mm");
    small(m.hover_mm, 2, "hover mm");
    small(m.join_position_m, 1e-6, "jump m");
    small(m.join_pelvis_m_s, 0.05, "pelvis velocity m/s");
    small(m.join_hand_m_s, 0.2, "hand velocity m/s");
    small(m.join_foot_m_s, 0.2, "foot velocity m/s");
    small(m.join_acceleration_ratio, 1.5, "acceleration ratio");
}

}  // namespace puppetri::scene
