// SPDX-License-Identifier: MIT
// Runs watched for joins: whenever a firing begins a movement, which movement of the same limbs it
// follows, and how the figure goes from one to the other on the stage.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/motion/join.h"
#include "puppetri/net/chooser.h"
#include "puppetri/proof/successions.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/beside.h"
#include "puppetri/stage/stage.h"
#include "puppetri/verdict/pursue.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::verdict {

// The movements of all figures as activities on lanes. A lane is a set of limbs of one figure that
// the same calls can drive; whether a call leaves the arms to what they hold is not looked at.
struct MovementLanes {
    struct Lane {
        std::uint32_t actor = 0;
        motion::LimbSet limbs;
        std::vector<std::uint32_t> places;  // item i; item places.size(): at rest after a cut
    };
    std::vector<Lane> lanes;
    std::vector<std::uint32_t> items;  // per lane: places and the rest after a cut
    net::Rows<proof::Begin> begins;    // per transition
    std::vector<proof::Begin> initially;

    bool is_rest(const proof::Succession& s) const {
        return s.after == lanes[s.lane].places.size();
    }
};
MovementLanes movement_lanes(const net::Net& net, const stage::Play& play);

class JoinRun {
 public:
    // A net with actions of the theatre's scene: its whole net, or a part of it. All outlive it.
    JoinRun(const net::Net& net, const Theatre& theatre, const MovementLanes& lanes,
            net::Chooser& chooser, std::uint64_t seed, const std::vector<Witness::Event>& events);

    // A succession as it happened.
    struct Seen {
        proof::Succession succession;
        SimTime at;
        std::uint64_t firing = 0;  // the number of its firing, from 1
    };
    // The next firing. False: nothing fires any more (within ten minutes), or the run stopped.
    bool step();
    const std::vector<Seen>& seen() const { return seen_; }
    bool at_rest() const { return at_rest_; }
    const run::Player& player() const { return player_; }
    std::vector<Witness::Step> steps() const;

    // Plays on as far as the measure looks beyond a join at that instant.
    void look_beyond(SimTime at);
    // Needs  look_beyond.
    motion::JoinMeasures measure(const Seen& seen, const motion::JoinLimits& limits);
    // The joint of a fault of that figure.
    std::string joint_of(const proof::Succession& succession, const motion::JoinFault& fault) const;

 private:
    bool step(SimTime until);

    const net::Net& net_;
    const MovementLanes& lanes_;
    scene::Beside beside_;
    stage::Stage stage_;
    run::Player player_;
    std::vector<Seen> seen_;
    std::vector<std::vector<std::uint32_t>> last_;  // per lane what may have begun last
    struct Fired {
        SimTime at;
        net::TransitionIndex transition;
    };
    std::vector<Fired> fired_;
    bool at_rest_ = false, over_ = false;
};

}  // namespace puppetri::verdict
