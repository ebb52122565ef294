// SPDX-License-Identifier: MIT
// Confidence intervals of means: from independent replications, and from one long run by batch
// means; and how many replications a wanted precision needs, so that the interval stays valid
// although the data themselves say when to stop.
#pragma once
#include <cstdint>
#include <span>

#include "puppetri/sim/tally.h"

namespace puppetri::sim {

// mean - half_width .. mean + half_width covers the true mean with probability `level`. The half
// width is infinite where fewer than two observations say nothing about it.
struct Confidence {
    double mean = 0;
    double half_width = 0;
    double level = 0.95;
    std::uint64_t count = 0;  // independent observations behind it
};

// The t with P(|T| <= t) = level for Student's distribution with so many degrees of freedom.
// Needs   0 < level < 1, degrees >= 1.
double student_t(double level, double degrees);

// From independent observations, nearly normal or many.
Confidence confidence(const Tally& tally, double level);

// Observations that come in pairs which counter each other (antithetic variates): the pairs' means
// are what is independent. Needs an even count.
Confidence confidence_of_pairs(std::span<const double> values, double level);

// One long run, cut into `batches` means of equal numbers of observations (what is left over at the
// beginning is dropped, where a run is least settled).
// Needs   batches >= 2. Gives an infinite half width for fewer observations than batches.
// Source  Schmeiser, "Batch size effects in the analysis of simulation output", Operations Research
//         30 (1982): 10 to 30 batches, whatever the length.
Confidence batch_means(std::span<const double> values, std::uint32_t batches, double level);

// The half width that is wanted: so much, or this share of the mean (the larger of both counts).
struct Precision {
    double half_width = 0;
    double share_of_mean = 0;
    bool wanted() const { return half_width > 0 || share_of_mean > 0; }
};

// Sampling in stages: so many observations are needed in all, at least as many as there are. When
// there are so many, ask again; the interval afterwards is that of staged_confidence. A rule that
// looks after each observation whether the interval is narrow enough stops preferably when the
// variance has been underestimated, and covers too seldom. Here a stage knows the variance of the
// stages before it alone, and t is that of the first, shortest stage.
// Needs   first_stage >= 2 observations in the first stage (30 or more, so that t is near that of
//         the normal distribution), so_far.count() at least as many, precision.wanted(). Where
//         observations are as skewed as exponential ones and fewer than about 100, intervals cover
//         a little too seldom, as any interval by Student's t does.
// Source  C. Stein, "A two-sample test for a linear hypothesis whose power is independent of the
//         variance", Annals of Mathematical Statistics 16 (1945). Changed: the variance is that of
//         all observations, since the first stage's alone varies too much where they are skewed;
//         for shares of the mean the mean so far stands for it.
std::uint64_t replications_needed(const Tally& so_far, std::uint64_t first_stage,
                                  const Precision& precision, double level);

// The mean, and the half width t * s / sqrt(n) with the t of the first stage.
Confidence staged_confidence(const Tally& all, std::uint64_t first_stage, double level);

}  // namespace puppetri::sim
