// SPDX-License-Identifier: MIT
#include "puppetri/motion/clip_movement.h"

#include <algorithm>

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
               std::span<const std::size_t> numbers, double speed, double scale)
        : clip_(std::move(clip)),
          rotations_(rotations.begin(), rotations.end()),
          numbers_(numbers.begin(), numbers.end()),
          speed_(speed),
          scale_(scale),
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
    double speed_, scale_;
    const VectorTrack* place_;
    const RotationTrack* turn_;
    Transform start_;
};

}  // namespace

ClipMaker::ClipMaker(std::string name, std::shared_ptr<const Clip> clip, ClipPlay play)
    : clip_(std::move(clip)), play_(play) {
    PUP_REQUIRE(clip_ != nullptr && play_.speed > 0);
    const figure::Figure& figure = any_humanoid();
    const figure::DofSet dofs = figure::humanoid_dofs(figure);
    spec_.name = std::move(name);
    spec_.duration_s = clip_->duration_s / play_.speed;
    spec_.loops = clip_->loops;
    const auto driven = [&](std::string_view joint) {
        const auto limb = limb_of_joint(figure, joint);
        return limb && play_.only.has(*limb);
    };
    for (std::size_t i = 0; i < clip_->rotations.size(); ++i) {
        const std::string& joint = clip_->rotations[i].target;
        if (joint != kHips && driven(joint)) {
            spec_.joints.push_back(joint);
            rotations_.push_back(i);
        }
    }
    for (std::size_t i = 0; i < clip_->numbers.size(); ++i) {
        const std::string& name_of_dof = clip_->numbers[i].target;
        const std::string_view joint =
            figure::humanoid_joint(std::string_view(name_of_dof).substr(0, name_of_dof.find('.')));
        if (dofs.find(name_of_dof).valid() && driven(joint)) {
            spec_.dofs.push_back(name_of_dof);
            numbers_.push_back(i);
        }
    }
    spec_.travels = clip_->find_translation(kHips) != nullptr && play_.only.has(Limb::kPelvis);
    for (const ClipMark& mark : clip_->marks) {
        const double begin = mark.t_s / play_.speed, end = mark.end_s / play_.speed;
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

MovementPtr ClipMaker::make(const OwnCall& call) const {
    const double own = call.context.figure.hips_height_m;
    const double scale = play_.hips_height_m > 0 ? own / play_.hips_height_m : 1;
    return make_posed(
        call.context, spec_,
        std::make_shared<ClipSource>(clip_, rotations_, numbers_, play_.speed, scale));
}

DurationRange ClipMaker::declared(const Arguments&) const {
    const SimTime duration = whole_milliseconds(std::fmax(spec_.duration_s, 0.001));
    return {duration, duration};
}

}  // namespace puppetri::motion
