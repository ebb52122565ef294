// SPDX-License-Identifier: MIT
// `bounded` refuted: a place that grows for ever. Covering an ancestor proves nothing where time,
// priorities and inhibitors have a say, since one token more may let another transition go first.
// So only two things count. A run that the player has played comes back to the same timed state but
// for more ready tokens in some places, each of which held all the time as many as anybody tests
// for: then the same choices can be made again, for ever. Or every run feeds a place that nothing
// takes from, again and again, however long anything takes.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/net/draft.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/verdict/pursue.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

struct Growth {
    std::uint32_t place = 0;
    std::string reason;
    std::optional<Witness> witness;  // of a run that comes back: lasso_from is set
    std::vector<std::string> assumptions;
};

class Growing {
 public:
    // `lowered`: of the theatre's net, with its numbers. Both outlive it; play may be null.
    Growing(const Theatre& theatre, const net::NetDraft& lowered, const stage::Play* play);

    // By runs that try to follow `prefix`, then `pump` again and again (transitions; of the untimed
    // net; may be empty). `places`: one of these has to grow; empty: any.
    // Gives  nothing if no such run was found, or the net is none where one can be told: times are
    //        drawn from distributions, or decided on the stage.
    // Cost   the time of some thousand firings.
    std::optional<Growth> by_runs(const std::vector<std::uint32_t>& prefix,
                                  const std::vector<std::uint32_t>& pump,
                                  const std::vector<std::uint32_t>& places, bool outside,
                                  const proof::Budget& budget) const;
    // By the readiness graph of the net without its collectors.
    std::optional<Growth> by_every_run(const std::vector<std::uint32_t>& places,
                                       std::uint32_t outside_events,
                                       const proof::Budget& budget) const;

 private:
    class Round;
    bool comes_back() const;

    const Theatre& theatre_;
    const net::Net& net_;
    const net::NetDraft& lowered_;
    const stage::Play* play_;
    // Per place: whether more tokens than `tested_` change nothing, and that number.
    std::vector<std::uint8_t> may_grow_;
    std::vector<std::int64_t> tested_;
};

// The verdict of `bounded` without a number becomes REFUTED where a place grows.
void refute_bounded(const Theatre& theatre, const net::NetDraft& lowered, const stage::Play* play,
                    const net::Rule& rule, const proof::BoundednessAnswer& pump,
                    std::uint32_t outside_events, const proof::Budget& budget, Verdict& verdict);

}  // namespace puppetri::verdict
