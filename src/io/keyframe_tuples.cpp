// SPDX-License-Identifier: MIT
#include "puppetri/io/keyframe_tuples.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "defects.h"
#include "puppetri/base/require.h"
#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

using motion::Clip;
using notation::KeyframeTuple;

const Clip* find_clip(const ClipFile& file, const std::string& name) {
    for (const Clip& clip : file.clips) {
        if (clip.name == name) {
            return &clip;
        }
    }
    return nullptr;
}

// Where the root of a pose is: its translation and rotation at the begin.
Transform root_of(const Clip& pose) {
    Transform at;
    if (const motion::VectorTrack* track = pose.find_translation(pose.root)) {
        at.translation = motion::sample(*track, 0, false, pose.duration_s);
    }
    if (const motion::RotationTrack* track = pose.find_rotation(pose.root)) {
        at.rotation = motion::sample(*track, 0, false, pose.duration_s);
    }
    return at;
}

template <class Key>
void add_keys(std::vector<motion::ClipTrack<Key>>& to,
              const std::vector<motion::ClipTrack<Key>>& pose, double pose_s, double t_s,
              motion::Interpolation between, auto place) {
    for (const motion::ClipTrack<Key>& track : pose) {
        auto found = std::find_if(to.begin(), to.end(),
                                  [&](const auto& t) { return t.target == track.target; });
        if (found == to.end()) {
            to.push_back({track.target, {}});
            found = to.end() - 1;
        }
        Key& key = found->keys.emplace_back();
        key.t_s = t_s;
        key.value = place(track.target, motion::sample(track, 0, false, pose_s));
        key.interpolation = between;
    }
}

}  // namespace

std::vector<KeyframeTuple> tuples_of(const stage::Performance& performance, FrameRate rate) {
    std::map<std::pair<std::int64_t, std::string>, const stage::ScoreEntry*> last;
    for (const stage::ScoreEntry& row : performance.score()) {
        if (row.actor.empty() || row.end > performance.duration() || row.left < row.end) {
            continue;
        }
        const stage::ScoreEntry*& told = last[{rate.nearest_frame(row.end), row.actor}];
        if (told == nullptr || told->start <= row.start) {
            told = &row;
        }
    }
    std::vector<KeyframeTuple> tuples;
    for (const auto& [when, row] : last) {
        tuples.push_back({when.first, when.second, row->movement});
    }
    return tuples;
}

Checked<ClipFile> absolute_keyframes(std::span<const KeyframeTuple> tuples, const ClipFile& poses,
                                     double rate_hz, motion::Interpolation between,
                                     const std::string& path) {
    PUP_REQUIRE(rate_hz > 0);
    Defects defects;
    std::vector<KeyframeTuple> sorted(tuples.begin(), tuples.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.frame < b.frame; });
    ClipFile file;
    file.skeleton = poses.skeleton;
    file.frame_s = 1 / rate_hz;
    for (const KeyframeTuple& first : tuples) {
        if (find_clip(file, first.object) == nullptr) {
            Clip& clip = file.clips.emplace_back();
            clip.name = first.object;
        }
    }
    for (const KeyframeTuple& tuple : sorted) {
        const Clip* pose = find_clip(poses, tuple.event);
        if (pose == nullptr) {
            std::vector<std::string> names;
            for (const Clip& clip : poses.clips) {
                names.push_back(clip.name);
            }
            const std::string_view near = nearest_name(tuple.event, names);
            defects.error("unknown-pose", {path, 0, 0, 1}, "object " + tuple.object,
                          "no pose is called " + tuple.event,
                          near.empty() ? "give the file of poses a clip of that name"
                                       : "did you mean " + std::string(near) + "?");
            continue;
        }
        const Clip* at = find_clip(poses, tuple.object);
        const Transform world_from_local = at != nullptr ? root_of(*at) : Transform{};
        Clip& clip = *std::find_if(file.clips.begin(), file.clips.end(),
                                   [&](const Clip& c) { return c.name == tuple.object; });
        clip.root = pose->root;
        const double t = static_cast<double>(tuple.frame) / rate_hz;
        clip.duration_s = std::max(clip.duration_s, t);
        clip.marks.push_back({t, t, tuple.event, ""});
        add_keys(clip.rotations, pose->rotations, pose->duration_s, t, between,
                 [&](const std::string& target, Quat value) {
                     return target == pose->root ? normalized(world_from_local.rotation * value)
                                                 : value;
                 });
        add_keys(clip.translations, pose->translations, pose->duration_s, t, between,
                 [&](const std::string& target, Vec3 value) {
                     return target == pose->root ? world_from_local * value : value;
                 });
        add_keys(clip.numbers, pose->numbers, pose->duration_s, t, between,
                 [](const std::string&, double value) { return value; });
        // A root that the pose does not move stands where the object is.
        if (!pose->root.empty() && at != nullptr) {
            if (pose->find_translation(pose->root) == nullptr) {
                add_keys(clip.translations,
                         std::vector<motion::VectorTrack>{{pose->root, {motion::VectorKey{}}}}, 0,
                         t, between,
                         [&](const std::string&, Vec3 v) { return world_from_local * v; });
            }
            if (pose->find_rotation(pose->root) == nullptr) {
                add_keys(clip.rotations,
                         std::vector<motion::RotationTrack>{{pose->root, {motion::RotationKey{}}}},
                         0, t, between,
                         [&](const std::string&, Quat) { return world_from_local.rotation; });
            }
        }
    }
    for (const Clip& clip : file.clips) {
        if (const Status status = motion::check(clip, path); !status && !defects.any()) {
            return Unexpected(status.error());
        }
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    return file;
}

}  // namespace puppetri::io
