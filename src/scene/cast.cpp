// SPDX-License-Identifier: MIT
// The cast: actors, props and sets with their properties. The scene's own cast comes whole and in
// order; of an imported file comes what its nets name.
#include "elaboration.h"
#include "puppetri/figure/palette.h"
#include "puppetri/notation/notation.h"

namespace puppetri::scene {
namespace {

const lang::CastMember* find_member(const lang::File& file, std::string_view name) {
    for (const lang::CastMember& m : file.body.cast) {
        if (m.name.text == name) {
            return &m;
        }
    }
    return nullptr;
}

// What a prop is called, and how large it is when nothing is said.
struct PropKind {
    const char* name;
    stage::PropShape shape;
    Vec3 size_m;
};
constexpr PropKind kPropKinds[] = {
    {"sphere", stage::PropShape::kSphere, {0.22, 0.22, 0.22}},
    {"box", stage::PropShape::kBox, {0.22, 0.22, 0.22}},
    {"cylinder", stage::PropShape::kCylinder, {0.22, 0.03, 0.22}},
    {"fork", stage::PropShape::kFork, {0.026, 0.006, 0.19}},
};
const PropKind* prop_kind_named(std::string_view name) {
    for (const PropKind& kind : kPropKinds) {
        if (name == kind.name) {
            return &kind;
        }
    }
    return nullptr;
}

std::string name_of(const lang::Property& property) { return lang::to_text(property.name); }

}  // namespace

std::optional<Term> Elaboration::cast_member(std::string_view name, std::uint32_t file) {
    const auto known = cast_.find({file, std::string(name)});
    if (known != cast_.end()) {
        return known->second;
    }
    const lang::CastMember* member = find_member(library_.files[file], name);
    if (member == nullptr) {
        for (const std::uint32_t other : library_.casts[file]) {
            // Its own members, not those that it imports in turn: casts that import each other end.
            if (find_member(library_.files[other], name) != nullptr) {
                return cast_member(name, other);
            }
        }
        return std::nullopt;
    }
    cast_[{file, std::string(name)}] = Nothing{};  // whoever asks while it is being made has a ring
    About about(*this, member->kind.text + " " + member->name.text, member->span);
    Term made = add_cast_member(*member);
    cast_[{file, std::string(name)}] = made;
    return made;
}

Term Elaboration::add_cast_member(const lang::CastMember& member) {
    const std::string& name = member.name.text;
    const auto first = cast_where_.emplace(name, member.span);
    if (!first.second && first.first->second != member.span) {
        error("name-twice", member.name.span, "the cast already has a " + name,
              "rename one of them; also casts of imported files count");
        return Nothing{};
    }
    const std::string& kind = member.kind.text;
    // Properties speak of the file, not of a net.
    const Scope scope{};
    stage::Cast& cast = scene.play.cast;
    if (kind == "mannequin" || kind == "stick") {
        const motion::ActorIndex index{static_cast<std::uint32_t>(cast.actors.size())};
        stage::Actor actor{
            .name = name,
            .body = kind == "stick" ? stage::BodyKind::kStick : stage::BodyKind::kMannequin};
        cast.actors.push_back(actor);
        fill_figure(member, scope, actor);
        cast.actors[index.value] = std::move(actor);
        return ActorTerm{index};
    }
    if (kind == "character" || kind == "creature" || kind == "linkage") {
        const motion::ActorIndex index{static_cast<std::uint32_t>(cast.actors.size())};
        stage::Actor actor{.name = name, .body = stage::BodyKind::kCharacter};
        cast.actors.push_back(actor);
        if (kind == "linkage") {
            fill_linkage(member, scope, actor);
        } else {
            fill_character(member, scope, actor);
        }
        cast.actors[index.value] = std::move(actor);
        return ActorTerm{index};
    }
    if (const PropKind* prop_kind = prop_kind_named(kind)) {
        const motion::PropIndex index{static_cast<std::uint32_t>(cast.props.size())};
        stage::Prop prop{.name = name, .shape = prop_kind->shape, .size_m = prop_kind->size_m};
        cast.props.push_back(prop);
        fill_prop(member, scope, prop);
        cast.props[index.value] = std::move(prop);
        return PropTerm{index};
    }
    if (kind == "set") {
        const motion::SetIndex index{static_cast<std::uint32_t>(cast.sets.size())};
        stage::Set set{.name = name};
        cast.sets.push_back(set);
        fill_set(member, scope, set);
        cast.sets[index.value] = std::move(set);
        return SetTerm{index};
    }
    unknown(member.kind.span, "kind of cast", kind,
            {"mannequin", "stick", "character", "creature", "linkage", "sphere", "box", "cylinder",
             "fork", "set"});
    return Nothing{};
}

void Elaboration::unknown_property(const lang::Property& property,
                                   const std::vector<std::string>& known) {
    unknown(property.name.span, "property", name_of(property), known);
}

bool Elaboration::has_values(const lang::Property& property, std::size_t count, const char* form) {
    if (property.values.size() == count && !property.has_children) {
        return true;
    }
    error("wrong-property", property.span, name_of(property) + " is not written like this",
          std::string("write `") + form + "`");
    return false;
}

std::optional<double> Elaboration::quantity_of(const lang::Property& property, const Scope& scope,
                                               lang::Dimension dimension, const char* form) {
    if (!has_values(property, 1, form)) {
        return std::nullopt;
    }
    const auto n = constant_number(property.values[0], scope, dimension, name_of(property));
    return n ? std::optional(n->value) : std::nullopt;
}

std::optional<Vec3> Elaboration::point_of(const lang::Expr& value, const Scope& scope) {
    const Term term = evaluate(value, scope);
    if (const auto* p = std::get_if<PointTerm>(&term);
        p != nullptr && p->dimension == lang::dimension::kLength) {
        return Vec3{p->at[0], p->at[1], p->at[2]};
    }
    wrong(value.span, "a point", term, "write it as (x, y, z) m");
    return std::nullopt;
}

std::optional<std::string> Elaboration::palette_of(const lang::Property& property) {
    if (!has_values(property, 1, "palette teal")) {
        return std::nullopt;
    }
    const lang::Expr& value = property.values[0];
    const std::string name =
        value.kind == lang::ExprKind::kString ? value.text : lang::to_text(value);
    if (figure::find_palette(name) != nullptr) {
        return name;
    }
    std::vector<std::string> known;
    for (const figure::Palette& p : figure::palettes()) {
        known.emplace_back(p.name);
    }
    unknown(value.span, "palette", name, known);
    return std::nullopt;
}

bool Elaboration::place_figure(const lang::Property& p, const Scope& scope, stage::Actor& actor) {
    const std::string name = name_of(p);
    if (name == "facing") {
        actor.heading_rad = quantity_of(p, scope, lang::dimension::kAngle, "facing 90 deg")
                                .value_or(actor.heading_rad);
    } else if (name == "at") {
        if (has_values(p, 1, "at (0, 0, 0) m")) {
            actor.position_world = point_of(p.values[0], scope).value_or(actor.position_world);
        }
    } else {
        return false;
    }
    return true;
}

void Elaboration::fill_figure(const lang::CastMember& member, const Scope& scope,
                              stage::Actor& actor) {
    for (const lang::Property& p : member.properties) {
        const std::string name = name_of(p);
        if (place_figure(p, scope, actor)) {
            continue;
        }
        if (name == "height") {
            actor.height_m = quantity_of(p, scope, lang::dimension::kLength, "height 1.75 m")
                                 .value_or(actor.height_m);
        } else if (name == "palette") {
            actor.palette = palette_of(p).value_or(actor.palette);
        } else {
            unknown_property(p, {"height", "at", "facing", "palette"});
        }
    }
}

void Elaboration::fill_prop(const lang::CastMember& member, const Scope& scope, stage::Prop& prop) {
    const bool sphere = prop.shape == stage::PropShape::kSphere;
    const bool cylinder = prop.shape == stage::PropShape::kCylinder;
    for (const lang::Property& p : member.properties) {
        const std::string name = name_of(p);
        if (name == "diameter" && (sphere || cylinder)) {
            if (const auto d = quantity_of(p, scope, lang::dimension::kLength, "diameter 22 cm")) {
                prop.size_m = {*d, cylinder ? prop.size_m.y : *d, *d};
            }
        } else if (name == "height" && cylinder) {
            prop.size_m.y = quantity_of(p, scope, lang::dimension::kLength, "height 10 cm")
                                .value_or(prop.size_m.y);
        } else if (name == "facing") {
            prop.heading_rad = quantity_of(p, scope, lang::dimension::kAngle, "facing 90 deg")
                                   .value_or(prop.heading_rad);
        } else if (name == "size" && !sphere && !cylinder) {
            if (has_values(p, 1, "size (0.4, 0.3, 0.2) m")) {
                prop.size_m = point_of(p.values[0], scope).value_or(prop.size_m);
            }
        } else if (name == "mass") {
            prop.mass_kg =
                quantity_of(p, scope, lang::dimension::kMass, "mass 0.4 kg").value_or(prop.mass_kg);
        } else if (name == "at") {
            if (has_values(p, 1, "at (0, 0.11, 0) m")) {
                prop.position_world = point_of(p.values[0], scope).value_or(prop.position_world);
            }
        } else if (name == "held") {
            if (has_values(p, 2, "held by ana.hands")) {
                const Term holder = holder_actor(p.values[1], scope);
                if (const auto* actor = std::get_if<ActorTerm>(&holder)) {
                    prop.held_by = actor->actor;
                } else {
                    wrong(p.values[1].span, "the hands of an actor", holder,
                          "write `held by ana.hands`");
                }
            }
        } else if (name == "palette") {
            prop.palette = palette_of(p).value_or(prop.palette);
        } else {
            std::vector<std::string> known{"mass", "at", "facing", "held", "palette"};
            known.emplace_back(sphere || cylinder ? "diameter" : "size");
            if (cylinder) {
                known.emplace_back("height");
            }
            unknown_property(p, known);
        }
    }
}

// `ana.hands` or `ana`.
Term Elaboration::holder_actor(const lang::Expr& e, const Scope& scope) {
    if (e.kind == lang::ExprKind::kPath && e.path.steps.size() == 2 &&
        e.path.steps[1].text == "hands") {
        lang::Path who = e.path;
        who.steps.pop_back();
        who.span = who.steps[0].span;
        return resolve(who, scope);
    }
    return evaluate(e, scope);
}

void Elaboration::fill_set(const lang::CastMember& member, const Scope& scope, stage::Set& set) {
    for (const lang::Property& p : member.properties) {
        const std::string name = name_of(p);
        if (name == "model") {
            if (has_values(p, 1, "model road")) {
                const std::string model = lang::to_text(p.values[0]);
                if (model != "road" && model != "floor") {
                    unknown(p.values[0].span, "model of a set", model, {"floor", "road"});
                }
                set.kind = model == "road" ? stage::SetKind::kRoad : stage::SetKind::kFloor;
            }
        } else if (name == "length") {
            set.length_m = quantity_of(p, scope, lang::dimension::kLength, "length 60 m")
                               .value_or(set.length_m);
        } else if (name == "width") {
            set.width_m =
                quantity_of(p, scope, lang::dimension::kLength, "width 6 m").value_or(set.width_m);
        } else if (name == "facing") {
            set.direction_rad = quantity_of(p, scope, lang::dimension::kAngle, "facing 90 deg")
                                    .value_or(set.direction_rad);
        } else if (name == "at") {
            if (has_values(p, 1, "at (0, 0, 0) m")) {
                set.position_world = point_of(p.values[0], scope).value_or(set.position_world);
            }
        } else {
            unknown_property(p, {"model", "length", "width", "at", "facing"});
        }
    }
}

void Elaboration::complete_cast() {
    for (const lang::CastMember& member : library_.files[0].body.cast) {
        const auto first = cast_.find({0, member.name.text});
        if (first != cast_.end() && cast_where_[member.name.text] != member.span) {
            About about(*this, member.kind.text + " " + member.name.text, member.span);
            error("name-twice", member.name.span, "the cast already has a " + member.name.text,
                  "rename one of them");
            continue;
        }
        cast_member(member.name.text, 0);
    }
    for (const std::uint32_t other : library_.casts[0]) {
        for (const lang::CastMember& member : library_.files[other].body.cast) {
            cast_member(member.name.text, other);
        }
    }
}

void Elaboration::check_cast() {
    for (Diagnostic& d : stage::check(scene.play.cast)) {
        const auto where = cast_where_.find(d.element.substr(d.element.rfind(' ') + 1));
        d.where = where == cast_where_.end() ? SourceSpan{} : at(where->second);
        diagnostics.push_back(std::move(d));
    }
}

// camera main { at (0, 1.6, 8) m, looks at (0, 1, 0) m, keeps ana and rui in view, moves with them,
// opens 35 deg }
void Elaboration::add_camera(const lang::Block& block) {
    const Scope scope{.sees_all = true};
    Camera camera{.name = block.name.text.empty() ? "main" : block.name.text};
    for (const lang::Property& p : block.properties) {
        const std::string name = name_of(p);
        if (name == "at") {
            if (has_values(p, 1, "at (0, 1.6, 8) m")) {
                camera.at_world = point_of(p.values[0], scope).value_or(camera.at_world);
            }
        } else if (name == "looks") {
            if (has_values(p, 2, "looks at (0, 1, 0) m")) {
                camera.looking_at_world = point_of(p.values[1], scope);
            }
        } else if (name == "keeps") {
            if (has_values(p, 3, "keeps ana and rui in view")) {
                keep_in_view(p.values[0], scope, camera);
            }
        } else if (name == "moves") {
            if (has_values(p, 2, "moves with them")) {
                camera.moves_with_them = true;
            }
        } else if (name == "opens") {
            camera.fov_rad = quantity_of(p, scope, lang::dimension::kAngle, "opens 35 deg");
            if (camera.fov_rad && (*camera.fov_rad < 0.05 || *camera.fov_rad > 2.6)) {
                error("out-of-range", p.span, "a camera opens between 3 and 148 degrees",
                      "write `opens 35 deg`");
            }
        } else {
            unknown_property(p, {"at", "looks", "keeps", "moves", "opens"});
        }
    }
    scene.cameras.push_back(std::move(camera));
}

void Elaboration::keep_in_view(const lang::Expr& e, const Scope& scope, Camera& camera) {
    if (e.kind == lang::ExprKind::kBinary && e.op == lang::Op::kAnd) {
        for (const lang::Argument& a : e.args) {
            keep_in_view(a.value, scope, camera);
        }
        return;
    }
    const Term term = evaluate(e, scope);
    if (const auto* actor = std::get_if<ActorTerm>(&term)) {
        camera.keeps.push_back(actor->actor);
    } else {
        wrong(e.span, "an actor", term);
    }
}

void Elaboration::complete_blocks() {
    for (const auto& [block, scope] : blocks_) {
        About about(*this, block->kind.text + " " + block->name.text, block->span);
        if (block->kind.text == "camera") {
            add_camera(*block);
        } else if (is_movement_kind(block->kind.text)) {
            define_movement(*block);
        } else if (notation::find_notation(block->kind.text) == nullptr) {
            std::vector<std::string> known{"camera", "movement", "keyframes", "clip"};
            for (const notation::Notation& n : notation::notations()) {
                known.emplace_back(n.kind);
            }
            unknown(block->kind.span, "kind of block", block->kind.text, known);
        }
    }
}

}  // namespace puppetri::scene
