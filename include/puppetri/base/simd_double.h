// SPDX-License-Identifier: MIT
// A few doubles side by side: 1 (the scalar twin), 2 (SSE2, NEON, WebAssembly), 4 (AVX2, only in
// sources that are compiled for it). As in simd_float.h one kernel gets the same bits at every
// width.
#pragma once
#include <cmath>
#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace puppetri::simd {

struct Double1 {
    static constexpr int kLanes = 1;
    using Scalar = double;
    double v;

    static Double1 load(const double* from) { return {*from}; }
    static Double1 all(double x) { return {x}; }
    void store(double* to) const { *to = v; }

    friend Double1 operator+(Double1 a, Double1 b) { return {a.v + b.v}; }
    friend Double1 operator-(Double1 a, Double1 b) { return {a.v - b.v}; }
    friend Double1 operator*(Double1 a, Double1 b) { return {a.v * b.v}; }
    friend Double1 operator/(Double1 a, Double1 b) { return {a.v / b.v}; }
    friend Double1 operator-(Double1 a) { return {-a.v}; }
    friend Double1 sqrt(Double1 a) { return {std::sqrt(a.v)}; }
    // a where x < 0, else b.
    friend Double1 where_negative(Double1 x, Double1 a, Double1 b) { return x.v < 0 ? a : b; }
};

struct Double2 {
    static constexpr int kLanes = 2;
    using Scalar = double;
    typedef double Vector __attribute__((vector_size(16)));
    Vector v;

    static Double2 load(const double* from) {
        Vector v;
        __builtin_memcpy(&v, from, sizeof v);
        return {v};
    }
    static Double2 all(double x) { return {Vector{x, x}}; }
    void store(double* to) const { __builtin_memcpy(to, &v, sizeof v); }

    friend Double2 operator+(Double2 a, Double2 b) { return {a.v + b.v}; }
    friend Double2 operator-(Double2 a, Double2 b) { return {a.v - b.v}; }
    friend Double2 operator*(Double2 a, Double2 b) { return {a.v * b.v}; }
    friend Double2 operator/(Double2 a, Double2 b) { return {a.v / b.v}; }
    friend Double2 operator-(Double2 a) { return {-a.v}; }
    friend Double2 sqrt(Double2 a) {
#if defined(__SSE2__)
        return {reinterpret_cast<Vector>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a.v)))};
#else
        return {Vector{std::sqrt(a.v[0]), std::sqrt(a.v[1])}};
#endif
    }
    friend Double2 where_negative(Double2 x, Double2 a, Double2 b) {
        return {x.v < 0.0 ? a.v : b.v};
    }
};

#if defined(__AVX2__)
struct Double4 {
    static constexpr int kLanes = 4;
    using Scalar = double;
    __m256d v;

    static Double4 load(const double* from) { return {_mm256_loadu_pd(from)}; }
    static Double4 all(double x) { return {_mm256_set1_pd(x)}; }
    void store(double* to) const { _mm256_storeu_pd(to, v); }

    friend Double4 operator+(Double4 a, Double4 b) { return {_mm256_add_pd(a.v, b.v)}; }
    friend Double4 operator-(Double4 a, Double4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
    friend Double4 operator*(Double4 a, Double4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
    friend Double4 operator/(Double4 a, Double4 b) { return {_mm256_div_pd(a.v, b.v)}; }
    friend Double4 operator-(Double4 a) { return {_mm256_xor_pd(a.v, _mm256_set1_pd(-0.0))}; }
    friend Double4 sqrt(Double4 a) { return {_mm256_sqrt_pd(a.v)}; }
    friend Double4 where_negative(Double4 x, Double4 a, Double4 b) {
        return {_mm256_blendv_pd(b.v, a.v, _mm256_cmp_pd(x.v, _mm256_setzero_pd(), _CMP_LT_OQ))};
    }
};
#endif

}  // namespace puppetri::simd
