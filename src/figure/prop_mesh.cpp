// SPDX-License-Identifier: MIT
#include "puppetri/figure/prop_mesh.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesh_builder.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

std::array<float, 3> floats(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// A flat rectangle that looks up.
void rectangle(Mesh& mesh, double x0, double x1, double z0, double z1, double y,
               std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : {Vec3{x0, y, z0}, Vec3{x0, y, z1}, Vec3{x1, y, z1}, Vec3{x1, y, z0}}) {
        mesh.positions.push_back(floats(p));
        mesh.normals.push_back({0, 1, 0});
    }
    const auto triangle = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.parts.push_back({material, triangle, 2});
}

}  // namespace

Mesh make_ball_mesh(double diameter_m, const Palette& palette) {
    PUP_REQUIRE(diameter_m > 0);
    constexpr std::uint32_t kRings = 24, kSectors = 48,
                            kPanels = 6;  // rings between the poles: kRings - 1
    const double r = diameter_m / 2;
    Mesh mesh;
    mesh.materials = {{"panel", palette.main, 0.35f, 0},
                      {"other panel", palette.second, 0.35f, 0},
                      {"cap", palette.accent, 0.35f, 0}};
    std::array<double, kSectors> cosines{}, sines{};
    circle_points(kSectors, cosines, sines);
    const auto vertex = [&](Vec3 n) {
        mesh.positions.push_back(floats(n * r));
        mesh.normals.push_back(floats(n));
    };
    vertex({0, -1, 0});
    for (std::uint32_t i = 1; i < kRings; ++i) {
        const double a = kPi * (static_cast<double>(i) / kRings - 0.5);
        const double c = puppetri::cos(a), s = puppetri::sin(a);
        for (std::size_t k = 0; k < kSectors; ++k) {
            vertex({c * cosines[k], s, c * sines[k]});
        }
    }
    vertex({0, 1, 0});
    const auto at = [](std::uint32_t ring, std::uint32_t sector) {
        return 1 + (ring - 1) * kSectors + sector % kSectors;
    };
    const auto high = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    const auto part = [&](std::uint32_t material) {
        mesh.parts.push_back({material, static_cast<std::uint32_t>(mesh.triangles.size()), 0});
    };
    part(2);  // caps at both poles, three rings high
    constexpr std::uint32_t kCap = 2;
    for (std::uint32_t k = 0; k < kSectors; ++k) {
        mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
        mesh.triangles.push_back({high, at(kRings - 1, k + 1), at(kRings - 1, k)});
    }
    const auto band = [&](std::uint32_t i, std::uint32_t k) {
        mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
        mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    };
    for (std::uint32_t k = 0; k < kSectors; ++k) {
        for (std::uint32_t i = 1; i < kCap; ++i) {
            band(i, k);
            band(kRings - 1 - i, k);
        }
    }
    mesh.parts.back().triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t p = 0; p < kPanels; ++p) {
        part(p % 2);
        for (std::uint32_t k = p * kSectors / kPanels; k < (p + 1) * kSectors / kPanels; ++k) {
            for (std::uint32_t i = kCap; i < kRings - kCap; ++i) {
                band(i, k);
            }
        }
        mesh.parts.back().triangle_count =
            static_cast<std::uint32_t>(mesh.triangles.size()) - mesh.parts.back().first_triangle;
    }
    sort_parts(mesh);
    return mesh;
}

Mesh make_box_mesh(Vec3 size_m, const Palette& palette) {
    PUP_REQUIRE(size_m.x > 0 && size_m.y > 0 && size_m.z > 0);
    Mesh mesh;
    mesh.materials = {{"box", palette.main, 0.6f, 0}, {"edges", palette.second, 0.6f, 0}};
    const Vec3 half = size_m * 0.5;
    const double bevel = 0.06 * std::min({size_m.x, size_m.y, size_m.z});
    // Each corner of the box is three vertices, one on each of its faces, drawn in from the edges
    // by the bevel. Faces, bevels and corner triangles then share no normals, and the box looks cut
    // from wood.
    const auto corner = [&](int sx, int sy, int sz, int face) {
        return Vec3{sx * (half.x - (face == 0 ? 0 : bevel)),
                    sy * (half.y - (face == 1 ? 0 : bevel)),
                    sz * (half.z - (face == 2 ? 0 : bevel))};
    };
    const auto polygon = [&](std::span<const Vec3> p, Vec3 outwards) {
        const Vec3 n = normalized(cross(p[1] - p[0], p[2] - p[0]));
        const bool right_way = dot(n, outwards) > 0;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3 q : p) {
            mesh.positions.push_back(floats(q));
            mesh.normals.push_back(floats(right_way ? n : -n));
        }
        for (std::uint32_t k = 2; k < p.size(); ++k) {
            if (right_way) {
                mesh.triangles.push_back({first, first + k - 1, first + k});
            } else {
                mesh.triangles.push_back({first, first + k, first + k - 1});
            }
        }
    };
    const auto component = [](int axis, int sign) {
        return Vec3{axis == 0 ? 1.0 * sign : 0, axis == 1 ? 1.0 * sign : 0,
                    axis == 2 ? 1.0 * sign : 0};
    };
    const auto place = [&](int axis, int sign, int b, int sb, int sc, int face) {
        const int c = 3 - axis - b;
        std::array<int, 3> s{};
        s[static_cast<std::size_t>(axis)] = sign;
        s[static_cast<std::size_t>(b)] = sb;
        s[static_cast<std::size_t>(c)] = sc;
        return corner(s[0], s[1], s[2], face);
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3;
        for (const int sign : {-1, 1}) {
            const std::array<Vec3, 4> face{
                place(axis, sign, b, -1, -1, axis), place(axis, sign, b, 1, -1, axis),
                place(axis, sign, b, 1, 1, axis), place(axis, sign, b, -1, 1, axis)};
            polygon(face, component(axis, sign));
        }
    }
    const auto edges_from = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.parts.push_back({0, 0, edges_from});
    for (int axis = 0; axis < 3; ++axis) {  // bevels along each axis
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        for (const int sb : {-1, 1}) {
            for (const int sc : {-1, 1}) {
                const std::array<Vec3, 4> strip{
                    place(axis, -1, b, sb, sc, b), place(axis, 1, b, sb, sc, b),
                    place(axis, 1, b, sb, sc, c), place(axis, -1, b, sb, sc, c)};
                polygon(strip, component(b, sb) + component(c, sc));
            }
        }
    }
    for (const int sx : {-1, 1}) {
        for (const int sy : {-1, 1}) {
            for (const int sz : {-1, 1}) {
                const std::array<Vec3, 3> tip{corner(sx, sy, sz, 0), corner(sx, sy, sz, 1),
                                              corner(sx, sy, sz, 2)};
                polygon(tip, {1.0 * sx, 1.0 * sy, 1.0 * sz});
            }
        }
    }
    mesh.parts.push_back(
        {1, edges_from, static_cast<std::uint32_t>(mesh.triangles.size()) - edges_from});
    return mesh;
}

Mesh make_cylinder_mesh(double diameter_m, double height_m, const Palette& palette) {
    PUP_REQUIRE(diameter_m > 0 && height_m > 0);
    Mesh mesh;
    mesh.materials = {{"cylinder", palette.main, 0.6f, 0}};
    const double r = diameter_m / 2, h = height_m / 2;
    const double bevel = 0.12 * std::min(r, h);
    constexpr int kSectors = 48;
    // Rings of one edge twice, with the normals of either side: flat faces and a sharp bevel.
    const std::array<ProfilePoint, 6> lower{{{0, -h, 0, -1},
                                             {r - bevel, -h, 0, -1},
                                             {r - bevel, -h, 1, -1},
                                             {r, -h + bevel, 1, -1},
                                             {r, -h + bevel, 1, 0},
                                             {0, 0, 0, 0}}};
    const std::array<ProfilePoint, 5> upper{{{r, h - bevel, 1, 0},
                                             {r, h - bevel, 1, 1},
                                             {r - bevel, h, 1, 1},
                                             {r - bevel, h, 0, 1},
                                             {0, h, 0, 1}}};
    std::vector<ProfilePoint> profile(lower.begin(), lower.end() - 1);
    profile.insert(profile.end(), upper.begin(), upper.end());
    append_revolution(mesh, profile, kSectors, {}, 0, nullptr);
    return mesh;
}

Mesh make_fork_mesh(Vec3 size_m, const Palette& palette) {
    PUP_REQUIRE(size_m.x > 0 && size_m.y > 0 && size_m.z > 0);
    constexpr int kTines = 4;
    const double w = size_m.x, h = size_m.y, l = size_m.z;
    Mesh mesh;
    const auto add = [&](Vec3 size, Vec3 centre) {
        const Mesh part = make_box_mesh(size, palette);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const auto triangle = static_cast<std::uint32_t>(mesh.triangles.size());
        mesh.materials = part.materials;
        for (const auto& p : part.positions) {
            mesh.positions.push_back(floats(Vec3{p[0], p[1], p[2]} + centre));
        }
        mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
        for (const auto& t : part.triangles) {
            mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
        for (const MeshPart& p : part.parts) {
            mesh.parts.push_back({p.material, p.first_triangle + triangle, p.triangle_count});
        }
    };
    add({0.42 * w, h, 0.5 * l}, {0, 0, -0.25 * l});        // the handle
    add({0.25 * w, 0.7 * h, 0.14 * l}, {0, 0, 0.06 * l});  // the neck
    add({w, 0.6 * h, 0.13 * l}, {0, 0, 0.18 * l});
    for (int i = 0; i < kTines; ++i) {
        const double x = w * ((i + 0.5) / kTines - 0.5);
        add({0.13 * w, 0.5 * h, 0.27 * l}, {x * (1 - 0.13 / kTines), 0, 0.365 * l});
    }
    sort_parts(mesh);
    return mesh;
}

Mesh make_road_mesh(double length_m, double width_m) {
    PUP_REQUIRE(length_m > 0 && width_m > 0);
    Mesh mesh;
    mesh.materials = {{"asphalt", {0.118f, 0.122f, 0.132f}, 0.95f, 0},
                      {"paint", {0.66f, 0.655f, 0.63f}, 0.8f, 0},
                      {"grass", {0.15f, 0.20f, 0.06f}, 1, 0}};
    const double w = width_m / 2, l = length_m / 2, verge = 6;
    constexpr double kPaint = 0.002;  // above the asphalt, against flicker
    rectangle(mesh, -w, w, -l, l, 0, 0);
    for (double z = -l; z < l; z += 4) {
        rectangle(mesh, -0.06, 0.06, z, std::min(z + 1.6, l), kPaint, 1);
    }
    for (const double side : {-1.0, 1.0}) {
        const double edge = side * (w - 0.28);
        rectangle(mesh, edge - 0.06, edge + 0.06, -l, l, kPaint, 1);
        rectangle(mesh, side < 0 ? -w - verge : w, side < 0 ? -w : w + verge, -l, l, 0, 2);
    }
    sort_parts(mesh);
    return mesh;
}

Mesh make_floor_mesh(double length_m, double width_m) {
    PUP_REQUIRE(length_m > 0 && width_m > 0);
    Mesh mesh;
    mesh.materials = {{"floor", {0.47f, 0.445f, 0.41f}, 0.9f, 0},
                      {"grid", {0.33f, 0.33f, 0.33f}, 0.9f, 0}};
    const double w = width_m / 2, l = length_m / 2;
    constexpr double kAbove = 0.001, kThin = 0.006;
    rectangle(mesh, -w, w, -l, l, 0, 0);
    for (double x = std::ceil(-w); x <= w; x += 1) {
        rectangle(mesh, std::max(-w, x - kThin), std::min(w, x + kThin), -l, l, kAbove, 1);
    }
    for (double z = std::ceil(-l); z <= l; z += 1) {
        rectangle(mesh, -w, w, std::max(-l, z - kThin), std::min(l, z + kThin), kAbove, 1);
    }
    sort_parts(mesh);
    return mesh;
}

}  // namespace puppetri::figure
