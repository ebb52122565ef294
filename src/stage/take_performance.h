// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "puppetri/stage/performance.h"
#include "take.h"

namespace puppetri::stage {

// Makes meshes and gaze tracks; nothing changes afterwards.
std::unique_ptr<const Performance> make_take_performance(Take take);

}  // namespace puppetri::stage
