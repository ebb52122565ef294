// SPDX-License-Identifier: MIT
// What figures really did: a rule about phases and holders asked of a performance.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "puppetri/scene/scene.h"
#include "puppetri/stage/stage.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

// How many tokens there were where, from which time on, in order of time; of one instant the last
// counts.
struct MarkingLog {
    std::vector<SimTime> at;
    std::vector<std::vector<std::uint32_t>> tokens;  // per place
};

// The first time (sampled 480 times a second, from 0 to `end`) at which the rule is broken; nothing
// if it is not, or speaks of more than figures and tokens. The stage is empty afterwards.
std::optional<SimTime> judge_figures(const scene::Scene& scene, const Obligation& obligation,
                                     stage::Stage& stage, const MarkingLog& log, SimTime end);

}  // namespace puppetri::verdict
