// SPDX-License-Identifier: MIT
// Three floats, for points, directions and colours while shading.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "puppetri/math/transform.h"

namespace puppetri::render {

struct Float3 {
    float x = 0, y = 0, z = 0;
};
inline Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Float3 operator*(Float3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Float3 operator*(Float3 a, Float3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline float dot(Float3 a, Float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Float3 cross(Float3 a, Float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Float3 normalized(Float3 a) {
    const float n = dot(a, a);
    return n > 0 ? a * (1 / std::sqrt(n)) : Float3{0, 1, 0};
}
inline Float3 mix(Float3 a, Float3 b, float t) { return a + (b - a) * t; }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
inline float smooth_step(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}
// Rounded down; |x| < 2^31. Without SSE 4.1 std::floor is a call.
inline int floor_int(float x) {
    const int i = static_cast<int>(x);
    return i - (x < static_cast<float>(i) ? 1 : 0);
}
inline Float3 float3(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Float3 float3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace puppetri::render
