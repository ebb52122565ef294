// SPDX-License-Identifier: MIT
// Keys: `at 0.5 s linear: me.left_elbow.flex = 20 deg`.
#include <algorithm>

#include "formula_block.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

// at 0.5 s: me.left_elbow.flex = 20 deg; at 0.5 s linear: ...; at 0.5 s raises clap. Further
// keys of the same instant follow as properties of their own, behind commas.
void FormulaBlock::at(const lang::Property& p) {
    key_at_.reset();
    const auto colon = std::find_if(p.values.begin(), p.values.end(),
                                    [](const lang::Expr& e) { return is_symbol(e, ":"); });
    if (colon == p.values.end()) {
        event(p);
        return;
    }
    const auto before = static_cast<std::size_t>(colon - p.values.begin());
    if (before < 1 || before > 2 || before + 2 > p.values.size()) {
        form(p, "at 0.5 s: " + me_ + ".left_elbow.flex = 20 deg");
        return;
    }
    const auto time =
        e_.constant_number(p.values[0], {}, lang::dimension::kTime, "the time of a key");
    if (!time) {
        return;
    }
    if (time->value < 0) {
        e_.error("negative-time", p.values[0].span, "a movement begins at 0 s",
                 "write a later time");
        return;
    }
    key_at_ = time->value;
    key_way_ = before == 2 ? way_of(p.values[1]) : way_;
    // `me.left_elbow.flex = 20 deg` reads as a comparison here.
    const lang::Expr& value = p.values[before + 1];
    if (value.kind != lang::ExprKind::kBinary || value.op != lang::Op::kEqual ||
        value.args.size() != 2 || value.args[0].value.kind != lang::ExprKind::kPath) {
        form(p, "at 0.5 s: " + me_ + ".left_elbow.flex = 20 deg");
        return;
    }
    key(value.args[0].value.path, value.args[1].value, std::span(p.values).subspan(before + 2),
        p.span);
}

FormulaBlock::Way FormulaBlock::way_of(const lang::Expr& e) {
    using motion::Interpolation;
    Way way;
    struct Kind {
        const char* name;
        Interpolation interpolation;
        std::vector<const char*> parameters;
    };
    static const Kind kKinds[] = {
        {"bezier", Interpolation::kBezier, {"x1", "y1", "x2", "y2"}},
        {"cardinal", Interpolation::kCardinal, {"tension"}},
        {"catmull_rom", Interpolation::kCatmullRom, {}},
        {"ease", Interpolation::kBezier, {}},
        {"hermite", Interpolation::kHermite, {}},
        {"kochanek_bartels", Interpolation::kKochanekBartels, {"tension", "continuity", "bias"}},
        {"linear", Interpolation::kLinear, {}},
        {"step", Interpolation::kStep, {}},
        {"tcb", Interpolation::kKochanekBartels, {"tension", "continuity", "bias"}},
    };
    const std::string name = lang::to_text(e.path);
    std::vector<std::string> known;
    const Kind* kind = nullptr;
    for (const Kind& k : kKinds) {
        known.emplace_back(k.name);
        kind = name == k.name ? &k : kind;
    }
    if (kind == nullptr) {
        e_.unknown(e.span, "interpolation", name.empty() ? lang::to_text(e) : name, known);
        return way;
    }
    way.interpolation = kind->interpolation;
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const lang::Argument& a = e.args[i];
        std::size_t which = i;
        if (!a.name.text.empty()) {
            which = static_cast<std::size_t>(
                std::find_if(kind->parameters.begin(), kind->parameters.end(),
                             [&](const char* p) { return a.name.text == p; }) -
                kind->parameters.begin());
        }
        if (which >= kind->parameters.size()) {
            e_.unknown(a.value.span, "parameter of " + name, a.name.text,
                       {kind->parameters.begin(), kind->parameters.end()});
            continue;
        }
        const std::string parameter = kind->parameters[which];
        const auto n = e_.constant_number(a.value, {}, lang::dimension::kNone, parameter);
        if (!n) {
            continue;
        }
        const bool x = parameter[0] == 'x';
        if (n->value < (x ? 0 : -10) || n->value > (x ? 1 : 10)) {
            e_.error("out-of-range", a.value.span,
                     parameter + (x ? " lies between 0 and 1" : " lies between -10 and 10"),
                     "choose another value");
            continue;
        }
        (parameter == "tension"      ? way.shape.tension
         : parameter == "continuity" ? way.shape.continuity
         : parameter == "bias"       ? way.shape.bias
         : parameter == "x1"         ? way.easing.x1
         : parameter == "y1"         ? way.easing.y1
         : parameter == "x2"         ? way.easing.x2
                                     : way.easing.y2) = n->value;
    }
    return way;
}

// One value at key_at_, and what stands behind it: `in world`, `rate(90 deg/s)`.
void FormulaBlock::key(const lang::Path& target, const lang::Expr& value,
                       std::span<const lang::Expr> more, lang::Span where) {
    const auto& steps = target.steps;
    if (steps[0].text != me_ || steps.size() < 2) {
        e_.error("wrong-subject", steps[0].span, "a movement moves its actor, " + me_,
                 "write `" + me_ + "." + steps.back().text + " = ...`");
        return;
    }
    const std::string name = name_after_me(target);
    const bool place = steps.size() == 3 && steps[2].text == "position";
    const NamedEnd* end = place ? end_of(steps[1]) : nullptr;
    if (place && end == nullptr) {
        return;
    }
    compiler_.about(name);
    motion::FormulaKey made{.t_s = *key_at_,
                            .interpolation = key_way_.interpolation,
                            .shape = key_way_.shape,
                            .easing = key_way_.easing,
                            .where = e_.at(where)};
    compiler_.without_time(true);
    bool good = true;
    std::optional<motion::PathSpace> space;
    for (; !more.empty() && good; more = more.subspan(1)) {
        const lang::Expr& e = more[0];
        if (place && is_word(e, "in") && more.size() > 1) {
            space = space_of(more[1], end->limb);
            good = space.has_value();
            more = more.subspan(1);
        } else if (e.kind == lang::ExprKind::kCall && lang::to_text(e.path) == "rate") {
            good = rates(e, name, place, made);
        } else {
            e_.error("wrong-property", e.span, "this means nothing behind the value of a key",
                     place ? "write `rate((0, 0.5, 0) m/s)` or `in world`, or put a comma before it"
                           : "write `rate(90 deg/s)`, or put a comma before it");
            good = false;
        }
    }
    std::vector<motion::FormulaKey>* keys = nullptr;
    if (!good) {
    } else if (place) {
        if (const auto programs = compiler_.path(value, lang::dimension::kLength)) {
            made.value = *programs;
            keys =
                path_keys({end->limb, space.value_or(end->space)}, space.has_value(), target.span);
        }
    } else if (const auto program = dof_program(name, value)) {
        made.value[0] = *program;
        keys = dof_keys(name, target.span, where);
    }
    compiler_.without_time(false);
    if (keys == nullptr) {
        return;
    }
    const auto after =
        std::lower_bound(keys->begin(), keys->end(), made.t_s,
                         [](const motion::FormulaKey& k, double t_s) { return k.t_s < t_s; });
    if (after != keys->end() && after->t_s == made.t_s) {
        e_.error("name-twice", target.span, name + " has a key at this time already",
                 "remove one of them");
        return;
    }
    keys->insert(after, std::move(made));
}

// rate(90 deg/s), or rate(in: 0 deg/s, out: 90 deg/s): how the curve arrives and leaves.
bool FormulaBlock::rates(const lang::Expr& e, const std::string& name, bool place,
                         motion::FormulaKey& key) {
    const auto programs =
        [&](const lang::Expr& value) -> std::optional<std::array<ProgramIndex, 3>> {
        if (place) {
            return compiler_.path(value, lang::dimension::kSpeed);
        }
        constexpr lang::Dimension kTurning{.time = -1, .angle = 1};
        const figure::DofIndex known = mannequin_dofs().find(name);
        const bool slides =
            known.valid() && mannequin_dofs().dofs[known.value].kind == figure::DofKind::kSlide;
        const auto one =
            compiler_.program_of(value, slides ? lang::dimension::kSpeed : kTurning,
                                 known.valid() && !slides ? kTurning : lang::dimension::kSpeed);
        return one ? std::optional(std::array<ProgramIndex, 3>{*one}) : std::nullopt;
    };
    bool in = false, out = false;
    for (const lang::Argument& a : e.args) {
        const bool arrives = a.name.text == "in", leaves = a.name.text == "out";
        const bool alone = a.name.text.empty() && e.args.size() == 1;
        if (!arrives && !leaves && !alone) {
            e_.unknown(a.value.span, "parameter of rate", a.name.text, {"in", "out"});
            return false;
        }
        if ((arrives && in) || (leaves && out)) {
            e_.error("name-twice", a.value.span, a.name.text + " is given twice", "remove one");
            return false;
        }
        const auto given = programs(a.value);
        if (!given) {
            return false;
        }
        if (arrives || alone) {
            key.in = *given;
            in = true;
        }
        if (leaves || alone) {
            key.out = *given;
            out = true;
        }
    }
    if (!in && !out) {
        e_.error("missing-argument", e.span, "no rate is given",
                 place ? "write `rate((0, 0.5, 0) m/s)`" : "write `rate(90 deg/s)`");
    }
    return in || out;
}

// A rate that no curve passes through would be lost in silence.
void FormulaBlock::check_rates() {
    using motion::Interpolation;
    for (const auto* tracks : {&formula_.dof_keys, &formula_.path_keys}) {
        for (const std::vector<motion::FormulaKey>& keys : *tracks) {
            for (std::size_t i = 0; i < keys.size(); ++i) {
                const bool arrives = i > 0 && keys[i - 1].interpolation == Interpolation::kHermite;
                const bool leaves =
                    i + 1 < keys.size() && keys[i].interpolation == Interpolation::kHermite;
                if ((keys[i].in[0].valid() || keys[i].out[0].valid()) && !arrives && !leaves) {
                    e_.diagnostics.push_back(
                        {Severity::kError, "rate-unused", keys[i].where, e_.element_,
                         "this key has a rate, and no curve beside it follows rates",
                         "write `interpolation hermite` before the keys"});
                }
            }
        }
    }
}

// The list of keys of a DOF; null (and told) where it has a formula.
std::vector<motion::FormulaKey>* FormulaBlock::dof_keys(const std::string& name, lang::Span target,
                                                        lang::Span where) {
    auto& dofs = formula_.spec.dofs;
    const auto found = std::find(dofs.begin(), dofs.end(), name);
    const auto i = static_cast<std::size_t>(found - dofs.begin());
    if (found == dofs.end()) {
        dofs.push_back(name);
        dof_spans_.push_back(target);
        formula_.dofs.emplace_back();
        formula_.dof_keys.emplace_back();
        formula_.dof_where.push_back(e_.at(where));
    } else if (formula_.dof_keys[i].empty()) {
        e_.error("name-twice", target, name + " has a formula already",
                 "write either a formula or keys");
        return nullptr;
    }
    return &formula_.dof_keys[i];
}
std::vector<motion::FormulaKey>* FormulaBlock::path_keys(motion::DrivenPath path, bool says_space,
                                                         lang::Span target) {
    auto& paths = formula_.spec.paths;
    const auto found =
        std::find_if(paths.begin(), paths.end(),
                     [&](const motion::DrivenPath& other) { return other.limb == path.limb; });
    const auto i = static_cast<std::size_t>(found - paths.begin());
    if (found == paths.end()) {
        paths.push_back(path);
        formula_.paths.emplace_back();
        formula_.path_keys.emplace_back();
        formula_.path_where.push_back(e_.at(target));
    } else if (formula_.path_keys[i].empty()) {
        e_.error("name-twice", target, "it has a way already", "write either a formula or keys");
        return nullptr;
    } else if (says_space && found->space != path.space) {
        e_.error("wrong-type", target, "keys of one way are all in the same space",
                 "say the space at its first key only");
        return nullptr;
    }
    return &formula_.path_keys[i];
}

}  // namespace puppetri::scene
