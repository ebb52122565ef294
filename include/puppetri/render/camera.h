// SPDX-License-Identifier: MIT
// The camera: what a scene says about it, and the smooth path that comes of it. The path is made once, from the whole
// performance, with filters that look ahead as well as back: the camera neither lags nor jerks, and asking for a view
// at any time gives the same answer in any order.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/math/transform.h"
#include "puppetri/stage/performance.h"

namespace puppetri::render {

inline constexpr double kDefaultFov_rad = 0.61;  // 35 degrees, vertical

// `camera main { at (0, 1.6, 8) m, keeps ana and rui in view, moves with them }`
struct Camera {
    std::string name = "main";
    Vec3 at_world{0, 1.6, 8};
    std::optional<Vec3> looking_at_world;    // none: the middle of those kept in view; without them straight to -Z
    std::vector<stage::ActorIndex> keeps;    // empty: nobody; the camera stands as it is told
    bool moves_with_them = false;            // keeps its offset to the middle of those kept in view
    double fov_rad = kDefaultFov_rad;        // vertical, in (0.05, 2.6)
};

// The camera looks along its own -Z, +Y is up, +X right.
struct View {
    Transform world_from_camera;
    double fov_rad = kDefaultFov_rad;  // vertical
};

// A camera for a scene that has none: before the first actor, keeps all in view and moves with them.
Camera default_camera(const stage::Performance& performance);

class CameraPath {
 public:
    // Follows those kept in view through the whole performance: it turns to their middle and, where they would leave
    // the picture (a tenth of it is margin), steps back along its line of sight.
    // Needs   indices in `keeps` are actors of the performance; aspect > 0 is width / height.
    // Cost    8 poses per second of performance and actor.
    CameraPath(const Camera& camera, const stage::Performance& performance, double aspect);

    View view(SimTime at) const;

 private:
    struct Key {
        Vec3 eye_world, target_world;
    };
    std::vector<Key> keys_;
    double interval_s_ = 1;
    double fov_rad_ = kDefaultFov_rad;
};

}  // namespace puppetri::render
