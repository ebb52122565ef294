// SPDX-License-Identifier: MIT
#include "posed_creature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "clip_root.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "rounds.h"

namespace puppetri::motion {
namespace {

using figure::Dof;
using figure::JointIndex;

constexpr std::size_t kMostDofsOfJoint = 6;

// Reused by every such movement of a thread; results never depend on what it holds.
struct Scratch {
    std::vector<double> dofs;
    std::vector<Quat> joints;
    std::vector<Vec3> paths, places;
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
        rounds_ = Rounds(spec_, duration);
        rounds_.tell_events(spec_, events);
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
        find_drives();
        Scratch s;
        const auto way = [&] {
            return path_ >= 0 ? s.paths[static_cast<std::size_t>(path_)] : Vec3{};
        };
        lap_ = source_at(spec_.duration_s, s);
        lap_way_ = way();
        from_first_ = inverse(source_at(0, s));
        lap_ = from_first_ * lap_;
        first_ = way();
        lap_way_ = lap_way_ - first_;
    }

    void sample(double t_s, Controls& out) const override {
        if (!limbs.has(Limb::kPelvis)) {
            return;
        }
        static thread_local Scratch s;
        const Rounds::At at = rounds_.at(t_s);
        const Transform place = power(lap_, at.round) * from_first_ * source_at(at.source_s, s);
        Transform world = {start_.rotation_world, start_.position_world};
        if (spec_.travels) {
            world = world * place;
        }
        if (path_ >= 0) {
            const Vec3 way =
                s.paths[static_cast<std::size_t>(path_)] - first_ + lap_way_ * at.round;
            world.translation = world.translation + rotate(start_.rotation_world, way);
        }
        out.pelvis = {world.translation, normalized(world.rotation)};
    }

    void overlay(double t_s, LimbSet which, figure::Pose& pose) const override {
        if (!which.has(Limb::kBody)) {
            return;
        }
        static thread_local Scratch s;
        source_at(rounds_.at(t_s).source_s, s);
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            pose.parent_from_joint[joints_[i].value].rotation = s.joints[i];
        }
        for (std::size_t i = 0; i < places_.size(); ++i) {
            pose.parent_from_joint[places_[i].value].translation = s.places[i];
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
        const auto find = [&](const std::vector<std::string>& names,
                              std::vector<JointIndex>& joints) {
            for (const std::string& name : names) {
                joints.push_back(figure_.skeleton.find(name));
                PUP_REQUIRE(joints.back().valid());
            }
        };
        find(spec_.joints, joints_);
        find(spec_.places, places_);
    }

    // Fills the scratch and gives how far a clip that travels has come.
    Transform source_at(double source_s, Scratch& s) const {
        s.dofs.resize(spec_.dofs.size());
        s.joints.resize(spec_.joints.size());
        s.paths.resize(spec_.paths.size());
        s.places.resize(spec_.places.size());
        PoseFrame frame{s.dofs, s.joints, s.paths, {}, s.places};
        source_->sample(source_s, frame);
        return frame.start_from_pelvis;
    }
    const figure::Figure& figure_;
    PosedSpec spec_;
    std::shared_ptr<const PoseSource> source_;
    PelvisControl start_;
    int path_ = -1;
    Rounds rounds_;
    Vec3 first_, lap_way_;
    Transform from_first_, lap_;
    std::vector<Drive> drives_;
    std::vector<JointIndex> joints_, places_;
};

}  // namespace

MovementPtr make_posed_creature(const MotionContext& context, const PosedSpec& spec,
                                std::shared_ptr<const PoseSource> source) {
    return std::make_shared<PosedCreature>(context, spec, std::move(source));
}

}  // namespace puppetri::motion
