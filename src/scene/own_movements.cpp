// SPDX-License-Identifier: MIT
// Movements that a file defines: `movement nod(me: actor) { ... }`. What `does` may call beside the
// library, with the same signatures and the same errors.
#include <algorithm>
#include <limits>

#include "elaboration.h"
#include "formula_compiler.h"
#include "puppetri/lang/units.h"
#include "puppetri/motion/formula_movement.h"

namespace puppetri::scene {

using motion::Limb;
using motion::ParameterType;
using motion::PathSpace;

namespace {

struct NamedType {
    const char* name;
    ParameterType type;
    lang::Dimension dimension;
};
constexpr NamedType kTypes[] = {
    {"actor", ParameterType::kActor, {}},
    {"angle", ParameterType::kAngle, lang::dimension::kAngle},
    {"bool", ParameterType::kBool, {}},
    {"int", ParameterType::kInt, {}},
    {"length", ParameterType::kLength, lang::dimension::kLength},
    {"point", ParameterType::kPoint, {}},
    {"prop", ParameterType::kProp, {}},
    {"real", ParameterType::kReal, {}},
    {"side", ParameterType::kSide, {}},
    {"time", ParameterType::kTime, lang::dimension::kTime},
};

bool is_thing(ParameterType type) {
    return type == ParameterType::kActor || type == ParameterType::kProp ||
           type == ParameterType::kPoint;
}

struct NamedEnd {
    const char* name;
    Limb limb;
    PathSpace space;
};
constexpr NamedEnd kEnds[] = {
    {"left_foot", Limb::kLeftLeg, PathSpace::kStart},
    {"left_hand", Limb::kLeftArm, PathSpace::kChest},
    {"pelvis", Limb::kPelvis, PathSpace::kStart},
    {"right_foot", Limb::kRightLeg, PathSpace::kStart},
    {"right_hand", Limb::kRightArm, PathSpace::kChest},
};

const figure::DofSet& mannequin_dofs() {
    static const figure::DofSet dofs = figure::humanoid_dofs(figure::make_mannequin(1.75));
    return dofs;
}

bool is_word(const lang::Expr& e, std::string_view word) {
    return e.kind == lang::ExprKind::kPath && e.path.steps.size() == 1 &&
           e.path.steps[0].text == word;
}
bool is_symbol(const lang::Expr& e, std::string_view text) {
    return e.kind == lang::ExprKind::kSymbol && e.text == text;
}

}  // namespace

// A block `movement` or `keyframes`, on its way to a definition. Both know formulas and keys.
class FormulaBlock {
 public:
    FormulaBlock(Elaboration& elaboration, const lang::Block& block)
        : e_(elaboration), block_(block), compiler_(elaboration, formula_) {
        formula_.spec.name = block.name.text;
        signature_.name = block.name.text;
    }

    OwnDefinition define() {
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
        const bool good = std::none_of(
            e_.diagnostics.begin() + static_cast<std::ptrdiff_t>(before), e_.diagnostics.end(),
            [](const Diagnostic& d) { return d.severity == Severity::kError; });
        OwnDefinition out{.block = &block_};
        for (const auto& event : formula_.spec.events) {
            out.events.push_back(event.name);
        }
        if (!good) {
            return out;
        }
        formula_.spec.reached_s = first_keys_s();
        out.limbs_of_definition(signature_, formula_.spec);
        out.dof_spans = std::move(dof_spans_);
        const std::vector<std::string> dofs = formula_.spec.dofs;
        auto maker = std::make_shared<const motion::FormulaMaker>(std::move(formula_));
        out.dofs = dofs;
        out.formula = maker;
        out.movement = std::make_shared<const motion::OwnMovement>(std::move(signature_), maker);
        return out;
    }

 private:
    void read(const lang::Property& p) {
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
                       {"takes", "at", "interpolation", "loop",
                        (me_.empty() ? "me" : me_) + ".head.flex"});
        }
    }

    // When the first keys come, if all that it drives has keys and none at the begin.
    double first_keys_s() const {
        double first = std::numeric_limits<double>::infinity();
        for (const auto* lists : {&formula_.dof_keys, &formula_.path_keys}) {
            for (const std::vector<motion::FormulaKey>& keys : *lists) {
                first = std::fmin(first, keys.empty() ? 0 : keys.front().t_s);
            }
        }
        return std::isfinite(first) ? first : 0;
    }

    void form(const lang::Property& p, const std::string& example) {
        e_.error("wrong-property", p.span, lang::to_text(p.name) + " is not written like this",
                 "write `" + example + "`");
    }

    // at 0.5 s: me.left_elbow.flex = 20 deg; at 0.5 s linear: ...; at 0.5 s raises clap. Further
    // keys of the same instant follow as properties of their own, behind commas.
    void at(const lang::Property& p) {
        key_at_.reset();
        const auto colon = std::find_if(p.values.begin(), p.values.end(),
                                        [](const lang::Expr& e) { return is_symbol(e, ":"); });
        if (colon == p.values.end()) {
            event(p);
            return;
        }
        const auto before = static_cast<std::size_t>(colon - p.values.begin());
        if (before < 1 || before > 2 || before + 2 != p.values.size()) {
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
        const lang::Expr& value = p.values.back();
        if (value.kind != lang::ExprKind::kBinary || value.op != lang::Op::kEqual ||
            value.args.size() != 2 || value.args[0].value.kind != lang::ExprKind::kPath) {
            form(p, "at 0.5 s: " + me_ + ".left_elbow.flex = 20 deg");
            return;
        }
        key(value.args[0].value.path, value.args[1].value, p.span);
    }

    // How a key goes to the next one.
    struct Way {
        motion::Interpolation interpolation = motion::Interpolation::kCatmullRom;
        KeyShape shape;
        Easing easing;
    };

    Way way_of(const lang::Expr& e) {
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
            {"kochanek_bartels",
             Interpolation::kKochanekBartels,
             {"tension", "continuity", "bias"}},
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

    // One value at key_at_.
    void key(const lang::Path& target, const lang::Expr& value, lang::Span where) {
        const auto& steps = target.steps;
        if (steps[0].text != me_ || steps.size() < 2) {
            e_.error("wrong-subject", steps[0].span, "a movement moves its actor, " + me_,
                     "write `" + me_ + "." + steps.back().text + " = ...`");
            return;
        }
        std::string name;
        for (std::size_t i = 1; i < steps.size(); ++i) {
            name += (i > 1 ? "." : "") + steps[i].text;
        }
        compiler_.about(name);
        motion::FormulaKey made{.t_s = *key_at_,
                                .interpolation = key_way_.interpolation,
                                .shape = key_way_.shape,
                                .easing = key_way_.easing,
                                .where = e_.at(where)};
        compiler_.without_time(true);
        std::vector<motion::FormulaKey>* keys = nullptr;
        if (steps.size() == 3 && steps[2].text == "position") {
            const NamedEnd* end = end_of(steps[1]);
            const auto programs = end != nullptr ? compiler_.path(value) : std::nullopt;
            if (programs) {
                made.value = *programs;
                keys = path_keys({end->limb, end->space}, target.span);
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

    // The list of keys of a DOF; null (and told) where it has a formula.
    std::vector<motion::FormulaKey>* dof_keys(const std::string& name, lang::Span target,
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
    std::vector<motion::FormulaKey>* path_keys(motion::DrivenPath path, lang::Span target) {
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
            e_.error("name-twice", target, "it has a way already",
                     "write either a formula or keys");
            return nullptr;
        }
        return &formula_.path_keys[i];
    }

    // DOFs of other figures: what the formula gives says whether they turn or slide.
    std::optional<ProgramIndex> dof_program(const std::string& name, const lang::Expr& value) {
        const figure::DofIndex known = mannequin_dofs().find(name);
        if (known.valid()) {
            const bool slides = mannequin_dofs().dofs[known.value].kind == figure::DofKind::kSlide;
            return compiler_.program(value,
                                     slides ? lang::dimension::kLength : lang::dimension::kAngle);
        }
        return compiler_.program_of(value, lang::dimension::kAngle, lang::dimension::kLength);
    }

    const NamedEnd* end_of(const lang::Name& end) {
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

    // at 0.5 s raises clap
    void event(const lang::Property& p) {
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
            formula_.spec.events.push_back(
                {at->value, p.values[2].path.steps[0].text, Limb::kPelvis});
        }
    }

    // me.head.flex = ..., me.right_hand.position = (...) m in chest
    void drive(const lang::Property& p) {
        const auto& steps = p.name.steps;
        if (key_at_) {
            if (p.values.size() == 2 && is_symbol(p.values[0], "=")) {
                key(p.name, p.values[1], p.span);
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
        std::string name;
        for (std::size_t i = 1; i < steps.size(); ++i) {
            name += (i > 1 ? "." : "") + steps[i].text;
        }
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

    void path(const lang::Property& p, const lang::Name& end) {
        const NamedEnd* found = end_of(end);
        if (found == nullptr) {
            return;
        }
        motion::DrivenPath driven{found->limb, found->space};
        const bool hand = found->limb == Limb::kLeftArm || found->limb == Limb::kRightArm;
        if (p.values.size() == 4 && is_word(p.values[2], "in") &&
            p.values[3].kind == lang::ExprKind::kPath) {
            const std::string space = lang::to_text(p.values[3]);
            if (space == "world") {
                driven.space = PathSpace::kWorld;
            } else if (space == "start") {
                driven.space = PathSpace::kStart;
            } else if (space == "chest" && hand) {
                driven.space = PathSpace::kChest;
            } else {
                e_.unknown(p.values[3].span, "space", space,
                           hand ? std::vector<std::string>{"chest", "start", "world"}
                                : std::vector<std::string>{"start", "world"});
                return;
            }
        } else if (p.values.size() != 2) {
            form(p, lang::to_text(p.name) + " = (0.2, 0.3, 0.4) m in chest");
            return;
        }
        auto& paths = formula_.spec.paths;
        if (std::any_of(paths.begin(), paths.end(), [&](const motion::DrivenPath& other) {
                return other.limb == driven.limb;
            })) {
            e_.error("name-twice", p.name.span, end.text + " has a way already",
                     "write one way for it");
            return;
        }
        if (const auto programs = compiler_.path(p.values[1])) {
            paths.push_back(driven);
            formula_.paths.push_back(*programs);
            formula_.path_keys.emplace_back();
            formula_.path_where.push_back(e_.at(p.span));
        }
    }

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

void OwnDefinition::limbs_of_definition(motion::OwnSignature& signature,
                                        const motion::PosedSpec& spec) {
    static const figure::Figure figure = figure::make_mannequin(1.75);
    humanoid = std::all_of(spec.dofs.begin(), spec.dofs.end(), [](const std::string& name) {
        return mannequin_dofs().find(name).valid();
    });
    signature.limbs = humanoid ? motion::limbs_of(figure, spec) : motion::LimbSet{};
    signature.as_argument =
        signature.limbs.bits != 0 && motion::without(signature.limbs, motion::kBothArms).bits == 0;
}

std::string Elaboration::read_own_parameters(
    const lang::Block& block, motion::OwnSignature& signature,
    const std::function<void(const std::string&, ParameterType, lang::Dimension)>& add) {
    std::vector<std::string> types;
    for (const NamedType& t : kTypes) {
        types.emplace_back(t.name);
    }
    std::string me;
    std::set<std::string> names;
    for (const lang::Parameter& p : block.parameters) {
        const bool first = &p == &block.parameters.front();
        if (!names.insert(p.name.text).second) {
            error("name-twice", p.name.span, "two parameters are called " + p.name.text,
                  "rename one");
            continue;
        }
        const std::string written = p.type ? lang::to_text(p.type) : "";
        if (first) {
            if (written != "actor") {
                error("wrong-type", p.span, "the first parameter of a movement is who moves",
                      "write `" + block.kind.text + " " + block.name.text + "(me: actor)`");
            }
            me = p.name.text;
            continue;
        }
        std::optional<Number> standard;
        if (p.default_value) {
            const Term term = evaluate(p.default_value, {});
            if (const Number* n = std::get_if<Number>(&term)) {
                standard = *n;
            } else if (const bool* b = std::get_if<bool>(&term)) {
                standard = Number::whole(*b ? 1 : 0);
            } else if (const Word* w = std::get_if<Word>(&term);
                       w != nullptr && (w->text == "left" || w->text == "right")) {
                standard = Number::whole(w->text == "right" ? 1 : 0);
            } else if (!is_nothing(term)) {
                wrong(p.default_value.span, "a number", term);
            }
        }
        const NamedType* type = nullptr;
        for (const NamedType& t : kTypes) {
            const bool fits = written.empty() && standard && !is_thing(t.type) &&
                              t.type != ParameterType::kBool && t.type != ParameterType::kSide &&
                              t.type != ParameterType::kInt && t.dimension == standard->dimension;
            if (written == t.name || (type == nullptr && fits)) {
                type = &t;
            }
        }
        if (type == nullptr) {
            if (written.empty()) {
                error("unknown-type", p.span, "nothing says what " + p.name.text + " is",
                      "write its type or a default: `" + p.name.text + ": angle = 15 deg`");
            } else {
                unknown(p.type.span, "type", written, types);
            }
            continue;
        }
        if (standard && standard->dimension != type->dimension) {
            wrong(p.default_value.span, lang::to_text(type->dimension), Term{*standard});
            continue;
        }
        signature.parameters.push_back(
            {.name = p.name.text,
             .types = motion::TypeSet{}.with(type->type),
             .default_text = standard ? lang::to_text(p.default_value) : "",
             .default_value = standard ? standard->value : 0,
             .doc = "a parameter of " + block.name.text});
        add(p.name.text, type->type, type->dimension);
    }
    if (me.empty()) {
        error("no-subject", block.name.span, "it does not say who moves",
              "write `" + block.kind.text + " " + block.name.text + "(me: actor) { ... }`");
    }
    return me;
}

bool Elaboration::is_argument_movement(std::string_view name, std::uint32_t file) {
    if (const auto* m = motion::find_movement(name, motion::SubjectKind::kActor)) {
        return m->as_argument;
    }
    const OwnDefinition* own = own_movement(name, file);
    return own != nullptr && own->movement != nullptr && own->movement->signature().as_argument;
}

std::vector<std::string> Elaboration::own_movement_names(std::uint32_t file) const {
    std::vector<std::string> names;
    for (const auto& [text, d] : library_.visible[file]) {
        if (d.block != nullptr) {
            names.push_back(text);
        }
    }
    for (const motion::OwnMovementPtr& host : library_.movements) {
        names.emplace_back(host->signature().name);
    }
    return names;
}

const OwnDefinition* Elaboration::own_movement(std::string_view name, std::uint32_t file) {
    if (file >= library_.visible.size()) {
        return nullptr;
    }
    const auto found = library_.visible[file].find(std::string(name));
    if (found != library_.visible[file].end()) {
        return found->second.block != nullptr ? &define_movement(*found->second.block) : nullptr;
    }
    for (const motion::OwnMovementPtr& host : library_.movements) {
        if (host->signature().name == name) {
            OwnDefinition& definition = host_movements_[std::string(name)];
            definition.movement = host;
            return &definition;
        }
    }
    return nullptr;
}

const OwnDefinition& Elaboration::define_movement(const lang::Block& block) {
    const auto known = own_movements_.find(key(block.span));
    if (known != own_movements_.end()) {
        return known->second;
    }
    About about(*this, block.kind.text + " " + block.name.text, block.span);
    OwnDefinition made{.block = &block};
    const bool taken =
        std::any_of(motion::movement_library().begin(), motion::movement_library().end(),
                    [&](const motion::MovementSignature& m) { return m.name == block.name.text; });
    if (taken) {
        error("name-twice", block.name.span,
              "the library has a movement " + block.name.text + " already", "choose another name");
    } else if (block.name.text.empty()) {
        error("no-name", block.kind.span, "this movement has no name",
              "write `" + block.kind.text + " NAME(me: actor) { ... }`");
    } else {
        made = block.kind.text == "clip" ? define_clip(block) : FormulaBlock(*this, block).define();
    }
    const OwnDefinition& kept =
        own_movements_.emplace(key(block.span), std::move(made)).first->second;
    if (kept.movement != nullptr && kept.humanoid) {
        // Without arguments, where it needs none: so it is looked at even if nobody does it.
        const auto& parameters = kept.movement->signature().parameters;
        if (std::all_of(parameters.begin(), parameters.end(),
                        [](const motion::Parameter& p) { return !p.default_text.empty(); })) {
            motion::BoundCall call{.movement = block.name.text, .own = kept.movement};
            check_own_call(kept, call, block.name.span);
        }
    }
    return kept;
}

// What can be wrong with one call: DOFs that the figure lacks, poles, values out of range.
void Elaboration::check_own_call(const OwnDefinition& definition, const motion::BoundCall& call,
                                 lang::Span where) {
    const figure::DofSet* dofs = &mannequin_dofs();
    std::string who = "a mannequin";
    if (call.subject.actor.valid()) {
        const stage::Actor& actor = scene.play.cast.actors[call.subject.actor.value];
        who = actor.name;
        if (!actor.humanoid()) {
            dofs = &actor.character->dofs;
        }
    }
    bool missing = false;
    for (std::size_t i = 0; i < definition.dofs.size(); ++i) {
        if (!dofs->find(definition.dofs[i]).valid()) {
            std::vector<std::string> known;
            for (const figure::Dof& d : dofs->dofs) {
                known.push_back(d.name);
            }
            unknown(definition.dof_spans[i], "degree of freedom of " + who, definition.dofs[i],
                    known);
            missing = true;
        }
    }
    const bool late =
        std::any_of(call.arguments.begin(), call.arguments.end(), [](const motion::Argument& a) {
            return std::holds_alternative<motion::TokenAttribute>(a.value);
        });
    if (missing || definition.formula == nullptr) {
        return;
    }
    const motion::Arguments arguments(call, definition.movement->signature());
    if (!late && !definition.formula->takes(arguments).good) {
        error("out-of-range", where,
              definition.block->name.text + " would take no time, or too much",
              "a movement takes between a millisecond and a day");
        return;
    }
    if (late) {
        return;
    }
    for (Diagnostic& d : definition.formula->check(arguments, *dofs)) {
        const bool told =
            std::any_of(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& known) {
                return known.code == d.code && known.where == d.where;
            });
        if (d.where.file.empty()) {
            d.where = at(where);
        }
        if (!told) {
            diagnostics.push_back(std::move(d));
        }
    }
}

}  // namespace puppetri::scene
