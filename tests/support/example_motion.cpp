// SPDX-License-Identifier: MIT
#include "support/example_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "puppetri/figure/character.h"
#include "puppetri/io/disk_files.h"

namespace puppetri::test {
namespace {

constexpr double kRate_hz = 480;
const std::string kMotion = PUP_SOURCE_DIR "/../shared/motion/";
const std::string kExamples = PUP_SOURCE_DIR "/examples/";

SimTime at(double t_s) {
    return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
}

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// `file "NAME"` of characters.
std::vector<std::string> files_of(const std::string& text) {
    std::vector<std::string> names;
    const std::string before = " file \"";
    for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at)) {
        at += before.size();
        names.push_back(text.substr(at, text.find('"', at) - at));
    }
    return names;
}

[[noreturn]] void give_up(const std::string& name, const Diagnostics& why) {
    for (const Diagnostic& d : why) {
        std::fprintf(stderr, "%s: %s: %s\n", name.c_str(), d.element.c_str(), d.message.c_str());
    }
    std::abort();
}

}  // namespace

figure::Figure Example::figure(std::uint32_t actor) const {
    if (const auto& character = scene->play.cast.actors[actor].character) {
        return character->moved_figure();
    }
    return figure::make_mannequin(scene->play.cast.actors[actor].height_m);
}

const Example& example(const std::string& name) {
    static std::vector<std::unique_ptr<Example>> known;
    for (const auto& one : known) {
        if (one->name == name) {
            return *one;
        }
    }
    io::DiskFiles files;
    for (const std::string& file : files_of(text_of(kExamples + name))) {
        files.replace(file, kMotion + file);
    }
    auto loaded = scene::load(files, kExamples + name);
    if (!loaded) {
        give_up(name, loaded.error());
    }
    auto made = std::make_unique<Example>();
    made->name = name;
    made->scene = std::make_unique<scene::Scene>(std::move(*loaded));
    auto performed = scene::perform(*made->scene);
    if (!performed) {
        give_up(name, performed.error());
    }
    made->performed = std::move(*performed);
    known.push_back(std::move(made));
    return *known.back();
}

const std::vector<std::string>& example_scenes() {
    static const std::vector<std::string> found = [] {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(kExamples)) {
            const std::string text =
                entry.path().extension() == ".pup" ? text_of(entry.path()) : std::string();
            const auto says = [&](const char* what) {
                return text.find(what) != std::string::npos;
            };
            if (!says("\nscene ") ||
                !(says("mannequin") || says("character {") || says("creature") || says("linkage") ||
                  says("import cast"))) {
                continue;
            }
            const std::string name =
                std::filesystem::relative(entry.path(), kExamples).generic_string();
            const std::vector<std::string> files = files_of(text);
            const bool all = std::all_of(files.begin(), files.end(), [](const std::string& file) {
                return std::filesystem::exists(kMotion + file);
            });
            if (all) {
                names.push_back(name);
            } else {
                std::printf("skipped: %s, whose character is not in ../shared/motion\n",
                            name.c_str());
            }
        }
        std::sort(names.begin(), names.end());
        return names;
    }();
    return found;
}

bool Example::is_humanoid(std::uint32_t actor) const {
    return character(actor) == nullptr || character(actor)->humanoid.has_value();
}

bool has_character_files() {
    const bool there = io::DiskFiles().read(kMotion + "CesiumMan.glb").has_value();
    if (!there) {
        std::printf("skipped: ../shared/motion/CesiumMan.glb is missing\n");
    }
    return there;
}

void bones_of_character(const figure::Character& character,
                        std::span<const Transform> world_from_joint,
                        std::span<Transform> world_from_bone) {
    const figure::Skeleton& bones = character.humanoid->figure.skeleton;
    for (std::uint32_t b = 0; b < bones.joints.size(); ++b) {
        const figure::Joint& bone = bones.joints[b];
        world_from_bone[b] = bone.parent.valid()
                                 ? world_from_bone[bone.parent.value] * bone.parent_from_joint_rest
                                 : Transform{};
        for (const figure::RigBone& rig : character.humanoid->rig.bones) {
            if (rig.bone.value == b) {
                world_from_bone[b] =
                    world_from_joint[rig.joint.value] * inverse(rig.bone_from_joint);
            }
        }
    }
}

std::vector<Planted> planted_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<Planted> planted;
    const int count = static_cast<int>(std::floor(end_s * kRate_hz + 1e-6));
    for (int side = 0; side < 2; ++side) {
        const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
        bool was = false;
        for (int i = 0; i <= count; ++i) {
            const bool on =
                e.performance().phase({actor}, leg, at(i / kRate_hz)) == motion::Phase::kSupport;
            if (on && !was) {
                planted.push_back({side, i / kRate_hz, i / kRate_hz});
            }
            if (on) {
                planted.back().end_s = i / kRate_hz;
            }
            was = on;
        }
    }
    return planted;
}

std::vector<double> joins_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<double> joins;
    for (const stage::ScoreEntry& entry : e.performance().score()) {
        const double t = entry.start.seconds();
        if (entry.actor == e.actor(actor) && t > 0 && t < end_s) {
            joins.push_back(t);
        }
    }
    std::sort(joins.begin(), joins.end());
    joins.erase(std::unique(joins.begin(), joins.end()), joins.end());
    return joins;
}

Measures measured_on_stage(const Example& e, std::uint32_t actor, double begin_s, double end_s) {
    const figure::Figure figure = e.figure(actor);
    figure::Pose pose;
    return measure(
        {.figure = figure,
         .sample =
             [&](double t, std::span<Transform> world) {
                 e.performance().pose({actor}, at(t), pose);
                 const figure::Skeleton& skeleton = *e.performance().actors()[actor].skeleton;
                 if (e.performance().actors()[actor].character == nullptr) {
                     figure::to_model_space(skeleton, pose, world);
                     return;
                 }
                 std::vector<Transform> joints(skeleton.joints.size());
                 figure::to_model_space(skeleton, pose, joints);
                 bones_of_character(*e.scene->play.cast.actors[actor].character, joints, world);
             },
         .begin_s = begin_s,
         .end_s = end_s,
         .rate_hz = kRate_hz,
         .planted = planted_of(e, actor, end_s),
         .joins_s = joins_of(e, actor, end_s)});
}

std::vector<Stretch> stretches_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<Stretch> list;
    for (const stage::ScoreEntry& entry : e.performance().score()) {
        const double t = entry.start.seconds();
        if (entry.actor == e.actor(actor) && entry.limbs.has(motion::Limb::kPelvis) && t < end_s) {
            if (!list.empty()) {
                list.back().end_s = t;
            }
            list.push_back({entry.movement, entry.place, t, end_s});
        }
    }
    return list;
}

}  // namespace puppetri::test
