// SPDX-License-Identifier: MIT
// A block `movement` or `keyframes` on its way to a definition: both know formulas and keys.
// Formulas, events and contacts: formula_block.cpp; keys: formula_keys.cpp.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elaboration.h"
#include "formula_compiler.h"
#include "puppetri/motion/formula_movement.h"

namespace puppetri::scene {

// Degrees of freedom of humanoids: the same names for all.
const figure::DofSet& mannequin_dofs();

inline bool is_word(const lang::Expr& e, std::string_view word) {
    return e.kind == lang::ExprKind::kPath && e.path.steps.size() == 1 &&
           e.path.steps[0].text == word;
}
inline bool is_symbol(const lang::Expr& e, std::string_view text) {
    return e.kind == lang::ExprKind::kSymbol && e.text == text;
}
// An argument that is somewhere, and moves: formulas read its coordinates.
inline bool is_thing(motion::ParameterType type) {
    return type == motion::ParameterType::kActor || type == motion::ParameterType::kProp ||
           type == motion::ParameterType::kPoint;
}

class FormulaBlock {
 public:
    FormulaBlock(Elaboration& elaboration, const lang::Block& block);

    OwnDefinition define();

 private:
    struct NamedEnd;

    // How a key goes to the next one.
    struct Way {
        motion::Interpolation interpolation = motion::Interpolation::kCatmullRom;
        KeyShape shape;
        Easing easing;
    };

    void read(const lang::Property& p);
    void form(const lang::Property& p, const std::string& example);
    void event(const lang::Property& p);
    void contact(const lang::Property& p);
    void drive(const lang::Property& p);
    void path(const lang::Property& p, const lang::Name& end);
    double first_keys_s() const;
    std::string name_after_me(const lang::Path& path) const;
    std::optional<motion::PathSpace> space_of(const lang::Expr& e, motion::Limb limb);
    const NamedEnd* end_of(const lang::Name& end);
    std::optional<ProgramIndex> dof_program(const std::string& name, const lang::Expr& value);

    // formula_keys.cpp
    void at(const lang::Property& p);
    Way way_of(const lang::Expr& e);
    void key(const lang::Path& target, const lang::Expr& value, std::span<const lang::Expr> more,
             lang::Span where);
    bool rates(const lang::Expr& e, const std::string& name, bool place, motion::FormulaKey& key);
    std::vector<motion::FormulaKey>* dof_keys(const std::string& name, lang::Span target,
                                              lang::Span where);
    std::vector<motion::FormulaKey>* path_keys(motion::DrivenPath path, bool says_space,
                                               lang::Span target);
    void check_rates();

    Elaboration& e_;
    const lang::Block& block_;
    motion::OwnSignature signature_;
    motion::FormulaMovement formula_;
    FormulaCompiler compiler_;
    std::string me_;
    std::vector<lang::Span> dof_spans_;
    std::optional<double> key_at_;  // while keys of one instant are read
    Way way_, key_way_;
};

struct FormulaBlock::NamedEnd {
    const char* name;
    motion::Limb limb;
    motion::PathSpace space;
};

}  // namespace puppetri::scene
