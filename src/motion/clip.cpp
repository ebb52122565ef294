// SPDX-License-Identifier: MIT
// Sampling of editable clips, and their defects.
#include "puppetri/motion/clip.h"

#include <algorithm>
#include <array>
#include <set>

#include "clip_segment.h"
#include "puppetri/base/require.h"
#include "puppetri/base/text.h"

namespace puppetri::motion {
namespace {

template <class Key>
const ClipTrack<Key>* find(const std::vector<ClipTrack<Key>>& tracks, std::string_view target) {
    for (const ClipTrack<Key>& track : tracks) {
        if (track.target == target) {
            return &track;
        }
    }
    return nullptr;
}

template <class Key>
typename Key::Value value_at(const ClipTrack<Key>& track, double t_s, bool loops,
                             double duration_s) {
    PUP_REQUIRE(!track.keys.empty());
    const double t = clip_time(t_s, loops, duration_s);
    const std::size_t i = segment_of(track.keys, t);
    if (t <= track.keys[i].t_s || i + 1 == track.keys.size()) {
        return track.keys[i].value;
    }
    return value_in(make_segment(track, i, has_seam(track, loops, duration_s)), t);
}

template <class Key>
typename Key::Rate rate_at(const ClipTrack<Key>& track, double t_s, bool loops, double duration_s) {
    PUP_REQUIRE(!track.keys.empty());
    const double t = clip_time(t_s, loops, duration_s);
    std::size_t i = segment_of(track.keys, t);
    const bool seam = has_seam(track, loops, duration_s);
    if (track.keys.size() < 2 || t < track.keys[0].t_s || t > track.keys.back().t_s) {
        return {};
    }
    if (i + 1 == track.keys.size()) {
        if (!seam) {
            --i;  // the very end: the rate with which the curve arrives
        } else {
            return rate_in(make_segment(track, 0, seam), 0);
        }
    }
    return rate_in(make_segment(track, i, seam), t);
}

// Beyond any figure: what is larger is a broken file, and would make endless work of sampling.
constexpr double kLargest = 1e9, kLongest_s = 1e6;
bool finite(double x) { return std::fabs(x) < kLargest; }
bool finite(Vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }
bool finite(Quat q) { return finite(Vec3{q.x, q.y, q.z}) && finite(q.w); }
bool well_formed(double x) { return finite(x); }
bool well_formed(Vec3 v) { return finite(v); }
bool well_formed(Quat q) {
    return finite(q) && std::fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 2e-3;
}

// Collects defects; of each track only the first bad key of a kind is told, with its number.
class Checker {
 public:
    Checker(const Clip& clip, std::string_view file) : clip_(clip), file_(file) {}

    Diagnostics run() {
        if (!(clip_.duration_s >= 0 && clip_.duration_s <= kLongest_s)) {
            complain("bad-clip-time", "clip " + clip_.name,
                     "the duration is not a number of seconds from 0 to a million",
                     "give the clip a duration");
            return std::move(defects_);
        }
        tracks(clip_.rotations, "rotation of ");
        tracks(clip_.translations, "translation of ");
        tracks(clip_.numbers, "track ");
        for (std::size_t i = 0; i < clip_.marks.size(); ++i) {
            const ClipMark& mark = clip_.marks[i];
            if (!(mark.t_s >= 0 && mark.end_s >= mark.t_s && mark.end_s <= clip_.duration_s) ||
                (i > 0 && mark.t_s < clip_.marks[i - 1].t_s)) {
                complain("bad-clip-time", "mark " + mark.name,
                         "its time is outside the clip, or marks are not in the order of time",
                         "put it between 0 and " + number_to_text(clip_.duration_s) + " s");
            }
        }
        return std::move(defects_);
    }

 private:
    void complain(const char* code, std::string element, std::string message, std::string remedy) {
        defects_.push_back({Severity::kError,
                            code,
                            {std::string(file_), 0, 0, 1},
                            std::move(element),
                            std::move(message),
                            std::move(remedy)});
    }

    template <class Key>
    void tracks(const std::vector<ClipTrack<Key>>& list, const char* kind) {
        std::set<std::string_view> seen;
        for (const ClipTrack<Key>& track : list) {
            const std::string element = kind + track.target;
            if (track.target.empty() || !seen.insert(track.target).second) {
                complain("bad-clip-track", element, "a track needs a name of its own",
                         "leave out one of the tracks");
            }
            if (track.keys.empty()) {
                complain("bad-clip-track", element, "there are no keys",
                         "give it a key, or leave it out");
            }
            keys(track, element);
        }
    }

    template <class Key>
    void keys(const ClipTrack<Key>& track, const std::string& element) {
        double before = -1;
        for (std::size_t i = 0; i < track.keys.size(); ++i) {
            const Key& key = track.keys[i];
            const std::string here = element + ", key " + std::to_string(i + 1);
            if (!(key.t_s > before && key.t_s >= 0 && key.t_s <= clip_.duration_s)) {
                complain("bad-clip-time", here,
                         "its time is not after the key before, or outside the clip",
                         "keys stand in ascending order between 0 and " +
                             number_to_text(clip_.duration_s) + " s");
                return;
            }
            before = key.t_s;
            const KeyShape& s = key.shape;
            if (!well_formed(key.value) || !finite(key.in) || !finite(key.out) ||
                !finite(s.tension) || !finite(s.continuity) || !finite(s.bias)) {
                complain("bad-clip-value", here,
                         "its value is not a finite number below 1e9, or not a rotation",
                         "give finite numbers, and of rotations unit quaternions");
                return;
            }
            const Easing& e = key.easing;
            if (!runs_forward(e) || !finite(e.y1) || !finite(e.y2)) {
                complain("bad-clip-value", here, "the time of its easing would run back",
                         "keep x1 and x2 of the easing between 0 and 1");
                return;
            }
        }
    }

    const Clip& clip_;
    std::string_view file_;
    Diagnostics defects_;
};

}  // namespace

std::string_view name_of(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::kStep:
            return "step";
        case Interpolation::kLinear:
            return "linear";
        case Interpolation::kCatmullRom:
            return "catmull-rom";
        case Interpolation::kCardinal:
            return "cardinal";
        case Interpolation::kKochanekBartels:
            return "kochanek-bartels";
        case Interpolation::kHermite:
            return "hermite";
        case Interpolation::kBezier:
            return "bezier";
    }
    return "";
}

const RotationTrack* Clip::find_rotation(std::string_view joint) const {
    return find(rotations, joint);
}
const VectorTrack* Clip::find_translation(std::string_view joint) const {
    return find(translations, joint);
}
const NumberTrack* Clip::find_number(std::string_view dof) const { return find(numbers, dof); }

Status check(const Clip& clip, std::string_view file) {
    Diagnostics defects = Checker(clip, file).run();
    if (!defects.empty()) {
        return Unexpected(std::move(defects));
    }
    return Ok{};
}

Quat sample(const RotationTrack& track, double t_s, bool loops, double duration_s) {
    return value_at(track, t_s, loops, duration_s);
}
Vec3 sample(const VectorTrack& track, double t_s, bool loops, double duration_s) {
    return value_at(track, t_s, loops, duration_s);
}
double sample(const NumberTrack& track, double t_s, bool loops, double duration_s) {
    return value_at(track, t_s, loops, duration_s);
}
Vec3 sample_rate(const RotationTrack& track, double t_s, bool loops, double duration_s) {
    return rate_at(track, t_s, loops, duration_s);
}
Vec3 sample_rate(const VectorTrack& track, double t_s, bool loops, double duration_s) {
    return rate_at(track, t_s, loops, duration_s);
}
double sample_rate(const NumberTrack& track, double t_s, bool loops, double duration_s) {
    return rate_at(track, t_s, loops, duration_s);
}

ClipBinding bind_clip(const Clip& clip, const figure::Skeleton& skeleton,
                      const figure::DofSet* dofs) {
    ClipBinding binding;
    for (const RotationTrack& track : clip.rotations) {
        binding.rotations.push_back(skeleton.find(track.target));
    }
    for (const VectorTrack& track : clip.translations) {
        binding.translations.push_back(skeleton.find(track.target));
    }
    for (std::size_t i = 0; dofs != nullptr && i < clip.numbers.size(); ++i) {
        const figure::DofIndex dof = dofs->find(clip.numbers[i].target);
        if (!dof.valid()) {
            continue;
        }
        const figure::JointIndex joint = dofs->dofs[dof.value].joint;
        const figure::DofSet::Range range = dofs->of_joint(joint);
        if (range.count > ClipBinding::kMostDofs) {
            continue;
        }
        auto found = std::find_if(binding.joints.begin(), binding.joints.end(),
                                  [&](const auto& j) { return j.joint == joint; });
        if (found == binding.joints.end()) {
            const auto first = dofs->dofs.begin() + range.first;
            binding.joints.push_back({joint,
                                      skeleton.joints[joint.value].parent_from_joint_rest,
                                      {first, first + range.count},
                                      std::vector<std::int32_t>(range.count, -1)});
            found = binding.joints.end() - 1;
        }
        found->tracks[dof.value - range.first] = static_cast<std::int32_t>(i);
    }
    for (ClipBinding::Joint& joint : binding.joints) {
        joint.all = std::find(joint.tracks.begin(), joint.tracks.end(), -1) == joint.tracks.end();
    }
    return binding;
}

void sample_clip(const Clip& clip, const ClipBinding& binding, double t_s, figure::Pose& out) {
    PUP_REQUIRE(binding.rotations.size() == clip.rotations.size() &&
                binding.translations.size() == clip.translations.size());
    for (std::size_t i = 0; i < clip.rotations.size(); ++i) {
        if (const figure::JointIndex j = binding.rotations[i]; j.valid()) {
            PUP_REQUIRE(j.value < out.parent_from_joint.size());
            out.parent_from_joint[j.value].rotation =
                sample(clip.rotations[i], t_s, clip.loops, clip.duration_s);
        }
    }
    for (std::size_t i = 0; i < clip.translations.size(); ++i) {
        if (const figure::JointIndex j = binding.translations[i]; j.valid()) {
            PUP_REQUIRE(j.value < out.parent_from_joint.size());
            out.parent_from_joint[j.value].translation =
                sample(clip.translations[i], t_s, clip.loops, clip.duration_s);
        }
    }
    for (const ClipBinding::Joint& joint : binding.joints) {
        PUP_REQUIRE(joint.joint.value < out.parent_from_joint.size());
        Transform& at = out.parent_from_joint[joint.joint.value];
        std::array<double, ClipBinding::kMostDofs> room{};
        const std::span<double> values(room.data(), joint.dofs.size());
        if (!joint.all) {
            figure::values_of(joint.dofs, joint.parent_from_joint_rest, at, values);
        }
        for (std::size_t d = 0; d < joint.dofs.size(); ++d) {
            if (joint.tracks[d] >= 0) {
                values[d] = sample(clip.numbers[static_cast<std::size_t>(joint.tracks[d])], t_s,
                                   clip.loops, clip.duration_s);
            }
        }
        at = figure::transform_of(joint.dofs, joint.parent_from_joint_rest, values);
    }
}

}  // namespace puppetri::motion
