// SPDX-License-Identifier: MIT
// From a driver to a graph: breadth first over strings of bytes, all answers from each. The three
// methods differ in the driver's clocks and in what their states carry besides (Extra).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "atom_reader.h"
#include "byte_store.h"
#include "driver.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/timed_graph.h"
#include "state_codec.h"

namespace puppetri::proof {

// The states of a graph and the way to more of them.
struct TimedGraph::States {
    States(World w, ClockForm f) : world(std::move(w)), form(f), codec(*world.net, f) {}
    World world;
    ClockForm form;
    StateCodec codec;
    ByteStore store;
    bool several_starts = false;      // state 0 is before all choices of the start
    std::optional<PlainGraph> plain;  // nets without time: the states are its markings
    bool observed = false;            // of classes: one more variable, the time since the start

    net::State decode(std::uint32_t state, std::uint32_t* outside = nullptr,
                      std::size_t* length = nullptr) const;
    // The state's string without what its maker adds.
    void encode(const Driver& driver, std::vector<std::uint8_t>& out,
                const std::unordered_map<std::int64_t, std::uint32_t>* variables = nullptr);
};

// The events and sensors that are free, from the request.
World world_of(const GraphRequest& request, const AtomReader& atoms);
// "place P lasts 1 s .. 2 s", of places and delays whose durations are not single numbers.
std::vector<std::string> open_durations(const net::Net& net, const World& world);
// What a graph of this world takes for granted.
std::vector<std::string> assumed(const World& world);
// What computes with the time left of a token; and whether tokens carry it about.
std::vector<std::string> misused_time_left(const net::Net& net);
bool carries_time_left(const net::Net& net);
std::string time_in_words(std::int64_t ticks);
// Plays a script in an engine as anybody would; false, and why: it does something else.
bool plays(const World& world, const Script& script, std::string* trouble);
std::optional<Script> class_script(const TimedGraph& graph, std::span<const std::uint32_t> path,
                                   std::string* trouble, TimedGraph::Pace pace);

// Some run never gets to a state of the set: it ends or stops before, or goes round for ever.
bool can_avoid(const Graph& graph, const StateBits& wanted);

class TimedBuilder {
 public:
    TimedBuilder(const GraphRequest& request, ClockForm form, const char* method);
    virtual ~TimedBuilder() = default;
    TimedGraph build();

 protected:
    // Appends the string of the state in which the driver stands.
    // Gives  false if it cannot be: the step did not happen.
    virtual bool encode(Driver& driver, const Driver::Step& step, std::vector<std::uint8_t>& out) {
        (void)step;
        graph_.states->encode(driver, out);
        return true;
    }
    // After encode(): nothing that follows is looked for.
    virtual bool ends() const { return false; }
    // The bounds of the step's ticks, after encode().
    virtual std::pair<std::int64_t, std::int64_t> ticks(const Driver::Step& step) {
        return {step.ticks, step.ticks};
    }
    // Before the branches of a state.
    virtual void enter(std::uint32_t state) { (void)state; }
    // After each branch: which kinds it stirs (graph_.waits), for keeping justice.
    virtual void stirred(Driver& driver, const Driver::Step& step, std::uint64_t* row) {
        (void)driver, (void)step, (void)row;
    }
    // Whether the last pass ends several durations at once, one of them drawn from a continuum.
    virtual bool coincidental(Driver& driver) {
        (void)driver;
        return false;
    }
    // Of graphs that weigh_edges(): the rate or probability of the branch. Those of one edge add
    // up.
    virtual double weight(Driver& driver, const Driver::Step& step) {
        (void)driver, (void)step;
        return 1;
    }
    void weigh_edges() { weighs_ = true; }
    virtual void read_waits(Driver& driver, std::uint64_t* row) { (void)driver, (void)row; }

    const GraphRequest& request_;
    TimedGraph graph_;
    AtomReader atoms_;
    std::unique_ptr<Driver> driver_;

 private:
    struct Row {
        Edge edge;
        std::int64_t low = 0, high = 0;
        double weight = 0;
        bool coincidental = false;
        std::vector<std::uint64_t> stirs;
    };
    void begin();
    void expand(std::uint32_t state);
    std::uint32_t add(std::uint32_t flags);
    void note_stop(std::uint32_t state, bool fired);
    void close_row();
    std::uint32_t wait_words() const { return (graph_.waits.kinds + 63) / 64; }
    Ended look();

    bool weighs_ = false;
    Meter meter_;
    std::vector<std::uint8_t> buffer_;
    std::vector<Row> row_;
    Ended ended_ = Ended::kDone;
};

}  // namespace puppetri::proof
