// SPDX-License-Identifier: MIT
#include "puppetri/figure/linkage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "mesh_builder.h"
#include "puppetri/base/elementary.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

constexpr int kSectors = 16, kRings = 10;
constexpr std::uint32_t kMain = 0, kAccent = 1;
constexpr double kLeast_m = 1e-4;

bool finite(double v) { return std::isfinite(v) && std::fabs(v) < 1e6; }
bool finite(Vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }

// Where a link of Denavit and Hartenberg ends, seen from its joint.
Transform joint_from_end(const Link& link) {
    return link.dh
               ? Transform{{}, {link.dh->a_m, 0, 0}} * Transform{about_x(link.dh->alpha_rad), {}}
               : Transform{};
}

// z up, x ahead: columns are where the axes of the chain go.
Quat model_from_base() { return from_basis({0, 0, 1}, {1, 0, 0}, {0, 1, 0}); }

class Maker {
 public:
    Maker(std::span<const Link> links, const Palette& palette) : links_(links) {
        c_.mesh.materials = {{"links", palette.main, 0.5f, 0},
                             {"joints", palette.accent, 0.35f, 0}};
    }

    Checked<Character> make() {
        check();
        if (!defects_.empty()) {
            return Unexpected(std::move(defects_));
        }
        c_.skeleton.joints.push_back({"root", {}, {}, {}});
        for (const Link& link : links_) {
            add_joint(link);
        }
        for (std::size_t i = 0; i < links_.size(); ++i) {
            add_dofs(i);
        }
        model_.resize(c_.skeleton.joints.size());
        to_model_space(c_.skeleton, rest_pose(c_.skeleton), model_);
        for (std::size_t i = 0; i < links_.size(); ++i) {
            add_shapes(i);
        }
        sort_parts(c_.mesh);
        c_.limits.assign(c_.skeleton.joints.size(), {});
        double top = 0;
        for (const auto& p : c_.mesh.positions) {
            top = std::fmax(top, p[1]);
        }
        c_.skeleton.height_m = std::fmax(top, 0.01);
        return std::move(c_);
    }

 private:
    void defect(const char* code, const Link& link, std::string message, std::string remedy) {
        defects_.push_back({Severity::kError,
                            code,
                            {},
                            "link " + link.name,
                            std::move(message),
                            std::move(remedy)});
    }

    void check() {
        if (links_.empty()) {
            defects_.push_back({Severity::kError,
                                "no-links",
                                {},
                                "linkage",
                                "it has no links",
                                "give it at least one: `link base { box (0.2, 0.2, 0.2) m }`"});
        }
        std::set<std::string> names{"root"};
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const Link& link = links_[i];
            if (!names.insert(link.name).second) {
                defect("name-used-twice", link, "another link has this name", "rename one of them");
            }
            if (link.parent != Link::kBase && link.parent >= i) {
                defect("wrong-parent", link, "the link that it hangs from does not come before it",
                       "order the links from the root outwards");
            }
            const bool good_place = link.dh ? finite(link.dh->a_m) && finite(link.dh->alpha_rad) &&
                                                  finite(link.dh->d_m) && finite(link.dh->theta_rad)
                                            : finite(link.parent_from_joint.translation) &&
                                                  finite(link.parent_from_joint.rotation.w);
            if (!good_place) {
                defect("not-finite", link, "its place is no finite number", "give numbers");
            }
            check_dofs(link);
            for (const LinkShape& shape : link.shapes) {
                const Vec3 way = shape.to_joint - shape.at_joint;
                const bool box = shape.kind == LinkShape::Kind::kBox;
                const bool solid =
                    finite(shape.size_m) && finite(way) && shape.size_m.x >= kLeast_m &&
                    (!box || (shape.size_m.y >= kLeast_m && shape.size_m.z >= kLeast_m)) &&
                    (shape.kind != LinkShape::Kind::kBar || length(way) >= kLeast_m);
                if (!solid) {
                    defect("zero-length", link, "a shape of it has no size",
                           "give sizes of at least 0.1 mm, and a bar two different ends");
                }
            }
        }
    }

    void check_dofs(const Link& link) {
        std::set<std::string> names;
        for (const LinkDof& dof : link.dofs) {
            if (!names.insert(dof.name).second) {
                defect("name-used-twice", link, "it has two degrees of freedom " + dof.name,
                       "name them apart: `turns flex about x ...`");
            }
            if (!finite(dof.axis_joint) || length(dof.axis_joint) < 1e-9) {
                defect("bad-axis", link, "the axis of " + dof.name + " is zero",
                       "give a direction such as (0, 0, 1)");
            }
            if (!finite(dof.lo) || !finite(dof.hi) || dof.lo > dof.hi) {
                defect("min-above-max", link,
                       "the range of " + dof.name + " ends below where it begins",
                       "write the smaller value first: `turns -30 deg .. 60 deg`");
                continue;
            }
            const double rest = rest_of(link, dof);
            if (rest < dof.lo - 1e-9 || rest > dof.hi + 1e-9) {
                defect(
                    "rest-outside-range", link,
                    "its " + dof.name + " at rest is outside of its range",
                    link.dh ? "widen the range, or change theta or d" : "let the range contain 0");
            }
        }
        if (std::count_if(link.dofs.begin(), link.dofs.end(),
                          [](const LinkDof& d) { return d.kind == DofKind::kTurn; }) > 3) {
            defect("wrong-dofs", link, "it turns about more than three axes",
                   "divide it into two links");
        }
        if (link.dofs.size() > 6) {
            defect("wrong-dofs", link, "it has more than six degrees of freedom",
                   "divide it into two links");
        }
        if (link.dh && link.dofs.size() > 1) {
            defect("wrong-dofs", link, "a link with Denavit-Hartenberg parameters has one DOF",
                   "divide it into two links, or place it with `at`");
        }
    }

    static double rest_of(const Link& link, const LinkDof& dof) {
        return !link.dh ? 0 : dof.kind == DofKind::kTurn ? link.dh->theta_rad : link.dh->d_m;
    }

    void add_joint(const Link& link) {
        Transform rest = link.parent_from_joint;
        if (link.dh) {
            rest = {about_z(link.dh->theta_rad), {0, 0, link.dh->d_m}};
        }
        JointIndex parent{0};
        if (link.parent != Link::kBase) {
            parent = {link.parent + 1};
            rest = joint_from_end(links_[link.parent]) * rest;
        } else if (link.dh) {
            rest = Transform{model_from_base(), {}} * rest;
        }
        rest.rotation = normalized(rest.rotation);
        c_.skeleton.joints.push_back({link.name, parent, rest, joint_from_end(link).translation});
    }

    void add_dofs(std::size_t i) {
        for (const LinkDof& dof : links_[i].dofs) {
            c_.dofs.dofs.push_back({.name = links_[i].name + "." + dof.name,
                                    .joint = {static_cast<std::uint32_t>(i + 1)},
                                    .kind = dof.kind,
                                    .axis_joint = normalized(dof.axis_joint),
                                    .lo = dof.lo,
                                    .hi = dof.hi,
                                    .at_rest = rest_of(links_[i], dof)});
        }
    }

    // ---- what it looks like ----

    void add_shapes(std::size_t i) {
        const Link& link = links_[i];
        for (const LinkShape& shape : link.shapes) {
            const std::uint32_t material = shape.accent ? kAccent : kMain;
            if (shape.kind == LinkShape::Kind::kBar) {
                bar(i, shape.at_joint, shape.to_joint, shape.size_m.x, material);
            } else if (shape.kind == LinkShape::Kind::kBall) {
                ball(i, shape.at_joint, shape.size_m.x, material);
            } else {
                box(i, shape);
            }
        }
        if (link.shapes.empty()) {
            bare(i);
        }
    }

    // A link that says nothing of its looks: bars to what hangs on it.
    void bare(std::size_t i) {
        std::vector<Vec3> ends;
        for (std::size_t k = i + 1; k < links_.size(); ++k) {
            if (links_[k].parent == i) {
                ends.push_back(c_.skeleton.joints[k + 1].parent_from_joint_rest.translation);
            }
        }
        ends.push_back(c_.skeleton.joints[i + 1].end_site_joint);
        double longest = 0;
        for (const Vec3 end : ends) {
            longest = std::fmax(longest, length(end));
        }
        if (longest < kLeast_m) {
            return;
        }
        for (const Vec3 end : ends) {
            if (length(end) > 0.05 * longest) {
                bar(i, {}, end, 0.16 * longest, kMain);
            }
        }
        ball(i, {}, 0.22 * longest, kAccent);
    }

    void revolve(std::size_t i, std::span<const ProfilePoint> profile, const Transform& at,
                 std::uint32_t material) {
        const auto joint = static_cast<std::uint16_t>(i + 1);
        append_revolution(c_.mesh, profile, kSectors, model_[i + 1] * at, material, &joint);
    }

    void ball(std::size_t i, Vec3 at, double diameter_m, std::uint32_t material) {
        std::vector<ProfilePoint> profile;
        for (int k = 0; k <= kRings; ++k) {
            const double a = kPi * (static_cast<double>(k) / kRings - 0.5);
            const double c = k == 0 || k == kRings ? 0 : puppetri::cos(a), s = puppetri::sin(a);
            profile.push_back({diameter_m / 2 * c, diameter_m / 2 * s, c, s});
        }
        revolve(i, profile, {{}, at}, material);
    }

    // A round bar with rounded edges.
    void bar(std::size_t i, Vec3 from, Vec3 to, double diameter_m, std::uint32_t material) {
        const double r = diameter_m / 2, l = length(to - from), e = std::fmin(0.2 * r, 0.2 * l);
        const std::array<ProfilePoint, 6> profile{{{0, 0, 0, -1},
                                                   {r - e, 0, 0.3, -1},
                                                   {r, e, 1, -0.3},
                                                   {r, l - e, 1, 0.3},
                                                   {r - e, l, 0.3, 1},
                                                   {0, l, 0, 1}}};
        const Quat turned = shortest_arc({0, 1, 0}, (to - from) * (1 / l), {1, 0, 0});
        revolve(i, profile, {turned, from}, material);
    }

    void box(std::size_t i, const LinkShape& shape) {
        const Mesh box = make_box_mesh(shape.size_m, palettes().front());
        const auto first = static_cast<std::uint32_t>(c_.mesh.positions.size());
        const Transform at = model_[i + 1] * Transform{{}, shape.at_joint};
        const auto floats = [](Vec3 v) {
            return std::array<float, 3>{static_cast<float>(v.x), static_cast<float>(v.y),
                                        static_cast<float>(v.z)};
        };
        for (std::size_t v = 0; v < box.positions.size(); ++v) {
            const auto &p = box.positions[v], &n = box.normals[v];
            c_.mesh.positions.push_back(floats(at * Vec3{p[0], p[1], p[2]}));
            c_.mesh.normals.push_back(floats(rotate(at.rotation, {n[0], n[1], n[2]})));
            c_.mesh.joints.push_back({static_cast<std::uint16_t>(i + 1), 0, 0, 0});
            c_.mesh.weights.push_back({1, 0, 0, 0});
        }
        c_.mesh.parts.push_back({shape.accent ? kAccent : kMain,
                                 static_cast<std::uint32_t>(c_.mesh.triangles.size()),
                                 static_cast<std::uint32_t>(box.triangles.size())});
        for (const auto& t : box.triangles) {
            c_.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
    }

    std::span<const Link> links_;
    Character c_;
    std::vector<Transform> model_;
    Diagnostics defects_;
};

}  // namespace

Checked<Character> make_linkage(std::span<const Link> links, const Palette& palette) {
    return Maker(links, palette).make();
}

}  // namespace puppetri::figure
