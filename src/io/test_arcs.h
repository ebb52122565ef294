// SPDX-License-Identifier: MIT
// Parallel tests. In files two inhibitor (or read) arcs from one place are two conditions, of which
// the strictest counts; in drafts parallel arcs of one kind add up.
#pragma once
#include "defects.h"
#include "puppetri/io/net_file.h"

namespace puppetri::io {

// Joins parallel read arcs and parallel inhibitor arcs, and says so in a note each.
void join_parallel_tests(NetFile& file, Defects& defects);

}  // namespace puppetri::io
