// SPDX-License-Identifier: MIT
#include "measures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "puppetri/base/text.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/net/tables.h"

namespace puppetri::cli {

Result<sim::Metric, std::string> parse_measure(const net::Net& net, const std::string& text) {
    const std::vector<net::MeasureDraft>& declared = net.declarations().measures;
    for (std::uint32_t m = 0; m < declared.size(); ++m) {
        if (declared[m].path == text) {
            return sim::Metric{sim::MetricKind::kMeasure, m};
        }
    }
    const std::size_t dot = text.rfind('.');
    const std::string path = text.substr(0, dot == std::string::npos ? 0 : dot),
                      kind = dot == std::string::npos ? "" : text.substr(dot + 1);
    using enum sim::MetricKind;
    for (const sim::MetricKind k : {kTokens, kMost, kBusy, kStay, kRate, kFirings}) {
        if (kind != sim::name_of(k)) {
            continue;
        }
        const std::uint32_t element =
            sim::of_transition(k) ? net.find_transition(path).value : net.find_place(path).value;
        if (element == net::kNoIndex) {
            return Unexpected("there is no " +
                              std::string(sim::of_transition(k) ? "transition " : "place ") + path +
                              " to measure");
        }
        return sim::Metric{k, element};
    }
    return Unexpected("'" + text +
                      "' is no measure: write PLACE.tokens, .most, .busy or .stay, "
                      "TRANSITION.rate or .firings, or the name of a measure of the scene");
}

Result<std::vector<sim::Metric>, std::string> measures_asked(
    const net::Net& net, const std::vector<std::string>& names) {
    if (names.empty()) {
        return sim::declared_metrics(net);
    }
    std::vector<sim::Metric> metrics;
    for (const std::string& name : names) {
        PUP_TRY(const sim::Metric m, parse_measure(net, name));
        metrics.push_back(m);
    }
    return metrics;
}

std::string measures_table(const net::Net& net, const std::vector<sim::Metric>& metrics,
                           const std::vector<double>& values) {
    std::size_t names = 0;
    for (const sim::Metric& m : metrics) {
        names = std::max<std::size_t>(names, count_code_points(sim::name_of(net, m)));
    }
    std::string out;
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        const std::string name = sim::name_of(net, metrics[i]);
        char value[40] = "-";
        if (!std::isnan(values[i])) {
            std::snprintf(value, sizeof value, "%.6g", values[i]);
        }
        char padded[48];
        std::snprintf(padded, sizeof padded, "%12s %-3s", value, sim::unit_of(net, metrics[i]));
        std::string line = "  " + name + std::string(names - count_code_points(name), ' ') + "  " +
                           padded + "  " + sim::caption_of(net, metrics[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

std::string measures_json(const net::Net& net, const std::vector<sim::Metric>& metrics,
                          const std::vector<double>& values) {
    io::JsonWriter json;
    json.begin_object();
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        json.key(sim::name_of(net, metrics[i])).begin_object();
        json.member("value", values[i]).member("unit", sim::unit_of(net, metrics[i]));
        if (const std::string caption = sim::caption_of(net, metrics[i]); !caption.empty()) {
            json.member("caption", caption);
        }
        json.end_object();
    }
    json.end_object();
    return json.take();
}

}  // namespace puppetri::cli
