// SPDX-License-Identifier: MIT
#include "loops.h"

#include <algorithm>
#include <map>

#include "net_features.h"

namespace puppetri::io {

Loops with_loops(const net::TransitionDraft& transition) {
    struct Row {
        std::int64_t take = 0, read = 0, give = 0;
    };
    std::map<std::uint32_t, Row> rows;
    Loops out;
    for (const net::ArcDraft& a : transition.inputs) {
        switch (plain_kind(a.kind)) {
            case net::ArcKind::kTake:
                rows[a.place.value].take += a.weight;
                break;
            case net::ArcKind::kRead:
                rows[a.place.value].read += a.weight;
                break;
            case net::ArcKind::kUnless:
                out.unless.emplace_back(a.place.value, a.weight);
                break;
            default:
                break;
        }
    }
    for (const net::OutputDraft& o : transition.outputs) {
        rows[o.place.value].give += o.weight;
    }
    for (const auto& [place, row] : rows) {
        const std::int64_t take = std::max(row.take, row.read);
        const std::int64_t give = row.give + take - row.take;
        if (take > 0) {
            out.takes.emplace_back(place, take);
        }
        if (give > 0) {
            out.gives.emplace_back(place, give);
        }
    }
    return out;
}

}  // namespace puppetri::io
