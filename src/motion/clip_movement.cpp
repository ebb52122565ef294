// SPDX-License-Identifier: MIT
#include "puppetri/motion/clip_movement.h"

#include <algorithm>

#include "creature_clip.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "times.h"

namespace puppetri::motion {
namespace {

constexpr std::string_view kHips = "hips";

const figure::Figure& any_humanoid() {
    static const figure::Figure figure = figure::make_mannequin(1.75);
    return figure;
}

class ClipSource final : public PoseSource {
 public:
    ClipSource(std::shared_ptr<const Clip> clip, std::span<const std::size_t> rotations,
               std::span<const std::size_t> numbers, double speed, double scale,
               double advances_m_s)
        : clip_(std::move(clip)),
          rotations_(rotations.begin(), rotations.end()),
          numbers_(numbers.begin(), numbers.end()),
          speed_(speed),
          scale_(scale),
          advances_m_s_(advances_m_s),
          place_(clip_->find_translation(kHips)),
          turn_(clip_->find_rotation(kHips)) {
        const Transform first = hips(0);
        start_ = {about_y(heading_of(first.rotation)),
                  {first.translation.x, 0, first.translation.z}};
    }

    void sample(double t_s, PoseFrame& frame) const override {
        const double t = t_s * speed_;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            frame.dofs[i] =
                motion::sample(clip_->numbers[numbers_[i]], t, clip_->loops, clip_->duration_s);
        }
        for (std::size_t i = 0; i < rotations_.size(); ++i) {
            frame.joints[i] =
                motion::sample(clip_->rotations[rotations_[i]], t, clip_->loops, clip_->duration_s);
        }
        if (place_ != nullptr) {
            Transform from_start = inverse(start_) * hips(t);
            from_start.translation = from_start.translation * scale_;
            from_start.translation.z += advances_m_s_ * t_s;
            frame.start_from_pelvis = from_start;
        }
    }

 private:
    Transform hips(double t_s) const {
        Transform out;
        if (place_ != nullptr) {
            out.translation = motion::sample(*place_, t_s, clip_->loops, clip_->duration_s);
        }
        if (turn_ != nullptr) {
            out.rotation = motion::sample(*turn_, t_s, clip_->loops, clip_->duration_s);
        }
        return out;
    }

    std::shared_ptr<const Clip> clip_;
    std::vector<std::size_t> rotations_, numbers_;
    double speed_, scale_, advances_m_s_;
    const VectorTrack* place_;
    const RotationTrack* turn_;
    Transform start_;
};

}  // namespace

ClipMaker::ClipMaker(std::string name, PlayableClip clip, double speed)
    : name_(std::move(name)), clip_(std::move(clip)), speed_(speed) {
    PUP_REQUIRE((clip_.humanoid != nullptr || clip_.raw != nullptr) && speed_ > 0);
    spec_.name = name_;
    spec_.duration_s = any().duration_s / speed_;
    spec_.loops = any().loops;
    if (clip_.humanoid == nullptr) {
        return;
    }
    const Clip& tracks = *clip_.humanoid;
    const figure::Figure& figure = any_humanoid();
    const figure::DofSet dofs = figure::humanoid_dofs(figure);
    for (std::size_t i = 0; i < tracks.rotations.size(); ++i) {
        const std::string& joint = tracks.rotations[i].target;
        if (joint != kHips && limb_of_joint(figure, joint)) {
            spec_.joints.push_back(joint);
            rotations_.push_back(i);
        }
    }
    for (std::size_t i = 0; i < tracks.numbers.size(); ++i) {
        if (dofs.find(tracks.numbers[i].target).valid()) {
            spec_.dofs.push_back(tracks.numbers[i].target);
            numbers_.push_back(i);
        }
    }
    spec_.travels = tracks.find_translation(kHips) != nullptr;
    advances_ = spec_.travels ? clip_.advances_m_s : 0;
    for (const ClipMark& mark : tracks.marks) {
        const double begin = mark.t_s / speed_, end = mark.end_s / speed_;
        const bool left =
            mark.target == "leftFoot" || mark.target == "left_leg" || mark.target == "leftToes";
        const bool right =
            mark.target == "rightFoot" || mark.target == "right_leg" || mark.target == "rightToes";
        if (mark.name == "contact" && (left || right) && end > begin) {
            spec_.contacts.push_back({left ? Side::kLeft : Side::kRight, begin, end});
        } else if (mark.end_s <= mark.t_s) {
            spec_.events.push_back(
                {begin, mark.name, limb_of_joint(figure, mark.target).value_or(Limb::kPelvis)});
        }
    }
}

bool ClipMaker::plays_on(const figure::Figure& figure) const {
    if (figure.humanoid()) {
        return clip_.humanoid != nullptr && limbs_of(figure, spec_).bits != 0;
    }
    if (clip_.raw == nullptr) {
        return false;
    }
    const PosedSpec spec =
        make_creature_clip(name_, clip_.raw, clip_.skeleton, figure, speed_, clip_.advances_m_s)
            .spec;
    return !spec.dofs.empty() || !spec.joints.empty();
}

MovementPtr ClipMaker::make(const OwnCall& call) const {
    const figure::Figure& figure = call.context.figure;
    if (!figure.humanoid()) {
        PUP_REQUIRE(clip_.raw != nullptr);
        CreatureClip made = make_creature_clip(name_, clip_.raw, clip_.skeleton, figure, speed_,
                                               clip_.advances_m_s);
        return make_posed(call.context, made.spec, std::move(made.source));
    }
    PUP_REQUIRE(clip_.humanoid != nullptr);
    const double scale = clip_.hips_height_m > 0 ? figure.hips_height_m / clip_.hips_height_m : 1;
    return make_posed(call.context, spec_,
                      std::make_shared<ClipSource>(clip_.humanoid, rotations_, numbers_, speed_,
                                                   scale, advances_));
}

DurationRange ClipMaker::declared(const Arguments&) const {
    const SimTime duration = whole_milliseconds(std::fmax(spec_.duration_s, 0.001));
    return {duration, duration};
}

}  // namespace puppetri::motion
