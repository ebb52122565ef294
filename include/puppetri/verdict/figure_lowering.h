// SPDX-License-Identifier: MIT
// What can be said of figures before anything moves: statements about phases of limbs and holders
// of props, told as statements about places. Which leg a movement can lift is known from its call;
// when it does so only the stage knows. So a statement about figures becomes two about the net: one
// that holds whenever it may hold, one that holds only if it must.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/stage/stage.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

// Which legs a call can have in the swing phase, and whether both at once.
struct Swings {
    bool left = false, right = false, both = false;
};
// `calm`: its figure never runs (duty factor above 1/2 everywhere) and is never cut, so that each
// movement begins with both feet on the ground, or ends its own swing itself.
Swings swings_of(const motion::BoundCall& call, bool calm);

// The limbs that a call drives, arms left to another movement included.
motion::LimbSet driven_limbs(const motion::BoundCall& call);

// The prop that a call needs in the hands of its actor, or none. `fly` holds it in the air.
motion::PropIndex claimed_prop(const motion::BoundCall& call);

class Holders;  // src/verdict/holders.h

class FigureLowering final : public HostLowering {
 public:
    // Both outlive it. Actions of places are numbers in play.actions.
    FigureLowering(const net::Net& net, const stage::Play& play);
    ~FigureLowering() override;
    // Cost  2^n for n different host atoms in one formula; more than 8 are not looked into: such a
    //       formula may always hold and never must.
    Lowered lower(const net::Formula& formula) const override;
    std::vector<std::string> assumptions(const net::Rule& rule) const override;

 private:
    struct ActionPlace {
        std::uint32_t place = 0;
        const motion::BoundCall* call = nullptr;
    };
    net::Formula may_swing(std::uint32_t actor, bool left, bool right) const;

    const net::Net& net_;
    const stage::Play& play_;
    std::vector<ActionPlace> places_;
    std::vector<std::uint8_t> calm_;  // per actor
    std::unique_ptr<Holders> holders_;
};

// The rules that every scene has to keep, whatever it says: nobody drives a limb twice, nobody
// claims a prop that somebody else has. Paths "builtin.one_movement.ana.left_leg",
// "builtin.one_holder.ball".
std::vector<net::Rule> figure_rules(const net::Net& net, const stage::Play& play);

}  // namespace puppetri::verdict
