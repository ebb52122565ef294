// SPDX-License-Identifier: MIT
// Example 06: a character from a file walks and plays ball, measured as mannequins are, on the
// stage and in the exported file read back by a reader that shares no code with Puppetri. The
// instrument sees the character's own joints.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/scene_files.h"
#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/io/gltf_document.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/math/rotation.h"
#include "support/bvh_reader.h"
#include "support/example_motion.h"
#include "support/gltf_reader.h"

using namespace puppetri;
using namespace puppetri::io::testing;
using test::Example;

namespace {

constexpr const char* kWalk = "06_character/walk.pup";
constexpr const char* kBall = "06_character/ball.pup";
constexpr const char* kRobot = "06_character/robot.pup";

const figure::Character& character_of(const Example& e, std::uint32_t actor) {
    return *e.scene->play.cast.actors[actor].character;
}

std::uint32_t number_of(const Example& e, const std::string& name) {
    std::uint32_t i = 0;
    while (e.actor(i) != name) {
        ++i;
    }
    return i;
}

void check_feet_and_joints(const test::Measures& m, double slip_mm) {
    CHECK_MESSAGE(m.slip_mm.value <= slip_mm, m.slip_mm.where, " at ", m.slip_mm.at_s);
    CHECK_MESSAGE(m.sink_mm.value <= 2, m.sink_mm.where, " at ", m.sink_mm.at_s);
    CHECK_MESSAGE(m.hover_mm.value <= 2, m.hover_mm.where, " at ", m.hover_mm.at_s);
    CHECK_MESSAGE(m.swing_sink_mm.value <= 2, m.swing_sink_mm.where, " at ", m.swing_sink_mm.at_s);
    CHECK(m.limit_excess_deg.value <= 0.01);
    CHECK(m.knee.speed_rad_s.value <= 10);
    CHECK(m.hip.speed_rad_s.value <= 6);
    CHECK(m.ankle.speed_rad_s.value <= 8);
    CHECK(m.spine.speed_rad_s.value <= 3);
    CHECK(m.arm.speed_rad_s.value <= 20);
    for (const test::JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck}) {
        CHECK(j->acceleration_rad_s2.value <= 400);
    }
    CHECK(m.pelvis_acceleration.value <= 4);
}

io::Take take_of(const Example& e) {
    auto take = io::sample_take(e.performance(), {});
    REQUIRE(take);
    return std::move(*take);
}

Transform from_eigen(const Eigen::Isometry3d& placed, double metres) {
    const Eigen::Quaterniond q(placed.linear());
    const Eigen::Vector3d t = placed.translation() * metres;
    return {{q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

}  // namespace

namespace {

// What the table says of the walk of somebody with legs of usual length and feet.
struct Walker {
    double rise_mm = 20, knee_stance_deg = 25, knee_swing_deg = 70;
};

void check_walk(const Example& e, const Walker& walker = {}) {
    CAPTURE(e.name);
    CHECK(e.performed.notes.empty());
    const test::Measures m = test::measured_on_stage(e, 0, 0, e.end_s());
    CAPTURE(test::report(m));
    check_feet_and_joints(m, 1);
    CHECK(m.knee_stance_deg.value <= walker.knee_stance_deg);
    CHECK(m.rise_mm >= walker.rise_mm);
    CHECK(m.rise_mm <= 60);
    CHECK(m.sway_mm >= 20);
    CHECK(m.sway_mm <= 50);
    CHECK(m.steps.size() == 4);
    for (const test::Step& step : m.steps) {
        CHECK(step.knee_deg >= 50);
        CHECK(step.knee_deg <= walker.knee_swing_deg);
        CHECK(step.clearance_mm >= 10);
        CHECK(step.clearance_mm <= 60);
    }
    CHECK(m.join_position_m.value <= 1e-6);
    CHECK(m.join_pelvis_m_s.value <= 0.05);
    CHECK(m.join_foot_m_s.value <= 0.2);
    CHECK(m.join_hand_m_s.value <= 0.2);
}

}  // namespace

TEST_CASE("CesiumMan's walk holds the table of good motion at 480 Hz [law]") {
    if (test::has_character_files()) {
        check_walk(test::example(kWalk));
    }
}

TEST_CASE(
    "a robot whose feet hang from a controller, and that has no wrists, walks by the table [law]") {
    if (!there("robot.glb")) {
        return;
    }
    const Example& e = test::example(kRobot);
    // Legs of 0.5 m with feet of 0.31 m: strokes of 0.2 m rise less.
    check_walk(e, {.rise_mm = 10, .knee_stance_deg = 27});
    // The feet that hang from the shins now go where the humanoid's go, and nothing of the skin is
    // in the floor.
    const figure::Character& c = *e.character(0);
    const figure::Figure figure = e.figure(0);
    std::vector<Transform> rest(c.skeleton.joints.size()), world(rest.size());
    figure::to_model_space(c.skeleton, figure::rest_pose(c.skeleton), rest);
    figure::Pose pose;
    double lowest_m = 1;
    std::string lowest;
    for (double t = 0; t < e.end_s(); t += 1 / 24.0) {
        e.performance().pose({0}, SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)}, pose);
        figure::to_model_space(c.skeleton, pose, world);
        for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
            const auto& p = c.mesh.positions[v];
            double y = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint16_t j = c.mesh.joints[v][k];
                y += static_cast<double>(c.mesh.weights[v][k]) *
                     (world[j] * (inverse(rest[j]) * Vec3{p[0], p[1], p[2]})).y;
            }
            if (y < lowest_m) {
                lowest_m = y;
                lowest = c.skeleton.joints[c.mesh.joints[v][0]].name;
            }
        }
    }
    CHECK_MESSAGE(lowest_m > -0.004, lowest);
    CHECK(c.skeleton.find("leftHand").valid());
    const auto parent = [&](const char* joint) {
        return c.skeleton.joints[c.skeleton.joints[c.skeleton.find(joint).value].parent.value].name;
    };
    CHECK(parent("Foot.L") == "LowerLeg.L");
    CHECK(parent("Foot.R") == "LowerLeg.R");
    CHECK(parent("Palm2.R") == "rightHand");
    CHECK(parent("Thumb.R") == "rightHand");
}

TEST_CASE("a rehung rig performs the clips of its own file as the file has them [oracle]") {
    if (!there("robot.glb")) {
        return;
    }
    // How far feet and hips turn against the beginning: by the nodes of the file, and by the clip
    // as humanoids perform it.
    io::DiskFiles files;
    const auto clips = files.assets()->clips({kMotion + "robot.glb", 0});
    REQUIRE(clips.has_value());
    CHECK(clips->no_humanoid.empty());
    REQUIRE(clips->humanoid.size() == 14);
    const auto file = io::load_clips(kMotion + "robot.glb");
    REQUIRE(file.has_value());
    const figure::Skeleton bones = figure::make_mannequin(1.75).skeleton;
    for (std::size_t i = 0; i < clips->humanoid.size(); ++i) {
        const motion::Clip &is = clips->humanoid[i], &was = file->clips[i];
        CAPTURE(was.name);
        REQUIRE(is.name == was.name);
        const auto turned = [](const motion::Clip& clip, const figure::Skeleton& skeleton,
                               const char* joint, double t) {
            figure::Pose pose = figure::rest_pose(skeleton);
            motion::sample_clip(clip, motion::bind_clip(clip, skeleton), t, pose);
            std::vector<Transform> model(skeleton.joints.size());
            figure::to_model_space(skeleton, pose, model);
            return model[skeleton.find(joint).value].rotation;
        };
        for (const auto& [bone, node] : {std::pair{"leftFoot", "Foot.L"},
                                         {"rightFoot", "Foot.R"},
                                         {"hips", "Body"},
                                         {"leftLowerLeg", "LowerLeg.L"},
                                         {"rightHand", "LowerArm.R"}}) {
            // At keys: in between, one is a spline of the other's frames.
            for (std::size_t k = 1; k < was.rotations[0].keys.size(); k += 3) {
                const double t = was.rotations[0].keys[k].t_s;
                const double ours =
                    angle_between(turned(is, bones, bone, 0), turned(is, bones, bone, t));
                const double theirs = angle_between(turned(was, file->skeleton, node, 0),
                                                    turned(was, file->skeleton, node, t));
                CHECK(ours == doctest::Approx(theirs).scale(1).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE("CesiumMan and the mannequin play ball: feet, joints, joins, and throws go on [law]") {
    if (!test::has_character_files()) {
        return;
    }
    const Example& e = test::example(kBall);
    for (const Diagnostic& note : e.performed.notes) {
        FAIL_CHECK(note.code << ": " << note.element << ": " << note.message);
    }
    const test::Measures m = test::measured_on_stage(e, number_of(e, "cem"), 0, 20);
    CAPTURE(test::report(m));
    check_feet_and_joints(m, 1);
    CHECK(m.arm.acceleration_rad_s2.value <= 1500);
    CHECK(m.join_position_m.value <= 1e-6);
    CHECK(m.join_pelvis_m_s.value <= 0.05);
    CHECK(m.join_hand_m_s.value <= 0.2);
    int thrown = 0, caught = 0;
    for (const stage::StageEvent& event : e.performance().events()) {
        thrown += event.name == "release" && event.actor == "cem";
        caught += event.name == "catch" && event.actor == "cem";
    }
    CHECK(thrown >= 3);
    CHECK(caught >= 3);
    // They do not drift apart for ever.
    figure::Pose a, b;
    const SimTime end = e.performance().duration();
    e.performance().pose({number_of(e, "ana")}, end, a);
    e.performance().pose({number_of(e, "cem")}, end, b);
    CHECK(length(a.parent_from_joint[0].translation - b.parent_from_joint[0].translation) < 4);
}

TEST_CASE("the palms of a character stay on the ball that it holds, within 1 mm [law]") {
    if (!test::has_character_files()) {
        return;
    }
    const Example& e = test::example(kBall);
    const std::uint32_t cem = number_of(e, "cem");
    const figure::Character& c = character_of(e, cem);
    const figure::Figure figure = e.figure(cem);
    const double radius_m = e.performance().props()[0].size_m.x / 2;
    double worst_m = 0;
    int held = 0;
    figure::Pose pose;
    std::vector<Transform> joints(c.skeleton.joints.size()), bones(figure.skeleton.joints.size());
    for (double t = 0; t < 20; t += 1 / 60.0) {
        const SimTime at{static_cast<std::int64_t>(t * kTicksPerSecond)};
        if (e.performance().holder({0}, at) != "cem.hands") {
            continue;
        }
        ++held;
        e.performance().pose({cem}, at, pose);
        figure::to_model_space(c.skeleton, pose, joints);
        test::bones_of_character(c, joints, bones);
        for (const figure::Arm& arm : figure.arms) {
            const Vec3 palm = bones[arm.hand.value] * arm.hand_from_palm.translation;
            const Vec3 ball = e.performance().world_from_prop({0}, at).translation;
            worst_m = std::fmax(worst_m, std::fabs(length(palm - ball) - radius_m));
        }
    }
    CHECK(held > 200);
    CHECK(worst_m < 0.001);
}

TEST_CASE("the exported walk keeps the table when it is read back, and stays textured [oracle]") {
    if (!test::has_character_files()) {
        return;
    }
    const Example& e = test::example(kWalk);
    const figure::Character& c = character_of(e, 0);
    const figure::Figure figure = e.figure(0);
    const io::Take take = take_of(e);
    const std::string glb = io::make_glb({std::span(&take, 1), {}, {}}, {});
    const test::GltfFile file = test::read_gltf(glb);
    std::vector<std::size_t> nodes;
    for (const figure::Joint& joint : c.skeleton.joints) {
        nodes.push_back(static_cast<std::size_t>(file.find("cem_" + joint.name)));
    }
    const double end_s = take.times.back().seconds();
    std::vector<Transform> joints(nodes.size());
    const test::Measures m = test::measure({.figure = figure,
                                            .sample =
                                                [&](double t, std::span<Transform> bones) {
                                                    const auto world = file.pose(0, t);
                                                    for (std::size_t j = 0; j < nodes.size(); ++j) {
                                                        joints[j] = from_eigen(world[nodes[j]], 1);
                                                    }
                                                    test::bones_of_character(c, joints, bones);
                                                },
                                            .begin_s = 0,
                                            .end_s = end_s,
                                            .rate_hz = 24,
                                            .planted = test::planted_of(e, 0, end_s)});
    CAPTURE(test::report(m));
    check_feet_and_joints(m, 2);

    // The skin that arrives at rest is the one that was read, and wears its picture.
    const auto document = io::GltfDocument::parse(glb, "walk.glb", nullptr);
    REQUIRE(document.has_value());
    REQUIRE(document->images.size() == 1);
    CHECK(document->images[0].bytes == c.mesh.textures[0].bytes);
    REQUIRE(document->meshes.size() == 1);
    const io::GltfPrimitiveIn& p = document->meshes[0].primitives[0];
    REQUIRE(p.uvs != io::kNoGltf);
    CHECK(document->floats(p.uvs)[0] == c.mesh.uvs[0][0]);
    CHECK(document->count(p.positions) == c.mesh.positions.size());
    CHECK(document->materials[p.material].base_colour_texture == 0);
}

TEST_CASE(
    "a character's BVH has its own joints, and they go where the performance has them [oracle]") {
    if (!test::has_character_files()) {
        return;
    }
    const Example& e = test::example(kWalk);
    const figure::Character& c = character_of(e, 0);
    const io::Take take = take_of(e);
    const test::Bvh bvh = test::read_bvh(io::make_bvh(take, 0, {}));
    figure::Pose pose;
    std::vector<Transform> joints(c.skeleton.joints.size());
    for (std::size_t frame = 0; frame < bvh.frames.size(); frame += 7) {
        const auto world = bvh.pose(frame);
        e.performance().pose({0}, take.rate.time_of(static_cast<std::int64_t>(frame)), pose);
        figure::to_model_space(c.skeleton, pose, joints);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const int at = bvh.find(c.skeleton.joints[j].name);
            REQUIRE(at >= 0);
            const Vec3 there = from_eigen(world[static_cast<std::size_t>(at)], 0.01).translation;
            CHECK(length(there - joints[j].translation) < 1e-5);
        }
    }
}

TEST_CASE(
    "a character is exported in an A-pose, and with the names of bones, if asked to [oracle]") {
    if (!test::has_character_files()) {
        return;
    }
    const Example& e = test::example(kWalk);
    const io::Take own = take_of(e);
    auto asked = io::sample_take(e.performance(), {.rest = io::RestPose::kA, .bone_names = true});
    REQUIRE(asked);
    const io::TakeActor &was = own.actors[0], &is = asked->actors[0];
    CHECK(was.skeleton.find("leftUpperArm").valid() == false);  // the file's own names
    CHECK(is.parent_from_joint == was.parent_from_joint);       // the motion is the same
    std::vector<Transform> model(is.skeleton.joints.size());
    figure::to_model_space(is.skeleton, figure::rest_pose(is.skeleton), model);
    const auto at = [&](const char* bone) {
        const figure::JointIndex j = is.skeleton.find(bone);
        REQUIRE(j.valid());
        return model[j.value].translation;
    };
    for (const bool left : {true, false}) {
        const std::string side = left ? "left" : "right";
        const Vec3 upper =
            normalized(at((side + "LowerArm").c_str()) - at((side + "UpperArm").c_str()));
        const Vec3 thigh =
            normalized(at((side + "LowerLeg").c_str()) - at((side + "UpperLeg").c_str()));
        CHECK(upper.y == doctest::Approx(-std::sqrt(0.5)).epsilon(1e-3));
        CHECK(upper.x == doctest::Approx((left ? 1 : -1) * std::sqrt(0.5)).epsilon(1e-3));
        CHECK(thigh.y < -0.99);
    }
    // The mesh went along: what hangs at a hand is as far from it as before.
    std::vector<Transform> before(was.skeleton.joints.size());
    figure::to_model_space(was.skeleton, figure::rest_pose(was.skeleton), before);
    std::size_t seen = 0;
    for (std::size_t v = 0; v < was.mesh.positions.size(); ++v) {
        if (was.mesh.weights[v][0] < 0.999f) {
            continue;
        }
        const std::size_t j = was.mesh.joints[v][0];
        const auto point = [](const std::array<float, 3>& p) { return Vec3{p[0], p[1], p[2]}; };
        const Vec3 a = inverse(before[j]) * point(was.mesh.positions[v]);
        const Vec3 b = inverse(model[j]) * point(is.mesh.positions[v]);
        REQUIRE(length(a - b) < 1e-5);
        ++seen;
    }
    CHECK(seen > 100);
}
