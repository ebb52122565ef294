// SPDX-License-Identifier: MIT
#include "puppetri/net/measure.h"

namespace puppetri::net {

const char* unit_of(const MeasureDraft& m) {
    if (m.seen == Seen::kCourse) {
        return m.unit.c_str();
    }
    switch (m.statistic) {
        case Statistic::kShare:
        case Statistic::kCount:
            return "";
        case Statistic::kRate:
            return "1/s";
        default:
            break;
    }
    const bool integral = m.seen == Seen::kState && m.statistic == Statistic::kTotal;
    const Expr* value = m.seen == Seen::kState                        ? &m.value
                        : m.seen == Seen::kFirings && !m.from.empty() ? &m.from[0].value
                                                                      : nullptr;
    const bool time = value == nullptr || value->type().kind == ValueKind::kTime;
    return time ? (integral ? "s2" : "s") : integral ? "s" : "";
}

const char* name_of(Statistic statistic) {
    switch (statistic) {
        case Statistic::kMean:
            return "mean";
        case Statistic::kMost:
            return "most";
        case Statistic::kLeast:
            return "least";
        case Statistic::kTotal:
            return "total";
        case Statistic::kFinal:
            return "final";
        case Statistic::kShare:
            return "share";
        case Statistic::kPercentile:
            return "percentile";
        case Statistic::kCount:
            return "count";
        case Statistic::kRate:
            return "rate";
    }
    return "";
}

}  // namespace puppetri::net
