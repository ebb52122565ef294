// SPDX-License-Identifier: MIT
// What figures really did: a rule about phases and holders asked of a performance.
#pragma once
#include <optional>

#include "puppetri/scene/scene.h"
#include "puppetri/stage/stage.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

// The first time (sampled 480 times a second, from 0 to `end`) at which the rule is broken; nothing
// if it is not, or speaks of more than figures. The stage is empty afterwards.
std::optional<SimTime> judge_figures(const scene::Scene& scene, const Obligation& obligation,
                                     stage::Stage& stage, SimTime end);

}  // namespace puppetri::verdict
