// SPDX-License-Identifier: MIT
// The built-in rule that successive movements join: which movements of a figure can follow each
// other is told by invariants or by a graph, for all runs; how they join is measured on the stage,
// where a run shows it (docs/proof.md says what that proves).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "join_run.h"
#include "part.h"

namespace puppetri::verdict {

// How a succession joined where it was measured, by what decides it: calls, durations, bodies,
// where those stand at first that the calls speak of. Shared by all parts: figures that do the same
// are measured once.
struct JoinBook {
    struct Entry {
        motion::JoinMeasures measures;
    };
    std::map<std::string, Entry> entries;
    motion::JoinLimits limits;
};

class JoinRule {
 public:
    // Of the figures whose movements lie in this part. All outlive it.
    JoinRule(Part& part, const Theatre& theatre, JoinBook& book);
    ~JoinRule();

    struct Limits {
        double seconds = 1;  // of playing and measuring
        const std::atomic<bool>* cancelled = nullptr;
    };
    // Tries to answer for this figure with what is known so far: successions that invariants or the
    // graph given last leave, joins of runs.
    // `graph`  null: none yet.
    // Gives    true: `verdict` has an answer.
    bool judge(std::uint32_t actor, const GraphView* graph, const Limits& limits, Verdict& verdict);

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace puppetri::verdict
