// SPDX-License-Identifier: MIT
// The loop for processors with AVX2 (module.cmake compiles this file for them).
#include "limb_batch_kernel.h"

#if defined(PUPPETRI_MOTION_AVX2)
namespace puppetri::motion {

const LimbLoop<double> kLimbLoopDouble4 = limb_loop<simd::Double4>;
const LimbLoop<float> kLimbLoopFloat8 = limb_loop<simd::Float8>;

}  // namespace puppetri::motion
#endif
