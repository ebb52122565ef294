// SPDX-License-Identifier: MIT
// What can be counted about speed: no allocation per firing after a warm-up, and at most 64 bytes
// per plain place and arc.
#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "../bench/models.h"
#include "puppetri/net/net.h"
#include "puppetri/run/player.h"
#include "support/count_allocations.h"
#include "support/random_net.h"

using namespace puppetri;
using puppetri::test::allocated_bytes;
using puppetri::test::allocations;

namespace {

std::uint64_t allocations_of_firings(const net::NetDraft& draft, std::uint64_t warm_up,
                                     std::uint64_t firings) {
    const Checked<net::Net> net = net::compile(draft);
    REQUIRE(net.has_value());
    run::Player player(*net);
    player.run({.firings = warm_up});
    const std::uint64_t before = allocations();
    player.run({.firings = warm_up + firings});
    CHECK(player.firings() == warm_up + firings);
    return allocations() - before;
}

// Rings of n places, each with a token on every tenth; timed or not.
net::NetDraft ring(std::uint32_t n, bool timed, std::uint32_t arcs_in) {
    net::NetDraft draft;
    for (std::uint32_t i = 0; i < n; ++i) {
        net::PlaceDraft p;
        p.path = "p" + std::to_string(i);
        if (timed) {
            p.duration = net::DurationDraft::constant({kTicksPerSecond});
        }
        if (i % 10 == 0) {
            p.tokens.push_back({.count = 1, .ready = false, .attributes = {}});
        }
        draft.places.push_back(p);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        net::TransitionDraft t;
        t.path = "t" + std::to_string(i);
        for (std::uint32_t k = 0; k < arcs_in; ++k) {
            net::ArcDraft arc;
            arc.place = {(i + k) % n};
            t.inputs.push_back(arc);
        }
        net::OutputDraft out;
        out.place = {(i + 1) % n};
        t.outputs.push_back(out);
        draft.transitions.push_back(t);
    }
    return draft;
}

// What net and player of this draft keep allocated, but for names and source positions, which a net
// without names and captions would not have: counted on top of Net::hot_bytes().
std::int64_t bytes_of_player(const net::NetDraft& draft) {
    const Checked<net::Net> net = net::compile(draft);
    REQUIRE(net.has_value());
    const std::int64_t before = allocated_bytes();
    run::Player player(*net);
    player.run({.firings = 1000});
    return allocated_bytes() - before + static_cast<std::int64_t>(net->hot_bytes());
}

}  // namespace

TEST_CASE("after a warm-up a firing allocates nothing [alloc]") {
    CHECK(allocations_of_firings(bench::philosophers(5), 2000, 20000) == 0);
    CHECK(allocations_of_firings(bench::philosophers(100), 20000, 20000) == 0);
    CHECK(allocations_of_firings(bench::hold(100), 2000, 20000) == 0);
}

TEST_CASE(
    "after a warm-up a firing allocates nothing, with records, data, events and delays either "
    "[alloc]") {
    // Bounded nets only: where tokens pile up, memory has to grow.
    std::uint64_t tried = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
        RandomStream stream{.key = 1000 + i, .count = 0};
        const net::NetDraft draft = test::random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value() || net->paced()) {
            continue;
        }
        run::Player player(*net, {.seed = i});
        const auto tokens = [&] {
            std::uint64_t sum = 0;
            for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
                sum += player.tokens(net::PlaceIndex{p});
            }
            return sum;
        };
        // Many tokens are many ways to bind several arcs: such nets are left out at once.
        const auto play_to = [&](std::uint64_t firings, std::int64_t units) {
            while (player.firings() < firings && tokens() <= 12 &&
                   player.step({.until = {units * test::kRandomNetUnit}}) == run::Stop::kNone) {
            }
            return player.firings() >= firings && tokens() <= 12;
        };
        if (!play_to(3000, 20000)) {
            continue;
        }
        const std::uint64_t before = allocations();
        const bool went_on = play_to(6000, 40000);
        const std::uint64_t made = allocations() - before;
        if (!went_on) {
            continue;
        }
        ++tried;
        CAPTURE(i);
        INFO(test::show(draft));
        CHECK(made <= 8);  // of 3000 firings: a queue that reaches its longest only now
    }
    CHECK(tried > 10);
}

TEST_CASE("net and state take at most 64 bytes per plain place and per arc [alloc]") {
    // Transitions have no allowance of their own: what they take is counted with their arcs.
    for (const bool timed : {false, true}) {
        const std::int64_t small = bytes_of_player(ring(4000, timed, 1));
        const std::int64_t large = bytes_of_player(ring(8000, timed, 1));
        const std::int64_t arcs = bytes_of_player(ring(4000, timed, 2));
        const double per_cell =
            static_cast<double>(large - small) / 4000;  // a place, a transition, two arcs
        const double per_arc = static_cast<double>(arcs - small) / 4000;
        MESSAGE(std::string(timed ? "timed: " : "untimed: ")
                << per_arc << " bytes per further arc, " << per_cell
                << " per place with its transition and two arcs");
        CHECK(per_arc <= 64);
        CHECK(per_cell <= 64 * (1 + 2));
    }
    const double philosopher = static_cast<double>(bytes_of_player(bench::philosophers(2000)) -
                                                   bytes_of_player(bench::philosophers(1000))) /
                               1000;
    MESSAGE(philosopher << " bytes per philosopher: 5 places, 12 arcs");
    CHECK(philosopher <= 64 * (5 + 12));
}
