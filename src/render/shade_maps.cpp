// SPDX-License-Identifier: MIT
#include "shade_maps.h"

#include <algorithm>
#include <cmath>

namespace puppetri::render {

BodySpheres::BodySpheres(const figure::Skeleton& skeleton, const figure::Mesh& mesh) {
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), model_from_joint);
    // Each joint's own vertices: their extent along the bone, and their mean distance from it.
    struct Cloud {
        std::vector<Vec3> points;
    };
    std::vector<Cloud> clouds(skeleton.joints.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (mesh.weights[v][0] > 0.55f) {
            const std::size_t j = mesh.joints[v][0];
            const auto& p = mesh.positions[v];
            clouds[j].points.push_back(inverse(model_from_joint[j]) * Vec3{p[0], p[1], p[2]});
        }
    }
    for (std::size_t j = 0; j < clouds.size(); ++j) {
        const auto& points = clouds[j].points;
        if (points.size() < 6) {
            continue;
        }
        Vec3 low = points[0], high = points[0];
        for (const Vec3& p : points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const Vec3 size = high - low, middle = (low + high) * 0.5;
        // Beads along the longest side, as thick as the mean of the other two.
        const double longest = std::max({size.x, size.y, size.z});
        const Vec3 axis = size.x == longest   ? Vec3{1, 0, 0}
                          : size.y == longest ? Vec3{0, 1, 0}
                                              : Vec3{0, 0, 1};
        const double across = (size.x + size.y + size.z - longest) / 2;
        const double radius = std::min(across / 2, longest / 2);
        if (radius < 0.012) {
            continue;  // fingers: too thin to shade the floor
        }
        const double way = std::max(0.0, longest - 2 * radius);
        const int count = 1 + static_cast<int>(way / (1.4 * radius));
        for (int k = 0; k < count; ++k) {
            const double t = count == 1 ? 0 : static_cast<double>(k) / (count - 1) - 0.5;
            beads_.push_back({static_cast<std::uint32_t>(j), middle + axis * (t * way),
                              static_cast<float>(radius)});
        }
    }
}

void BodySpheres::at(std::span<const Transform> world_from_joint, std::vector<Sphere>& out) const {
    out.clear();
    for (const Bead& b : beads_) {
        out.push_back({float3(world_from_joint[b.joint] * b.centre_joint), b.radius});
    }
}

void FloorShade::make(std::span<const Sphere> spheres) {
    Float3 low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
    for (const Sphere& s : spheres) {
        if (s.centre_world.y - s.radius < 1.0f) {
            low = {std::min(low.x, s.centre_world.x), 0, std::min(low.z, s.centre_world.z)};
            high = {std::max(high.x, s.centre_world.x), 0, std::max(high.z, s.centre_world.z)};
        }
    }
    light_.assign(static_cast<std::size_t>((kCells + 1) * (kCells + 1)), 1.0f);
    if (low.x > high.x) {
        return;
    }
    const float side = std::max({high.x - low.x, high.z - low.z, 0.3f}) + 1.5f;
    cell_ = side / kCells;
    low_x_ = (low.x + high.x - side) / 2;
    low_z_ = (low.z + high.z - side) / 2;
    for (int i = 0; i <= kCells; ++i) {
        for (int k = 0; k <= kCells; ++k) {
            const float x = low_x_ + cell_ * static_cast<float>(k),
                        z = low_z_ + cell_ * static_cast<float>(i);
            float light = 1;
            for (const Sphere& s : spheres) {
                const float dx = s.centre_world.x - x, dz = s.centre_world.z - z;
                const float y = std::max(s.centre_world.y, s.radius);
                const float square = dx * dx + dz * dz + y * y;
                light *= 1 - s.radius * s.radius * y / (square * std::sqrt(square));
            }
            // Fades to nothing at the rim of the map.
            const float rim_x = std::min(k, kCells - k) * (2.0f / kCells),
                        rim_z = std::min(i, kCells - i) * (2.0f / kCells);
            light_[static_cast<std::size_t>(i * (kCells + 1) + k)] =
                mix(1.0f, light, smooth_step(0.0f, 0.45f, std::min(rim_x, rim_z)));
        }
    }
}

float FloorShade::at(float x, float z) const {
    const float u = (x - low_x_) / cell_, v = (z - low_z_) / cell_;
    if (light_.empty() || u < 0 || v < 0 || u >= kCells || v >= kCells) {
        return 1;
    }
    const auto k = static_cast<std::size_t>(u), i = static_cast<std::size_t>(v);
    const float s = u - static_cast<float>(k), t = v - static_cast<float>(i);
    const float* row = light_.data() + i * (kCells + 1) + k;
    const float* next = row + kCells + 1;
    return mix(mix(row[0], row[1], s), mix(next[0], next[1], s), t);
}

VertexShade::VertexShade(const figure::Mesh& mesh) {
    const std::size_t n = mesh.positions.size();
    first_neighbour_.assign(n + 1, 0);
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            ++first_neighbour_[v + 1];
        }
    }
    for (std::size_t v = 0; v < n; ++v) {
        first_neighbour_[v + 1] += first_neighbour_[v];
    }
    neighbours_.resize(first_neighbour_[n]);
    std::vector<std::uint32_t> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            neighbours_[next[t[k]]++] = t[(k + 1) % 3];
        }
    }
}

void VertexShade::make(const Tracer& tracer, const float* positions,
                       std::span<const std::array<float, 3>> normals, Float3 eye,
                       std::span<float> light) {
    // Eight directions about the pole, spread like the cosine: two rings; each vertex turns them by
    // its own angle.
    struct Direction {
        float side, up, angle;
    };
    static const std::array<Direction, kPack> kDirections = [] {
        std::array<Direction, kPack> all{};
        for (int i = 0; i < kPack; ++i) {
            const float square = (static_cast<float>(i) + 0.5f) / kPack;
            all[static_cast<std::size_t>(i)] = {std::sqrt(square), std::sqrt(1 - square),
                                                2.399963f * static_cast<float>(i)};
        }
        return all;
    }();
    RayPack rays;
    for (std::size_t v = 0; v + 1 < first_neighbour_.size(); ++v) {
        const Float3 p{positions[4 * v], positions[4 * v + 1], positions[4 * v + 2]},
            n = float3(normals[v]);
        light[v] = -1;
        const Float3 to_eye = eye - p;
        if (dot(n, to_eye) < -0.25f * std::sqrt(dot(to_eye, to_eye))) {
            continue;
        }
        const Float3 side =
            normalized(cross(std::fabs(n.y) < 0.9f ? Float3{0, 1, 0} : Float3{1, 0, 0}, n));
        const Float3 other = cross(n, side);
        const float turn = 2.399963f * static_cast<float>(v % 64) * 3.7f;
        const Float3 start = p + n * 0.004f;
        for (std::size_t i = 0; i < kPack; ++i) {
            const Direction& d = kDirections[i];
            const float c = std::cos(d.angle + turn) * d.side,
                        s = std::sin(d.angle + turn) * d.side;
            const Float3 way = side * c + other * s + n * d.up;
            rays.ox[i] = start.x;
            rays.oy[i] = start.y;
            rays.oz[i] = start.z;
            rays.dx[i] = way.x;
            rays.dy[i] = way.y;
            rays.dz[i] = way.z;
            rays.near[i] = 0;
            rays.far[i] = 0.45f;
        }
        const unsigned met = tracer.occluded(rays, 0xFF);
        light[v] = 1 - static_cast<float>(__builtin_popcount(met)) / kPack;
    }
    for (int round = 0; round < 2; ++round) {
        before_.assign(light.begin(), light.end());
        for (std::size_t v = 0; v + 1 < first_neighbour_.size(); ++v) {
            float sum = before_[v] >= 0 ? before_[v] : 0, count = before_[v] >= 0 ? 1.0f : 0.0f;
            for (std::uint32_t i = first_neighbour_[v]; i < first_neighbour_[v + 1]; ++i) {
                const float one = before_[neighbours_[i]];
                sum += one >= 0 ? one : 0;
                count += one >= 0 ? 1.0f : 0.0f;
            }
            light[v] = count > 0 ? sum / count : -1;
        }
    }
    for (float& one : light) {
        one = one < 0 ? 1 : one;
    }
}

}  // namespace puppetri::render
