// SPDX-License-Identifier: MIT
// Files of motion by their kind.
#include "puppetri/io/clip_file.h"

#include <algorithm>

#include "clip_take.h"
#include "clip_tidy.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/bvh_reader.h"
#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/gltf_clips.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/io/keys_file.h"

namespace puppetri::io {
namespace {

Unexpected<Diagnostics> failure(const char* code, std::string path, std::string element,
                                std::string message, std::string remedy) {
    return Unexpected(Diagnostics{{Severity::kError,
                                   code,
                                   {std::move(path), 0, 0, 1},
                                   std::move(element),
                                   std::move(message),
                                   std::move(remedy)}});
}

// The joints on which the clips are written, and their degrees of freedom.
struct Body {
    figure::Skeleton skeleton;
    figure::DofSet dofs;
};

bool plays_on(const motion::Clip& clip, const Body& body) {
    const motion::ClipBinding binding = motion::bind_clip(clip, body.skeleton, &body.dofs);
    const auto bound = [](const auto& list) {
        return std::any_of(list.begin(), list.end(),
                           [](figure::JointIndex j) { return j.valid(); });
    };
    return bound(binding.rotations) || bound(binding.translations) || !binding.joints.empty();
}

Checked<Body> body_of(const ClipFile& file, const std::string& path) {
    Body body;
    body.skeleton = file.skeleton;
    if (!file.skeleton.joints.empty()) {
        return body;
    }
    const figure::Figure mannequin = figure::make_mannequin(1.75);
    body = {mannequin.skeleton, figure::humanoid_dofs(mannequin)};
    for (const motion::Clip& clip : file.clips) {
        if (!plays_on(clip, body)) {
            return failure("no-skeleton", path, "clip " + clip.name,
                           "the format needs joints, and nothing in the clip names one of the "
                           "mannequin",
                           "put lines joint NAME PARENT X Y Z into the keyframe file");
        }
    }
    return body;
}

template <class Tracks>
void tell_unbound(const Tracks& tracks, const auto& has, const std::string& path, const char* kind,
                  Diagnostics& notes) {
    for (const auto& track : tracks) {
        if (!has(track.target)) {
            notes.push_back({Severity::kWarning,
                             "track-dropped",
                             {path, 0, 0, 1},
                             kind + track.target,
                             "the figure has nothing of this name; the track is left out",
                             "rename the track, or give the file that joint"});
        }
    }
}

Status write_all(std::vector<std::pair<std::string, std::string>> files) {
    std::vector<AtomicFile> open;
    for (const auto& [path, text] : files) {
        PUP_TRY(AtomicFile file, AtomicFile::open(path));
        PUP_TRY(Ok written, file.write(text));
        static_cast<void>(written);
        open.push_back(std::move(file));
    }
    for (AtomicFile& file : open) {
        PUP_TRY(Ok committed, file.commit());
        static_cast<void>(committed);
    }
    return Ok{};
}

}  // namespace

const char* name_of(ClipFormat format) {
    switch (format) {
        case ClipFormat::kKeys:
            return "keys";
        case ClipFormat::kBvh:
            return "BVH";
        case ClipFormat::kGltf:
            return "glTF";
        case ClipFormat::kVrma:
            return "VRM animation";
    }
    return "";
}

std::optional<ClipFormat> clip_format_of(std::string_view path) {
    const std::size_t dot = path.rfind('.');
    std::string ending(dot == std::string_view::npos ? "" : path.substr(dot + 1));
    for (char& c : ending) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
    }
    if (ending == "keys") {
        return ClipFormat::kKeys;
    }
    if (ending == "bvh") {
        return ClipFormat::kBvh;
    }
    if (ending == "gltf" || ending == "glb" || ending == "vrm") {
        return ClipFormat::kGltf;
    }
    if (ending == "vrma") {
        return ClipFormat::kVrma;
    }
    return std::nullopt;
}

Checked<ClipFile> parse_clips(std::string bytes, const std::string& path,
                              const ClipReadOptions& options, scene::FileSource* files) {
    const std::optional<ClipFormat> format = clip_format_of(path);
    if (!format) {
        return failure("unknown-format", path, "", "the ending names no format of motion",
                       "endings are .keys, .bvh, .gltf, .glb, .vrm and .vrma");
    }
    if (bytes.size() > options.largest_bytes) {
        return Unexpected(too_large(path, options.largest_bytes));
    }
    switch (*format) {
        case ClipFormat::kKeys:
            return read_keys(bytes, path, options);
        case ClipFormat::kBvh:
            return read_bvh(bytes, path, options);
        case ClipFormat::kGltf:
        case ClipFormat::kVrma:
            break;
    }
    PUP_TRY(GltfDocument document, GltfDocument::parse(std::move(bytes), path, files));
    if (*format == ClipFormat::kVrma && !document.vrm_animation) {
        return failure("not-vrma", path, "", "the file has no VRMC_vrm_animation",
                       "name other glTF files .glb or .gltf");
    }
    return clips_of(document, path, options);
}

Checked<ClipFile> load_clips(const std::string& path, const ClipReadOptions& options) {
    DiskFiles disk;
    Result<std::string, scene::FileProblem> bytes = disk.read(path);
    if (!bytes) {
        return failure("cannot-read", path, "", bytes.error().message, "name a file that is there");
    }
    return parse_clips(std::move(*bytes), path, options, &disk);
}

Checked<std::vector<std::string>> write_clips(const std::string& path, const ClipFile& file,
                                              const ClipWriteOptions& options, Diagnostics& notes) {
    const std::optional<ClipFormat> format = clip_format_of(path);
    if (!format || *format == ClipFormat::kVrma || path.ends_with(".vrm")) {
        return failure("not-writable", path, "", "motion is not written in this format",
                       "write .keys, .bvh, .glb or .gltf");
    }
    if (*format == ClipFormat::kKeys) {
        PUP_TRY(Ok written, write_file(path, make_keys(file)));
        static_cast<void>(written);
        return std::vector<std::string>{path};
    }
    PUP_TRY(const Body body, body_of(file, path));
    std::vector<Take> takes;
    for (const motion::Clip& clip : file.clips) {
        const auto joint = [&](const std::string& name) {
            return body.skeleton.find(name).valid();
        };
        tell_unbound(clip.rotations, joint, path, "rotation of ", notes);
        tell_unbound(clip.translations, joint, path, "translation of ", notes);
        tell_unbound(
            clip.numbers, [&](const std::string& name) { return body.dofs.find(name).valid(); },
            path, "track ", notes);
        PUP_TRY(Take take, take_of(clip, body.skeleton, &body.dofs,
                                   {.rate_hz = options.rate_hz,
                                    .source_frame_s = file.frame_s,
                                    .own_keys = *format == ClipFormat::kGltf}));
        takes.push_back(std::move(take));
    }
    if (takes.empty()) {
        return failure("no-animation", path, "", "there is no clip to write",
                       "name a file that has one");
    }
    if (*format == ClipFormat::kGltf) {
        PUP_TRY(Ok written, write_gltf(path, {.takes = takes}, {.names = options.names}));
        static_cast<void>(written);
        std::vector<std::string> paths{path};
        if (path.ends_with(".gltf")) {
            paths.push_back(path.substr(0, path.size() - 5) + ".bin");
        }
        return paths;
    }
    std::vector<std::pair<std::string, std::string>> files;
    std::vector<std::string> paths;
    for (const Take& take : takes) {
        paths.push_back(takes.size() == 1 ? path : bvh_path(path, take.name));
        files.emplace_back(
            paths.back(),
            make_bvh(take, 0,
                     {.names = options.names,
                      .unit = options.metres ? LengthUnit::kMetre : LengthUnit::kCentimetre}));
    }
    PUP_TRY(Ok written, write_all(std::move(files)));
    static_cast<void>(written);
    return paths;
}

}  // namespace puppetri::io
