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
    // Whether the step has reached the state of this string.
    bool is_at(const Driver::Step& step, std::span<const std::uint8_t> state);

 protected:
    void enter(std::uint32_t state) override;
    bool encode(Driver& driver, const Driver::Step& step, std::vector<std::uint8_t>& out) override;
    std::pair<std::int64_t, std::int64_t> ticks(const Driver::Step& step) override;
    bool coincidental(Driver& driver) override;
    // A reached class, before it is kept; may be changed. False: it is not wanted.
    virtual bool keep(Driver& driver, const Driver::Step& step, Zone& zone) {
        (void)driver, (void)step, (void)zone;
        return true;
    }

    // Set by keep(): such states are told from others by a last byte.
    bool mark_ = false;
    static constexpr std::uint8_t kMark = 0xFE;  // no string without it ends like this

    const bool observed_;
    Zone zone_;  // of the state that is expanded: variable k waits under the number k

 private:
    bool choose(Driver& driver, std::vector<std::int64_t>& over);
    void check(const GraphRequest& request);
    Zone passed_;  // that of zone_ after the pass that was chosen
    std::int64_t low_ = 0, high_ = 0;
    Track track_;
    TimedGraph::States* states_ = nullptr;
    std::vector<Waiting> waiting_;
    std::vector<std::uint8_t> drawn_;  // per place, then per transition: from a distribution
};

}  // namespace puppetri::proof
