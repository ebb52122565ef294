// SPDX-License-Identifier: MIT
// The mannequin's skin: contour the shape, cut it along the borders of the clothes, bind it to the joints.
#include "puppetri/figure/mannequin_mesh.h"

#include <algorithm>

#include "contour.h"
#include "mannequin_shape.h"
#include "skin_weights.h"
#include "puppetri/base/require.h"

namespace puppetri::figure {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Divides triangles so that no edge crosses a border of the clothes: vertices that are near to it slide onto it, edges
// that still cross it get a vertex there.
class Tailor {
   public:
    Tailor(Contour& body, const ImplicitShape& shape, const Landmarks& marks)
        : body_(body), shape_(shape), marks_(marks), zones_(body.triangles.size(), Zone::kShirt),
          assigned_(body.triangles.size(), 0) {
        for (int i = 0; i < shape.size(); ++i) {
            everything_.push_back(static_cast<std::uint16_t>(i));
        }
        rebuild_edges();
        for (int which = 0; which < kBorderCount; ++which) {
            cut(which);
        }
    }

    const std::vector<Zone>& zones() const { return zones_; }

   private:
    static constexpr double kSnap = 0.32;  // an edge is not cut nearer to its end than this; a vertex slides instead

    double value(int which, Vec3 p) const {
        return border_applies(marks_, which, p) ? border(marks_, which, p) : marks_.unit_m;
    }

    void onto_surface(std::uint32_t v) {
        for (int step = 0; step < 2; ++step) {
            const FieldSample f = shape_.sample(body_.positions_model[v], everything_);
            body_.positions_model[v] =
                body_.positions_model[v] - f.gradient * (f.distance / std::max(dot(f.gradient, f.gradient), 0.05));
            body_.normals_model[v] = normalized(f.gradient, {0, 1, 0});
        }
    }

    void cut(int which) {
        auto& p = body_.positions_model;
        std::vector<double> g(p.size());
        for (std::size_t v = 0; v < p.size(); ++v) {
            g[v] = value(which, p[v]);
        }
        // Slide.
        std::vector<double> shift(p.size(), 1e9);
        std::vector<Vec3> target(p.size());
        for (const auto& e : body_.edges) {
            if ((g[e[0]] < 0) == (g[e[1]] < 0)) {
                continue;
            }
            const double t = g[e[0]] / (g[e[0]] - g[e[1]]);
            const Vec3 where = p[e[0]] + (p[e[1]] - p[e[0]]) * t;
            const std::uint32_t v = t < kSnap ? e[0] : t > 1 - kSnap ? e[1] : kNone;
            if (v != kNone && length(where - p[v]) < shift[v]) {
                shift[v] = length(where - p[v]);
                target[v] = where;
            }
        }
        for (std::uint32_t v = 0; v < p.size(); ++v) {
            if (shift[v] < 1e9) {
                p[v] = target[v];
                onto_surface(v);
                g[v] = 0;
            }
        }
        // Divide.
        std::vector<std::uint32_t> middle(body_.edges.size(), kNone);
        for (std::size_t i = 0; i < body_.edges.size(); ++i) {
            const auto e = body_.edges[i];
            if (g[e[0]] * g[e[1]] >= 0) {
                continue;
            }
            const double t = g[e[0]] / (g[e[0]] - g[e[1]]);
            middle[i] = static_cast<std::uint32_t>(p.size());
            p.push_back(p[e[0]] + (p[e[1]] - p[e[0]]) * t);
            body_.normals_model.push_back({});
            onto_surface(middle[i]);
            g.push_back(0);
        }
        const std::size_t before = body_.triangles.size();
        for (std::size_t t = 0; t < before; ++t) {
            divide(t, middle);
        }
        for (std::size_t t = 0; t < body_.triangles.size(); ++t) {
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
        rebuild_edges();
    }

    void divide(std::size_t t, const std::vector<std::uint32_t>& middle) {
        const auto c = body_.triangles[t];
        std::array<std::uint32_t, 3> m;  // m[k] on the edge c[k], c[k + 1]
        int crossed = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            m[k] = middle[edge_index(c[k], c[(k + 1) % 3])];
            crossed += m[k] != kNone;
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
                const std::uint32_t on_next = m[next], on_last = m[last];
                body_.triangles[t] = {c[last], on_last, on_next};
                extra({c[k], c[next], on_next});
                extra({c[k], on_next, on_last});
                return;
            }
        }
    }

    std::size_t edge_index(std::uint32_t a, std::uint32_t b) const {
        const std::array<std::uint32_t, 2> e{std::min(a, b), std::max(a, b)};
        auto at = std::lower_bound(body_.edges.begin() + first_edge_[e[0]], body_.edges.begin() + first_edge_[e[0] + 1], e);
        return static_cast<std::size_t>(at - body_.edges.begin());
    }

    void rebuild_edges() {
        body_.edges.clear();
        for (const auto& t : body_.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (t[k] < t[(k + 1) % 3]) {  // closed: the neighbour has the edge the other way round
                    body_.edges.push_back({t[k], t[(k + 1) % 3]});
                }
            }
        }
        index_edges();
    }

    void index_edges() {
        // Buckets by the lower vertex; inside a bucket the few edges are sorted.
        first_edge_.assign(body_.positions_model.size() + 1, 0);
        for (const auto& e : body_.edges) {
            ++first_edge_[e[0] + 1];
        }
        for (std::size_t i = 1; i < first_edge_.size(); ++i) {
            first_edge_[i] += first_edge_[i - 1];
        }
        std::vector<std::array<std::uint32_t, 2>> sorted(body_.edges.size());
        std::vector<std::uint32_t> next(first_edge_.begin(), first_edge_.end() - 1);
        for (const auto& e : body_.edges) {
            sorted[next[e[0]]++] = e;
        }
        for (std::size_t v = 0; v + 1 < first_edge_.size(); ++v) {
            std::sort(sorted.begin() + first_edge_[v], sorted.begin() + first_edge_[v + 1]);
        }
        body_.edges = std::move(sorted);
    }

    Contour& body_;
    const ImplicitShape& shape_;
    const Landmarks& marks_;
    std::vector<Zone> zones_;
    std::vector<std::uint8_t> assigned_;
    std::vector<std::uint16_t> everything_;
    std::vector<std::uint32_t> first_edge_;
};

std::array<float, 3> floats(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

Mesh make_mannequin_mesh(const Skeleton& skeleton, const Palette& palette) {
    PUP_REQUIRE(skeleton.height_m > 0);
    const Landmarks marks = landmarks_of(skeleton);
    const ImplicitShape shape = mannequin_shape(marks);
    const ContourGrid grid = mannequin_grid(marks);
    Contour body = contour(shape, grid);
    const Tailor tailor(body, shape, marks);
    const SkinWeights weights(skeleton, marks);

    Mesh mesh;
    mesh.materials = {{"skin", palette.skin, 0.62f, 0}, {"hair", palette.hair, 0.55f, 0},
                      {"shirt", palette.main, 0.8f, 0}, {"trousers", palette.second, 0.85f, 0},
                      {"shoes", palette.accent, 0.5f, 0}};
    const std::size_t n = body.positions_model.size();
    mesh.positions.reserve(n);
    mesh.normals.reserve(n);
    mesh.joints.reserve(n);
    mesh.weights.reserve(n);
    for (std::size_t v = 0; v < n; ++v) {
        mesh.positions.push_back(floats(body.positions_model[v]));
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
