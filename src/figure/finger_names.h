// SPDX-License-Identifier: MIT
// The joints of the fingers without their side: thumb first, from the palm to the tip.
#pragma once
#include <array>

#include "puppetri/figure/mannequin.h"

namespace puppetri::figure {

inline constexpr std::array<const char*, kFingerJointCount> kFingerNames{
    "ThumbMetacarpal",   "ThumbProximal",      "ThumbDistal",      "IndexProximal",
    "IndexIntermediate", "IndexDistal",        "MiddleProximal",   "MiddleIntermediate",
    "MiddleDistal",      "RingProximal",       "RingIntermediate", "RingDistal",
    "LittleProximal",    "LittleIntermediate", "LittleDistal"};

}  // namespace puppetri::figure
