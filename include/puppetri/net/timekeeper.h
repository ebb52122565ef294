// SPDX-License-Identifier: MIT
// Who keeps the clocks instead of the engine: provers that abstract from exact time (readiness,
// state classes). The engine then never lets time pass by itself; whatever lasts waits under a
// number until Engine::pass says that it is over. Firing, priorities, data and events stay the
// engine's, so that an abstraction of time is no second semantics.
#pragma once
#include <cstdint>

#include "puppetri/base/time.h"

namespace puppetri::net {

// A time above this and below never() is no time but the number of a wait, added to it.
inline constexpr std::int64_t kWaiting = std::int64_t{1} << 62;
inline constexpr bool is_wait(std::int64_t ticks) {
    return ticks > kWaiting && ticks != SimTime::never().ticks;
}

class Timekeeper {
 public:
    enum class Kind : std::uint8_t {
        kToken,     // in place `element`
        kDelay,     // of transition `element`
        kSchedule,  // of event `element`
    };

    virtual ~Timekeeper() = default;
    // Something begins that lasts from low to high ticks. Of `takes auto` the range is 0 .. never:
    // the keeper knows better.
    // Gives  0: it is over at once; else a number of its own, from 1 to 2^61. What `lasts as` its
    //        sibling, and what gets the time left of another, waits under the other's number
    //        without asking.
    virtual std::int64_t begin(Kind kind, std::uint32_t element, SimTime low, SimTime high) = 0;
};

}  // namespace puppetri::net
