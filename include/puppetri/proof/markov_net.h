// SPDX-License-Identifier: MIT
// Nets whose durations and delays are all exponential, or none (generalized stochastic Petri nets),
// as Markov chains: what a simulation estimates is computed. The net is fired by net::Engine as
// ever; of what waits in a settled instant exactly one is over next, at the rate of its mean, and
// ties within an instant go by their odds.
//   Nets in which nothing is drawn but ties are chains in steps: their states are those of exact
// time, each lasts until something is over, and where it goes is decided by odds. So all chains in
// discrete time are solved, also several with different steps in one net.
// Source  M. Ajmone Marsan, G. Conte, G. Balbo, "A class of generalized stochastic Petri nets for
//         the performance evaluation of multiprocessor systems", ACM TOCS 2 (1984).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/proof/markov_chain.h"
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// The chain of the states in which time passes (tangible ones); those inside of an instant are
// passed with their probabilities.
class MarkovNet {
 public:
    // Every element that is in the way: a duration that is not exponential (in a net where some
    // are), or is drawn (in one where none is exponential), an event from outside.
    std::vector<std::string> why_not;
    bool available() const { return why_not.empty(); }

    TimedGraph graph;                  // all states; not whole if graph.graph.ended says so
    MarkovChain chain;                 // of the tangible ones
    std::vector<std::uint32_t> state;  // of the graph, by state of the chain

    // Of a distribution over the chain's states.
    double mean_tokens(const std::vector<double>& shares, net::PlaceIndex place) const;
    double share_marked(const std::vector<double>& shares, net::PlaceIndex place) const;
    // Firings per second.
    double rate(const std::vector<double>& shares, net::TransitionIndex transition) const;
    // Tokens that the place gets per second.
    double arrivals(const std::vector<double>& shares, net::PlaceIndex place) const;

 private:
    friend MarkovNet markov_net(const GraphRequest& request);
    std::vector<double> firings(const std::vector<double>& shares) const;
    // By edge of the graph: a rate per second, or a probability. The rate of a state that lasts
    // exactly so long is one over this time.
    std::vector<double> weights_;
    std::vector<std::uint32_t> order_;  // the states inside of an instant, each before what follows
};

// No outside events are considered.
// Cost    one engine step per edge; see long_run and at_time for the rest.
MarkovNet markov_net(const GraphRequest& request);

}  // namespace puppetri::proof
