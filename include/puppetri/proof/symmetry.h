// SPDX-License-Identifier: MIT
// Interchangeable instances: permutations of whole module instances that are automorphisms of the
// net. Found by names ("pairs.7.ana.has"), verified arc by arc. Markings that differ by such a
// permutation have the same future up to it, so one of them, the sorted one, stands for all.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

struct Symmetry {
    // `count` instances with `width` places each: places[i * width + k] is the k-th of instance i.
    // Any two of them may be swapped.
    struct Group {
        std::uint32_t count = 0, width = 0, transitions_width = 0;
        std::vector<std::uint32_t> places;
        std::vector<std::uint32_t> transitions;  // likewise, with transitions_width
    };
    std::vector<Group> groups;  // no place in two of them
    bool none() const { return groups.empty(); }
};

// Candidates are subtrees of the dotted names with the same inner names, and what the same number
// stands behind ("voting_7", "voted_7"); kept are those where exchanging two maps the net's arcs,
// levels and flags onto themselves. The initial marking need not be symmetric.
Symmetry interchangeable_instances(const PlainNet& net,
                                   std::span<const std::string_view> place_names,
                                   std::span<const std::string_view> transition_names);

// The marking's representative: in each group the instances' rows of tokens in ascending order.
void make_canonical(const Symmetry& symmetry, std::span<std::uint32_t> marking);

// Of each group the instances whose swaps leave the predicate as it is, up to the order of
// conjunctions and disjunctions: a rule about two of fifty leaves the other forty-eight. A
// predicate that asks for the enabledness of transitions respects none: tell it in tokens
// (told_in_tokens). Whether anything can fire at all respects every symmetry: ask that without this
// function.
Symmetry respecting(const Symmetry& symmetry, const Predicate& predicate);

// Of each group the instances that hold the same tokens in the marking. From such a marking on,
// with every marking all its permutations are reachable.
Symmetry keeping(const Symmetry& symmetry, std::span<const std::uint32_t> marking);

}  // namespace puppetri::proof
