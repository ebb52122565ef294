// SPDX-License-Identifier: MIT
// The files of the Platform Independent Petri net Editor, versions 2 to 5: generalized stochastic
// nets in a dialect of XML that looks like PNML and is none. What is read, written and refused:
// docs/formats/pipe.md.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// Timed transitions get exponential delays with mean 1/rate seconds and priority 0, immediate ones
// their priority (at least 1) and their rate as odds: what is immediate goes before what is timed.
// A net without timed transitions is paced. Tokens of several classes (colours) are unfolded: each
// arc names how many of each class, so a place becomes one per class, "queue(Writers)".
// Fails  with all defects of the file.
Checked<NetFile> read_pipe(std::string_view text, const std::string& path,
                           const NetLimits& limits = {});

}  // namespace puppetri::io
