// SPDX-License-Identifier: MIT
// A counting allocator: whatever a figure does, showing a frame of it asks the heap for nothing.
#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "measured.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/host_movement.h"
#include "puppetri/motion/library.h"
#include "puppetri/scene/assets.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

// "walk.bvh": a take of a man of 1.9 m who walks, made by sampling a performance; so it comes with
// hips and feet, and who performs it is somebody of other proportions. "arm.keys": two joints.
class Takes final : public Assets {
 public:
    Checked<LoadedCharacter> character(const CharacterRequest&) override {
        return Unexpected(Diagnostics{});
    }
    Checked<LoadedClips> clips(const ClipRequest& request) override {
        LoadedClips loaded;
        loaded.humanoid.push_back(request.path == "walk.bvh" ? walk() : arm());
        loaded.raw = loaded.humanoid;
        if (request.path == "walk.bvh") {
            loaded.skeleton = figure::make_mannequin(1.9).skeleton;
            loaded.hips_height_m = hips_height_m_;
        }
        return loaded;
    }

 private:
    static motion::Clip arm() {
        motion::Clip clip;
        clip.name = "raise";
        clip.duration_s = 1;
        clip.rotations = {{"rightUpperArm", {}}, {"leftUpperArm", {}}};
        for (int k = 0; k <= 4; ++k) {
            motion::RotationKey key;
            key.t_s = k / 4.0;
            key.interpolation = motion::Interpolation::kCatmullRom;
            key.value = about_z(radians(82 - 10 * (k % 3)));
            clip.rotations[0].keys.push_back(key);
            key.value = conjugate(key.value);
            clip.rotations[1].keys.push_back(key);
        }
        return clip;
    }

    motion::Clip walk() {
        MemoryFiles files;
        files.add("scene.pup",
                  "language 1\nscene \"s\"\nuntil 3 s\ncast { tom: mannequin { height 1.9 m } }\n"
                  "place p does tom.walk(steps: 3) tokens 1\nend { p }\n");
        const Scene scene = must(load(files, "scene.pup"));
        const Performed p = performed(scene);
        const figure::Figure tom = figure::make_mannequin(1.9);
        motion::Clip clip;
        clip.name = "walk";
        clip.duration_s = 2;
        clip.root = "hips";
        clip.translations.push_back({"hips", {}});
        figure::Pose pose;
        for (std::size_t j = 1; j < tom.skeleton.joints.size(); ++j) {
            clip.rotations.push_back({tom.skeleton.joints[j].name, {}});
        }
        for (int k = 0; k <= 48; ++k) {
            const double t = k / 24.0;
            p.performance->pose({0}, SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)}, pose);
            const Transform hips = pose.parent_from_joint[0] * pose.parent_from_joint[1];
            hips_height_m_ = k == 0 ? hips.translation.y : hips_height_m_;
            for (std::size_t j = 1; j < tom.skeleton.joints.size(); ++j) {
                motion::RotationKey key;
                key.t_s = t;
                key.value =
                    j == tom.hips.value ? hips.rotation : pose.parent_from_joint[j].rotation;
                clip.rotations[j - 1].keys.push_back(key);
            }
            motion::VectorKey place;
            place.t_s = t;
            place.value = hips.translation;
            clip.translations[0].keys.push_back(place);
        }
        for (const auto& [foot, from, to] :
             {std::tuple{"leftFoot", 0.0, 0.4}, std::tuple{"rightFoot", 0.5, 1.2}}) {
            clip.marks.push_back({from, to, "contact", foot});
        }
        return clip;
    }

    double hips_height_m_ = 0;
};

const char* const kOwn = R"(
movement by_formula(me: actor) {
  takes 1 s
  rise = sin(pi*t/1 s)^2
  me.right_shoulder.side = 75 deg*rise
  me.left_hand.position = (0.25, -0.3, 0.1) m + rise*(0.1, 0.4, 0.25) m in chest
  me.head.flex = 15 deg*sin(2*pi*t/1 s)
}
keyframes by_keys(me: actor) {
  takes 1 s
  at 0 s: me.left_shoulder.flex = 0 deg, me.left_elbow.flex = 15 deg
  at 0.4 s: me.left_shoulder.flex = 60 deg, me.left_elbow.flex = 40 deg
  at 1 s: me.left_shoulder.flex = 0 deg, me.left_elbow.flex = 15 deg
}
clip by_clip { from "arm.keys" }
clip by_part { from "arm.keys", only right_arm, loop, mirror }
clip by_capture { from "walk.bvh" }
)";

struct Call {
    std::string movement;   // of the library, or of kOwn
    std::string arguments;  // as text
};

// Each with somebody and a ball where it needs them. `before` brings ana and the ball there.
struct Situation {
    const char* ball;    // of the cast
    double apart_m;      // how far rui stands in front of ana
    const char* before;  // what ana does first
    std::vector<Call> calls;
};

const std::vector<Situation>& situations() {
    static const std::vector<Situation> list{
        {"at (3, 0.11, 3) m",
         3,
         "idle(lasting: 1 s)",
         {{"idle", "lasting: 1 s"},
          {"walk", "steps: 3"},
          {"step", "left"},
          {"half_step", "right"},
          {"turn", "60 deg"},
          {"face", "rui"},
          {"go", "(0.4, 0, 0.8) m"},
          {"bow", ""},
          {"wave", ""},
          {"eat", ""},
          {"sit", ""},
          {"stand_up", ""},
          {"jump", ""},
          {"look", "(1, 1, 1) m"},
          {"reach", "(0.2, 1.3, 0.6) m"},
          {"point", "(2, 1.4, 2) m"},
          {"aim", "(1, 1.3, 3) m"},
          {"swing", ""},
          {"stand", "lasting: 1 s"},
          {"ready", "ball, from: rui"},
          {"by_formula", ""},
          {"by_keys", ""},
          {"by_clip", ""},
          {"by_part", ""},
          {"by_capture", ""},
          {"by_callback", ""}}},
        {"held by ana.hands",
         3,
         "idle(lasting: 1 s)",
         {{"throw", "ball, to: rui"}, {"carry", "ball"}, {"hold", "ball"}}},
        {"held by ana.hands", 0.92, "idle(lasting: 1 s)", {{"hand_over", "ball, to: rui"}}},
        {"at (0, 0.11, 0.4) m", 3, "idle(lasting: 1 s)", {{"pick_up", "ball"}}},
        {"at (-0.2, 1.1, 0.4) m",
         3,
         "idle(lasting: 1 s)",
         {{"take", "ball"}, {"lay", "ball, at: (-0.2, 1.1, 0.4) m"}}},
        {"at (3, 0.11, 3) m", 0.37, "idle(lasting: 1 s)", {{"hug", "rui"}}},
    };
    return list;
}

std::vector<motion::OwnMovementPtr> callbacks() {
    return {motion::make_host_movement(
        {.signature = {.name = "by_callback"},
         .spec = {.duration_s = 1, .dofs = {"right_shoulder.side"}},
         .pose = [](double t_s, const motion::HostArguments&, motion::PoseFrame& frame) {
             frame.dofs[0] = puppetri::sin(kPi * t_s);
         }})};
}

// Two figures, one after another through all calls of a situation; rui throws to ana at last, where
// there is a ball in her hands.
Scene scene_of(const Situation& s) {
    std::string text = std::string(
                           "language 1\nscene \"s\"\nuntil 120 s\ncast {\n  ana: mannequin\n"
                           "  rui: mannequin { height 1.6 m, facing 180 deg, at (0, 0, ") +
                       std::to_string(s.apart_m) + ") m }\n  ball: sphere { diameter 8 cm, " +
                       s.ball + " }\n}\n" + kOwn + "place p does ana." + s.before + " tokens 1\n";
    std::string last = "p";
    int k = 0;
    for (const Call& call : s.calls) {
        const std::string place = "q" + std::to_string(k);
        text += "place " + place + " does ana." + call.movement + "(" + call.arguments + ")\nt" +
                std::to_string(k) + ": " + last + " -> " + place + "\n";
        last = place;
        ++k;
    }
    text += "place z does ana.idle(lasting: 1 s)\nlast: " + last + " -> z\nend { z }\n";
    FilesWith<Takes> files;
    files.memory.add("scene.pup", text);
    const auto host = callbacks();
    return must(load(files, "scene.pup", host));
}

// A throw, a flight, a catch.
Scene exchange() {
    return from_text(R"(
place s does rui.ready(ball, from: ana) takes 1 s tokens 1
place r does ana.throw(ball, to: rui) takes 1 s tokens 1
place f does ball.fly(from: ana, to: rui)
place w
place rr does ana.idle()
place c does rui.catch(ball)
place e does rui.idle(lasting: 1 s)
let_go: r -> f + rr
wait: s -> w
begin: f + w -> c
done: c -> e
end { e and rr }
)");
}

void show_frames(const Performed& p, double rate_hz, const std::function<void(double)>& shown) {
    const stage::Performance& performance = *p.performance;
    figure::Pose pose;
    for (double t = 0; t < performance.duration().seconds(); t += 1 / rate_hz) {
        const SimTime at{static_cast<std::int64_t>(t * kTicksPerSecond)};
        for (std::uint32_t actor = 0; actor < performance.actors().size(); ++actor) {
            performance.pose({actor}, at, pose);
        }
        for (std::uint32_t prop = 0; prop < performance.props().size(); ++prop) {
            (void)performance.world_from_prop({prop}, at);
        }
        shown(t);
    }
}

void check_no_allocation(const Scene& scene, const std::string& what) {
    // Warm: another performance of the same scene, so that what a movement keeps for itself counts.
    const Performed first = performed(scene);
    show_frames(first, 30, [](double) {});
    const Performed p = performed(scene);
    double at_s = -1;
    std::uint64_t before = 0, counted = 0;
    show_frames(p, 24, [&](double t) {
        const std::uint64_t now = test::allocations();
        if (t > 0 && now != before) {
            at_s = at_s < 0 ? t : at_s;
            counted += now - before;
        }
        before = test::allocations();
    });
    std::string place;
    for (const stage::ScoreEntry& row : p.performance->score()) {
        if (row.start.seconds() <= at_s) {
            place = row.place + " " + row.movement;
        }
    }
    CHECK_MESSAGE(counted == 0,
                  what << ": " << counted << ", first at " << at_s << " s in " << place);
}

}  // namespace

TEST_CASE("no frame of any movement asks for memory, after the first [alloc]") {
    std::set<std::string> done{"fly",     "catch",         "transfer",
                               "support", "swing_forward", "swing_backward"};
    for (const Situation& s : situations()) {
        for (const Call& call : s.calls) {
            done.insert(call.movement);
        }
        check_no_allocation(scene_of(s), s.calls.front().movement);
    }
    check_no_allocation(exchange(), "exchange");
    check_no_allocation(example("02_walk/limbs.pup"), "limbs");
    // None of the library is left out.
    for (const motion::MovementSignature& m : motion::movement_library()) {
        CHECK_MESSAGE(done.contains(std::string(m.name)), m.name);
    }
}
