// SPDX-License-Identifier: MIT
#include "puppetri/render/camera.h"

#include <doctest/doctest.h>

#include <cmath>

#include "stage_of_balls.h"

using namespace puppetri;
using namespace puppetri::render;
using namespace puppetri::test;

namespace {

// Where a point is in the picture: x and y in [-1, 1] inside it.
struct Spot {
    double x, y, depth;
};
Spot spot(const View& view, double aspect, Vec3 p_world) {
    const Vec3 p = inverse(view.world_from_camera) * p_world;
    const double half = std::tan(view.fov_rad / 2);
    return {p.x / -p.z / (half * aspect), p.y / -p.z / half, -p.z};
}

Transform at(double x, double z, double heading = 0) { return {about_y(heading), {x, 0, z}}; }

constexpr double kWide = 16.0 / 9;

}  // namespace

TEST_CASE("a camera that keeps nobody stands where it is told and looks where it is told [unit]") {
    StageOfBalls stage(2);
    scene::Camera camera;
    camera.at_world = {1, 2, 3};
    const View ahead = CameraPath(camera, stage, kWide).view({});
    CHECK(length(ahead.world_from_camera.translation - Vec3{1, 2, 3}) < 1e-12);
    CHECK(length(rotate(ahead.world_from_camera.rotation, {0, 0, -1}) - Vec3{0, 0, -1}) < 1e-12);
    camera.looking_at_world = Vec3{4, 2, 3};
    camera.fov_rad = 0.5;
    const View aside = CameraPath(camera, stage, kWide).view(StageOfBalls::instant(1));
    CHECK(length(rotate(aside.world_from_camera.rotation, {0, 0, -1}) - Vec3{1, 0, 0}) < 1e-12);
    CHECK(aside.fov_rad == 0.5);
    // The horizon is level, whatever the direction.
    camera.looking_at_world = Vec3{-3, 0.4, -2};
    const View down = CameraPath(camera, stage, kWide).view({});
    CHECK(std::fabs(rotate(down.world_from_camera.rotation, {1, 0, 0}).y) < 1e-12);
}

TEST_CASE("those kept in view stay in the picture for the whole film [law]") {
    for (const bool moves : {true, false}) {
        for (const bool own_angle : {true, false}) {
            StageOfBalls stage(8);
            stage.add_actor(1.75, [](double t) { return at(-1.5 - 0.2 * t, 0.9 * t); });
            stage.add_actor(1.6, [](double t) {
                return at(1.5 + std::sin(2 * t), t > 3 ? 0.9 * (t - 3) : 0, t);
            });
            scene::Camera camera;
            camera.keeps = {{0}, {1}};
            camera.moves_with_them = moves;
            if (!moves) {
                camera.at_world = {2, 1.6, 16};
            }
            if (own_angle) {
                camera.fov_rad = 0.3;  // too narrow: it must step back
            }
            const CameraPath path(camera, stage, kWide);
            figure::Pose pose;
            for (double t = 0; t <= 8; t += 0.1) {
                const View view = path.view(StageOfBalls::instant(t));
                for (std::uint32_t a = 0; a < 2; ++a) {
                    const figure::Skeleton& skeleton = *stage.actors()[a].skeleton;
                    stage.pose({a}, StageOfBalls::instant(t), pose);
                    std::vector<Transform> world(skeleton.joints.size());
                    figure::to_model_space(skeleton, pose, world);
                    for (std::size_t j = 0; j < world.size(); ++j) {
                        const Spot s =
                            spot(view, kWide, world[j] * skeleton.joints[j].end_site_joint);
                        CAPTURE(t);
                        CAPTURE(skeleton.joints[j].name);
                        CHECK(s.depth > 0);
                        CHECK(std::fabs(s.x) < 0.97);
                        CHECK(std::fabs(s.y) < 0.97);
                    }
                }
            }
        }
    }
}

TEST_CASE("a camera that moves with walkers neither jerks nor drifts away [law]") {
    StageOfBalls stage(10);
    // Stop and go, and a heading that swings: what a walk does to a careless camera.
    stage.add_actor(1.75, [](double t) {
        return at(0.05 * std::sin(7 * t),
                  t < 4   ? 0.0
                  : t < 7 ? 1.2 * (t - 4)
                          : 3.6,
                  0.3 * std::sin(9 * t));
    });
    scene::Camera camera;
    camera.at_world = {0, 1.6, 6};
    camera.keeps = {{0}};
    camera.moves_with_them = true;
    const CameraPath path(camera, stage, kWide);
    constexpr double h = 1.0 / 48;
    double hardest = 0;
    for (double t = h; t <= 10 - h; t += h) {
        const Vec3 a = path.view(StageOfBalls::instant(t - h)).world_from_camera.translation;
        const Vec3 b = path.view(StageOfBalls::instant(t)).world_from_camera.translation;
        const Vec3 c = path.view(StageOfBalls::instant(t + h)).world_from_camera.translation;
        hardest = std::max(hardest, length(a + c - b * 2) / (h * h));
    }
    CHECK(hardest < 1.2);  // the walker's own start is without bound
    const Vec3 end = path.view(StageOfBalls::instant(10)).world_from_camera.translation;
    CHECK(length(end - Vec3{0, 1.6, 6 + 3.6}) < 0.4);
}

TEST_CASE("views do not depend on the order of asking [law]") {
    StageOfBalls stage(4);
    stage.add_actor(1.75, [](double t) { return at(t, -t); });
    const CameraPath path(default_camera(stage), stage, kWide);
    const View late = path.view(StageOfBalls::instant(3.3)),
               early = path.view(StageOfBalls::instant(0.2));
    CHECK(path.view(StageOfBalls::instant(3.3)).world_from_camera == late.world_from_camera);
    CHECK(path.view(StageOfBalls::instant(0.2)).world_from_camera == early.world_from_camera);
    // Beyond the end it rests.
    CHECK(path.view(StageOfBalls::instant(400)).world_from_camera ==
          path.view(StageOfBalls::instant(500)).world_from_camera);
}

TEST_CASE("the default camera sees the faces of all actors [unit]") {
    StageOfBalls stage(1);
    stage.add_actor(1.75, [](double) { return at(-1, 0); });
    stage.add_actor(1.9, [](double) { return at(2, 1); });
    const scene::Camera camera = default_camera(stage);
    CHECK(camera.keeps.size() == 2);
    CHECK(camera.at_world.z > 1);  // they face +Z
    const View view = CameraPath(camera, stage, kWide).view({});
    for (const Vec3 head : {Vec3{-1, 1.6, 0}, Vec3{2, 1.8, 1}}) {
        const Spot s = spot(view, kWide, head);
        CHECK(s.depth > 1);
        CHECK(std::fabs(s.x) < 1);
        CHECK(std::fabs(s.y) < 1);
    }
    const StageOfBalls empty(1);
    CHECK(default_camera(empty).keeps.empty());
}
