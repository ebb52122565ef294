// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include <csignal>
#include <cstdlib>

#include "puppetri/io/atomic_file.h"

namespace puppetri::cli {
namespace {

volatile std::sig_atomic_t asked = 0;
// A handler of signals may touch atomics that need no lock.
std::atomic<std::atomic<bool>*> flag_to_set{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<std::atomic<bool>*>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
    if (asked != 0) {
        io::remove_unfinished_files();
        std::_Exit(128 + signal);
    }
    asked = 1;
    if (std::atomic<bool>* flag = flag_to_set.load()) {
        flag->store(true);
    }
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

void set_when_interrupted(std::atomic<bool>* flag) {
    flag_to_set.store(flag);
    if (flag != nullptr && asked != 0) {
        flag->store(true);
    }
}

}  // namespace puppetri::cli
