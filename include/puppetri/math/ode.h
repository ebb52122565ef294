// SPDX-License-Identifier: MIT
// Ordinary differential equations x' = f(t, x), step by step with an interpolant inside each step:
// what equations coupled to nets are made of. Two methods, one interface, the same bits on every
// compiler: an explicit one for most problems, an implicit one for stiff ones.
//   OdeSolver solver(system, {.method = OdeMethod::kDormandPrince});
//   solver.start(0, x0);
//   while (solver.step(step, 10) == OdeSolver::Outcome::kStepped) { step.at(0.5, x); ... }
// Why not a library: docs/decisions/0013-one-integrator-of-our-own.md.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace puppetri {

class OdeSystem {
 public:
    virtual ~OdeSystem() = default;
    virtual std::uint32_t size() const = 0;
    // Fills dx/dt. Gives false where the right side has no value.
    virtual bool rates(double t_s, std::span<const double> x, std::span<double> rates) = 0;
};

// kDormandPrince  explicit, order 5, interpolant of order 4. Source: Dormand, Prince, "A family of
//                 embedded Runge-Kutta formulae", J. Comp. Appl. Math. 6 (1980) 19-26; interpolant
//                 and control as in Hairer, Norsett, Wanner, "Solving Ordinary Differential
//                 Equations I", II.4 to II.6.
// kRodas          linearly implicit (Rosenbrock), order 4, stiffly accurate, interpolant of order
//                 3; its Jacobian is taken by differences. Source: Hairer, Wanner, "Solving
//                 Ordinary Differential Equations II", IV.7 and IV.10.
// kGiven          steps that another integrator has made, of any order up to 7; not of OdeSolver.
enum class OdeMethod : std::uint8_t { kDormandPrince, kRodas, kGiven };

struct OdeOptions {
    OdeMethod method = OdeMethod::kDormandPrince;
    double relative = 1e-9;   // of the error of one step, against the size of each variable
    double absolute = 1e-12;  // what is smaller is not followed
    double most_s = 1e6;      // the longest step
    // Variables from this number on are only watched: their errors count against this accuracy.
    std::uint32_t watched_from = ~std::uint32_t{0};
    double watched = 1e-4;
};

// An accepted step: the course of all variables from begin_s to begin_s + length_s.
struct OdeStep {
    double begin_s = 0, length_s = 0;
    OdeMethod method = OdeMethod::kDormandPrince;
    std::uint32_t size = 0;
    // Of the interpolant, `size` numbers each; the first is x at begin_s. With s from 0 to 1, but
    // for kDormandPrince, r0 (1-s) + s (r1 + (1-s) (r2 + s (r3 + s (r4 + ...)))).
    std::vector<double> rows;

    // `ratio` in [0, 1] of the step; 0 gives exactly the beginning. Cost: no allocation.
    void at(double ratio, std::span<double> x) const;
    double at(double ratio, std::uint32_t variable) const;
    // A step in which nothing changes.
    static OdeStep constant(double begin_s, double length_s, std::span<const double> x);
};

class OdeSolver {
 public:
    enum class Outcome : std::uint8_t {
        kStepped,
        kBlewUp,  // no step is short enough: the solution ends here, or the right side has no
                  // value
    };

    explicit OdeSolver(const OdeOptions& options = {}) : options_(options) {}

    // Begins anew; the length of the first step is found by looking at the equations.
    // False: the right side has no value there.
    bool start(OdeSystem& system, double t_s, std::span<const double> x);
    // One step from where the last one ended, not beyond `until_s`. Cost: no allocation once
    // `out` has had its size, but for what the system does.
    Outcome step(OdeSystem& system, double until_s, OdeStep& out);

    double now_s() const { return t_s_; }
    std::span<const double> x() const { return x_; }
    // What it would try next; with now_s and x all that decides what follows.
    double next_s() const { return next_s_; }
    void resume(OdeSystem& system, double t_s, std::span<const double> x, double next_s);

 private:
    bool try_dormand_prince(OdeSystem& system, double h, double& error);
    bool try_rodas(OdeSystem& system, double h, double& error);
    bool linearize(OdeSystem& system);
    bool factorize(double diagonal);
    void solve(std::span<double> b) const;
    double first_length(OdeSystem& system);
    double norm(std::span<const double> error) const;
    std::span<double> row(std::uint32_t i) { return {k_.data() + i * n_, n_}; }

    OdeOptions options_;
    std::uint32_t n_ = 0;
    double t_s_ = 0, next_s_ = 0;
    double end_s_ = 0;  // of the step that is being tried
    bool rejected_ = false, linear_ = false;
    std::vector<double> x_, rate_, new_x_, new_rate_, scratch_;
    std::vector<double> k_;                              // stages
    std::vector<double> jacobian_, time_rate_, matrix_;  // of kRodas
    std::vector<std::uint32_t> pivots_;
};

}  // namespace puppetri
