// SPDX-License-Identifier: MIT
// The outside of glTF files: GLB chunks, data URIs, names of files beside.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"

namespace puppetri::io {

struct GltfContainer {
    std::string_view json;    // of the bytes that were split
    std::string_view binary;  // the BIN chunk; empty where there is none
    bool has_binary = false;
};

// Splits a GLB; other bytes are JSON as a whole.
// Fails   "not-gltf" when lengths do not fit, "gltf-version" for another version than 2.
Checked<GltfContainer> split_gltf(std::string_view bytes, const std::string& path);

// The bytes of "data:MEDIA;base64,..."; none when it is not written so. `media` gets MEDIA.
std::optional<std::string> decode_data_uri(std::string_view uri, std::string& media);

// The relative path that a URI means; none for other hosts, schemes and absolute paths.
std::optional<std::string> path_of_uri(std::string_view uri);

}  // namespace puppetri::io
