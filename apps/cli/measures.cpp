// SPDX-License-Identifier: MIT
#include "measures.h"

#include "puppetri/net/tables.h"

namespace puppetri::cli {

Result<sim::Metric, std::string> parse_measure(const net::Net& net, const std::string& text) {
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
                      "' is no measure: write PLACE.tokens, .most, .busy or .stay, or "
                      "TRANSITION.rate or .firings");
}

}  // namespace puppetri::cli
