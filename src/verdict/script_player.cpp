// SPDX-License-Identifier: MIT
#include "script_player.h"

#include <algorithm>
#include <utility>

#include "puppetri/proof/siphons.h"
#include "puppetri/proof/supervisor.h"

namespace puppetri::verdict {

ScriptPlayer::ScriptPlayer(const scene::Scene& scene, const Witness& witness)
    : witness_(witness),
      beside_(scene),
      stage_(scene.play, beside_.quantities()),
      chooser_(witness.choices),
      player_(scene.net, {.seed = witness.seed,
                          .host = &stage_,
                          .chooser = &chooser_,
                          .beat = scene.beat,
                          .coupled = beside_.coupled(stage_)}) {
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
    proof::PlaceSet siphon = proof::siphon_of_deadlock(net, marking);
    // As small as leaving places out one by one makes it, among those that had tokens at first.
    const auto marked = [&](const proof::PlaceSet& places) {
        return std::any_of(places.begin(), places.end(),
                           [&](std::uint32_t p) { return net.initial[p] > 0; });
    };
    for (std::size_t i = 0; i < siphon.size();) {
        proof::PlaceSet rest = siphon;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        rest = proof::greatest_siphon_within(net, rest);
        if (!rest.empty() && marked(rest)) {
            siphon = std::move(rest);
            i = 0;
        } else {
            ++i;
        }
    }
    return {siphon.begin(), siphon.end()};
}

}  // namespace puppetri::verdict
