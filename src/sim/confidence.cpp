// SPDX-License-Identifier: MIT
// Intervals by Student's distribution, whose quantiles Boost.Math knows.
#include "puppetri/sim/confidence.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "puppetri/base/require.h"

namespace puppetri::sim {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// More than any run will make: what a precision near 0 asks for.
constexpr double kMostReplications = 1e15;

namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::domain_error<policies::ignore_error>,
                               policies::pole_error<policies::ignore_error>,
                               policies::overflow_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>>;

Confidence of_moments(double mean, double variance, double degrees, std::uint64_t count,
                      double level) {
    Confidence c{.mean = mean, .half_width = kInfinite, .level = level, .count = count};
    if (degrees >= 1) {
        c.half_width = student_t(level, degrees) * std::sqrt(variance / static_cast<double>(count));
    }
    return c;
}

}  // namespace

double student_t(double level, double degrees) {
    PUP_REQUIRE(level > 0 && level < 1 && degrees >= 1);
    const boost::math::students_t_distribution<double, Quiet> t(degrees);
    return boost::math::quantile(boost::math::complement(t, (1 - level) / 2));
}

Confidence confidence(const Tally& tally, double level) {
    return of_moments(tally.mean(), tally.variance(), static_cast<double>(tally.count()) - 1,
                      tally.count(), level);
}

Confidence confidence_of_pairs(std::span<const double> values, double level) {
    PUP_REQUIRE(values.size() % 2 == 0);
    Tally pairs;
    for (std::size_t i = 0; i < values.size(); i += 2) {
        pairs.add((values[i] + values[i + 1]) / 2);
    }
    return confidence(pairs, level);
}

Confidence batch_means(std::span<const double> values, std::uint32_t batches, double level) {
    PUP_REQUIRE(batches >= 2);
    const std::size_t size = values.size() / batches;
    Tally means;
    for (std::size_t b = 0; size != 0 && b < batches; ++b) {
        Tally batch;
        for (const double x : values.subspan(values.size() - (batches - b) * size, size)) {
            batch.add(x);
        }
        means.add(batch.mean());
    }
    return confidence(means, level);
}

std::uint64_t replications_needed(const Tally& so_far, std::uint64_t first_stage,
                                  const Precision& precision, double level) {
    PUP_REQUIRE(first_stage >= 2 && so_far.count() >= first_stage && precision.wanted());
    const double half_width =
        std::max(precision.half_width, precision.share_of_mean * std::abs(so_far.mean()));
    if (so_far.variance() == 0) {
        return so_far.count();
    }
    const double t = student_t(level, static_cast<double>(first_stage) - 1);
    const double needed = std::ceil(t * t * so_far.variance() / (half_width * half_width));
    // A mean of 0 makes it infinite or no number
    return std::max(so_far.count(), needed < kMostReplications
                                        ? static_cast<std::uint64_t>(needed)
                                        : static_cast<std::uint64_t>(kMostReplications));
}

Confidence staged_confidence(const Tally& all, std::uint64_t first_stage, double level) {
    return of_moments(all.mean(), all.variance(), static_cast<double>(first_stage) - 1, all.count(),
                      level);
}

}  // namespace puppetri::sim
