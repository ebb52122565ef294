// SPDX-License-Identifier: MIT
// Drafts of the measured models.
#include "models.h"

namespace puppetri::bench {

using namespace net;

namespace {

PlaceIndex add_place(NetDraft& net, std::string path, std::uint32_t tokens) {
    PlaceDraft place;
    place.path = std::move(path);
    if (tokens != 0) {
        place.tokens.push_back({.count = tokens, .ready = false, .attributes = {}});
    }
    net.places.push_back(std::move(place));
    return PlaceIndex{static_cast<std::uint32_t>(net.places.size()) - 1};
}

void take(TransitionDraft& t, PlaceIndex p) {
    ArcDraft arc;
    arc.place = p;
    t.inputs.push_back(std::move(arc));
}

void give(TransitionDraft& t, PlaceIndex p) {
    OutputDraft out;
    out.place = p;
    t.outputs.push_back(std::move(out));
}

DurationDraft exponential(double mean_s) {
    DurationDraft d;
    d.kind = DurationKind::kDistribution;
    d.distribution = DistributionKind::kExponential;
    d.parameters.push_back(Expr::real(mean_s));
    return d;
}

}  // namespace

NetDraft philosophers(std::uint32_t n) {
    NetDraft net;
    net.name = "philosophers";
    const auto p = [](std::uint32_t i) { return PlaceIndex{i}; };
    for (std::uint32_t i = 0; i < 5 * n; ++i) {
        add_place(net, "p" + std::to_string(i), i < 2 * n ? 1 : 0);
        if (i >= 2 * n) {
            net.places[i].duration = DurationDraft::constant({kPhilosopherPhases[(i - 2 * n) / n]});
        }
    }
    for (std::uint32_t i = 0; i < 4 * n; ++i) {
        TransitionDraft t;
        t.path = "t" + std::to_string(i);
        const std::uint32_t who = i % n;
        const PlaceIndex table[3] = {p(2 * who), p(2 * who + 1), p((2 * who + 2) % (2 * n))};
        if (i < n) {
            for (const PlaceIndex place : table) {
                take(t, place);
            }
        } else {
            take(t, p(i + n));
        }
        if (i < 3 * n) {
            give(t, p(i + 2 * n));
        } else {
            for (const PlaceIndex place : table) {
                give(t, place);
            }
        }
        net.transitions.push_back(std::move(t));
    }
    return net;
}

NetDraft hold(std::uint32_t n) {
    NetDraft net;
    net.name = "hold";
    const PlaceIndex p = add_place(net, "pending", n);
    net.places[p.value].duration = exponential(kHoldMean_s);
    TransitionDraft t;
    t.path = "event";
    take(t, p);
    give(t, p);
    net.transitions.push_back(std::move(t));
    return net;
}

NetDraft mm1() {
    NetDraft net;
    net.name = "mm1";
    const PlaceIndex queue = add_place(net, "queue", 0);
    TransitionDraft arrive;
    arrive.path = "arrive";
    arrive.delay = DelayDraft{.duration = exponential(kArrivalMean_s)};
    give(arrive, queue);
    net.transitions.push_back(std::move(arrive));
    TransitionDraft serve;
    serve.path = "serve";
    serve.delay = DelayDraft{.duration = exponential(kServiceMean_s)};
    take(serve, queue);
    net.transitions.push_back(std::move(serve));
    return net;
}

}  // namespace puppetri::bench
