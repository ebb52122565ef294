// SPDX-License-Identifier: MIT
// `clip` blocks: layers, masks, warps, and creatures that play clips by the names of their joints.
// Expectations are closed forms of clips whose every value is known.
#include <doctest/doctest.h>

#include <cmath>

#include "measured.h"
#include "puppetri/figure/dof.h"
#include "puppetri/math/rotation.h"
#include "puppetri/scene/assets.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

motion::RotationTrack turning(const char* joint, Vec3 axis, double from, double to, double end_s) {
    motion::RotationTrack track{joint, {}};
    for (const auto& [t, angle] : {std::pair{0.0, from}, std::pair{end_s, to}}) {
        motion::RotationKey key;
        key.t_s = t;
        key.value = from_axis_angle(axis, angle);
        track.keys.push_back(key);
    }
    return track;
}
motion::VectorTrack moving(const char* joint, Vec3 from, Vec3 to, double end_s) {
    motion::VectorTrack track{joint, {}};
    for (const auto& [t, place] : {std::pair{0.0, from}, std::pair{end_s, to}}) {
        motion::VectorKey key;
        key.t_s = t;
        key.value = place;
        track.keys.push_back(key);
    }
    return track;
}

constexpr Vec3 kZ{0, 0, 1}, kX{1, 0, 0}, kY{0, 1, 0};

// base: the arms come down steadily about z, 0 to 1 rad in 2 s, and the left elbow bends from 0.1
// to 0.5 rad. extra: the right arm, 0.4 to 0.8 rad in 1 s. flex: the left elbow as a degree of
// freedom, 0.2 to 0.6. crane: joints of a linkage of two links, and the upper one shifts; it goes 2
// m ahead.
class SomeClips final : public Assets {
 public:
    Checked<LoadedCharacter> character(const CharacterRequest&) override {
        return Unexpected(Diagnostics{});
    }
    Checked<LoadedClips> clips(const ClipRequest& request) override {
        LoadedClips loaded;
        motion::Clip clip;
        clip.name = "only";
        if (request.path == "base.keys") {
            clip.duration_s = 2;
            clip.rotations = {turning("rightUpperArm", kZ, 0, 1, 2),
                              turning("leftUpperArm", kZ, 0, -1, 2),
                              turning("leftLowerArm", kY, -0.1, -0.5, 2)};
        } else if (request.path == "extra.keys") {
            clip.duration_s = 1;
            clip.rotations = {turning("rightUpperArm", kZ, 0.4, 0.8, 1)};
        } else if (request.path == "flex.keys") {
            clip.duration_s = 2;
            motion::NumberKey a, b;
            a.value = 0.2;
            b.t_s = 2;
            b.value = 0.6;
            clip.numbers = {{"left_elbow.flex", {a, b}}};
        } else if (request.path == "links.keys") {
            clip.duration_s = 2;
            clip.rotations = {turning("lower", kX, 0, 0.8, 2)};
            motion::NumberKey bent;
            bent.value = -0.3;
            clip.numbers = {{"upper.bend", {bent}}, {"tail.bend", {bent}}};
        } else if (request.path == "crane.glb") {
            // The file has a base above that turns nothing, and twice the size of the linkage.
            loaded.skeleton.joints = {{"base", {}, {{}, {0, 2, 0}}, {}},
                                      {"lower", {0}, {{}, {0, 0, 0}}, {}},
                                      {"between", {1}, {{}, {0, 1, 0}}, {}},
                                      {"upper", {2}, {{}, {0, 1, 0}}, {}}};
            clip.duration_s = 2;
            clip.root = "base";
            clip.rotations = {turning("lower", kX, 0, 0.8, 2), turning("between", kX, 0, 0.2, 2)};
            clip.translations = {moving("base", {0, 2, 0}, {0, 2, 4}, 2)};
            loaded.no_humanoid = {
                {Severity::kError, "no-bone", {}, "left_knee", "it has none", "add one"}};
            loaded.raw = {clip};
            return loaded;
        } else {
            return Unexpected(Diagnostics{{Severity::kError,
                                           "cannot-read",
                                           {},
                                           "file",
                                           "there is no such file",
                                           "name one"}});
        }
        loaded.raw = {clip};
        loaded.humanoid = {clip};
        return loaded;
    }
};

using Files = FilesWith<SomeClips>;

constexpr const char* kLinkage =
    "linkage { at (1, 0, 0) m, facing 90 deg\n"
    "  link lower { at (0, 1, 0) m, turns -90 .. 90 deg about x }\n"
    "  link upper { at (0, 1, 0) m, turns -90 .. 90 deg about x as bend }\n }";

Checked<Scene> load_clip(const std::string& block, const std::string& actor = "mannequin",
                         const std::string& place = "") {
    Files files;
    files.memory.add("scene.pup", "language 1\nscene \"s\"\nuntil 6 s\ncast { ana: " + actor +
                                      " }\n" + block + "\nplace p does ana.hail() " + place +
                                      " tokens 1\nend { p }\n");
    return load(files, "scene.pup");
}
std::string defect(const std::string& block, const std::string& actor = "mannequin") {
    const auto scene = load_clip(block, actor);
    if (scene) {
        return "";
    }
    CHECK(scene.error().front().where.line > 0);
    CHECK(!scene.error().front().remedy.empty());
    return scene.error().front().code;
}

// The turn of a forearm about z at a time, once what was found has faded (0.35 s).
double turned(const Scene& scene, const char* joint, double t_s) {
    const Performed p = performed(scene);
    figure::Pose pose;
    p.performance->pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
    const figure::Skeleton& skeleton = *p.performance->actors()[0].skeleton;
    return to_rotation_vector(pose.parent_from_joint[skeleton.find(joint).value].rotation).z;
}
double turned(const std::string& block, const char* joint, double t_s) {
    const auto scene = load_clip(block);
    if (!scene) {
        FAIL(told(scene.error()));
    }
    return turned(*scene, joint, t_s);
}

std::vector<Transform> model_of(const Performed& p, double t_s) {
    figure::Pose pose;
    p.performance->pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
    const figure::Skeleton& skeleton = *p.performance->actors()[0].skeleton;
    std::vector<Transform> world(skeleton.joints.size());
    to_model_space(skeleton, pose, world);
    return world;
}

}  // namespace

TEST_CASE("a layer takes the place of what is below, by its weight, where and while it plays") {
    const auto right = [](const char* layer, double t) {
        return turned(
            std::string("clip hail {\n  from \"base.keys\"\n  layer { ") + layer + " }\n}",
            "rightUpperArm", t);
    };
    // Below it is t / 2; the layer 0.4 + 0.4 t for a second.
    CHECK(right("from \"extra.keys\"", 0.75) == doctest::Approx(0.7).epsilon(1e-4));
    CHECK(right("from \"extra.keys\"", 1.5) == doctest::Approx(0.75).epsilon(1e-4));
    CHECK(right("from \"extra.keys\", weight 0.25", 0.8) ==
          doctest::Approx(0.75 * 0.4 + 0.25 * 0.72).epsilon(1e-4));
    CHECK(right("from \"extra.keys\", begins 0.5 s", 1.25) == doctest::Approx(0.7).epsilon(1e-4));
    CHECK(right("from \"extra.keys\", begins 0.5 s, speed 0.8", 1.5) ==
          doctest::Approx(0.4 + 0.4 * 0.8).epsilon(1e-4));
    // Faded in as a cubic: half way at half of the time.
    CHECK(right("from \"extra.keys\", begins 0.5 s, fade_in 1 s", 1) ==
          doctest::Approx(0.5 * 0.5 + 0.5 * 0.6).epsilon(1e-4));
    CHECK(right("from \"extra.keys\", begins 0.5 s, fade_out 0.5 s", 1.25) ==
          doctest::Approx(0.5 * 0.625 + 0.5 * 0.7).epsilon(1e-4));
    // What is added is how far it is from its own beginning.
    CHECK(right("from \"extra.keys\", additive", 0.75) ==
          doctest::Approx(0.375 + 0.3).epsilon(1e-4));
    CHECK(right("from \"extra.keys\", additive, weight 0.5", 0.75) ==
          doctest::Approx(0.375 + 0.15).epsilon(1e-4));
    // Without a file it is another stretch of the same one.
    CHECK(right("reverse", 0.8) == doctest::Approx(1 - 0.4).epsilon(1e-4));
    CHECK(right("cut 1 s .. 2 s, only right_arm", 0.8) == doctest::Approx(0.9).epsilon(1e-4));
}

TEST_CASE("a mask lets a layer have its say about limbs and joints, more or less") {
    const auto both = [](const char* mask) {
        const auto scene = load_clip(
            std::string("clip hail {\n  from \"base.keys\"\n  layer { reverse, ") + mask + " }\n}");
        if (!scene) {
            FAIL(told(scene.error()));
        }
        return std::pair(turned(*scene, "rightUpperArm", 0.8), turned(*scene, "leftUpperArm", 0.8));
    };
    CHECK(both("only right_arm").first == doctest::Approx(0.6).epsilon(1e-4));
    CHECK(both("only right_arm").second == doctest::Approx(-0.4).epsilon(1e-4));
    CHECK(both("only right_arm and left_arm").second == doctest::Approx(-0.6).epsilon(1e-4));
    CHECK(both("only left_clavicle").second == doctest::Approx(-0.6).epsilon(1e-4));
    CHECK(both("only left_clavicle").first == doctest::Approx(0.4).epsilon(1e-4));
    CHECK(both("mask { left_shoulder 0.5, right_shoulder 1 }").second ==
          doctest::Approx(-0.5).epsilon(1e-4));
    CHECK(both("mask { left_shoulder 0.5, right_shoulder 1 }").first ==
          doctest::Approx(0.6).epsilon(1e-4));
    // A joint of a mask stands for itself alone.
    CHECK(both("mask { left_clavicle 1 }").second == doctest::Approx(-0.4).epsilon(1e-4));
}

TEST_CASE("degrees of freedom of a layer act on the joints of what is below") {
    const auto flexed = [](const char* layer, double t_s) {
        const auto scene = load_clip(std::string("clip hail {\n  from \"base.keys\"\n  layer { "
                                                 "from \"flex.keys\"") +
                                     layer + " }\n}");
        if (!scene) {
            FAIL(told(scene.error()));
        }
        const Performed p = performed(*scene);
        figure::Pose pose;
        p.performance->pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
        static const figure::Figure figure = figure::make_mannequin(1.75);
        static const figure::DofSet dofs = figure::humanoid_dofs(figure);
        const figure::Dof& dof = dofs.dofs[dofs.find("left_elbow.flex").value];
        const figure::DofSet::Range range = dofs.of_joint(dof.joint);
        std::vector<double> values(range.count);
        figure::values_of({dofs.dofs.data() + range.first, range.count},
                          figure.skeleton.joints[dof.joint.value].parent_from_joint_rest,
                          pose.parent_from_joint[dof.joint.value], values);
        return values[dofs.find("left_elbow.flex").value - range.first];
    };
    CHECK(flexed("", 1) == doctest::Approx(0.4).epsilon(1e-4));
    CHECK(flexed(", weight 0", 1) == doctest::Approx(0.3).epsilon(1e-4));
    CHECK(flexed(", weight 0.5", 1) == doctest::Approx(0.35).epsilon(1e-4));
    CHECK(flexed(", additive", 1.5) == doctest::Approx(0.4 + 0.3).epsilon(1e-4));
    CHECK(flexed(", additive, weight 0.5", 1) == doctest::Approx(0.3 + 0.1).epsilon(1e-4));
}

TEST_CASE("a warp moves instants, straight in between, the rest at its own pace") {
    // 0.5 s -> 1.5 s: the first half second is three times as slow; the rest ends at 3 s.
    const char* const block = "clip hail { from \"base.keys\", warp 0.5 s -> 1.5 s }";
    CHECK(turned(block, "rightUpperArm", 0.9) == doctest::Approx(0.15).epsilon(1e-4));
    CHECK(turned(block, "rightUpperArm", 1.5) == doctest::Approx(0.25).epsilon(1e-4));
    CHECK(turned(block, "rightUpperArm", 2.5) == doctest::Approx(0.75).epsilon(1e-4));
    const auto scene = load_clip(block);
    REQUIRE(scene.has_value());
    CHECK(performed(*scene).performance->score()[0].end == SimTime{3 * kTicksPerSecond});
    // Counted from where the clip is cut.
    CHECK(turned("clip hail {\n  from \"base.keys\"\n  cut 1 s .. 2 s\n  warp 0.5 s -> 1.5 s\n"
                 "  warp 1 s -> 2 s\n}",
                 "rightUpperArm", 0.9) == doctest::Approx(0.65).epsilon(1e-4));
}

TEST_CASE("a creature plays a clip by the names of its joints, and travels as the clip does") {
    const auto scene = load_clip("clip hail { from \"crane.glb\" }", kLinkage);
    if (!scene) {
        FAIL(told(scene.error()));
    }
    const Performed p = performed(*scene);
    const figure::Skeleton& skeleton = *p.performance->actors()[0].skeleton;
    const std::size_t lower = skeleton.find("lower").value, upper = skeleton.find("upper").value;
    for (double t = 0.5; t <= 2; t += 0.25) {
        const std::vector<Transform> model = model_of(p, t);
        const double u = t / 2;
        // It faces +X: ahead is +X, and the clip's 4 m are 2 m of a figure half as big.
        CHECK(length(model[lower].translation - Vec3{1 + 2 * u, 1, 0}) < 1e-6);
        // Turning about x leans towards what is ahead: the link of 1 m, of which the half below
        // `between` follows its own turn too.
        const double a = 0.8 * u;
        CHECK(std::fabs(
                  angle_between(Quat{}, conjugate(model[lower].rotation) * model[upper].rotation) -
                  0.2 * u) < 1e-6);
        CHECK(std::fabs(turn_between(heading_of(rotate(model[lower].rotation, kX)), kPi)) < 1e-6);
        CHECK(rotate(model[lower].rotation, kY).x == doctest::Approx(std::sin(a)).epsilon(1e-6));
        CHECK(length(model[upper].translation - model[lower].translation) ==
              doctest::Approx(1).epsilon(1e-6));
    }
}

TEST_CASE("a clip that loops goes on where it has come to, round after round") {
    const auto scene = load_clip("clip hail { from \"crane.glb\", loop }", kLinkage, "takes 6 s");
    REQUIRE(scene.has_value());
    const Performed p = performed(*scene);
    const std::size_t lower = p.performance->actors()[0].skeleton->find("lower").value;
    for (double t = 0.5; t <= 5.9; t += 0.2) {
        CHECK(model_of(p, t)[lower].translation.x == doctest::Approx(1 + t).epsilon(2e-3));
    }
    const auto ahead =
        load_clip("clip hail { from \"crane.glb\", only lower, advances 0.5 m/s }", kLinkage);
    REQUIRE(ahead.has_value());
    const Performed q = performed(*ahead);
    CHECK(model_of(q, 1.5)[lower].translation.x == doctest::Approx(1.75).epsilon(1e-6));
}

TEST_CASE("keyframes without a skeleton move the joints and degrees of freedom of their names") {
    const auto scene = load_clip("clip hail { from \"links.keys\" }", kLinkage);
    if (!scene) {
        FAIL(told(scene.error()));
    }
    const Performed p = performed(*scene);
    const figure::Skeleton& skeleton = *p.performance->actors()[0].skeleton;
    const std::vector<Transform> model = model_of(p, 1.5);
    const Quat lower = model[skeleton.find("lower").value].rotation,
               upper = model[skeleton.find("upper").value].rotation;
    CHECK(angle_between(conjugate(lower) * upper, about_x(-0.3)) < 1e-9);
    CHECK(angle_between(lower, about_y(kPi / 2) * about_x(0.6)) < 1e-9);
    CHECK(defect("clip hail { from \"base.keys\" }", kLinkage) == "nothing-moves");
}

TEST_CASE("what is wrong with layers, masks and warps is told where it stands [hostile]") {
    CHECK(defect("clip hail { from \"base.keys\", layer { from \"other.keys\" } }") ==
          "cannot-read");
    CHECK(defect("clip hail { from \"base.keys\", layer { take \"x\" } }") == "unknown-name");
    CHECK(defect("clip hail { from \"base.keys\", layer 3 }") == "wrong-property");
    CHECK(defect("clip hail { from \"base.keys\", layer { layer { reverse } } }") ==
          "unknown-name");
    CHECK(defect("clip hail { from \"base.keys\", layer { weight 2 } }") == "out-of-range");
    CHECK(defect("clip hail { from \"base.keys\", layer { weight 1 s } }") == "wrong-unit");
    CHECK(defect("clip hail { from \"base.keys\", layer { begins -1 s } }") == "out-of-range");
    CHECK(defect("clip hail { from \"base.keys\", layer { only tail } }") == "unknown-name");
    CHECK(defect("clip hail { from \"base.keys\", layer { mask 3 } }") == "wrong-property");
    CHECK(defect("clip hail { from \"base.keys\", layer { mask { tail 1 } } }") == "unknown-name");
    CHECK(defect("clip hail { from \"base.keys\", layer { mask { head 2 } } }") == "out-of-range");
    CHECK(defect("clip hail { from \"base.keys\", layer { mask { } } }") == "wrong-property");
    CHECK(defect("clip hail { from \"base.keys\", weight 1 }") == "unknown-name");
    CHECK(defect("clip hail { from \"base.keys\", warp 1 s }") == "wrong-property");
    CHECK(defect("clip hail { from \"base.keys\", warp 3 s -> 1 s }") == "out-of-range");
    CHECK(defect("clip hail { from \"base.keys\", warp 1 s -> 1 s, warp 0.5 s -> 2 s }") ==
          "out-of-range");
    CHECK(defect("clip hail { from \"base.keys\", advances 1 m }") == "wrong-unit");
    // Of a creature, and done by a humanoid; of both kinds at once.
    CHECK(defect("clip hail { from \"crane.glb\" }") == "nothing-moves");
    CHECK(defect("clip hail { from \"crane.glb\", layer { from \"base.keys\", only right_arm } }",
                 kLinkage) == "wrong-type");
}
