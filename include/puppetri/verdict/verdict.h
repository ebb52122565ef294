// SPDX-License-Identifier: MIT
// A verdict: what is known about one rule, how it is known, under which assumptions, at what cost.
// The one idea: it never says more than its method may say. Where the methods end without an
// answer, the answer is UNKNOWN and the reason is told (docs/proof.md).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::verdict {

enum class Answer : std::uint8_t {
    kProved,
    kRefuted,  // never without a witness that has been played again, or "nothing of the kind can
               // be" of `possible`
    kUnknown,
    kSampled,  // many runs agree: no proof
};

// How strongly it holds, where there is more than one way to mean it.
enum class Force : std::uint8_t {
    kPlain,
    // Ties may be lost for ever, outside events may never come: it holds all the same.
    kEveryChoice,
    // It holds unless somebody is unlucky in infinitely many ties: REFUTED only by ever-unlucky
    // ties, whose probability is 0; the witness is one of these.
    kProbabilityOne,
};

struct Verdict {
    std::string rule;     // path: "one_ball", "if_ready.a", built-in ones "builtin.time_goes_on"
    std::string caption;  // what people call it
    SourceSpan where;     // of the rule; line 0: built in
    bool built_in = false;

    Answer answer = Answer::kUnknown;
    Force force = Force::kPlain;
    std::string method;  // "semiflow", "readiness graph", ...; empty: none came to an end
    // Of kUnknown: why. Of kRefuted: what is wrong, in one sentence.
    std::string reason;
    // What the answer takes for granted: "fly takes 0.001 s .. 5 s".
    std::vector<std::string> assumptions;
    // Vacuity and the like: "a never happens".
    std::vector<std::string> notes;
    std::uint64_t states = 0, edges = 0;
    double seconds = 0;
    std::optional<Witness> witness;

    // Of kSampled: how many runs, how many kept the rule, and an interval for the probability that
    // a run keeps it, at this confidence.
    struct Sample {
        std::uint64_t runs = 0, kept = 0;
        double low = 0, high = 1, confidence = 0.95;
    };
    std::optional<Sample> sample;
};

// "PROVED", "PROVED for every choice", "PROVED with probability 1", "REFUTED", "UNKNOWN",
// "SAMPLED".
std::string name_of(const Verdict& verdict);

// What a program that has these verdicts ends with: 0 all are proved, 1 one is refuted (that beats
// unknown), 3 otherwise. Sampled ones count as proved if they are accepted.
int exit_status(const std::vector<Verdict>& verdicts, bool accept_sampled);

}  // namespace puppetri::verdict
