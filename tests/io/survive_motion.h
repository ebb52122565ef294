// SPDX-License-Identifier: MIT
// What must hold for any bytes whatever that are given to the readers of motion: the tests of
// hostile files and the fuzzers ask the same.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "puppetri/io/bvh_reader.h"
#include "puppetri/io/gltf_clips.h"
#include "puppetri/io/keys_file.h"
#include "puppetri/motion/packed_clip.h"

namespace puppetri::io::testing {

// The files of tests/corpus/motion, name and bytes, in order of name.
inline std::vector<std::pair<std::string, std::string>> motion_corpus() {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& entry :
         std::filesystem::directory_iterator(PUP_SOURCE_DIR "/tests/corpus/motion")) {
        std::ifstream in(entry.path(), std::ios::binary);
        out.emplace_back(entry.path().filename().string(),
                         std::string(std::istreambuf_iterator<char>(in), {}));
    }
    std::sort(out.begin(), out.end());
    return out;
}

// By the ending of the name.
inline Checked<ClipFile> read_motion_as(std::string_view name, std::string_view bytes) {
    if (name.ends_with(".bvh")) {
        return read_bvh(bytes, "hostile");
    }
    if (name.ends_with(".keys")) {
        return read_keys(bytes, "hostile");
    }
    PUP_TRY(const GltfDocument document,
            GltfDocument::parse(std::string(bytes), "hostile", nullptr));
    return clips_of(document, "hostile");
}

// Empty when all is well, otherwise the law that the bytes broke.
inline std::string broken_motion_law(std::string_view name, std::string_view bytes) {
    const Checked<ClipFile> file = read_motion_as(name, bytes);
    if (!file) {
        const auto lines =
            static_cast<std::uint32_t>(1 + std::count(bytes.begin(), bytes.end(), '\n'));
        for (const Diagnostic& d : file.error()) {
            if (d.message.empty() || d.code.empty() || d.remedy.empty()) {
                return "a diagnostic says what is wrong and what to do";
            }
            if (d.where.line > lines || (d.where.file.empty() && d.code != "more-defects")) {
                return "a diagnostic points into the file";
            }
        }
        return has_errors(file.error()) ? "" : "who fails says why";
    }
    for (std::size_t j = 0; j < file->skeleton.joints.size(); ++j) {
        const figure::JointIndex parent = file->skeleton.joints[j].parent;
        if (parent.valid() && parent.value >= j) {
            return "parents stand before children";
        }
    }
    for (const motion::Clip& clip : file->clips) {
        if (!motion::check(clip)) {
            return "what is read is a good clip";
        }
        // Sampled anywhere, it gives finite rotations.
        const motion::ClipBinding binding = motion::bind_clip(clip, file->skeleton);
        figure::Pose pose = figure::rest_pose(file->skeleton);
        for (const double t : {-1.0, 0.0, clip.duration_s / 3, clip.duration_s, 1e9}) {
            motion::sample_clip(clip, binding, t, pose);
            for (const Transform& at : pose.parent_from_joint) {
                const Quat q = at.rotation;
                const double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
                if (!(n > 0.99 && n < 1.01)) {
                    return "rotations are rotations";
                }
            }
        }
    }
    // What is written as keyframes is read again, and says the same.
    const std::string text = make_keys(*file);
    if (text.size() < 200'000) {
        const Checked<ClipFile> again = read_keys(text, "again");
        if (!again) {
            return "keyframes that are written are read: " + again.error()[0].message;
        }
        if (make_keys(*again) != text) {
            return "keyframes say the same again";
        }
    }
    return {};
}

}  // namespace puppetri::io::testing
