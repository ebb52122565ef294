// SPDX-License-Identifier: MIT
// Rules that the arcs alone prove: invariants for what must never be, theorems of liveness. Holds
// for every timing, so it is tried first.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "builtin_rules.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/state_equation.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

struct StructuralProof {
    std::string method;              // "invariants", "theorem"
    std::vector<std::string> notes;  // which
    bool every_choice = false;
};

class Structure {
 public:
    // The net outlives it.
    explicit Structure(const net::Net& net);
    // Nothing: these methods cannot say.
    std::optional<StructuralProof> prove(const Asked& asked, const HostLowering* host,
                                         const proof::Budget& budget);

 private:
    std::optional<StructuralProof> by_invariants(const net::Rule& rule, const HostLowering* host,
                                                 const proof::Budget& budget);
    std::optional<StructuralProof> by_theorem(const proof::Budget& budget);
    // The invariants by which none of the cases can be; nothing if that is not proved.
    std::optional<std::vector<proof::Invariant>> exclude(const proof::Predicate& bad,
                                                         const proof::Budget& budget);
    bool instants_end() const;

    const net::Net& net_;
    proof::Plain plain_;
    std::vector<std::uint8_t> emptied_;
    std::vector<std::string_view> names_;
    std::vector<proof::Invariant> known_;  // used before: they often answer the next question too
    std::optional<bool> live_;
    std::string theorem_;

 public:
    // Of `bounded`: what was found where it does not hold without time, and how.
    std::string grows;
    proof::BoundednessAnswer pump;
};

}  // namespace puppetri::verdict
