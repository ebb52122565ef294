// SPDX-License-Identifier: MIT
// Sampling: where no method proves or refutes, many runs say how likely a rule is kept. No proof:
// the answer is SAMPLED, an interval for the probability that a run keeps the rule up to its
// horizon. Valid stopping: the number of runs is fixed before the first (Clopper and Pearson), or
// Wald's test decides when it may stop.
#pragma once
#include <cstdint>
#include <optional>

#include "puppetri/base/time.h"
#include "puppetri/verdict/pursue.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

// The probability p of success lies between low and high with at least this confidence, whatever p
// is, if `runs` was fixed beforehand. Exact, never too narrow.
// Source  C. J. Clopper, E. S. Pearson, The use of confidence or fiducial limits illustrated in the
//         case of the binomial, Biometrika 26, 1934; by bisection on the binomial tail.
// Cost    O(runs).
struct Interval {
    double low = 0, high = 1;
};
Interval clopper_pearson(std::uint64_t kept, std::uint64_t runs, double confidence);

// Decides between p >= p_good and p <= p_bad, each wrongly with at most the given probability,
// looking after every run.
// Source  A. Wald, Sequential tests of statistical hypotheses, Ann. Math. Stat. 16, 1945.
class WaldTest {
 public:
    enum class Says : std::uint8_t { kGoOn, kGood, kBad };
    // Needs  0 < p_bad < p_good < 1, 0 < wrong < 1/2.
    WaldTest(double p_good, double p_bad, double wrong);
    Says add(bool kept);

 private:
    double sum_ = 0, on_kept_, on_broken_, limit_;
};

struct SampleOptions {
    std::uint64_t runs = 1000;               // fixed beforehand
    SimTime horizon{600 * kTicksPerSecond};  // of each run
    std::uint64_t firings = 100'000;         // likewise
    double confidence = 0.95;
    double seconds = 30;
};

// Plays runs from seeds of their own. A run that breaks the rule ends the sampling: it is a
// witness, and what is refuted is not sampled. Nothing if the rule is not one that a run can break,
// or the time was over before all runs were played.
struct Sampled {
    std::optional<Verdict::Sample> sample;
    std::optional<Witness> witness;
};
Sampled sample(const Theatre& theatre, const Obligation& obligation, const AtomReader& reader,
               const SampleOptions& options);

}  // namespace puppetri::verdict
