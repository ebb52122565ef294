// SPDX-License-Identifier: MIT
// The travel of clips.
#include "clip_root.h"

namespace puppetri::motion {

Transform power(Transform base, double times) {
    Transform result;
    for (auto n = static_cast<std::uint64_t>(clamp(times, 0, 1e15)); n != 0; n >>= 1) {
        if (n & 1) {
            result = result * base;
        }
        base = base * base;
    }
    result.rotation = normalized(result.rotation);
    return result;
}

Transform planar_root(const Clip& clip, double t_s) {
    Transform at;
    if (const VectorTrack* track = clip.find_translation(clip.root)) {
        const Vec3 p = sample(*track, t_s, clip.loops, clip.duration_s);
        at.translation = {p.x, 0, p.z};
    }
    if (const RotationTrack* track = clip.find_rotation(clip.root)) {
        at.rotation = about_y(heading_of(sample(*track, t_s, clip.loops, clip.duration_s)));
    }
    return at;
}

void carry_root(Clip& clip, const Transform& by) {
    for (VectorTrack& track : clip.translations) {
        if (track.target == clip.root) {
            for (VectorKey& key : track.keys) {
                key.value = by * key.value;
                key.in = rotate(by.rotation, key.in);
                key.out = rotate(by.rotation, key.out);
            }
        }
    }
    for (RotationTrack& track : clip.rotations) {
        if (track.target == clip.root) {
            for (RotationKey& key : track.keys) {
                key.value = by.rotation * key.value;
            }
        }
    }
}

Transform root_travel(const Clip& clip, double t_s) {
    if (clip.root.empty()) {
        return {};
    }
    const Transform back = inverse(planar_root(clip, 0));
    if (!clip.loops || clip.duration_s <= 0 || t_s <= clip.duration_s) {
        return back * planar_root(clip, clamp(t_s, 0, clip.duration_s));
    }
    const double rounds = std::floor(t_s / clip.duration_s);
    return power(back * planar_root(clip, clip.duration_s), rounds) * back *
           planar_root(clip, clamp(t_s - rounds * clip.duration_s, 0, clip.duration_s));
}

}  // namespace puppetri::motion
