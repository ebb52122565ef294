// SPDX-License-Identifier: MIT
// Logs of other programs and the names of a net: what `replay` and `compare` share.
#pragma once
#include <string>
#include <vector>

#include "command.h"
#include "puppetri/io/firing_log.h"
#include "puppetri/run/replay.h"

namespace puppetri::cli {

// --map, --name, --rate.
std::vector<Option> with_log_options(std::vector<Option> options);

// The file's lines. Says what is wrong and gives the exit code otherwise.
Result<std::vector<io::LogLine>, int> load_log(const std::string& path, const Arguments& arguments,
                                               double frames_per_s);

// A log in the names of a net.
struct NetLog {
    std::vector<run::Observed> firings;
    std::vector<std::uint32_t> lines;  // of the file, by firing
};
// By --map, then --name, then the event's own name, OBJECT.EVENT, EVENT.OBJECT and EVENT[OBJECT].
// Says which names are none and gives the exit code otherwise.
Result<NetLog, int> in_names_of(const net::Net& net, const std::vector<io::LogLine>& lines,
                                const std::string& path, const Arguments& arguments);

}  // namespace puppetri::cli
