// SPDX-License-Identifier: MIT
// `--for 40s`, `--for 960f`, `--for 1000x`: how long a run goes on.
#pragma once
#include <string>

#include "puppetri/scene/scene.h"

namespace puppetri::cli {

// Reads a number and what it counts: a unit of time (s, ms, min, h), `f` or `frames` (at the
// scene's rate), `x` or `firings`; with or without space between. Fails   with a sentence for
// people.
Result<scene::Horizon, std::string> parse_horizon(const std::string& text,
                                                  const scene::FrameRate& rate);

}  // namespace puppetri::cli
