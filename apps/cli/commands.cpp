// SPDX-License-Identifier: MIT
// The table of commands: what is not named here does not exist.
#include "commands.h"

namespace puppetri::cli {

std::vector<Command> all_commands() {
    // clang-format off
    return {
        new_command(),
        check_command(),
        fmt_command(),
        run_command(),
        prove_command(),
        explain_command(),
        sweep_command(),
        solve_command(),
        compare_command(),
        replay_command(),
        explore_command(),
        query_command(),
        draw_command(),
        export_command(),
        render_command(),
        convert_command(),
        clip_command(),
    };
    // clang-format on
}

}  // namespace puppetri::cli
