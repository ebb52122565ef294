// SPDX-License-Identifier: MIT
// Draws from distributions. Each draw of a uniform number is a statement of its own: the order of
// draws is part of the contract.
#include <cmath>

#include "normal_bounds.h"
#include "puppetri/base/distribution.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"

namespace puppetri {
namespace {

constexpr int kMostTries = 100000;  // each rejection below accepts with probability above 0.2
constexpr double kTwoPi = 6.283185307179586476925;

double standard_exponential(RandomStream& stream) { return -log(stream.uniform()); }

// Source  G. Box, M. Muller, Ann. Math. Statist. 29 (1958); the second of the pair is not kept, so
// that a stream's state
//         is its count.
double standard_normal(RandomStream& stream) {
    const double radius = std::sqrt(2 * standard_exponential(stream));
    return radius * cos(kTwoPi * stream.uniform());
}

// A standard normal number on condition of lying in [low, high], 0 < low.
// Source  C. Robert, "Simulation of truncated normal variables", Statistics and Computing 5 (1995),
// section 2.
double normal_tail(double low, double high, RandomStream& stream) {
    const double root = std::sqrt(low * low + 4);
    const double rate = (low + root) / 2;
    const bool narrow = high - low <= 2 / (low + root) * exp(0.5 + (low * low - low * root) / 4);
    for (int i = 0; i < kMostTries; ++i) {
        if (narrow) {
            const double z = low + (high - low) * stream.uniform();
            if (stream.uniform() <= exp((low * low - z * z) / 2)) {
                return z;
            }
        } else {
            const double z = low + standard_exponential(stream) / rate;
            const double u = stream.uniform();
            if (z <= high && u <= exp(-(z - rate) * (z - rate) / 2)) {
                return z;
            }
        }
    }
    return low;
}

double truncated_normal(std::span<const double> p, RandomStream& stream) {
    const double mean = p[0];
    const double deviation = p[1];
    if (!(deviation > 0)) {
        return mean;
    }
    const NormalBounds bounds = normal_bounds(p);
    const double low = (bounds.low - mean) / deviation;
    const double high = (bounds.high - mean) / deviation;
    double z = 0;
    if (low > 0) {
        z = normal_tail(low, high, stream);
    } else if (high < 0) {
        z = -normal_tail(-high, -low, stream);
    } else if (high - low >
               2.5) {  // about sqrt(2 pi): from here on the normal proposal is the better one
        int tries = 0;
        do {
            z = standard_normal(stream);
        } while (!(z >= low && z <= high) && ++tries < kMostTries);
    } else {
        for (int tries = 0; tries < kMostTries; ++tries) {
            z = low + (high - low) * stream.uniform();
            if (stream.uniform() <= exp(-z * z / 2)) {
                break;
            }
        }
    }
    const double x = mean + deviation * z;
    return x < bounds.low ? bounds.low : x > bounds.high ? bounds.high : x;  // rounding
}

// Inverse of the distribution function.
double triangular(std::span<const double> p, RandomStream& stream) {
    const double u = stream.uniform();
    const double width = p[2] - p[0];
    const double left = p[1] - p[0];
    if (u * width <= left) {
        return p[0] + std::sqrt(u * width * left);
    }
    return p[2] - std::sqrt((1 - u) * width * (p[2] - p[1]));
}

// Shape a, mean a.
// Source  G. Marsaglia, W. Tsang, "A simple method for generating gamma variables", ACM TOMS 26
// (2000), section 6 for
//         shapes below 1.
double standard_gamma(double shape, RandomStream& stream) {
    if (shape < 1) {
        const double larger = standard_gamma(shape + 1, stream);
        return larger * pow(stream.uniform(), 1 / shape);
    }
    const double d = shape - 1.0 / 3;
    const double c = 1 / std::sqrt(9 * d);
    for (int i = 0; i < kMostTries; ++i) {
        const double x = standard_normal(stream);
        const double root = 1 + c * x;
        if (root <= 0) {
            continue;
        }
        const double v = root * root * root;
        const double u = stream.uniform();
        if (log(u) < 0.5 * x * x + d - d * v + d * log(v)) {
            return d * v;
        }
    }
    return shape;
}

// The sum of `shape` exponential phases; of many phases as a gamma distribution.
double erlang(double shape, double mean, RandomStream& stream) {
    if (shape > 16) {
        return mean / shape * standard_gamma(shape, stream);
    }
    double product = 1;  // of at most 16 numbers above 2^-53: no underflow
    for (int i = 0; i < static_cast<int>(shape); ++i) {
        product *= stream.uniform();
    }
    return -mean / shape * log(product);
}

// Source  A. Law, "Simulation Modeling and Analysis", 5th edition, section 8.3.16.
double empirical(std::span<const double> p, RandomStream& stream) {
    const double position = stream.uniform() * static_cast<double>(p.size() - 1);
    const std::size_t i = static_cast<std::size_t>(position);
    if (i + 1 >= p.size()) {
        return p.back();
    }
    return p[i] + (position - static_cast<double>(i)) * (p[i + 1] - p[i]);
}

double discrete(std::span<const double> p, RandomStream& stream) {
    double total = 0;
    for (std::size_t i = 1; i < p.size(); i += 2) {
        total += p[i];
    }
    double rest = stream.uniform() * total;
    double last = p[0];
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
        if (p[i + 1] > 0) {
            last = p[i];
            rest -= p[i + 1];
            if (rest < 0) {
                break;
            }
        }
    }
    return last;
}

}  // namespace

double sample(DistributionKind kind, std::span<const double> p, RandomStream& stream) {
    PUP_REQUIRE(!p.empty());
    switch (kind) {
        case DistributionKind::kConstant:
            return p[0];
        case DistributionKind::kUniform:
            return p[0] + (p[1] - p[0]) * stream.uniform();
        case DistributionKind::kNormal:
            return truncated_normal(p, stream);
        case DistributionKind::kExponential:
            return p[0] * standard_exponential(stream);
        case DistributionKind::kTriangular:
            return triangular(p, stream);
        case DistributionKind::kErlang:
            return erlang(p[0], p[1], stream);
        case DistributionKind::kGamma:
            return p[1] / p[0] * standard_gamma(p[0], stream);
        case DistributionKind::kEmpirical:
            return empirical(p, stream);
        case DistributionKind::kDiscrete:
            return discrete(p, stream);
    }
    return 0;
}

}  // namespace puppetri
