// SPDX-License-Identifier: MIT
// The run of a witness, firing by firing, with the stage.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/net/chooser.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/beside.h"
#include "puppetri/scene/scene.h"
#include "puppetri/stage/stage.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::verdict {

class ScriptPlayer {
 public:
    ScriptPlayer(const scene::Scene& scene, const Witness& witness);
    ScriptPlayer(const ScriptPlayer&) = delete;
    ScriptPlayer& operator=(const ScriptPlayer&) = delete;
    // The next firing of the witness; false: it is over.
    bool step();
    // One more firing after it, as chance has it. False: nothing fires any more.
    bool step_on() {
        return player_.step({.until = player_.now() + kPatience}) == run::Stop::kNone;
    }
    const run::Player& player() const { return player_; }

 private:
    static constexpr SimTime kPatience{600 * kTicksPerSecond};
    const Witness& witness_;
    scene::Beside beside_;
    stage::Stage stage_;
    net::ScriptedChooser chooser_;
    run::Player player_;
};

// A siphon among the empty places that had tokens at first, with no smaller one in it: a set of
// places that can never get a token again (ordinary nets). Empty: there is none.
std::vector<std::uint32_t> empty_siphon(const proof::PlainNet& net, const proof::Marking& marking);

}  // namespace puppetri::verdict
