// SPDX-License-Identifier: MIT
// Who has one prop, from when on: hands, one hand, the air, or the floor (or what else it lies on).
// One holder at any time, by construction.
#pragma once
#include <vector>

#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/flight.h"
#include "puppetri/motion/grip.h"

namespace puppetri::stage {

enum class Holding : std::uint8_t { kHands, kOneHand, kFlight, kFloor };

struct Hold {
    SimTime from = {};
    Holding kind = Holding::kFloor;
    motion::ActorIndex actor = {};   // kHands, kOneHand; kFlight: who threw it, or none
    motion::ActorIndex target = {};  // kFlight: who shall catch it, or none
    Quat hands_from_prop =
        {};  // kHands: how it lies between the hands (its spin goes on from catch to catch)
    motion::Side hand = motion::Side::kRight;  // kOneHand
    Transform hand_from_prop = {};             // kOneHand
    motion::Grip grip = {};                    // kHands
    motion::Flight flight = {};                // kFlight
    Transform lies = {};                       // kFloor
};

class PropTimeline {
 public:
    // Needs `hold.from` not before any earlier one; at the same instant the later call wins.
    void take(const Hold& hold);
    const Hold& at(SimTime at, bool before = false) const;
    const std::vector<Hold>& holds() const { return holds_; }

 private:
    std::vector<Hold> holds_;
};

}  // namespace puppetri::stage
