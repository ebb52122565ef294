// SPDX-License-Identifier: MIT
// Keyframe files: clips as text that people write (docs/formats/keys.md). The absolute keyframes of
// a whole scene are a file of this kind with one clip per object, in the world's space.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::io {

// Gives   the clips, checked; the skeleton if the file has joints.
// Fails   "bad-keys" and the codes of motion::check, with line, column and track; "too-large".
Checked<ClipFile> read_keys(std::string_view text, const std::string& path,
                            const ClipReadOptions& options = {});

// The text of a file that read_keys reads back with the same bits.
std::string make_keys(const ClipFile& file);

}  // namespace puppetri::io
