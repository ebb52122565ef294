// SPDX-License-Identifier: MIT
#include "take.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::stage {
namespace {

// The transform of one joint in the world: the product along its ancestors.
Transform world_from_joint(const figure::Skeleton& skeleton, const figure::Pose& pose,
                           figure::JointIndex joint) {
    Transform t = pose.parent_from_joint[joint.value];
    for (figure::JointIndex p = skeleton.joints[joint.value].parent; p.valid();
         p = skeleton.joints[p.value].parent) {
        t = pose.parent_from_joint[p.value] * t;
    }
    return t;
}

}  // namespace

void Take::pose(ActorIndex actor, SimTime at, figure::Pose& out, bool before) const {
    const ActorTake& a = actors[actor.value];
    motion::Controls controls;
    a.timeline.sample(at, controls, before);
    if (!a.gaze_track.empty()) {
        controls.body.chest_from_head =
            normalized(from_rotation_vector(a.gaze_track.at(at)) * controls.body.chest_from_head);
    }
    motion::solve_controls(*a.figure, controls, out);
    a.timeline.overlay(*a.figure, at, out, before);
    move_driven_joints(actor, at, out);
}

motion::Grip Take::grip(PropIndex prop, ActorIndex actor, SimTime at, bool before) const {
    const Hold& hold = props[prop.value].at(at, before);
    if (hold.kind == Holding::kHands) {
        return hold.grip;
    }
    const Prop& thing = cast.props[prop.value];
    if (thing.shape == PropShape::kSphere || !actors[actor.value].figure->humanoid()) {
        return motion::ball_grip(radius(prop));
    }
    motion::Controls controls;
    actors[actor.value].timeline.sample(at, controls, before);
    const double lies = hold.kind == Holding::kFloor ? heading_of(hold.lies.rotation) : 0;
    motion::Grip grip =
        motion::box_grip(thing.size_m, heading_of(controls.pelvis.rotation_world) - lies);
    grip.yaw_rad += lies;
    return grip;
}

Transform Take::between_hands(ActorIndex actor, const motion::Grip& grip, SimTime at,
                              bool before) const {
    static thread_local figure::Pose
        pose_of_holder;  // scratch: results never depend on what it holds
    pose(actor, at, pose_of_holder, before);
    const figure::Figure& f = *actors[actor.value].figure;
    return motion::ball_between(
        f, world_from_joint(f.skeleton, pose_of_holder, f.arms[figure::kLeft].hand),
        world_from_joint(f.skeleton, pose_of_holder, f.arms[figure::kRight].hand), grip);
}

Transform Take::world_from_hand(ActorIndex actor, motion::Side side, SimTime at,
                                bool before) const {
    static thread_local figure::Pose pose_of_holder;  // scratch, as above
    pose(actor, at, pose_of_holder, before);
    const figure::Figure& f = *actors[actor.value].figure;
    return world_from_joint(f.skeleton, pose_of_holder, f.arms[motion::index_of(side)].hand);
}

Transform Take::world_from_prop(PropIndex prop, SimTime at, bool before) const {
    const Hold& hold = props[prop.value].at(at, before);
    const auto& driven = driven_props[prop.value];
    if (driven && hold.kind == Holding::kFloor) {
        const SimTime t = std::max(at, SimTime{0});
        return {{},
                {quantities->at((*driven)[0], t), quantities->at((*driven)[1], t),
                 quantities->at((*driven)[2], t)}};
    }
    switch (hold.kind) {
        case Holding::kHands: {
            Transform t = between_hands(hold.actor, hold.grip, at, before);
            t.rotation = normalized(t.rotation * hold.hands_from_prop);
            return t;
        }
        case Holding::kOneHand: {
            Transform t = world_from_hand(hold.actor, hold.hand, at, before) * hold.hand_from_prop;
            t.rotation = normalized(t.rotation);
            return t;
        }
        case Holding::kFlight:
            return {hold.flight.rotation(at), hold.flight.position(at)};
        case Holding::kFloor:
            break;
    }
    return hold.lies;
}

bool Take::gaze_target(ActorIndex actor, SimTime at, Vec3& target_world) const {
    const auto& spans = actors[actor.value].gazes;
    const auto after = std::upper_bound(spans.begin(), spans.end(), at,
                                        [](SimTime t, const GazeSpan& s) { return t < s.from; });
    motion::Gaze gaze = after == spans.begin() ? motion::Gaze{} : (after - 1)->gaze;
    if (gaze.kind ==
        motion::GazeKind::kOwn) {  // nothing better to look at than a ball on its way from or to me
        for (std::uint32_t i = 0; i < props.size(); ++i) {
            const Hold& hold = props[i].at(at);
            if (hold.kind == Holding::kFlight && (hold.actor == actor || hold.target == actor) &&
                at <= hold.flight.start + hold.flight.duration) {
                gaze = {.kind = motion::GazeKind::kProp, .prop = PropIndex{i}};
            }
        }
    }
    switch (gaze.kind) {
        case motion::GazeKind::kOwn:
            return false;
        case motion::GazeKind::kPoint:
            target_world = gaze.point_world;
            return true;
        case motion::GazeKind::kActor: {
            const ActorTake& other = actors[gaze.actor.value];
            motion::Controls controls;
            other.timeline.sample(at, controls);
            target_world =
                controls.pelvis.position_world + Vec3{0, 0.4 * other.figure->height_m, 0};
            return true;
        }
        case motion::GazeKind::kProp:
            break;
    }
    const Hold& hold = props[gaze.prop.value].at(at);
    const bool one_hand = hold.kind == Holding::kOneHand;
    if ((hold.kind == Holding::kHands || one_hand) && hold.actor == actor) {
        return false;  // nobody stares at what it has in its own hands
    }
    if (one_hand) {
        const ActorTake& holder = actors[hold.actor.value];
        motion::Controls controls;
        holder.timeline.sample(at, controls);
        target_world = motion::world_from_palm(*holder.figure, controls, hold.hand).translation;
    } else if (hold.kind == Holding::kHands) {
        const ActorTake& holder = actors[hold.actor.value];
        motion::Controls controls;
        holder.timeline.sample(at, controls);
        target_world =
            (motion::world_from_palm(*holder.figure, controls, motion::Side::kLeft).translation +
             motion::world_from_palm(*holder.figure, controls, motion::Side::kRight).translation) *
            0.5;
    } else if (hold.kind == Holding::kFlight) {
        target_world = hold.flight.position(at);
    } else {
        target_world = world_from_prop(gaze.prop, at).translation;
    }
    return true;
}

}  // namespace puppetri::stage
