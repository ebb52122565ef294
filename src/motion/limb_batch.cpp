// SPDX-License-Identifier: MIT
// The loop over limbs for every processor, and the choice of the width.
#include "puppetri/motion/limb_batch.h"

#include "limb_batch_kernel.h"
#include "puppetri/base/require.h"

namespace puppetri::motion {
namespace {

template <class T, std::size_t kCount>
void require_size(const std::array<std::span<T>, kCount>& spans, std::size_t size) {
    for (const std::span<T>& span : spans) {
        PUP_REQUIRE(span.size() == size);
    }
}

template <class T>
void require_sizes(const LimbGoalsSoa<T>& goals, const LimbPosesSoa<T>& poses) {
    const std::size_t size = goals.position_parent[0].size();
    require_size(goals.position_parent, size);
    require_size(goals.swivel_zero, size);
    require_size(goals.swivel, goals.swivel[0].empty() ? 0 : size);
    const bool rotations = !goals.rotation_parent[0].empty();
    require_size(goals.rotation_parent, rotations ? size : 0);
    require_size(poses.start, size);
    require_size(poses.hinge, size);
    PUP_REQUIRE(poses.residual_m.size() == size);
    if (rotations) {
        require_size(poses.end, size);
    }
}

#if defined(PUPPETRI_MOTION_AVX2)
bool has_avx2() {
    static const bool has = __builtin_cpu_supports("avx2");
    return has;
}
#endif

}  // namespace

void solve_limbs_soa(const LimbIk& ik, const LimbGoalsSoa<double>& goals,
                     const LimbPosesSoa<double>& poses, BatchWidth width) {
    require_sizes(goals, poses);
    if (width == BatchWidth::kOne) {
        return limb_loop<simd::Double1>(ik, goals, poses);
    }
#if defined(PUPPETRI_MOTION_AVX2)
    if (width == BatchWidth::kWidest && has_avx2()) {
        return kLimbLoopDouble4(ik, goals, poses);
    }
#endif
    limb_loop<simd::Double2>(ik, goals, poses);
}

void solve_limbs_soa(const LimbIk& ik, const LimbGoalsSoa<float>& goals,
                     const LimbPosesSoa<float>& poses, BatchWidth width) {
    require_sizes(goals, poses);
    if (width == BatchWidth::kOne) {
        return limb_loop<simd::Float1>(ik, goals, poses);
    }
#if defined(PUPPETRI_MOTION_AVX2)
    if (width == BatchWidth::kWidest && has_avx2()) {
        return kLimbLoopFloat8(ik, goals, poses);
    }
#endif
    limb_loop<simd::Float4>(ik, goals, poses);
}

}  // namespace puppetri::motion
