// SPDX-License-Identifier: MIT
#include "script_player.h"

#include "puppetri/proof/supervisor.h"

namespace puppetri::verdict {

ScriptPlayer::ScriptPlayer(const scene::Scene& scene, const Witness& witness)
    : witness_(witness),
      stage_(scene.play),
      chooser_(witness.choices),
      player_(scene.net,
              {.seed = witness.seed, .host = &stage_, .chooser = &chooser_, .beat = scene.beat}) {
    std::vector<run::OutsideEvent> events;
    for (const Witness::Event& e : witness.events) {
        events.push_back({e.at, scene.net.find_event(e.path)});
    }
    player_.schedule(events);
}

bool ScriptPlayer::step() {
    return player_.firings() < witness_.steps.size() && player_.step() == run::Stop::kNone;
}

std::vector<std::uint32_t> empty_siphon(const proof::PlainNet& net, const proof::Marking& marking) {
    const proof::PlaceSet siphon = proof::siphon_of_deadlock(net, marking);
    return {siphon.begin(), siphon.end()};
}

}  // namespace puppetri::verdict
