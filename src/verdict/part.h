// SPDX-License-Identifier: MIT
// A part of a net that shares nothing with the rest, the rules that read it, and its graphs, each
// made when it is first asked for.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "builtin_rules.h"
#include "puppetri/proof/timed_graph.h"
#include "puppetri/verdict/check_graph.h"
#include "puppetri/verdict/figure_lowering.h"
#include "puppetri/verdict/pursue.h"

namespace puppetri::verdict {

enum class Method : std::uint8_t { kReadiness, kExact, kClasses };
const char* name_of(Method method);

struct GraphLimits {
    proof::Budget budget;
    std::uint32_t first_look_states = 0;  // of nets without time
    std::uint32_t outside_events = 0;
};

class Part {
 public:
    // The whole net. Theatre and host outlive it.
    Part(const net::Net& whole, const Theatre& theatre, const HostLowering* host);
    // One part of it, compiled from `draft`; play may be null.
    static std::unique_ptr<Part> of(net::NetDraft draft, const Theatre& theatre,
                                    const stage::Play* play);

    const net::Net& net() const { return *net_; }
    // The rule of this path in the part's own numbers; null: it does not lie in it.
    const Asked* asked(const std::string& path) const;
    std::uint32_t add(Asked asked);
    const Asked& asked(std::uint32_t i) const { return asked_[i]; }
    const Obligation& obligation(std::uint32_t i) const { return obligations_[i]; }
    std::uint32_t rules() const { return static_cast<std::uint32_t>(asked_.size()); }

    // A first look, at few states, where a graph may be large.
    // Null: the method does not treat this net; `why` says so.
    const proof::TimedGraph* first_look(Method method, const GraphLimits& limits, std::string& why);
    // What grows without end even without time will hardly end with it: then the first look is all.
    const proof::TimedGraph* whole_graph(Method method, const GraphLimits& limits,
                                         std::string& why);
    GraphView view(Method method) const;
    bool has(Method method) const { return graphs_[static_cast<std::size_t>(method)].has_value(); }
    const HostLowering* host() const { return host_; }
    // The atoms of all rules that were added so far; the budget outlives it.
    proof::GraphRequest request(const proof::Budget& budget, std::uint32_t outside_events) const;

    // Found on the way: without time this place grows without end.
    bool grows = false;
    std::string grows_where;

    // From the numbers of the whole net to those of the part; empty: the same.
    std::vector<std::uint32_t> transitions, events;
    // Firings of the part as firings of the whole net.
    std::vector<std::uint32_t> in_whole(std::vector<std::uint32_t> firings) const;

 private:
    Part() = default;
    const proof::TimedGraph* made(Method method, const proof::Budget& budget,
                                  std::uint32_t outside_events, std::string& why);
    std::optional<net::Net> own_;
    const net::Net* net_ = nullptr;
    const Theatre* theatre_ = nullptr;
    const HostLowering* host_ = nullptr;
    std::unique_ptr<FigureLowering> own_host_;
    Atoms atoms_;
    std::vector<Asked> asked_;
    std::vector<Obligation> obligations_;
    std::optional<proof::TimedGraph> graphs_[3];
    std::string why_[3];
    bool all_states_[3] = {false, false, false};
};

}  // namespace puppetri::verdict
