// SPDX-License-Identifier: MIT
// Who moves which limb of one actor, from when on. Movements start from the state they find, so
// that putting a new one in charge is all there is to a join.
#pragma once
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "puppetri/motion/context.h"
#include "puppetri/motion/inertialize.h"
#include "puppetri/motion/movement.h"

namespace puppetri::stage {

// What joints of a limb did beyond controls when its movement changed, fading.
struct JointJoin {
    std::vector<std::pair<figure::JointIndex, motion::InertialJoint>> joints;
};

// `movement` drives the limb from `from` on; it began at `start`.
struct Charge {
    SimTime from = {}, start = {};
    motion::MovementPtr movement = {};
    std::uint32_t owner = ~0u;  // number of the activity; none for what the stage starts by itself
    std::shared_ptr<const JointJoin> join = {};  // only where a movement poses joints

    bool poses(motion::Limb limb) const { return movement->overlays.has(limb); }
};

class ActorTimeline {
 public:
    // Needs `from` not before any earlier one; at the same instant the later call wins.
    void take(motion::LimbSet limbs, const Charge& charge);

    // The charge of the limb at that instant; `before`: just before it. Needs a charge that reaches
    // that far back.
    const Charge& in_charge(motion::Limb limb, SimTime at, bool before = false) const;

    // Writes all limbs. Cost: O(log n) searches and one sample per distinct movement, no
    // allocation.
    void sample(SimTime at, motion::Controls& out, bool before = false) const;

    // Writes what joints do beyond the controls into the pose that these were solved into; all
    // within the limits of the figure, which is the actor's.
    void overlay(const figure::Figure& figure, SimTime at, figure::Pose& pose,
                 bool before = false) const;
    // Whether any movement ever poses joints: otherwise overlay changes nothing.
    bool has_overlays() const { return has_overlays_; }

    // Gives the limb's movement that began last a join. Needs a charge.
    void join(motion::Limb limb, std::shared_ptr<const JointJoin> join) {
        charges_[static_cast<std::size_t>(limb)].back().join = std::move(join);
    }

    motion::Phase phase(motion::Limb limb, SimTime at) const;

    const std::vector<Charge>& charges(motion::Limb limb) const {
        return charges_[static_cast<std::size_t>(limb)];
    }

 private:
    bool has_overlays_ = false;
    std::array<std::vector<Charge>, motion::kLimbCount> charges_;
};

}  // namespace puppetri::stage
