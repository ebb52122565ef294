// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include <csignal>
#include <cstdlib>

#include "puppetri/io/atomic_file.h"

namespace puppetri::cli {
namespace {

volatile std::sig_atomic_t asked = 0;

extern "C" void on_interrupt(int signal) {
    if (asked != 0) {
        io::remove_unfinished_files();
        std::_Exit(128 + signal);
    }
    asked = 1;
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
#ifdef SIGPIPE
    std::signal(SIGPIPE, SIG_IGN);
#endif
#ifdef SIGHUP
    std::signal(SIGHUP, on_interrupt);
#endif
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN);  // a limit of file size is a full disk, told by the write
#endif
}

bool interrupted() { return asked != 0; }

}  // namespace puppetri::cli
