// SPDX-License-Identifier: MIT
// The path of a camera. It is made once, from the whole performance, with filters that look ahead
// as well as back: the camera neither lags nor jerks, and asking for a view at any time gives the
// same answer in any order.
#pragma once
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/math/transform.h"
#include "puppetri/scene/scene.h"
#include "puppetri/stage/performance.h"

namespace puppetri::render {

// The camera looks along its own -Z, +Y is up, +X right.
struct View {
    Transform world_from_camera;
    double fov_rad = 0.61;  // vertical
};

// A camera for a scene that has none: before the actors and a little aside, or, when they look at
// each other, across the line between them. It keeps all in view and moves with them.
scene::Camera default_camera(const stage::Performance& performance);

class CameraPath {
 public:
    // Follows those kept in view through the whole performance: it turns to their middle (unless it
    // looks at a point) and, when it moves with them, keeps its offset to that middle. Without a
    // field of view of its own it takes the one, between 12 and 60 degrees and constant for the
    // whole film, that holds everybody kept in view with a margin of a tenth; what even that would
    // lose, it holds by stepping back along its line of sight. Needs   indices in `keeps` are
    // actors of the performance; aspect > 0 is width / height. Gives   a camera that keeps nobody
    // in view stands still, looking at its point or straight to -Z. Cost    8 poses per second of
    // performance and actor kept.
    CameraPath(const scene::Camera& camera, const stage::Performance& performance, double aspect);

    View view(SimTime at) const;

 private:
    struct Key {
        Vec3 eye_world, target_world;
    };
    std::vector<Key> keys_;  // control points of a uniform cubic B-spline
    double fov_rad_ = 0.61;
};

}  // namespace puppetri::render
