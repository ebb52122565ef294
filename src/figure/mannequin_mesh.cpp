// SPDX-License-Identifier: MIT
// The mannequin's skin: contour the shape, cut it along the borders of the clothes, bind it to the
// joints.
#include "puppetri/figure/mannequin_mesh.h"

#include <algorithm>

#include "contour.h"
#include "mannequin_shape.h"
#include "puppetri/base/require.h"
#include "skin_weights.h"

namespace puppetri::figure {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Divides triangles so that no edge crosses a border of the clothes: vertices that are near to it
// slide onto it, edges that still cross it get a vertex there.
class Tailor {
 public:
    Tailor(Contour& body, const ImplicitShape& shape, const Landmarks& marks)
        : body_(body),
          shape_(shape),
          marks_(marks),
          zones_(body.triangles.size(), Zone::kShirt),
          assigned_(body.triangles.size(), 0) {
        for (int i = 0; i < shape.size(); ++i) {
            everything_.push_back(static_cast<std::uint16_t>(i));
        }
        locked_.assign(body.positions_model.size(), 0);
        for (int which = 0; which < kBorderCount; ++which) {
            cut(which, 0);
            if (which != 1) {
                // A second cut gives the thickness of the cloth its own strip of triangles.
                cut(which, zone_inside(which) == Zone::kHair ? kHem : -kHem);
            }
        }
    }

    const std::vector<Zone>& zones() const { return zones_; }

 private:
    static constexpr double kSnap =
        0.32;  // an edge is not cut nearer to its end than this; a vertex slides instead

    double value(int which, Vec3 p) const {
        return border_applies(marks_, which, p) ? border(marks_, which, p) : 1.0;
    }

    void onto_surface(std::uint32_t v) {
        for (int step = 0; step < 2; ++step) {
            const FieldSample f = shape_.sample(body_.positions_model[v], everything_);
            body_.positions_model[v] =
                body_.positions_model[v] -
                f.gradient * (f.distance / std::max(dot(f.gradient, f.gradient), 0.05));
            body_.normals_model[v] = normalized(f.gradient, {0, 1, 0});
        }
    }

    // Along the set where the border's function is `level`; level 0 also divides the zones.
    void cut(int which, double level) {
        auto& p = body_.positions_model;
        std::vector<double> g(p.size());
        for (std::size_t v = 0; v < p.size(); ++v) {
            g[v] = value(which, p[v]) - level;
        }
        // Slide: a vertex near to where its edges cross goes to the nearest crossing.
        shift_.assign(p.size(), 1e9);
        target_.resize(p.size());
        for_crossing_edges(g, [&](std::uint32_t from, std::uint32_t to, double t) {
            const Vec3 where = p[from] + (p[to] - p[from]) * t;
            const std::uint32_t v = t < kSnap ? from : t > 1 - kSnap ? to : kNone;
            if (v != kNone && !locked_[v] && length(where - p[v]) < shift_[v]) {
                shift_[v] = length(where - p[v]);
                target_[v] = where;
            }
        });
        for (std::uint32_t v = 0; v < p.size(); ++v) {
            if (shift_[v] < 1e9) {
                p[v] = target_[v];
                onto_surface(v);
                g[v] = 0;
                locked_[v] = 1;
            }
        }
        // Divide what still crosses.
        crossings_.clear();
        for_crossing_edges(g, [&](std::uint32_t from, std::uint32_t to, double t) {
            crossings_.push_back({from, to, static_cast<std::uint32_t>(p.size())});
            p.push_back(p[from] + (p[to] - p[from]) * t);
            body_.normals_model.push_back({});
            onto_surface(crossings_.back().middle);
            g.push_back(0);
            locked_.push_back(1);
        });
        std::sort(crossings_.begin(), crossings_.end());
        const std::size_t before = body_.triangles.size();
        for (std::size_t t = 0; t < before; ++t) {
            divide(t, g);
        }
        for (std::size_t t = 0; t < body_.triangles.size() && level == 0; ++t) {
            const auto& c = body_.triangles[t];
            // Vertices on the border say nothing; where all are, the middle decides.
            double sum = g[c[0]] + g[c[1]] + g[c[2]];
            if (sum == 0) {
                sum = value(which, (p[c[0]] + p[c[1]] + p[c[2]]) * (1.0 / 3));
            }
            if (sum < 0 && !assigned_[t]) {
                assigned_[t] = 1;
                zones_[t] = zone_inside(which);
            }
        }
    }

    static bool crosses(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

    // Each edge once (its other triangle has it the other way round): use(low vertex, high vertex,
    // share of the way).
    template <class Use>
    void for_crossing_edges(const std::vector<double>& g, Use&& use) {
        const std::size_t count = body_.triangles.size();
        for (std::size_t i = 0; i < count; ++i) {
            const auto t = body_.triangles[i];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t from = t[k], to = t[(k + 1) % 3];
                if (from < to && crosses(g[from], g[to])) {
                    use(from, to, g[from] / (g[from] - g[to]));
                }
            }
        }
    }

    void divide(std::size_t t, const std::vector<double>& g) {
        const auto c = body_.triangles[t];
        std::array<std::uint32_t, 3> m{kNone, kNone, kNone};  // m[k] on the edge c[k], c[k + 1]
        int crossed = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = c[k], b = c[(k + 1) % 3];
            if (crosses(g[a], g[b])) {
                const Crossing wanted{std::min(a, b), std::max(a, b), 0};
                m[k] = std::lower_bound(crossings_.begin(), crossings_.end(), wanted)->middle;
                ++crossed;
            }
        }
        const auto extra = [&](std::array<std::uint32_t, 3> triangle) {
            body_.triangles.push_back(triangle);
            zones_.push_back(zones_[t]);
            assigned_.push_back(assigned_[t]);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
            if (crossed == 1 && m[k] != kNone) {
                body_.triangles[t] = {c[k], m[k], c[last]};
                extra({m[k], c[next], c[last]});
                return;
            }
            if (crossed == 2 && m[k] == kNone) {  // the corner c[last] is cut off
                body_.triangles[t] = {c[last], m[last], m[next]};
                const auto& p = body_.positions_model;
                if (length(p[c[k]] - p[m[next]]) <= length(p[c[next]] - p[m[last]])) {
                    extra({c[k], c[next], m[next]});
                    extra({c[k], m[next], m[last]});
                } else {
                    extra({c[k], c[next], m[last]});
                    extra({c[next], m[next], m[last]});
                }
                return;
            }
        }
    }

    struct Crossing {
        std::uint32_t low, high, middle;  // the ends of the edge, the vertex on it
        bool operator<(const Crossing& o) const {
            return low != o.low ? low < o.low : high < o.high;
        }
    };

    Contour& body_;
    const ImplicitShape& shape_;
    const Landmarks& marks_;
    std::vector<Zone> zones_;
    std::vector<std::uint8_t> assigned_, locked_;  // per triangle; per vertex: it lies on a cut
    std::vector<std::uint16_t> everything_;
    std::vector<double> shift_;
    std::vector<Vec3> target_;
    std::vector<Crossing> crossings_;
};

std::array<float, 3> floats(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// In sharp creases (between fingers, behind the ears) triangles are too coarse to follow the
// function, and its gradient says little about them: there the normals lean to those of the
// triangles around.
void settle_normals(Contour& body) {
    std::vector<Vec3> around(body.positions_model.size());
    for (const auto& t : body.triangles) {
        const Vec3 a = body.positions_model[t[0]];
        const Vec3 n = cross(body.positions_model[t[1]] - a, body.positions_model[t[2]] - a);
        for (const std::uint32_t v : t) {
            around[v] = around[v] + n;
        }
    }
    for (std::size_t v = 0; v < around.size(); ++v) {
        const Vec3 n = normalized(around[v], body.normals_model[v]);
        const double agreement = std::clamp((dot(n, body.normals_model[v]) - 0.3) / 0.4, 0.0, 1.0);
        body.normals_model[v] = normalized(n + (body.normals_model[v] - n) * agreement, n);
    }
}

std::vector<Material> materials_of(const Palette& palette) {
    return {{"skin", palette.skin, 0.62f, 0},
            {"hair", palette.hair, 0.55f, 0},
            {"shirt", palette.main, 0.8f, 0},
            {"trousers", palette.second, 0.85f, 0},
            {"shoes", palette.accent, 0.5f, 0}};
}

}  // namespace

Mesh fit_mannequin_mesh(Mesh mesh, double ratio, const Palette& palette) {
    PUP_REQUIRE(ratio > 0);
    for (std::array<float, 3>& p : mesh.positions) {
        for (float& x : p) {
            x = static_cast<float>(x * ratio);
        }
    }
    mesh.materials = materials_of(palette);
    return mesh;
}

Mesh make_mannequin_mesh(const Skeleton& skeleton, const Palette& palette) {
    PUP_REQUIRE(skeleton.height_m > 0);
    const Landmarks marks = landmarks_of(skeleton);
    ImplicitShape shape = mannequin_shape(marks);
    shape.set_relief([](const void* context,
                        Vec3 p) { return relief(*static_cast<const Landmarks*>(context), p); },
                     &marks);
    const ContourGrid grid = mannequin_grid(marks);
    Contour body = contour(shape, grid);
    const Tailor tailor(body, shape, marks);
    settle_normals(body);
    const SkinWeights weights(skeleton, marks);

    Mesh mesh;
    mesh.materials = materials_of(palette);
    const std::size_t n = body.positions_model.size();
    mesh.positions.reserve(n);
    mesh.normals.reserve(n);
    mesh.joints.reserve(n);
    mesh.weights.reserve(n);
    for (std::size_t v = 0; v < n; ++v) {
        mesh.positions.push_back(floats(body.positions_model[v] * marks.scale));
        mesh.normals.push_back(floats(body.normals_model[v]));
        const SkinBinding b = weights.at(body.positions_model[v]);
        mesh.joints.push_back(b.joints);
        mesh.weights.push_back(b.weights);
    }
    mesh.triangles.reserve(body.triangles.size());
    for (std::uint32_t zone = 0; zone < kZoneCount; ++zone) {
        const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
        for (std::size_t t = 0; t < body.triangles.size(); ++t) {
            if (static_cast<std::uint32_t>(tailor.zones()[t]) == zone) {
                mesh.triangles.push_back(body.triangles[t]);
            }
        }
        const auto count = static_cast<std::uint32_t>(mesh.triangles.size()) - first;
        if (count > 0) {
            mesh.parts.push_back({zone, first, count});
        }
    }
    return mesh;
}

}  // namespace puppetri::figure
