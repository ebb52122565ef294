// SPDX-License-Identifier: MIT
#include "puppetri/io/humanoid_clips.h"

#include <set>

#include "puppetri/figure/complete_humanoid.h"
#include "puppetri/figure/fit_humanoid.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/motion/walk_cycle.h"

namespace puppetri::io {
namespace {

using figure::JointIndex;
using figure::Pose;
using figure::Skeleton;

// The skeleton with a root on the floor above all that the file has.
Skeleton rooted(const Skeleton& raw) {
    Skeleton out;
    out.height_m = raw.height_m;
    out.joints.push_back({"puppetri root", {}, {}, {}});
    for (figure::Joint joint : raw.joints) {
        joint.parent = {joint.parent.valid() ? joint.parent.value + 1 : 0};
        out.joints.push_back(std::move(joint));
    }
    return out;
}

std::vector<double> times_of(const motion::Clip& clip) {
    std::set<double> times{0, clip.duration_s};
    for (const motion::RotationTrack& track : clip.rotations) {
        for (const motion::RotationKey& key : track.keys) {
            times.insert(key.t_s);
        }
    }
    return {times.begin(), times.end()};
}

// The height of the lowest contact point of both feet.
double lowest_sole(const figure::Figure& figure, const Pose& pose) {
    std::vector<Transform> world(figure.skeleton.joints.size());
    to_model_space(figure.skeleton, pose, world);
    double lowest = 1e9;
    for (const figure::Leg& leg : figure.legs) {
        const Transform& foot = world[leg.ankle.value];
        lowest = std::fmin(lowest, (foot * leg.heel_foot).y);
        lowest = std::fmin(lowest, (foot * leg.ball_foot).y);
    }
    return lowest;
}

motion::Clip converted(const motion::Clip& clip, const Skeleton& raw,
                       const figure::CompletedSkeleton& completed,
                       const figure::Humanoid& humanoid) {
    const Skeleton& target = humanoid.figure.skeleton;
    const motion::ClipBinding binding = motion::bind_clip(clip, raw);
    motion::Clip out;
    out.name = clip.name;
    out.duration_s = clip.duration_s;
    out.loops = clip.loops;
    out.marks = clip.marks;
    out.root = "hips";
    out.numbers = clip.numbers;
    std::vector<std::size_t> track_of(target.joints.size(), ~std::size_t{0});
    for (std::size_t j = 0; j < target.joints.size(); ++j) {
        if (j != humanoid.figure.root.value) {
            track_of[j] = out.rotations.size();
            out.rotations.push_back({target.joints[j].name, {}});
        }
    }
    out.translations.push_back({"hips", {}});
    Pose pose = figure::rest_pose(raw), normal;
    double lowest = 1e9;
    for (const double t : times_of(clip)) {
        motion::sample_clip(clip, binding, t, pose);
        humanoid.rig.to_figure(humanoid.figure, completed.skeleton, completed.carry(raw, pose),
                               normal);
        const Transform hips = normal.parent_from_joint[humanoid.figure.root.value] *
                               normal.parent_from_joint[humanoid.figure.hips.value];
        for (std::size_t j = 0; j < target.joints.size(); ++j) {
            if (track_of[j] == ~std::size_t{0}) {
                continue;
            }
            motion::RotationKey key;
            key.t_s = t;
            key.value = j == humanoid.figure.hips.value ? hips.rotation
                                                        : normal.parent_from_joint[j].rotation;
            key.interpolation = motion::Interpolation::kCatmullRom;
            auto& keys = out.rotations[track_of[j]].keys;
            if (!keys.empty()) {  // the same hemisphere, for the spline
                const Quat& q = keys.back().value;
                Quat& v = key.value;
                if (q.x * v.x + q.y * v.y + q.z * v.z + q.w * v.w < 0) {
                    v = {-v.x, -v.y, -v.z, -v.w};
                }
            }
            keys.push_back(key);
        }
        motion::VectorKey place;
        place.t_s = t;
        place.value = hips.translation;
        lowest = std::fmin(lowest, lowest_sole(humanoid.figure, normal));
        place.interpolation = motion::Interpolation::kCatmullRom;
        out.translations[0].keys.push_back(place);
    }
    // The floor is where the feet come down to, whatever the zero of the capture.
    for (motion::VectorKey& key : out.translations[0].keys) {
        key.value.y -= lowest;
    }
    if (out.marks.empty()) {
        for (const char* side : {"left", "right"}) {
            const motion::FootJoints foot{std::string(side) + "Foot", std::string(side) + "Toes"};
            for (motion::ClipMark& mark : motion::find_contacts(out, target, foot, {})) {
                out.marks.push_back(std::move(mark));
            }
        }
    }
    return out;
}

}  // namespace

scene::LoadedClips clips_for_figures(ClipFile file, const std::string& path) {
    scene::LoadedClips loaded;
    loaded.notes = std::move(file.notes);
    loaded.raw = std::move(file.clips);
    loaded.skeleton = std::move(file.skeleton);
    if (loaded.skeleton.joints.empty()) {
        loaded.humanoid = loaded.raw;
        return loaded;
    }
    const Skeleton raw = rooted(loaded.skeleton);
    const figure::CompletedSkeleton completed = figure::complete_humanoid(raw, {}, find_bones(raw));
    auto humanoid = figure::fit_humanoid(completed.skeleton, {}, completed.bones);
    if (!humanoid) {
        loaded.no_humanoid = std::move(humanoid.error());
        for (Diagnostic& d : loaded.no_humanoid) {
            d.where.file = path;
        }
        // Creatures take lengths by the length of their bones.
        std::erase_if(loaded.notes, [](const Diagnostic& d) { return d.code == "odd-scale"; });
        return loaded;
    }
    const double height = humanoid->figure.height_m;
    if (height > 4 || height < 0.3) {
        loaded.notes.push_back({Severity::kWarning,
                                "odd-scale",
                                {path, 0, 0, 1},
                                "skeleton",
                                "the figure of this file would be " +
                                    std::to_string(static_cast<long long>(height * 100)) +
                                    " cm tall",
                                "give a scale: `scale 0.0564` for captures in the units of CMU"});
    }
    loaded.hips_height_m = humanoid->figure.hips_height_m;
    for (const motion::Clip& clip : loaded.raw) {
        loaded.humanoid.push_back(converted(clip, raw, completed, *humanoid));
    }
    return loaded;
}

}  // namespace puppetri::io
