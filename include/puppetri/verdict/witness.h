// SPDX-License-Identifier: MIT
// A witness: a run that shows what a verdict says. Not a picture of a run but its recipe, the
// answer to every choice, so that the player plays it again, the stage performs it, and it exports
// and renders like any other run.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/base/time.h"

namespace puppetri::verdict {

struct Witness {
    std::string rule;            // whose verdict it belongs to
    std::string says;            // in one sentence, what it shows
    std::uint64_t net_hash = 0;  // net::Net::hash() of the net that it was found on
    std::uint64_t seed = 1;
    std::vector<std::int64_t> choices;  // answers for net::ScriptedChooser
    struct Event {
        SimTime at;
        std::string path;
        bool operator==(const Event&) const = default;
    };
    std::vector<Event> events;  // what the outside makes happen

    // For people and for checking that it was the same run: who fires, when.
    struct Step {
        SimTime at;
        std::string transition;
        bool operator==(const Step&) const = default;
    };
    std::vector<Step> steps;
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    // After so many firings what is shown is there (0: at the start). kNone: nothing but the lasso.
    std::uint32_t violates_after = kNone;
    // After so many firings the run is where it is again at the end, and goes round for ever.
    // kNone: it does not.
    std::uint32_t lasso_from = kNone;
    // When the last thing that matters happens: a run of the witness is played up to here at least.
    SimTime until;

    bool operator==(const Witness&) const = default;
};

}  // namespace puppetri::verdict
