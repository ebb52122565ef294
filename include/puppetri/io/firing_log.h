// SPDX-License-Identifier: MIT
// Logs of who did what when, as other programs write them: CSV with or without a head line, and
// lines `time object event`.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/time.h"

namespace puppetri::io {

struct LogLine {
    SimTime at;
    std::string event;
    std::string object;  // empty where the log names none
    std::uint32_t line = 0;
    bool operator==(const LogLine&) const = default;
};

struct LogFormat {
    // Of a column `frame`, and of the lines `time object event` where their times are frames.
    double frames_per_s = 24;
    bool tuples_in_frames = true;  // whole numbers there are frames, else seconds
};

// CSV (RFC 4180; commas or semicolons) by the names of its columns: tick, frame, seconds, time,
// timestamp or t; event, transition, activity, action or name; object, actor, case, customer or id.
// Without such a head line the columns are time in seconds, event, and object if there is a third.
// A text without commas and semicolons has three words per line: time, object, event. Lines that
// begin with # are left out.
// Fails   "bad-log" with line and column: a time that is none, a missing column, no line at all.
Checked<std::vector<LogLine>> read_firing_log(std::string_view text, const std::string& path,
                                              const LogFormat& format = {});

}  // namespace puppetri::io
