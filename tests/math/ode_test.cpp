// SPDX-License-Identifier: MIT
// Tests of math/ode.h against closed forms and published reference solutions.
#include "puppetri/math/ode.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "math/formula_system.h"

namespace {

using namespace puppetri;

struct Run {
    std::vector<double> x;
    int steps = 0;
    bool good = true;
    double worst = 0;  // of the interpolant, against `truth`
};

template <class F>
Run integrate(FormulaSystem<F>& system, std::vector<double> x, double until,
              const OdeOptions& options, double (*truth)(double) = nullptr) {
    OdeSolver solver(options);
    Run out;
    REQUIRE(solver.start(system, 0, x));
    OdeStep step;
    while (out.good && solver.now_s() < until) {
        out.good = solver.step(system, until, step) == OdeSolver::Outcome::kStepped;
        ++out.steps;
        for (int i = 0; truth != nullptr && i <= 10; ++i) {
            const double t = step.begin_s + step.length_s * i / 10;
            out.worst = std::max(out.worst, std::fabs(step.at(i / 10.0, 0) - truth(t)));
        }
    }
    out.x.assign(solver.x().begin(), solver.x().end());
    return out;
}

constexpr OdeMethod kBoth[] = {OdeMethod::kDormandPrince, OdeMethod::kRodas};

TEST_CASE("a decay and an oscillator are their closed forms, also between the steps [oracle]") {
    for (const OdeMethod method : kBoth) {
        FormulaSystem decay(1, [](double, auto x, auto out) { out[0] = -x[0]; });
        Run r = integrate(decay, {1}, 5, {.method = method, .relative = 1e-9},
                          [](double t) { return std::exp(-t); });
        CHECK(r.worst < 1e-7);
        CHECK(std::fabs(r.x[0] - std::exp(-5.0)) < 1e-8);

        FormulaSystem spring(2, [](double, auto x, auto out) {
            out[0] = x[1];
            out[1] = -x[0];
        });
        r = integrate(spring, {0, 1}, 20, {.method = method, .relative = 1e-9},
                      [](double t) { return std::sin(t); });
        CHECK(r.worst < 1e-6);
    }
}

// The global error at fixed lengths of steps falls with the order: also where the right side
// depends on the time, which tells a wrong slope coefficient at once.
TEST_CASE("halving the step divides the error by two to the order [law]") {
    for (const OdeMethod method : kBoth) {
        const auto error = [&](int steps) {
            FormulaSystem forced(
                1, [](double t, auto x, auto out) { out[0] = -2 * x[0] * t + std::cos(3 * t); });
            // Tolerances that accept every step, and steps of one length.
            OdeSolver solver(
                {.method = method, .relative = 1e9, .absolute = 1e9, .most_s = 2.0 / steps});
            const double x0 = 1;
            solver.resume(forced, 0, {&x0, 1}, 2.0 / steps);
            OdeStep step;
            while (solver.now_s() < 2) {
                REQUIRE(solver.step(forced, 2, step) == OdeSolver::Outcome::kStepped);
            }
            // By Simpson's rule on x(2) = exp(-4) (1 + integral of exp(s^2) cos(3 s)).
            double sum = 0;
            constexpr int kParts = 20000;
            for (int i = 0; i <= kParts; ++i) {
                const double s = 2.0 * i / kParts;
                sum += std::exp(s * s) * std::cos(3 * s) *
                       (i == 0 || i == kParts ? 1
                        : i % 2 == 1          ? 4
                                              : 2);
            }
            const double truth = std::exp(-4.0) * (1 + sum * 2 / kParts / 3);
            return std::fabs(solver.x()[0] - truth);
        };
        const double order = std::log2(error(40) / error(80));
        CAPTURE(order);
        CHECK(order > (method == OdeMethod::kDormandPrince ? 4.7 : 3.7));
    }
}

TEST_CASE("the predator and the prey keep their invariant [oracle]") {
    FormulaSystem wolves(2, [](double, auto x, auto out) {
        out[0] = x[0] * (1.1 - 0.4 * x[1]);
        out[1] = x[1] * (0.1 * x[0] - 0.4);
    });
    const auto invariant = [](double x, double y) {
        return 0.1 * x - 0.4 * std::log(x) + 0.4 * y - 1.1 * std::log(y);
    };
    const Run r = integrate(wolves, {10, 5}, 100, {});
    CHECK(std::fabs(invariant(r.x[0], r.x[1]) - invariant(10, 5)) < 1e-6);
}

// Hairer, Wanner, "Solving Ordinary Differential Equations II", IV.10: Robertson's reaction.
// Reference values of the test set for initial value problem solvers, t = 1e11.
TEST_CASE("the stiff method solves Robertson's reaction in few steps [oracle]") {
    FormulaSystem reaction(3, [](double, auto y, auto out) {
        out[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        out[2] = 3e7 * y[1] * y[1];
        out[1] = -out[0] - out[2];
    });
    const Run r = integrate(reaction, {1, 0, 0}, 40,
                            {.method = OdeMethod::kRodas, .relative = 1e-7, .absolute = 1e-12});
    REQUIRE(r.good);
    // At t = 40: Hindmarsh's example of LSODE.
    CHECK(r.x[0] == doctest::Approx(7.158e-1).epsilon(1e-4));
    CHECK(r.x[1] == doctest::Approx(9.185e-6).epsilon(1e-3));
    CHECK(r.x[2] == doctest::Approx(2.841e-1).epsilon(1e-4));
    const Run late = integrate(
        reaction, {1, 0, 0}, 1e11,
        {.method = OdeMethod::kRodas, .relative = 1e-6, .absolute = 1e-16, .most_s = 1e12});
    REQUIRE(late.good);
    CHECK(late.x[0] == doctest::Approx(0.2083340149701255e-7).epsilon(1e-3));
    CHECK(late.x[1] == doctest::Approx(0.8333360770334713e-13).epsilon(1e-3));
    CHECK(late.x[2] == doctest::Approx(0.9999999791665050).epsilon(1e-9));
    CHECK(late.steps < 10000);  // an explicit method would need 1e12
}

TEST_CASE("the stiff oscillator of van der Pol ends at its published values [oracle]") {
    // eps = 1e-6, t = 2: y = 0.1706167732170483e1, z = -0.8928097010247975.
    FormulaSystem oscillator(2, [](double, auto y, auto out) {
        out[0] = y[1];
        out[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6;
    });
    const Run r = integrate(oscillator, {2, 0}, 2,
                            {.method = OdeMethod::kRodas, .relative = 1e-7, .absolute = 1e-9});
    REQUIRE(r.good);
    CHECK(r.x[0] == doctest::Approx(1.706167732170483).epsilon(1e-5));
    CHECK(r.x[1] == doctest::Approx(-0.8928097010247975).epsilon(1e-5));
    CHECK(r.steps < 3000);
}

TEST_CASE("a solution that leaves for infinity is told at its pole [hostile]") {
    for (const OdeMethod method : kBoth) {
        FormulaSystem pole(1, [](double, auto x, auto out) { out[0] = x[0] * x[0]; });
        const double one = 1;
        OdeSolver solver({.method = method});
        REQUIRE(solver.start(pole, 0, {&one, 1}));
        OdeStep step;
        OdeSolver::Outcome outcome = OdeSolver::Outcome::kStepped;
        for (int i = 0; i < 100000 && outcome == OdeSolver::Outcome::kStepped; ++i) {
            outcome = solver.step(pole, 5, step);
        }
        CHECK(outcome == OdeSolver::Outcome::kBlewUp);
        CHECK(solver.now_s() == doctest::Approx(1).epsilon(1e-6));
    }
}

}  // namespace
