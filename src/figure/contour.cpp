// SPDX-License-Identifier: MIT
// Octree dual contouring: build, contour, relax.
#include "contour.h"

#include <algorithm>

#include "puppetri/base/require.h"

namespace puppetri::figure {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr int kExtraLevels = 2;  // how much deeper cells with two sheets of surface are split

struct Node {
    std::uint32_t children = kNone;  // the first of eight
    std::uint32_t vertex = kNone;
    std::uint32_t first_active = 0, active_count = 0;
    std::uint8_t depth = 0;
    std::array<float, 8>
        corner{};  // of leaves: the function at the corners, bit 0 for x, bit 1 for y, bit 2 for z
    Vec3 low;      // lattice space
};

// True when the corners inside hang together along edges of the cell, and so do those outside.
bool simple(const std::array<float, 8>& corner) {
    for (const bool inside : {true, false}) {
        unsigned all = 0;
        for (unsigned i = 0; i < 8; ++i) {
            all |= ((corner[i] < 0) == inside ? 1u : 0u) << i;
        }
        if (all == 0) {
            return true;
        }
        unsigned seen = all & (~all + 1);
        for (unsigned before = 0; before != seen;) {
            before = seen;
            for (unsigned i = 0; i < 8; ++i) {
                if (seen >> i & 1) {
                    seen |= (1u << (i ^ 1) | 1u << (i ^ 2) | 1u << (i ^ 4)) & all;
                }
            }
        }
        if (seen != all) {
            return false;
        }
    }
    return true;
}

class Contourer {
 public:
    Contourer(const ImplicitShape& shape, const ContourGrid& grid) : shape_(shape), grid_(grid) {
        nodes_.reserve(60'000);
        Node root;
        root.low = {grid.low, grid.low, grid.low};
        for (int i = 0; i < shape.size(); ++i) {
            active_.push_back(static_cast<std::uint16_t>(i));
        }
        root.active_count = static_cast<std::uint32_t>(active_.size());
        nodes_.push_back(root);
        split(0);
        cell(0);
    }

    Contour finish() {
        relax();
        Contour out;
        out.positions_model = std::move(positions_);
        out.normals_model = std::move(normals_);
        out.triangles.reserve(quads_.size() * 2);
        for (const auto& q : quads_) {
            if (q[3] == kNone) {
                out.triangles.push_back({q[0], q[1], q[2]});
                continue;
            }
            // The diagonal that bends less with the surface: the one whose ends agree more about
            // the normal.
            const auto& n = out.normals_model;
            const auto& p = out.positions_model;
            const double first = (1.5 - dot(n[q[0]], n[q[2]])) * length(p[q[0]] - p[q[2]]);
            const double second = (1.5 - dot(n[q[1]], n[q[3]])) * length(p[q[1]] - p[q[3]]);
            // Ties go by a measure that is the same on both sides of the body, so that mirrored
            // quads are divided alike.
            const auto measure = [&](std::uint32_t v) {
                return std::fabs(p[v].x) + 0.37 * p[v].y + 0.21 * p[v].z;
            };
            const bool tie = std::fabs(first - second) < 1e-7 * (first + second);
            const bool by_measure =
                std::max(measure(q[0]), measure(q[2])) > std::max(measure(q[1]), measure(q[3]));
            if (tie ? by_measure : first < second) {
                out.triangles.push_back({q[0], q[1], q[2]});
                out.triangles.push_back({q[0], q[2], q[3]});
            } else {
                out.triangles.push_back({q[0], q[1], q[3]});
                out.triangles.push_back({q[1], q[2], q[3]});
            }
        }
        return out;
    }

 private:
    Vec3 model(Vec3 lattice) const {
        return {grid_.x(lattice.x), grid_.y(lattice.y), grid_.z(lattice.z)};
    }
    double cell_size(int depth) const { return grid_.size / static_cast<double>(1u << depth); }

    std::span<const std::uint16_t> active(const Node& n) const {
        return {active_.data() + n.first_active, n.active_count};
    }

    void split(std::uint32_t index) {
        const Node n = nodes_[index];
        const double size = cell_size(n.depth);
        Bounds box;
        box.add(model(n.low));
        box.add(model(n.low + Vec3{size, size, size}));
        // What can matter here, and how fine it wants its cells.
        const auto first = static_cast<std::uint32_t>(active_.size());
        int wanted = 0;
        bool any = false;
        for (std::uint32_t k = 0; k < n.active_count; ++k) {
            const std::uint16_t i = active_[n.first_active + k];
            if (shape_.reach(i).overlaps(box)) {
                active_.push_back(i);
                if (shape_.tight(i).grown(0.004).overlaps(box)) {
                    wanted = std::max(wanted, grid_.depth + shape_.cone(i).level);
                    any = true;
                } else {
                    wanted = std::max(wanted, grid_.depth);
                }
            }
        }
        nodes_[index].first_active = first;
        nodes_[index].active_count = static_cast<std::uint32_t>(active_.size()) - first;
        const auto here = active(nodes_[index]);
        if (here.empty() || (!any && n.depth >= grid_.depth)) {
            nodes_[index].corner.fill(1);
            if (!here.empty()) {
                evaluate_corners(index, size);
            }
            return;
        }
        if (n.depth >= 3) {
            // Deep inside or far outside nothing is to be found. Values are distances to first
            // order only: take twice the half diagonal.
            const double d = shape_.distance((box.low + box.high) * 0.5, here);
            if (std::fabs(d) > length(box.high - box.low)) {
                nodes_[index].corner.fill(d < 0 ? -1.0f : 1.0f);
                return;
            }
        }
        if (n.depth >= wanted) {
            evaluate_corners(index, size);
            // A thin gap may pass between all corners: the middle tells.
            const auto& corner = nodes_[index].corner;
            const bool all_alike = std::all_of(corner.begin(), corner.end(),
                                               [&](float c) { return (c < 0) == (corner[0] < 0); });
            const bool missed = all_alike && (shape_.distance((box.low + box.high) * 0.5, here) <
                                              0) != (corner[0] < 0);
            if (n.depth >= wanted + kExtraLevels || (simple(corner) && !missed)) {
                return;
            }
        }
        const auto children = static_cast<std::uint32_t>(nodes_.size());
        nodes_[index].children = children;
        for (int c = 0; c < 8; ++c) {
            Node child;
            child.depth = static_cast<std::uint8_t>(n.depth + 1);
            child.low = n.low + Vec3{(c & 1) ? size / 2 : 0, (c & 2) ? size / 2 : 0,
                                     (c & 4) ? size / 2 : 0};
            child.first_active = nodes_[index].first_active;
            child.active_count = nodes_[index].active_count;
            nodes_.push_back(child);
        }
        for (std::uint32_t c = 0; c < 8; ++c) {
            split(children + c);
        }
    }

    void evaluate_corners(std::uint32_t index, double size) {
        Node& n = nodes_[index];
        for (int c = 0; c < 8; ++c) {
            const Vec3 p = n.low + Vec3{(c & 1) ? size : 0, (c & 2) ? size : 0, (c & 4) ? size : 0};
            n.corner[static_cast<std::size_t>(c)] = corner_value(p, active(n));
        }
    }

    // The function at a lattice point, evaluated once for all cells that meet there.
    float corner_value(Vec3 p, std::span<const std::uint16_t> near) {
        const double finest = cell_size(kDeepest);
        const auto step = [&](double v) {
            return static_cast<std::uint64_t>((v - grid_.low) / finest + 0.5);
        };
        const std::uint64_t key = step(p.x) << 40 | step(p.y) << 20 | step(p.z);
        std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> (64 - kTableBits);
        while (known_[slot].key != key && known_[slot].key != kUnknown) {
            slot = (slot + 1) & (known_.size() - 1);
        }
        if (known_[slot].key == kUnknown) {
            PUP_REQUIRE(++known_count_ < known_.size());
            const double d = shape_.distance(model(p), near);
            known_[slot] = {key, static_cast<float>(d == 0 ? 1e-9 : d)};
        }
        return known_[slot].value;
    }

    bool leaf(std::uint32_t n) const { return nodes_[n].children == kNone; }
    std::uint32_t child(std::uint32_t n, int corner) const {
        return leaf(n) ? n : nodes_[n].children + static_cast<std::uint32_t>(corner);
    }

    void cell(std::uint32_t n) {
        if (leaf(n)) {
            return;
        }
        for (int c = 0; c < 8; ++c) {
            cell(child(n, c));
        }
        for (int d = 0; d < 3; ++d) {
            const int a = 1 << (d + 1) % 3, b = 1 << (d + 2) % 3;
            for (const int rest : {0, a, b, a | b}) {
                face(child(n, rest), child(n, rest | 1 << d), d);
            }
            for (int h = 0; h < 2; ++h) {
                const int along = h << d;
                edge({child(n, along), child(n, along | a), child(n, along | b),
                      child(n, along | a | b)},
                     d);
            }
        }
    }

    // Two cells that share a face across axis d, `low` before `high`.
    void face(std::uint32_t low, std::uint32_t high, int d) {
        if (leaf(low) && leaf(high)) {
            return;
        }
        const int a = 1 << (d + 1) % 3, b = 1 << (d + 2) % 3;
        for (const int rest : {0, a, b, a | b}) {
            face(child(low, rest | 1 << d), child(high, rest), d);
        }
        for (const int e : {(d + 1) % 3, (d + 2) % 3}) {
            const int f = 3 - d - e;
            for (int h = 0; h < 2; ++h) {
                std::array<std::uint32_t, 4> around;
                for (int i = 0; i < 4; ++i) {
                    const int on_a = i & 1,
                              on_b = i >> 1;  // sides along (e + 1) % 3 and (e + 2) % 3
                    const bool d_first = (e + 1) % 3 == d;
                    const int side_d = d_first ? on_a : on_b, side_f = d_first ? on_b : on_a;
                    around[static_cast<std::size_t>(i)] =
                        child(side_d ? high : low, (h << e) | ((1 - side_d) << d) | (side_f << f));
                }
                edge(around, e);
            }
        }
    }

    // Four cells around an edge along axis d; bit 0 of the place says the side along (d + 1) % 3,
    // bit 1 the other.
    void edge(std::array<std::uint32_t, 4> around, int d) {
        const int a = (d + 1) % 3, b = (d + 2) % 3;
        if (leaf(around[0]) && leaf(around[1]) && leaf(around[2]) && leaf(around[3])) {
            smallest_edge(around, d, a, b);
            return;
        }
        for (int h = 0; h < 2; ++h) {
            std::array<std::uint32_t, 4> halves;
            for (int i = 0; i < 4; ++i) {
                halves[static_cast<std::size_t>(i)] =
                    child(around[static_cast<std::size_t>(i)],
                          (h << d) | ((1 - (i & 1)) << a) | ((1 - (i >> 1)) << b));
            }
            edge(halves, d);
        }
    }

    void smallest_edge(const std::array<std::uint32_t, 4>& around, int d, int a, int b) {
        int finest = 0;
        for (int i = 1; i < 4; ++i) {
            if (nodes_[around[static_cast<std::size_t>(i)]].depth >
                nodes_[around[static_cast<std::size_t>(finest)]].depth) {
                finest = i;
            }
        }
        const Node& n = nodes_[around[static_cast<std::size_t>(finest)]];
        const int corner = ((1 - (finest & 1)) << a) | ((1 - (finest >> 1)) << b);
        const double v0 = n.corner[static_cast<std::size_t>(corner)];
        const double v1 = n.corner[static_cast<std::size_t>(corner | 1 << d)];
        if ((v0 < 0) == (v1 < 0)) {
            return;
        }
        const double size = cell_size(n.depth);
        Vec3 p =
            n.low + Vec3{(corner & 1) ? size : 0, (corner & 2) ? size : 0, (corner & 4) ? size : 0};
        const double way = size * std::clamp(v0 / (v0 - v1), 0.0, 1.0);
        (d == 0 ? p.x : d == 1 ? p.y : p.z) += way;
        std::array<std::uint32_t, 4> quad;
        static constexpr std::array<std::size_t, 4> kRound{0, 1, 3,
                                                           2};  // counter-clockwise seen from +d
        int corners = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            Node& touched = nodes_[around[kRound[v0 < 0 ? k : 3 - k]]];
            if (touched.vertex == kNone) {
                touched.vertex = static_cast<std::uint32_t>(positions_.size());
                positions_.push_back({});
                crossings_.push_back(0);
                owners_.push_back(static_cast<std::uint32_t>(&touched - nodes_.data()));
            }
            if (corners == 0 || (quad[static_cast<std::size_t>(corners - 1)] != touched.vertex &&
                                 quad[0] != touched.vertex)) {
                quad[static_cast<std::size_t>(corners++)] = touched.vertex;
            }
            positions_[touched.vertex] = positions_[touched.vertex] + model(p);
            ++crossings_[touched.vertex];
        }
        if (corners >= 3) {
            if (corners == 3) {
                quad[3] = kNone;
            }
            quads_.push_back(quad);
        }
    }

    // Vertices slide to the middle of their neighbours along the surface; Newton steps keep them on
    // it.
    void relax() {
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            positions_[i] = positions_[i] * (1.0 / crossings_[i]);
        }
        normals_.resize(positions_.size());
        collect_active();
        project();
        std::vector<Vec3> middle(positions_.size());
        std::vector<std::uint32_t> degree(positions_.size());
        for (int round = 0; round < 3; ++round) {
            std::fill(middle.begin(), middle.end(), Vec3{});
            std::fill(degree.begin(), degree.end(), 0u);
            for (const auto& q : quads_) {
                const std::size_t corners = q[3] == kNone ? 3 : 4;
                for (std::size_t k = 0; k < corners; ++k) {
                    const std::uint32_t from = q[k], to = q[(k + 1) % corners];
                    middle[from] = middle[from] + positions_[to];
                    ++degree[from];
                }
            }
            for (std::size_t i = 0; i < positions_.size(); ++i) {
                const Vec3 way = middle[i] * (1.0 / degree[i]) - positions_[i];
                positions_[i] = positions_[i] + (way - normals_[i] * dot(way, normals_[i])) * 0.6;
            }
            project();
        }
        project();
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            normals_[i] = normalized(shape_.sample(positions_[i], near(i)).gradient, {0, 1, 0});
        }
    }

    // The cones that matter around a vertex: where it is and where it may slide to.
    void collect_active() {
        vertex_active_.resize(positions_.size());
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            const Node& cell = nodes_[owners_[i]];
            const double size = cell_size(cell.depth);
            const Vec3 p = positions_[i];
            const double slack = length(model(cell.low + Vec3{size, size, size}) - model(cell.low));
            Bounds box;
            box.add(p);
            const auto first = static_cast<std::uint32_t>(active_.size());
            for (int c = 0; c < shape_.size(); ++c) {
                if (shape_.reach(c).overlaps(box.grown(slack)) && shape_.near(c, p, slack)) {
                    active_.push_back(static_cast<std::uint16_t>(c));
                }
            }
            vertex_active_[i] = {first, static_cast<std::uint32_t>(active_.size()) - first};
        }
    }

    std::span<const std::uint16_t> near(std::size_t vertex) const {
        return {active_.data() + vertex_active_[vertex][0], vertex_active_[vertex][1]};
    }

    // One Newton step for every vertex; leaves the gradient's direction where it came from.
    void project() {
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            const FieldSample f = shape_.sample(positions_[i], near(i));
            normals_[i] = normalized(f.gradient, {0, 1, 0});
            positions_[i] = positions_[i] -
                            f.gradient * (f.distance / std::max(dot(f.gradient, f.gradient), 0.05));
        }
    }

    static constexpr int kDeepest = 12, kTableBits = 17;
    static constexpr std::uint64_t kUnknown = ~std::uint64_t{0};
    struct Known {
        std::uint64_t key = kUnknown;
        float value = 0;
    };

    const ImplicitShape& shape_;
    const ContourGrid& grid_;
    std::vector<Known> known_ =
        std::vector<Known>(std::size_t{1} << kTableBits);  // open addressing
    std::size_t known_count_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint16_t> active_;
    std::vector<Vec3> positions_, normals_;
    std::vector<std::uint32_t> crossings_, owners_;
    std::vector<std::array<std::uint32_t, 2>> vertex_active_;  // first, count in active_
    std::vector<std::array<std::uint32_t, 4>> quads_;          // the last is kNone in a triangle
};

}  // namespace

double AxisMap::operator()(double u) const {
    if (odd && u < 0) {
        return -(*this)(-u);
    }
    const auto after = std::upper_bound(lattice.begin() + 1, lattice.end() - 1, u);
    const auto i = static_cast<std::size_t>(after - lattice.begin());
    const double t = (u - lattice[i - 1]) / (lattice[i] - lattice[i - 1]);
    return model_m[i - 1] + t * (model_m[i] - model_m[i - 1]);
}

Contour contour(const ImplicitShape& shape, const ContourGrid& grid) {
    return Contourer(shape, grid).finish();
}

}  // namespace puppetri::figure
