// SPDX-License-Identifier: MIT
// Ctrl-C: the first asks the work to end cleanly with what is known, the second ends the program at
// once.
#pragma once
#include <atomic>

namespace puppetri::cli {

// Installs the handler for SIGINT and SIGTERM, and ignores SIGPIPE (a closed pipe is an error of a
// write).
void catch_interrupts();

// Whether the user asked to stop. Long loops ask this now and then and end cleanly.
bool interrupted();

// The flag is set, too, when the interruption comes (or has come); null: none any more. One flag at
// a time.
void set_when_interrupted(std::atomic<bool>* flag);

}  // namespace puppetri::cli
