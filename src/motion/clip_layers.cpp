// SPDX-License-Identifier: MIT
#include "puppetri/motion/clip_layers.h"

#include <algorithm>
#include <array>
#include <set>

#include "clip_segment.h"
#include "puppetri/base/require.h"

namespace puppetri::motion {
namespace {

double smooth(double u) { return u <= 0 ? 0 : u >= 1 ? 1 : u * u * (3 - 2 * u); }

// How much say a layer has at an instant, before its mask; and where in its clip it is.
struct Say {
    double weight = 0, t_s = 0;
};
Say say_of(const ClipLayer& layer, double t_s) {
    PUP_REQUIRE(layer.clip != nullptr && layer.speed > 0);
    const double since = t_s - layer.begin_s;
    const double length = layer.clip->duration_s / layer.speed;
    if (since < 0 || (!layer.clip->loops && since > length)) {
        return {};
    }
    double weight = layer.weight;
    if (layer.fade_in_s > 0) {
        weight *= smooth(since / layer.fade_in_s);
    }
    if (layer.fade_out_s > 0 && !layer.clip->loops) {
        weight *= smooth((length - since) / layer.fade_out_s);
    }
    return {weight, since * layer.speed};
}

Quat combined(Quat below, Quat value, double weight, LayerMode mode) {
    if (mode == LayerMode::kAdditive) {
        return normalized(below * slerp({}, value, weight));
    }
    return weight >= 1 ? value : slerp(below, value, weight);
}
Vec3 combined(Vec3 below, Vec3 value, double weight, LayerMode mode) {
    return mode == LayerMode::kAdditive ? below + value * weight : lerp(below, value, weight);
}
double combined(double below, double value, double weight, LayerMode mode) {
    return mode == LayerMode::kAdditive ? below + value * weight : lerp(below, value, weight);
}

// Joint by joint: the values that the pose has, combined with those of the layer.
void apply_numbers(const ClipLayer& layer, const Say& say, const figure::Skeleton& skeleton,
                   const figure::DofSet& set, figure::Pose& pose) {
    const Clip& clip = *layer.clip;
    const ClipBinding binding = bind_clip({.numbers = clip.numbers}, skeleton, &set);
    for (const ClipBinding::Joint& joint : binding.joints) {
        Transform& t = pose.parent_from_joint[joint.joint.value];
        std::array<double, ClipBinding::kMostDofs> values{};
        const std::span<double> used(values.data(), joint.dofs.size());
        figure::values_of(joint.dofs, joint.parent_from_joint_rest, t, used);
        bool any = false;
        for (std::size_t i = 0; i < used.size(); ++i) {
            if (joint.tracks[i] < 0) {
                continue;
            }
            const NumberTrack& track = clip.numbers[static_cast<std::size_t>(joint.tracks[i])];
            const double weight = say.weight * layer.mask.weight_of(track.target);
            any = any || weight != 0;
            used[i] = combined(used[i], sample(track, say.t_s, clip.loops, clip.duration_s), weight,
                               layer.mode);
        }
        if (any) {
            t = figure::transform_of(joint.dofs, joint.parent_from_joint_rest, used);
        }
    }
}

}  // namespace

double LayerMask::weight_of(std::string_view target) const {
    for (const Part& part : parts) {
        if (part.target == target) {
            return part.weight;
        }
    }
    return others;
}

LayerMask mask_below(const figure::Skeleton& skeleton, std::string_view top) {
    LayerMask mask;
    mask.others = 0;
    std::vector<char> in(skeleton.joints.size(), 0);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const figure::Joint& joint = skeleton.joints[j];
        in[j] = joint.name == top || (joint.parent.valid() && in[joint.parent.value]);
        if (in[j]) {
            mask.parts.push_back({joint.name, 1});
        }
    }
    return mask;
}

void apply_layers(std::span<const ClipLayer> layers, const figure::Skeleton& skeleton, double t_s,
                  figure::Pose& pose, const figure::DofSet* dofs) {
    for (const ClipLayer& layer : layers) {
        const Say say = say_of(layer, t_s);
        if (say.weight == 0) {
            continue;
        }
        const Clip& clip = *layer.clip;
        const auto apply = [&](const auto& tracks, auto part_of) {
            for (const auto& track : tracks) {
                const figure::JointIndex j = skeleton.find(track.target);
                const double weight = say.weight * layer.mask.weight_of(track.target);
                if (j.valid() && weight != 0) {
                    auto& part = part_of(pose.parent_from_joint[j.value]);
                    part = combined(part, sample(track, say.t_s, clip.loops, clip.duration_s),
                                    weight, layer.mode);
                }
            }
        };
        apply(clip.rotations, [](Transform& t) -> Quat& { return t.rotation; });
        apply(clip.translations, [](Transform& t) -> Vec3& { return t.translation; });
        if (dofs != nullptr) {
            apply_numbers(layer, say, skeleton, *dofs, pose);
        }
    }
}

Clip flattened(std::span<const ClipLayer> layers, const figure::Skeleton& skeleton,
               double duration_s, double rate_hz, const figure::DofSet* dofs) {
    PUP_REQUIRE(duration_s >= 0 && rate_hz > 0);
    Clip out;
    out.name = layers.empty() ? "layers" : layers.front().clip->name;
    out.duration_s = duration_s;
    out.root = layers.empty() ? "" : layers.front().clip->root;
    std::set<std::string> turning, moving, counting;
    for (const ClipLayer& layer : layers) {
        for (const RotationTrack& t : layer.clip->rotations) {
            if (skeleton.find(t.target).valid() && turning.insert(t.target).second) {
                out.rotations.push_back({t.target, {}});
            }
        }
        for (const VectorTrack& t : layer.clip->translations) {
            if (skeleton.find(t.target).valid() && moving.insert(t.target).second) {
                out.translations.push_back({t.target, {}});
            }
        }
        for (ClipMark mark : layer.clip->marks) {
            mark.t_s = layer.begin_s + mark.t_s / layer.speed;
            mark.end_s = std::min(layer.begin_s + mark.end_s / layer.speed, duration_s);
            if (mark.t_s >= 0 && mark.t_s <= duration_s) {
                out.marks.push_back(std::move(mark));
            }
        }
    }
    for (const ClipLayer& layer : layers) {
        for (const NumberTrack& t : layer.clip->numbers) {
            const figure::DofIndex dof =
                dofs != nullptr ? dofs->find(t.target) : figure::DofIndex{};
            const bool turned =
                dof.valid() &&
                turning.count(skeleton.joints[dofs->dofs[dof.value].joint.value].name) != 0;
            if (!turned && counting.insert(t.target).second) {
                out.numbers.push_back({t.target, {}});
            }
        }
    }
    std::stable_sort(out.marks.begin(), out.marks.end(),
                     [](const ClipMark& a, const ClipMark& b) { return a.t_s < b.t_s; });
    const figure::Pose rest = figure::rest_pose(skeleton);
    const auto frame = [&](double t) {
        figure::Pose pose = rest;
        apply_layers(layers, skeleton, t, pose, dofs);
        for (RotationTrack& track : out.rotations) {
            RotationKey& key = track.keys.emplace_back();
            key.t_s = t;
            key.value = pose.parent_from_joint[skeleton.find(track.target).value].rotation;
        }
        for (VectorTrack& track : out.translations) {
            VectorKey& key = track.keys.emplace_back();
            key.t_s = t;
            key.value = pose.parent_from_joint[skeleton.find(track.target).value].translation;
        }
        for (NumberTrack& track : out.numbers) {
            double value = 0;
            for (const ClipLayer& layer : layers) {
                const Say say = say_of(layer, t);
                const double weight = say.weight * layer.mask.weight_of(track.target);
                if (const NumberTrack* own = layer.clip->find_number(track.target);
                    own != nullptr && weight != 0) {
                    value = combined(
                        value, sample(*own, say.t_s, layer.clip->loops, layer.clip->duration_s),
                        weight, layer.mode);
                }
            }
            NumberKey& key = track.keys.emplace_back();
            key.t_s = t;
            key.value = value;
        }
    };
    for (std::size_t k = 0; static_cast<double>(k) / rate_hz < duration_s - 1e-9; ++k) {
        frame(static_cast<double>(k) / rate_hz);
    }
    frame(duration_s);
    return out;
}

Clip to_additive(const Clip& clip, double reference_s) {
    Clip out = clip;
    for (std::size_t i = 0; i < out.rotations.size(); ++i) {
        const Quat from = sample(clip.rotations[i], reference_s, clip.loops, clip.duration_s);
        for (RotationKey& key : out.rotations[i].keys) {
            key.value = normalized(conjugate(from) * key.value);  // rates are the body's: they stay
        }
    }
    for (std::size_t i = 0; i < out.translations.size(); ++i) {
        const Vec3 from = sample(clip.translations[i], reference_s, clip.loops, clip.duration_s);
        for (VectorKey& key : out.translations[i].keys) {
            key.value = key.value - from;
        }
    }
    for (std::size_t i = 0; i < out.numbers.size(); ++i) {
        const double from = sample(clip.numbers[i], reference_s, clip.loops, clip.duration_s);
        for (NumberKey& key : out.numbers[i].keys) {
            key.value -= from;
        }
    }
    return out;
}

}  // namespace puppetri::motion
