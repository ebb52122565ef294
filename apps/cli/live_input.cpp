// SPDX-License-Identifier: MIT
#include "live_input.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>

#include "interrupt.h"
#include "puppetri/base/rational.h"
#include "puppetri/scene/events.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

// Lines of stdin as they come, without blocking longer than asked.
class Lines {
 public:
    // Waits up to `milliseconds` for input. False when stdin has ended and all lines were taken.
    bool wait(int milliseconds) {
        if (ended_) {
            return false;
        }
        pollfd in{STDIN_FILENO, POLLIN, 0};
        if (poll(&in, 1, milliseconds) <= 0) {
            return true;
        }
        char bytes[4096];
        const ssize_t got = read(STDIN_FILENO, bytes, sizeof bytes);
        if (got <= 0) {
            ended_ = true;
            if (!rest_.empty()) {
                rest_ += '\n';
            }
        } else {
            rest_.append(bytes, static_cast<std::size_t>(got));
        }
        return true;
    }

    bool next(std::string& line) {
        const std::size_t end = rest_.find('\n');
        if (end == std::string::npos) {
            return false;
        }
        line = rest_.substr(0, end);
        rest_.erase(0, end + 1);
        return true;
    }

 private:
    std::string rest_;
    bool ended_ = false;
};

}  // namespace

Diagnostics play_with_stdin(scene::Session& session, const net::Net& net) {
    using Clock = std::chrono::steady_clock;
    const std::vector<std::string> names = scene::event_names(net);
    Diagnostics problems;
    Lines lines;
    const Clock::time_point begin = Clock::now();
    bool going = true;
    while (going && lines.wait(20)) {
        if (interrupted()) {
            session.interrupt();
            return problems;
        }
        const double spent_s = std::chrono::duration<double>(Clock::now() - begin).count();
        std::string line;
        while (lines.next(line)) {
            auto event = scene::parse_live_event(line, names);
            if (!event) {
                say_diagnostics(event.error());
                problems.insert(problems.end(), event.error().begin(), event.error().end());
            } else if (*event && (*event)->at) {
                session.schedule({*(*event)->at, (*event)->event});
            } else if (*event) {
                session.push((*event)->event);
            }
        }
        if (const auto now = to_ticks(spent_s)) {
            going = session.advance_to(now->time);
        }
    }
    if (going) {
        session.run();
    }
    return problems;
}

}  // namespace puppetri::cli
