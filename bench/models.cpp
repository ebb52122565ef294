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

NetDraft mm1_customers() {
    NetDraft net = mm1();
    net.name = "mm1_customers";
    const ValueType number{ValueKind::kInt};
    DatumDraft next;
    next.path = "next";
    next.type = number;
    net.data.push_back(std::move(next));
    const Expr read = Expr::slot(slot(SlotKind::kDatum, 0), number);
    net.places[0].attributes.push_back({"number", number});
    net.transitions[0].outputs[0].attributes.push_back(read);
    net.transitions[0].assignments.push_back(
        {DatumIndex{0}, Expr::binary(ExprOp::kAdd, read, Expr::integer(1)).value(), {}});
    net.transitions[1].variables.push_back({"n", number});
    PatternDraft pattern;
    pattern.binds = 0;
    net.transitions[1].inputs[0].pattern.push_back(std::move(pattern));
    MeasureDraft length;
    length.path = "length";
    length.value = Expr::slot(slot(SlotKind::kCount, 0), number);
    net.measures.push_back(std::move(length));
    for (const Statistic s : {Statistic::kMean, Statistic::kMost}) {
        MeasureDraft stay;
        stay.path = name_of(s);
        stay.statistic = s;
        stay.seen = Seen::kStays;
        stay.place = PlaceIndex{0};
        net.measures.push_back(std::move(stay));
    }
    return net;
}

NetDraft barber_day() {
    NetDraft net;
    net.name = "barber_day";
    const PlaceIndex door = add_place(net, "door", 0), waiting = add_place(net, "waiting", 0),
                     seats = add_place(net, "seats", 4), barber = add_place(net, "barber", 1),
                     chair = add_place(net, "chair", 0);
    DurationDraft cut;
    cut.kind = DurationKind::kInterval;
    cut.a = Expr::time({300 * kTicksPerSecond});
    cut.b = Expr::time({900 * kTicksPerSecond});
    net.places[chair.value].duration = std::move(cut);
    const auto add = [&](const char* path, std::initializer_list<PlaceIndex> from,
                         std::initializer_list<PlaceIndex> to) -> TransitionDraft& {
        TransitionDraft& t = net.transitions.emplace_back();
        t.path = path;
        for (const PlaceIndex p : from) {
            take(t, p);
        }
        for (const PlaceIndex p : to) {
            give(t, p);
        }
        return t;
    };
    add("come", {}, {door}).delay = DelayDraft{.duration = exponential(600)};
    add("sit_down", {door, seats}, {waiting}).priority = 3;
    add("go_away", {door}, {}).priority = 2;
    add("begin", {waiting, barber}, {chair, seats});
    add("pay", {chair}, {barber});
    return net;
}

}  // namespace puppetri::bench
