// SPDX-License-Identifier: MIT
// Validation, moments and supports of distributions. The draws themselves are in
// distribution_sample.cpp.
#include "puppetri/base/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "normal_bounds.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"

namespace puppetri {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool finite(double x) { return x - x == 0; }

class Defects {
 public:
    explicit Defects(DistributionKind kind) : kind_(kind) {}

    void require(bool holds, const char* message, const char* remedy) {
        if (!holds) {
            list_.push_back({.severity = Severity::kError,
                             .code = "wrong-distribution",
                             .where = {},
                             .element = name_of(kind_),
                             .message = message,
                             .remedy = remedy});
        }
    }
    bool count(std::size_t have, std::size_t want, const char* remedy) {
        require(have == want, "the number of parameters is wrong", remedy);
        return have == want;
    }
    Status result() && {
        if (list_.empty()) {
            return Ok{};
        }
        return Unexpected(std::move(list_));
    }

 private:
    DistributionKind kind_;
    Diagnostics list_;
};

void check_normal(std::span<const double> p, Defects& defects) {
    constexpr const char* kUsage = "normal(mean, deviation) or normal(mean, deviation, low, high)";
    if (p.size() != 2 && !defects.count(p.size(), 4, kUsage)) {
        return;
    }
    defects.require(finite(p[0]) && finite(p[1]), "mean and deviation must be numbers", kUsage);
    defects.require(!(p[1] < 0), "the deviation is negative", "give a deviation of 0 or more");
    if (p.size() == 4) {
        defects.require(p[2] <= p[3] && p[2] < kInfinity && p[3] > -kInfinity,
                        "the lower bound is above the upper", "write the smaller bound first");
    }
    const NormalBounds b = normal_bounds(p);
    if (p[1] == 0) {
        defects.require(p[0] >= b.low && p[0] <= b.high,
                        "with deviation 0 the mean must lie within the bounds",
                        "move the bounds or give a deviation");
    }
    defects.require(!(p[1] > 0) || (b.low - p[0] <= 1e6 * p[1] && p[0] - b.high <= 1e6 * p[1]),
                    "the bounds are more than a million deviations from the mean",
                    "check the units of mean, deviation and bounds");
}

void check_discrete(std::span<const double> p, Defects& defects) {
    constexpr const char* kUsage = "discrete(value, weight, value, weight, ...)";
    defects.require(!p.empty() && p.size() % 2 == 0, "values and weights do not pair up", kUsage);
    bool usable = true;
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        usable = usable && finite(p[i]) && (i % 2 == 0 || p[i] >= 0);
        sum += i % 2 == 1 ? p[i] : 0;
    }
    defects.require(usable, "a value is no number or a weight is negative", kUsage);
    defects.require(sum > 0 && finite(sum), "the weights must have a finite sum above 0",
                    "give at least one value a weight above 0");
}

void check_others(DistributionKind kind, std::span<const double> p, Defects& defects) {
    bool all_finite = true;
    for (const double x : p) {
        all_finite = all_finite && finite(x);
    }
    defects.require(all_finite, "a parameter is not a finite number", "give finite parameters");
    switch (kind) {
        case DistributionKind::kConstant:
            defects.count(p.size(), 1, "constant(value)");
            break;
        case DistributionKind::kUniform:
            if (defects.count(p.size(), 2, "uniform(low, high)")) {
                defects.require(!(p[0] > p[1]), "the lower bound is above the upper",
                                "write the smaller bound first");
            }
            break;
        case DistributionKind::kExponential:
            if (defects.count(p.size(), 1, "exponential(mean)")) {
                defects.require(p[0] > 0, "the mean is not above 0", "give a mean above 0");
            }
            break;
        case DistributionKind::kTriangular:
            if (defects.count(p.size(), 3, "triangular(low, mode, high)")) {
                defects.require(p[0] <= p[1] && p[1] <= p[2],
                                "low, mode and high are not in ascending order",
                                "write triangular(low, mode, high)");
            }
            break;
        case DistributionKind::kErlang:
            if (defects.count(p.size(), 2, "erlang(shape, mean)")) {
                defects.require(p[0] >= 1 && p[0] <= 1e6 && std::floor(p[0]) == p[0],
                                "the shape is not a whole number from 1 to 1 000 000",
                                "give the number of phases, or use gamma(shape, mean)");
                defects.require(p[1] > 0, "the mean is not above 0", "give a mean above 0");
            }
            break;
        case DistributionKind::kGamma:
            if (defects.count(p.size(), 2, "gamma(shape, mean)")) {
                defects.require(p[0] > 0, "the shape is not above 0", "give a shape above 0");
                defects.require(p[1] > 0, "the mean is not above 0", "give a mean above 0");
            }
            break;
        default:
            defects.require(!p.empty(), "there is no observation", "empirical(value, value, ...)");
            defects.require(std::is_sorted(p.begin(), p.end()),
                            "the observations are not in ascending order", "sort them");
            break;
    }
}

// Simpson's rule over the part of [low, high] (in deviations from the mean) that carries weight.
// The density is scaled by its largest value there, so that far tails do not vanish.
Moments normal_moments(std::span<const double> p) {
    const NormalBounds b = normal_bounds(p);
    const double mean = p[0];
    const double deviation = p[1];
    if (deviation == 0) {
        return {.mean = mean, .variance = 0};
    }
    double low = (b.low - mean) / deviation;
    double high = (b.high - mean) / deviation;
    const double peak = low > 0 ? low : high < 0 ? high : 0;
    const double reach = 40 / (1 + std::fabs(peak)) +
                         (peak == 0 ? 0 : 1e-9);  // beyond it the density is below e^-40
    low = std::max(low, peak - reach);
    high = std::min(high, peak + reach);
    if (!(low < high)) {
        return {.mean = mean + deviation * peak, .variance = 0};
    }
    constexpr int kSteps = 4000;
    const double h = (high - low) / kSteps;
    double sums[3] = {};
    for (int i = 0; i <= kSteps; ++i) {
        const double d = low - peak + h * i;  // z = peak + d
        const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
        const double density = weight * exp(-0.5 * d * (d + 2 * peak));
        sums[0] += density;
        sums[1] += density * d;
        sums[2] += density * d * d;
    }
    const double first = sums[1] / sums[0];
    const double second = sums[2] / sums[0];
    return {.mean = mean + deviation * (peak + first),
            .variance = deviation * deviation * (second - first * first)};
}

// Each of the n - 1 stretches between neighbours is equally likely and uniform within.
Moments empirical_moments(std::span<const double> p) {
    if (p.size() == 1) {
        return {.mean = p[0], .variance = 0};
    }
    const double n = static_cast<double>(p.size() - 1);
    double mean = 0;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        mean += (p[i] + p[i + 1]) / 2 / n;
    }
    double variance = 0;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        const double middle = (p[i] + p[i + 1]) / 2 - mean;
        const double width = p[i + 1] - p[i];
        variance += (middle * middle + width * width / 12) / n;
    }
    return {.mean = mean, .variance = variance};
}

Moments discrete_moments(std::span<const double> p) {
    double total = 0;
    double mean = 0;
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
        total += p[i + 1];
        mean += p[i] * p[i + 1];
    }
    mean /= total;
    double variance = 0;
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
        variance += (p[i] - mean) * (p[i] - mean) * p[i + 1] / total;
    }
    return {.mean = mean, .variance = variance};
}

}  // namespace

const char* name_of(DistributionKind kind) {
    static constexpr const char* kNames[] = {"constant",    "uniform",    "normal",
                                             "exponential", "triangular", "erlang",
                                             "gamma",       "empirical",  "discrete"};
    return kNames[static_cast<std::uint8_t>(kind)];
}

Status check(DistributionKind kind, std::span<const double> parameters) {
    Defects defects(kind);
    if (kind == DistributionKind::kNormal) {
        check_normal(parameters, defects);
    } else if (kind == DistributionKind::kDiscrete) {
        check_discrete(parameters, defects);
    } else {
        check_others(kind, parameters, defects);
    }
    return std::move(defects).result();
}

// Source  A. Law, "Simulation Modeling and Analysis", 5th edition, section 6.2; the rest by
// integration.
Moments moments(DistributionKind kind, std::span<const double> p) {
    PUP_REQUIRE(!p.empty());
    switch (kind) {
        case DistributionKind::kConstant:
            return {.mean = p[0], .variance = 0};
        case DistributionKind::kUniform:
            return {.mean = (p[0] + p[1]) / 2, .variance = (p[1] - p[0]) * (p[1] - p[0]) / 12};
        case DistributionKind::kNormal:
            return normal_moments(p);
        case DistributionKind::kExponential:
            return {.mean = p[0], .variance = p[0] * p[0]};
        case DistributionKind::kTriangular:
            return {
                .mean = (p[0] + p[1] + p[2]) / 3,
                .variance = ((p[2] - p[0]) * (p[2] - p[0]) - (p[1] - p[0]) * (p[2] - p[1])) / 18};
        case DistributionKind::kErlang:
        case DistributionKind::kGamma:
            return {.mean = p[1], .variance = p[1] * p[1] / p[0]};
        case DistributionKind::kEmpirical:
            return empirical_moments(p);
        case DistributionKind::kDiscrete:
            return discrete_moments(p);
    }
    return {};
}

Support support(DistributionKind kind, std::span<const double> p) {
    PUP_REQUIRE(!p.empty());
    switch (kind) {
        case DistributionKind::kConstant:
            return {.low = p[0], .high = p[0]};
        case DistributionKind::kUniform:
            return {.low = p[0], .high = p[1]};
        case DistributionKind::kNormal: {
            const NormalBounds b = normal_bounds(p);
            return p[1] == 0 ? Support{.low = p[0], .high = p[0]}
                             : Support{.low = b.low, .high = b.high};
        }
        case DistributionKind::kTriangular:
            return {.low = p[0], .high = p[2]};
        case DistributionKind::kEmpirical:
            return {.low = p.front(), .high = p.back()};
        case DistributionKind::kDiscrete: {
            Support s = {.low = kInfinity, .high = -kInfinity};
            for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
                if (p[i + 1] > 0) {
                    s.low = std::min(s.low, p[i]);
                    s.high = std::max(s.high, p[i]);
                }
            }
            return s;
        }
        default:
            return {.low = 0, .high = kInfinity};
    }
}

}  // namespace puppetri
