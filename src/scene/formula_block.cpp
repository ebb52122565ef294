// SPDX-License-Identifier: MIT
// What a block says about its movement: how long, formulas, events, contacts.
#include "formula_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "puppetri/lang/units.h"

namespace puppetri::scene {

using motion::Limb;
using motion::ParameterType;
using motion::PathSpace;

FormulaBlock::FormulaBlock(Elaboration& elaboration, const lang::Block& block)
    : e_(elaboration), block_(block), compiler_(elaboration, formula_) {
    formula_.spec.name = block.name.text;
    signature_.name = block.name.text;
}

OwnDefinition FormulaBlock::define() {
    const std::size_t before = e_.diagnostics.size();
    me_ = e_.read_own_parameters(
        block_, signature_,
        [this](const std::string& name, ParameterType type, lang::Dimension dimension) {
            is_thing(type) ? compiler_.add_thing(name) : compiler_.add_number(name, dimension);
        });
    for (const lang::Property& p : block_.properties) {
        read(p);
    }
    if (!formula_.takes.valid()) {
        e_.error("no-duration", block_.name.span, "it does not say how long it takes",
                 "write `takes 1 s`");
    }
    if (formula_.spec.dofs.empty() && formula_.spec.paths.empty()) {
        e_.error("nothing-moves", block_.name.span, "it moves nothing",
                 "write `" + (me_.empty() ? "me" : me_) + ".head.flex = ...`");
    }
    check_rates();
    OwnDefinition out{.block = &block_};
    out.limbs_of_definition(signature_, formula_.spec);
    if (!out.humanoid && !formula_.spec.contacts.empty()) {
        e_.error("wrong-subject", block_.name.span, "contacts are of the feet of humanoids",
                 "remove them: of creatures nothing holds feet to the floor");
    }
    const bool good = std::none_of(
        e_.diagnostics.begin() + static_cast<std::ptrdiff_t>(before), e_.diagnostics.end(),
        [](const Diagnostic& d) { return d.severity == Severity::kError; });
    for (const auto& event : formula_.spec.events) {
        out.events.push_back(event.name);
    }
    if (!good) {
        return out;
    }
    formula_.spec.reached_s = first_keys_s();
    out.dof_spans = std::move(dof_spans_);
    const std::vector<std::string> dofs = formula_.spec.dofs;
    auto maker = std::make_shared<const motion::FormulaMaker>(std::move(formula_));
    out.dofs = dofs;
    out.formula = maker;
    out.movement = std::make_shared<const motion::OwnMovement>(std::move(signature_), maker);
    return out;
}

void FormulaBlock::read(const lang::Property& p) {
    const auto& steps = p.name.steps;
    if (steps.size() == 1) {
        key_at_.reset();
    }
    if (p.has_children) {
        e_.error("wrong-property", p.span, "nothing can stand in braces here",
                 "write one formula per line");
    } else if (steps.size() > 1) {
        drive(p);
    } else if (!p.values.empty() && is_symbol(p.values[0], "=")) {
        if (p.values.size() == 2) {
            compiler_.add_local(steps[0], p.values[1]);
        } else {
            form(p, "a = 15 deg");
        }
    } else if (steps[0].text == "takes") {
        if (p.values.size() == 1) {
            compiler_.about("takes");
            formula_.takes =
                compiler_.program(p.values[0], lang::dimension::kTime).value_or(formula_.takes);
        } else {
            form(p, "takes 1 s");
        }
    } else if (steps[0].text == "at") {
        at(p);
    } else if (steps[0].text == "contact") {
        contact(p);
    } else if (steps[0].text == "interpolation") {
        if (p.values.size() == 1) {
            way_ = way_of(p.values[0]);
        } else {
            form(p, "interpolation catmull_rom");
        }
    } else if (steps[0].text == "loop" && p.values.empty()) {
        formula_.spec.loops = true;
    } else {
        e_.unknown(p.name.span, "property of a movement", lang::to_text(p.name),
                   {"takes", "at", "interpolation", "loop", "contact",
                    (me_.empty() ? "me" : me_) + ".head.flex"});
    }
}

// When the first keys come, if all that it drives has keys and none at the begin.
double FormulaBlock::first_keys_s() const {
    double first = std::numeric_limits<double>::infinity();
    for (const auto* lists : {&formula_.dof_keys, &formula_.path_keys}) {
        for (const std::vector<motion::FormulaKey>& keys : *lists) {
            first = std::fmin(first, keys.empty() ? 0 : keys.front().t_s);
        }
    }
    return std::isfinite(first) ? first : 0;
}

void FormulaBlock::form(const lang::Property& p, const std::string& example) {
    e_.error("wrong-property", p.span, lang::to_text(p.name) + " is not written like this",
             "write `" + example + "`");
}

// DOFs of other figures: what the formula gives says whether they turn or slide.
std::optional<ProgramIndex> FormulaBlock::dof_program(const std::string& name,
                                                      const lang::Expr& value) {
    const figure::DofIndex known = mannequin_dofs().find(name);
    if (known.valid()) {
        const bool slides = mannequin_dofs().dofs[known.value].kind == figure::DofKind::kSlide;
        return compiler_.program(value,
                                 slides ? lang::dimension::kLength : lang::dimension::kAngle);
    }
    return compiler_.program_of(value, lang::dimension::kAngle, lang::dimension::kLength);
}

const FormulaBlock::NamedEnd* FormulaBlock::end_of(const lang::Name& end) {
    static constexpr NamedEnd kEnds[] = {
        {"left_foot", Limb::kLeftLeg, PathSpace::kStart},
        {"left_hand", Limb::kLeftArm, PathSpace::kChest},
        {"pelvis", Limb::kPelvis, PathSpace::kStart},
        {"right_foot", Limb::kRightLeg, PathSpace::kStart},
        {"right_hand", Limb::kRightArm, PathSpace::kChest},
    };
    std::vector<std::string> known;
    for (const NamedEnd& n : kEnds) {
        if (end.text == n.name) {
            return &n;
        }
        known.emplace_back(n.name);
    }
    e_.unknown(end.span, "hand or foot", end.text, known);
    return nullptr;
}

std::optional<PathSpace> FormulaBlock::space_of(const lang::Expr& e, Limb limb) {
    const bool hand = limb == Limb::kLeftArm || limb == Limb::kRightArm;
    const std::string space = e.kind == lang::ExprKind::kPath ? lang::to_text(e.path) : "";
    if (space == "world") {
        return PathSpace::kWorld;
    }
    if (space == "start") {
        return PathSpace::kStart;
    }
    if (space == "chest" && hand) {
        return PathSpace::kChest;
    }
    e_.unknown(e.span, "space", space,
               hand ? std::vector<std::string>{"chest", "start", "world"}
                    : std::vector<std::string>{"start", "world"});
    return std::nullopt;
}

// "head.flex" of `me.head.flex`.
std::string FormulaBlock::name_after_me(const lang::Path& path) const {
    std::string name;
    for (std::size_t i = 1; i < path.steps.size(); ++i) {
        name += (i > 1 ? "." : "") + path.steps[i].text;
    }
    return name;
}

// contact left_foot 0.1 s .. 0.6 s
void FormulaBlock::contact(const lang::Property& p) {
    if (p.values.size() != 2 || p.values[0].kind != lang::ExprKind::kPath ||
        p.values[1].kind != lang::ExprKind::kRange) {
        form(p, "contact left_foot 0 .. 0.4 s");
        return;
    }
    const std::string foot = lang::to_text(p.values[0].path);
    if (foot != "left_foot" && foot != "right_foot") {
        e_.unknown(p.values[0].span, "foot", foot, {"left_foot", "right_foot"});
        return;
    }
    const auto begin =
        e_.constant_number(p.values[1].args[0].value, {}, lang::dimension::kTime, "the beginning");
    const auto end =
        e_.constant_number(p.values[1].args[1].value, {}, lang::dimension::kTime, "the end");
    if (!begin || !end) {
        return;
    }
    if (!(begin->value >= 0 && begin->value < end->value)) {
        e_.error("out-of-range", p.values[1].span, "a contact begins at 0 s or later, and lasts",
                 "write `contact " + foot + " 0 .. 0.4 s`");
        return;
    }
    const motion::FootContact made{foot == "left_foot" ? motion::Side::kLeft : motion::Side::kRight,
                                   begin->value, end->value};
    for (const motion::FootContact& other : formula_.spec.contacts) {
        if (other.side == made.side && made.begin_s < other.end_s && other.begin_s < made.end_s) {
            e_.error("name-twice", p.values[1].span,
                     foot + " stands already for a part of that time",
                     "join the two contacts, or let one begin after the other");
            return;
        }
    }
    formula_.spec.contacts.push_back(made);
    formula_.contact_where.push_back(e_.at(p.span));
}

// at 0.5 s raises clap
void FormulaBlock::event(const lang::Property& p) {
    if (p.values.size() != 3 || !is_word(p.values[1], "raises") ||
        p.values[2].kind != lang::ExprKind::kPath || p.values[2].path.steps.size() != 1) {
        form(p, "at 0.5 s raises clap");
        return;
    }
    const auto at =
        e_.constant_number(p.values[0], {}, lang::dimension::kTime, "the time of an event");
    if (at && at->value < 0) {
        e_.error("negative-time", p.values[0].span, "a movement begins at 0 s",
                 "write a later time");
    } else if (at) {
        formula_.spec.events.push_back({at->value, p.values[2].path.steps[0].text, Limb::kPelvis});
    }
}

// me.head.flex = ..., me.right_hand.position = (...) m in chest
void FormulaBlock::drive(const lang::Property& p) {
    const auto& steps = p.name.steps;
    if (key_at_) {
        if (p.values.size() >= 2 && is_symbol(p.values[0], "=")) {
            key(p.name, p.values[1], std::span(p.values).subspan(2), p.span);
        } else {
            form(p, lang::to_text(p.name) + " = 20 deg");
        }
        return;
    }
    if (steps[0].text != me_) {
        e_.error("wrong-subject", steps[0].span,
                 "a movement moves its actor, " + (me_.empty() ? "its first parameter" : me_),
                 "write `" + me_ + "." + steps.back().text + " = ...`");
        return;
    }
    if (p.values.size() < 2 || !is_symbol(p.values[0], "=")) {
        form(p, lang::to_text(p.name) + " = 15 deg * sin(2*pi*t/1 s)");
        return;
    }
    const std::string name = name_after_me(p.name);
    compiler_.about(name);
    if (steps.size() == 3 && steps[2].text == "position") {
        path(p, steps[1]);
        return;
    }
    if (p.values.size() != 2) {
        form(p, lang::to_text(p.name) + " = 15 deg * sin(2*pi*t/1 s)");
        return;
    }
    auto& dofs = formula_.spec.dofs;
    if (std::find(dofs.begin(), dofs.end(), name) != dofs.end()) {
        e_.error("name-twice", p.name.span, name + " has a formula already",
                 "add the two in one formula");
        return;
    }
    if (const auto program = dof_program(name, p.values[1])) {
        dofs.push_back(name);
        dof_spans_.push_back(p.name.span);
        formula_.dofs.push_back(*program);
        formula_.dof_keys.emplace_back();
        formula_.dof_where.push_back(e_.at(p.span));
    }
}

void FormulaBlock::path(const lang::Property& p, const lang::Name& end) {
    const NamedEnd* found = end_of(end);
    if (found == nullptr) {
        return;
    }
    motion::DrivenPath driven{found->limb, found->space};
    if (p.values.size() == 4 && is_word(p.values[2], "in")) {
        const auto space = space_of(p.values[3], found->limb);
        if (!space) {
            return;
        }
        driven.space = *space;
    } else if (p.values.size() != 2) {
        form(p, lang::to_text(p.name) + " = (0.2, 0.3, 0.4) m in chest");
        return;
    }
    auto& paths = formula_.spec.paths;
    if (std::any_of(paths.begin(), paths.end(),
                    [&](const motion::DrivenPath& other) { return other.limb == driven.limb; })) {
        e_.error("name-twice", p.name.span, end.text + " has a way already",
                 "write one way for it");
        return;
    }
    if (const auto programs = compiler_.path(p.values[1], lang::dimension::kLength)) {
        paths.push_back(driven);
        formula_.paths.push_back(*programs);
        formula_.path_keys.emplace_back();
        formula_.path_where.push_back(e_.at(p.span));
    }
}

}  // namespace puppetri::scene
