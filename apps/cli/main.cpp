// SPDX-License-Identifier: MIT
// The program `puppetri`.
#include "commands.h"
#include "interrupt.h"

int main(int argc, char** argv) {
    puppetri::cli::catch_interrupts();
    return puppetri::cli::run_command_line(argc, argv, puppetri::cli::all_commands());
}
