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

Checked<std::vector<KeyframeTuple>> read_tuples(std::string_view text, const std::string& path) {
    Defects defects;
    std::vector<KeyframeTuple> tuples;
    std::map<std::pair<std::string, std::int64_t>, std::uint32_t> seen;
    std::uint32_t line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view row = text.substr(at, end - at);
        at = end + 1;
        ++line;
        row = row.substr(0, row.find('#'));
        std::vector<std::pair<std::string_view, std::uint32_t>> words;
        for (std::size_t i = 0; i < row.size();) {
            const auto blank = [&](char c) { return c == ' ' || c == '\t' || c == '\r'; };
            if (blank(row[i])) {
                ++i;
                continue;
            }
            const std::size_t begin = i;
            while (i < row.size() && !blank(row[i])) {
                ++i;
            }
            words.emplace_back(row.substr(begin, i - begin), column_of(row, begin));
        }
        if (words.empty()) {
            continue;
        }
        const std::optional<double> frame = parse_number(words[0].first);
        if (words.size() != 3 || !frame || !(*frame >= 0 && *frame <= 1e12) ||
            *frame != std::floor(*frame)) {
            defects.error("bad-tuple", {path, line, words[0].second, 1}, "",
                          "a line is: FRAME OBJECT EVENT, the frame a whole number from 0",
                          "write it like: 24 man1 EATING1");
            continue;
        }
        KeyframeTuple tuple{static_cast<std::int64_t>(*frame), std::string(words[1].first),
                            std::string(words[2].first)};
        if (!seen.try_emplace({tuple.object, tuple.frame}, line).second) {
            defects.error("bad-tuple", {path, line, words[1].second, 1}, "object " + tuple.object,
                          "it reaches two keyframes at one frame", "leave one of them out");
        }
        tuples.push_back(std::move(tuple));
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    return tuples;
}

std::string make_tuples(std::span<const KeyframeTuple> tuples) {
    std::vector<KeyframeTuple> sorted(tuples.begin(), tuples.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.frame < b.frame; });
    std::string text;
    for (const KeyframeTuple& t : sorted) {
        text += std::to_string(t.frame) + " " + t.object + " " + t.event + "\n";
    }
    return text;
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
