// SPDX-License-Identifier: MIT
// Which loops run: those asked for, or the widest that this processor has.
#pragma once
#include "puppetri/motion/packed_clip.h"

namespace puppetri::motion {

struct PackedKernels;
const PackedKernels& kernels(Lanes lanes);

}  // namespace puppetri::motion
