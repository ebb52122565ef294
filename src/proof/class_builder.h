// SPDX-License-Identifier: MIT
// State classes as a TimedBuilder: a string is the marking with the numbers of its variables, then
// the zone of the times that are left.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "puppetri/proof/state_classes.h"
#include "timed_builder.h"
#include "zone.h"

namespace puppetri::proof {

class ClassBuilder : public TimedBuilder {
 public:
    // `observed`: one more variable, the last: minus the time since the start.
    ClassBuilder(const GraphRequest& request, bool observed);
    TimedGraph make();

    // For those who follow a path: see class_script.
    struct Track {
        Zone zone;                          // of the state that was reached
        std::vector<std::int64_t> numbers;  // variable - 1 -> number in the engine that reached it
    };
    const Track& track() const { return track_; }
    Driver& driver() { return *driver_; }
    // Goes along in somebody else's graph, which need not be changed.
    void follow(const TimedGraph& graph);
    void stand_in(std::uint32_t state) { enter(state); }
    // The string of what the step has reached; false: no time allows it.
    bool string_of(const Driver::Step& step, std::vector<std::uint8_t>& out) {
        return encode(*driver_, step, out);
    }

 protected:
    void enter(std::uint32_t state) override;
    bool encode(Driver& driver, const Driver::Step& step, std::vector<std::uint8_t>& out) override;
    std::pair<std::int64_t, std::int64_t> ticks(const Driver::Step& step) override;
    bool coincidental(Driver& driver) override;
    // A reached class, before it is kept. False: it is not wanted.
    virtual bool keep(Driver& driver, const Zone& zone) {
        (void)driver, (void)zone;
        return true;
    }

    const bool observed_;

 private:
    bool choose(Driver& driver, std::vector<std::int64_t>& over);
    void check(const GraphRequest& request);
    Zone zone_;    // of the state that is expanded: variable k waits under the number k
    Zone passed_;  // the same after the pass that was chosen
    std::int64_t low_ = 0, high_ = 0;
    Track track_;
    TimedGraph::States* states_ = nullptr;
    std::vector<Waiting> waiting_;
    std::vector<std::uint8_t> drawn_;  // per place, then per transition: from a distribution
};

}  // namespace puppetri::proof
