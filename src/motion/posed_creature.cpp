// SPDX-License-Identifier: MIT
#include "posed_creature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "times.h"

namespace puppetri::motion {
namespace {

using figure::Dof;
using figure::JointIndex;

constexpr std::size_t kMostDofsOfJoint = 6;

// Reused by every such movement of a thread; results never depend on what it holds.
struct Scratch {
    std::vector<double> dofs;
    std::vector<Quat> joints;
    std::vector<Vec3> paths;
};

class PosedCreature final : public Movement {
 public:
    PosedCreature(const MotionContext& context, const PosedSpec& spec,
                  std::shared_ptr<const PoseSource> source)
        : figure_(context.figure),
          spec_(spec),
          source_(std::move(source)),
          start_(context.now.pelvis) {
        for (std::size_t i = 0; i < spec_.paths.size(); ++i) {
            path_ = spec_.paths[i].limb == Limb::kPelvis ? static_cast<int>(i) : path_;
        }
        limbs = limb_set(Limb::kBody);
        if (path_ >= 0 || spec_.travels) {
            limbs = limbs.with(Limb::kPelvis);
        }
        overlays = limb_set(Limb::kBody);
        duration =
            context.duration.ticks >= 0 ? context.duration : whole_milliseconds(spec_.duration_s);
        pace_ = duration.ticks > 0 ? spec_.duration_s / duration.seconds() : 1;
        for (const PosedSpec::Event& event : spec_.events) {
            events.push_back(
                {to_time(pace_ > 0 ? event.at_s / pace_ : event.at_s), event.name, event.limb});
        }
        find_drives();
        Scratch s;
        first_place_ = frame_at(0, s);
        first_ = path_ >= 0 ? s.paths[static_cast<std::size_t>(path_)] : Vec3{};
    }

    void sample(double t_s, Controls& out) const override {
        if (!limbs.has(Limb::kPelvis)) {
            return;
        }
        static thread_local Scratch s;
        const Transform place = frame_at(t_s, s);
        Transform world = {start_.rotation_world, start_.position_world};
        if (spec_.travels) {
            world = world * (inverse(first_place_) * place);
        }
        if (path_ >= 0) {
            const Vec3 way = s.paths[static_cast<std::size_t>(path_)] - first_;
            world.translation = world.translation + rotate(start_.rotation_world, way);
        }
        out.pelvis = {world.translation, normalized(world.rotation)};
    }

    void overlay(double t_s, LimbSet which, figure::Pose& pose) const override {
        if (!which.has(Limb::kBody)) {
            return;
        }
        static thread_local Scratch s;
        frame_at(t_s, s);
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            pose.parent_from_joint[joints_[i].value].rotation = s.joints[i];
        }
        for (const Drive& drive : drives_) {
            const auto dofs =
                std::span(figure_.dofs.dofs).subspan(drive.range.first, drive.range.count);
            std::array<double, kMostDofsOfJoint> values{};
            for (std::size_t i = 0; i < dofs.size(); ++i) {
                values[i] = drive.from[i] < 0
                                ? dofs[i].at_rest
                                : clamp(s.dofs[static_cast<std::size_t>(drive.from[i])], dofs[i].lo,
                                        dofs[i].hi);
            }
            pose.parent_from_joint[drive.joint.value] = figure::transform_of(
                dofs, figure_.skeleton.joints[drive.joint.value].parent_from_joint_rest, values);
        }
    }

 private:
    struct Drive {
        JointIndex joint;
        figure::DofSet::Range range;
        std::array<std::int32_t, kMostDofsOfJoint> from{};  // number in the frame, -1: at rest
    };

    void find_drives() {
        for (std::size_t i = 0; i < spec_.dofs.size(); ++i) {
            const figure::DofIndex dof = figure_.dofs.find(spec_.dofs[i]);
            PUP_REQUIRE(dof.valid());
            const JointIndex joint = figure_.dofs.dofs[dof.value].joint;
            auto found = std::find_if(drives_.begin(), drives_.end(),
                                      [&](const Drive& d) { return d.joint == joint; });
            if (found == drives_.end()) {
                Drive drive{joint, figure_.dofs.of_joint(joint), {}};
                PUP_REQUIRE(drive.range.count <= kMostDofsOfJoint);
                drive.from.fill(-1);
                found = drives_.insert(found, drive);
            }
            found->from[dof.value - found->range.first] = static_cast<std::int32_t>(i);
        }
        for (const std::string& name : spec_.joints) {
            joints_.push_back(figure_.skeleton.find(name));
            PUP_REQUIRE(joints_.back().valid());
        }
    }

    // Fills the scratch and gives the place of a clip that travels.
    Transform frame_at(double t_s, Scratch& s) const {
        s.dofs.resize(spec_.dofs.size());
        s.joints.resize(spec_.joints.size());
        s.paths.resize(spec_.paths.size());
        PoseFrame frame{s.dofs, s.joints, s.paths, {}};
        const double t = t_s * pace_, end = spec_.duration_s;
        const double turns = spec_.loops && end > 0 ? std::floor(t / end) : 0;
        source_->sample(clamp(t - turns * end, 0, end), frame);
        return frame.start_from_pelvis;
    }

    const figure::Figure& figure_;
    PosedSpec spec_;
    std::shared_ptr<const PoseSource> source_;
    PelvisControl start_;
    int path_ = -1;
    double pace_ = 1;
    Vec3 first_;
    Transform first_place_;
    std::vector<Drive> drives_;
    std::vector<JointIndex> joints_;
};

}  // namespace

MovementPtr make_posed_creature(const MotionContext& context, const PosedSpec& spec,
                                std::shared_ptr<const PoseSource> source) {
    return std::make_shared<PosedCreature>(context, spec, std::move(source));
}

}  // namespace puppetri::motion
