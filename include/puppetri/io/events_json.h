// SPDX-License-Identifier: MIT
// The markers of a take as a file of their own, NAME.events.json, for programs that do not read
// glTF's extras. Its members are described in docs/formats/events.md.
#pragma once
#include <span>
#include <string>

#include "puppetri/io/take.h"

namespace puppetri::io {

inline constexpr int kEventsVersion = 1;

// With several takes (clips) every event and holder also says in which clip it is.
std::string make_events_json(std::span<const Take> takes, std::string_view title);

}  // namespace puppetri::io
