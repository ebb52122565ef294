// SPDX-License-Identifier: MIT
// Draws against distribution functions (Kolmogorov and Smirnov) and closed moments; validation of
// parameters.
#include "puppetri/base/distribution.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace puppetri;

namespace {

using Kind = DistributionKind;
using Cdf = std::function<double(double)>;
constexpr double kInf = std::numeric_limits<double>::infinity();

double phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// The regularized lower incomplete gamma function, by its series.
double gamma_p(double a, double x) {
    if (x <= 0) {
        return 0;
    }
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < 2000 && term > sum * 1e-17; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return std::min(1.0, sum * std::exp(a * std::log(x) - x - std::lgamma(a)));
}

struct Case {
    const char* name;
    Kind kind;
    std::vector<double> parameters;
    Cdf cdf;  // empty: not continuous
};

Cdf truncated(double mean, double deviation, double low, double high) {
    return [=](double x) {
        const auto z = [&](double v) { return (v - mean) / deviation; };
        // by the upper tails where the bounds lie above the mean, so that nothing cancels
        const double a = z(low);
        const double b = z(high);
        if (a > 0) {
            return (phi(-a) - phi(-z(x))) / (phi(-a) - phi(-b));
        }
        return (phi(z(x)) - phi(a)) / (phi(b) - phi(a));
    };
}

std::vector<Case> cases() {
    return {
        {"uniform", Kind::kUniform, {2, 5}, [](double x) { return (x - 2) / 3; }},
        {"exponential", Kind::kExponential, {3}, [](double x) { return 1 - std::exp(-x / 3); }},
        {"triangular",
         Kind::kTriangular,
         {1, 2, 5},
         [](double x) { return x < 2 ? (x - 1) * (x - 1) / 4 : 1 - (5 - x) * (5 - x) / 12; }},
        {"triangular, mode at an end",
         Kind::kTriangular,
         {1, 1, 3},
         [](double x) { return 1 - (3 - x) * (3 - x) / 4; }},
        {"normal", Kind::kNormal, {10, 2}, truncated(10, 2, 0, kInf)},
        {"normal, cut near its mean", Kind::kNormal, {1, 2}, truncated(1, 2, 0, kInf)},
        {"normal, a narrow window", Kind::kNormal, {0, 1, -0.5, 0.75}, truncated(0, 1, -0.5, 0.75)},
        {"normal, an upper tail", Kind::kNormal, {0, 1, 3, kInf}, truncated(0, 1, 3, kInf)},
        {"normal, a narrow upper tail", Kind::kNormal, {0, 1, 3, 3.1}, truncated(0, 1, 3, 3.1)},
        {"normal, a far upper tail", Kind::kNormal, {0, 1, 12, kInf}, truncated(0, 1, 12, kInf)},
        {"normal, a lower tail", Kind::kNormal, {5, 1, -kInf, 2.5}, truncated(5, 1, -kInf, 2.5)},
        {"Erlang", Kind::kErlang, {3, 6}, [](double x) { return gamma_p(3, x / 2); }},
        {"Erlang of many phases",
         Kind::kErlang,
         {40, 20},
         [](double x) { return gamma_p(40, x * 2); }},
        {"gamma, shape below 1",
         Kind::kGamma,
         {0.5, 1},
         [](double x) { return gamma_p(0.5, x / 2); }},
        {"gamma", Kind::kGamma, {2.5, 5}, [](double x) { return gamma_p(2.5, x / 2); }},
        {"empirical",
         Kind::kEmpirical,
         {1, 2, 2.5, 4},
         [](double x) {
             return x < 2     ? (x - 1) / 3
                    : x < 2.5 ? 1.0 / 3 + (x - 2) / 1.5
                              : 2.0 / 3 + (x - 2.5) / 4.5;
         }},
        {"discrete", Kind::kDiscrete, {1, 3, 5, 0, 7, 1}, {}},
    };
}

}  // namespace

TEST_CASE("draws follow their distribution function (Kolmogorov-Smirnov) [law]") {
    constexpr int kDraws = 20000;
    for (const Case& c : cases()) {
        if (!c.cdf) {
            continue;
        }
        CAPTURE(c.name);
        REQUIRE(check(c.kind, c.parameters).has_value());
        RandomStream stream{.key = 2024, .count = 0};
        std::vector<double> draws(kDraws);
        for (double& x : draws) {
            x = sample(c.kind, c.parameters, stream);
        }
        std::sort(draws.begin(), draws.end());
        double gap = 0;
        for (int i = 0; i < kDraws; ++i) {
            const double f = c.cdf(draws[static_cast<std::size_t>(i)]);
            gap = std::max({gap, f - i / double{kDraws}, (i + 1) / double{kDraws} - f});
        }
        CHECK(gap * std::sqrt(double{kDraws}) < 2.0);  // exceeded with probability 0.0007
    }
}

TEST_CASE("draws fill cells of equal probability evenly (chi-square) [law]") {
    constexpr int kDraws = 20000, kCells = 40;
    const auto chi_square = [](const std::vector<int>& counts, const std::vector<double>& shares) {
        double sum = 0;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const double expected = shares[i] * kDraws;
            sum += (counts[i] - expected) * (counts[i] - expected) / expected;
        }
        return sum;
    };
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        RandomStream stream{.key = 2025, .count = 0};
        if (!c.cdf) {  // values and weights
            std::vector<int> counts;
            std::vector<double> shares;
            std::vector<double> values;
            double whole = 0;
            for (std::size_t i = 0; i < c.parameters.size(); i += 2) {
                whole += c.parameters[i + 1];
                if (c.parameters[i + 1] > 0) {
                    values.push_back(c.parameters[i]);
                    shares.push_back(c.parameters[i + 1]);
                }
            }
            for (double& share : shares) {
                share /= whole;
            }
            counts.resize(values.size());
            for (int i = 0; i < kDraws; ++i) {
                const double x = sample(c.kind, c.parameters, stream);
                const auto found = std::find(values.begin(), values.end(), x);
                REQUIRE(found != values.end());  // none of weight 0
                ++counts[static_cast<std::size_t>(found - values.begin())];
            }
            CHECK(chi_square(counts, shares) < 15);  // one degree of freedom: probability 0.0001
            continue;
        }
        std::vector<int> counts(kCells);
        for (int i = 0; i < kDraws; ++i) {
            const double f = c.cdf(sample(c.kind, c.parameters, stream));
            ++counts[static_cast<std::size_t>(
                std::clamp(static_cast<int>(f * kCells), 0, kCells - 1))];
        }
        // 39 degrees of freedom: below 12 or above 83 each with a probability below 0.0001
        const double sum = chi_square(counts, std::vector<double>(kCells, 1.0 / kCells));
        CHECK(sum < 83);
        CHECK(sum > 12);
    }
}

TEST_CASE("mean and variance of draws are those of the moments, all within the support [law]") {
    constexpr int kDraws = 100000;
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        RandomStream stream{.key = 99, .count = 0};
        const Moments m = moments(c.kind, c.parameters);
        const Support s = support(c.kind, c.parameters);
        double sum = 0;
        double squares = 0;
        for (int i = 0; i < kDraws; ++i) {
            const double x = sample(c.kind, c.parameters, stream);
            CHECK((x >= s.low && x <= s.high));
            sum += x - m.mean;
            squares += (x - m.mean) * (x - m.mean);
        }
        CHECK(std::fabs(sum / kDraws) < 4 * std::sqrt(m.variance / kDraws));
        CHECK(squares / kDraws == doctest::Approx(m.variance).epsilon(0.06));
    }
}

TEST_CASE("moments of truncated normals agree with the closed form [oracle]") {
    const auto closed = [](double a, double b) {  // of the standard normal in [a, b]
        const auto density = [](double z) {
            return std::isinf(z) ? 0.0 : std::exp(-z * z / 2) / std::sqrt(2 * M_PI);
        };
        const auto times = [&](double z) { return std::isinf(z) ? 0.0 : z * density(z); };
        const double mass = a > 0 ? phi(-a) - phi(-b) : phi(b) - phi(a);
        const double mean = (density(a) - density(b)) / mass;
        return Moments{.mean = mean, .variance = 1 + (times(a) - times(b)) / mass - mean * mean};
    };
    for (const auto& [a, b] : std::vector<std::pair<double, double>>{
             {-1, kInf}, {-0.5, 0.75}, {2, kInf}, {-3, -1}, {-kInf, kInf}, {4, 4.5}}) {
        const std::vector<double> p = {0, 1, a, b};
        const Moments m = moments(Kind::kNormal, p);
        const Moments wanted = closed(a, b);
        CHECK(m.mean == doctest::Approx(wanted.mean).epsilon(1e-9));
        CHECK(m.variance == doctest::Approx(wanted.variance).epsilon(1e-7));
    }
}

TEST_CASE(
    "a discrete draw has the frequencies of its weights and never a value of weight 0 [law]") {
    RandomStream stream{.key = 5, .count = 0};
    const std::vector<double> p = {1, 3, 5, 0, 7, 1};
    int sevens = 0;
    for (int i = 0; i < 40000; ++i) {
        const double x = sample(Kind::kDiscrete, p, stream);
        CHECK((x == 1 || x == 7));
        sevens += x == 7 ? 1 : 0;
    }
    CHECK(std::fabs(sevens - 10000) < 4 * std::sqrt(40000 * 0.25 * 0.75));
}

TEST_CASE("the same stream gives the same draws, and its count says where it stands [unit]") {
    for (const Case& c : cases()) {
        RandomStream a{.key = 1, .count = 0};
        RandomStream b{.key = 1, .count = 0};
        for (int i = 0; i < 10; ++i) {
            CHECK(sample(c.kind, c.parameters, a) == sample(c.kind, c.parameters, b));
        }
        CHECK(a.count > 0);
        RandomStream again{.key = 1, .count = a.count};
        CHECK(sample(c.kind, c.parameters, a) == sample(c.kind, c.parameters, again));
    }
}

TEST_CASE("degenerate parameters are fine [unit]") {
    RandomStream stream{.key = 3, .count = 0};
    CHECK(sample(Kind::kConstant, std::vector<double>{4}, stream) == 4);
    CHECK(sample(Kind::kUniform, std::vector<double>{4, 4}, stream) == 4);
    CHECK(sample(Kind::kTriangular, std::vector<double>{4, 4, 4}, stream) == 4);
    CHECK(sample(Kind::kNormal, std::vector<double>{4, 0}, stream) == 4);
    CHECK(sample(Kind::kNormal, std::vector<double>{4, 1, 5, 5}, stream) == 5);
    CHECK(sample(Kind::kEmpirical, std::vector<double>{4}, stream) == 4);
    CHECK(sample(Kind::kDiscrete, std::vector<double>{4, 1}, stream) == 4);
    CHECK(moments(Kind::kNormal, std::vector<double>{4, 0}).mean == 4);
    CHECK(moments(Kind::kNormal, std::vector<double>{4, 1, 5, 5}).mean == doctest::Approx(5));
}

TEST_CASE("wrong parameters are refused, each kind by name [unit]") {
    const std::vector<std::pair<Kind, std::vector<double>>> wrong = {
        {Kind::kConstant, {}},
        {Kind::kConstant, {kInf}},
        {Kind::kUniform, {2, 1}},
        {Kind::kUniform, {1}},
        {Kind::kNormal, {1}},
        {Kind::kNormal, {1, -1}},
        {Kind::kNormal, {1, 1, 3, 2}},
        {Kind::kNormal, {-5, 0}},
        {Kind::kNormal, {std::nan(""), 1}},
        {Kind::kNormal, {0, 1e-9, 5, 6}},
        {Kind::kExponential, {0}},
        {Kind::kExponential, {std::nan("")}},
        {Kind::kTriangular, {1, 0, 2}},
        {Kind::kErlang, {0, 1}},
        {Kind::kErlang, {1.5, 1}},
        {Kind::kErlang, {2, 0}},
        {Kind::kGamma, {0, 1}},
        {Kind::kGamma, {1, -1}},
        {Kind::kEmpirical, {}},
        {Kind::kEmpirical, {2, 1}},
        {Kind::kDiscrete, {1}},
        {Kind::kDiscrete, {1, 0}},
        {Kind::kDiscrete, {1, -1, 2, 3}},
    };
    for (const auto& [kind, parameters] : wrong) {
        CAPTURE(std::string(name_of(kind)));
        CAPTURE(parameters.size());
        const Status status = check(kind, parameters);
        REQUIRE(!status.has_value());
        CHECK(status.error()[0].code == "wrong-distribution");
        CHECK(status.error()[0].element == name_of(kind));
    }
}
