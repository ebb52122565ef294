// SPDX-License-Identifier: MIT
// Drawing one picture. Rays are spent only where something can be met: tiles of the picture that a
// projected triangle touches get primary rays, tiles that its shadow on the ground touches get
// shadow rays; sky and ground are formulas. Pixels where neighbours disagree (outlines, rims of
// shadows) get more samples afterwards.
#include "puppetri/render/picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "environment.h"
#include "float3.h"
#include "lanes.h"
#include "puppetri/base/require.h"
#include "shade_maps.h"
#include "skin.h"
#include "texture.h"
#include "tone.h"
#include "tracer.h"

namespace puppetri::render {
namespace {

constexpr int kTile = 16;
constexpr std::uint16_t kSkyId = 0, kGroundId = 1, kFirstMeshId = 2;
constexpr float kSunRadius = 0.007f;  // of the sun's disc, radians; the true one is 0.0047
constexpr int kShadowSamples = 8;

struct Object {
    const figure::Mesh* mesh = nullptr;
    std::uint32_t traced = 0;  // number in the tracer
    std::vector<std::array<float, 3>> normals_world;
    std::vector<float> light;                // ambient, per vertex
    std::vector<std::uint16_t> material_of;  // per triangle
    std::uint16_t first_id = 0;              // ids of its materials follow each other
    std::vector<std::optional<TextureImage>> textures;
    std::vector<Sphere> spheres;
    FloorShade floor;
};

// A pixel's position and size, for shading: the camera in world space.
struct Eye {
    Float3 at, right, up, ahead;  // right and up are scaled to half the picture at distance 1
    float step = 0;               // the angle of one pixel, about
};

struct Sample {
    Float3 light;
    float depth = 1e9f;
    std::uint16_t id = kSkyId;
};

}  // namespace

namespace {

// Over the photographer's left shoulder, so that faces are lit and shadows fall aside and back.
Vec3 sun_over_the_shoulder(const View& view) {
    const Vec3 back = rotate(view.world_from_camera.rotation, {0, 0, 1}),
               left = rotate(view.world_from_camera.rotation, {-1, 0, 0});
    const Vec3 level = normalized(Vec3{back.x, 0, back.z}, {0, 0, 1}) * 0.61 +
                       normalized(Vec3{left.x, 0, left.z}, {-1, 0, 0}) * 0.79;
    return normalized(level) * 0.68 + Vec3{0, 0.74, 0};
}

}  // namespace

struct PictureMaker::Data {
    Data(const RenderScene& s, int w, int h)
        : scene(s),
          width(w),
          height(h),
          environment(s.look.to_sun_world.value_or(sun_over_the_shoulder(s.camera->view({}))),
                      s.sets) {}

    RenderScene scene;
    int width, height, tiles_x = 0, tiles_y = 0;
    Environment environment;
    Tone tone;
    Tracer tracer;
    std::vector<Object> objects;  // actors, then props
    std::vector<Skin> skins;      // of actors
    std::vector<BodySpheres> bodies;
    std::vector<VertexShade> shades;
    std::vector<Transform> world_from_joint;
    figure::Pose pose;
    Eye eye;
    std::vector<std::uint8_t> seen,
        shaded;  // per tile: may a primary ray, a shadow ray from the ground, meet anything
    std::vector<Float3> light;  // per pixel
    std::vector<float> depth;
    std::vector<std::uint16_t> ids;
    std::vector<std::uint8_t> sunlit;  // per pixel of the ground: 1 in the sun
    std::vector<std::array<float, 2>> projected;

    void add(const figure::Mesh* mesh) {
        Object o;
        o.mesh = mesh;
        o.traced = tracer.add(mesh->triangles, mesh->positions.size());
        o.normals_world.resize(mesh->positions.size());
        o.light.resize(mesh->positions.size(), 1.0f);
        o.material_of.resize(mesh->triangles.size());
        for (const figure::Texture& texture : mesh->textures) {
            o.textures.push_back(TextureImage::decode(texture));
        }
        for (const figure::MeshPart& part : mesh->parts) {
            for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
                o.material_of[part.first_triangle + t] = static_cast<std::uint16_t>(part.material);
            }
        }
        o.first_id = objects.empty()
                         ? kFirstMeshId
                         : static_cast<std::uint16_t>(objects.back().first_id +
                                                      objects.back().mesh->materials.size());
        objects.push_back(std::move(o));
        shades.emplace_back(*mesh);
    }

    void pose_all(SimTime at);
    void set_eye(SimTime at);
    void mark_tiles();
    void mark(const std::vector<std::array<float, 2>>& points, const figure::Mesh& mesh,
              std::vector<std::uint8_t>& tiles);
    bool project(Float3 p, std::array<float, 2>& out) const;
    Float3 direction(float x, float y) const;
    void background(const std::array<Float3, kPack>& d, unsigned lanes, const Lanes8& sun_share,
                    std::array<Sample, kPack>& out) const;
    void shade(const std::array<float, kPack>& x, const std::array<float, kPack>& y, unsigned lanes,
               bool primary, bool shadows, std::array<Sample, kPack>& out,
               std::array<std::uint8_t, kPack>* lit) const;
    void first_pass();
    void refine_outlines();
    void refine_shadows();
    void develop(Picture& out) const;
};

PictureMaker::PictureMaker(const RenderScene& scene, int width, int height) {
    PUP_REQUIRE(scene.performance != nullptr && scene.camera != nullptr);
    PUP_REQUIRE(width >= 16 && height >= 16 && width <= 8192 && height <= 8192);
    data_ = std::make_unique<Data>(scene, width, height);
    Data& d = *data_;
    d.tiles_x = (width + kTile - 1) / kTile;
    d.tiles_y = (height + kTile - 1) / kTile;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    d.light.resize(pixels);
    d.depth.resize(pixels);
    d.ids.resize(pixels);
    d.sunlit.resize(pixels);
    for (const stage::ActorView& a : scene.performance->actors()) {
        d.add(a.mesh);
        d.skins.emplace_back(*a.skeleton, *a.mesh);
        d.bodies.emplace_back(*a.skeleton, *a.mesh);
    }
    for (const stage::PropView& p : scene.performance->props()) {
        d.add(p.mesh);
    }
}

PictureMaker::~PictureMaker() = default;
PictureMaker::PictureMaker(PictureMaker&&) noexcept = default;
PictureMaker& PictureMaker::operator=(PictureMaker&&) noexcept = default;

void PictureMaker::draw(SimTime at, Picture& out) {
    data_->pose_all(at);
    data_->set_eye(at);
    data_->mark_tiles();
    data_->first_pass();
    data_->refine_shadows();
    data_->refine_outlines();
    data_->develop(out);
}

void PictureMaker::Data::pose_all(SimTime at) {
    const auto actors = scene.performance->actors();
    for (std::uint32_t a = 0; a < actors.size(); ++a) {
        Object& o = objects[a];
        scene.performance->pose({a}, at, pose);
        skins[a].apply(pose, tracer.vertices(o.traced), o.normals_world);
        world_from_joint.resize(actors[a].skeleton->joints.size());
        figure::to_model_space(*actors[a].skeleton, pose, world_from_joint);
        bodies[a].at(world_from_joint, o.spheres);
    }
    const auto props = scene.performance->props();
    for (std::uint32_t p = 0; p < props.size(); ++p) {
        Object& o = objects[actors.size() + p];
        const Transform where = scene.performance->world_from_prop({p}, at);
        place(*o.mesh, where, tracer.vertices(o.traced), o.normals_world);
        const Vec3 size = props[p].size_m;
        const bool ball = props[p].shape == stage::PropShape::kSphere;
        o.spheres = {
            {float3(where.translation),
             static_cast<float>(ball ? size.x / 2 : std::min({size.x, size.y, size.z}) / 2)}};
    }
    tracer.commit();
}

void PictureMaker::Data::set_eye(SimTime at) {
    const View view = scene.camera->view(at);
    const Quat q = view.world_from_camera.rotation;
    const double half = std::tan(view.fov_rad / 2);
    eye.at = float3(view.world_from_camera.translation);
    eye.right = float3(rotate(q, {1, 0, 0}) * (half * width / height));
    eye.up = float3(rotate(q, {0, 1, 0}) * half);
    eye.ahead = float3(rotate(q, {0, 0, -1}));
    eye.step = static_cast<float>(2 * half / height);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        shades[i].make(tracer, tracer.vertices(objects[i].traced), objects[i].normals_world, eye.at,
                       objects[i].light);
        objects[i].floor.make(objects[i].spheres);
    }
}

// Pixels; false behind the eye.
bool PictureMaker::Data::project(Float3 p, std::array<float, 2>& out) const {
    const Float3 d = p - eye.at;
    const float ahead_m = dot(d, eye.ahead);
    if (ahead_m < 0.05f) {
        return false;
    }
    const float x = dot(d, eye.right) / (dot(eye.right, eye.right) * ahead_m);
    const float y = dot(d, eye.up) / (dot(eye.up, eye.up) * ahead_m);
    out = {(x + 1) * 0.5f * static_cast<float>(width), (1 - y) * 0.5f * static_cast<float>(height)};
    return true;
}

Float3 PictureMaker::Data::direction(float x, float y) const {
    const float u = 2 * x / static_cast<float>(width) - 1,
                v = 1 - 2 * y / static_cast<float>(height);
    return normalized(eye.ahead + eye.right * u + eye.up * v);
}

void PictureMaker::Data::mark(const std::vector<std::array<float, 2>>& points,
                              const figure::Mesh& mesh, std::vector<std::uint8_t>& tiles) {
    for (const auto& t : mesh.triangles) {
        const auto &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
        // Half a pixel more: samples may lie beside the centre.
        const float x0 = std::min({a[0], b[0], c[0]}) - 1, x1 = std::max({a[0], b[0], c[0]}) + 1;
        const float y0 = std::min({a[1], b[1], c[1]}) - 1, y1 = std::max({a[1], b[1], c[1]}) + 1;
        if (x1 < 0 || y1 < 0 || x0 >= static_cast<float>(width) ||
            y0 >= static_cast<float>(height)) {
            continue;
        }
        const int tx0 = std::max(0, static_cast<int>(x0) / kTile),
                  ty0 = std::max(0, static_cast<int>(y0) / kTile);
        const int tx1 = std::min(tiles_x - 1, static_cast<int>(std::min(x1, 1e5f)) / kTile);
        const int ty1 = std::min(tiles_y - 1, static_cast<int>(std::min(y1, 1e5f)) / kTile);
        for (int ty = ty0; ty <= ty1; ++ty) {
            for (int tx = tx0; tx <= tx1; ++tx) {
                tiles[static_cast<std::size_t>(ty * tiles_x + tx)] = 1;
            }
        }
    }
}

void PictureMaker::Data::mark_tiles() {
    const auto count = static_cast<std::size_t>(tiles_x * tiles_y);
    seen.assign(count, 0);
    shaded.assign(count, 0);
    const Float3 sun = environment.to_sun();
    for (const Object& o : objects) {
        const float* p = tracer.vertices(o.traced);
        for (const bool shadow : {false, true}) {
            bool all = true, any = false;
            projected.resize(o.mesh->positions.size());
            for (std::size_t v = 0; v < projected.size(); ++v) {
                Float3 at{p[4 * v], p[4 * v + 1], p[4 * v + 2]};
                if (shadow) {
                    at = at - sun * (at.y / sun.y);
                }
                const bool before = project(at, projected[v]);
                all = all && before;
                any = any || before;
            }
            std::vector<std::uint8_t>& tiles = shadow ? shaded : seen;
            if (all) {
                mark(projected, *o.mesh, tiles);
            } else if (any) {
                tiles.assign(count, 1);  // around the eye: look everywhere
            }
        }
    }
}

// Sky or ground in each direction; sun_share: of the sun that reaches the ground there.
void PictureMaker::Data::background(const std::array<Float3, kPack>& d, unsigned lanes,
                                    const Lanes8& sun_share, std::array<Sample, kPack>& out) const {
    GroundPoints points{};
    Lanes8 distance{};
    unsigned down = 0;
    for (std::size_t i = 0; i < kPack; ++i) {
        if (d[i].y > -1e-3f || eye.at.y <= 0) {
            continue;
        }
        down |= (lanes >> i & 1) << i;
        distance[i] = -eye.at.y / d[i].y;
        points.x[i] = eye.at.x + d[i].x * distance[i];
        points.z[i] = eye.at.z + d[i].z * distance[i];
        // How far a pixel reaches on the ground: its two sides, projected along the ray.
        const float size = distance[i] * eye.step, slant = 1 / -d[i].y;
        const float flat = std::max(1e-4f, std::sqrt(d[i].x * d[i].x + d[i].z * d[i].z));
        const float cx = std::fabs(d[i].x) / flat, cz = std::fabs(d[i].z) / flat;
        points.width_x[i] = size * (cx * slant + cz);
        points.width_z[i] = size * (cz * slant + cx);
    }
    Colours8 albedo;
    if (down != 0) {
        environment.ground(points, albedo);
    }
    const Float3 sun = environment.sun() * environment.to_sun().y,
                 sky = environment.ambient({0, 1, 0});
    for (std::size_t i = 0; i < kPack; ++i) {
        if (!(lanes >> i & 1)) {
            continue;
        }
        if (!(down >> i & 1)) {
            out[i] = {environment.sky(d[i]), 1e9f, kSkyId};
            continue;
        }
        float ambient = 1;
        for (const Object& o : objects) {
            ambient *= o.floor.at(points.x[i], points.z[i]);
        }
        const Float3 light_here = albedo.at(i) * (sun * sun_share[i] + sky * ambient);
        out[i] = {environment.haze(light_here, distance[i]), distance[i], kGroundId};
    }
}

namespace {

// The base colour texture at a point of a triangle that a pixel of this width sees; white without.
Float3 texture_colour(const Object& o, const figure::Material& material,
                      const std::array<std::uint32_t, 3>& t, const std::array<float, 3>& weights,
                      const std::array<Float3, 3>& corner_world, float width_world) {
    if (material.base_colour_texture >= o.textures.size() || o.mesh->uvs.empty() ||
        !o.textures[material.base_colour_texture]) {
        return {1, 1, 1};
    }
    const auto &a = o.mesh->uvs[t[0]], &b = o.mesh->uvs[t[1]], &c = o.mesh->uvs[t[2]];
    const float u = a[0] * weights[0] + b[0] * weights[1] + c[0] * weights[2],
                v = a[1] * weights[0] + b[1] * weights[1] + c[1] * weights[2];
    const float in_picture =
        std::fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    const Float3 span = cross(corner_world[1] - corner_world[0], corner_world[2] - corner_world[0]);
    const float in_world = std::sqrt(dot(span, span));
    const float width = in_world > 0 ? width_world * std::sqrt(in_picture / in_world) : 0.0f;
    return o.textures[material.base_colour_texture]->at(u, v, width);
}

}  // namespace

void PictureMaker::Data::shade(const std::array<float, kPack>& x, const std::array<float, kPack>& y,
                               unsigned lanes, bool primary, bool shadows,
                               std::array<Sample, kPack>& out,
                               std::array<std::uint8_t, kPack>* lit) const {
    RayPack rays;
    HitPack hits;
    std::array<Float3, kPack> d;
    for (std::size_t i = 0; i < kPack; ++i) {
        d[i] = direction(x[i], y[i]);
        rays.ox[i] = eye.at.x;
        rays.oy[i] = eye.at.y;
        rays.oz[i] = eye.at.z;
        rays.dx[i] = d[i].x;
        rays.dy[i] = d[i].y;
        rays.dz[i] = d[i].z;
        rays.near[i] = 0.02f;
        rays.far[i] = 1e6f;
        hits.mesh[i] = kNoHit;
    }
    if (primary) {
        tracer.closest(rays, lanes, hits);
    }
    struct Surface {
        Float3 normal;
        float ambient = 1;
        const figure::Material* material = nullptr;
        Float3 albedo;
    };
    std::array<Surface, kPack> surfaces;
    unsigned to_sun = 0;
    const Float3 sun = environment.to_sun();
    for (std::size_t i = 0; i < kPack; ++i) {
        if (!(lanes >> i & 1)) {
            continue;
        }
        Float3 start;
        if (hits.mesh[i] == kNoHit) {
            if (!shadows || d[i].y > -1e-3f) {
                continue;
            }
            const float distance = -eye.at.y / d[i].y;
            start = eye.at + d[i] * distance;
            start.y = 1e-4f;
            to_sun |= 1u << i;
        } else {
            const Object& o = objects[hits.mesh[i]];
            const float* p = tracer.vertices_of(o.traced);
            const auto& t = o.mesh->triangles[hits.triangle[i]];
            const std::array<float, 3> w{1 - hits.u[i] - hits.v[i], hits.u[i], hits.v[i]};
            std::array<Float3, 3> corner, normal;
            Float3 n{}, at{};
            float ambient = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k] = {p[4 * t[k]], p[4 * t[k] + 1], p[4 * t[k] + 2]};
                normal[k] = float3(o.normals_world[t[k]]);
                n = n + normal[k] * w[k];
                at = at + corner[k] * w[k];
                ambient += w[k] * o.light[t[k]];
            }
            n = normalized(n);
            if (dot(n, d[i]) > 0) {  // seen at a grazing angle, just beyond the outline
                n = normalized(n - d[i] * (dot(n, d[i]) * 1.02f));
            }
            const figure::Material& material = o.mesh->materials[o.material_of[hits.triangle[i]]];
            surfaces[i] = {
                n, ambient, &material,
                float3(material.base_colour) *
                    texture_colour(o, material, t, w, corner, hits.distance[i] * eye.step)};
            out[i].id = static_cast<std::uint16_t>(o.first_id + o.material_of[hits.triangle[i]]);
            out[i].depth = hits.distance[i];
            if (dot(n, sun) > 0) {
                // The shadow ray starts on the smooth surface, not on the flat triangle below it,
                // or the border between light and dark would show the triangles. Source  J. Hanika,
                // "Hacking the shadow terminator", Ray Tracing Gems II, 2021.
                Float3 lift{};
                for (std::size_t k = 0; k < 3; ++k) {
                    lift =
                        lift + normal[k] * (w[k] * -std::min(0.0f, dot(at - corner[k], normal[k])));
                }
                start = at + lift + n * 0.002f;
                to_sun |= 1u << i;
            }
        }
        rays.ox[i] = start.x;
        rays.oy[i] = start.y;
        rays.oz[i] = start.z;
        rays.dx[i] = sun.x;
        rays.dy[i] = sun.y;
        rays.dz[i] = sun.z;
        rays.near[i] = 0;
        rays.far[i] = 100;
    }
    const unsigned dark = to_sun != 0 ? tracer.occluded(rays, to_sun) : 0;
    Lanes8 sun_share;
    unsigned missed = 0;
    for (std::size_t i = 0; i < kPack; ++i) {
        sun_share[i] = dark >> i & 1 ? 0.0f : 1.0f;
        missed |= (surfaces[i].material == nullptr ? 1u : 0u) << i;
    }
    if ((missed & lanes) != 0) {
        background(d, missed & lanes, sun_share, out);
    }
    for (std::size_t i = 0; i < kPack; ++i) {
        if (!(lanes >> i & 1)) {
            continue;
        }
        const bool shadow = dark >> i & 1;
        if (lit != nullptr) {
            (*lit)[i] = !shadow;
        }
        if (surfaces[i].material == nullptr) {
            continue;
        }
        const Surface& s = surfaces[i];
        const Float3 n = s.normal;
        const Float3 albedo = s.albedo;
        const float facing = shadow ? 0 : std::max(0.0f, dot(n, sun));
        const Float3 ambient = environment.ambient(n) * (0.25f + 0.75f * s.ambient) * s.ambient;
        Float3 shine = albedo * (environment.sun() * facing + ambient);
        // A little shine: Blinn and Phong's highlight of the sun, and the sky mirrored at grazing
        // angles (Schlick).
        const float gloss = 1 - s.material->roughness;
        const Float3 half = normalized(sun - d[i]);
        const float power = 8 + 90 * gloss * gloss;
        if (facing > 0) {
            shine = shine + environment.sun() * (facing * 0.10f * gloss * (power + 8) / 25 *
                                                 std::pow(std::max(0.0f, dot(n, half)), power));
        }
        const float grazing = 1 - std::max(0.0f, -dot(n, d[i]));
        const float g2 = grazing * grazing;
        shine = shine + environment.ambient({n.x, 0.6f + 0.4f * n.y, n.z}) *
                            (s.ambient * (0.35f * g2 * g2 * grazing) * (0.35f + gloss));
        out[i].light = environment.haze(shine, out[i].depth);
    }
}

void PictureMaker::Data::first_pass() {
    std::array<float, kPack> x, y;
    std::array<Sample, kPack> samples;
    std::array<std::uint8_t, kPack> lit;
    std::array<Float3, kPack> d;
    Lanes8 in_sun;
    in_sun.fill(1);
    for (int ty = 0; ty < tiles_y; ++ty) {
        for (int tx = 0; tx < tiles_x; ++tx) {
            const auto tile = static_cast<std::size_t>(ty * tiles_x + tx);
            const bool primary = seen[tile], shadows = shaded[tile];
            for (int py = 0; py < kTile; py += 2) {
                for (int px = 0; px < kTile; px += 4) {
                    unsigned lanes = 0;
                    std::array<std::size_t, kPack> pixel;
                    for (int i = 0; i < kPack; ++i) {
                        const int ix = tx * kTile + px + i % 4, iy = ty * kTile + py + i / 4;
                        const auto k = static_cast<std::size_t>(i);
                        x[k] = static_cast<float>(ix) + 0.5f;
                        y[k] = static_cast<float>(iy) + 0.5f;
                        pixel[k] = static_cast<std::size_t>(iy) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(ix);
                        lanes |= (ix < width && iy < height ? 1u : 0u) << i;
                    }
                    lit.fill(1);
                    if (primary || shadows) {
                        shade(x, y, lanes, primary, shadows, samples, &lit);
                    } else {
                        for (std::size_t i = 0; i < kPack; ++i) {
                            d[i] = direction(x[i], y[i]);
                        }
                        background(d, lanes, in_sun, samples);
                    }
                    for (std::size_t i = 0; i < kPack; ++i) {
                        if (lanes >> i & 1) {
                            light[pixel[i]] = samples[i].light;
                            depth[pixel[i]] = samples[i].depth;
                            ids[pixel[i]] = samples[i].id;
                            sunlit[pixel[i]] = lit[i];
                        }
                    }
                }
            }
        }
    }
}

// Rims of shadows on the ground: several rays to the disc of the sun.
void PictureMaker::Data::refine_shadows() {
    static constexpr int kReach = 3;
    static const std::array<std::array<float, 2>, kShadowSamples> kDisc = [] {
        std::array<std::array<float, 2>, kShadowSamples> all{};
        for (int i = 0; i < kShadowSamples; ++i) {
            const float r = std::sqrt((static_cast<float>(i) + 0.5f) / kShadowSamples),
                        a = 2.399963f * static_cast<float>(i);
            all[static_cast<std::size_t>(i)] = {r * std::cos(a), r * std::sin(a)};
        }
        return all;
    }();
    const Float3 sun = environment.to_sun();
    const Float3 side = normalized(cross(sun, {0, 1, 0})), other = cross(side, sun);
    RayPack rays;
    for (std::size_t i = 0; i < kPack; ++i) {
        const Float3 way = normalized(sun + side * (kDisc[i][0] * kSunRadius) +
                                      other * (kDisc[i][1] * kSunRadius));
        rays.dx[i] = way.x;
        rays.dy[i] = way.y;
        rays.dz[i] = way.z;
        rays.near[i] = 0;
        rays.far[i] = 100;
    }
    for (int ty = 0; ty < tiles_y; ++ty) {
        for (int tx = 0; tx < tiles_x; ++tx) {
            if (!shaded[static_cast<std::size_t>(ty * tiles_x + tx)]) {
                continue;
            }
            for (int py = ty * kTile; py < std::min(height, (ty + 1) * kTile); ++py) {
                for (int px = tx * kTile; px < std::min(width, (tx + 1) * kTile); ++px) {
                    const auto at = static_cast<std::size_t>(py) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(px);
                    if (ids[at] != kGroundId) {
                        continue;
                    }
                    bool rim = false;
                    for (const auto& [ox, oy] : {std::array<int, 2>{1, 0},
                                                 {-1, 0},
                                                 {0, 1},
                                                 {0, -1},
                                                 {kReach, 0},
                                                 {-kReach, 0},
                                                 {0, 2},
                                                 {0, -2}}) {
                        const int nx = px + ox, ny = py + oy;
                        if (nx < 0 || ny < 0 || nx >= width || ny >= height) {
                            continue;
                        }
                        const auto near =
                            static_cast<std::size_t>(ny) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(nx);
                        rim = rim || (ids[near] == kGroundId && sunlit[near] != sunlit[at]);
                    }
                    if (!rim) {
                        continue;
                    }
                    unsigned open = 0;
                    for (std::size_t i = 0; i < kPack; ++i) {
                        // Samples spread over the pixel as over the sun.
                        const Float3 way =
                            direction(static_cast<float>(px) + 0.5f + 0.5f * kDisc[i][1],
                                      static_cast<float>(py) + 0.5f + 0.5f * kDisc[i][0]);
                        const float distance = way.y < -1e-4f ? -eye.at.y / way.y : 0;
                        rays.ox[i] = eye.at.x + way.x * distance;
                        rays.oy[i] = 1e-4f;
                        rays.oz[i] = eye.at.z + way.z * distance;
                    }
                    open = static_cast<unsigned>(kPack -
                                                 __builtin_popcount(tracer.occluded(rays, 0xFF)));
                    std::array<Float3, kPack> d{};
                    std::array<Sample, kPack> samples;
                    d[0] = direction(static_cast<float>(px) + 0.5f, static_cast<float>(py) + 0.5f);
                    background(d, 1, {static_cast<float>(open) / kPack}, samples);
                    light[at] = samples[0].light;
                }
            }
        }
    }
}

// Outlines: more primary rays where neighbours show different things.
void PictureMaker::Data::refine_outlines() {
    const int extra = scene.look.edge_samples;
    if (extra <= 0) {
        return;
    }
    std::array<float, kPack> x{}, y{};
    std::array<Sample, kPack> samples;
    std::array<std::size_t, kPack> owner{};
    int filled = 0;
    std::vector<Float3> sum;
    std::vector<std::size_t> pixels;
    const auto differ = [&](std::size_t a, std::size_t b) {
        if (ids[a] != ids[b]) {
            return ids[a] > kGroundId || ids[b] > kGroundId;
        }
        return ids[a] > kGroundId && std::fabs(depth[a] - depth[b]) > 0.02f + 0.004f * depth[a];
    };
    for (int py = 0; py < height; ++py) {
        for (int px = 0; px < width; ++px) {
            const auto w = static_cast<std::size_t>(width);
            const auto at = static_cast<std::size_t>(py) * w + static_cast<std::size_t>(px);
            if ((px + 1 < width && differ(at, at + 1)) || (px > 0 && differ(at, at - 1)) ||
                (py + 1 < height && differ(at, at + w)) || (py > 0 && differ(at, at - w))) {
                pixels.push_back(at);
            }
        }
    }
    sum.resize(pixels.size());
    const auto flush = [&] {
        shade(x, y, (1u << filled) - 1, true, true, samples, nullptr);
        for (int i = 0; i < filled; ++i) {
            const auto k = static_cast<std::size_t>(i);
            sum[owner[k]] = sum[owner[k]] + samples[k].light;
        }
        filled = 0;
    };
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const auto px = static_cast<float>(pixels[p] % static_cast<std::size_t>(width));
        const auto py = static_cast<float>(pixels[p] / static_cast<std::size_t>(width));
        for (int s = 0; s < extra; ++s) {
            // An additive sequence with good spread in the plane (R2; M. Roberts, 2018), without
            // the middle.
            const float u = 0.7548777f * static_cast<float>(s + 1) + 0.25f,
                        v = 0.5698403f * static_cast<float>(s + 1) + 0.25f;
            x[static_cast<std::size_t>(filled)] = px + u - std::floor(u);
            y[static_cast<std::size_t>(filled)] = py + v - std::floor(v);
            owner[static_cast<std::size_t>(filled)] = p;
            if (++filled == kPack) {
                flush();
            }
        }
    }
    if (filled > 0) {
        flush();
    }
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        light[pixels[p]] = (light[pixels[p]] + sum[p]) * (1.0f / static_cast<float>(extra + 1));
    }
}

void PictureMaker::Data::develop(Picture& out) const {
    // A Bayer matrix of 8 x 8 hides the steps of eight-bit skies.
    static constexpr std::array<std::uint8_t, 64> kBayer = [] {
        std::array<std::uint8_t, 64> m{};
        for (unsigned y = 0; y < 8; ++y) {
            for (unsigned x = 0; x < 8; ++x) {
                unsigned v = 0;
                for (unsigned bit = 0; bit < 3; ++bit) {
                    v = v << 2 | (((x ^ y) >> bit & 1) << 1 | (y >> bit & 1));
                }
                m[y * 8 + x] = static_cast<std::uint8_t>(v);
            }
        }
        return m;
    }();
    out.width = width;
    out.height = height;
    out.rgb.resize(light.size() * 3);
    for (int py = 0; py < height; ++py) {
        for (int px = 0; px < width; ++px) {
            const auto at = static_cast<std::size_t>(py) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(px);
            const float noise =
                scene.look.dither
                    ? (kBayer[static_cast<std::size_t>((py & 7) * 8 + (px & 7))] + 0.5f) / 64.0f
                    : 0.5f;
            out.rgb[3 * at] =
                static_cast<std::uint8_t>(std::min(255.0f, tone(light[at].x) + noise));
            out.rgb[3 * at + 1] =
                static_cast<std::uint8_t>(std::min(255.0f, tone(light[at].y) + noise));
            out.rgb[3 * at + 2] =
                static_cast<std::uint8_t>(std::min(255.0f, tone(light[at].z) + noise));
        }
    }
}

}  // namespace puppetri::render
