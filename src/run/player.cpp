// SPDX-License-Identifier: MIT
// The player is the engine with limits, outside events, a recording and snapshots around it.
#include "puppetri/run/player.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/hash.h"
#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"
#include "puppetri/net/log_hash.h"

namespace puppetri::run {

struct Player::Data final : net::EngineListener {
    Data(const net::Net& n, const Options& o)
        : net(n),
          options(o),
          engine(n, o.chooser != nullptr ? *o.chooser : random, engine_options()) {
        engine.start();
    }

    net::EngineOptions engine_options() {
        net::EngineOptions e;
        e.seed = options.seed;
        e.host = options.host;
        e.listener = options.sink != nullptr ? this : nullptr;
        e.beat = options.beat.ticks;
        e.firings_per_instant = options.firings_per_instant;
        e.antithetic = options.antithetic;
        return e;
    }
    void fired(SimTime at, net::TransitionIndex t) override { options.sink->fired(at, t); }
    void occurs(SimTime at, net::EventIndex e) override { options.sink->occurs(at, e); }
    void lost(SimTime at, net::EventIndex e) override { options.sink->lost(at, e); }

    void occur(const OutsideEvent& e) {
        engine.occur(e.event, e.at);
        if (options.record) {
            recording.push_back(e);
        }
    }

    const net::Net& net;
    Options options;
    net::RandomChooser random;
    net::Engine engine;
    std::vector<OutsideEvent> recording;
};

Player::Player(const net::Net& net, const Options& options)
    : data_(std::make_unique<Data>(net, options)) {}
Player::~Player() = default;
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;

// An instant that has begun takes no more from outside: what comes late comes in the next tick, so
// that a replay, where all events lie ready from the start, takes it at the same moment.
void Player::schedule(std::span<const OutsideEvent> events) {
    const bool begun = firings() != 0 || now().ticks != 0;
    const SimTime first{now().ticks + (begun ? 1 : 0)};
    for (OutsideEvent e : events) {
        e.at = std::max(e.at, first);
        data_->occur(e);
    }
}

void Player::push(net::EventIndex event) {
    const OutsideEvent e{{0}, event};
    schedule({&e, 1});
}

namespace {

Stop stop_of(net::Engine::Outcome outcome, const net::Engine& engine) {
    switch (outcome) {
        case net::Engine::Outcome::kFired:
            return Stop::kNone;
        case net::Engine::Outcome::kSettled:
            return Stop::kLimit;
        case net::Engine::Outcome::kFault:
            return Stop::kFault;
        case net::Engine::Outcome::kDead:
            break;
    }
    return engine.in_final_marking() ? Stop::kFinal : Stop::kDead;
}

}  // namespace

Stop Player::step(const Limits& limits) {
    if (data_->engine.faulted()) {
        return Stop::kFault;
    }
    if (firings() >= limits.firings) {
        return Stop::kLimit;
    }
    return stop_of(data_->engine.step(limits.until.ticks), data_->engine);
}

Stop Player::run(const Limits& limits) {
    const Stop stop = stop_of(data_->engine.run(limits.until.ticks, limits.firings), data_->engine);
    return stop == Stop::kNone ? Stop::kLimit : stop;
}

Stop Player::advance_to(SimTime at) { return run({.until = at}); }

SimTime Player::now() const { return {data_->engine.state().now}; }
std::uint64_t Player::firings() const { return data_->engine.state().firings; }
net::TransitionIndex Player::last() const { return {data_->engine.state().last}; }

std::uint64_t Player::log_hash() const {
    const net::State& s = data_->engine.state();
    return net::log_hash_value(s.log_hash, s.firings);
}

SimTime Player::next_time() const { return {data_->engine.next_time()}; }

std::uint32_t Player::tokens(net::PlaceIndex p) const {
    PUP_REQUIRE(p.value < data_->net.place_count());
    return data_->engine.state().counts[p.value].total;
}
std::uint32_t Player::ready_tokens(net::PlaceIndex p) const {
    PUP_REQUIRE(p.value < data_->net.place_count());
    return data_->engine.state().counts[p.value].ready;
}
Value Player::datum(net::DatumIndex d) const {
    PUP_REQUIRE(d.value < data_->net.datum_count());
    return data_->engine.state().data[d.value];
}
bool Player::fireable(net::TransitionIndex t) const {
    PUP_REQUIRE(t.value < data_->net.transition_count());
    return data_->engine.fireable(t);
}
bool Player::in_final_marking() const { return data_->engine.in_final_marking(); }

const Diagnostic& Player::fault() const { return data_->engine.fault(); }
const Diagnostics& Player::notes() const { return data_->engine.notes(); }

std::vector<std::uint8_t> Player::snapshot() const {
    return net::write_state(data_->net, data_->engine.save());
}

Status Player::restore(std::span<const std::uint8_t> bytes) {
    PUP_TRY(net::State state, net::read_state(data_->net, bytes));
    data_->engine.restore(std::move(state));
    return Ok{};
}

const std::vector<OutsideEvent>& Player::recording() const { return data_->recording; }

}  // namespace puppetri::run
