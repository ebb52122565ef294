// SPDX-License-Identifier: MIT
// Linkages and characters in the language: what they become, and what is wrong with them.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "puppetri/figure/character.h"
#include "puppetri/math/rotation.h"
#include "puppetri/scene/assets.h"
#include "puppetri/scene/perform.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

Checked<Scene> load_cast(const std::string& member, const std::string& rest = "") {
    MemoryFiles files;
    files.add("s.pup",
              "language 1\nscene \"s\"\nuntil 2 s\ncast {\n  arm: " + member + "\n}\n" + rest);
    return load(files, "s.pup");
}

std::string defect(const std::string& member, const std::string& rest = "") {
    const auto scene = load_cast(member, rest);
    if (scene) {
        return "";
    }
    std::string all;  // but that there are no files here
    for (const Diagnostic& d : scene.error()) {
        if (d.code != "no-assets" || scene.error().size() == 1) {
            all += (all.empty() ? "" : ", ") + d.code + " line " + std::to_string(d.where.line);
        }
    }
    return all;
}

// A source whose characters are all one, and that tells what was asked.
class OneCharacter final : public FileSource, public Assets {
 public:
    std::string text;
    CharacterRequest asked;
    Diagnostics fails;

    Result<std::string, FileProblem> read(const std::string& path) override {
        if (path == "dir/s.pup") {
            return text;
        }
        return Unexpected(FileProblem{"there is no such file"});
    }
    Assets* assets() override { return this; }
    Checked<LoadedCharacter> character(const CharacterRequest& request) override {
        asked = request;
        if (!fails.empty()) {
            return Unexpected(fails);
        }
        figure::Character c;
        const figure::Figure f = figure::make_mannequin(request.height_m.value_or(1.5));
        c.skeleton = f.skeleton;
        c.limits = f.limits;
        if (request.humanoid) {
            c.humanoid = figure::Humanoid{f, {}};
        }
        return LoadedCharacter{std::make_shared<const figure::Character>(std::move(c)), {}};
    }
    Checked<LoadedClips> clips(const ClipRequest&) override { return Unexpected(Diagnostics{}); }
};

constexpr const char* kArm =
    "linkage {\n    at (1, 0, 0) m, facing 90 deg\n"
    "    link turret { d 0.3 m, alpha 90 deg, turns -170 .. 170 deg }\n"
    "    link upper { a 0.5 m, theta 90 deg, turns 0 .. 180 deg }\n"
    "    link probe { alpha 90 deg, d 0.1 m, slides 5 cm .. 0.3 m as reach }\n  }";

}  // namespace

TEST_CASE("a linkage of the language has the joints, DOFs and place that it says [unit]") {
    const auto scene = load_cast(kArm);
    REQUIRE(scene.has_value());
    const stage::Actor& actor = scene->play.cast.actors[0];
    CHECK(actor.body == stage::BodyKind::kCharacter);
    CHECK(!actor.humanoid());
    REQUIRE(actor.character->skeleton.joints.size() == 4);
    const auto& dofs = actor.character->dofs.dofs;
    REQUIRE(dofs.size() == 3);
    CHECK(dofs[0].name == "turret.turn");
    CHECK(dofs[0].lo == doctest::Approx(radians(-170)));
    CHECK(dofs[1].at_rest == doctest::Approx(radians(90)));
    CHECK(dofs[2].name == "probe.reach");
    CHECK(dofs[2].kind == figure::DofKind::kSlide);
    CHECK(dofs[2].lo == doctest::Approx(0.05));
    CHECK(actor.heading_rad == doctest::Approx(kPi / 2));
}

TEST_CASE("a formula moves the links of a linkage while the net says so [oracle]") {
    const auto scene = load_cast(kArm,
                                 "movement m(me: actor) {\n  takes 2 s\n"
                                 "  me.turret.turn = 40 deg * sin(pi*t/2 s)\n"
                                 "  me.probe.reach = 0.1 m + 0.1 m * sin(pi*t/2 s)\n}\n"
                                 "place p does arm.m() tokens 1\nend { p }\n");
    REQUIRE(scene.has_value());
    const auto performed = perform(*scene);
    REQUIRE(performed.has_value());
    figure::Pose pose;
    performed->performance->pose({0}, SimTime{kTicksPerSecond}, pose);
    const figure::Skeleton& skeleton = *performed->performance->actors()[0].skeleton;
    std::vector<Transform> world(skeleton.joints.size());
    figure::to_model_space(skeleton, pose, world);
    CHECK(length(world[0].translation - Vec3{1, 0, 0}) < 1e-9);
    // Turned by 40 degrees about the vertical, the upper arm straight up.
    CHECK(length(world[3].translation - world[1].translation) ==
          doctest::Approx(std::sqrt(0.5 * 0.5 + 0.2 * 0.2)).epsilon(1e-6));
    const Vec3 ahead = rotate(world[1].rotation, {1, 0, 0});  // x of the turret
    CHECK(heading_of(ahead) == doctest::Approx(kPi / 2 + radians(40)).epsilon(1e-6));
}

TEST_CASE("what is wrong with a linkage or character is told where it stands [unit]") {
    CHECK(defect(kArm) == "");
    CHECK(defect("linkage { at (0, 0, 0) m }") == "no-links line 5");
    CHECK(defect("linkage {\n link a { turns 60 .. -30 deg }\n}") == "min-above-max line 6");
    CHECK(defect("linkage {\n link a { theta 90 deg, turns 0 .. 30 deg }\n}") ==
          "rest-outside-range line 6");
    CHECK(defect("linkage {\n link a\n link a\n}") == "name-used-twice line 7");
    CHECK(defect("linkage {\n link a { on b }\n}") == "unknown-name line 6");
    CHECK(defect("linkage {\n link a { a 1 m, at (0, 1, 0) m }\n}") == "wrong-property line 6");
    CHECK(defect("linkage {\n link a { turns 30 deg }\n}") == "wrong-property line 6");
    CHECK(defect("linkage {\n link a { bar { diameter 1 cm } }\n}") == "zero-length line 6");
    CHECK(defect("character { height 1.7 m }") == "no-file line 5");
    CHECK(defect("character { file \"a.glb\" }") == "no-assets line 5");
    CHECK(defect("character { file \"a.glb\", height 60 m }") == "height-out-of-range line 5");
    CHECK(defect("character { file \"a.glb\", bones { hips \"x\" } }") == "wrong-property line 5");
    CHECK(defect(kArm, "place p does arm.walk(steps: 2) tokens 1\nend { p }\n") ==
          "wrong-subject line 12");
}

TEST_CASE(
    "a character is asked of the assets, beside the scene, and performs as a humanoid [unit]") {
    OneCharacter files;
    files.text =
        "language 1\nscene \"s\"\nuntil 3 s\ncast {\n"
        "  ana: character { file \"models/ana.glb\", height 1.6 m, bones { hips: \"Hip Bone\" } }\n"
        "  ball: sphere { diameter 22 cm, held by ana.hands }\n}\n"
        "place p does ana.walk(steps: 2, arms: carry(ball)) tokens 1\nend { p }\n";
    const auto scene = load(files, "dir/s.pup");
    REQUIRE(scene.has_value());
    CHECK(files.asked.path == "dir/models/ana.glb");
    CHECK(files.asked.height_m == 1.6);
    REQUIRE(files.asked.bones.size() == 1);
    CHECK(files.asked.bones[0].joint == "Hip Bone");
    CHECK(files.asked.bones[0].where.line == 5);
    CHECK(scene->play.cast.actors[0].height_m == doctest::Approx(1.6));
    files.fails = {{Severity::kError,
                    "no-bone",
                    {},
                    "left_knee",
                    "the character has no left_knee",
                    "name its joint"}};
    const auto failed = load(files, "dir/s.pup");
    REQUIRE(!failed.has_value());
    REQUIRE(failed.error().size() == 1);  // and nothing that follows from it
    CHECK(failed.error()[0].code == "no-bone");
    CHECK(failed.error()[0].element == "character ana, left_knee");
    CHECK(failed.error()[0].where.line == 5);
    files.fails.clear();
    files.text.replace(files.text.find("character"), 9, "creature ");
    const auto creature = load(files, "dir/s.pup");
    REQUIRE(!creature.has_value());
    for (const Diagnostic& d : creature.error()) {
        CHECK((d.code == "wrong-subject" || d.code == "no-hands"));
    }
}
