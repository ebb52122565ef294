// SPDX-License-Identifier: MIT
// Formulas of movements: expressions of the time and of parameters, with units checked, compiled to
// code that the motion module evaluates. Every value is a real number in SI units; what has no
// value somewhere (a division by zero) is written down as a danger to look for.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elaboration.h"
#include "puppetri/motion/formula_movement.h"

namespace puppetri::scene {

// A compiled value with its unit. A plain 0 fits every unit.
struct Formula {
    Expr value;
    lang::Dimension dimension;
    bool zero = false;

    bool fits(lang::Dimension wanted) const { return zero || dimension == wanted; }
};
using Formula3 = std::array<Formula, 3>;

// Names that formulas know beside the time, parameters and parts: what a path or a call stands for.
class FormulaNames {
 public:
    enum class Found : std::uint8_t {
        kNo,     // nothing that it knows
        kYes,    // in `out`
        kWrong,  // something is wrong with it, and has been told
    };
    virtual ~FormulaNames() = default;
    virtual Found find(const lang::Expr& path, Formula& out) = 0;
    virtual Found call(const lang::Expr& call, Formula& out) = 0;
    virtual std::vector<std::string> names() const = 0;  // for proposals
};

class FormulaCompiler {
 public:
    // Compiles into `out`. Needs both to outlive it.
    FormulaCompiler(Elaboration& elaboration, motion::FormulaMovement& out)
        : e_(elaboration), out_(out) {}

    // Asked before anything else. Then radians count as numbers, as in physics: the rate of the
    // rate of an angle may be a length over a length and a time squared.
    void also_knows(FormulaNames* names) { names_ = names; }
    lang::Dimension counted(lang::Dimension d) const {
        d.angle = names_ != nullptr ? std::int8_t{0} : d.angle;
        return d;
    }

    // Parameters: a number of that dimension, or the place of a thing.
    void add_number(const std::string& name, lang::Dimension dimension);
    void add_thing(const std::string& name);
    // `name = EXPR`; told when the name is taken. Later formulas may read it.
    void add_local(const lang::Name& name, const lang::Expr& e);

    // Number and dimension of a local, where that is one and nothing was wrong with it.
    std::optional<std::pair<std::uint32_t, lang::Dimension>> local(std::string_view name) const;

    // The messages of what follows speak of this element, "head.flex".
    void about(std::string element) { element_ = std::move(element); }

    // None when something was wrong, which has been told.
    std::optional<Formula> number(const lang::Expr& e);
    std::optional<Formula3> point(const lang::Expr& e);
    // The same as programs, of the wanted dimension.
    std::optional<ProgramIndex> program(const lang::Expr& e, lang::Dimension wanted);
    // Of the first dimension, or of the other where the formula gives that.
    std::optional<ProgramIndex> program_of(const lang::Expr& e, lang::Dimension usual,
                                           lang::Dimension other);
    // Three coordinates of that dimension.
    std::optional<std::array<ProgramIndex, 3>> path(const lang::Expr& e, lang::Dimension wanted);
    // The values of keys do not depend on the time.
    void without_time(bool without) { without_time_ = without; }

    static Expr slot(motion::FormulaSlot kind, std::uint32_t index) {
        return Expr::slot({static_cast<std::uint32_t>(kind), index}, {ValueKind::kReal});
    }

 private:
    struct Guard {
        Expr condition;
        bool holds = true;
    };

    std::optional<Formula> name(const lang::Expr& e);
    std::optional<Formula> unary(const lang::Expr& e);
    std::optional<Formula> binary(const lang::Expr& e);
    std::optional<Formula> conditional(const lang::Expr& e);
    std::optional<Formula> call(const lang::Expr& e);
    std::optional<Formula> fold(const lang::Expr& e, Formula a, const lang::Expr& right, Formula b);
    std::optional<Formula> power(const lang::Expr& e, Formula a, const lang::Expr& right,
                                 Formula b);
    std::optional<Expr> truth(const lang::Expr& e);
    std::optional<Expr> apply(ExprOp op, std::vector<Expr> operands, const lang::Expr& e);
    std::optional<ProgramIndex> compiled(const Expr& value, const lang::Expr& e);
    bool is_point(const lang::Expr& e) const;
    bool same_unit(const lang::Expr& e, const Formula& a, const Formula& b);
    void danger(const Expr& value, bool negative, const lang::Expr& e, std::string what);

    Elaboration& e_;
    FormulaNames* names_ = nullptr;
    motion::FormulaMovement& out_;
    std::string element_;
    std::map<std::string, std::pair<std::uint32_t, lang::Dimension>, std::less<>> numbers_;
    std::map<std::string, std::uint32_t, std::less<>> things_;  // first of three inputs
    std::map<std::string, std::pair<std::uint32_t, lang::Dimension>, std::less<>> locals_;
    std::vector<Guard> guards_;  // of the branch that is being compiled
    int depth_ = 0;
    bool without_time_ = false;
};

}  // namespace puppetri::scene
