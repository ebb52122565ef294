// SPDX-License-Identifier: MIT
// Motion from every format into every other: where the joints are, by readers that share no code
// with ours; keyframe files bit by bit; defects.
#include "puppetri/io/clip_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "puppetri/io/disk_files.h"
#include "puppetri/io/keys_file.h"
#include "support/bvh_reader.h"
#include "support/gltf_reader.h"

using namespace puppetri;
using namespace puppetri::io;

namespace {

const std::filesystem::path kMotion = PUP_SOURCE_DIR "/../shared/motion";

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool missing() {
    if (std::filesystem::exists(kMotion)) {
        return false;
    }
    MESSAGE("skipped: ../shared/motion is missing");
    return true;
}

ClipFile loaded(const std::filesystem::path& path, const ClipReadOptions& options = {}) {
    Checked<ClipFile> file = load_clips(path.string(), options);
    REQUIRE_MESSAGE(file.has_value(), (file ? std::string() : file.error()[0].message));
    return std::move(*file);
}

std::vector<Transform> model_at(const ClipFile& file, std::size_t clip, double t_s) {
    figure::Pose pose = figure::rest_pose(file.skeleton);
    motion::sample_clip(file.clips[clip], motion::bind_clip(file.clips[clip], file.skeleton), t_s,
                        pose);
    std::vector<Transform> model(file.skeleton.joints.size());
    figure::to_model_space(file.skeleton, pose, model);
    return model;
}

// Joints of ours at the places of the nodes of the same name.
void same_as_nodes(const ClipFile& file, std::size_t clip, const test::GltfFile& other,
                   std::size_t other_clip, double tolerance) {
    for (int i = 0; i <= 20; ++i) {
        const double t = file.clips[clip].duration_s * i / 20;
        const std::vector<Transform> ours = model_at(file, clip, t);
        const std::vector<Eigen::Isometry3d> theirs = other.pose(other_clip, t);
        for (std::size_t j = 0; j < ours.size(); ++j) {
            const int node = other.find(file.skeleton.joints[j].name);
            if (node < 0) {
                continue;
            }
            const Eigen::Isometry3d& at = theirs[static_cast<std::size_t>(node)];
            const Eigen::Vector3d p = at.translation();
            REQUIRE_MESSAGE(length(ours[j].translation - Vec3{p.x(), p.y(), p.z()}) < tolerance,
                            file.skeleton.joints[j].name << " at " << t);
            const Eigen::Vector3d x = at.linear() * Eigen::Vector3d(0, 1, 0);
            REQUIRE(length(rotate(ours[j].rotation, {0, 1, 0}) - Vec3{x.x(), x.y(), x.z()}) <
                    10 * tolerance);
        }
    }
}

void same_motion(const ClipFile& a, const ClipFile& b, double tolerance) {
    REQUIRE(a.clips.size() == b.clips.size());
    for (std::size_t c = 0; c < a.clips.size(); ++c) {
        CHECK(b.clips[c].duration_s == doctest::Approx(a.clips[c].duration_s).epsilon(1e-3));
        for (int i = 0; i <= 30; ++i) {
            const double t = a.clips[c].duration_s * i / 30;
            const std::vector<Transform> pa = model_at(a, c, t), pb = model_at(b, c, t);
            for (std::size_t j = 0; j < pa.size(); ++j) {
                const figure::JointIndex other = b.skeleton.find(a.skeleton.joints[j].name);
                REQUIRE_MESSAGE(other.valid(), a.skeleton.joints[j].name);
                REQUIRE(length(pa[j].translation - pb[other.value].translation) < tolerance);
            }
        }
    }
}

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("puppetri_clips_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
};

const char* const kWalk =
    "keys 1\n"
    "frames 25\n"
    "joint hips - 0 1 0\n"
    "joint \"left arm\" hips 0.2 0.5 0 turned 0 0 0.6 0.8 end 0.1 0 0 # a comment\n"
    "clip walk lasts 1 loops root hips\n"
    "mark 5f .. 0.4 contact leftFoot\n"
    "mark 0 start\n"
    "translation hips kochanek-bartels\n"
    "  0 0 1 0\n"
    "  10f 0 1.1 0.5 tension 0.3 continuity -0.2 bias 0.1\n"
    "  1 0 1 1 linear\n"
    "rotation \"left arm\" degrees\n"
    "  0 0 0 0\n"
    "  0.5 10 20 30 bezier easing 0.3 0 0.7 1\n"
    "  1 0 0 0 hermite in 0 0 90\n"
    "number left_elbow.flex degrees step\n"
    "  0 90\n"
    "clip still\n"
    "rotation hips\n"
    "  0 0 0.6 0 0.8\n";

}  // namespace

TEST_CASE("a keyframe file says what it says [unit]") {
    const Checked<ClipFile> file = read_keys(kWalk, "walk.keys");
    REQUIRE_MESSAGE(file.has_value(), (file ? "" : file.error()[0].message));
    CHECK(file->skeleton.joints.size() == 2);
    CHECK(file->skeleton.joints[1].name == "left arm");
    CHECK(file->skeleton.joints[1].parent == figure::JointIndex{0});
    CHECK(file->skeleton.joints[1].end_site_joint == Vec3{0.1, 0, 0});
    REQUIRE(file->clips.size() == 2);
    const motion::Clip& walk = file->clips[0];
    CHECK(walk.loops);
    CHECK(walk.root == "hips");
    CHECK(walk.marks[0].name == "start");
    CHECK(walk.marks[1].t_s == doctest::Approx(0.2));
    CHECK(walk.marks[1].end_s == doctest::Approx(0.4));
    const motion::VectorKey& key = walk.find_translation("hips")->keys[1];
    CHECK(key.t_s == doctest::Approx(0.4));
    CHECK(key.interpolation == motion::Interpolation::kKochanekBartels);
    CHECK(key.shape.continuity == -0.2);
    const motion::RotationTrack* arm = walk.find_rotation("left arm");
    const Quat expected = about_z(radians(30)) * about_y(radians(20)) * about_x(radians(10));
    CHECK(angle_between(arm->keys[1].value, expected) < 1e-12);
    CHECK(arm->keys[1].easing == Easing{0.3, 0, 0.7, 1});
    CHECK(arm->keys[2].in.z == doctest::Approx(kPi / 2));
    CHECK(walk.find_number("left_elbow.flex")->keys[0].value == doctest::Approx(kPi / 2));
    CHECK(file->clips[1].duration_s == 0);
}

TEST_CASE("what is written as keyframes is read back with the same bits [law]") {
    const Checked<ClipFile> first = read_keys(kWalk, "walk.keys");
    REQUIRE(first.has_value());
    const std::string text = make_keys(*first);
    const Checked<ClipFile> second = read_keys(text, "walk.keys");
    REQUIRE_MESSAGE(second.has_value(), (second ? "" : second.error()[0].message) << "\n" << text);
    CHECK(make_keys(*second) == text);
    const motion::Clip &a = first->clips[0], &b = second->clips[0];
    for (double t = 0; t <= 1; t += 0.03) {
        CHECK(motion::sample(a.rotations[0], t, true, 1) ==
              motion::sample(b.rotations[0], t, true, 1));
        CHECK(motion::sample(a.translations[0], t, true, 1) ==
              motion::sample(b.translations[0], t, true, 1));
    }
    CHECK(second->skeleton.joints[1].parent_from_joint_rest ==
          first->skeleton.joints[1].parent_from_joint_rest);
    if (!missing()) {
        ClipFile capture = loaded(kMotion / "cmu_01_01.bvh");
        capture.clips[0].rotations.resize(3);
        const Checked<ClipFile> again = read_keys(make_keys(capture), "x.keys");
        REQUIRE(again.has_value());
        CHECK(again->frame_s == capture.frame_s);
        for (std::size_t k = 0; k < capture.clips[0].rotations[2].keys.size(); ++k) {
            REQUIRE(again->clips[0].rotations[2].keys[k].value ==
                    capture.clips[0].rotations[2].keys[k].value);
        }
    }
}

TEST_CASE("defects of a keyframe file have their line and column, all at once [unit]") {
    const auto defects = [](const std::string& text) {
        const Checked<ClipFile> file = read_keys(text, "x.keys");
        std::string found;
        for (const Diagnostic& d : file ? Diagnostics{} : file.error()) {
            CHECK(!d.remedy.empty());
            found += d.code + " " + std::to_string(d.where.line) + ":" +
                     std::to_string(d.where.column) + "; ";
        }
        return found;
    };
    CHECK(defects("") == "bad-keys 1:1; ");
    CHECK(defects("once upon a time") == "bad-keys 1:1; ");
    CHECK(defects("keys 2\n") == "bad-keys 1:6; ");
    CHECK(defects("keys 1\n0 1 2 3\n") == "bad-keys 2:1; ");
    CHECK(defects("keys 1\nclip a\nrotation b\n 0 0 0 0 2\n 1 0 0 nan 1\n") ==
          "bad-keys 4:10; bad-keys 5:8; ");
    CHECK(defects("keys 1\nclip a\nclip a\nrotatoin b\n") == "bad-keys 3:6; bad-keys 4:1; ");
    CHECK(defects("keys 1\nclip a lasts 1\nnumber b\n 0.5 1\n 0.5 2\n") == "bad-clip-time 2:1; ");
    CHECK(defects("keys 1\nclip a lasts 1\nnumber b\n 2 1\n") == "bad-clip-time 2:1; ");
    CHECK(defects("keys 1\nclip a lasts 3f\n") == "bad-keys 2:14; ");
    CHECK(defects("keys 1\njoint a b 0 0 0\n") == "bad-keys 2:9; ");
    CHECK(defects("keys 1\nclip \"a\n") == "bad-keys 2:6; ");
    CHECK(defects("keys 1\nclip a lasts 1\nnumber b\n 0 1 easing 2 0 1 1\n") ==
          "bad-clip-value 2:1; ");
    CHECK(defects("keys 1\nclip a\nrotation b\n 0 0 0 0 1 banana\n") == "bad-keys 4:12; ");
    CHECK(defects("keys 1\nclip a\nnumber b\n") == "bad-clip-track 2:1; ");
    CHECK(defects("keys 1\nclip \xff\n") == "bad-keys 2:1; ");
}

TEST_CASE("glTF animations are where an independent reader has them [oracle]") {
    if (missing()) {
        return;
    }
    for (const char* name : {"CesiumMan.glb", "Fox.glb", "SimpleSkin.gltf"}) {
        CAPTURE(name);
        const ClipFile file = loaded(kMotion / name);
        const test::GltfFile other =
            test::read_gltf(bytes_of(kMotion / name), kMotion.string(), true);
        REQUIRE(file.clips.size() == other.clips.size());
        for (std::size_t c = 0; c < file.clips.size(); ++c) {
            const bool fox = std::string(name) == "Fox.glb";  // in centimetres
            same_as_nodes(file, c, other, c, fox ? 1e-3 : 1e-5);
        }
    }
    const ClipFile fox = loaded(kMotion / "Fox.glb");
    CHECK(fox.clips[0].name == "Survey");
    CHECK(fox.clips[2].name == "Run");
    CHECK(fox.notes.size() >= 1);  // 80 m tall
    const ClipFile robot = loaded(kMotion / "robot.glb");
    CHECK(robot.clips.size() == 14);
    CHECK(robot.skeleton.height_m > 1);
}

TEST_CASE("a VRM animation is the humanoid's, rest rotations taken off [oracle]") {
    if (missing()) {
        return;
    }
    const ClipFile file = loaded(kMotion / "test.vrma");
    CHECK(file.format == ClipFormat::kVrma);
    CHECK(file.skeleton.find("leftUpperArm").valid());
    for (const figure::Joint& joint : file.skeleton.joints) {
        CHECK(joint.parent_from_joint_rest.rotation == Quat{});
    }
    // Bones point the same way as the file's nodes do, at every instant.
    const test::GltfFile other = test::read_gltf(bytes_of(kMotion / "test.vrma"), "", true);
    for (int i = 0; i <= 10; ++i) {
        const double t = file.clips[0].duration_s * i / 10;
        const std::vector<Transform> ours = model_at(file, 0, t);
        const std::vector<Eigen::Isometry3d> theirs = other.pose(0, t);
        std::size_t met = 0;
        for (std::size_t j = 0; j < ours.size(); ++j) {
            const int node = other.find(file.skeleton.joints[j].name);
            if (node >= 0) {
                const Eigen::Vector3d p = theirs[static_cast<std::size_t>(node)].translation();
                REQUIRE(length(ours[j].translation - Vec3{p.x(), p.y(), p.z()}) < 1e-5);
                ++met;
            }
        }
        CHECK(met > 10);
    }
}

TEST_CASE("from every format to every other the joints stay where they are [law]") {
    if (missing()) {
        return;
    }
    const Folder folder;
    ClipFile capture = loaded(kMotion / "cmu_01_01.bvh", {.scale = 0.056444});
    // Half a second of it.
    for (motion::RotationTrack& track : capture.clips[0].rotations) {
        track.keys.resize(std::min<std::size_t>(track.keys.size(), 61));
    }
    for (motion::VectorTrack& track : capture.clips[0].translations) {
        track.keys.resize(std::min<std::size_t>(track.keys.size(), 61));
    }
    capture.clips[0].duration_s = 60 * capture.frame_s;
    capture.clips[0].name = "walk";
    const std::pair<ClipFile, double> sources[] = {{capture, 1e-5},
                                                   {loaded(kMotion / "CesiumMan.glb"), 1e-5},
                                                   {loaded(kMotion / "test.vrma"), 1e-5}};
    int number = 0;
    for (const auto& [source, tolerance] : sources) {
        for (const char* ending : {".keys", ".bvh", ".glb", ".gltf"}) {
            const std::string path =
                (folder.path / ("f" + std::to_string(number++) + ending)).string();
            CAPTURE(path);
            Diagnostics notes;
            const Checked<std::vector<std::string>> written = write_clips(path, source, {}, notes);
            REQUIRE_MESSAGE(written.has_value(), (written ? "" : written.error()[0].message));
            CHECK(notes.empty());
            const ClipFile back = loaded(path);
            // BVH has frames only: between them rotations of chains are not the splines'.
            same_motion(source, back, std::string(ending) == ".bvh" ? 1e-3 : tolerance);
            if (std::string(ending) == ".bvh") {
                const test::Bvh bvh = test::read_bvh(bytes_of(path));
                CHECK(bvh.find(source.skeleton.joints[0].name) >= 0);
            }
            if (std::string(ending) == ".glb") {
                const test::GltfFile glb = test::read_gltf(bytes_of(path));
                same_as_nodes(source, 0, glb, 0, 1e-4);
            }
        }
    }
}

TEST_CASE("keyframes of a humanoid without joints play on the mannequin [unit]") {
    const Folder folder;
    const Checked<ClipFile> nod = read_keys(
        "keys 1\nclip nod lasts 1\nnumber head.flex degrees\n 0 0\n 0.5 20\n 1 0\n", "nod.keys");
    REQUIRE(nod.has_value());
    Diagnostics notes;
    const std::string path = (folder.path / "nod.bvh").string();
    const auto written = write_clips(path, *nod, {.rate_hz = 30}, notes);
    REQUIRE(written.has_value());
    CHECK(notes.empty());
    const test::Bvh bvh = test::read_bvh(bytes_of(path));
    CHECK(bvh.frames.size() == 31);
    const auto head = static_cast<std::size_t>(bvh.find("head"));
    // At half time the head's up leans 20 degrees forward.
    const Eigen::Vector3d up = bvh.pose(15)[head].linear() * Eigen::Vector3d(0, 1, 0);
    CHECK(up.z() == doctest::Approx(std::sin(20 * 3.14159265358979 / 180)).epsilon(1e-3));
    // Names that nobody has.
    const Checked<ClipFile> odd =
        read_keys("keys 1\nclip x lasts 1\nnumber tail.wag\n 0 0\n", "x.keys");
    REQUIRE(odd.has_value());
    const auto refused = write_clips((folder.path / "x.glb").string(), *odd, {}, notes);
    REQUIRE(!refused.has_value());
    CHECK(refused.error()[0].code == "no-skeleton");
    CHECK(!std::filesystem::exists(folder.path / "x.glb"));
}

TEST_CASE("what is no motion is told [unit]") {
    const auto code = [](const Checked<ClipFile>& file) {
        return file ? std::string("fine") : file.error()[0].code;
    };
    CHECK(code(load_clips("nowhere.bvh")) == "cannot-read");
    CHECK(code(parse_clips("", "x.txt")) == "unknown-format");
    CHECK(code(parse_clips("{}", "x.glb")) != "fine");
    CHECK(code(parse_clips("keys 1\n", "x.keys", {.largest_bytes = 3})) == "too-large");
    CHECK(code(parse_clips("{\"asset\":{\"version\":\"2.0\"}}", "x.gltf")) == "no-animation");
    CHECK(code(parse_clips("{\"asset\":{\"version\":\"2.0\"}}", "x.vrma")) == "not-vrma");
}
