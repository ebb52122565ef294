// SPDX-License-Identifier: MIT
// Who may hold a prop in which marking, told from what movements declare: a catch has it from its
// start, a throw lets it go at its end, a flight has it in the air until it is over; carrying and
// holding change nothing. Known where an invariant says that one token at a time does any of this:
// then that token goes from place to place, and who holds the prop follows from its way.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "puppetri/net/formula.h"
#include "puppetri/net/net.h"
#include "puppetri/stage/stage.h"

namespace puppetri::verdict {

// Their disjunction; of none: false.
net::Formula any_of(std::vector<net::Formula> parts);

class Holders {
 public:
    // Both outlive it.
    Holders(const net::Net& net, const stage::Play& play) : net_(net), play_(play) {}

    // In a marking that satisfies it the prop may be held by somebody whom `wanted` names (or, if
    // `others`, by anybody else). Constant true where nothing is known.
    // Cost  the net's semiflows once, within half a second; then a few passes over the net per
    //       prop, once.
    net::Formula may_hold(std::uint32_t prop, const std::set<std::string>& wanted,
                          bool others = false);
    // What is taken for granted there: "place getting: ball is between the hands when its movement
    // begins".
    std::vector<std::string> assumptions(std::uint32_t prop);

 private:
    // Per place of the invariant: all who may hold the prop while the token is there.
    struct Way {
        std::map<std::uint32_t, std::set<std::string>> holders;
        std::set<std::uint32_t> aloft;  // where it does not fall before the token is ready
        std::set<std::uint32_t> catches;
    };
    const std::optional<Way>& way(std::uint32_t prop);
    std::optional<Way> find_way(std::uint32_t prop);
    std::optional<std::vector<std::uint32_t>> one_token(const std::set<std::uint32_t>& places);
    net::Formula goes_on_at_once(std::uint32_t place) const;

    const net::Net& net_;
    const stage::Play& play_;
    std::map<std::uint32_t, std::optional<Way>> ways_;
    std::optional<std::vector<std::vector<std::uint32_t>>> single_;  // supports of one token each
};

}  // namespace puppetri::verdict
