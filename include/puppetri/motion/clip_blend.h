// SPDX-License-Identifier: MIT
// Two clips made one: cycles blended by phase, and transitions by inertialization.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// Where two cycles are alike: at_a of one and at_b of the other are the same phase.
struct PhasePoint {
    double at_a_s = 0, at_b_s = 0;
};

// The landings ("foot_strike") of these feet, in the order of a; both clips must have one of each.
// Empty where one has not.
std::vector<PhasePoint> phases_of(const Clip& a, const Clip& b, std::span<const std::string> feet);

// A cycle between two: time runs so that equal phases meet, its length and its stride are between
// theirs; weight 0 is a, 1 is b.
// Needs   two loops with the same root that begin in the same phase; points between their begin and
//         end, ascending in both.
// Gives   keys at rate_hz, linear; marks of a. Tracks that one clip lacks are the other's.
// Source  timewarps by correspondences: A. Bruderlin and L. Williams, "Motion signal processing",
//         SIGGRAPH 1995, section 3.3; L. Kovar and M. Gleicher, "Flexible automatic motion blending
//         with registration curves", SCA 2003.
Clip blended_cycles(const Clip& a, const Clip& b, double weight, std::span<const PhasePoint> points,
                    double rate_hz = 60);

// Up to at_s `first`, from there on `second` from its second_s on, whose difference to where first
// is, and how fast, fades within blend_s (motion/inertialize.h). The root of the second goes on
// from where the first's is. Gives   a clip that is continuous in value and rate at the seam, but
// for corners of its own.
Clip transition(const Clip& first, double at_s, const Clip& second, double second_s,
                double blend_s);

}  // namespace puppetri::motion
