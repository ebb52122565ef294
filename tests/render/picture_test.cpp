// SPDX-License-Identifier: MIT
#include "puppetri/render/picture.h"

#include <doctest/doctest.h>

#include <cmath>

#include "stage_of_balls.h"

using namespace puppetri;
using namespace puppetri::render;
using namespace puppetri::test;

namespace {

struct Rgb {
    int r, g, b;
    int bright() const { return r + g + b; }
};
Rgb pixel(const Picture& p, double x, double y) {
    const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                         static_cast<std::size_t>(x));
    return {p.rgb[at], p.rgb[at + 1], p.rgb[at + 2]};
}

// A camera at (0, 1, 5) that looks along -Z with a vertical field of view of 90 degrees: a point at
// depth d and height h is h / d half pictures from the middle.
scene::Camera straight() {
    scene::Camera camera;
    camera.at_world = {0, 1, 5};
    camera.fov_rad = kPi / 2;
    return camera;
}

Picture drawn(const stage::Performance& stage, const Look& look = {}, double t = 0) {
    const CameraPath path(straight(), stage, 1);
    PictureMaker maker({&stage, &path, {}, look}, 256, 256);
    Picture out;
    maker.draw(StageOfBalls::instant(t), out);
    return out;
}

bool can_draw() { return why_no_pictures().empty(); }

}  // namespace

TEST_CASE("a ball is drawn where projection says, in its colours, and round [oracle]") {
    if (!can_draw()) {
        return;
    }
    StageOfBalls stage(1);
    // At depth 4: 1 m is 32 pixels. The ball's middle is half a picture right of the middle and 0.5
    // m below the eye.
    stage.add_ball(1, [](double) { return Transform{{}, {2, 0.5, 1}}; });
    const Picture p = drawn(stage);
    REQUIRE(p.rgb.size() == 256 * 256 * 3);
    const StageOfBalls nothing(1);
    const Picture bare = drawn(nothing);
    // Pixels of the ball differ from the bare picture; so do those of its shadow, on the ground
    // below y = 128.
    int inside = 0, outside_above = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            // The ray through the pixel, against the sphere by formula.
            const Vec3 d = normalized(Vec3{(x + 0.5 - 128) / 128, (128 - y - 0.5) / 128, -1});
            const Vec3 to_ball = Vec3{2, 0.5, 1} - Vec3{0, 1, 5};
            const double beside = length(to_ball - d * dot(to_ball, d));
            const Rgb a = pixel(p, x, y), b = pixel(bare, x, y);
            const bool differs =
                std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 24;
            if (beside < 0.47) {
                ++inside;
                CHECK(differs);
            } else if (beside > 0.53 && y < 128) {
                outside_above += differs ? 1 : 0;
            }
        }
    }
    CHECK(inside > 500);
    CHECK(outside_above == 0);
}

TEST_CASE("a ball casts its shadow away from the sun [oracle]") {
    if (!can_draw()) {
        return;
    }
    StageOfBalls stage(1);
    stage.add_ball(0.5, [](double) { return Transform{{}, {0, 2, 0}}; });
    Look look;
    look.to_sun_world = {-1, 1, 0};
    const Picture p = drawn(stage, look);
    const StageOfBalls nothing(1);
    const Picture bare = drawn(nothing, look);
    // The sun stands at 45 degrees on the left: the shadow's middle is at (2, 0, 0), depth 5, 1 m
    // below the eye.
    const double x = 128 + 2.0 / 5 * 128, y = 128 + 1.0 / 5 * 128;
    CHECK(pixel(p, x, y).bright() < 0.7 * pixel(bare, x, y).bright());
    // The other side is as before.
    CHECK(std::abs(pixel(p, 256 - x, y).bright() - pixel(bare, 256 - x, y).bright()) < 6);
}

TEST_CASE("feet darken the floor around them [unit]") {
    if (!can_draw()) {
        return;
    }
    StageOfBalls stage(1);
    stage.add_ball(0.4, [](double) { return Transform{{}, {0, 0.2, 1}}; });
    Look look;
    look.to_sun_world = {-1, 0.15, 0};  // low on the left: the shadow lies to the right
    const Picture p = drawn(stage, look);
    const StageOfBalls nothing(1);
    const Picture bare = drawn(nothing, look);
    // On the floor 5 cm in front of the ball: z = 1.25, depth 3.75. The ball takes a quarter of the
    // sky there.
    const double y = 128 + 1 / 3.75 * 128;
    CHECK(pixel(p, 128, y).bright() < 0.97 * pixel(bare, 128, y).bright());
}

TEST_CASE("an instant gives the same bytes whatever was drawn before [law]") {
    if (!can_draw()) {
        return;
    }
    StageOfBalls stage(3);
    stage.add_actor(1.75, [](double t) { return Transform{about_y(t), {t - 1, 0, 0}}; });
    stage.add_ball(0.3, [](double t) { return Transform{about_x(3 * t), {1, 1 + t / 3, 1}}; });
    const CameraPath path(straight(), stage, 1);
    PictureMaker maker({&stage, &path, {}, {}}, 160, 160);
    Picture first, between, again;
    maker.draw(StageOfBalls::instant(1), first);
    maker.draw(StageOfBalls::instant(2.5), between);
    maker.draw(StageOfBalls::instant(1), again);
    CHECK(first.rgb == again.rgb);
    CHECK(first.rgb != between.rgb);
    PictureMaker other({&stage, &path, {}, {}}, 160, 160);
    Picture fresh;
    other.draw(StageOfBalls::instant(1), fresh);
    CHECK(first.rgb == fresh.rgb);
}

TEST_CASE(
    "pictures of any shape are drawn, also from below the ground and from inside a figure "
    "[hostile]") {
    if (!can_draw()) {
        return;
    }
    StageOfBalls stage(1);
    stage.add_actor(1.75, [](double) { return Transform{}; });
    for (const Vec3 eye : {Vec3{0, 1, 0}, Vec3{0, -2, 4}, Vec3{0, 500, 1}, Vec3{0, 0, 3}}) {
        scene::Camera camera;
        camera.at_world = eye;
        camera.looking_at_world = Vec3{0, 0.9, 0.1};
        for (const auto& [w, h] : {std::pair{16, 16}, {17, 131}, {333, 18}}) {
            const CameraPath path(camera, stage, static_cast<double>(w) / h);
            PictureMaker maker({&stage, &path, {}, {}}, w, h);
            Picture out;
            maker.draw({}, out);
            CHECK(out.rgb.size() == static_cast<std::size_t>(w * h * 3));
        }
    }
}
