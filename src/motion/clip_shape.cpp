// SPDX-License-Identifier: MIT
// Edits of the shape of clips: one after the other, repeated, closed to a loop, mirrored, sampled
// anew, with fewer keys.
#include <algorithm>
#include <array>

#include "clip_keys.h"
#include "clip_root.h"
#include "clip_segment.h"
#include "puppetri/base/require.h"
#include "puppetri/motion/clip_edit.h"

namespace puppetri::motion {
namespace {

// All splines as Hermite segments, so that they no longer lean on their neighbours.
template <class Key>
void freeze_all(std::vector<ClipTrack<Key>>& tracks, bool loops, double duration_s) {
    for (ClipTrack<Key>& track : tracks) {
        const bool seam = has_seam(track, loops, duration_s);
        std::vector<Key> keys = track.keys;
        for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
            if (is_spline(keys[k].interpolation)) {
                const Segment<Key> s = make_segment(track, k, seam);
                keys[k].out = s.out;
                keys[k + 1].in = s.in;
                keys[k].interpolation = Interpolation::kHermite;
            }
        }
        track.keys = std::move(keys);
    }
}
void freeze_all(Clip& clip) {
    freeze_all(clip.rotations, clip.loops, clip.duration_s);
    freeze_all(clip.translations, clip.loops, clip.duration_s);
    freeze_all(clip.numbers, clip.loops, clip.duration_s);
}

template <class Key>
void join_tracks(std::vector<ClipTrack<Key>>& into, const std::vector<ClipTrack<Key>>& from,
                 double at_s) {
    for (const ClipTrack<Key>& track : from) {
        auto found = std::find_if(into.begin(), into.end(),
                                  [&](const auto& t) { return t.target == track.target; });
        std::vector<Key> keys = track.keys;
        for (Key& key : keys) {
            key.t_s += at_s;
        }
        if (found == into.end()) {
            into.push_back({track.target, std::move(keys)});
            continue;
        }
        append_keys(found->keys, std::move(keys));
    }
}

// Reflection across the plane at right angles to one of the axes.
struct Mirror {
    int axis = 0;
    Vec3 point(Vec3 v) const {
        (axis == 0 ? v.x : axis == 1 ? v.y : v.z) *= -1;
        return v;
    }
    Vec3 turning(Vec3 v) const { return point(v) * -1.0; }  // of axial vectors
    Quat rotation(Quat q) const {
        const Vec3 v = turning({q.x, q.y, q.z});
        return {v.x, v.y, v.z, q.w};
    }
};

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_letter(char c) { return is_upper(c) || (c >= 'a' && c <= 'z'); }

}  // namespace

Clip joined(const Clip& first, const Clip& second) {
    Clip out = first, next = second;
    freeze_all(out);
    freeze_all(next);
    if (!first.root.empty() && first.root == second.root) {
        carry_root(next, planar_root(first, first.duration_s) * inverse(planar_root(second, 0)));
    }
    join_tracks(out.rotations, next.rotations, first.duration_s);
    join_tracks(out.translations, next.translations, first.duration_s);
    join_tracks(out.numbers, next.numbers, first.duration_s);
    out.duration_s = first.duration_s + second.duration_s;
    out.loops = false;
    for (ClipMark mark : second.marks) {
        mark.t_s += first.duration_s;
        mark.end_s += first.duration_s;
        out.marks.push_back(std::move(mark));
    }
    return out;
}

Clip repeated(const Clip& clip, int rounds) {
    PUP_REQUIRE(rounds >= 1);
    Clip out = clip;
    for (int i = 1; i < rounds; ++i) {
        out = joined(out, clip);
    }
    out.loops = clip.loops;
    return out;
}

Clip closed(const Clip& clip, double blend_s) {
    PUP_REQUIRE(blend_s > 0 && blend_s <= clip.duration_s);
    constexpr int kParts = 8;
    const double end = clip.duration_s, begin = end - blend_s;
    Clip out = clip;
    for (int i = 0; i <= kParts; ++i) {
        out = with_keys_at(out, begin + blend_s * i / kParts);
    }
    freeze_all(out);
    out.loops = false;
    const Quat turned = about_y(turn_between(heading_of(planar_root(clip, 0).rotation),
                                             heading_of(planar_root(clip, end).rotation)));
    const bool has_turn = clip.find_rotation(clip.root) != nullptr;

    // Adds a change that is zero with rate zero at `begin` and the given one at `end`.
    const auto add = [&](auto& track, const auto& original, auto missing, auto missing_rate,
                         auto apply) {
        const double last = original.keys.back().t_s;
        if (original.keys.size() > 1 && last < end) {  // it stands still up to the end
            auto key = track.keys.back();
            key.t_s = end;
            key.interpolation = Interpolation::kLinear;
            track.keys.push_back(key);
        }
        using Change = decltype(missing);
        const auto dense = track;
        for (std::size_t k = 0; k < track.keys.size(); ++k) {
            auto& key = track.keys[k];
            if (key.t_s < begin - kSame_s) {
                continue;
            }
            const double u = clamp((key.t_s - begin) / blend_s, 0, 1);
            const Change h = hermite(Change{}, Change{}, missing, missing_rate, blend_s, u);
            const Change rate = hermite_rate(Change{}, Change{}, missing, missing_rate, blend_s, u);
            const bool last_key = k + 1 == track.keys.size();
            const Change in =
                k > 0 ? rate_in(make_segment(dense, k - 1, false), key.t_s) : Change{};
            const Change out_rate = last_key ? in : rate_in(make_segment(dense, k, false), key.t_s);
            apply(key, h, rate, in, out_rate);
            if (!last_key) {
                key.interpolation = Interpolation::kHermite;
            }
        }
    };
    for (std::size_t i = 0; i < out.rotations.size(); ++i) {
        RotationTrack& track = out.rotations[i];
        const RotationTrack original = track;
        const Quat q0 = sample(original, 0, false, end), q1 = sample(original, end, false, end);
        const bool root = track.target == clip.root;
        const Quat goal = root ? turned * q0 : q0;
        const Vec3 missing = change_between(q1, goal);
        const Vec3 r0 = sample_rate(original, 0, false, end),
                   r1 = sample_rate(original, end, false, end);
        const Vec3 missing_rate = r0 - rotate(conjugate(from_rotation_vector(missing)), r1);
        add(track, original, missing, missing_rate,
            [&](RotationKey& key, Vec3 h, Vec3 rate, Vec3 in, Vec3 leaving) {
                const Quat extra = from_rotation_vector(h);
                key.value = normalized(key.value * extra);
                key.in = rotate(conjugate(extra), in) + rate;
                key.out = rotate(conjugate(extra), leaving) + rate;
                if (key.t_s >= end - kSame_s) {
                    key.value = goal;
                    key.in = key.out = r0;
                }
            });
    }
    for (std::size_t i = 0; i < out.translations.size(); ++i) {
        VectorTrack& track = out.translations[i];
        const VectorTrack original = track;
        const Vec3 p0 = sample(original, 0, false, end), p1 = sample(original, end, false, end);
        const bool root = track.target == clip.root;
        Vec3 missing = p0 - p1;
        Vec3 r0 = sample_rate(original, 0, false, end);
        if (root) {
            missing.x = missing.z = 0;
            r0 = has_turn ? rotate(turned, r0) : r0;
        }
        const Vec3 r1 = sample_rate(original, end, false, end);
        add(track, original, missing, r0 - r1,
            [&](VectorKey& key, Vec3 h, Vec3 rate, Vec3 in, Vec3 leaving) {
                key.value = key.value + h;
                key.in = in + rate;
                key.out = leaving + rate;
                if (key.t_s >= end - kSame_s) {
                    key.value = root ? Vec3{p1.x, p0.y, p1.z} : p0;
                    key.in = key.out = r0;
                }
            });
    }
    for (NumberTrack& track : out.numbers) {
        const NumberTrack original = track;
        const double x0 = sample(original, 0, false, end), x1 = sample(original, end, false, end);
        const double r0 = sample_rate(original, 0, false, end),
                     r1 = sample_rate(original, end, false, end);
        add(track, original, x0 - x1, r0 - r1,
            [&](NumberKey& key, double h, double rate, double in, double leaving) {
                key.value += h;
                key.in = in + rate;
                key.out = leaving + rate;
                if (key.t_s >= end - kSame_s) {
                    key.value = x0;
                    key.in = key.out = r0;
                }
            });
    }
    out.loops = true;
    return out;
}

std::string mirrored_name(std::string_view name) {
    static constexpr std::array<std::array<std::string_view, 2>, 3> kWords = {
        {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}};
    for (const auto& pair : kWords) {
        for (const int side : {0, 1}) {
            const std::string_view from = pair[static_cast<std::size_t>(side)],
                                   to = pair[static_cast<std::size_t>(1 - side)];
            if (const std::size_t at = name.find(from); at != std::string_view::npos) {
                return std::string(name.substr(0, at)) + std::string(to) +
                       std::string(name.substr(at + from.size()));
            }
        }
    }
    // A single letter, alone between what is no letter or the ends, or before a capital.
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (c != 'L' && c != 'R' && c != 'l' && c != 'r') {
            continue;
        }
        const bool opens = i == 0 || !is_letter(name[i - 1]);
        const bool closes = i + 1 == name.size() || !is_letter(name[i + 1]) ||
                            (is_upper(c) && i + 2 < name.size() && is_upper(name[i + 1]) &&
                             is_letter(name[i + 2]) && !is_upper(name[i + 2]));
        if (opens && closes && name.size() > 1) {
            std::string other(name);
            other[i] = c == 'L' ? 'R' : c == 'R' ? 'L' : c == 'l' ? 'r' : 'l';
            return other;
        }
    }
    return std::string(name);
}

Clip mirrored(const Clip& clip, const figure::Skeleton& skeleton) {
    const std::size_t n = skeleton.joints.size();
    std::vector<figure::JointIndex> partner(n);
    figure::Pose rest = figure::rest_pose(skeleton);
    std::vector<Transform> model(n);
    figure::to_model_space(skeleton, rest, model);
    Vec3 apart;
    for (std::uint32_t j = 0; j < n; ++j) {
        partner[j] = skeleton.find(mirrored_name(skeleton.joints[j].name));
        if (!partner[j].valid()) {
            partner[j] = {j};
        }
        const Vec3 d = model[j].translation - model[partner[j].value].translation;
        apart = apart + Vec3{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
    }
    const Mirror mirror{apart.y > apart.x && apart.y > apart.z ? 1 : apart.z > apart.x ? 2 : 0};
    const auto own_axes = [&](figure::JointIndex j) {  // K(j)
        return j.valid() ? conjugate(mirror.rotation(model[j.value].rotation)) *
                               model[partner[j.value].value].rotation
                         : Quat{};
    };
    Clip out = clip;
    for (RotationTrack& track : out.rotations) {
        const figure::JointIndex j = skeleton.find(track.target);
        const Quat below = own_axes(j);
        const Quat above = j.valid() ? own_axes(skeleton.joints[j.value].parent) : Quat{};
        track.target = mirrored_name(track.target);
        if (j.valid()) {
            track.target = skeleton.joints[partner[j.value].value].name;
        }
        for (RotationKey& key : track.keys) {
            key.value = normalized(conjugate(above) * mirror.rotation(key.value) * below);
            key.in = rotate(conjugate(below), mirror.turning(key.in));
            key.out = rotate(conjugate(below), mirror.turning(key.out));
        }
    }
    for (VectorTrack& track : out.translations) {
        const figure::JointIndex j = skeleton.find(track.target);
        const figure::JointIndex parent =
            j.valid() ? skeleton.joints[j.value].parent : figure::JointIndex{};
        const Quat above = own_axes(parent);
        Vec3 from, to;
        if (j.valid() && parent.valid()) {  // proportions stay each side's own
            from = skeleton.joints[j.value].parent_from_joint_rest.translation;
            to = skeleton.joints[partner[j.value].value].parent_from_joint_rest.translation;
        }
        track.target =
            j.valid() ? skeleton.joints[partner[j.value].value].name : mirrored_name(track.target);
        const auto flipped = [&](Vec3 v) { return rotate(conjugate(above), mirror.point(v)); };
        for (VectorKey& key : track.keys) {
            key.value = to + flipped(key.value - from);
            key.in = flipped(key.in);
            key.out = flipped(key.out);
        }
    }
    for (NumberTrack& track : out.numbers) {
        const std::string other = mirrored_name(track.target);
        const bool middle = other == track.target;
        const bool sign =
            middle && (track.target.ends_with(".side") || track.target.ends_with(".twist"));
        track.target = other;
        for (NumberKey& key : track.keys) {
            key.value *= sign ? -1 : 1;
            key.in *= sign ? -1 : 1;
            key.out *= sign ? -1 : 1;
        }
    }
    for (ClipMark& mark : out.marks) {
        mark.target = mirrored_name(mark.target);
        mark.name = mirrored_name(mark.name);
    }
    return out;
}

Clip resampled(const Clip& clip, double rate_hz) {
    PUP_REQUIRE(rate_hz > 0);
    Clip out = clip;
    const auto anew = [&](const auto& from, auto& to) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            auto& keys = to[i].keys;
            keys.clear();
            const auto put = [&](double t) {
                auto& key = keys.emplace_back();
                key.t_s = t;
                // The end of a loop is its own key, not the beginning again.
                key.value = sample(from[i], t, clip.loops, clip.duration_s);
            };
            for (std::size_t k = 0; static_cast<double>(k) / rate_hz < clip.duration_s - kSame_s;
                 ++k) {
                put(static_cast<double>(k) / rate_hz);
            }
            put(clip.duration_s);
        }
    };
    anew(clip.rotations, out.rotations);
    anew(clip.translations, out.translations);
    anew(clip.numbers, out.numbers);
    return out;
}

namespace {

// Keeps the ends and, while a line between two kept keys is too far from one left out, the farthest
// of these. Source  Ramer 1972; Douglas and Peucker 1973, without recursion.
template <class Key>
std::vector<Key> fewer(const std::vector<Key>& keys, double tolerance) {
    std::vector<char> keep(keys.size(), 0);
    keep.front() = keep.back() = 1;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, keys.size() - 1}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        double worst = tolerance;
        std::size_t at = 0;
        for (std::size_t k = a + 1; k < b; ++k) {
            const double ratio = (keys[k].t_s - keys[a].t_s) / (keys[b].t_s - keys[a].t_s);
            const double d = apart(keys[k].value, mix(keys[a].value, keys[b].value, ratio));
            if (d > worst) {
                worst = d;
                at = k;
            }
        }
        if (at != 0) {
            keep[at] = 1;
            open.emplace_back(a, at);
            open.emplace_back(at, b);
        }
    }
    std::vector<Key> out;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (keep[k]) {
            out.push_back(keys[k]);
        }
    }
    if (out.size() == 2 && apart(out[0].value, out[1].value) == 0) {
        out.pop_back();
    }
    return out;
}

}  // namespace

Clip reduced(const Clip& clip, const KeyTolerance& tolerance) {
    Clip out = clip;
    const auto thin = [&](auto& tracks, double allowed) {
        for (auto& track : tracks) {
            const bool straight = std::all_of(
                track.keys.begin(), track.keys.end(),
                [](const auto& key) { return key.interpolation == Interpolation::kLinear; });
            if (straight && track.keys.size() > 1) {
                track.keys = fewer(track.keys, allowed);
            }
        }
    };
    thin(out.rotations, tolerance.angle_rad);
    thin(out.translations, tolerance.length_m);
    thin(out.numbers, std::min(tolerance.angle_rad, tolerance.length_m));
    return out;
}

}  // namespace puppetri::motion
