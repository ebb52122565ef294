// SPDX-License-Identifier: MIT
// Any net file, whatever its format: what the commands that take nets open.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// By the ending of its name: .pnml, .xml (told apart by content: PNML or PIPE), .net (TINA), .pup;
// of others, by content. Nothing if neither tells.
std::optional<NetFormat> net_format_of(std::string_view path, std::string_view text);

// Reads a net file from memory. Not for scenes (they import others): code "not-a-net-file".
Checked<NetFile> read_net(std::string_view text, const std::string& path,
                          const NetLimits& limits = {});

// Reads a net file from the disk; of a scene (.pup), its net.
// Fails  "cannot-read" beside the reader's own defects.
Checked<NetFile> load_net(const std::string& path, const NetLimits& limits = {});

}  // namespace puppetri::io
