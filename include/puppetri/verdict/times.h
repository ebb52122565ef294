// SPDX-License-Identifier: MIT
// Questions about time, whose answers are numbers and no verdicts: how soon and how late a state is
// reached over all runs, how long a round takes. A number is exact, or it is a bound and says so;
// what is shown by a run comes with that run, to be played again (docs/proof.md).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/frame_rate.h"
#include "puppetri/verdict/prove.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::verdict {

// So many ticks for so many rounds; of times from the start: for one.
struct Stretch {
    std::int64_t ticks = 0;
    std::int64_t rounds = 1;
    double seconds() const;
    // Of the quotients, exactly.
    bool operator==(const Stretch& other) const;
};

// One end of what is asked for: the quickest run, or the slowest.
struct TimeEnd {
    enum class Says : std::uint8_t {
        kTime,
        kNever,    // no run does it, whatever its timing
        kNoBound,  // some run takes longer than any time
        kUnknown,
    };
    Says says = Says::kUnknown;
    // Of kTime: no run is quicker (slower).
    Stretch time;
    // Of kTime: some run takes just so long, or as nearly so as one likes.
    bool exact = false;
    // Of kNoBound and kUnknown: why.
    std::string reason;
    // Of kTime: a run, and how long it takes. Of kNoBound: a run that waits for ever.
    std::optional<Witness> witness;
    Stretch shown;
};

struct TimeAnswer {
    std::string question;  // path: "soonest", "round.a"
    std::string caption;
    SourceSpan where;
    net::TimeQuestionKind kind = net::TimeQuestionKind::kShortest;
    // What is asked for: shortest has no slowest, longest no quickest, cycle both.
    std::optional<TimeEnd> quickest, slowest;

    std::string method;
    std::vector<std::string> assumptions;
    std::vector<std::string> notes;
    std::uint64_t states = 0, edges = 0;
    double seconds = 0;

    bool known() const;
};

// The questions of a scene, or of a net, in their order; `only` as of rules. The options' budget is
// for all of them together.
std::vector<TimeAnswer> answer_times(const scene::Scene& scene, const ProveOptions& options);
std::vector<TimeAnswer> answer_times(const net::NetDraft& draft, const net::Net& net,
                                     const ProveOptions& options);

// As of verdicts alone (verdict.h); a question without an answer counts as something unknown.
int exit_status(const std::vector<Verdict>& verdicts, const std::vector<TimeAnswer>& answers,
                bool accept_sampled);

// "2.5 s (60 frames)", "at least 3 s; a run takes 3.2 s", "4 s, 6.5 s a round", "no bound",
// "never", "UNKNOWN". Frames where they are whole.
std::string text(const TimeAnswer& answer, FrameRate rate);
// Exactly, in seconds: "5/2".
std::string exact_seconds(const Stretch& span);

}  // namespace puppetri::verdict
