// SPDX-License-Identifier: MIT
// Characters and creatures of the cast: figures out of files, which the file source reads.
#include "elaboration.h"
#include "puppetri/figure/character.h"

namespace puppetri::scene {
// How a cast without files stands in for one that could not be read: nothing is performed with it,
// but what else is wrong with the scene is found.
std::shared_ptr<const figure::Character> Elaboration::stand_in_character() {
    figure::Character c;
    const figure::Figure f = figure::make_mannequin(1.75);
    c.skeleton = f.skeleton;
    c.limits = f.limits;
    c.humanoid = figure::Humanoid{f, {}};
    c.dofs = figure::humanoid_dofs(f);
    return std::make_shared<const figure::Character>(std::move(c));
}

// bones { hips: "Armature_Hips", left_knee: "shin.L" }
std::vector<NamedBone> Elaboration::bones_of(const lang::Property& property) {
    std::vector<NamedBone> bones;
    if (!property.values.empty() || !property.has_children) {
        error("wrong-property", property.span, "bones is not written like this",
              "write `bones { hips: \"Armature_Hips\", left_knee: \"shin.L\" }`");
        return bones;
    }
    for (const lang::Property& p : property.children) {
        const bool good = p.values.size() == 2 && !p.has_children &&
                          p.values[0].kind == lang::ExprKind::kSymbol && p.values[0].text == ":" &&
                          p.values[1].kind == lang::ExprKind::kString;
        if (!good) {
            error("wrong-property", p.span, "a bone is not written like this",
                  "write the joint of the file in quotes: `hips: \"Armature_Hips\"`");
            continue;
        }
        bones.push_back({lang::to_text(p.name), p.values[1].text, at(p.span)});
    }
    return bones;
}

void Elaboration::fill_character(const lang::CastMember& member, const Scope& scope,
                                 stage::Actor& actor) {
    CharacterRequest request;
    request.humanoid = member.kind.text == "character";
    const lang::Property* file = nullptr;
    for (const lang::Property& p : member.properties) {
        const std::string name = lang::to_text(p.name);
        if (place_figure(p, scope, actor)) {
            continue;
        }
        if (name == "file") {
            if (p.values.size() == 1 && p.values[0].kind == lang::ExprKind::kString) {
                file = &p;
            } else {
                error("wrong-property", p.span, "file is not written like this",
                      "write the path in quotes: `file \"CesiumMan.glb\"`");
                actor.character = stand_in_character();
                return;
            }
        } else if (name == "height") {
            request.height_m = quantity_of(p, scope, lang::dimension::kLength, "height 1.75 m");
            const double lo = request.humanoid ? 0.5 : 0.01, hi = request.humanoid ? 3 : 100;
            if (request.height_m && !(*request.height_m >= lo && *request.height_m <= hi)) {
                error("height-out-of-range", p.span,
                      request.humanoid ? "the height is not between 0.5 m and 3 m"
                                       : "the height is not between 1 cm and 100 m",
                      "give a height such as 1.75 m");
                request.height_m.reset();
            }
        } else if (name == "bones") {
            request.bones = bones_of(p);
        } else {
            unknown_property(p, {"file", "height", "at", "facing", "bones"});
        }
    }
    actor.character = stand_in_character();
    actor.height_m = 1.75;
    if (file == nullptr) {
        error("no-file", member.name.span, "nothing says what " + member.name.text + " looks like",
              "name a file: `file \"CesiumMan.glb\"`");
        return;
    }
    request.path = library_.source == nullptr
                       ? file->values[0].text
                       : library_.source->resolve(library_.files[member.span.file].filename,
                                                  file->values[0].text);
    About about(*this, member.kind.text + " " + member.name.text, file->span);
    load_character(member, request, actor);
}

void Elaboration::load_character(const lang::CastMember& member, CharacterRequest& request,
                                 stage::Actor& actor) {
    Assets* assets = library_.source == nullptr ? nullptr : library_.source->assets();
    const std::string who = member.kind.text + " " + member.name.text;
    if (assets == nullptr) {
        error("no-assets", member.name.span, "figures cannot be read from files here",
              "use the command line, or a mannequin");
        return;
    }
    Checked<LoadedCharacter> loaded = assets->character(request);
    Diagnostics& told = loaded ? loaded->notes : loaded.error();
    for (Diagnostic& d : told) {
        if (d.where.file.empty()) {
            d.where = at(member.name.span);
        }
        d.element = d.element.empty() ? who : who + ", " + d.element;
        diagnostics.push_back(std::move(d));
    }
    if (loaded) {
        actor.character = std::move(loaded->character);
        actor.height_m = actor.character->humanoid ? actor.character->humanoid->figure.height_m
                                                   : actor.character->skeleton.height_m;
    }
}

}  // namespace puppetri::scene
