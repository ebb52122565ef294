// SPDX-License-Identifier: MIT
#include "mesh_builder.h"

#include <algorithm>
#include <array>

#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {

void circle_points(int count, std::span<double> cosines, std::span<double> sines) {
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * kPi * i / count;
        cosines[static_cast<std::size_t>(i)] =
            4 * i % count == 0 && (4 * i / count) % 2 == 1 ? 0 : puppetri::cos(angle);
        sines[static_cast<std::size_t>(i)] = 2 * i % count == 0 ? 0 : puppetri::sin(angle);
    }
}

void append_revolution(Mesh& mesh, std::span<const ProfilePoint> profile, int sectors,
                       const Transform& model_from_local, std::uint32_t material,
                       const std::uint16_t* joint) {
    PUP_REQUIRE(profile.size() >= 3 && sectors >= 3);
    std::vector<double> cosines(static_cast<std::size_t>(sectors)),
        sines(static_cast<std::size_t>(sectors));
    circle_points(sectors, cosines, sines);
    const auto vertex = [&](Vec3 p_local, Vec3 n_local) {
        const Vec3 p = model_from_local * p_local, n = rotate(model_from_local.rotation, n_local);
        mesh.positions.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        mesh.normals.push_back(
            {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
        if (joint != nullptr) {
            mesh.joints.push_back({*joint, 0, 0, 0});
            mesh.weights.push_back({1, 0, 0, 0});
        }
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    const auto first_triangle = static_cast<std::uint32_t>(mesh.triangles.size());
    const std::uint32_t low = vertex({0, profile.front().y_m, 0}, {0, -1, 0});
    const auto rings = static_cast<std::uint32_t>(profile.size() - 2),
               n = static_cast<std::uint32_t>(sectors);
    for (std::uint32_t r = 0; r < rings; ++r) {
        const ProfilePoint& at = profile[r + 1];
        const Vec3 plane = normalized(Vec3{at.normal_out, at.normal_y, 0});
        for (std::size_t s = 0; s < n; ++s) {
            vertex({at.radius_m * cosines[s], at.y_m, at.radius_m * sines[s]},
                   {plane.x * cosines[s], plane.y, plane.x * sines[s]});
        }
    }
    const std::uint32_t high = vertex({0, profile.back().y_m, 0}, {0, 1, 0});
    const auto ring = [&](std::uint32_t r, std::uint32_t s) { return low + 1 + r * n + s % n; };
    for (std::uint32_t s = 0; s < n; ++s) {
        mesh.triangles.push_back({low, ring(0, s), ring(0, s + 1)});
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
            mesh.triangles.push_back({ring(r, s), ring(r + 1, s), ring(r + 1, s + 1)});
            mesh.triangles.push_back({ring(r, s), ring(r + 1, s + 1), ring(r, s + 1)});
        }
        mesh.triangles.push_back({high, ring(rings - 1, s + 1), ring(rings - 1, s)});
    }
    mesh.parts.push_back({material, first_triangle,
                          static_cast<std::uint32_t>(mesh.triangles.size()) - first_triangle});
}

void sort_parts(Mesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<MeshPart> parts;
    triangles.reserve(mesh.triangles.size());
    for (std::uint32_t m = 0; m < mesh.materials.size(); ++m) {
        const auto first = static_cast<std::uint32_t>(triangles.size());
        for (const MeshPart& p : mesh.parts) {
            if (p.material == m) {
                triangles.insert(triangles.end(), mesh.triangles.begin() + p.first_triangle,
                                 mesh.triangles.begin() + p.first_triangle + p.triangle_count);
            }
        }
        const auto count = static_cast<std::uint32_t>(triangles.size()) - first;
        if (count > 0) {
            parts.push_back({m, first, count});
        }
    }
    mesh.triangles = std::move(triangles);
    mesh.parts = std::move(parts);
}

}  // namespace puppetri::figure
