// SPDX-License-Identifier: MIT
// `puppetri convert IN OUT` where IN is a file of motion.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::cli {

int convert_motion(const Arguments& arguments);

// What reading and writing motion have in common with `puppetri clip`. Problems with the options
// are said, and give nothing.
std::optional<io::ClipReadOptions> motion_read_options(const Arguments& arguments);
std::optional<io::ClipWriteOptions> motion_write_options(const Arguments& arguments);
std::vector<Option> motion_options();

// Keeps the clips of these names (all without a name). Says which is not there, and gives false.
bool keep_clips(io::ClipFile& file, const std::vector<std::string>& names);

// Carries all clips onto another humanoid, where --onto names one. Says what is wrong, and gives
// false.
bool carry_onto(io::ClipFile& file, const Arguments& arguments, double rate_hz);

// With --names: joints that are bones of a humanoid, and their tracks, get the names of that set in
// the file `out`. Says what is wrong, and gives false.
bool rename_bones(io::ClipFile& file, const Arguments& arguments, const std::string& out,
                  io::BoneNames set);

// Writes the file and tells it, as JSON where that is wanted; gives the exit code.
int write_motion(const std::string& path, const io::ClipFile& file,
                 const io::ClipWriteOptions& options, bool json);

}  // namespace puppetri::cli
