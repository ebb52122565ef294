// SPDX-License-Identifier: MIT
// BVH in: forward kinematics against an independent reader, every order of channels, every defect
// with its place.
#include "puppetri/io/bvh_reader.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/bvh_reader.h"

using namespace puppetri;
using namespace puppetri::io;

namespace {

// Positions of all joints of our reader against those of the tests' reader, in every `step`-th
// frame.
void same_motion(const ClipFile& file, const test::Bvh& other, double scale, std::size_t step) {
    REQUIRE(file.clips.size() == 1);
    const motion::Clip& clip = file.clips[0];
    const motion::ClipBinding binding = motion::bind_clip(clip, file.skeleton);
    figure::Pose pose = figure::rest_pose(file.skeleton);
    std::vector<Transform> model(file.skeleton.joints.size());
    for (std::size_t frame = 0; frame < other.frames.size(); frame += step) {
        motion::sample_clip(clip, binding, static_cast<double>(frame) * other.frame_time_s, pose);
        figure::to_model_space(file.skeleton, pose, model);
        const std::vector<Eigen::Isometry3d> world = other.pose(frame);
        std::size_t ours = 0;
        for (std::size_t j = 0; j < other.joints.size(); ++j) {
            if (other.joints[j].end_site) {
                const Vec3 tip = model[ours - 1] * file.skeleton.joints[ours - 1].end_site_joint;
                const Eigen::Vector3d p = world[j].translation() * scale;
                REQUIRE(length(tip - Vec3{p.x(), p.y(), p.z()}) < 1e-9);
                continue;
            }
            const Eigen::Vector3d p = world[j].translation() * scale;
            REQUIRE(length(model[ours].translation - Vec3{p.x(), p.y(), p.z()}) < 1e-9);
            const Eigen::Matrix3d m = world[j].linear();
            REQUIRE(length(rotate(model[ours].rotation, {0, 0, 1}) -
                           Vec3{m(0, 2), m(1, 2), m(2, 2)}) < 1e-9);
            ++ours;
        }
    }
}

const char* const kSmall =
    "HIERARCHY\nROOT hips\n{\n  OFFSET 0 90 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT chest\n  {\n    OFFSET 1 50 2\n    CHANNELS 3 Zrotation Yrotation Xrotation\n"
    "    End Site\n    {\n      OFFSET 0 20 0\n    }\n  }\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.04\n"
    "1 2 3 10 20 30 40 50 60\n-1 -2 -3 -10 -20 -30 -40 -50 -60\n";

std::string with(const std::string& from, const std::string& to) {
    std::string text = kSmall;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

// "CODE LINE:COLUMN" of the first defect.
std::string defect(const std::string& text) {
    const Checked<ClipFile> file = read_bvh(text, "x.bvh");
    if (file) {
        return "fine";
    }
    const Diagnostic& d = file.error()[0];
    CHECK(!d.remedy.empty());
    return d.code + " " + std::to_string(d.where.line) + ":" + std::to_string(d.where.column) +
           (d.element.empty() ? "" : " ") + d.element;
}

}  // namespace

TEST_CASE("joints of a small BVH are where an independent reader has them [oracle]") {
    const Checked<ClipFile> file = read_bvh(kSmall, "a/small.bvh");
    REQUIRE(file.has_value());
    same_motion(*file, test::read_bvh(kSmall), 0.01, 1);
    CHECK(file->clips[0].name == "small");
    CHECK(file->clips[0].duration_s == doctest::Approx(0.04));
    CHECK(file->clips[0].root == "hips");
    CHECK(file->frame_s == 0.04);
    CHECK(file->notes.empty());
    const Checked<ClipFile> metres = read_bvh(kSmall, "small.bvh", {.scale = 1});
    REQUIRE(metres.has_value());
    same_motion(*metres, test::read_bvh(kSmall), 1, 1);
}

TEST_CASE("channels come in any order and any subset, on any joint [oracle]") {
    const std::string text =
        "HIERARCHY\nROOT a\n{\nOFFSET 1 2 3\nCHANNELS 2 Yrotation Zposition\n"
        "JOINT b\n{\nOFFSET 0 5 0\nCHANNELS 6 Xrotation Yposition Yrotation Xposition Zrotation "
        "Zposition\n"
        "JOINT still\n{\nOFFSET 0 1 0\nCHANNELS 0\nJOINT c\n{\nOFFSET 4 5 6\nCHANNELS 1 Xrotation\n"
        "End Site\n{\nOFFSET 0 0 1\n}\n}\n}\n}\n}\n"
        "MOTION\nFrames: 3\nFrame Time: .5\n"
        "10 1 20 2 30 3 40 4 50\n11 12 13 14 15 16 17 18 19\n-5 -6 -7 -8 -9 -10 -11 -12 -13\n";
    const Checked<ClipFile> file = read_bvh(text, "order.bvh");
    REQUIRE(file.has_value());
    same_motion(*file, test::read_bvh(text), 0.01, 1);
    CHECK(file->clips[0].root == "a");
    CHECK(file->clips[0].find_rotation("still") == nullptr);
}

TEST_CASE("several roots are several trees in one skeleton [unit]") {
    std::string text = kSmall;
    text.insert(text.find("MOTION"),
                "ROOT sword\n{\nOFFSET 0 0 7\nCHANNELS 3 Xposition Yposition "
                "Zposition\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n");
    text.replace(text.find("60\n"), 3, "60 7 8 9\n");
    text.replace(text.rfind("60\n"), 3, "60 1 1 1\n");
    const Checked<ClipFile> file = read_bvh(text, "x.bvh");
    REQUIRE(file.has_value());
    const figure::JointIndex sword = file->skeleton.find("sword");
    REQUIRE(sword.valid());
    CHECK(!file->skeleton.joints[sword.value].parent.valid());
    CHECK(length(file->clips[0].find_translation("sword")->keys[0].value - Vec3{0.07, 0.08, 0.16}) <
          1e-12);
}

TEST_CASE("tracks that do not change have one key, joints of one name get their own [unit]") {
    std::string text = with("40 50 60\n", "1 1 1\n");
    text.replace(text.find("-40 -50 -60"), 11, "1 1 1");
    text.replace(text.find("chest"), 5, "hips");
    const Checked<ClipFile> file = read_bvh(text, "x.bvh");
    REQUIRE(file.has_value());
    CHECK(file->skeleton.joints[1].name == "hips_2");
    CHECK(file->clips[0].find_rotation("hips_2")->keys.size() == 1);
    CHECK(file->clips[0].find_rotation("hips")->keys.size() == 2);
    REQUIRE(file->notes.size() == 1);
    CHECK(file->notes[0].code == "duplicate-joint");
}

TEST_CASE("defects of a BVH have their line and name their joint, channel or frame [unit]") {
    CHECK(defect("") == "bad-bvh 1:1");
    CHECK(defect("solid cube") == "bad-bvh 1:1");
    CHECK(defect(with("HIERARCHY\nROOT hips\n", "HIERARCHY\nMOTION\nROOT hips\n")) ==
          "bad-bvh 2:1");
    CHECK(defect(with("-40 -50 -60", "-40 -50")) ==
          "missing-channel 20:29 frame 2, joint chest, xrotation");
    CHECK(defect(with("-40 -50 -60", "-40 -50 -60 -70")) == "extra-channel 20:34 frame 2");
    CHECK(defect(with("50 60\n", "nan 60\n")) ==
          "bad-number 19:19 frame 1, joint chest, yrotation");
    CHECK(defect(with("50 60\n", "1e999 60\n")).starts_with("bad-number 19:19"));
    CHECK(defect(with("50 60\n", "5O 60\n")).starts_with("bad-number 19:19"));
    CHECK(defect(with("Time: 0.04", "Time: 0")) == "bad-frame-time 18:13 Frame Time");
    CHECK(defect(with("Time: 0.04", "Time: -0.04")) == "bad-frame-time 18:13 Frame Time");
    CHECK(defect(with("Time: 0.04", "Time: nan")) == "bad-number 18:13 Frame Time");
    CHECK(defect(with("Frames: 2", "Frames: 7")).starts_with("truncated"));
    CHECK(defect(with("Frames: 2", "Frames: 100000000")).starts_with("truncated"));
    CHECK(defect(with("Frames: 2", "Frames: -2")).starts_with("bad-bvh 17:9"));
    CHECK(defect(with("3 Zrotation Yrotation Xrotation", "3 Zrotation Yrotation")) ==
          "missing-channel 9:16 joint chest");
    CHECK(defect(with("3 Zrotation Yrotation Xrotation", "2 Zrotation Yrotation Xrotation")) ==
          "extra-channel 9:16 joint chest");
    CHECK(defect(with("3 Zrotation Yrotation Xrotation", "3 Zrotation Yrotation Wrotation"))
              .starts_with("bad-bvh 9:"));
    CHECK(defect(with("3 Zrotation Yrotation Xrotation", "3 Zrotation Yrotation Zrotation"))
              .starts_with("bad-bvh 9:"));
    CHECK(defect(with("OFFSET 1 50 2", "OFFSET 1 50")).starts_with("bad-number"));
    CHECK(defect(with("  }\n}\nMOTION", "  }\nMOTION")).starts_with("bad-bvh"));
    // One more frame than announced is used, and told.
    const Checked<ClipFile> more = read_bvh(with("Frames: 2", "Frames: 1"), "x.bvh");
    REQUIRE(more.has_value());
    CHECK(more->clips[0].duration_s == doctest::Approx(0.04));
    CHECK(more->notes.at(0).code == "frame-count");
    std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n";
    for (int i = 0; i < 100'000; ++i) {
        deep += "JOINT a\n{\nOFFSET 0 0 0\n";
    }
    CHECK(defect(deep).starts_with("too-large"));
}

TEST_CASE("all bad frames are told at once [unit]") {
    std::string text = with("50 60\n", "x 60\n");
    text.replace(text.find("-50"), 3, "y");
    const Checked<ClipFile> file = read_bvh(text, "x.bvh");
    REQUIRE(!file.has_value());
    CHECK(file.error().size() == 2);
}

TEST_CASE("a capture of CMU is read as it is, and its odd scale is told with the remedy [oracle]") {
    const std::filesystem::path path = PUP_SOURCE_DIR "/../shared/motion/cmu_01_01.bvh";
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: ../shared/motion is missing");
        return;
    }
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const Checked<ClipFile> file = read_bvh(text, "cmu_01_01.bvh");
    REQUIRE(file.has_value());
    CHECK(file->skeleton.joints.size() == 31);
    CHECK(file->clips[0].find_rotation("LeftLeg")->keys.size() == 2752);
    same_motion(*file, test::read_bvh(text), 0.01, 100);
    REQUIRE(file->notes.size() == 1);
    CHECK(file->notes[0].code == "odd-scale");
    CHECK(file->notes[0].remedy.find("--scale 0.056444") != std::string::npos);
    const Checked<ClipFile> scaled = read_bvh(text, "cmu_01_01.bvh", {.scale = 0.056444});
    REQUIRE(scaled.has_value());
    CHECK(scaled->notes.empty());
    CHECK(scaled->skeleton.height_m > 1.3);
    CHECK(scaled->skeleton.height_m < 2.1);
    // Taken for metres it would be a giant.
    const Checked<ClipFile> giant = read_bvh(text, "cmu_01_01.bvh", {.scale = 2});
    REQUIRE(giant.has_value());
    CHECK(giant->notes.at(0).code == "odd-scale");
}
