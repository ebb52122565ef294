// SPDX-License-Identifier: MIT
// The instrument that measures motion against the table "What good motion measures". It sees joint
// transforms in the world over time and nothing else, so that it judges a performance and an
// exported file read back alike. It knows neither controls nor movements.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/figure/mannequin.h"

namespace puppetri::test {

// A foot (0 left, 1 right) that is meant to stand on the floor during [begin, end].
struct Planted {
    int side = 0;
    double begin_s = 0, end_s = 0;
};

struct MeasureInput {
    const figure::Figure& figure;  // joints, contact points, limits
    // Fills world_from_joint, one per joint of the figure's skeleton.
    std::function<void(double t_s, std::span<Transform> world_from_joint)> sample;
    double begin_s = 0, end_s = 0, rate_hz = 480;
    std::vector<Planted> planted;  // in any order; measured in the parts inside [begin, end]
    std::vector<double> joins_s;   // instants at which one movement follows another
    double floor_y = 0;
    double steady_begin_s = 0, steady_end_s = -1;  // where the gait is steady; empty: nowhere
};

// The worst value of one quantity, and where and when it happened.
struct Worst {
    double value = 0;
    double at_s = 0;
    std::string where;
};

struct JointMeasures {
    Worst speed_rad_s;
    Worst acceleration_rad_s2;
};

struct Step {  // one swing of one foot
    int side = 0;
    double begin_s = 0, end_s = 0;
    double knee_deg = 0;  // largest flexion
    double clearance_mm =
        0;  // lowest point of the foot at mid swing (when it passes the other foot, else half way)
    double highest_mm = 0;  // largest height of the lowest point of the foot
    double length_m = 0;    // how far the ankle travelled over the floor
    double pelvis_rise_mm =
        0;  // from the lowest to the highest pelvis between this swing's and the next's middle
};

struct Measures {
    Worst slip_mm, sink_mm, hover_mm;  // of planted feet
    Worst swing_sink_mm;               // any foot, any time: below the floor
    Worst knee_stance_deg;    // largest flexion of a planted leg while it stands alone or has just
                              // landed
    Worst knee_planted_deg;   // the same during the whole planted interval, push-off included
    std::vector<Step> steps;  // swings wholly inside [begin, end]
    double rise_mm = 0;       // largest pelvis_rise_mm
    double sway_mm = 0;       // width of the pelvis's path across its mean direction
    Worst pelvis_acceleration;  // m/s^2
    Worst pelvis_steady;        // m/s^2, within the steady interval
    JointMeasures knee, hip, ankle, toes, spine, neck, arm, fingers;
    Worst limit_excess_deg;
    Worst join_position_m;  // jump of any joint from one side of a join to the other, motion taken
                            // out
    Worst join_pelvis_m_s, join_hand_m_s, join_foot_m_s;  // jump of velocity
    Worst join_acceleration_ratio;  // angular acceleration across the join against the larger of
                                    // both sides
    std::vector<Planted>
        detected;  // when feet stood, by geometry alone (within 2 mm of the floor and at rest)
};

Measures measure(const MeasureInput& input);

// One line per quantity, for people.
std::string report(const Measures& measures);

}  // namespace puppetri::test
