// SPDX-License-Identifier: MIT
// Rays against triangles, eight at a time. The only file that knows Embree is tracer.cpp.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace puppetri::render {

inline constexpr int kPack = 8;
inline constexpr std::uint32_t kNoHit = ~std::uint32_t{0};

struct alignas(32) RayPack {
    std::array<float, kPack> ox, oy, oz, dx, dy, dz, near, far;
};
struct alignas(32) HitPack {
    std::array<std::uint32_t, kPack> mesh, triangle;  // kNoHit where nothing was met
    std::array<float, kPack> u, v,
        distance;  // weights of the second and third vertex; in lengths of d
};

class Tracer {
 public:
    Tracer();
    ~Tracer();
    Tracer(Tracer&&) noexcept;
    Tracer& operator=(Tracer&&) noexcept;

    // Adds a mesh whose vertices will be written before each commit. Gives its number.
    std::uint32_t add(std::span<const std::array<std::uint32_t, 3>> triangles,
                      std::size_t vertex_count);
    // x y z of each vertex, four floats apart.
    float* vertices(std::uint32_t mesh);
    const float* vertices_of(std::uint32_t mesh) const;
    // Builds anew over the vertices as they are now.
    void commit();

    // Rays whose bit in `lanes` is 0 are left alone.
    void closest(const RayPack& rays, unsigned lanes, HitPack& hits) const;
    // Bits of the rays that meet anything.
    unsigned occluded(const RayPack& rays, unsigned lanes) const;

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace puppetri::render
