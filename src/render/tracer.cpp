// SPDX-License-Identifier: MIT
// Embree 3 behind the tracer. Each tracer has a device of its own without helper threads: films run
// one per thread. The tree is built anew for each picture (a few milliseconds), not refitted: a
// tree refitted from a T-pose is slow once the arms hang, and a picture must not depend on those
// drawn before.
#include "tracer.h"

#include <vector>

#include "puppetri/base/require.h"
#include "puppetri/render/picture.h"

#ifdef PUPPETRI_WITH_EMBREE
#include <embree3/rtcore.h>
#endif

namespace puppetri::render {

std::string why_no_pictures() {
#if !defined(PUPPETRI_WITH_EMBREE) || !defined(PUPPETRI_WITH_PNG)
    return "this program was built without Embree 3 or libpng, which draw and pack its pictures "
           "(on Debian: apt-get "
           "install libembree-dev libpng-dev, then build again)";
#else
    return "";
#endif
}

#ifdef PUPPETRI_WITH_EMBREE

struct Tracer::Data {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<float*> vertices;
    std::vector<RTCGeometry> geometries;

    ~Data() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
        if (device != nullptr) {
            rtcReleaseDevice(device);
        }
    }
};

Tracer::Tracer() : data_(std::make_unique<Data>()) {
    data_->device = rtcNewDevice("threads=1,set_affinity=0,start_threads=0");
    PUP_REQUIRE(data_->device != nullptr);
    data_->scene = rtcNewScene(data_->device);
    rtcSetSceneFlags(data_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(data_->scene, RTC_BUILD_QUALITY_LOW);
}

std::uint32_t Tracer::add(std::span<const std::array<std::uint32_t, 3>> triangles,
                          std::size_t vertex_count) {
    RTCGeometry geometry = rtcNewGeometry(data_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 4 * sizeof(float), vertex_count));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), triangles.size()));
    PUP_REQUIRE(vertices != nullptr && indices != nullptr);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            indices[3 * t + k] = triangles[t][k];
        }
    }
    for (std::size_t i = 0; i < 4 * vertex_count; ++i) {
        vertices[i] = 0;
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    const unsigned id = rtcAttachGeometry(data_->scene, geometry);
    rtcReleaseGeometry(geometry);  // the scene keeps it
    PUP_REQUIRE(id == data_->vertices.size());
    data_->vertices.push_back(vertices);
    data_->geometries.push_back(geometry);
    return id;
}

float* Tracer::vertices(std::uint32_t mesh) { return data_->vertices[mesh]; }
const float* Tracer::vertices_of(std::uint32_t mesh) const { return data_->vertices[mesh]; }

void Tracer::commit() {
    for (RTCGeometry geometry : data_->geometries) {
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(data_->scene);
}

namespace {

template <class Pack>
void load(const RayPack& rays, Pack& to) {
    for (std::size_t i = 0; i < kPack; ++i) {
        to.org_x[i] = rays.ox[i];
        to.org_y[i] = rays.oy[i];
        to.org_z[i] = rays.oz[i];
        to.dir_x[i] = rays.dx[i];
        to.dir_y[i] = rays.dy[i];
        to.dir_z[i] = rays.dz[i];
        to.tnear[i] = rays.near[i];
        to.tfar[i] = rays.far[i];
        to.time[i] = 0;
        to.mask[i] = ~0u;
        to.id[i] = 0;
        to.flags[i] = 0;
    }
}

struct alignas(32) Lanes {
    std::array<int, kPack> valid;
    explicit Lanes(unsigned lanes) {
        for (std::size_t i = 0; i < kPack; ++i) {
            valid[i] = (lanes >> i & 1) ? -1 : 0;
        }
    }
};

}  // namespace

void Tracer::closest(const RayPack& rays, unsigned lanes, HitPack& hits) const {
    RTCRayHit8 packet;
    load(rays, packet.ray);
    for (std::size_t i = 0; i < kPack; ++i) {
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    const Lanes valid(lanes);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid.valid.data(), data_->scene, &context, &packet);
    for (std::size_t i = 0; i < kPack; ++i) {
        hits.mesh[i] = packet.hit.geomID[i];
        hits.triangle[i] = packet.hit.primID[i];
        hits.u[i] = packet.hit.u[i];
        hits.v[i] = packet.hit.v[i];
        hits.distance[i] = packet.ray.tfar[i];
    }
}

unsigned Tracer::occluded(const RayPack& rays, unsigned lanes) const {
    RTCRay8 packet;
    load(rays, packet);
    const Lanes valid(lanes);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid.valid.data(), data_->scene, &context, &packet);
    unsigned met = 0;
    for (std::size_t i = 0; i < kPack; ++i) {
        met |= (packet.tfar[i] < 0 ? 1u : 0u) << i;  // minus infinity says so
    }
    return met & lanes;
}

#else

struct Tracer::Data {};
Tracer::Tracer() { PUP_REQUIRE(!"built without Embree: ask why_no_pictures() first"); }
std::uint32_t Tracer::add(std::span<const std::array<std::uint32_t, 3>>, std::size_t) { return 0; }
float* Tracer::vertices(std::uint32_t) { return nullptr; }
const float* Tracer::vertices_of(std::uint32_t) const { return nullptr; }
void Tracer::commit() {}
void Tracer::closest(const RayPack&, unsigned, HitPack&) const {}
unsigned Tracer::occluded(const RayPack&, unsigned) const { return 0; }

#endif

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

}  // namespace puppetri::render
