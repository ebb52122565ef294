// SPDX-License-Identifier: MIT
// Queues whose long-run behaviour has a closed form, as bare nets.
#pragma once
#include "net/maker.h"

namespace puppetri::sim {

struct QueueNet {
    net::Net net;
    std::uint32_t queue, busy;           // places
    std::uint32_t arrive, serve, leave;  // transitions
};

// Poisson arrivals, `servers` servers, first come first served; with room for `room` customers in
// all (0: endless), the others are lost.
inline QueueNet make_queue(double arrival_mean_s, std::uint32_t servers, net::DurationDraft service,
                           std::uint32_t room = 0) {
    net::Maker make;
    make.place("queue");
    make.place("busy", 0, std::move(service));
    make.place("idle", servers);
    if (room != 0) {
        make.place("free", room);
        make.t("arrive", {"free"}, {"queue", "gate"}).priority = 2;
        make.t("lose", {"unless free", "come"}, {"gate"});
        make.draft.transitions[0].inputs.push_back(make.arc("come"));
        make.t("clock", {"gate"}, {"come"}).delay =
            net::DelayDraft{.duration = net::exponential(arrival_mean_s)};
        make.place("gate", 1);
    } else {
        make.t("arrive", {}, {"queue"}).delay =
            net::DelayDraft{.duration = net::exponential(arrival_mean_s)};
    }
    make.t("serve", {"queue", "idle"}, {"busy"});
    if (room != 0) {
        make.t("leave", {"busy"}, {"idle", "free"});
    } else {
        make.t("leave", {"busy"}, {"idle"});
    }
    auto compiled = net::compile(make.draft);
    REQUIRE(compiled.has_value());
    QueueNet q{std::move(compiled).value(), 0, 0, 0, 0, 0};
    q.queue = q.net.find_place("queue").value;
    q.busy = q.net.find_place("busy").value;
    q.arrive = q.net.find_transition("arrive").value;
    q.serve = q.net.find_transition("serve").value;
    q.leave = q.net.find_transition("leave").value;
    return q;
}

}  // namespace puppetri::sim
