// SPDX-License-Identifier: MIT
// The loop over limbs, for every width. Included by one source per set of instructions; what has a
// body is in an unnamed namespace or instantiated for that source's types alone.
#pragma once
#include <algorithm>
#include <cstddef>

#include "limb_kernel.h"
#include "puppetri/motion/limb_batch.h"

namespace puppetri::motion {

template <class T>
using LimbLoop = void (*)(const LimbIk&, const LimbGoalsSoa<T>&, const LimbPosesSoa<T>&);
#if defined(PUPPETRI_MOTION_AVX2)
extern const LimbLoop<double> kLimbLoopDouble4;
extern const LimbLoop<float> kLimbLoopFloat8;
#endif

namespace {

// Lanes from i on; those beyond the end repeat the last element.
template <class F>
F lanes(std::span<const typename F::Scalar> from, std::size_t i) {
    if (i + F::kLanes <= from.size()) {
        return F::load(from.data() + i);
    }
    typename F::Scalar tail[F::kLanes];
    for (std::size_t k = 0; k < F::kLanes; ++k) {
        tail[k] = from[std::min(i + k, from.size() - 1)];
    }
    return F::load(tail);
}
template <class F>
void keep(F value, std::span<typename F::Scalar> to, std::size_t i) {
    if (i + F::kLanes <= to.size()) {
        value.store(to.data() + i);
        return;
    }
    typename F::Scalar tail[F::kLanes];
    value.store(tail);
    std::copy(tail, tail + (to.size() - i), to.begin() + static_cast<std::ptrdiff_t>(i));
}

template <class F, bool kRotation>
void limb_loop_of(const LimbIk& ik, const LimbGoalsSoa<typename F::Scalar>& goals,
                  const LimbPosesSoa<typename F::Scalar>& poses) {
    const LimbTriangle& triangle = ik.tables().triangle;
    const Vec3 start = ik.shape().start;
    const auto t = kernel::triangle_of<F>(triangle);
    const F sign = F::all(static_cast<typename F::Scalar>(triangle.sign));
    const auto all = [](double x) { return F::all(static_cast<typename F::Scalar>(x)); };
    const kernel::V3<F> from{all(start.x), all(start.y), all(start.z)},
        on_root{F::all(0), F::all(-1), F::all(0)};
    const auto& p = goals.position_parent;
    const auto& z = goals.swivel_zero;
    const auto& r = goals.rotation_parent;
    for (std::size_t i = 0; i < p[0].size(); i += F::kLanes) {
        const kernel::V3<F> target =
            kernel::V3<F>{lanes<F>(p[0], i), lanes<F>(p[1], i), lanes<F>(p[2], i)} - from;
        const kernel::V3<F> zero{lanes<F>(z[0], i), lanes<F>(z[1], i), lanes<F>(z[2], i)};
        kernel::Q4<F> rotation{};
        if constexpr (kRotation) {
            rotation = {lanes<F>(r[0], i), lanes<F>(r[1], i), lanes<F>(r[2], i), lanes<F>(r[3], i)};
        }
        F c = F::all(1), s = F::all(0);
        if (!goals.swivel[0].empty()) {
            c = lanes<F>(goals.swivel[0], i);
            s = lanes<F>(goals.swivel[1], i);
        }
        const auto out =
            kernel::solve<F, kRotation>(t, target, on_root, rotation, zero, c, s, sign);
        const auto keep4 = [&](const kernel::Q4<F>& q,
                               const std::array<std::span<typename F::Scalar>, 4>& to) {
            keep(q.x, to[0], i);
            keep(q.y, to[1], i);
            keep(q.z, to[2], i);
            keep(q.w, to[3], i);
        };
        keep4(out.start, poses.start);
        keep4(out.hinge, poses.hinge);
        if constexpr (kRotation) {
            keep4(out.end, poses.end);
        }
        keep(out.residual, poses.residual_m, i);
    }
}

template <class F>
void limb_loop(const LimbIk& ik, const LimbGoalsSoa<typename F::Scalar>& goals,
               const LimbPosesSoa<typename F::Scalar>& poses) {
    if (goals.rotation_parent[0].empty()) {
        limb_loop_of<F, false>(ik, goals, poses);
    } else {
        limb_loop_of<F, true>(ik, goals, poses);
    }
#if defined(__AVX2__)
    // Upper halves that stay dirty slow down all that comes after; the compiler has been seen to
    // forget them.
    _mm256_zeroupper();
#endif
}

}  // namespace
}  // namespace puppetri::motion
