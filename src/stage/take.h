// SPDX-License-Identifier: MIT
// What was taken: everything that decides poses and props, while the run adds to it and after it.
// Stage writes it, TakePerformance reads it.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actor_timeline.h"
#include "gaze_track.h"
#include "prop_timeline.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/prepare.h"
#include "puppetri/stage/cast.h"
#include "puppetri/stage/performance.h"
#include "puppetri/stage/stage.h"

namespace puppetri::stage {

// Where an actor's eyes go from `from` on, as its movements say.
struct GazeSpan {
    SimTime from = {};
    motion::Gaze gaze = {};
};

struct ActorTake {
    std::unique_ptr<figure::Figure> figure;  // movements refer to it
    ActorTimeline timeline;
    std::vector<GazeSpan> gazes;
    GazeTrack gaze_track;  // made after the take, when poses are asked for
};

struct Take {
    // What equations move: per prop its place, per actor its degrees of freedom, those of one joint
    // together.
    struct Joint {
        figure::JointIndex joint;
        figure::DofSet::Range range;
        std::vector<std::uint32_t> dofs, quantities;  // numbers within the range, and whose value
    };
    std::shared_ptr<const Quantities> quantities;
    std::vector<std::optional<std::array<std::uint32_t, 3>>> driven_props;
    std::vector<std::vector<Joint>> driven_joints;

    Cast cast;
    std::vector<ActorTake> actors;
    std::vector<PropTimeline> props;
    std::vector<ScoreEntry> score;
    std::vector<StageEvent> events;
    SimTime end = {};

    // Needs driven_props and driven_joints of the cast's sizes, and the actors' figures.
    void drive(const Play& play, std::shared_ptr<const Quantities> from);
    void move_driven_joints(ActorIndex actor, SimTime at, figure::Pose& pose) const;

    // Of the sphere that a prop flies as.
    double radius(PropIndex prop) const { return cast.props[prop.value].size_m.x / 2; }
    // How it is held at that instant or, where nobody holds it, how this actor would take it.
    motion::Grip grip(PropIndex prop, ActorIndex actor, SimTime at, bool before = false) const;

    // The pose of an actor, with its gaze once the track is made. `before`: just before the
    // instant.
    void pose(ActorIndex actor, SimTime at, figure::Pose& out, bool before = false) const;

    // The prop's place. Between hands it is read off the solved pose, so that palms and prop cannot
    // part.
    Transform world_from_prop(PropIndex prop, SimTime at, bool before = false) const;

    // The ball that the hands of this actor would hold: its centre, and the left hand's idea of its
    // rotation.
    Transform between_hands(ActorIndex actor, const motion::Grip& grip, SimTime at,
                            bool before = false) const;

    // The joint of one hand.
    Transform world_from_hand(ActorIndex actor, motion::Side side, SimTime at,
                              bool before = false) const;

    // Where the eyes of an actor go, if they follow something: false leaves the head to the
    // movement. Reads controls only, not poses.
    bool gaze_target(ActorIndex actor, SimTime at, Vec3& target_world) const;
};

}  // namespace puppetri::stage
