// SPDX-License-Identifier: MIT
// Soft shade where bodies are near: on the floor from a closed formula over spheres that stand for
// bodies, on the bodies themselves by a few short rays per vertex. Both are smooth by construction,
// where sampling per pixel would be noise.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "float3.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"
#include "tracer.h"

namespace puppetri::render {

struct Sphere {
    Float3 centre_world;
    float radius = 0;
};

// A body as spheres along its bones, as thick as its mesh is there.
class BodySpheres {
 public:
    BodySpheres(const figure::Skeleton& skeleton, const figure::Mesh& mesh);
    void at(std::span<const Transform> world_from_joint, std::vector<Sphere>& out) const;

 private:
    struct Bead {
        std::uint32_t joint;
        Vec3 centre_joint;
        float radius;
    };
    std::vector<Bead> beads_;
};

// The share of the sky that a point of the floor still sees below one body.
// Source  a sphere of radius r at distance d whose centre stands at an angle a from the normal
// takes r^2 / d^2 cos a of
//         the light of a uniform sky (form factor of a sphere above the horizon; Baum, Rushmeier,
//         Winget 1989).
class FloorShade {
 public:
    void make(std::span<const Sphere> spheres);
    // 1 outside of the map.
    float at(float x, float z) const;

 private:
    static constexpr int kCells = 88;
    float low_x_ = 0, low_z_ = 0, cell_ = 0.025f;
    std::vector<float> light_;  // (kCells + 1)^2
};

// The share of ambient light that each vertex gets, by `kShadeRays` rays of at most 0.45 m.
class VertexShade {
 public:
    explicit VertexShade(const figure::Mesh& mesh);
    // Vertices that look away from the eye are left out (their value is that of their neighbours).
    void make(const Tracer& tracer, const float* positions_world,
              std::span<const std::array<float, 3>> normals_world, Float3 eye_world,
              std::span<float> light);

 private:
    std::vector<std::uint32_t> first_neighbour_, neighbours_;
    std::vector<float> before_;
};

}  // namespace puppetri::render
