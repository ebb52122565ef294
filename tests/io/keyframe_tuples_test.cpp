// SPDX-License-Identifier: MIT
// The tuples of the dining philosophers and what they become: poses reached when they say, at the
// place of each philosopher.
#include "puppetri/io/keyframe_tuples.h"

#include <doctest/doctest.h>

#include "puppetri/io/keys_file.h"
#include "puppetri/scene/perform.h"
#include "puppetri/scene/scene.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::notation;

namespace {

const char* const kPoses =
    "keys 1\n"
    "clip RESTING root root\nnumber right_elbow.flex degrees\n 0 20\n"
    "clip EATING1 root root\nnumber right_elbow.flex degrees\n 0 60\n"
    "translation root\n 0 0 0 0.1\n"
    "clip EATING2 root root\nnumber right_elbow.flex degrees\n 0 120\n"
    "clip man2 root root\ntranslation root\n 0 1 0 2\nrotation root degrees\n 0 0 90 0\n";

}  // namespace

TEST_CASE("tuples are read and written, their defects told by line [unit]") {
    const auto tuples = read_tuples("0 man1 RESTING\n# a comment\n24 man1 EATING1  # here\n", "t");
    REQUIRE(tuples.has_value());
    CHECK(tuples->size() == 2);
    CHECK((*tuples)[1] == KeyframeTuple{24, "man1", "EATING1"});
    CHECK(make_tuples(*tuples) == "0 man1 RESTING\n24 man1 EATING1\n");
    const auto bad = read_tuples("x man1 A\n1.5 man1 A\n3 man1\n4 m A\n4 m B\n", "t");
    REQUIRE(!bad.has_value());
    CHECK(bad.error().size() == 4);
    CHECK(bad.error()[0].code == "bad-tuple");
    CHECK(bad.error()[3].where.line == 5);
}

TEST_CASE(
    "poses are reached when the tuples say, each object at its place, straight in between "
    "[oracle]") {
    const auto poses = read_keys(kPoses, "poses.keys");
    REQUIRE(poses.has_value());
    const auto tuples = read_tuples(
        "0 man1 RESTING\n0 man2 RESTING\n24 man2 EATING1\n48 man2 EATING2\n24 man1 EATING2\n", "t");
    REQUIRE(tuples.has_value());
    const auto scene = absolute_keyframes(*tuples, *poses, 24, motion::Interpolation::kLinear, "t");
    REQUIRE(scene.has_value());
    REQUIRE(scene->clips.size() == 2);
    const motion::Clip& man2 = scene->clips[1];
    CHECK(man2.name == "man2");
    CHECK(man2.duration_s == 2);
    const auto flex = [&](double t) {
        return motion::sample(*man2.find_number("right_elbow.flex"), t, false, 2) * 180 / kPi;
    };
    CHECK(flex(0) == doctest::Approx(20));
    CHECK(flex(0.5) == doctest::Approx(40));
    CHECK(flex(1) == doctest::Approx(60));
    CHECK(flex(2) == doctest::Approx(120));
    // 0.1 m ahead of a place at (1, 0, 2) that looks along +X.
    const Vec3 root = motion::sample(*man2.find_translation("root"), 1, false, 2);
    CHECK(length(root - Vec3{1.1, 0, 2}) < 1e-9);
    CHECK(length(motion::sample(*man2.find_translation("root"), 0, false, 2) - Vec3{1, 0, 2}) <
          1e-9);
    CHECK(man2.marks[1].name == "EATING1");
    // The file of absolute keyframes is a keyframe file like any other.
    const std::string text = make_keys(*scene);
    const auto again = read_keys(text, "absolute.keys");
    REQUIRE(again.has_value());
    CHECK(make_keys(*again) == text);
    const auto unknown = read_tuples("0 man1 EATINGG1\n", "t");
    const auto refused =
        absolute_keyframes(*unknown, *poses, 24, motion::Interpolation::kLinear, "t");
    REQUIRE(!refused.has_value());
    CHECK(refused.error()[0].code == "unknown-pose");
}

TEST_CASE("a performance written as tuples and read as a net is performed alike [law]") {
    const std::string head =
        "language 1\nscene \"s\"\nframes 24 per second, until frame 120\n"
        "cast { ana: mannequin { at (-1, 0, 0) m }, rui: mannequin { at (1, 0, 0) m } }\n"
        "keyframes low(me: actor) { takes 1 s; at 1 s: me.right_elbow.flex = 20 deg }\n"
        "keyframes high(me: actor) { takes 1 s; at 1 s: me.right_elbow.flex = 110 deg }\n";
    const auto performed = [](const scene::MemoryFiles& given) {
        scene::MemoryFiles files = given;
        const auto scene = scene::load(files, "scene.pup");
        REQUIRE(scene.has_value());
        auto done = scene::perform(*scene, {});
        REQUIRE(done.has_value());
        return std::move(*done);
    };
    scene::MemoryFiles original;
    original.add("scene.pup",
                 head +
                     "net m(me: actor, d: time) {\n place a does me.low() takes d tokens 1\n"
                     " place b does me.high() takes 17 frames\n ab: a -> b\n ba: b -> a\n}\n"
                     "use m(ana, 20 frames) as x\nuse m(rui, 31 frames) as y\n");
    const auto first = performed(original);
    const std::string tuples = make_tuples(tuples_of(*first.performance, {24, 1}));
    // 20, 37, 57, 74, 94, 111 and 31, 48, 79, 96: by hand.
    CHECK(tuples ==
          "20 ana low\n31 rui low\n37 ana high\n48 rui high\n57 ana low\n74 ana high\n79 rui "
          "low\n94 ana low\n96 rui high\n111 ana high\n");
    scene::MemoryFiles again;
    again.add("d.tuples", tuples);
    again.add("scene.pup", head +
                               "import d from \"d.tuples\"\n"
                               "use d(ana: ana, rui: rui, low: low(), high: high())\n");
    const auto second = performed(again);
    figure::Pose p, q;
    for (std::uint32_t actor = 0; actor < 2; ++actor) {
        for (int frame = 0; frame <= 96; ++frame) {
            const SimTime at = FrameRate{24, 1}.time_of(frame);
            first.performance->pose({actor}, at, p);
            second.performance->pose({actor}, at, q);
            for (std::size_t j = 0; j < p.parent_from_joint.size(); ++j) {
                const Quat d =
                    conjugate(p.parent_from_joint[j].rotation) * q.parent_from_joint[j].rotation;
                CHECK(std::fabs(d.w) > 1 - 1e-9);
            }
        }
    }
}
