// SPDX-License-Identifier: MIT
// From firings that a portfolio has found to a run of the player.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "plain_rules.h"
#include "puppetri/verdict/pursue.h"

namespace puppetri::verdict {

// Played twice, firing by firing. What a watched run shows (a broken rule, rest) is looked at again
// by replay(); that something is out of reach from where it ends, or that the marking there is the
// one where it went round before, is the finding's word.
// Needs  an untimed net; firings of it.
std::optional<Witness> witness_of_firings(const Theatre& theatre, const Obligation& obligation,
                                          const AtomReader& reader, const PlainFinding& finding,
                                          const std::vector<std::uint32_t>& firings,
                                          std::string& trouble);

// The finding as a verdict; without a witness where one is needed (`trouble` says why there is
// none) nothing is concluded.
void conclude(const PlainFinding& finding, net::RuleKind kind, std::optional<Witness> witness,
              const std::string& trouble, Verdict& verdict);

}  // namespace puppetri::verdict
