// SPDX-License-Identifier: MIT
// A performance: the pose of every actor and the place of every prop at any time. What exporters
// and pictures read. It is finished when a run is: nothing in it changes while it is asked, and
// times may be asked in any order.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/index.h"
#include "puppetri/base/time.h"
#include "puppetri/figure/character.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/movement.h"

namespace puppetri::stage {

using motion::ActorIndex;  // into actors()
using motion::PropIndex;   // into props()

// Which movement, when: a row of the score file. The movement ends at `end`; the token leaves the
// place at `left` (SimTime::never() when the run stopped before).
struct ScoreEntry {
    SimTime start, end, left;
    std::string place;  // full path, "a.with_ball.P4"
    std::string actor;  // of the cast, "ana"; empty for a prop's own movement
    motion::LimbSet limbs;
    std::string movement;  // "step"
    std::string prop;      // "ball", or empty
    std::string instance;  // path of the net instance, "a.with_ball"
};

// A marker: foot strikes, releases, catches, in order of time.
struct StageEvent {
    SimTime at;
    std::string name, actor, limb, prop;  // empty where it does not apply
};

enum class PropShape : std::uint8_t { kSphere, kBox, kCylinder, kFork };

struct ActorView {
    std::string name;
    const figure::Skeleton* skeleton = nullptr;  // lives as long as the performance
    const figure::Mesh* mesh = nullptr;
    figure::JointIndex hips = {};  // none where there are none; joint 0 is the root
    // Of a character: its skeleton has the names, axes and rest pose of its file.
    const figure::Character* character = nullptr;
};
struct PropView {
    std::string name;
    PropShape shape = PropShape::kSphere;
    Vec3 size_m;  // across, up, along; a sphere's diameter in all three
    const figure::Mesh* mesh = nullptr;
};

class Performance {
 public:
    virtual ~Performance() = default;

    virtual SimTime duration() const = 0;
    virtual std::span<const ActorView> actors() const = 0;
    virtual std::span<const PropView> props() const = 0;
    virtual std::span<const ScoreEntry> score() const = 0;
    virtual std::span<const StageEvent> events() const = 0;

    // Writes the actor's pose at `at`; `out` is resized once and then reused without allocation.
    // Safe from several threads with different `out`.
    virtual void pose(ActorIndex actor, SimTime at, figure::Pose& out) const = 0;
    virtual Transform world_from_prop(PropIndex prop, SimTime at) const = 0;
    // Who holds the prop: "ana.hands", "air", "floor".
    virtual std::string holder(PropIndex prop, SimTime at) const = 0;
    // The phase of an actor's limb, for tests and rules over phases.
    virtual motion::Phase phase(ActorIndex actor, motion::Limb limb, SimTime at) const = 0;
};

}  // namespace puppetri::stage
