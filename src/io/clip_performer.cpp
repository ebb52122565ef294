// SPDX-License-Identifier: MIT
#include "puppetri/io/clip_performer.h"

#include <algorithm>

#include "clip_tidy.h"
#include "puppetri/figure/fit_humanoid.h"
#include "puppetri/io/character_reader.h"
#include "rest_pose.h"

namespace puppetri::io {

Checked<figure::Character> performer_of(const ClipFile& file, const std::string& path) {
    if (file.skeleton.joints.empty()) {
        return Unexpected(Diagnostics{{Severity::kError,
                                       "no-skeleton",
                                       {path, 0, 0, 1},
                                       "",
                                       "the file has no joints to tell a figure by",
                                       "put lines joint NAME PARENT X Y Z into it"}});
    }
    // A root on the floor above all. A file's own joint of that name keeps its tracks.
    figure::Character character;
    character.source = path;
    figure::Skeleton& raw = character.skeleton;
    std::string name = "root";
    while (file.skeleton.find(name).valid()) {
        name = "puppetri_" + name;
    }
    raw.joints.push_back({name, {}, {}, {}});
    for (figure::Joint joint : file.skeleton.joints) {
        joint.parent = {joint.parent.valid() ? joint.parent.value + 1 : 0};
        raw.joints.push_back(std::move(joint));
    }
    const std::vector<figure::FoundBone> bones = find_bones(raw);
    const auto place = [&](std::initializer_list<std::string_view> names,
                           const std::vector<Transform>& model) {
        for (const std::string_view wanted : names) {
            for (const figure::FoundBone& bone : bones) {
                if (bone.bone == wanted) {
                    return model[bone.joint.value].translation;
                }
            }
        }
        return Vec3{};
    };
    std::vector<Transform> model = model_from_rest(raw);
    const Quat upright = figure::upright(
        place({"hips"}, model), place({"head", "neck", "upperChest", "chest", "spine"}, model),
        place({"leftUpperLeg", "leftUpperArm"}, model),
        place({"rightUpperLeg", "rightUpperArm"}, model));
    raw.joints[0].parent_from_joint_rest.rotation = upright;
    model = model_from_rest(raw);
    // The fit wants the soles on the floor and the hips above the origin. Only the rest of the
    // topmost joints says where that is: their tracks, if they have any, say it for the clip.
    double low = 1e300;
    for (std::size_t j = 1; j < raw.joints.size(); ++j) {
        low = std::min({low, model[j].translation.y, (model[j] * raw.joints[j].end_site_joint).y});
    }
    const Vec3 hips = place({"hips"}, model);
    const Vec3 shift = rotate(conjugate(upright), Vec3{-hips.x, -low, -hips.z});
    for (std::size_t j = 1; j < raw.joints.size(); ++j) {
        if (raw.joints[j].parent.value == 0) {
            Vec3& at = raw.joints[j].parent_from_joint_rest.translation;
            at = at + shift;
        }
    }
    raw.height_m = rest_height_m(raw);
    Checked<figure::Humanoid> humanoid = figure::fit_humanoid(raw, {}, bones);
    if (!humanoid) {
        Diagnostics defects = std::move(humanoid).error();
        for (Diagnostic& d : defects) {
            d.where.file = path;
        }
        return Unexpected(std::move(defects));
    }
    character.humanoid = std::move(*humanoid);
    return character;
}

}  // namespace puppetri::io
