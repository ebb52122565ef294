// SPDX-License-Identifier: MIT
// Graphs of the whole kernel net, with time, priorities, data, identity and events: what is common
// to the three ways of making them (readiness.h, timed_exact.h, state_classes.h). All three drive
// net::Engine, so that prover and player have one rule of firing; they differ in who keeps the
// clocks. Edges are the smallest steps of an instant: one firing, one event, or the passing to the
// next instant, after which tokens are ready and nothing has fired yet.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/time.h"
#include "puppetri/net/formula.h"
#include "puppetri/net/net.h"
#include "puppetri/net/state.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/graph.h"

namespace puppetri::proof {

// How long something may last, both ends included. high == never: longer than any bound.
struct TickRange {
    std::int64_t low = 0;
    std::int64_t high = SimTime::never().ticks;
    bool operator==(const TickRange&) const = default;
};

struct GraphRequest {
    static constexpr std::uint32_t kAnyNumber = ~std::uint32_t{0};

    const net::Net& net;
    // State formulas; their bits stand in this order in graph.atoms. An atom of a host or of a
    // firing is not known to a state: it may and need not hold. Operators of branching or linear
    // time are refused.
    std::span<const net::Formula> atoms = {};
    // By ActionIndex, of `takes auto`: what the movement declares. Others: anything at all.
    std::span<const TickRange> actions = {};
    // How often the outside makes an event occur, at any time: never, at most so often, any number
    // of times. Events of movements (neither outside, nor scheduled, nor raised) may always occur.
    std::uint32_t outside_events = kAnyNumber;
    std::int64_t beat = kTicksPerSecond;  // of paced nets
    const Budget& budget;
};

// Where a run stops that cannot go on: a datum leaves its range, a module does not end clean, ...
struct Stop {
    std::uint32_t state = 0;
    std::uint32_t label = Edge::kPass;  // of the step that stops
    Diagnostic fault;                   // as the engine says it; its time is not meant
};

// For justice, the only one that is taken for granted: what waits for the end of a finite duration
// does not wait for ever. A cycle of the graph with a kPass edge, in all of whose states something
// of one kind waits and none of whose edges stirs that kind, is no run. Kinds are places, then
// transitions (their delays), then events (scheduled ones).
struct Waits {
    std::uint32_t kinds = 0;  // 0: every cycle of the graph can be gone round for ever
    // Rows of (kinds + 63) / 64 words, per state and per edge (in the order of edges.items).
    std::vector<std::uint64_t> waiting, stirred;
    bool waits(std::uint32_t state, std::uint32_t kind) const { return bit(waiting, state, kind); }
    bool stirs(std::uint32_t edge, std::uint32_t kind) const { return bit(stirred, edge, kind); }

    // Per event, also where kinds is 0. rare: no firing raises it, so that it occurs only finitely
    // often in one instant; a cycle without kPass edges that needs it is no run. by_outside: nobody
    // but the outside makes it occur, which need not.
    std::vector<std::uint8_t> rare, by_outside;
    bool is_rare(const Edge& edge) const { return marks(rare, edge); }
    bool is_by_outside(const Edge& edge) const { return marks(by_outside, edge); }

 private:
    static bool marks(const std::vector<std::uint8_t>& events, const Edge& edge) {
        const std::uint32_t e = edge.label & ~Edge::kEvent;
        return edge.label != Edge::kPass && (edge.label & Edge::kEvent) != 0 && e < events.size() &&
               events[e] != 0;
    }
    bool bit(const std::vector<std::uint64_t>& rows, std::uint32_t row, std::uint32_t k) const {
        return ((rows[std::size_t{row} * ((kinds + 63) / 64) + k / 64] >> (k & 63)) & 1) != 0;
    }
};

// A run of the net, to be played again: with a ScriptedChooser, in an engine that is not free.
struct Script {
    std::vector<std::int64_t> answers;
    struct Outside {
        SimTime at;
        net::EventIndex event;
    };
    std::vector<Outside> outside;  // to be made to occur
    // How long the movements of `takes auto` take, in the order in which they begin: the host has
    // to agree.
    std::vector<SimTime> movements;
    struct Firing {
        SimTime at;
        net::TransitionIndex transition;
    };
    std::vector<Firing> firings;
    SimTime until;  // of the last step
};

// A graph together with its states: how to name them, and how to play a path.
class TimedGraph {
 public:
    TimedGraph();
    ~TimedGraph();
    TimedGraph(TimedGraph&&) noexcept;
    TimedGraph& operator=(TimedGraph&&) noexcept;

    // False: the method cannot treat this net soundly, and there is no graph; why_not names every
    // element that is in the way.
    bool available() const { return why_not.empty(); }
    std::vector<std::string> why_not;

    Graph graph;  // with ticks on its edges where they are known
    // What keeps graph.over or graph.exact from being true, an element each: "place fly lasts
    // 1 s .. 2 s: only the ends were tried".
    std::vector<std::string> not_over, not_exact;
    // What both take for granted: "throw takes 0.4 s .. 0.6 s", "outside events occur at most 3
    // times".
    std::vector<std::string> assumptions;
    std::vector<Stop> stops;
    Waits waits;
    // Per edge (in the order of edges.items), of state classes: 1 if several durations have to end
    // at one instant, one of which is drawn from a distribution: probability 0 in real time.
    std::vector<std::uint8_t> coincidental;
    // Per edge, of Markov chains (markov_net.h): a rate per second, or within an instant a
    // probability. Empty elsewhere.
    std::vector<double> weights;

    net::Counts tokens(std::uint32_t state, net::PlaceIndex place) const;
    Value datum(std::uint32_t state, net::DatumIndex datum) const;
    // "P2 (not ready: 0.5 s), 3 P3, x = 2": what is marked, in words.
    std::string words(std::uint32_t state) const;
    // "t3 fires", "0.5 s pass", "kick occurs".
    std::string words_of_edge(std::uint32_t edge) const;
    // Edges by their number in graph.edges.items, one after another from the initial state.
    // Gives  a script that has been played and did just this; nothing if the path is no run, or
    //        not one that a script can play (trouble says why).
    // Where durations are intervals: the run of this path that ends soonest, or as late as it can.
    // Needs  graph.exact for every path to have one.
    enum class Pace : std::uint8_t { kSoonest, kLatest };
    std::optional<Script> script(std::span<const std::uint32_t> path,
                                 std::string* trouble = nullptr, Pace pace = Pace::kSoonest) const;
    // The end of each edge is not enough to find a path back: breadth first from the initial state.
    // Gives  the edges of a shortest path; empty for the initial state.
    std::vector<std::uint32_t> path_to(std::uint32_t state) const;
    std::uint64_t bytes() const;  // held by the states, apart from `graph`

    struct States;
    std::unique_ptr<States> states;  // the maker's business
};

// A firing sequence of a net without any time (paced) as a script that has been played.
// Gives  nothing if the net does not fire so; trouble says where.
std::optional<Script> script_of(const net::Net& net, std::span<const std::uint32_t> firings,
                                std::int64_t beat, std::string* trouble = nullptr);

}  // namespace puppetri::proof
