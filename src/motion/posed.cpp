// SPDX-License-Identifier: MIT
// A posing movement goes through controls wherever they can say what it means, so that it joins and
// is joined like all others: base controls (a living stand) are solved into a pose, the source's
// joints are set in it, and the handles are read off again. What handles cannot say, the overlay
// adds: the difference of each joint between that pose and what its handles are solved into.
#include "puppetri/motion/posed.h"

#include <algorithm>
#include <array>
#include <utility>

#include "arm_state.h"
#include "clip_root.h"
#include "foot_path.h"
#include "posed_creature.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/library.h"
#include "puppetri/motion/solve_controls.h"
#include "rounds.h"

namespace puppetri::motion {
namespace {

using figure::Dof;
using figure::DofSet;
using figure::Figure;
using figure::JointIndex;
using figure::Pose;

constexpr int kMostDofsOfJoint = 6;
// What rests at the end rests as it was just before: a step there is no movement any more.
constexpr double kBeforeEnd_s = 1e-9;
// Legs that joints pose are not the controls' before the source's joints are set: the base's feet
// must not draw the pelvis to them.
constexpr PelvisRule kPelvis = PelvisRule::kAsWanted;
// A contact so near to the end of a round goes on in the next.
constexpr double kSeam_s = 1e-6;

// Reused by every posing movement of a thread; results never depend on what it holds.
struct Scratch {
    Pose own, solved, joining;
    std::vector<double> dofs;
    std::vector<Quat> joints;
    std::vector<Vec3> paths;
};
Scratch& scratch() {
    static thread_local Scratch s;
    return s;
}

// A foot that stands in [begin, end] although the source moves it: it is drawn to one place, and
// the way there fades before and after.
struct Lock {
    std::size_t side = 0;
    double begin_s = 0, end_s = 0;
    LegControl place;
    InertialLeg before, after;  // time runs backwards in `before`

    void apply(double t_s, LegControl& leg) const {
        if (t_s < begin_s) {
            before.apply(begin_s - t_s, leg);
        } else if (t_s > end_s) {
            after.apply(t_s - end_s, leg);
        } else {
            leg = place;
        }
    }
};

class Posed final : public Movement {
 public:
    Posed(const MotionContext& found, const PosedSpec& spec,
          std::shared_ptr<const PoseSource> source)
        : figure_(found.figure), spec_(spec), source_(std::move(source)) {
        const MotionContext context = arms_in_chest_space(found);
        start_ = context.now;
        limbs = limbs_of(figure_, spec);
        duration = duration_of(context, spec.duration_s);
        rounds_ = Rounds(spec, duration);
        // What the source leaves out of an arm's joints is as it hangs. On its way there the joint
        // would take the others of its DOFs through any values.
        base_ = make_idle(context, {.limbs = limbs,
                                    .duration_s = spec.duration_s,
                                    .gets_up = spec.gets_up,
                                    .at_home = limbs_of(figure_, {.dofs = spec.dofs})});
        find_drives();
        const Transform pelvis{about_y(heading_of(start_.pelvis.rotation_world)),
                               start_.pelvis.position_world};
        world_from_start_ = {
            pelvis.rotation,
            {pelvis.translation.x, floor_under(figure_, context), pelvis.translation.z}};
        find_lap();
        plan_contacts();
        join(context);
        tell_phases();
    }

    void sample(double t_s, Controls& out) const override {
        Controls c = start_;
        own(t_s, c, scratch());
        offset(t_s, c);
        copy_limbs(limbs, c, out);
    }

    void overlay(double t_s, LimbSet which, Pose& pose) const override {
        if (which.bits == 0) {
            return;
        }
        Scratch& s = scratch();
        Controls c = start_;
        own(t_s, c, s);
        solve_controls(figure_, c, s.solved, kPelvis);
        // Arms are exactly as they are said to be, whatever breath and trunk do to the collar bone;
        // a head may turn beyond that to what it looks at.
        const bool joining = t_s < blend_s_;
        if (joining) {
            offset(t_s, c);
            solve_controls(figure_, c, s.joining, kPelvis);
        }
        for (const auto& [limb, joint] : overlay_joints_) {
            if (!which.has(limb)) {
                continue;
            }
            const bool arm = is_arm(limb);
            const std::uint32_t j = joint.value;
            const auto of = [j](const Pose& p) { return p.parent_from_joint[j].rotation; };
            Quat& q = pose.parent_from_joint[j].rotation;
            const Quat other = !arm ? q : joining ? of(s.joining) : of(s.solved);
            q = figure::clamp_to_limit(figure_.limits[j],
                                       normalized(of(s.own) * conjugate(of(s.solved)) * other));
        }
        for (const DrivenPath& path : spec_.paths) {
            if (which.has(path.limb) && is_fixed(path)) {
                lead_exactly(index_of(side_of(path.limb)), c, pose);
            }
        }
    }

 private:
    static bool is_arm(Limb limb) { return limb == Limb::kLeftArm || limb == Limb::kRightArm; }
    static Side side_of(Limb arm) { return arm == Limb::kLeftArm ? Side::kLeft : Side::kRight; }
    // The way of a hand that does not go along with the trunk.
    static bool is_fixed(const DrivenPath& path) {
        return is_arm(path.limb) && path.space != PathSpace::kChest;
    }

    // Where the chest is over those hips, whatever the joints of the trunk do.
    Transform chest_over(Transform world_from_hips, const Pose& pose) const {
        for (const JointIndex joint : {figure_.spine, figure_.chest, figure_.upper_chest}) {
            world_from_hips = world_from_hips * pose.parent_from_joint[joint.value];
        }
        return world_from_hips;
    }

    // A hand that is fixed to the world, solved from the chest that the pose has: controls know how
    // far the trunk bends, and not how that is spread over its joints. Keeps the fingers.
    void lead_exactly(int side, const Controls& controls, Pose& pose) const {
        const auto i = static_cast<std::size_t>(side);
        Controls c = controls;
        ArmControl& arm = c.arms[i];
        const Transform hips =
            pose.parent_from_joint[figure_.root.value] * pose.parent_from_joint[figure_.hips.value];
        const Transform fixed = inverse(chest_over(hips, pose)) * arm.world_from_hand;
        const double w = clamp(arm.world_weight, 0, 1);
        arm.chest_from_hand = {slerp(arm.chest_from_hand.rotation, fixed.rotation, w),
                               lerp(arm.chest_from_hand.translation, fixed.translation, w)};
        arm.world_weight = 0;
        Pose& solved = scratch().joining;
        solve_controls(figure_, c, solved, kPelvis);
        const figure::Arm& joints = figure_.arms[i];
        for (const JointIndex joint : {joints.clavicle, joints.shoulder, joints.shoulder_twist,
                                       joints.elbow, joints.elbow_twist, joints.hand}) {
            pose.parent_from_joint[joint.value] = solved.parent_from_joint[joint.value];
        }
    }

    // The DOFs of one joint that the source drives.
    struct Drive {
        JointIndex joint;
        DofSet::Range range;
        std::array<std::int32_t, kMostDofsOfJoint> from{};  // number in the frame, -1: the base's
    };

    void find_drives() {
        dofs_ = figure_.dofs;
        for (std::size_t i = 0; i < spec_.dofs.size(); ++i) {
            const figure::DofIndex dof = dofs_.find(spec_.dofs[i]);
            PUP_REQUIRE(dof.valid());
            const JointIndex joint = dofs_.dofs[dof.value].joint;
            auto found = std::find_if(drives_.begin(), drives_.end(),
                                      [&](const Drive& d) { return d.joint == joint; });
            if (found == drives_.end()) {
                Drive drive{joint, dofs_.of_joint(joint), {}};
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
        for (int i = 0; i < kLimbCount; ++i) {
            const Limb limb = static_cast<Limb>(i);
            bool posed = false;
            for (const JointIndex joint : joints_of(figure_, limb)) {
                posed = posed ||
                        std::any_of(drives_.begin(), drives_.end(),
                                    [&](const Drive& d) { return d.joint == joint; }) ||
                        std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
            }
            if (posed) {
                posed_ = posed_.with(limb);
                // The hips are controls to the last bit.
                if (limb != Limb::kPelvis) {
                    overlays = overlays.with(limb);
                    for (const JointIndex joint : joints_of(figure_, limb)) {
                        overlay_joints_.emplace_back(limb, joint);
                    }
                }
            }
        }
        for (const DrivenPath& path : spec_.paths) {
            paths_ = paths_.with(path.limb);
            if (is_fixed(path)) {
                overlays = overlays.with(path.limb);
            }
        }
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const Limb leg = leg_of(side);
            joints_of_arm_[index_of(side)] = joints_of(figure_, arm_of(side));
            based_[index_of(side)] = limbs.has(leg) && !posed_.has(leg) && !paths_.has(leg);
            for (const PhaseSpan& span : base_->phases) {
                if (span.limb == leg && span.phase == Phase::kSupport) {
                    down_s_[index_of(side)] = span.begin.seconds();
                }
            }
        }
    }

    // Feet that the base keeps on the floor, once it has put them down.
    std::array<bool, 2> stands(double t_s) const {
        return {based_[0] && t_s >= down_s_[0], based_[1] && t_s >= down_s_[1]};
    }

    // How far a round takes it, in start space.
    void find_lap() {
        if (!spec_.loops || !spec_.travels) {
            return;
        }
        const auto place_at = [&](double source_s) {
            Scratch& s = scratch();
            const Transform at = frame_at(source_s, s).start_from_pelvis;
            return Transform{about_y(heading_of(at.rotation)),
                             {at.translation.x, 0, at.translation.z}};
        };
        const Transform first = place_at(0);
        lap_ = place_at(spec_.duration_s) * inverse(first);
    }
    Transform world_from_round(double round) const {
        return world_from_start_ * power(lap_, round);
    }

    PoseFrame frame_at(double source_s, Scratch& s) const {
        s.dofs.resize(spec_.dofs.size());
        s.joints.resize(spec_.joints.size());
        s.paths.resize(spec_.paths.size());
        PoseFrame frame{s.dofs, s.joints, s.paths, {}};
        source_->sample(source_s, frame);
        return frame;
    }

    // The movement's own controls and pose, without regard to what it found.
    void own(double t_s, Controls& c, Scratch& s) const {
        base_->sample(t_s, c);
        const Rounds::At at = rounds_.at(t_s, kBeforeEnd_s);
        PoseFrame frame = frame_at(at.source_s, s);
        if (spec_.travels) {
            const Transform pelvis = world_from_round(at.round) * frame.start_from_pelvis;
            c.pelvis = {pelvis.translation, pelvis.rotation};
        }
        solve_controls(figure_, c, s.own, kPelvis);
        pose_joints(frame, s.own);
        controls_from_pose(figure_, s.own, posed_, c);
        follow_paths(frame, c, s.own);
        // Locks are those of the first round.
        const Transform now_from_first =
            at.round > 0 ? world_from_round(at.round) * inverse(world_from_start_) : Transform{};
        for (const Lock& lock : locks_) {
            LegControl leg = carried(inverse(now_from_first), c.legs[lock.side]);
            lock.apply(at.source_s, leg);
            c.legs[lock.side] = carried(now_from_first, leg);
        }
    }

    static LegControl carried(const Transform& by, LegControl leg) {
        leg.ankle_world = by * leg.ankle_world;
        leg.foot_rotation_world = normalized(by.rotation * leg.foot_rotation_world);
        return leg;
    }

    void pose_joints(const PoseFrame& frame, Pose& pose) const {
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            pose.parent_from_joint[joints_[i].value].rotation =
                figure::clamp_to_limit(figure_.limits[joints_[i].value], frame.joints[i]);
        }
        for (const Drive& drive : drives_) {
            const std::span<const Dof> dofs(dofs_.dofs.data() + drive.range.first,
                                            drive.range.count);
            Transform& joint = pose.parent_from_joint[drive.joint.value];
            const Transform& rest =
                figure_.skeleton.joints[drive.joint.value].parent_from_joint_rest;
            std::array<double, kMostDofsOfJoint> values{};
            const bool hips = drive.joint == figure_.hips;
            const std::span<double> used(values.data(), dofs.size());
            figure::values_of(dofs, rest, {joint.rotation, rest.translation}, used);
            for (std::size_t k = 0; k < dofs.size(); ++k) {
                if (drive.from[k] >= 0 &&
                    std::isfinite(frame.dofs[static_cast<std::size_t>(drive.from[k])])) {
                    used[k] = clamp(frame.dofs[static_cast<std::size_t>(drive.from[k])], dofs[k].lo,
                                    dofs[k].hi);
                }
            }
            const Quat turned = figure::transform_of(dofs, rest, used).rotation;
            joint.rotation =
                hips ? turned : figure::clamp_to_limit(figure_.limits[drive.joint.value], turned);
        }
    }

    void follow_paths(const PoseFrame& frame, Controls& c, Pose& pose) const {
        for (std::size_t i = 0; i < spec_.paths.size(); ++i) {
            const DrivenPath& path = spec_.paths[i];
            const Vec3 at = frame.paths[i];
            if (path.limb == Limb::kPelvis) {
                const Vec3 way =
                    path.space == PathSpace::kWorld ? at : rotate(world_from_start_.rotation, at);
                c.pelvis.position_world = c.pelvis.position_world + way;
            } else if (path.limb == Limb::kLeftLeg || path.limb == Limb::kRightLeg) {
                const std::size_t side = path.limb == Limb::kLeftLeg ? 0 : 1;
                const Vec3 sole = path.space == PathSpace::kWorld ? at : world_from_start_ * at;
                LegControl& leg = c.legs[side];
                leg.ankle_world =
                    sole + rotate(leg.foot_rotation_world, {0, figure_.ankle_height_m, 0});
            }
        }
        for (std::size_t i = 0; i < spec_.paths.size(); ++i) {
            const DrivenPath& path = spec_.paths[i];
            if (path.limb == Limb::kLeftArm || path.limb == Limb::kRightArm) {
                lead_hand(path, frame.paths[i], c, pose);
            }
        }
    }

    // The wrist goes there, the hand stays in line with the forearm; joints of the arm that the
    // source drives beside the path keep what it says.
    void lead_hand(const DrivenPath& path, Vec3 at, Controls& c, Pose& pose) const {
        const Side side = path.limb == Limb::kLeftArm ? Side::kLeft : Side::kRight;
        ArmControl& arm = c.arms[index_of(side)];
        const figure::Arm& joints = figure_.arms[index_of(side)];
        const Transform world_from_chest_now =
            chest_over({c.pelvis.rotation_world, c.pelvis.position_world}, pose);
        const bool fixed = path.space != PathSpace::kChest;
        const Vec3 world = path.space == PathSpace::kWorld ? at : world_from_start_ * at;
        const Vec3 chest = fixed ? inverse(world_from_chest_now) * world : at;
        const Quat wrist =
            posed_.has(path.limb) ? pose.parent_from_joint[joints.hand.value].rotation : Quat{};
        arm.chest_from_hand.translation = chest;
        arm.world_weight = 0;
        Pose& solved = scratch().solved;
        solve_controls(figure_, c, solved, kPelvis);
        solved.parent_from_joint[joints.hand.value].rotation = wrist;
        controls_from_pose(figure_, solved, limb_set(path.limb), c);
        if (fixed) {  // whatever the trunk of somebody else's movement does
            arm.world_from_hand = {world_from_chest_now.rotation * arm.chest_from_hand.rotation,
                                   world};
            arm.world_weight = 1;
        }
        for (const JointIndex joint : joints_of_arm_[index_of(side)]) {
            pose.parent_from_joint[joint.value] = solved.parent_from_joint[joint.value];
        }
    }

    // Where a foot stands: where the source has it in the middle of the contact, flat on the floor.
    void plan_contacts() {
        std::vector<Lock> locks;
        for (std::size_t i = 0; i < spec_.contacts.size(); ++i) {
            const FootContact& contact = spec_.contacts[i];
            if (!posed_.has(leg_of(contact.side)) && !paths_.has(leg_of(contact.side))) {
                continue;
            }
            // A foot that stands through the end of a round stands where the next one has it.
            std::optional<LegControl> goes_on;
            for (std::size_t k = 0; spec_.loops && k < spec_.contacts.size(); ++k) {
                const FootContact& next = spec_.contacts[k];
                if (next.side == contact.side && next.begin_s <= kSeam_s &&
                    contact.end_s >= spec_.duration_s - kSeam_s && k != i) {
                    goes_on = carried(world_from_round(1) * inverse(world_from_start_),
                                      lock_of(next, k, {}).place);
                }
            }
            locks.push_back(lock_of(contact, i, goes_on));
        }
        locks_ = std::move(locks);
    }

    Lock lock_of(const FootContact& contact, std::size_t number,
                 const std::optional<LegControl>& place) const {
        constexpr double kMoment_s = 1e-4, kFade_s = 0.25;
        const std::size_t side = static_cast<std::size_t>(index_of(contact.side));
        const auto leg_at = [&](double source_s) {
            Controls c = start_;
            own(source_s / rounds_.pace(), c, scratch());
            return c.legs[side];
        };
        const auto rate_between_legs = [&](const LegControl& a, const LegControl& b) {
            Controls from = start_, to = start_;
            from.legs[side] = a;
            to.legs[side] = b;
            return rate_between(from, to, kMoment_s).legs[side];
        };
        Lock lock{side, contact.begin_s, contact.end_s, {}, {}, {}};
        lock.place = leg_at((contact.begin_s + contact.end_s) / 2);
        lock.place.foot_rotation_world = about_y(heading_of(lock.place.foot_rotation_world));
        lock.place.ankle_world.y = world_from_start_.translation.y + figure_.ankle_height_m;
        lock.place.toe_bend_rad = 0;
        lock.place = place.value_or(lock.place);
        // Half of the gap to the neighbouring contact of that foot.
        double before_s = std::fmin(kFade_s, contact.begin_s),
               after_s = std::fmin(kFade_s, spec_.duration_s - contact.end_s);
        for (std::size_t k = 0; k < spec_.contacts.size(); ++k) {
            const FootContact& other = spec_.contacts[k];
            if (k != number && other.side == contact.side) {
                if (other.begin_s >= contact.end_s) {
                    after_s = std::fmin(after_s, (other.begin_s - contact.end_s) / 2);
                }
                if (other.end_s <= contact.begin_s) {
                    before_s = std::fmin(before_s, (contact.begin_s - other.end_s) / 2);
                }
            }
        }
        const LegControl at_begin = leg_at(contact.begin_s), at_end = leg_at(contact.end_s);
        const LegControl earlier = leg_at(std::fmax(0, contact.begin_s - kMoment_s)),
                         later = leg_at(contact.end_s + kMoment_s);
        lock.before =
            InertialLeg(lock.place, {}, at_begin, rate_between_legs(at_begin, earlier), before_s);
        lock.after = InertialLeg(lock.place, {}, at_end, rate_between_legs(at_end, later), after_s);
        return lock;
    }

    void join(const MotionContext& context) {
        constexpr double kMoment = InertialFigure::kMoment_s;
        Controls first = start_, later = start_;
        own(0, first, scratch());
        own(kMoment, later, scratch());
        const ControlsRate rate = rate_between(first, later, kMoment);
        const double settle =
            spec_.reached_s > 0 ? spec_.reached_s / rounds_.pace() : spec_.settle_s;
        const double blend = std::fmin(settle, std::fmax(0.1, duration.seconds()));
        blend_s_ = blend;
        join_ = InertialFigure(context, first, later, blend);
        pelvis_ = {context.now.pelvis.position_world - first.pelvis.position_world,
                   context.rate.pelvis_velocity_world - rate.pelvis_velocity_world, blend};
        for (std::size_t i = 0; i < 2; ++i) {
            // The swivel is the figure's business.
            LegControl now = context.now.legs[i];
            ControlsRate::Leg now_rate = context.rate.legs[i];
            now.swivel_rad = first.legs[i].swivel_rad;
            now_rate.swivel_rad_s = rate.legs[i].swivel_rad_s;
            legs_[i] = InertialLeg(now, now_rate, first.legs[i], rate.legs[i], blend);
        }
        reach_ = KeepReach(figure_, stands(0), context.now);
    }

    void offset(double t_s, Controls& c) const {
        join_.apply(t_s, c);
        c.pelvis.position_world = c.pelvis.position_world + pelvis_.at(t_s);
        for (std::size_t i = 0; i < 2; ++i) {
            if (!based_[i]) {
                legs_[i].apply(t_s, c.legs[i]);
            }
        }
        if (limbs.has(Limb::kPelvis)) {
            reach_.apply(stands(t_s), t_s, c);
        }
    }

    void tell_phases() {
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const Limb leg = leg_of(side);
            if (!limbs.has(leg)) {
                continue;
            }
            if (!posed_.has(leg) && !paths_.has(leg)) {
                for (const PhaseSpan& span : base_->phases) {
                    if (span.limb == leg) {
                        phases.push_back(span);
                    }
                }
                continue;
            }
            SimTime until;
            for (const auto& [begin, end] : contacts_of(side)) {
                if (begin > until) {
                    phases.push_back({leg, Phase::kSwing, until, begin});
                    events.push_back({begin, "foot_strike", leg});
                }
                phases.push_back({leg, Phase::kSupport, begin, end});
                until = std::max(until, end);
            }
            if (until < duration) {
                phases.push_back({leg, Phase::kSwing, until, duration});
            }
        }
        rounds_.tell_events(spec_, events);
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
    }

    // Of all rounds, in order; those that meet are one.
    std::vector<std::pair<SimTime, SimTime>> contacts_of(Side side) const {
        std::vector<FootContact> own;
        for (const FootContact& c : spec_.contacts) {
            if (c.side == side) {
                own.push_back(c);
            }
        }
        std::sort(own.begin(), own.end(),
                  [](const FootContact& a, const FootContact& b) { return a.begin_s < b.begin_s; });
        std::vector<std::pair<SimTime, SimTime>> all;
        for (int round = 0; round < rounds_.told(); ++round) {
            for (const FootContact& c : own) {
                const SimTime begin = rounds_.time_of(c.begin_s, round),
                              end = rounds_.time_of(c.end_s, round);
                if (!all.empty() && begin <= all.back().second + to_time(kSeam_s)) {
                    all.back().second = std::max(all.back().second, end);
                } else {
                    all.emplace_back(begin, end);
                }
            }
        }
        return all;
    }

    const Figure& figure_;
    PosedSpec spec_;
    std::shared_ptr<const PoseSource> source_;
    MovementPtr base_;
    Rounds rounds_;
    Transform lap_;       // by which a round takes it, in start space
    double blend_s_ = 0;  // over which the state that was found fades
    Controls start_;
    Transform world_from_start_;
    DofSet dofs_;
    std::vector<Drive> drives_;
    std::vector<JointIndex> joints_;
    std::vector<std::pair<Limb, JointIndex>> overlay_joints_;
    std::array<std::vector<JointIndex>, 2> joints_of_arm_;
    LimbSet posed_, paths_;  // by joints, by paths
    std::vector<Lock> locks_;
    std::array<bool, 2> based_{};  // feet that are the base's
    std::array<double, 2> down_s_{};
    InertialFigure join_;
    InertialOffset3 pelvis_;
    std::array<InertialLeg, 2> legs_;
    KeepReach reach_;
};

}  // namespace

std::optional<Limb> limb_of_joint(const Figure& figure, std::string_view name) {
    const JointIndex joint = figure.skeleton.find(name);
    for (int i = 0; joint.valid() && i < kLimbCount; ++i) {
        const auto list = joints_of(figure, static_cast<Limb>(i));
        if (std::find(list.begin(), list.end(), joint) != list.end()) {
            return static_cast<Limb>(i);
        }
    }
    return std::nullopt;
}

LimbSet limbs_of(const Figure& figure, const PosedSpec& spec) {
    LimbSet limbs;
    if (!figure.humanoid()) {
        return limb_set(Limb::kBody);
    }
    const auto add = [&](std::string_view joint) {
        if (const auto limb = limb_of_joint(figure, joint)) {
            limbs = limbs.with(*limb);
        }
    };
    for (const std::string& dof : spec.dofs) {
        add(figure::humanoid_joint(std::string_view(dof).substr(0, dof.find('.'))));
    }
    for (const std::string& joint : spec.joints) {
        add(joint);
    }
    for (const DrivenPath& path : spec.paths) {
        limbs = limbs.with(path.limb);
    }
    limbs = both(limbs, spec.also);
    return limbs.has(Limb::kPelvis) || spec.travels ? both(limbs, kLowerBody) : limbs;
}

MovementPtr make_posed(const MotionContext& context, const PosedSpec& spec,
                       std::shared_ptr<const PoseSource> source) {
    if (!context.figure.humanoid()) {
        return make_posed_creature(context, spec, std::move(source));
    }
    return std::make_shared<Posed>(context, spec, std::move(source));
}

Diagnostics check_posed(const DofSet& dofs, const PosedSpec& spec, const PoseSource& source) {
    constexpr double kRate_hz = 240;
    Diagnostics list;
    std::vector<const Dof*> driven;
    for (const std::string& name : spec.dofs) {
        const figure::DofIndex dof = dofs.find(name);
        driven.push_back(dof.valid() ? &dofs.dofs[dof.value] : nullptr);
    }
    std::vector<double> values(spec.dofs.size());
    std::vector<Quat> joints(spec.joints.size());
    std::vector<Vec3> paths(spec.paths.size());
    std::vector<bool> told(spec.dofs.size());
    PoseFrame frame{values, joints, paths, {}};
    const auto element = [&](const std::string& what, double t_s) {
        return "movement " + spec.name + ", " + what + " at " + told_seconds(t_s);
    };
    const auto no_number = [&](const std::string& what, double t_s) {
        list.push_back({Severity::kError,
                        "not-a-number",
                        {},
                        element(what, t_s),
                        "it has no value there",
                        "look at divisions, roots and logarithms in its formula"});
    };
    const int count = static_cast<int>(clamp(std::ceil(spec.duration_s * kRate_hz), 1, 1e5));
    for (int k = 0; k <= count; ++k) {
        const double t = spec.duration_s * k / count;
        source.sample(t, frame);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(values[i] - values[i] == 0)) {
                no_number(spec.dofs[i], t);
                return list;
            }
            if (driven[i] == nullptr || told[i]) {
                continue;
            }
            const Dof& dof = *driven[i];
            const double over = std::fmax(values[i] - dof.hi, dof.lo - values[i]);
            if (over > 1e-6) {
                told[i] = true;
                const double shown = dof.kind == figure::DofKind::kTurn ? 180 / kPi : 100;
                const char* unit = dof.kind == figure::DofKind::kTurn ? " deg" : " cm";
                const auto whole = [&](double x) {
                    return std::to_string(static_cast<long long>(std::nearbyint(x * shown)));
                };
                list.push_back({Severity::kWarning,
                                "out-of-range",
                                {},
                                element(dof.name, t),
                                "it would be " + whole(values[i]) + unit +
                                    ", and the joint goes from " + whole(dof.lo) + " to " +
                                    whole(dof.hi) + unit,
                                "keep it within the range; it is stopped there"});
            }
        }
        for (std::size_t i = 0; i < paths.size(); ++i) {
            if (!(length(paths[i]) - length(paths[i]) == 0)) {
                no_number(std::string(name_of(spec.paths[i].limb)) + ".position", t);
                return list;
            }
        }
    }
    return list;
}

}  // namespace puppetri::motion
