// SPDX-License-Identifier: MIT
// Invariants that the arcs alone give. A place flow y has y C = 0 for the incidence matrix C: the
// weighted number of tokens y m never changes, whatever the timing, priorities, guards, inhibitors,
// events or seed, since these only forbid firings. The one thing that breaks it is an arc that
// takes all tokens of a place: give such places as `emptied`, and no flow will stand on them. A
// transition flow x has C x = 0: firing each t x(t) times changes nothing. Everything here is
// exact; numbers that do not fit end the search, they never wrap.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

// A sparse vector of integers over places or transitions.
struct Flow {
    struct Term {
        std::uint32_t index = 0;
        std::int64_t factor = 1;
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;  // in order of indices, no zero factors, greatest common divisor 1
    bool operator==(const Flow&) const = default;
};

struct Flows {
    std::vector<Flow> flows;
    // False: the budget ended, or a number passed 63 bits. What is there is right, but not all.
    bool complete = true;
};

// The minimal semiflows: non-negative flows whose support contains no other's. In a fixed order
// that depends on the net alone.
// Cost    exponential in the worst case: at most `budget.states` rows are held at once (default
//         cap 20 000), and the budget's time.
// Source  Farkas' algorithm as in Martinez and Silva (1982), with the test of minimal supports and
//         the elimination order of Colom and Silva, Convex geometry and semiflows in P/T nets,
//         APN 1990, LNCS 483.
Flows place_semiflows(const PlainNet& net, const Budget& budget,
                      std::span<const std::uint8_t> emptied = {});
Flows transition_semiflows(const PlainNet& net, const Budget& budget);

// A basis of all place flows over the rationals, signs as they come.
// Cost    cubic (integer elimination).
Flows place_flow_basis(const PlainNet& net, const Budget& budget,
                       std::span<const std::uint8_t> emptied = {});

// Per place: some arc of the net takes all its tokens (`all P`).
std::vector<std::uint8_t> emptied_places(const net::Net& net);

// y m. Nothing on overflow.
std::optional<std::int64_t> weighted_tokens(const Flow& flow,
                                            std::span<const std::uint32_t> marking);

// The most tokens that a place can ever have, by the semiflows that stand on it: floor(y m0 /
// y(p)); kNoBound where none does.
inline constexpr std::uint64_t kNoBound = ~std::uint64_t{0};
std::vector<std::uint64_t> bounds_by_semiflows(const PlainNet& net, const Flows& semiflows);

// The transition changes the marking by `effect`: gives minus takes, in order of places, no zeros.
std::vector<Flow> effects(const PlainNet& net);

// "2*ana.has + rui.has = 1": a flow and its constant with the places' names.
std::string invariant_text(const Flow& flow, std::int64_t constant,
                           std::span<const std::string_view> place_names);

}  // namespace puppetri::proof
