// SPDX-License-Identifier: MIT
// Measures as the command line names them: "queue.stay".
#pragma once
#include <string>

#include "puppetri/base/result.h"
#include "puppetri/net/net.h"
#include "puppetri/sim/metric.h"

namespace puppetri::cli {

// An element's path and what is measured of it.
// Fails   with a sentence that says what is wrong.
Result<sim::Metric, std::string> parse_measure(const net::Net& net, const std::string& text);

}  // namespace puppetri::cli
