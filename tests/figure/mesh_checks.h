// SPDX-License-Identifier: MIT
// Questions about meshes, answered by brute force.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "puppetri/figure/mesh.h"

namespace puppetri::test {

inline Vec3 vec(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

// Each directed edge belongs to one triangle, and so does its reverse.
inline bool closed_manifold(const figure::Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!edges.insert({t[k], t[(k + 1) % 3]}).second) {
                return false;
            }
        }
    }
    return std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
        return edges.count({e.second, e.first}) == 1;
    });
}

// V - E + F of a closed mesh; a sphere has 2. Vertices that no triangle uses do not count.
inline long euler_number(const figure::Mesh& mesh) {
    std::set<std::uint32_t> used;
    for (const auto& t : mesh.triangles) {
        used.insert(t.begin(), t.end());
    }
    const auto faces = static_cast<long>(mesh.triangles.size());
    return static_cast<long>(used.size()) - faces * 3 / 2 + faces;
}

inline int components(const figure::Mesh& mesh) {
    std::vector<std::uint32_t> leader(mesh.positions.size());
    for (std::uint32_t v = 0; v < leader.size(); ++v) {
        leader[v] = v;
    }
    const auto find = [&](std::uint32_t v) {
        while (leader[v] != v) {
            v = leader[v] = leader[leader[v]];
        }
        return v;
    };
    for (const auto& t : mesh.triangles) {
        leader[find(t[0])] = find(t[1]);
        leader[find(t[1])] = find(t[2]);
    }
    std::set<std::uint32_t> roots;
    for (std::uint32_t v = 0; v < leader.size(); ++v) {
        roots.insert(find(v));
    }
    return static_cast<int>(roots.size());
}

inline double volume_m3(const std::vector<std::array<float, 3>>& positions,
                        const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    double six = 0;
    for (const auto& t : triangles) {
        six += dot(vec(positions[t[0]]), cross(vec(positions[t[1]]), vec(positions[t[2]])));
    }
    return six / 6;
}

inline bool parts_cover(const figure::Mesh& mesh) {
    std::vector<int> covered(mesh.triangles.size());
    for (const figure::MeshPart& p : mesh.parts) {
        if (p.material >= mesh.materials.size() ||
            p.first_triangle + p.triangle_count > covered.size()) {
            return false;
        }
        for (std::uint32_t t = 0; t < p.triangle_count; ++t) {
            ++covered[p.first_triangle + t];
        }
    }
    return std::all_of(covered.begin(), covered.end(), [](int n) { return n == 1; });
}

inline double worst_normal_length(const figure::Mesh& mesh) {
    double worst = 0;
    for (const auto& n : mesh.normals) {
        worst = std::max(worst, std::fabs(length(vec(n)) - 1));
    }
    return worst;
}

// The smallest height of a triangle over its longest side.
inline double thinnest_triangle_m(const figure::Mesh& mesh) {
    double thinnest = 1e9;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = vec(mesh.positions[t[0]]), b = vec(mesh.positions[t[1]]),
                   c = vec(mesh.positions[t[2]]);
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        thinnest = std::min(thinnest, length(cross(b - a, c - a)) / longest);
    }
    return thinnest;
}

// The share of the surface whose triangles face another way than the mean of their vertices'
// normals.
inline double share_facing_inwards(const figure::Mesh& mesh) {
    double all = 0, wrong = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = vec(mesh.positions[t[0]]);
        const Vec3 n = cross(vec(mesh.positions[t[1]]) - a, vec(mesh.positions[t[2]]) - a);
        const Vec3 mean =
            vec(mesh.normals[t[0]]) + vec(mesh.normals[t[1]]) + vec(mesh.normals[t[2]]);
        all += length(n);
        wrong += dot(n, mean) <= 0 ? length(n) : 0;
    }
    return wrong / all;
}

// The distance from a point to the nearest point of any triangle, by trying all.
inline double distance_to_surface_m(const figure::Mesh& mesh, Vec3 p) {
    double best = 1e9;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = vec(mesh.positions[t[0]]), ab = vec(mesh.positions[t[1]]) - a,
                   ac = vec(mesh.positions[t[2]]) - a;
        const Vec3 ap = p - a, n = cross(ab, ac);
        // Barycentric coordinates of the foot, clamped edge by edge.
        const double nn = dot(n, n);
        const double u = dot(cross(ap, ac), n) / nn, v = dot(cross(ab, ap), n) / nn;
        if (u >= 0 && v >= 0 && u + v <= 1) {
            best = std::min(best, std::fabs(dot(ap, n)) / std::sqrt(nn));
        }
        for (const auto& [from, way] : {std::pair{a, ab}, {a, ac}, {a + ab, ac - ab}}) {
            const double s = std::clamp(dot(p - from, way) / dot(way, way), 0.0, 1.0);
            best = std::min(best, length(p - from - way * s));
        }
    }
    return best;
}

}  // namespace puppetri::test
