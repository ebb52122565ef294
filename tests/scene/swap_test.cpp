// SPDX-License-Identifier: MIT
// The papers' point: the technique of a movement is chosen without touching the net. One net, the
// greeting of one place made by seven techniques: the log stays what it is, and every performance
// joins. (The eighth, a capture retargeted, needs readers of files: io/swap_capture_test.cpp.)
#include <doctest/doctest.h>

#include <cmath>

#include "greeting_net.h"
#include "measured.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/host_movement.h"
#include "puppetri/scene/assets.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

// A file of motion that a test makes: an arm that rises and falls, as a clip of its joint.
class ArmClip final : public Assets {
 public:
    Checked<LoadedCharacter> character(const CharacterRequest&) override {
        return Unexpected(Diagnostics{});
    }
    Checked<LoadedClips> clips(const ClipRequest& request) override {
        if (request.path != "arm.keys") {
            return Unexpected(Diagnostics{{Severity::kError,
                                           "cannot-read",
                                           {},
                                           "file",
                                           "there is no such file",
                                           "name one"}});
        }
        motion::Clip clip;
        clip.name = "raise";
        clip.duration_s = 2.4;
        clip.rotations.push_back({"rightUpperArm", {}});
        clip.rotations.push_back({"rightLowerArm", {}});
        for (int k = 0; k <= 8; ++k) {
            motion::RotationKey key;
            key.t_s = 0.3 * k;
            key.interpolation = motion::Interpolation::kCatmullRom;
            const double rise = puppetri::sin(kPi * k / 8.0) * puppetri::sin(kPi * k / 8.0);
            key.value = about_z(radians(82) * (1 - rise));
            clip.rotations[0].keys.push_back(key);
            key.value = about_y(radians(20) + radians(70) * rise);
            clip.rotations[1].keys.push_back(key);
        }
        LoadedClips loaded;
        loaded.raw.push_back(clip);
        loaded.humanoid.push_back(std::move(clip));
        return loaded;
    }
};

using FilesWithClips = FilesWith<ArmClip>;

struct Taken {
    std::uint64_t log_hash = 0;
    Vec3 hand;  // of ana, in the middle of the greeting
};

Taken take(const std::string& greet, const std::string& definitions,
           std::span<const motion::OwnMovementPtr> host = {}) {
    FilesWithClips files;
    files.memory.add("scene.pup", test::greeting_with(greet, definitions));
    const Scene scene = must(load(files, "scene.pup", host));
    const Performed p = performed(scene);
    check_good(measured(p, scene, 0), greet);
    Taken out{p.log_hash, {}};
    for (const stage::ScoreEntry& row : p.performance->score()) {
        if (row.place == "greets") {
            figure::Pose pose;
            p.performance->pose({0}, row.start + SimTime{kTicksPerSecond * 12 / 10}, pose);
            const figure::Skeleton& skeleton = *p.performance->actors()[0].skeleton;
            std::vector<Transform> world(skeleton.joints.size());
            to_model_space(skeleton, pose, world);
            out.hand = world[skeleton.find("rightHand").value].translation;
            break;
        }
    }
    return out;
}

}  // namespace

TEST_CASE("a net never sees how its movements are made: seven techniques, one log [agree]") {
    // Inverse kinematics.
    const Taken reach = take("reach((0, 1.3, 0.2) m)", "");
    // The library.
    const Taken wave = take("wave()", "");
    // Keyframes.
    const Taken keys = take("hail()", R"(
keyframes hail(me: actor) {
  takes 2.4 s
  at 0 s:   me.right_shoulder.side = 5 deg, me.right_elbow.flex = 15 deg
  at 1 s:   me.right_shoulder.side = 80 deg, me.right_elbow.flex = 70 deg
  at 1.5 s: me.right_shoulder.side = 80 deg, me.right_elbow.flex = 40 deg
  at 2.4 s: me.right_shoulder.side = 5 deg, me.right_elbow.flex = 15 deg
}
)");
    // A formula over degrees of freedom, and one over the way of the hand.
    const Taken formula = take("hail(70 deg)", R"(
movement hail(me: actor, up: angle) {
  takes 2.4 s
  rise = sin(pi*t/2.4 s)^2
  me.right_shoulder.side = up * rise
  me.right_elbow.flex = (15 deg + 60 deg*rise) + 10 deg*rise*sin(9*t/1 s)
}
)");
    const Taken path = take("hail()", R"(
movement hail(me: actor) {
  takes 2.4 s
  rise = sin(pi*t/2.4 s)^2
  me.right_hand.position = (-0.25, -0.3, 0.1) m + rise*(-0.1, 0.5, 0.25) m in chest
}
)");
    // A clip.
    const Taken clip = take("hail()", "clip hail { from \"arm.keys\" }\n");
    // A callback.
    const motion::OwnMovementPtr host[] = {motion::make_host_movement(
        {.signature = {.name = "hail", .parameters = {motion::angle_parameter("up", radians(60))}},
         .spec = {.duration_s = 2.4, .dofs = {"right_shoulder.side", "right_elbow.flex"}},
         .pose = [](double t_s, const motion::HostArguments& with, motion::PoseFrame& frame) {
             const double rise = puppetri::sin(kPi * t_s / 2.4) * puppetri::sin(kPi * t_s / 2.4);
             frame.dofs[0] = with.number("up") * rise;
             frame.dofs[1] = radians(15) + radians(80) * rise;
         }})};
    const Taken callback = take("hail(up: 75 deg)", "", host);

    const std::uint64_t log = reach.log_hash;
    CHECK(wave.log_hash == log);
    CHECK(keys.log_hash == log);
    CHECK(formula.log_hash == log);
    CHECK(path.log_hash == log);
    CHECK(clip.log_hash == log);
    CHECK(callback.log_hash == log);
    // They are different movements.
    const Taken* all[] = {&reach, &wave, &keys, &formula, &path, &clip, &callback};
    for (std::size_t i = 0; i < std::size(all); ++i) {
        for (std::size_t k = i + 1; k < std::size(all); ++k) {
            CHECK(length(all[i]->hand - all[k]->hand) > 0.01);
        }
    }
}

TEST_CASE("a callback has typed parameters, and its wrong calls are told as all others [unit]") {
    const motion::OwnMovementPtr host[] = {motion::make_host_movement(
        {.signature = {.name = "hail",
                       .parameters = {motion::angle_parameter("up", 1),
                                      motion::prop_parameter("what")}},
         .spec = {.duration_s = 1, .dofs = {"head.flex"}},
         .pose = [](double, const motion::HostArguments& with, motion::PoseFrame& frame) {
             frame.dofs[0] = 0.1 * with.place("what").y;
         }})};
    const auto tell = [&](const std::string& call) {
        MemoryFiles files;
        files.add("scene.pup",
                  "language 1\nscene \"s\"\nuntil 3 s\ncast {\n ana: mannequin\n ball: sphere { at "
                  "(0, 1, 1) m }\n}\nplace p does ana." +
                      call + " tokens 1\nend { p }\n");
        const auto scene = load(files, "scene.pup", host);
        return scene ? std::string() : scene.error().front().code;
    };
    CHECK(tell("hail(what: ball)") == "");
    CHECK(tell("hail()") == "missing-argument");
    CHECK(tell("hail(2 s, ball)") == "wrong-unit");
    CHECK(tell("hale(what: ball)") == "unknown-name");
}

TEST_CASE("clips are cut, sped up, mirrored, masked, and told when they are wrong [unit]") {
    const auto tell = [](const std::string& block) {
        FilesWithClips files;
        files.memory.add("scene.pup",
                         "language 1\nscene \"s\"\nuntil 4 s\ncast { ana: mannequin }\n" + block +
                             "\nplace p does ana.hail() tokens 1\nend { p }\n");
        const auto scene = load(files, "scene.pup");
        if (!scene) {
            CHECK(scene.error().front().where.line > 0);
            CHECK(!scene.error().front().remedy.empty());
            return scene.error().front().code;
        }
        const Performed p = performed(*scene);
        const SimTime took = p.performance->score()[0].end;
        return std::to_string(took.ticks / kTicksPerMillisecond);
    };
    CHECK(tell("clip hail { from \"arm.keys\" }") == "2400");
    CHECK(tell("clip hail { from \"arm.keys\", take \"raise\", speed 2 }") == "1200");
    CHECK(tell("clip hail { from \"arm.keys\", cut 0.5 s .. 1.5 s, mirror, reverse }") == "1000");
    CHECK(tell("clip hail { from \"arm.keys\", loop, only right_arm }") == "2400");
    CHECK(tell("clip hail { from \"arm.keys\", only left_arm }") == "nothing-moves");
    CHECK(tell("clip hail { from \"other.bvh\" }") == "cannot-read");
    CHECK(tell("clip hail { from \"arm.keys\", take \"jump\" }") == "unknown-name");
    CHECK(tell("clip hail { from \"arm.keys\", cut 1 s .. 9 s }") == "out-of-range");
    CHECK(tell("clip hail { from \"arm.keys\", speed 0 }") == "out-of-range");
    CHECK(tell("clip hail { speed 2 }") == "no-file");
    CHECK(tell("clip hail { from 3 }") == "wrong-property");
    CHECK(tell("clip hail { from \"arm.keys\", sped 2 }") == "unknown-name");
}

TEST_CASE("the example of one net and five techniques performs them all in step [unit]") {
    const Scene scene = example("08_greeting/greeting.pup");
    const Performed p = performed(scene);
    CHECK_MESSAGE(p.notes.empty(), told(p.notes));
    CHECK(p.firings == 40);
    for (std::uint32_t actor = 0; actor < 5; ++actor) {
        const auto& figure = scene.play.cast.actors[actor];
        check_good(measured(p, scene, actor, 0, 6), figure.name);
    }
}
