// SPDX-License-Identifier: MIT
#include "puppetri/proof/linear_program.h"

#include <doctest/doctest.h>

#include <limits>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

constexpr std::int64_t kNoLow = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kNoHigh = std::numeric_limits<std::int64_t>::max();

struct Bounds {
    std::int64_t low = kNoLow, high = kNoHigh;
};

// A random program over three free variables: what each variable is as a combination of them.
struct Random {
    LinearProgram program;
    std::vector<std::vector<std::int64_t>> meaning;
    std::vector<Bounds> bounds;

    explicit Random(Chance& chance) {
        const std::uint32_t base = 3, sums = 2 + chance.below(4);
        for (std::uint32_t i = 0; i < base; ++i) {
            program.variable();
            meaning.push_back({i == 0, i == 1, i == 2});
        }
        for (std::uint32_t i = 0; i < sums; ++i) {
            std::vector<LinearProgram::Term> terms;
            std::vector<std::int64_t> m(base, 0);
            for (std::uint32_t k = 0; k < meaning.size(); ++k) {
                const std::int64_t f = static_cast<std::int64_t>(chance.below(7)) - 3;
                if (chance.one_in(2)) {
                    terms.push_back({k, f});
                    for (std::uint32_t b = 0; b < base; ++b) {
                        m[b] += f * meaning[k][b];
                    }
                }
            }
            program.sum(terms);
            meaning.push_back(m);
        }
        bounds.resize(meaning.size());
    }
    void tighten(Chance& chance) {
        const std::uint32_t v = chance.below(static_cast<std::uint32_t>(meaning.size()));
        const std::int64_t limit = static_cast<std::int64_t>(chance.below(13)) - 6;
        if (chance.one_in(2)) {
            program.at_least(v, limit);
            bounds[v].low = std::max(bounds[v].low, limit);
        } else {
            program.at_most(v, limit);
            bounds[v].high = std::min(bounds[v].high, limit);
        }
    }
    // The values are within their bounds and fit together.
    void check_values() const {
        std::int64_t common = 1;
        for (std::uint32_t b = 0; b < 3; ++b) {
            common *= program.value(b).denominator;
        }
        for (std::uint32_t v = 0; v < meaning.size(); ++v) {
            std::int64_t sum = 0;
            for (std::uint32_t b = 0; b < 3; ++b) {
                sum += meaning[v][b] * program.value(b).numerator *
                       (common / program.value(b).denominator);
            }
            const auto x = program.value(v);
            CHECK(x.numerator * common == sum * x.denominator);
            CHECK((bounds[v].low == kNoLow || x.numerator >= bounds[v].low * x.denominator));
            CHECK((bounds[v].high == kNoHigh || x.numerator <= bounds[v].high * x.denominator));
        }
    }
    // The reasons cancel, and their bounds add up above zero.
    void check_reasons() const {
        std::vector<std::int64_t> sum(3, 0);
        std::int64_t least = 0;
        for (const LinearProgram::Reason& r : program.reasons()) {
            REQUIRE(r.factor > 0);
            const std::int64_t f = r.upper ? -r.factor : r.factor;
            const std::int64_t bound = r.upper ? bounds[r.variable].high : bounds[r.variable].low;
            REQUIRE(bound != kNoLow);
            REQUIRE(bound != kNoHigh);
            least += f * bound;
            for (std::uint32_t b = 0; b < 3; ++b) {
                sum[b] += f * meaning[r.variable][b];
            }
        }
        CHECK(sum == std::vector<std::int64_t>(3, 0));
        CHECK(least > 0);
    }
};

}  // namespace

TEST_CASE(
    "each answer comes with its proof: values within all bounds, or bounds that contradict each "
    "other [law]") {
    Chance chance(111);
    int feasible = 0, infeasible = 0;
    for (int round = 0; round < 4000; ++round) {
        Random r(chance);
        std::vector<std::vector<Bounds>> saved;
        for (int step = 0; step < 12; ++step) {
            if (chance.one_in(4)) {
                r.program.push();
                saved.push_back(r.bounds);
            } else if (chance.one_in(4) && !saved.empty()) {
                r.program.pop();
                r.bounds = saved.back();
                saved.pop_back();
            } else {
                r.tighten(chance);
            }
            const auto answer = r.program.solve(10000);
            if (answer == LinearProgram::Answer::kFeasible) {
                ++feasible;
                r.check_values();
            } else {
                REQUIRE(answer == LinearProgram::Answer::kInfeasible);
                ++infeasible;
                r.check_reasons();
            }
        }
    }
    CHECK(feasible > 5000);
    CHECK(infeasible > 5000);
}

TEST_CASE("the greatest value is reached, and one more is impossible [law]") {
    Chance chance(112);
    int found = 0, unbounded = 0;
    for (int round = 0; round < 4000; ++round) {
        Random r(chance);
        for (int step = 0; step < 10; ++step) {
            r.tighten(chance);
        }
        const std::uint32_t goal = chance.below(static_cast<std::uint32_t>(r.meaning.size()));
        LinearProgram::Value best;
        const auto answer = r.program.maximize(goal, 10000, best);
        if (answer == LinearProgram::Answer::kFeasible) {
            ++found;
            r.check_values();
            CHECK(r.program.value(goal).numerator == best.numerator);
            // floor + 1
            std::int64_t above = best.numerator / best.denominator + 1;
            above -= best.numerator % best.denominator < 0 ? 1 : 0;
            r.program.at_least(goal, above);
            CHECK(r.program.solve(10000) == LinearProgram::Answer::kInfeasible);
        } else if (answer == LinearProgram::Answer::kUnbounded) {
            ++unbounded;
            r.program.at_least(goal, 1'000'000);
            CHECK(r.program.solve(10000) == LinearProgram::Answer::kFeasible);
        }
    }
    CHECK(found > 100);
    CHECK(unbounded > 50);
}

TEST_CASE("numbers that do not fit end the search with no answer [unit]") {
    LinearProgram program;
    std::uint32_t x = program.variable();
    program.at_least(x, 1);
    for (int i = 0; i < 5; ++i) {
        const LinearProgram::Term term{x, std::int64_t{1} << 40};
        x = program.sum({&term, 1});
    }
    CHECK(program.solve(100) == LinearProgram::Answer::kGaveUp);
    CHECK(program.overflowed());
}
