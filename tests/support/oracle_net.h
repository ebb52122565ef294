// SPDX-License-Identifier: MIT
// A direct, slow, obviously right interpreter of the kernel, for tests only. It reads a draft
// (without fusions, rendezvous, holdings and refinements, which are rewritten before any semantics
// begins), keeps every token as a record, and asks everything anew after every firing. It shares
// nothing with the engine but the draft and the expressions' trees.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "puppetri/net/draft.h"

namespace puppetri::test {

// Bounds of a run: instants up to `until`, at most so many firings.
struct OracleBounds {
    std::int64_t until = 0;
    std::uint64_t firings = 8;
    std::size_t runs = 4000;   // give up beyond so many different sequences of choices
    std::int64_t beat = 1000;  // of nets that declare no time
};

struct OracleFiring {
    std::int64_t tick = 0;
    std::uint32_t transition = 0;
    bool operator==(const OracleFiring&) const = default;
};

// The draft with every holding time written out as begin, busy and end. The functions below need a
// draft without them.
net::NetDraft without_holdings(net::NetDraft draft);

// One run as text: every firing as "tick:path;", then how it ended and the last marking:
//   "0:a;20:b;|dead P=1/1 Q=2/0 x=3"     P=tokens/ready ones; ends: limit, dead, fault
using OracleRun = std::string;

// All runs under all choices: ties, tokens of `any` places, both ends of intervals. nullopt: more
// than bounds.runs.
std::optional<std::set<OracleRun>> oracle_runs(const net::NetDraft& draft,
                                               const OracleBounds& bounds);

// Whether some choices lead to exactly these firings; nullopt: more than bounds.runs tried, none
// did; (of a run that ended by `bounds`). Needs   a net without intervals and distributions.
std::optional<bool> oracle_accepts(const net::NetDraft& draft,
                                   const std::vector<OracleFiring>& firings,
                                   const OracleBounds& bounds);

// The same notation for a run of somebody else.
OracleRun oracle_notation(
    const net::NetDraft& draft, const std::vector<OracleFiring>& firings, const std::string& end,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& tokens_and_ready,
    const std::vector<Value>& data);

}  // namespace puppetri::test
