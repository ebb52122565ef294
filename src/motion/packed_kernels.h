// SPDX-License-Identifier: MIT
// The loops over packed poses, written once for every width of base/simd_float.h, and the table by
// which a width is chosen at run time. Included by one source per set of instructions; everything
// with a body is in an unnamed namespace, so that no function compiled for a newer processor can
// stand in for one that must run on all.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>

#include "puppetri/base/simd_float.h"
#include "puppetri/motion/packed_clip.h"

namespace puppetri::motion {

// Counts are of floats: multiples of 8.
struct PackedKernels {
    // Rotations between two frames in one hemisphere (x, y, z, w, each `from_stride` floats).
    void (*sample)(const float* a, const float* b, float ratio, std::size_t count,
                   std::size_t from_stride, float* out, std::size_t out_stride);
    // Seven components each.
    void (*blend)(const float* a, const float* b, float weight, std::size_t count,
                  std::size_t stride, float* out);
    void (*to_model)(const PackedSkeleton::Run* runs, std::size_t run_count, std::size_t stride,
                     const float* local, float* out);
    // Matrices of 12 floats of a pose in model space: that of slot i at matrices + 12 joint_of[i].
    void (*to_matrices)(const float* model, std::size_t stride, const std::uint32_t* joint_of,
                        std::size_t joints, float* matrices);
};
extern const PackedKernels kKernels1, kKernels4;
#if defined(PUPPETRI_MOTION_AVX2)
extern const PackedKernels kKernels8;
#endif

namespace {

template <class F>
struct Rotation {
    F x, y, z, w;
};

template <class F>
inline void store_unit(Rotation<F> q, float* out, std::size_t stride) {
    const F scale = F::all(1) / sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    (q.x * scale).store(out);
    (q.y * scale).store(out + stride);
    (q.z * scale).store(out + 2 * stride);
    (q.w * scale).store(out + 3 * stride);
}

template <class F>
inline Rotation<F> load_rotation(const float* from, std::size_t stride) {
    return {F::load(from), F::load(from + stride), F::load(from + 2 * stride),
            F::load(from + 3 * stride)};
}

template <class F>
void sample_kernel(const float* a, const float* b, float ratio, std::size_t count,
                   std::size_t from_stride, float* out, std::size_t out_stride) {
    const F r = F::all(ratio);
    for (std::size_t i = 0; i < count; i += F::kLanes) {
        const Rotation<F> p = load_rotation<F>(a + i, from_stride);
        const Rotation<F> q = load_rotation<F>(b + i, from_stride);
        store_unit(Rotation<F>{p.x + (q.x - p.x) * r, p.y + (q.y - p.y) * r, p.z + (q.z - p.z) * r,
                               p.w + (q.w - p.w) * r},
                   out + i, out_stride);
    }
}

template <class F>
void blend_kernel(const float* a, const float* b, float weight, std::size_t count,
                  std::size_t stride, float* out) {
    const F w = F::all(weight), rest = F::all(1 - weight), minus = F::all(-weight);
    for (std::size_t i = 0; i < count; i += F::kLanes) {
        const Rotation<F> p = load_rotation<F>(a + i, stride);
        const Rotation<F> q = load_rotation<F>(b + i, stride);
        const F same = p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w;
        const F s = where_negative(same, minus, w);
        store_unit(Rotation<F>{p.x * rest + q.x * s, p.y * rest + q.y * s, p.z * rest + q.z * s,
                               p.w * rest + q.w * s},
                   out + i, stride);
        for (std::size_t k = 4 * stride + i; k < 7 * stride; k += stride) {
            const F from = F::load(a + k);
            (from + (F::load(b + k) - from) * w).store(out + k);
        }
    }
}

template <class F>
struct Seven {
    Rotation<F> q;
    F tx, ty, tz;
};

template <class F>
inline Seven<F> load_seven(const float* from, std::size_t stride) {
    return {load_rotation<F>(from, stride), F::load(from + 4 * stride), F::load(from + 5 * stride),
            F::load(from + 6 * stride)};
}

// parent * local, as transforms.
template <class F>
inline Seven<F> times(const Seven<F>& p, const Seven<F>& l) {
    const Rotation<F>&a = p.q, &b = l.q;
    Seven<F> out;
    out.q = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
             a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
             a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
             a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    // v + 2 w (u x v) + 2 u x (u x v)
    const F cx = a.y * l.tz - a.z * l.ty, cy = a.z * l.tx - a.x * l.tz,
            cz = a.x * l.ty - a.y * l.tx;
    const F dx = cx + cx, dy = cy + cy, dz = cz + cz;
    out.tx = p.tx + (l.tx + dx * a.w + (a.y * dz - a.z * dy));
    out.ty = p.ty + (l.ty + dy * a.w + (a.z * dx - a.x * dz));
    out.tz = p.tz + (l.tz + dz * a.w + (a.x * dy - a.y * dx));
    return out;
}

template <class F>
inline void store_seven(const Seven<F>& s, float* out, std::size_t stride) {
    s.q.x.store(out);
    s.q.y.store(out + stride);
    s.q.z.store(out + 2 * stride);
    s.q.w.store(out + 3 * stride);
    s.tx.store(out + 4 * stride);
    s.ty.store(out + 5 * stride);
    s.tz.store(out + 6 * stride);
}

template <class F>
inline Seven<F> gather_seven(const float* from, std::size_t stride, const std::int32_t* index) {
    return {{F::gather(from, index), F::gather(from + stride, index),
             F::gather(from + 2 * stride, index), F::gather(from + 3 * stride, index)},
            F::gather(from + 4 * stride, index),
            F::gather(from + 5 * stride, index),
            F::gather(from + 6 * stride, index)};
}

// The lanes beyond a run's count are computed from whatever is there and overwritten by the next
// run; strides leave room behind the last.
template <class F>
void to_model_kernel(const PackedSkeleton::Run* runs, std::size_t run_count, std::size_t stride,
                     const float* local, float* out) {
    Seven<F> before{};
    for (std::size_t r = 0; r < run_count; ++r) {
        const PackedSkeleton::Run& run = runs[r];
        const Seven<F> l = load_seven<F>(local + run.begin, stride);
        Seven<F> model;
        if (run.parents[0] < 0) {
            model = l;
        } else {
            Seven<F> parent;
#if defined(__AVX2__)
            if constexpr (F::kLanes == 8) {
                if (run.from_before) {
                    const std::int32_t* in = run.within;
                    parent = {{before.q.x.permuted(in), before.q.y.permuted(in),
                               before.q.z.permuted(in), before.q.w.permuted(in)},
                              before.tx.permuted(in),
                              before.ty.permuted(in),
                              before.tz.permuted(in)};
                } else {
                    parent = gather_seven<F>(out, stride, run.parents);
                }
            } else
#endif
            {
                parent = gather_seven<F>(out, stride, run.parents);
            }
            model = times(parent, l);
        }
        store_seven(model, out + run.begin, stride);
        before = model;
    }
}

// The matrix of lane I; unrolled, so that the rows stay in registers.
template <std::size_t I, class F>
[[gnu::always_inline]] inline void store_one(const F (&rows)[3][4], const std::uint32_t* joint_of,
                                             std::size_t joints, float* matrices) {
    if (I < joints) {
        float* m = matrices + 12 * std::size_t{joint_of[I]};
        store_four(rows[0][I % 4], I / 4, m);
        store_four(rows[1][I % 4], I / 4, m + 4);
        store_four(rows[2][I % 4], I / 4, m + 8);
    }
}
template <class F, std::size_t... I>
[[gnu::always_inline]] inline void store_each(const F (&rows)[3][4], const std::uint32_t* joint_of,
                                              std::size_t joints, float* matrices,
                                              std::index_sequence<I...>) {
    (store_one<I>(rows, joint_of, joints, matrices), ...);
}

template <class F>
void to_matrices_kernel(const float* model, std::size_t stride, const std::uint32_t* joint_of,
                        std::size_t joints, float* matrices) {
    const F one = F::all(1);
    for (std::size_t slot = 0; slot < joints; slot += F::kLanes) {
        const Seven<F> s = load_seven<F>(model + slot, stride);
        const Rotation<F>& q = s.q;
        const F x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
        F rows[3][4] = {{one - (q.y * y2 + q.z * z2), q.x * y2 + q.w * z2, q.x * z2 - q.w * y2,
                         q.x * y2 - q.w * z2},
                        {one - (q.x * x2 + q.z * z2), q.y * z2 + q.w * x2, q.x * z2 + q.w * y2,
                         q.y * z2 - q.w * x2},
                        {one - (q.x * x2 + q.y * y2), s.tx, s.ty, s.tz}};
        if constexpr (F::kLanes == 1) {
            float* m = matrices + 12 * std::size_t{joint_of[slot]};
            for (const F(&row)[4] : rows) {
                for (const F& part : row) {
                    part.store(m++);
                }
            }
        } else {
            for (F(&row)[4] : rows) {
                transpose(row);
            }
            store_each(rows, joint_of + slot, joints - slot, matrices,
                       std::make_index_sequence<F::kLanes>{});
        }
    }
}

template <class F>
constexpr PackedKernels kernels_of() {
    return {sample_kernel<F>, blend_kernel<F>, to_model_kernel<F>, to_matrices_kernel<F>};
}

}  // namespace

}  // namespace puppetri::motion
