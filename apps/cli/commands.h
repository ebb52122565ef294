// SPDX-License-Identifier: MIT
// The commands, one per file of the same name. A new one is declared here and named in the table of
// commands.cpp.
#pragma once
#include <vector>

#include "command.h"

namespace puppetri::cli {

Command new_command();
Command check_command();
Command fmt_command();
Command run_command();
Command prove_command();
Command explain_command();
Command draw_command();
Command export_command();
Command render_command();
Command sweep_command();
Command solve_command();
Command explore_command();
Command convert_command();
Command clip_command();
Command query_command();
Command replay_command();
Command compare_command();

// In the order of the help.
std::vector<Command> all_commands();

}  // namespace puppetri::cli
