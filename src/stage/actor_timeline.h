// SPDX-License-Identifier: MIT
// Who moves which limb of one actor, from when on. Movements start from the state they find, so
// that putting a new one in charge is all there is to a join.
#pragma once
#include <array>
#include <vector>

#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::stage {

// `movement` drives the limb from `from` on; it began at `start`.
struct Charge {
    SimTime from = {}, start = {};
    motion::MovementPtr movement = {};
    std::uint32_t owner = ~0u;  // number of the activity; none for what the stage starts by itself
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

    motion::Phase phase(motion::Limb limb, SimTime at) const;

    const std::vector<Charge>& charges(motion::Limb limb) const {
        return charges_[static_cast<std::size_t>(limb)];
    }

 private:
    std::array<std::vector<Charge>, motion::kLimbCount> charges_;
};

}  // namespace puppetri::stage
