// SPDX-License-Identifier: MIT
// The tuples of the dining philosophers and what they become: poses reached when they say, at the
// place of each philosopher.
#include "puppetri/io/keyframe_tuples.h"

#include <doctest/doctest.h>

#include "puppetri/io/keys_file.h"

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
