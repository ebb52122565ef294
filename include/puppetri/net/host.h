// SPDX-License-Identifier: MIT
// The way out of the net: what an action place asks of whoever performs movements. The net knows an
// action by an opaque index and never what a joint is; the stage implements this and never sees the
// marking.
#pragma once
#include <cstdint>
#include <span>

#include "puppetri/base/index.h"
#include "puppetri/base/time.h"

namespace puppetri::net {

using ActionIndex =
    Index<struct ActionTag>;  // a bound movement of the scene: "a's step with these arguments"
using EventIndex = Index<struct EventTag>;  // a named event of the net

// One performance of an action: from the token's arrival until it leaves. Numbered 0, 1, 2, ... in
// order of arrival.
using ActivityIndex = Index<struct ActivityTag>;

// An occurrence that the movement will raise by itself (a foot strike, a release).
struct RaisedEvent {
    SimTime at;  // absolute, not before the start
    EventIndex event;
};

class MovementHost {
 public:
    virtual ~MovementHost() = default;

    // A token arrived in an action place. `duration` is the place's own (fixed by the net), or
    // negative for `takes auto`: then the host decides; `attributes` are the token's values, in the
    // order of the place's declaration. Gives   how long the movement takes (>= 0); its own
    // duration where the net gave one may differ from it: the
    //         movement is then fitted to the net's. A negative answer says "I cannot": the run
    //         stops and names the place.
    virtual SimTime begin(ActionIndex action, ActivityIndex activity, SimTime at, SimTime duration,
                          std::span<const std::int64_t> attributes) = 0;

    // The events of an activity that has just begun, in order of time. The span lives until the
    // next call.
    virtual std::span<const RaisedEvent> raised(ActivityIndex activity) = 0;

    // A `now` arc took the token before it was ready: the movement ends here, at its pose.
    virtual void cut(ActivityIndex activity, SimTime at) = 0;

    // The token left its place (also after cut).
    virtual void left(ActivityIndex activity, SimTime at) = 0;
};

}  // namespace puppetri::net
