// SPDX-License-Identifier: MIT
// The loops for every processor: one lane, and four.
#include "packed_kernels.h"

namespace puppetri::motion {

const PackedKernels kKernels1 = kernels_of<simd::Float1>();
const PackedKernels kKernels4 = kernels_of<simd::Float4>();

}  // namespace puppetri::motion
