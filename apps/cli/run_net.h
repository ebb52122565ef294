// SPDX-License-Identifier: MIT
// `puppetri run NET`: the token game of a net from elsewhere, one firing per beat.
#pragma once
#include "command.h"

namespace puppetri::cli {

// A witness, firing by firing, or a random run; and the marking that it comes to.
// Needs  the argument "scene" is no scene.
int run_net(const Arguments& arguments);

}  // namespace puppetri::cli
