// SPDX-License-Identifier: MIT
// Movements that a file defines: `movement nod(me: actor) { ... }`. What `does` may call beside the
// library, with the same signatures and the same errors.
#include <algorithm>

#include "formula_block.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

using motion::ParameterType;

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

}  // namespace

const figure::DofSet& mannequin_dofs() {
    static const figure::DofSet dofs = figure::humanoid_dofs(figure::make_mannequin(1.75));
    return dofs;
}

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

// A clip of somebody else: of no humanoid, or of joints that a creature does not have.
void Elaboration::check_clip_call(const OwnDefinition& definition, const motion::BoundCall& call,
                                  lang::Span where) {
    if (!call.subject.actor.valid()) {
        return;
    }
    const stage::Actor& actor = scene.play.cast.actors[call.subject.actor.value];
    const std::string& clip = definition.block->name.text;
    if (actor.humanoid()) {
        static const figure::Figure figure = figure::make_mannequin(1.75);
        if (definition.clip->plays_on(figure)) {
            return;
        }
        const bool no_skeleton = definition.no_humanoid.empty();
        const Diagnostic* why = no_skeleton ? nullptr : &definition.no_humanoid.front();
        error("nothing-moves", where,
              why == nullptr ? "the clip " + clip + " moves nothing that a humanoid has"
                             : "the clip " + clip + " is of no humanoid: " + why->element + ": " +
                                   why->message,
              "let a `creature` with joints of its names do it; look at them with `puppetri clip`");
        return;
    }
    const figure::Figure figure = actor.character->moved_figure();
    if (!definition.clip->plays_on(figure)) {
        std::string some;
        for (std::size_t i = 1; i < figure.skeleton.joints.size() && i <= 6; ++i) {
            some += (i > 1 ? ", " : "") + figure.skeleton.joints[i].name;
        }
        error("nothing-moves", where,
              "the clip " + clip + " moves no joint of " + actor.name + ", a creature",
              "its joints are " + some + (figure.skeleton.joints.size() > 7 ? ", ..." : "") +
                  "; name the tracks so");
    }
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
    if (definition.clip != nullptr) {
        check_clip_call(definition, call, where);
        return;
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
