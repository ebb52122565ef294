// SPDX-License-Identifier: MIT
#include "questions.h"

#include <algorithm>

#include "puppetri/net/tables.h"

namespace puppetri::verdict {

Finding check_question(Question question, const GraphView& view, std::uint64_t most_edges) {
    Finding f;
    const proof::TimedGraph& timed = *view.timed;
    f.product = make_product(timed.graph, nullptr, most_edges, timed.stops);
    const Product& p = f.product;
    f.targets.assign(p.size(), 0);
    const bool covers = timed.graph.over && p.complete;
    std::vector<std::uint32_t> at;  // states that stop for this reason
    for (const proof::Stop& stop : timed.stops) {
        if (concerns(question, stop.fault.code)) {
            at.push_back(stop.state);
            f.reason = stop.fault.message;
        }
    }
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        f.targets[n] = std::find(at.begin(), at.end(), p.state[n]) != at.end() ? 1 : 0;
    }
    if (question == Question::kTimeGoesOn) {
        std::vector<std::uint8_t> passes(p.targets.size(), 0);
        for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
            const proof::Edge& edge = timed.graph.edges.items[p.edge[e]];
            passes[e] = edge.label == proof::Edge::kPass || timed.waits.is_rare(edge) ? 1 : 0;
        }
        const Nodes all(p.size(), 1);
        if (const auto cycle = endless(p, all, passes, nullptr)) {
            for (const std::uint32_t n : *cycle) {
                f.targets[n] = 1;
            }
            f.reason = "one instant may last for ever: firings go round without time passing";
            at.push_back(0);
        }
    }
    if (!at.empty()) {
        f.kind = Finding::Kind::kSuspect;
        f.target = Finding::Target::kBroken;
        return f;
    }
    if (covers) {
        f.kind = Finding::Kind::kHolds;
        f.product = {};
    } else {
        f.reason =
            timed.graph.ended != proof::Ended::kDone
                ? std::string("not all states were looked at: ") + proof::name_of(timed.graph.ended)
                : "not all states were looked at";
    }
    return f;
}

bool inexact_durations(const net::Net& net, const std::vector<proof::TickRange>& actions) {
    const net::NetTables& tables = net.tables();
    const auto inexact = [&](const net::DurationTable& d, std::uint32_t place) {
        if (d.kind == net::DurationKind::kAuto) {
            const net::ActionIndex a =
                place == net::kNoIndex ? net::ActionIndex{} : net.action(net::PlaceIndex{place});
            return !a.valid() || a.value >= actions.size() ||
                   actions[a.value].low != actions[a.value].high;
        }
        return d.kind == net::DurationKind::kInterval || d.kind == net::DurationKind::kDistribution;
    };
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        const std::uint32_t d = tables.place[p].duration;
        if (d != net::kNoIndex && inexact(tables.durations[d], p)) {
            return true;
        }
    }
    return std::any_of(tables.delays.begin(), tables.delays.end(), [&](const net::DelayTable& d) {
        return inexact(d.duration, net::kNoIndex);
    });
}

bool draws_times(const net::Net& net) {
    const net::NetTables& tables = net.tables();
    const auto drawn = [](const net::DurationTable& d) {
        return d.kind == net::DurationKind::kDistribution;
    };
    return std::any_of(tables.durations.begin(), tables.durations.end(), drawn) ||
           std::any_of(tables.delays.begin(), tables.delays.end(),
                       [&](const net::DelayTable& d) { return drawn(d.duration); });
}

bool has_coincidences(const proof::TimedGraph& graph) {
    return std::any_of(graph.coincidental.begin(), graph.coincidental.end(),
                       [](std::uint8_t c) { return c != 0; });
}

bool (*fault_of(Question question))(const std::string&) {
    switch (question) {
        case Question::kTimeGoesOn:
            return [](const std::string& c) { return concerns(Question::kTimeGoesOn, c); };
        case Question::kModulesEndClean:
            return [](const std::string& c) { return concerns(Question::kModulesEndClean, c); };
        case Question::kDataInRange:
            return [](const std::string& c) { return concerns(Question::kDataInRange, c); };
        case Question::kNothingStops:
            return [](const std::string& c) { return concerns(Question::kNothingStops, c); };
        default:
            return nullptr;
    }
}

}  // namespace puppetri::verdict
