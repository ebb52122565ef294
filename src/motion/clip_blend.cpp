// SPDX-License-Identifier: MIT
#include "puppetri/motion/clip_blend.h"

#include <algorithm>

#include "clip_keys.h"
#include "clip_root.h"
#include "clip_segment.h"
#include "puppetri/base/require.h"
#include "puppetri/motion/clip_edit.h"
#include "puppetri/motion/inertialize.h"

namespace puppetri::motion {
namespace {

// Time of a clip at a phase counted in points: 0 at its begin, points + 1 at its end.
double time_at(double phase, std::span<const PhasePoint> points, bool of_b, double duration_s) {
    const auto n = static_cast<double>(points.size() + 1);
    const double p = clamp(phase, 0, n);
    const auto i = std::min(static_cast<std::size_t>(p), points.size());
    const auto corner = [&](std::size_t k) {
        return k == 0                   ? 0
               : k == points.size() + 1 ? duration_s
               : of_b                   ? points[k - 1].at_b_s
                                        : points[k - 1].at_a_s;
    };
    return lerp(corner(i), corner(i + 1), p - static_cast<double>(i));
}

template <class Key>
std::vector<std::string> targets_of(const std::vector<ClipTrack<Key>>& a,
                                    const std::vector<ClipTrack<Key>>& b) {
    std::vector<std::string> names;
    for (const auto* list : {&a, &b}) {
        for (const ClipTrack<Key>& track : *list) {
            if (std::find(names.begin(), names.end(), track.target) == names.end()) {
                names.push_back(track.target);
            }
        }
    }
    return names;
}

}  // namespace

std::vector<PhasePoint> phases_of(const Clip& a, const Clip& b, std::span<const std::string> feet) {
    std::vector<PhasePoint> points;
    const auto landing = [](const Clip& clip, const std::string& foot) {
        for (const ClipMark& mark : clip.marks) {
            if (mark.name == "foot_strike" && mark.target == foot) {
                return mark.t_s;
            }
        }
        return -1.0;
    };
    for (const std::string& foot : feet) {
        const PhasePoint p{landing(a, foot), landing(b, foot)};
        if (p.at_a_s < 0 || p.at_b_s < 0) {
            return {};
        }
        if (p.at_a_s > kSame_s && p.at_b_s > kSame_s) {  // the begin is a common phase already
            points.push_back(p);
        }
    }
    std::sort(points.begin(), points.end(),
              [](const PhasePoint& x, const PhasePoint& y) { return x.at_a_s < y.at_a_s; });
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].at_b_s <= points[i - 1].at_b_s) {
            return {};
        }
    }
    return points;
}

Clip blended_cycles(const Clip& a, const Clip& b, double weight, std::span<const PhasePoint> points,
                    double rate_hz) {
    PUP_REQUIRE(a.duration_s > 0 && b.duration_s > 0 && rate_hz > 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        PUP_REQUIRE(points[i].at_a_s > (i > 0 ? points[i - 1].at_a_s : 0) &&
                    points[i].at_b_s > (i > 0 ? points[i - 1].at_b_s : 0) &&
                    points[i].at_a_s < a.duration_s && points[i].at_b_s < b.duration_s);
    }
    Clip out;
    out.name = a.name;
    out.loops = true;
    out.root = a.root;
    out.duration_s = lerp(a.duration_s, b.duration_s, weight);
    // The new clip's own times of the phases.
    std::vector<PhasePoint> own;
    for (const PhasePoint& p : points) {
        own.push_back({lerp(p.at_a_s, p.at_b_s, weight), 0});
    }
    const auto phase_of = [&](double t) {
        std::size_t i = 0;
        const auto corner = [&](std::size_t k) {
            return k == 0 ? 0 : k > own.size() ? out.duration_s : own[k - 1].at_a_s;
        };
        while (i < own.size() && corner(i + 1) <= t) {
            ++i;
        }
        return static_cast<double>(i) + clamp((t - corner(i)) / (corner(i + 1) - corner(i)), 0, 1);
    };
    const auto count = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::nearbyint(out.duration_s * rate_hz)));
    const auto build = [&](const auto& of_a, const auto& of_b, auto& to) {
        for (const std::string& target : targets_of(of_a, of_b)) {
            const auto pick = [&](const auto& list) {
                return std::find_if(list.begin(), list.end(),
                                    [&](const auto& t) { return t.target == target; });
            };
            const auto ta = pick(of_a), tb = pick(of_b);
            to.push_back({target, {}});
            for (std::size_t k = 0; k <= count; ++k) {
                auto& key = to.back().keys.emplace_back();
                key.t_s = k == count ? out.duration_s
                                     : out.duration_s * static_cast<double>(k) /
                                           static_cast<double>(count);
                const double phase = phase_of(key.t_s);
                const double in_a = time_at(phase, points, false, a.duration_s),
                             in_b = time_at(phase, points, true, b.duration_s);
                if (ta == of_a.end()) {
                    key.value = sample(*tb, in_b, false, b.duration_s);
                } else if (tb == of_b.end()) {
                    key.value = sample(*ta, in_a, false, a.duration_s);
                } else {
                    key.value = mix(sample(*ta, in_a, false, a.duration_s),
                                    sample(*tb, in_b, false, b.duration_s), weight);
                }
            }
        }
    };
    build(a.rotations, b.rotations, out.rotations);
    build(a.translations, b.translations, out.translations);
    build(a.numbers, b.numbers, out.numbers);
    for (ClipMark mark : a.marks) {
        const auto moved = [&](double t) {  // the phase of a's time, in the new clip's
            std::size_t i = 0;
            while (i < points.size() && points[i].at_a_s <= t) {
                ++i;
            }
            const double from = i == 0 ? 0 : points[i - 1].at_a_s,
                         to = i < points.size() ? points[i].at_a_s : a.duration_s;
            const double phase = static_cast<double>(i) + (t - from) / (to - from);
            return clamp(time_at(phase, own, false, out.duration_s), 0, out.duration_s);
        };
        mark.t_s = moved(mark.t_s);
        mark.end_s = moved(mark.end_s);
        out.marks.push_back(std::move(mark));
    }
    return out;
}

Clip transition(const Clip& first, double at_s, const Clip& second, double second_s,
                double blend_s) {
    PUP_REQUIRE(at_s >= 0 && at_s <= first.duration_s && second_s >= 0 &&
                second_s <= second.duration_s && blend_s > 0);
    constexpr int kParts = 16;
    const double rest_s = second.duration_s - second_s;
    Clip next = copied(second, second_s, second.duration_s);
    for (int i = 1; i <= kParts; ++i) {
        const double t = std::min(blend_s, rest_s) * i / kParts;
        if (t < rest_s) {
            next = with_keys_at(next, t);
        }
    }
    const Clip before = copied(first, 0, at_s);
    // The second's root on the floor where the first's is, looking the same way.
    if (!first.root.empty() && first.root == second.root) {
        carry_root(next, planar_root(first, at_s) * inverse(planar_root(second, second_s)));
    }
    constexpr double kMoment_s = 1e-5;
    const auto fade = [&](auto& tracks, const auto& from, auto offset_at, auto apply) {
        for (auto& track : tracks) {
            const auto found = std::find_if(
                from.begin(), from.end(), [&](const auto& t) { return t.target == track.target; });
            if (found == from.end()) {
                continue;
            }
            const auto original = track;
            const auto offset = offset_at(*found, original);
            for (std::size_t k = 0; k < track.keys.size(); ++k) {
                auto& key = track.keys[k];
                if (key.t_s > blend_s + kSame_s) {
                    break;
                }
                const bool last = k + 1 == track.keys.size();
                const auto in = k > 0 ? rate_in(make_segment(original, k - 1, false), key.t_s)
                                      : typename std::decay_t<decltype(key)>::Rate{};
                const auto out = last ? in : rate_in(make_segment(original, k, false), key.t_s);
                const auto x = offset.at(key.t_s);
                const auto v =
                    (offset.at(key.t_s + kMoment_s) - offset.at(key.t_s)) * (1 / kMoment_s);
                apply(key, x, v, in, out);
                if (!last && key.t_s < blend_s - kSame_s) {
                    key.interpolation = Interpolation::kHermite;
                }
            }
        }
    };
    const auto end_rate = [&](const auto& track) {
        // How the first arrives.
        return at_s > 0 ? sample_rate(track, at_s - 1e-9, first.loops, first.duration_s)
                        : sample_rate(track, 0, first.loops, first.duration_s);
    };
    fade(
        next.rotations, first.rotations,
        [&](const RotationTrack& from, const RotationTrack& to) {
            const Quat own = to.keys.front().value;
            const Vec3 x = change_between(own, sample(from, at_s, first.loops, first.duration_s));
            const Vec3 rate = to.keys.size() > 1 ? rate_in(make_segment(to, 0, false), 0) : Vec3{};
            const Vec3 v = end_rate(from) - rotate(conjugate(from_rotation_vector(x)), rate);
            return InertialOffset3(x, v, blend_s);
        },
        [](RotationKey& key, Vec3 x, Vec3 v, Vec3 in, Vec3 out) {
            const Quat extra = from_rotation_vector(x);
            key.value = normalized(key.value * extra);
            key.in = rotate(conjugate(extra), in) + v;
            key.out = rotate(conjugate(extra), out) + v;
        });
    fade(
        next.translations, first.translations,
        [&](const VectorTrack& from, const VectorTrack& to) {
            const Vec3 x =
                sample(from, at_s, first.loops, first.duration_s) - to.keys.front().value;
            const Vec3 rate = to.keys.size() > 1 ? rate_in(make_segment(to, 0, false), 0) : Vec3{};
            return InertialOffset3(x, end_rate(from) - rate, blend_s);
        },
        [](VectorKey& key, Vec3 x, Vec3 v, Vec3 in, Vec3 out) {
            key.value = key.value + x;
            key.in = in + v;
            key.out = out + v;
        });
    fade(
        next.numbers, first.numbers,
        [&](const NumberTrack& from, const NumberTrack& to) {
            const double x =
                sample(from, at_s, first.loops, first.duration_s) - to.keys.front().value;
            const double rate = to.keys.size() > 1 ? rate_in(make_segment(to, 0, false), 0) : 0;
            return InertialOffset(x, end_rate(from) - rate, blend_s);
        },
        [](NumberKey& key, double x, double v, double in, double out) {
            key.value += x;
            key.in = in + v;
            key.out = out + v;
        });
    // Joined, the root is where it was put already.
    Clip a = before, b = next;
    a.root.clear();
    b.root.clear();
    Clip out = joined(a, b);
    out.root = first.root;
    out.name = second.name;
    return out;
}

}  // namespace puppetri::motion
