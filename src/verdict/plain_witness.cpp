// SPDX-License-Identifier: MIT
#include "plain_witness.h"

namespace puppetri::verdict {

std::optional<Witness> witness_of_firings(const Theatre& theatre, const Obligation& obligation,
                                          const AtomReader& reader, const PlainFinding& finding,
                                          const std::vector<std::uint32_t>& firings,
                                          std::string& trouble) {
    const auto script = proof::script_of(*theatre.net, firings, theatre.beat.ticks, &trouble);
    std::optional<Witness> witness = script ? witness_of(theatre, *script, &trouble) : std::nullopt;
    if (!witness) {
        return std::nullopt;
    }
    witness->rule = obligation.rule;
    witness->says = finding.reason;
    if (finding.lasso_from != kFar) {
        witness->lasso_from = finding.lasso_from;
        return witness;
    }
    witness->violates_after = static_cast<std::uint32_t>(witness->steps.size());
    if (finding.target == Finding::Target::kHopeless) {
        return witness;
    }
    Finding shown;
    shown.target = finding.target;
    const Hunt hunt{.obligation = &obligation, .reader = &reader, .finding = &shown};
    const Replayed again = replay(theatre, *witness, hunt);
    if (!again.breaks) {
        trouble = again.trouble;
        return std::nullopt;
    }
    return witness;
}

}  // namespace puppetri::verdict
