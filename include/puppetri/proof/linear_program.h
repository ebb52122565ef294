// SPDX-License-Identifier: MIT
// Exact linear programming: the simplex method of bounds on integer rows, as solvers of
// satisfiability modulo theories use it. Bounds are pushed and popped, so that cases are tried one
// after another from where the last one ended. There is no rounding anywhere: "infeasible" comes
// with a combination of bounds that sums up to a contradiction.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace puppetri::proof {

class Meter;

class LinearProgram {
 public:
    enum class Answer : std::uint8_t {
        kFeasible,
        kInfeasible,
        kUnbounded,  // of maximize
        kGaveUp,     // a number passed 63 bits, or the pivots allowed are used up
    };
    struct Term {
        std::uint32_t variable = 0;
        std::int64_t factor = 1;
    };
    // A part of a contradiction: `factor` (above 0) times the bound of a variable.
    struct Reason {
        std::uint32_t variable = 0;
        bool upper = false;
        std::int64_t factor = 1;
    };

    LinearProgram();
    ~LinearProgram();
    LinearProgram(LinearProgram&&) noexcept;
    LinearProgram& operator=(LinearProgram&&) noexcept;

    // A new variable without bounds.
    std::uint32_t variable();
    // A new variable that equals a sum of earlier ones.
    std::uint32_t sum(std::span<const Term> terms);

    // Tightens a bound; a weaker one than there is changes nothing.
    void at_least(std::uint32_t variable, std::int64_t limit);
    void at_most(std::uint32_t variable, std::int64_t limit);
    // A bound that no pop forgets.
    void at_least_always(std::uint32_t variable, std::int64_t limit);
    // Bounds since the last push are forgotten by pop.
    void push();
    void pop();

    // Are there rationals within all bounds?
    // Cost    `pivots` at most, each about the number of entries of the tableau.
    Answer solve(std::uint64_t pivots);
    // A number did not fit: every answer from now on is kGaveUp.
    bool overflowed() const;
    // After kInfeasible: bounds that exclude each other, with the factors that show it.
    const std::vector<Reason>& reasons() const;
    // After kFeasible: the value found is numerator / denominator (above 0).
    struct Value {
        std::int64_t numerator = 0, denominator = 1;
        std::int64_t floor() const {
            return numerator / denominator - (numerator % denominator != 0 && numerator < 0);
        }
    };
    Value value(std::uint32_t variable) const;

    // The greatest value of a variable within all bounds; `best` is it, if kFeasible.
    Answer maximize(std::uint32_t variable, std::uint64_t pivots, Value& best);

 private:
    struct Tableau;
    std::unique_ptr<Tableau> tableau_;
};

// Are there rationals within all bounds? "no" also when the budget or the numbers' size do not let
// it be known.
bool is_feasible(LinearProgram& program, Meter& meter);

}  // namespace puppetri::proof
