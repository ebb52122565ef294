// SPDX-License-Identifier: MIT
// Movements by formula and by keyframes: the degrees of freedom of a figure, and the ways of its
// hands, feet and pelvis, each as an expression of the time or as keys whose values are expressions
// of the arguments. The scene compiles what its author wrote; here it is evaluated, and looked at
// for poles before it ever plays.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/expr.h"
#include "puppetri/motion/clip.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {

// What slots of the expressions stand for; every value is a real number in SI units.
enum class FormulaSlot : std::uint32_t {
    kTime,   // since the movement began, in its own seconds
    kInput,  // number in `inputs`
    kLocal,  // number in `locals`
};

// A number that is fixed when the movement begins: an argument, or a coordinate of where an actor
// or a prop that is an argument is then (an actor's: between its feet, on the floor).
struct FormulaInput {
    std::string parameter;
    int coordinate = -1;  // 0 x, 1 y, 2 z; -1: the argument is a number itself
};

// An expression that must not be 0 (`zero`), or must not fall below 0, for a formula to have a
// value: a divisor, the argument of a logarithm or a root.
struct FormulaDanger {
    ProgramIndex program;
    bool negative = false;  // below 0 is wrong, 0 itself is not
    std::string element;    // "head.flex": whose formula it is
    SourceSpan where;
    std::string what;  // "it divides by `t - 0.5 s`"
};

// A key of one DOF (then only value[0] counts) or of one path.
struct FormulaKey {
    double t_s = 0;
    std::array<ProgramIndex, 3> value;
    std::array<ProgramIndex, 3> in, out;  // kHermite: rates per second; not valid: 0
    Interpolation interpolation = Interpolation::kCatmullRom;
    KeyShape shape;
    Easing easing;
    SourceSpan where;
};

struct FormulaMovement {
    PosedSpec spec;  // duration_s is that of `takes` for a call
    Code code;
    ProgramIndex takes;
    std::vector<FormulaInput> inputs;
    std::vector<ProgramIndex> locals;                // each may read those before it
    std::vector<ProgramIndex> dofs;                  // of spec.dofs
    std::vector<std::array<ProgramIndex, 3>> paths;  // of spec.paths
    // By DOF and by path, ordered by time; where there are keys, the formula above is not valid.
    std::vector<std::vector<FormulaKey>> dof_keys, path_keys;
    std::vector<FormulaDanger> dangers;
    std::vector<SourceSpan> dof_where, path_where, contact_where;
};

class FormulaMaker final : public MovementMaker {
 public:
    explicit FormulaMaker(FormulaMovement formula);

    MovementPtr make(const OwnCall& call) const override;
    DurationRange declared(const Arguments& arguments) const override;

    // The duration of a call, or why it has none.
    struct Takes {
        double seconds = 0;
        bool good = false;  // finite, and between a millisecond and a day
    };
    Takes takes(const Arguments& arguments) const;

    // All that is wrong with a call before anything moves: poles ("formula-pole"), values that are
    // no numbers ("not-a-number"), keys and contacts after the end ("key-after-end"), values out of
    // a DOF's range ("out-of-range", a warning). Inputs that are places of things are taken as at
    // (1, 1, 1) m, once more at (0.3, 0.2, -1) m. Cost    about a millisecond.
    Diagnostics check(const Arguments& arguments, const figure::DofSet& dofs) const;

    const FormulaMovement& formula() const { return *formula_; }

 private:
    std::vector<double> inputs_of(const Arguments& arguments, const Surroundings* around,
                                  Vec3 stand_in) const;

    std::shared_ptr<const FormulaMovement> formula_;
};

}  // namespace puppetri::motion
