// SPDX-License-Identifier: MIT
// Linkages of the cast: figures put together in the scene itself.
//   arm: linkage {
//     link base  { d 0.33 m, alpha 90 deg, turns -170 deg .. 170 deg }
//     link upper { a 0.4 m, theta 90 deg, turns 0 deg .. 150 deg }
//   }
#include "elaboration.h"
#include "puppetri/figure/linkage.h"
#include "puppetri/math/rotation.h"

namespace puppetri::scene {

using figure::Link;
using figure::LinkDof;
using figure::LinkShape;

namespace {

bool is_word(const lang::Expr& e, std::string_view word) {
    return e.kind == lang::ExprKind::kPath && lang::to_text(e) == word;
}

}  // namespace

// `turns LO .. HI about AXIS as NAME`, `slides LO .. HI along AXIS as NAME`; axis and name may be
// left out.
std::optional<LinkDof> Elaboration::link_dof(const lang::Property& p, const Scope& scope) {
    const bool turns = lang::to_text(p.name) == "turns";
    const char* form =
        turns ? "turns -30 deg .. 60 deg about x as flex" : "slides 0 m .. 0.3 m along x as reach";
    LinkDof dof;
    dof.kind = turns ? figure::DofKind::kTurn : figure::DofKind::kSlide;
    dof.name = turns ? "turn" : "slide";
    bool good = !p.values.empty() && !p.has_children && p.values.size() % 2 == 1 &&
                p.values[0].kind == lang::ExprKind::kRange && p.values[0].args.size() == 2;
    for (std::size_t i = 1; good && i + 1 < p.values.size(); i += 2) {
        const lang::Expr& what = p.values[i + 1];
        if (is_word(p.values[i], "as") && what.kind == lang::ExprKind::kPath) {
            dof.name = lang::to_text(what);
        } else if (is_word(p.values[i], turns ? "about" : "along")) {
            const std::string axis = lang::to_text(what);
            if (axis == "x" || axis == "y" || axis == "z") {
                dof.axis_joint = {axis == "x" ? 1.0 : 0.0, axis == "y" ? 1.0 : 0.0,
                                  axis == "z" ? 1.0 : 0.0};
            } else {
                const Term term = evaluate(what, scope);
                const auto* point = std::get_if<PointTerm>(&term);
                good = point != nullptr;
                if (good) {
                    dof.axis_joint = {point->at[0], point->at[1], point->at[2]};
                }
            }
        } else {
            good = false;
        }
    }
    if (!good) {
        error("wrong-property", p.span, lang::to_text(p.name) + " is not written like this",
              std::string("write `") + form + "`");
        return std::nullopt;
    }
    const lang::Dimension dimension = turns ? lang::dimension::kAngle : lang::dimension::kLength;
    const auto lo = constant_number(p.values[0].args[0].value, scope, dimension, "the lower end");
    const auto hi = constant_number(p.values[0].args[1].value, scope, dimension, "the upper end");
    if (!lo || !hi) {
        return std::nullopt;
    }
    dof.lo = lo->value;
    dof.hi = hi->value;
    return dof;
}

// `box (x, y, z) m`, `ball 10 cm`, or with more to say: `box { size (x, y, z) m, at (x, y, z) m,
// accent }`, `bar { diameter 4 cm, at (x, y, z) m, to (x, y, z) m }`.
std::optional<LinkShape> Elaboration::link_shape(const lang::Property& p, const Scope& scope) {
    const std::string kind = lang::to_text(p.name);
    LinkShape shape;
    shape.kind = kind == "box"    ? LinkShape::Kind::kBox
                 : kind == "ball" ? LinkShape::Kind::kBall
                                  : LinkShape::Kind::kBar;
    const bool box = shape.kind == LinkShape::Kind::kBox, bar = shape.kind == LinkShape::Kind::kBar;
    const auto size = [&](const lang::Expr& e) {
        if (box) {
            shape.size_m = point_of(e, scope).value_or(Vec3{});
        } else if (const auto d = constant_number(e, scope, lang::dimension::kLength, "diameter")) {
            shape.size_m.x = d->value;
        }
    };
    if (!p.has_children && p.values.size() == 1 && !bar) {
        size(p.values[0]);
        return shape;
    }
    if (!p.has_children || !p.values.empty()) {
        error("wrong-property", p.span, kind + " is not written like this",
              bar   ? "write `bar { diameter 4 cm, to (0, 0.4, 0) m }`"
              : box ? "write `box (0.2, 0.1, 0.3) m` or `box { size (0.2, 0.1, 0.3) m, at (0, 0.1, "
                      "0) m }`"
                    : "write `ball 10 cm` or `ball { diameter 10 cm, at (0, 0.1, 0) m }`");
        return std::nullopt;
    }
    for (const lang::Property& c : p.children) {
        const std::string name = lang::to_text(c.name);
        if (name == (box ? "size" : "diameter") && c.values.size() == 1) {
            size(c.values[0]);
        } else if (name == "at" && c.values.size() == 1) {
            shape.at_joint = point_of(c.values[0], scope).value_or(Vec3{});
        } else if (name == "to" && bar && c.values.size() == 1) {
            shape.to_joint = point_of(c.values[0], scope).value_or(Vec3{});
        } else if (name == "accent" && c.values.empty()) {
            shape.accent = true;
        } else {
            std::vector<std::string> known{box ? "size" : "diameter", "at", "accent"};
            if (bar) {
                known.emplace_back("to");
            }
            unknown_property(c, known);
        }
    }
    return shape;
}

std::optional<Link> Elaboration::link_of(const lang::Property& p, const Scope& scope,
                                         const std::vector<Link>& before) {
    if (p.values.size() != 1 || p.values[0].kind != lang::ExprKind::kPath) {
        error("wrong-property", p.span, "link is not written like this",
              "write `link upper { a 0.4 m, turns -90 deg .. 90 deg }`");
        return std::nullopt;
    }
    Link link;
    link.name = lang::to_text(p.values[0]);
    link.parent = before.empty() ? Link::kBase : static_cast<std::uint32_t>(before.size() - 1);
    figure::DhParameters dh;
    Vec3 place;
    double facing = 0, tilt = 0;
    bool has_dh = false, has_place = false;
    for (const lang::Property& c : p.children) {
        const std::string name = lang::to_text(c.name);
        const auto number = [&](double& out, lang::Dimension dimension, const char* form) {
            out = quantity_of(c, scope, dimension, form).value_or(0);
        };
        if (name == "a" || name == "d") {
            has_dh = true;
            number(name == "a" ? dh.a_m : dh.d_m, lang::dimension::kLength, "a 0.4 m");
        } else if (name == "alpha" || name == "theta") {
            has_dh = true;
            number(name == "alpha" ? dh.alpha_rad : dh.theta_rad, lang::dimension::kAngle,
                   "alpha 90 deg");
        } else if (name == "at") {
            has_place = true;
            if (has_values(c, 1, "at (0, 0.4, 0) m")) {
                place = point_of(c.values[0], scope).value_or(Vec3{});
            }
        } else if (name == "facing" || name == "tilted") {
            has_place = true;
            number(name == "facing" ? facing : tilt, lang::dimension::kAngle, "facing 45 deg");
        } else if (name == "on") {
            link.parent = Link::kBase;
            const std::string parent = c.values.size() == 1 ? lang::to_text(c.values[0]) : "";
            std::vector<std::string> known;
            for (std::uint32_t i = 0; i < before.size(); ++i) {
                known.push_back(before[i].name);
                link.parent = before[i].name == parent ? i : link.parent;
            }
            if (link.parent == Link::kBase && parent != "root") {
                unknown(c.span, "link before this one", parent, known);
            }
        } else if (name == "turns" || name == "slides") {
            if (auto dof = link_dof(c, scope)) {
                link.dofs.push_back(std::move(*dof));
            }
        } else if (name == "box" || name == "ball" || name == "bar") {
            if (const auto shape = link_shape(c, scope)) {
                link.shapes.push_back(*shape);
            }
        } else {
            unknown_property(c, {"a", "alpha", "d", "theta", "at", "facing", "tilted", "on",
                                 "turns", "slides", "box", "ball", "bar"});
        }
    }
    if (has_dh && has_place) {
        error("wrong-property", p.span,
              "a link has either Denavit-Hartenberg parameters or a place of its own",
              "leave out `at`, `facing` and `tilted`, or `a`, `alpha`, `d` and `theta`");
    }
    if (has_dh) {
        link.dh = dh;
    }
    link.parent_from_joint = {about_y(facing) * about_x(tilt), place};
    return link;
}

void Elaboration::fill_linkage(const lang::CastMember& member, const Scope& scope,
                               stage::Actor& actor) {
    std::vector<Link> links;
    std::map<std::string, lang::Span> where;
    bool whole = true;
    for (const lang::Property& p : member.properties) {
        const std::string name = lang::to_text(p.name);
        if (place_figure(p, scope, actor)) {
            continue;
        }
        if (name == "palette") {
            actor.palette = palette_of(p).value_or(actor.palette);
        } else if (name == "link") {
            auto link = link_of(p, scope, links);
            whole = whole && link.has_value();
            if (link) {
                where["link " + link->name] = p.span;  // of two with one name the second
                links.push_back(std::move(*link));
            }
        } else {
            unknown_property(p, {"link", "at", "facing", "palette"});
        }
    }
    actor.character = stand_in_character();
    const figure::Palette* palette = figure::find_palette(actor.palette);
    auto made =
        figure::make_linkage(links, palette != nullptr ? *palette : figure::palettes().front());
    if (!made) {
        for (Diagnostic& d : made.error()) {
            const auto link = where.find(d.element);
            d.where = at(link == where.end() ? member.name.span : link->second);
            d.element = member.kind.text + " " + member.name.text + ", " + d.element;
            if (whole) {
                diagnostics.push_back(std::move(d));
            }
        }
        return;
    }
    actor.height_m = made->skeleton.height_m;
    actor.character = std::make_shared<const figure::Character>(std::move(*made));
}

}  // namespace puppetri::scene
