// SPDX-License-Identifier: MIT
// Parts of a net that share nothing, made so large that every rule that compares parts, and the
// declared ends, lie in one of them.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "builtin_rules.h"
#include "puppetri/net/draft.h"
#include "puppetri/proof/components.h"
#include "puppetri/stage/stage.h"

namespace puppetri::verdict {

class Splitting {
 public:
    // One part: the whole net.
    Splitting() { parts_.count = 1; }
    // play may be null; the net outlives it. A draft whose lowered form has other numbers than the
    // net is left whole.
    Splitting(const net::Net& net, const net::NetDraft& draft, const stage::Play* play,
              const std::vector<const Asked*>& rules);

    std::uint32_t count() const { return parts_.count; }
    // The parts that a rule reads; empty: no part in particular, or the whole net.
    std::vector<std::uint32_t> read_by(const Asked& asked) const;
    // A part with these rules, as far as they lie in it.
    net::NetDraft draft_of(std::uint32_t part, const std::vector<net::Rule>& rules) const;

    // The whole net, with its numbers; without places: there is no such draft.
    const net::NetDraft& lowered() const { return lowered_; }

    // Rules (by their numbers in the list) by the part that they read; what reads several comes
    // last, together.
    static constexpr std::uint32_t kWhole = ~std::uint32_t{0};
    struct Group {
        std::uint32_t part = kWhole;
        std::vector<std::uint32_t> rules;
    };
    std::vector<Group> groups(const std::vector<const Asked*>& rules) const;

    static bool reads_everything(const Asked& asked);
    // Of what reads everything: each part can be asked by itself, and the answers put together.
    static bool splits(const Asked& asked);
    // It is enough that one part keeps it.
    static bool one_is_enough(const Asked& asked);

 private:
    void add_figures(std::uint32_t atom, std::vector<std::uint32_t>& out) const;

    const net::Net* net_ = nullptr;
    const stage::Play* play_ = nullptr;
    net::NetDraft lowered_;
    proof::Components parts_;
};

}  // namespace puppetri::verdict
