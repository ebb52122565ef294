// SPDX-License-Identifier: MIT
// Events that come in on stdin while a run goes on.
#pragma once
#include <string>
#include <vector>

#include "puppetri/scene/perform.h"

namespace puppetri::cli {

// Plays the session in real time and feeds it the lines of stdin: `now NAME` occurs when it is
// read, `2.5 s NAME` at that time of the model. When stdin ends, the rest is played at full speed.
// Gives   what was wrong with lines; they are left out.
Diagnostics play_with_stdin(scene::Session& session, const net::Net& net);

}  // namespace puppetri::cli
