// SPDX-License-Identifier: MIT
// Runs of keys that meet: what all edits that put stretches one behind the other share.
#pragma once
#include <cmath>
#include <vector>

#include "puppetri/motion/clip.h"

namespace puppetri::motion {

inline constexpr double kSame_s = 1e-9;  // keys nearer than this are one
inline constexpr double kJump_s = 1e-6;  // what a jump takes where two runs do not meet

inline double apart(Quat a, Quat b) { return angle_between(a, b); }
inline double apart(Vec3 a, Vec3 b) { return length(a - b); }
inline double apart(double a, double b) { return std::fabs(a - b); }

// Puts later keys behind those that are there. Where both have a key at one instant there is one
// afterwards if their values are the same, else a jump.
template <class Key>
void append_keys(std::vector<Key>& keys, std::vector<Key> more) {
    if (more.empty()) {
        return;
    }
    if (!keys.empty()) {
        Key& last = keys.back();
        if (more.front().t_s > last.t_s + kSame_s) {
            last.interpolation = Interpolation::kLinear;
        } else if (apart(last.value, more.front().value) < 1e-9) {
            more.front().in = last.in;
            more.front().t_s = last.t_s;
            keys.pop_back();
        } else {
            last.interpolation = Interpolation::kLinear;
            more.front().t_s = last.t_s + kJump_s;
            if (more.size() > 1 && more[1].t_s <= more[0].t_s + kSame_s) {
                more.erase(more.begin());
            }
        }
    }
    keys.insert(keys.end(), more.begin(), more.end());
}

}  // namespace puppetri::motion
