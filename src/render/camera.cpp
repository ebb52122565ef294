// SPDX-License-Identifier: MIT
// The path of a camera: sampled, widened, smoothed.
//
// The middle of those kept in view is sampled 8 times a second and smoothed by a Gaussian of 0.7 s
// (it looks ahead, so that there is no lag). A field of view is then chosen for the whole film, and
// where even that is not enough the distance by which the camera must step back is taken as the
// largest need of the second around, smoothed: never less than needed, never a jerk. Keys are
// control points of a uniform cubic B-spline, twice continuously differentiable.
#include "puppetri/render/camera.h"

#include <algorithm>
#include <cmath>

#include "puppetri/base/require.h"

namespace puppetri::render {
namespace {

constexpr double kKeysPerSecond = 8;
constexpr double kSmoothing_s = 0.7;
constexpr double kMargin = 0.86;  // of the half picture that those kept in view may use
constexpr double kSmallestFov_rad = 0.209, kLargestFov_rad = 1.047;  // 12 and 60 degrees

SimTime instant(double seconds) {
    return {
        static_cast<std::int64_t>(std::llround(seconds * static_cast<double>(kTicksPerSecond)))};
}

// A Gaussian over the keys; beyond both ends the path goes on straight (odd reflection), so that a
// camera which travels with walkers neither waits at the start nor at the end.
template <class T>
std::vector<T> smoothed(const std::vector<T>& keys, double sigma_keys) {
    const int n = static_cast<int>(keys.size());
    const int reach = static_cast<int>(std::ceil(3 * sigma_keys));
    const auto at = [&](int i) {
        if (i < 0) {
            return keys.front() * 2 - keys[static_cast<std::size_t>(std::min(-i, n - 1))];
        }
        if (i >= n) {
            return keys.back() * 2 - keys[static_cast<std::size_t>(std::max(2 * n - 2 - i, 0))];
        }
        return keys[static_cast<std::size_t>(i)];
    };
    std::vector<T> out(keys.size());
    for (int i = 0; i < n; ++i) {
        T sum{};
        double total = 0;
        for (int k = -reach; k <= reach; ++k) {
            const double w = std::exp(-0.5 * (k / sigma_keys) * (k / sigma_keys));
            sum = sum + at(i + k) * w;
            total += w;
        }
        out[static_cast<std::size_t>(i)] = sum * (1 / total);
    }
    return out;
}

struct Axes {
    Vec3 right, up, back;
};

Axes axes_towards(Vec3 eye, Vec3 target) {
    const Vec3 back = normalized(eye - target, {0, 0, 1});
    const Vec3 right = normalized(cross({0, 1, 0}, back), {1, 0, 0});
    return {right, cross(back, right), back};
}

Quat rotation_of(const Axes& a) {
    // From a rotation matrix with columns right, up, back (Shepperd's method: the largest component
    // first).
    const double trace = a.right.x + a.up.y + a.back.z;
    Quat q;
    if (trace > 0) {
        const double s = 2 * std::sqrt(trace + 1);
        q = {(a.up.z - a.back.y) / s, (a.back.x - a.right.z) / s, (a.right.y - a.up.x) / s, s / 4};
    } else if (a.right.x > a.up.y && a.right.x > a.back.z) {
        const double s = 2 * std::sqrt(1 + a.right.x - a.up.y - a.back.z);
        q = {s / 4, (a.right.y + a.up.x) / s, (a.back.x + a.right.z) / s, (a.up.z - a.back.y) / s};
    } else if (a.up.y > a.back.z) {
        const double s = 2 * std::sqrt(1 + a.up.y - a.right.x - a.back.z);
        q = {(a.right.y + a.up.x) / s, s / 4, (a.back.y + a.up.z) / s, (a.back.x - a.right.z) / s};
    } else {
        const double s = 2 * std::sqrt(1 + a.back.z - a.right.x - a.up.y);
        q = {(a.back.x + a.right.z) / s, (a.back.y + a.up.z) / s, s / 4, (a.right.y - a.up.x) / s};
    }
    return q;
}

}  // namespace

scene::Camera default_camera(const stage::Performance& performance) {
    scene::Camera camera;
    camera.name = "default";
    const auto actors = performance.actors();
    if (actors.empty()) {
        return camera;
    }
    Vec3 low{1e9, 0, 1e9}, high{-1e9, 0, -1e9};
    double tallest = 0;
    figure::Pose pose;
    for (std::uint32_t a = 0; a < actors.size(); ++a) {
        performance.pose({a}, {}, pose);
        const Vec3 p = pose.parent_from_joint[0].translation;
        low = {std::min(low.x, p.x), 0, std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), 0, std::max(high.z, p.z)};
        tallest = std::max(tallest, actors[a].skeleton->height_m);
        camera.keeps.push_back({a});
    }
    const Vec3 middle = (low + high) * 0.5, spread = high - low;
    const double away = std::max(2.6 * tallest, 1.3 * std::max(spread.x, spread.z) + tallest);
    Vec3 ahead;
    for (std::uint32_t a = 0; a < actors.size(); ++a) {
        performance.pose({a}, {}, pose);
        ahead = ahead + rotate(pose.parent_from_joint[0].rotation, {0, 0, 1}) *
                            (1.0 / static_cast<double>(actors.size()));
    }
    Vec3 side;
    if (length(ahead) > 0.5) {  // they look one way: before them, a little aside
        side = normalized(ahead) * 0.8 + normalized(Vec3{ahead.z, 0, -ahead.x}) * 0.6;
    } else {  // they look at each other: across the line between them
        side = spread.x >= spread.z ? Vec3{0.2, 0, 1} : Vec3{1, 0, 0.2};
    }
    camera.at_world = middle + normalized(side) * away + Vec3{0, 0.85 * tallest, 0};
    camera.moves_with_them = true;
    return camera;
}

CameraPath::CameraPath(const scene::Camera& camera, const stage::Performance& performance,
                       double aspect) {
    PUP_REQUIRE(aspect > 0);
    fov_rad_ = camera.fov_rad.value_or(0.61);
    const Vec3 ahead = camera.looking_at_world.value_or(camera.at_world + Vec3{0, 0, -1});
    if (camera.keeps.empty()) {
        keys_ = {{camera.at_world, ahead}};
        return;
    }
    const double duration_s = performance.duration().seconds();
    const int count = 2 + static_cast<int>(std::ceil(duration_s * kKeysPerSecond));
    std::vector<Vec3> middle;
    std::vector<std::vector<Vec3>> bodies(
        static_cast<std::size_t>(count));  // points to keep in view
    figure::Pose pose;
    std::vector<Transform> world_from_joint;
    double height = 0;
    for (const stage::ActorIndex a : camera.keeps) {
        PUP_REQUIRE(a.value < performance.actors().size());
        height += performance.actors()[a.value].skeleton->height_m /
                  static_cast<double>(camera.keeps.size());
    }
    for (int k = 0; k < count; ++k) {
        const SimTime at = std::min(instant(k / kKeysPerSecond), performance.duration());
        Vec3 sum;
        for (const stage::ActorIndex a : camera.keeps) {
            const figure::Skeleton& skeleton = *performance.actors()[a.value].skeleton;
            performance.pose(a, at, pose);
            world_from_joint.resize(skeleton.joints.size());
            figure::to_model_space(skeleton, pose, world_from_joint);
            Vec3 mean;
            for (std::size_t j = 0; j < world_from_joint.size(); ++j) {
                const Vec3 tip = world_from_joint[j] * skeleton.joints[j].end_site_joint;
                mean = mean + tip * (1.0 / static_cast<double>(world_from_joint.size()));
                bodies[static_cast<std::size_t>(k)].push_back(tip);
            }
            sum = sum + mean * (1.0 / static_cast<double>(camera.keeps.size()));
        }
        middle.push_back({sum.x, 0.52 * height, sum.z});
    }
    middle = smoothed(middle, kSmoothing_s * kKeysPerSecond);
    const Vec3 offset = camera.at_world - middle.front();
    for (int k = 0; k < count; ++k) {
        const Vec3 m = middle[static_cast<std::size_t>(k)];
        const Vec3 eye = camera.moves_with_them ? m + offset : camera.at_world;
        keys_.push_back({eye, camera.looking_at_world.value_or(m)});
    }
    // The half height at distance 1 that each key needs.
    std::vector<double> back(keys_.size(), 0.0);
    double needed = 0;
    const auto each_point = [&](auto&& use) {
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const Axes axes = axes_towards(keys_[k].eye_world, keys_[k].target_world);
            for (const Vec3 p : bodies[k]) {
                const Vec3 d = p - keys_[k].eye_world;
                // Vertical extent is padded by flesh and hair around the joints.
                use(k,
                    std::max((std::fabs(dot(d, axes.right)) + 0.1) / aspect,
                             std::fabs(dot(d, axes.up)) + 0.05),
                    -dot(d, axes.back));
            }
        }
    };
    if (!camera.fov_rad) {
        each_point([&](std::size_t, double aside, double depth) {
            needed = std::max(needed, depth > 0.05 ? aside / depth : 1e9);
        });
        const double half = std::atan(needed / kMargin);
        fov_rad_ = std::clamp(2 * half, kSmallestFov_rad, kLargestFov_rad);
    }
    const double slope = kMargin * std::tan(fov_rad_ / 2);
    each_point([&](std::size_t k, double aside, double depth) {
        back[k] = std::max(back[k], aside / slope - depth);
    });
    const int around = static_cast<int>(kKeysPerSecond);
    std::vector<double> widest(back.size());
    for (int k = 0; k < count; ++k) {
        for (int i = std::max(0, k - around); i <= std::min(count - 1, k + around); ++i) {
            widest[static_cast<std::size_t>(k)] =
                std::max(widest[static_cast<std::size_t>(k)], back[static_cast<std::size_t>(i)]);
        }
    }
    widest = smoothed(widest, 0.35 * kKeysPerSecond);
    for (std::size_t k = 0; k < keys_.size(); ++k) {
        keys_[k].eye_world =
            keys_[k].eye_world +
            axes_towards(keys_[k].eye_world, keys_[k].target_world).back * std::max(0.0, widest[k]);
    }
}

View CameraPath::view(SimTime at) const {
    const int last = static_cast<int>(keys_.size()) - 1;
    const double place = std::clamp(at.seconds() * kKeysPerSecond, 0.0, static_cast<double>(last));
    const int i = std::min(static_cast<int>(place), std::max(0, last - 1));
    const double t = place - i;
    const std::array<double, 4> w{(1 - t) * (1 - t) * (1 - t) / 6,
                                  (3 * t * t * t - 6 * t * t + 4) / 6,
                                  (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6};
    Vec3 eye, target;
    for (int k = 0; k < 4; ++k) {
        // Beyond the ends the path goes on straight.
        const auto key = [&](auto member) {
            const int j = i + k - 1;
            const auto value = [&](int n) {
                return keys_[static_cast<std::size_t>(std::clamp(n, 0, last))].*member;
            };
            return j < 0      ? value(0) * 2 - value(1)
                   : j > last ? value(last) * 2 - value(last - 1)
                              : value(j);
        };
        eye = eye + key(&Key::eye_world) * w[static_cast<std::size_t>(k)];
        target = target + key(&Key::target_world) * w[static_cast<std::size_t>(k)];
    }
    return {{rotation_of(axes_towards(eye, target)), eye}, fov_rad_};
}

}  // namespace puppetri::render
