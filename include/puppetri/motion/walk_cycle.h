// SPDX-License-Identifier: MIT
// Walk cycles out of captures: where feet stand, how long a stride is, and one stride cut out as a
// clip that repeats without a seam and travels.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// The joints of one leg that meet the floor. Without toes the foot alone tells.
struct FootJoints {
    std::string foot, toes;
};

// A foot stands when one of its points is low and slow, and has left when all are high or fast: two
// pairs of thresholds, so that noise between them changes nothing. Heights are above the lowest
// that the point usually is (the twentieth part of its heights lies below).
struct ContactThresholds {
    double low_m = 0.03, high_m = 0.06;
    double slow_m_s = 0.35, fast_m_s = 0.7;
    double shortest_s = 0.05;  // shorter contacts and shorter gaps are noise
};

// Marks "contact" about the foot's joint, in the order of time.
// Needs   a clip that plays on the skeleton; +Y up, metres.
// Source  thresholds on height and speed: J. Lee et al., "Interactive control of avatars animated
//         with human motion data", SIGGRAPH 2002, section 3.1; two of each (a Schmitt trigger) and
//         the floor from the data are ours.
std::vector<ClipMark> find_contacts(const Clip& clip, const figure::Skeleton& skeleton,
                                    const FootJoints& foot, const ContactThresholds& thresholds);

struct CycleOptions {
    ContactThresholds contacts = {};
    double shortest_s = 0.5, longest_s = 2.5;  // of a stride: two steps
    double begin_s = 0, end_s = 1e9;           // where in the clip to look
    // Ends that fit worse than this are no repetition: there is then no stride.
    double worst_mismatch_m = 0.12;
    double blend_s = 0.2;  // over which the loop is closed
    // A walk or run: the right foot lands in the middle three fifths of the stride. Otherwise any
    // landings will do, together too: hops.
    bool alternating = true;
    bool straight = true;  // takes out the turn of a stride, where that is below 30 degrees
};

struct WalkCycle {
    Clip clip;               // loops; begins when the left foot lands, at the origin, towards +Z
    double begin_s = 0;      // in the capture
    double mismatch_m = 0;   // of the joints at both ends before closing: their mean distance
    double travel_m = 0;     // of a stride
    double duty_factor = 0;  // share of the stride for which a foot stands, mean of both
};

// Cuts out the stride whose ends fit best, over all strides between landings of the left foot and a
// tenth of a second around: the places and velocities of all joints, both seen from the root.
// Gives   marks "contact" and "foot_strike" of both feet.
// Fails   "no-root", "no-foot" (with the joint's name), "no-stride": the left foot does not land
//         twice within the range, or the right foot not in between (see alternating), or no two
//         ends fit.
// Source  comparing clouds of points after planar alignment: L. Kovar, M. Gleicher, F. Pighin,
//         "Motion graphs", SIGGRAPH 2002, section 3.1.
Checked<WalkCycle> cut_walk_cycle(const Clip& clip, const figure::Skeleton& skeleton,
                                  const std::array<FootJoints, 2>& feet,
                                  const CycleOptions& options = {});

}  // namespace puppetri::motion
