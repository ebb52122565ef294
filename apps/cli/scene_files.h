// SPDX-License-Identifier: MIT
// The files that a scene names, put in place from the command line: `--file NAME=PATH`.
#pragma once
#include "command.h"
#include "puppetri/io/disk_files.h"

namespace puppetri::cli {

// The row of the option, for commands that load scenes.
Option file_option();

// Tells the source where those files are. Says what is wrong and gives false otherwise.
bool use_files(const Arguments& arguments, io::DiskFiles& files);

}  // namespace puppetri::cli
