// SPDX-License-Identifier: MIT
// Families of nets whose state spaces have closed forms.
#pragma once
#include <cstdint>
#include <string>

#include "proof/small_nets.h"

namespace puppetri::proof::test {

// N philosophers who take their two forks one after the other in any order, the contest's model.
// Each fork is free or with one of its two neighbours, and that says all: 3^N markings. A
// philosopher has 7/9 of a firing on average (see the counts of fork pairs): 7 N 3^(N - 2) edges.
// Dead: all with their left fork, or all with their right one.
inline PlainNet philosophers(std::uint32_t n) {
    PlainNet net;
    const auto think = [&](std::uint32_t i) { return i; };
    const auto fork = [&](std::uint32_t i) { return n + i % n; };
    const auto left = [&](std::uint32_t i) { return 2 * n + i; };
    const auto right = [&](std::uint32_t i) { return 3 * n + i; };
    const auto eat = [&](std::uint32_t i) { return 4 * n + i; };
    net.initial.assign(5 * n, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        net.initial[think(i)] = net.initial[fork(i)] = 1;
        add_transition(net, {{think(i), 1}, {fork(i), 1}}, {{left(i), 1}});
        add_transition(net, {{think(i), 1}, {fork(i + 1), 1}}, {{right(i), 1}});
        add_transition(net, {{left(i), 1}, {fork(i + 1), 1}}, {{eat(i), 1}});
        add_transition(net, {{right(i), 1}, {fork(i), 1}}, {{eat(i), 1}});
        add_transition(net, {{eat(i), 1}}, {{think(i), 1}, {fork(i), 1}, {fork(i + 1), 1}});
    }
    return net;
}

// One vote of N people: 3^N + 1 markings, 2 N 3^(N - 1) + 1 edges, 2^N of them dead.
inline PlainNet referendum(std::uint32_t n) {
    PlainNet net;
    net.initial.assign(1 + 3 * n, 0);
    net.initial[0] = 1;
    std::map<std::uint32_t, std::uint32_t> all;
    for (std::uint32_t i = 0; i < n; ++i) {
        all[1 + i] = 1;
    }
    add_transition(net, {{0, 1}}, all);
    for (std::uint32_t i = 0; i < n; ++i) {
        add_transition(net, {{1 + i, 1}}, {{1 + n + i, 1}});
        add_transition(net, {{1 + i, 1}}, {{1 + 2 * n + i, 1}});
    }
    return net;
}

// `places` places in a ring with `tokens` tokens that hop to the next one: binomial(tokens + places
// - 1, places - 1) markings.
inline PlainNet ring(std::uint32_t places, std::uint32_t tokens) {
    PlainNet net;
    net.initial.assign(places, 0);
    net.initial[0] = tokens;
    for (std::uint32_t p = 0; p < places; ++p) {
        add_transition(net, {{p, 1}}, {{(p + 1) % places, 1}});
    }
    return net;
}

// Players in a ring who pass balls that have identity to the next one, if that one has none. Who
// has a ball changes, the order of the balls round the ring does not: balls * binomial(players,
// balls) markings, if the balls start in order. Place ball * players + player: the player has it;
// behind these, one place per player whose hands are free.
inline PlainNet balls_in_a_ring(std::uint32_t players, std::uint32_t balls) {
    PlainNet net;
    const auto has = [&](std::uint32_t ball, std::uint32_t player) {
        return ball * players + player % players;
    };
    const auto free = [&](std::uint32_t player) { return balls * players + player % players; };
    net.initial.assign(balls * players + players, 0);
    for (std::uint32_t p = 0; p < players; ++p) {
        net.initial[free(p)] = 1;
    }
    for (std::uint32_t b = 0; b < balls; ++b) {
        const std::uint32_t p = b * (players / balls);
        net.initial[has(b, p)] = 1;
        net.initial[free(p)] = 0;
    }
    for (std::uint32_t b = 0; b < balls; ++b) {
        for (std::uint32_t p = 0; p < players; ++p) {
            add_transition(net, {{has(b, p), 1}, {free(p + 1), 1}},
                           {{has(b, p + 1), 1}, {free(p), 1}});
        }
    }
    return net;
}

}  // namespace puppetri::proof::test
