// SPDX-License-Identifier: MIT
// A few floats side by side: 1 (the scalar twin), 4 (SSE2, NEON, WebAssembly), 8 (AVX2, only in
// sources that are compiled for it), the same bits at every width (simd_lanes.h).
#pragma once
#include "puppetri/base/simd_lanes.h"

namespace puppetri::simd {

using Float1 = One<float>;
using Float4 = Sixteen<float>;

// The four lanes; of eight, the lower (0) or the upper (1) ones.
inline void store_four(Float4 a, std::size_t, float* to) { a.store(to); }

// Four rows of four become columns.
inline void transpose(Float4 (&r)[4]) {
    const Float4::Vector a = __builtin_shufflevector(r[0].v, r[1].v, 0, 4, 1, 5),
                         b = __builtin_shufflevector(r[0].v, r[1].v, 2, 6, 3, 7),
                         c = __builtin_shufflevector(r[2].v, r[3].v, 0, 4, 1, 5),
                         d = __builtin_shufflevector(r[2].v, r[3].v, 2, 6, 3, 7);
    r[0].v = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    r[1].v = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    r[2].v = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[3].v = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

#if defined(__AVX2__)
struct Float8 {
    static constexpr int kLanes = 8;
    using Scalar = float;
    __m256 v;

    static Float8 load(const float* from) { return {_mm256_loadu_ps(from)}; }
    static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
    void store(float* to) const { _mm256_storeu_ps(to, v); }
    static Float8 gather(const float* from, const std::int32_t* index) {
        return {_mm256_setr_ps(from[index[0]], from[index[1]], from[index[2]], from[index[3]],
                               from[index[4]], from[index[5]], from[index[6]], from[index[7]])};
    }
    // Lane i of the result is lane index[i] of this one.
    Float8 permuted(const std::int32_t* index) const {
        return {_mm256_permutevar8x32_ps(
            v, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index)))};
    }

    friend Float8 operator+(Float8 a, Float8 b) { return {_mm256_add_ps(a.v, b.v)}; }
    friend Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
    friend Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
    friend Float8 operator/(Float8 a, Float8 b) { return {_mm256_div_ps(a.v, b.v)}; }
    friend Float8 operator-(Float8 a) { return {_mm256_xor_ps(a.v, _mm256_set1_ps(-0.0f))}; }
    friend void store_four(Float8 a, std::size_t half, float* to) {
        _mm_storeu_ps(to, half == 0 ? _mm256_castps256_ps128(a.v) : _mm256_extractf128_ps(a.v, 1));
    }
    // Four rows of eight become columns, each half by itself: the lower four lanes of r[i] are
    // column i, the upper ones column i + 4.
    friend void transpose(Float8 (&r)[4]) {
        const __m256 a = _mm256_unpacklo_ps(r[0].v, r[1].v), b = _mm256_unpackhi_ps(r[0].v, r[1].v),
                     c = _mm256_unpacklo_ps(r[2].v, r[3].v), d = _mm256_unpackhi_ps(r[2].v, r[3].v);
        r[0].v = _mm256_shuffle_ps(a, c, 0x44);
        r[1].v = _mm256_shuffle_ps(a, c, 0xee);
        r[2].v = _mm256_shuffle_ps(b, d, 0x44);
        r[3].v = _mm256_shuffle_ps(b, d, 0xee);
    }
    friend Float8 sqrt(Float8 a) { return {_mm256_sqrt_ps(a.v)}; }
    friend Float8 where_negative(Float8 x, Float8 a, Float8 b) {
        return {_mm256_blendv_ps(b.v, a.v, _mm256_cmp_ps(x.v, _mm256_setzero_ps(), _CMP_LT_OQ))};
    }
};
#endif

}  // namespace puppetri::simd
