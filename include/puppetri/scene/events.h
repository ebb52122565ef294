// SPDX-License-Identifier: MIT
// Lists of outside events: what `events from "file"`, `run --events FILE` and a recorded session
// hold. One line per event: a time and the event's full path; `#` begins a comment.
//     2.5 s go          seconds, exactly; also ms and min
//     1764000000 ticks a.whistle
//     now stop          at once: only in live input
//     seed 7            in recordings: the seed of the session, at the top
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/net/host.h"
#include "puppetri/net/net.h"
#include "puppetri/run/player.h"

namespace puppetri::scene {

struct EventList {
    std::vector<run::OutsideEvent> events;  // in the order of the file
    std::optional<std::uint64_t> seed;
    Diagnostics diagnostics;
};

// One line of live input; `at` is left out where it says `now`.
struct LiveEvent {
    std::optional<SimTime> at;
    net::EventIndex event;
};

// Reads a whole list. Fails line by line: "bad-event-line", "unknown-name"; `now` has no meaning
// here. `names[i]` is how the list calls event i.
EventList parse_event_list(std::string_view text, const std::string& filename,
                           std::span<const std::string> names);

// The full paths of all events of a net; empty for those that time alone makes occur, the inner
// clocks of notations.
std::vector<std::string> event_names(const net::Net& net);

// Reads one line. Gives nullopt for an empty line or a comment.
Checked<std::optional<LiveEvent>> parse_live_event(std::string_view line,
                                                   std::span<const std::string> names);

// A session as a file: seed and events in ticks. Reading it again gives the same list.
std::string write_event_list(const std::vector<run::OutsideEvent>& events,
                             std::optional<std::uint64_t> seed, std::span<const std::string> names);

}  // namespace puppetri::scene
