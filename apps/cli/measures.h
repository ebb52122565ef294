// SPDX-License-Identifier: MIT
// Measures as the command line names them: "queue.stay", or the name of one that the scene
// declares.
#pragma once
#include <string>
#include <vector>

#include "puppetri/base/result.h"
#include "puppetri/net/net.h"
#include "puppetri/sim/metric.h"

namespace puppetri::cli {

// A declared measure, or an element's path and what is measured of it.
// Fails   with a sentence that says what is wrong.
Result<sim::Metric, std::string> parse_measure(const net::Net& net, const std::string& text);

// Those named, or, where none is, those that the scene declares.
Result<std::vector<sim::Metric>, std::string> measures_asked(const net::Net& net,
                                                             const std::vector<std::string>& names);

// One line for each: name, value, unit, caption.
std::string measures_table(const net::Net& net, const std::vector<sim::Metric>& metrics,
                           const std::vector<double>& values);
// A JSON object: by name an object with value (null of nothing), unit and, if there is one,
// caption.
std::string measures_json(const net::Net& net, const std::vector<sim::Metric>& metrics,
                          const std::vector<double>& values);

}  // namespace puppetri::cli
