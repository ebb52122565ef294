// SPDX-License-Identifier: MIT
// What goes on continuously beside a net and speaks to it through crossings: equations
// (run/equations.h), sensors on figures. The player asks, whenever an instant has settled, when the
// next crossing comes; a crossing is an occurrence of an event like those from outside, and firings
// act back. Guards never read what is continuous.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/time.h"
#include "puppetri/net/host.h"
#include "puppetri/net/indices.h"
#include "puppetri/net/measure.h"
#include "puppetri/net/state.h"

namespace puppetri::run {

// How a quantity went for some time.
struct CourseSum {
    double integral = 0;  // over the time, in seconds
    double most = 0, least = 0, last = 0;
};

// Roots are rounded up to whole milliseconds; what lies less than a microsecond above one counts as
// that one, so that the last digits of an integration do not delay a crossing that is meant there.
SimTime crossing_time(double root_s);

class Coupled {
 public:
    struct Crossings {
        SimTime at = SimTime::never();
        std::vector<net::EventIndex> events;  // in the order in which they occur
    };

    virtual ~Coupled() = default;

    // While an instant is played, in order.
    virtual void occurs(SimTime /*at*/, net::EventIndex /*event*/) {}
    virtual void fired(SimTime /*at*/, net::TransitionIndex /*transition*/) {}

    // The instant `state.now` has settled, up to the occurrences that are given here: when and what
    // crosses next, at `state.now` or later, not after `until`. Asked again without anything having
    // happened it answers the same.
    // Gives   false where it cannot go on; `fault` says why then.
    virtual bool next(const net::State& state, SimTime until, Crossings& out,
                      Diagnostic& fault) = 0;
    // What next() gave last is about to occur.
    virtual void deliver() = 0;
    // Whether it may ever cross anything, should nothing else happen.
    virtual bool may_cross() const = 0;

    // How a quantity of it went from `from` to `to`, which has been played.
    // Gives   false where it has none such, or it has no value there: `fault` says why then.
    virtual bool measure(const net::CourseQuantity& /*quantity*/, SimTime /*from*/, SimTime /*to*/,
                         CourseSum& /*out*/, Diagnostic& /*fault*/) {
        return false;
    }

    // All that decides its future; what the state of the net says is not in it.
    virtual void save(std::vector<std::uint8_t>& out) const = 0;
    // False: these are no bytes of it, and it is as before.
    virtual bool restore(std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace puppetri::run
