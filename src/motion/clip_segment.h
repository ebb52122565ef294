// SPDX-License-Identifier: MIT
// One segment of a track with its rates worked out: what sampling evaluates and editing turns into
// explicit keys. The same for rotations, vectors and numbers.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "puppetri/motion/clip.h"

namespace puppetri::motion {

inline double mix(double a, double b, double ratio) { return lerp(a, b, ratio); }
inline Vec3 mix(Vec3 a, Vec3 b, double ratio) { return lerp(a, b, ratio); }
inline Quat mix(Quat a, Quat b, double ratio) { return slerp(a, b, ratio); }

constexpr bool is_spline(Interpolation i) {
    return i == Interpolation::kCatmullRom || i == Interpolation::kCardinal ||
           i == Interpolation::kKochanekBartels || i == Interpolation::kHermite;
}

// What of a key's shape the interpolation uses.
constexpr KeyShape used_shape(Interpolation interpolation, const KeyShape& shape) {
    switch (interpolation) {
        case Interpolation::kCardinal:
            return {.tension = shape.tension};
        case Interpolation::kKochanekBartels:
            return shape;
        default:
            return {};
    }
}

// The segment of keys in which t lies: the last key that is not after t; the first for earlier t.
template <class Key>
std::size_t segment_of(const std::vector<Key>& keys, double t_s) {
    const auto after = std::upper_bound(keys.begin(), keys.end(), t_s,
                                        [](double t, const Key& key) { return t < key.t_s; });
    return after == keys.begin() ? 0 : static_cast<std::size_t>(after - keys.begin()) - 1;
}

// Whether the curve goes on from the last key to the first.
template <class Key>
bool has_seam(const ClipTrack<Key>& track, bool loops, double duration_s) {
    return loops && track.keys.size() > 2 && track.keys.front().t_s == 0 &&
           track.keys.back().t_s == duration_s;
}

// The rates with which a spline of this kind passes key i. At an end without a seam the missing
// neighbour is the other one mirrored at the key, so that the curve leaves along its chord.
template <class Key>
KeyRates<typename Key::Rate> rates_at(const ClipTrack<Key>& track, std::size_t i,
                                      Interpolation kind, bool seam) {
    const std::vector<Key>& keys = track.keys;
    const std::size_t last = keys.size() - 1;
    if (kind == Interpolation::kHermite || last == 0) {
        return {keys[i].in, keys[i].out};
    }
    const auto change = [&](std::size_t k) {
        return change_between(keys[k].value, keys[k + 1].value);
    };
    const auto length = [&](std::size_t k) { return keys[k + 1].t_s - keys[k].t_s; };
    const std::size_t before = i > 0 ? i - 1 : seam ? last - 1 : 0;
    const std::size_t after = i < last ? i : seam ? 0 : last - 1;
    return key_rates(used_shape(kind, keys[i].shape), change(before), length(before), change(after),
                     length(after));
}

template <class Key>
struct Segment {
    Interpolation kind = Interpolation::kStep;
    double begin_s = 0, length_s = 0;
    typename Key::Value a{}, b{};
    typename Key::Rate out{}, in{};  // leaving a, arriving at b: of splines
    Easing easing;
};

// Needs   i + 1 < keys.
template <class Key>
Segment<Key> make_segment(const ClipTrack<Key>& track, std::size_t i, bool seam) {
    const Key &a = track.keys[i], &b = track.keys[i + 1];
    Segment<Key> s{a.interpolation, a.t_s, b.t_s - a.t_s, a.value, b.value, {}, {}, a.easing};
    if (is_spline(s.kind)) {
        s.out = rates_at(track, i, s.kind, seam).out;
        s.in = rates_at(track, i + 1, s.kind, seam).in;
    }
    return s;
}

template <class Key>
typename Key::Value value_in(const Segment<Key>& s, double t_s) {
    const double ratio = (t_s - s.begin_s) / s.length_s;
    switch (s.kind) {
        case Interpolation::kStep:
            return s.a;
        case Interpolation::kLinear:
            return mix(s.a, s.b, ratio);
        case Interpolation::kBezier:
            return mix(s.a, s.b, ease(s.easing, ratio));
        default:
            return hermite(s.a, s.out, s.b, s.in, s.length_s, ratio);
    }
}

template <class Key>
typename Key::Rate rate_in(const Segment<Key>& s, double t_s) {
    const double ratio = (t_s - s.begin_s) / s.length_s;
    switch (s.kind) {
        case Interpolation::kStep:
            return {};
        case Interpolation::kLinear:
            return change_between(s.a, s.b) * (1 / s.length_s);
        case Interpolation::kBezier:
            return change_between(s.a, s.b) * (ease_rate(s.easing, ratio) / s.length_s);
        default:
            return hermite_rate(s.a, s.out, s.b, s.in, s.length_s, ratio);
    }
}

// Time within the clip.
inline double clip_time(double t_s, bool loops, double duration_s) {
    if (!loops || duration_s <= 0 || (t_s >= 0 && t_s <= duration_s)) {
        return clamp(t_s, 0, duration_s);
    }
    const double rounds = std::floor(t_s / duration_s);
    return clamp(t_s - rounds * duration_s, 0, duration_s);
}

}  // namespace puppetri::motion
