// SPDX-License-Identifier: MIT
// A few doubles side by side: 1 (the scalar twin), 2 (SSE2, NEON, WebAssembly), 4 (AVX2, only in
// sources that are compiled for it), the same bits at every width (simd_lanes.h).
#pragma once
#include "puppetri/base/simd_lanes.h"

namespace puppetri::simd {

using Double1 = One<double>;
using Double2 = Sixteen<double>;

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
