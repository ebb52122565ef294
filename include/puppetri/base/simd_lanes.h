// SPDX-License-Identifier: MIT
// Numbers side by side, of either precision: one (the scalar twin), and what fits into 16 bytes
// (SSE2, NEON, WebAssembly). One kernel written over these types gets the same bits at every width:
// there are only + - * /, square roots, selections and permutations, all exactly specified, and
// nothing is fused. The wider ones of AVX2 are in simd_float.h and simd_double.h, which name all.
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

template <class T>
struct One {
    static constexpr int kLanes = 1;
    using Scalar = T;
    T v;

    static One load(const T* from) { return {*from}; }
    static One all(T x) { return {x}; }
    void store(T* to) const { *to = v; }
    // Lane i is from[index[i]].
    static One gather(const T* from, const std::int32_t* index) { return {from[index[0]]}; }

    friend One operator+(One a, One b) { return {a.v + b.v}; }
    friend One operator-(One a, One b) { return {a.v - b.v}; }
    friend One operator*(One a, One b) { return {a.v * b.v}; }
    friend One operator/(One a, One b) { return {a.v / b.v}; }
    friend One operator-(One a) { return {-a.v}; }
    friend One sqrt(One a) { return {std::sqrt(a.v)}; }
    // a where x < 0, else b.
    friend One where_negative(One x, One a, One b) { return x.v < 0 ? a : b; }
};

template <class T>
struct Sixteen {
    static constexpr int kLanes = 16 / sizeof(T);
    using Scalar = T;
    typedef T Vector __attribute__((vector_size(16)));
    Vector v;

    static Sixteen load(const T* from) {
        Vector v;
        __builtin_memcpy(&v, from, sizeof v);
        return {v};
    }
    static Sixteen all(T x) { return {x - Vector{}}; }  // also of -0
    void store(T* to) const { __builtin_memcpy(to, &v, sizeof v); }
    static Sixteen gather(const T* from, const std::int32_t* index) {
        if constexpr (kLanes == 4) {
            return {Vector{from[index[0]], from[index[1]], from[index[2]], from[index[3]]}};
        } else {
            return {Vector{from[index[0]], from[index[1]]}};
        }
    }

    friend Sixteen operator+(Sixteen a, Sixteen b) { return {a.v + b.v}; }
    friend Sixteen operator-(Sixteen a, Sixteen b) { return {a.v - b.v}; }
    friend Sixteen operator*(Sixteen a, Sixteen b) { return {a.v * b.v}; }
    friend Sixteen operator/(Sixteen a, Sixteen b) { return {a.v / b.v}; }
    friend Sixteen operator-(Sixteen a) { return {-a.v}; }
    friend Sixteen sqrt(Sixteen a) {
#if defined(__SSE2__)
        if constexpr (kLanes == 4) {
            return {reinterpret_cast<Vector>(_mm_sqrt_ps(reinterpret_cast<__m128>(a.v)))};
        } else {
            return {reinterpret_cast<Vector>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a.v)))};
        }
#else
        for (int i = 0; i < kLanes; ++i) {
            a.v[i] = std::sqrt(a.v[i]);
        }
        return a;
#endif
    }
    friend Sixteen where_negative(Sixteen x, Sixteen a, Sixteen b) {
        return {x.v < Vector{} ? a.v : b.v};
    }
};

}  // namespace puppetri::simd
