// SPDX-License-Identifier: MIT
// A few floats side by side: 1 (the scalar twin), 4 (SSE2, NEON, WebAssembly), 8 (AVX2, only in
// sources that are compiled for it). One kernel written over these types gets the same bits at
// every width: there are only + - * /, square roots, selections and permutations, all exactly
// specified, and nothing is fused.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace puppetri::simd {

struct Float1 {
    static constexpr int kLanes = 1;
    using Scalar = float;
    float v;

    static Float1 load(const float* from) { return {*from}; }
    static Float1 all(float x) { return {x}; }
    void store(float* to) const { *to = v; }
    // Lane i is from[index[i]].
    static Float1 gather(const float* from, const std::int32_t* index) { return {from[index[0]]}; }

    friend Float1 operator+(Float1 a, Float1 b) { return {a.v + b.v}; }
    friend Float1 operator-(Float1 a, Float1 b) { return {a.v - b.v}; }
    friend Float1 operator*(Float1 a, Float1 b) { return {a.v * b.v}; }
    friend Float1 operator/(Float1 a, Float1 b) { return {a.v / b.v}; }
    friend Float1 operator-(Float1 a) { return {-a.v}; }
    friend Float1 sqrt(Float1 a) { return {std::sqrt(a.v)}; }
    // a where x < 0, else b.
    friend Float1 where_negative(Float1 x, Float1 a, Float1 b) { return x.v < 0 ? a : b; }
};

struct Float4 {
    static constexpr int kLanes = 4;
    using Scalar = float;
    typedef float Vector __attribute__((vector_size(16)));
    Vector v;

    static Float4 load(const float* from) {
        Vector v;
        __builtin_memcpy(&v, from, sizeof v);
        return {v};
    }
    static Float4 all(float x) { return {Vector{x, x, x, x}}; }
    void store(float* to) const { __builtin_memcpy(to, &v, sizeof v); }
    void store_four(std::size_t, float* to) const { store(to); }
    static Float4 gather(const float* from, const std::int32_t* index) {
        return {Vector{from[index[0]], from[index[1]], from[index[2]], from[index[3]]}};
    }

    friend Float4 operator+(Float4 a, Float4 b) { return {a.v + b.v}; }
    friend Float4 operator-(Float4 a, Float4 b) { return {a.v - b.v}; }
    friend Float4 operator*(Float4 a, Float4 b) { return {a.v * b.v}; }
    friend Float4 operator/(Float4 a, Float4 b) { return {a.v / b.v}; }
    friend Float4 operator-(Float4 a) { return {-a.v}; }
    friend Float4 sqrt(Float4 a) {
#if defined(__SSE2__)
        return {reinterpret_cast<Vector>(_mm_sqrt_ps(reinterpret_cast<__m128>(a.v)))};
#else
        return {Vector{std::sqrt(a.v[0]), std::sqrt(a.v[1]), std::sqrt(a.v[2]), std::sqrt(a.v[3])}};
#endif
    }
    // Four rows of four become columns.
    friend void transpose(Float4 (&r)[4]) {
        const Vector a = __builtin_shufflevector(r[0].v, r[1].v, 0, 4, 1, 5),
                     b = __builtin_shufflevector(r[0].v, r[1].v, 2, 6, 3, 7),
                     c = __builtin_shufflevector(r[2].v, r[3].v, 0, 4, 1, 5),
                     d = __builtin_shufflevector(r[2].v, r[3].v, 2, 6, 3, 7);
        r[0].v = __builtin_shufflevector(a, c, 0, 1, 4, 5);
        r[1].v = __builtin_shufflevector(a, c, 2, 3, 6, 7);
        r[2].v = __builtin_shufflevector(b, d, 0, 1, 4, 5);
        r[3].v = __builtin_shufflevector(b, d, 2, 3, 6, 7);
    }
    friend Float4 where_negative(Float4 x, Float4 a, Float4 b) { return {x.v < 0.0f ? a.v : b.v}; }
};

#if defined(__AVX2__)
struct Float8 {
    static constexpr int kLanes = 8;
    using Scalar = float;
    __m256 v;

    static Float8 load(const float* from) { return {_mm256_loadu_ps(from)}; }
    static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
    void store(float* to) const { _mm256_storeu_ps(to, v); }
    // The lower (0) or the upper (1) four lanes.
    void store_four(std::size_t half, float* to) const {
        _mm_storeu_ps(to, half == 0 ? _mm256_castps256_ps128(v) : _mm256_extractf128_ps(v, 1));
    }
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
