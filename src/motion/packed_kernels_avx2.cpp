// SPDX-License-Identifier: MIT
// The loops for processors with AVX2 (module.cmake compiles this file for them, and no other).
#include "packed_kernels.h"

#if defined(PUPPETRI_MOTION_AVX2)
namespace puppetri::motion {

const PackedKernels kKernels8 = kernels_of<simd::Float8>();

}  // namespace puppetri::motion
#endif
