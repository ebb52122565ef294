// SPDX-License-Identifier: MIT
#include "plain_witness.h"

#include <utility>

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

void conclude(const PlainFinding& finding, net::RuleKind kind, std::optional<Witness> witness,
              const std::string& trouble, Verdict& verdict) {
    if (finding.answer == Answer::kUnknown) {
        return;
    }
    // Of these the refutation is that there is no run.
    const bool by_none = kind == net::RuleKind::kPossible || kind == net::RuleKind::kQuasiLive;
    if (finding.answer == Answer::kRefuted && !by_none && !witness) {
        if (!finding.branches) {
            verdict.reason = finding.reason + ", but no run shows it: " + trouble;
            return;
        }
        verdict.notes.push_back("no single run shows it: it is about choices");
    }
    verdict.answer = finding.answer;
    verdict.force = finding.force;
    verdict.method = method_of(finding.how);
    verdict.reason = finding.answer == Answer::kRefuted ? finding.reason : "";
    verdict.notes.insert(verdict.notes.end(), finding.notes.begin(), finding.notes.end());
    verdict.witness = std::move(witness);
}

}  // namespace puppetri::verdict
