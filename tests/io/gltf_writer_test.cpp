// SPDX-License-Identifier: MIT
#include "puppetri/io/gltf_writer.h"

#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/io/events_json.h"
#include "support/fake_performance.h"
#include "support/gltf_reader.h"

using namespace puppetri;
using test::FakePerformance;
using test::GltfFile;

namespace {

GltfFile exported(const stage::Performance& performance, const io::TakeOptions& take_options = {},
                  const io::GltfOptions& options = {}) {
    const auto take = io::sample_take(performance, take_options);
    REQUIRE(take);
    return test::read_gltf(io::make_glb({std::span(&*take, 1), {}, {}}, options));
}

// The largest distance between joints of the file at file time t and of the performance at `at`;
// `moved` applies to the performance's world.
double worst_joint_m(const GltfFile& file, const FakePerformance& performance, std::uint32_t actor,
                     double t, SimTime at, std::size_t clip = 0) {
    figure::Pose pose;
    performance.pose({actor}, at, pose);
    std::vector<Transform> world_from_joint(pose.parent_from_joint.size());
    figure::to_model_space(performance.skeleton(), pose, world_from_joint);
    const auto world = file.pose(clip, t);
    double worst = 0;
    for (std::size_t j = 0; j < world_from_joint.size(); ++j) {
        const std::string name =
            performance.actors()[actor].name + "_" + performance.skeleton().joints[j].name;
        const int node = file.find(name);
        REQUIRE_MESSAGE(node >= 0, name);
        const Eigen::Vector3d there = world[static_cast<std::size_t>(node)].translation();
        const Vec3 here = world_from_joint[j].translation;
        worst = std::max(worst, (there - Eigen::Vector3d(here.x, here.y, here.z)).norm());
    }
    return worst;
}

}  // namespace

TEST_CASE("all joints of all actors read back within 0.1 mm at every frame and event [oracle]") {
    const FakePerformance performance;
    const GltfFile file = exported(performance);
    REQUIRE(file.clips.size() == 1);
    CHECK(file.clips[0].end_s() == doctest::Approx(4));
    for (std::uint32_t actor = 0; actor < 2; ++actor) {
        for (int frame = 0; frame <= 96; ++frame) {
            CHECK(worst_joint_m(file, performance, actor, frame / 24.0,
                                FakePerformance::at(frame / 24.0)) < 1e-5);
        }
        for (const stage::StageEvent& event : performance.events()) {
            CHECK(worst_joint_m(file, performance, actor, event.at.seconds(), event.at) < 1e-4);
        }
    }
}

TEST_CASE("the ball reads back where it was, and its holders stand in the extras [oracle]") {
    const FakePerformance performance;
    const GltfFile file = exported(performance);
    const int ball = file.find("ball");
    REQUIRE(ball >= 0);
    for (int frame = 0; frame <= 96; ++frame) {
        const Vec3 here =
            performance.world_from_prop({0}, FakePerformance::at(frame / 24.0)).translation;
        const Eigen::Vector3d there =
            file.pose(0, frame / 24.0)[static_cast<std::size_t>(ball)].translation();
        CHECK((there - Eigen::Vector3d(here.x, here.y, here.z)).norm() < 1e-5);
    }
    CHECK(file.clips[0].extras.find(R"({"frame":18,"holder":"air","prop":"ball","t":0.75})") !=
          std::string::npos);
}

TEST_CASE(
    "skinning the file's mesh with the file's bones gives what skinning the figure's gives "
    "[oracle]") {
    const FakePerformance performance;
    const GltfFile file = exported(performance);
    const int node = file.find("ana_mesh");
    REQUIRE(node >= 0);
    const auto& skin =
        file.skins.at(static_cast<std::size_t>(file.nodes[static_cast<std::size_t>(node)].skin));
    const auto& primitive =
        file.meshes.at(static_cast<std::size_t>(file.nodes[static_cast<std::size_t>(node)].mesh))
            .at(0);
    figure::Pose pose;
    performance.pose({0}, FakePerformance::at(1.375), pose);
    const figure::Skeleton& skeleton = performance.skeleton();
    std::vector<Transform> now(8), rest(8);
    figure::to_model_space(skeleton, pose, now);
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), rest);
    const figure::Mesh& mesh = *performance.actors()[0].mesh;
    const auto world = file.pose(0, 1.375);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Vec3 here;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint16_t j = mesh.joints[v][k];
            const Vec3 p{mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
            here = here + mesh.weights[v][k] * ((now[j] * inverse(rest[j])) * p);
        }
        Eigen::Vector4d there = Eigen::Vector4d::Zero();
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto j = static_cast<std::size_t>(primitive.joints[v][k]);
            const Eigen::Vector4d p = primitive.positions[v].homogeneous();
            const Eigen::Matrix4d bone =
                world[static_cast<std::size_t>(skin.joints[j])].matrix() * skin.inverse_bind[j];
            there += primitive.weights[v][k] * (bone * p);
            sum += primitive.weights[v][k];
        }
        CHECK(sum == doctest::Approx(1).epsilon(1e-6));
        CHECK((there.head<3>() - Eigen::Vector3d(here.x, here.y, here.z)).norm() < 1e-5);
    }
}

TEST_CASE(
    "neighbouring rotations lie in one hemisphere, so that interpolation takes the short way "
    "[law]") {
    const GltfFile file = exported(FakePerformance());
    for (const auto& [target, curve] : file.clips[0].curves) {
        for (std::size_t i = 1; i < curve.values.size(); ++i) {
            if (target.second == "rotation") {
                CHECK(curve.values[i].dot(curve.values[i - 1]) > 0);
                CHECK(curve.values[i].norm() == doctest::Approx(1).epsilon(1e-6));
            }
        }
    }
}

TEST_CASE("a joint that never moves has no channel, one that rests elsewhere has one key [unit]") {
    const GltfFile file = exported(FakePerformance());
    const auto& curves = file.clips[0].curves;
    const auto keys = [&](const char* node, const char* path) -> std::size_t {
        const auto found = curves.find({file.find(node), path});
        return found == curves.end() ? 0 : found->second.times.size();
    };
    CHECK(keys("ana_rightUpperArm", "rotation") == 0);
    CHECK(keys("ana_leftLowerArm", "rotation") == 1);
    CHECK(keys("ana_leftLowerArm", "translation") == 0);
    CHECK(keys("rui_root", "rotation") == 0);
    CHECK(keys("ana_root", "rotation") == keys("ana_root", "translation"));
    // 97 frames, and 4 foot strikes between frames; the releases fall on frames
    CHECK(keys("ana_root", "translation") == 97 + 4);
}

TEST_CASE("markers stand in the extras with their exact times [unit]") {
    const GltfFile file = exported(FakePerformance());
    const auto& events = file.clips[0].events;
    REQUIRE(events.size() == 8);
    CHECK(events[0].t == 0.26171875);
    CHECK(events[0].frame == 6);
    CHECK(events[0].name == "foot_strike");
    CHECK(events[0].actor == "ana");
    CHECK(events[0].limb == "left_leg");
    CHECK(events[1].prop == "ball");
}

TEST_CASE("reduced keys stay within the tolerance at every sampled key, and are fewer [law]") {
    const FakePerformance performance;
    const GltfFile all = exported(performance);
    for (const double tolerance_m : {1e-4, 1e-3, 1e-2}) {
        const GltfFile reduced = exported(performance, {}, {.reduce_m = tolerance_m});
        double worst = 0;
        for (std::uint32_t actor = 0; actor < 2; ++actor) {
            for (int frame = 0; frame <= 96; ++frame) {
                worst = std::max(worst, worst_joint_m(reduced, performance, actor, frame / 24.0,
                                                      FakePerformance::at(frame / 24.0)));
            }
            for (const stage::StageEvent& event : performance.events()) {
                CHECK(worst_joint_m(reduced, performance, actor, event.at.seconds(), event.at) <
                      1e-4);
            }
        }
        CHECK(worst < tolerance_m + 1e-5);
        std::size_t before = 0, after = 0;
        for (const auto& [target, curve] : all.clips[0].curves) {
            before += curve.times.size();
            after += reduced.clips[0].curves.at(target).times.size();
        }
        CHECK(after < before);
        const auto& root = reduced.clips[0].curves.at({reduced.find("rui_root"), "translation"});
        CHECK(root.times.size() ==
              2 + 8 + 3);  // a straight line: the ends, the events, the ball coming back
    }
}

TEST_CASE("a range of frames begins at 0 in the file, with its handles [unit]") {
    const FakePerformance performance;
    const GltfFile file =
        exported(performance, {.frames = io::FrameRange{24, 48}, .handles_frames = 30});
    CHECK(file.clips[0].end_s() == doctest::Approx((24 + 48 + 30 - 24) / 24.0));
    CHECK(worst_joint_m(file, performance, 0, 0.5, FakePerformance::at(0.5)) < 1e-5);
    CHECK(file.clips[0].extras.find(
              R"("first_frame":0,"frames":79,"frames_per_second":"24","handles":[24,30])") !=
          std::string::npos);
    const GltfFile inner = exported(performance, {.frames = io::FrameRange{24, 48}});
    CHECK(worst_joint_m(inner, performance, 0, 0.5, FakePerformance::at(1.5)) < 1e-5);
    CHECK(inner.clips[0].events.at(0).t == 0.26171875);
    CHECK(inner.clips[0].events.at(0).frame == 6);
}

TEST_CASE("frames that are not there, odd rates and negative handles are refused [hostile]") {
    const FakePerformance performance;
    const auto code = [&](const io::TakeOptions& options) {
        const auto take = io::sample_take(performance, options);
        return take ? std::string("fine") : take.error().at(0).code;
    };
    CHECK(code({.frames = io::FrameRange{0, 96}}) == "fine");
    CHECK(code({.frames = io::FrameRange{0, 97}}) == "bad-range");
    CHECK(code({.frames = io::FrameRange{5, 4}}) == "bad-range");
    CHECK(code({.frames = io::FrameRange{-1, 4}}) == "bad-range");
    CHECK(code({.handles_frames = -1}) == "bad-range");
    CHECK(code({.rate = {23, 1}}) == "bad-rate");
    CHECK(code({.rate = {24000, 1001}}) == "fine");
    CHECK(code({.rate = {120, 1}}) == "fine");
    CHECK(code({.rate = {121, 1}}) == "bad-rate");
}

TEST_CASE("a loop is one period whose last key equals its first but for the root's travel [law]") {
    const FakePerformance performance;
    const GltfFile file = exported(performance, {.loop = true});
    CHECK(file.clips[0].end_s() == doctest::Approx(1));
    for (const auto& [target, curve] : file.clips[0].curves) {
        const std::string& name = file.nodes[static_cast<std::size_t>(target.first)].name;
        if (name.ends_with("_root") || name == "ball") {
            continue;
        }
        const Eigen::Vector4d first = curve.values.front(), last = curve.values.back();
        const bool same = target.second == "rotation" ? std::fabs(first.dot(last)) > 1 - 1e-6
                                                      : (first - last).norm() < 1e-6;
        CHECK_MESSAGE(same, name);
    }
    // rui walks 1.2 m along +Z in a second without turning
    CHECK(file.clips[0].extras.find(R"("rui":{"rotation":[0,0,0,1],"translation":[0,0,1.2]})") !=
          std::string::npos);
    CHECK(file.clips[0].extras.find(R"("loop":true)") != std::string::npos);
    const FakePerformance short_one(0.9);
    CHECK(io::sample_take(short_one, {.loop = true}).error().at(0).code == "no-period");
}

TEST_CASE("clips per movement begin at the origin, one per actor and place [unit]") {
    const FakePerformance performance;
    const auto clips = io::sample_clips(performance, {});
    REQUIRE(clips);
    const GltfFile file = test::read_gltf(io::make_glb({*clips, {}, {}}, {}));
    std::vector<std::string> names;
    for (const auto& clip : file.clips) {
        names.push_back(clip.name);
    }
    CHECK(names == std::vector<std::string>{"ana_step_P4", "ana_step_P6", "rui_idle"});
    for (std::size_t clip = 0; clip < 3; ++clip) {
        const int root = file.find(clip == 2 ? "rui_root" : "ana_root");
        const auto& at = file.pose(clip, 0)[static_cast<std::size_t>(root)];
        CHECK(at.isApprox(Eigen::Isometry3d::Identity(), 1e-6));
        CHECK(file.clips[clip].end_s() == doctest::Approx(clip == 2 ? 1 : 0.5));
    }
    CHECK(file.clips[0].events.size() == 1);
    // Seen from the root, the clip shows the performance.
    const auto world = file.pose(1, 0.25);
    figure::Pose pose;
    performance.pose({0}, FakePerformance::at(0.75), pose);
    std::vector<Transform> now(8);
    figure::to_model_space(performance.skeleton(), pose, now);
    const auto root = static_cast<std::size_t>(file.find("ana_root")),
               arm = static_cast<std::size_t>(file.find("ana_leftLowerArm"));
    const Vec3 here = (inverse(now[0]) * now[4]).translation;
    const Eigen::Vector3d there = (world[root].inverse() * world[arm]).translation();
    CHECK((there - Eigen::Vector3d(here.x, here.y, here.z)).norm() < 1e-5);
}

TEST_CASE("root modes keep the figure's shape: in place it stays, in hips the root is idle [law]") {
    const FakePerformance performance;
    const GltfFile motion = exported(performance),
                   place = exported(performance, {.root = io::RootMode::kInPlace}),
                   hips = exported(performance, {.root = io::RootMode::kHips});
    const auto arm = static_cast<std::size_t>(motion.find("ana_leftLowerArm")),
               root = static_cast<std::size_t>(motion.find("ana_root"));
    for (const double t : {0.0, 1.25, 4.0}) {
        const auto a = motion.pose(0, t), b = place.pose(0, t), c = hips.pose(0, t);
        CHECK((b[root].translation() - a[root].translation() + Eigen::Vector3d(0, 0, 1.2 * t))
                  .norm() < 1e-5);
        CHECK((b[root].inverse() * b[arm]).isApprox(a[root].inverse() * a[arm], 1e-5));
        CHECK(c[root].isApprox(Eigen::Isometry3d::Identity(), 1e-6));
        CHECK(c[arm].isApprox(a[arm], 1e-5));
    }
}

TEST_CASE("an A-pose at rest changes what poses are measured from, never where joints are [law]") {
    const FakePerformance performance;
    const GltfFile t_pose = exported(performance),
                   a_pose = exported(performance, {.rest = io::RestPose::kA});
    const auto arm = static_cast<std::size_t>(t_pose.find("ana_leftLowerArm"));
    CHECK(t_pose.pose(0, 1.3)[arm].isApprox(a_pose.pose(0, 1.3)[arm], 1e-6));
    // Without its animation the left forearm hangs lower and nearer to the body than in the T-pose.
    const Eigen::Vector3d before = t_pose.pose(9, 0)[arm].translation(),
                          after = a_pose.pose(9, 0)[arm].translation();
    CHECK(after.y() < before.y());
    CHECK_FALSE(t_pose.skins[0].inverse_bind[3].isApprox(a_pose.skins[0].inverse_bind[3], 1e-3));
    CHECK((a_pose.meshes[0][0].positions[13] - t_pose.meshes[0][0].positions[13]).norm() > 0.01);
}

TEST_CASE("sets and cameras come along, named apart from the cast [unit]") {
    const FakePerformance performance;
    const auto take = io::sample_take(performance, {});
    REQUIRE(take);
    const io::StaticMesh road{"ball", performance.props()[0].mesh, {{}, {0, -1, 0}}};
    io::CameraTrack camera{"main", 0.6, 1.5, {}};
    for (const SimTime at : take->times) {
        camera.world_from_camera.push_back({{}, {0, 1.6, 8 + at.seconds()}});
    }
    const GltfFile file = test::read_gltf(
        io::make_glb({std::span(&*take, 1), std::span(&road, 1), std::span(&camera, 1)}, {}));
    CHECK(file.find("ball_2") >= 0);
    CHECK(file.cameras == 1);
    CHECK(file.pose(0, 2)[static_cast<std::size_t>(file.find("main"))].translation().z() ==
          doctest::Approx(10));
    CHECK(file.materials == std::vector<std::string>{"skin", "cloth", "ball"});
}

TEST_CASE("bones are named as other programs name them [unit]") {
    const FakePerformance performance;
    CHECK(exported(performance, {}, {.names = io::BoneNames::kMixamo})
              .find("ana_mixamorigLeftForeArm") >= 0);
    CHECK(exported(performance, {}, {.names = io::BoneNames::kUnreal}).find("rui_thigh_l") >= 0);
    CHECK(exported(performance, {}, {.names = io::BoneNames::kRigify}).find("rui_upper_arm.R") >=
          0);
    CHECK(io::bone_name(io::BoneNames::kUnreal, "rightIndexProximal") == "index_01_r");
    CHECK(io::bone_name(io::BoneNames::kMixamo, "somethingElse") == "somethingElse");
}

TEST_CASE("the events file holds the same markers, and says which clip they are of [unit]") {
    const FakePerformance performance;
    const auto take = io::sample_take(performance, {});
    REQUIRE(take);
    const std::string text = io::make_events_json(std::span(&*take, 1), "A \"scene\"");
    CHECK(text.starts_with(
        R"({"version":1,"scene":"A \"scene\"","frames_per_second":"24","first_frame":0,"frames":97,)"));
    CHECK(
        text.find(
            R"({"t":0.75,"frame":18,"name":"release","actor":"ana","limb":"right_arm","prop":"ball"})") !=
        std::string::npos);
    const auto clips = io::sample_clips(performance, {});
    REQUIRE(clips);
    CHECK(io::make_events_json(*clips, "").find(R"("clip":"ana_step_P4")") != std::string::npos);
}

namespace {

// Ana swings the ball in her left hand, as in a throw.
class Swing final : public FakePerformance {
 public:
    Transform world_from_prop(stage::PropIndex, SimTime at) const override {
        return hand(at) * Transform{{}, {0, 0.1, 0.05}};
    }
    std::string holder(stage::PropIndex, SimTime) const override { return "ana.left_hand"; }

 private:
    Transform hand(SimTime at) const {
        figure::Pose now;
        pose({0}, at, now);
        std::vector<Transform> world_from_joint(8);
        figure::to_model_space(skeleton(), now, world_from_joint);
        return world_from_joint[7];
    }
};

// How far the ball in the file moves against the hand in the file, at 480 instants a second.
double looseness_m(const GltfFile& file) {
    const auto hand = static_cast<std::size_t>(file.find("ana_leftHand")),
               ball = static_cast<std::size_t>(file.find("ball"));
    double worst = 0;
    for (int i = 0; i <= 960; ++i) {
        const auto world = file.pose(0, i / 480.0);
        const Eigen::Vector3d grip = world[hand].inverse() * world[ball].translation();
        worst = std::max(worst, (grip - Eigen::Vector3d(0, 0.1, 0.05)).norm());
    }
    return worst;
}

}  // namespace

TEST_CASE("a swung ball stays in the hand between the keys of the file too [law]") {
    const Swing performance;
    const GltfFile loose = exported(performance, {.keys_at_events = false}),
                   held = exported(performance);
    CHECK(loose.clips[0].curves.at({loose.find("ball"), "translation"}).times.size() == 97);
    CHECK(looseness_m(loose) > 2e-3);
    CHECK(looseness_m(held) < 5e-4);
    // The frames are still there.
    CHECK(worst_joint_m(held, performance, 0, 13 / 24.0, FakePerformance::at(13 / 24.0)) < 1e-5);
}
