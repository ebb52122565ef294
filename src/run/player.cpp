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
          wants(o.observer != nullptr ? o.observer->wants() : Observer::Wants{}),
          engine(n, o.chooser != nullptr ? *o.chooser : random, engine_options()) {
        if (options.observer != nullptr) {
            options.observer->prepare();
        }
        engine.start();
    }

    net::EngineOptions engine_options() {
        net::EngineOptions e;
        e.seed = options.seed;
        e.host = options.host;
        e.listener =
            options.sink != nullptr || wants.insides || !options.coupled.empty() ? this : nullptr;
        e.beat = options.beat.ticks;
        e.firings_per_instant = options.firings_per_instant;
        e.antithetic = options.antithetic;
        return e;
    }
    void fired(SimTime at, net::TransitionIndex t) override {
        for (Coupled* c : options.coupled) {
            c->fired(at, t);
        }
        if (options.sink != nullptr) {
            options.sink->fired(at, t);
        }
    }
    void occurs(SimTime at, net::EventIndex e) override {
        for (Coupled* c : options.coupled) {
            c->occurs(at, e);
        }
        if (options.sink != nullptr) {
            options.sink->occurs(at, e);
        }
    }
    void lost(SimTime at, net::EventIndex e) override {
        if (options.sink != nullptr) {
            options.sink->lost(at, e);
        }
    }
    void fires(SimTime at, net::TransitionIndex t, const Code::Reader& before) override {
        if (wants.insides) {
            options.observer->fires(at, t, before);
        }
    }
    void arrives(SimTime at, net::PlaceIndex p, SimTime ready) override {
        if (wants.insides) {
            options.observer->arrives(at, p, ready);
        }
    }
    void leaves(SimTime at, net::PlaceIndex p, SimTime arrived) override {
        if (wants.insides) {
            options.observer->leaves(at, p, arrived);
        }
    }

    net::Engine::Outcome run(std::int64_t until, std::uint64_t firings);
    net::Engine::Outcome run_coupled(std::int64_t until, std::uint64_t firings);
    bool next_crossings(SimTime until, std::vector<Coupled*>& whose, Coupled::Crossings& found);
    bool may_cross() const {
        return std::any_of(options.coupled.begin(), options.coupled.end(),
                           [](const Coupled* c) { return c->may_cross(); });
    }

    void occur(const OutsideEvent& e) {
        engine.occur(e.event, e.at);
        if (options.record) {
            recording.push_back(e);
        }
    }

    const net::Net& net;
    Options options;
    Observer::Wants wants;
    net::RandomChooser random;
    net::Engine engine;
    std::vector<OutsideEvent> recording;
    Diagnostic coupled_fault;
    bool coupled_faulted = false;
};

net::Engine::Outcome Player::Data::run(std::int64_t until, std::uint64_t firings) {
    return options.coupled.empty() ? engine.run(until, firings) : run_coupled(until, firings);
}

// The earliest crossings of all, in the order of the list of what is coupled.
bool Player::Data::next_crossings(SimTime until, std::vector<Coupled*>& whose,
                                  Coupled::Crossings& found) {
    whose.clear();
    found = {};
    for (Coupled* c : options.coupled) {
        Coupled::Crossings next;
        if (!c->next(engine.state(), until, next, coupled_fault)) {
            coupled_faulted = true;
            return false;
        }
        if (next.events.empty() || next.at > until || next.at > found.at) {
            continue;
        }
        if (next.at < found.at) {
            whose.clear();
            found = {next.at, {}};
            until = std::min(until, found.at);  // the others need not look further
        }
        whose.push_back(c);
        found.events.insert(found.events.end(), next.events.begin(), next.events.end());
    }
    return true;
}

// Instant by instant: when one has settled, either the net's next instant comes, or a crossing
// before it. Crossings enter only when time goes on to them, so that whatever the outside says for
// that instant comes first, in a replay as well.
net::Engine::Outcome Player::Data::run_coupled(std::int64_t until, std::uint64_t firings) {
    using Outcome = net::Engine::Outcome;
    constexpr std::int64_t kPatience = 3600 * kTicksPerSecond;
    if (coupled_faulted) {
        return Outcome::kFault;
    }
    for (;;) {
        const std::int64_t now = engine.state().now;
        Outcome outcome = engine.run(now, firings);
        if (outcome == Outcome::kFired || outcome == Outcome::kFault) {
            return outcome;
        }
        const std::int64_t next = engine.next_time();
        const std::int64_t never = SimTime::never().ticks;
        std::int64_t continue_to = now;
        std::int64_t limit = std::min(until, next);
        if (limit == never) {
            // Nothing but crossings can come: one within the hour, or none is waited for.
            limit = now > never - kPatience ? never : now + kPatience;
        }
        std::vector<Coupled*> whose;
        Coupled::Crossings found;
        if (!next_crossings({limit}, whose, found)) {
            return Outcome::kFault;
        }
        if (!whose.empty()) {
            for (Coupled* c : whose) {
                c->deliver();
            }
            for (const net::EventIndex e : found.events) {
                engine.occur(e, {std::max(found.at.ticks, now)});
            }
            continue_to = std::max(found.at.ticks, now);
        } else if (next <= until && next != never) {
            continue_to = next;
        } else {
            if (next == never && (until == never || !may_cross())) {
                return Outcome::kDead;
            }
            engine.pass_to({std::max(until, now)});
            return Outcome::kSettled;
        }
        outcome = engine.run(continue_to, firings);
        if (outcome == Outcome::kFired || outcome == Outcome::kFault) {
            return outcome;
        }
        if (wants.instants && !whose.empty()) {
            return Outcome::kSettled;  // a crossing that nobody used: something to look at
        }
    }
}

Player::Player(const net::Net& net, const Options& options)
    : data_(std::make_unique<Data>(net, options)) {
    if (options.observer != nullptr) {
        options.observer->begins(*this);
    }
}
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
    if (data_->engine.faulted() || data_->coupled_faulted) {
        return Stop::kFault;
    }
    if (firings() >= limits.firings) {
        return Stop::kLimit;
    }
    Observer* const observer = data_->options.observer;
    for (;;) {
        const std::int64_t until = limits.until.ticks;
        // Not beyond the next instant, for those who want to see it
        const std::int64_t next =
            data_->wants.instants ? std::min(until, data_->engine.next_time()) : until;
        const Stop stop = stop_of(data_->run(next, firings() + 1), data_->engine);
        if (observer != nullptr && stop == Stop::kNone) {
            observer->fired(*this);
        } else if (data_->wants.instants && stop != Stop::kFault) {
            observer->passed(*this);
        }
        if (stop != Stop::kLimit || !data_->wants.instants || now().ticks >= until) {
            return stop;
        }
    }
}

Stop Player::run(const Limits& limits) {
    if (data_->options.observer != nullptr) {
        Stop stop = Stop::kNone;
        while (stop == Stop::kNone) {
            stop = step(limits);
        }
        return stop;
    }
    const Stop stop = stop_of(data_->run(limits.until.ticks, limits.firings), data_->engine);
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

std::span<Coupled* const> Player::coupled() const { return data_->options.coupled; }

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

const Diagnostic& Player::fault() const {
    return data_->coupled_faulted ? data_->coupled_fault : data_->engine.fault();
}
const Diagnostics& Player::notes() const { return data_->engine.notes(); }

namespace {

// Parts one after another, each with its length in eight bytes before it.
void add_part(std::vector<std::uint8_t>& out, const std::vector<std::uint8_t>& part) {
    for (int i = 0; i < 8; ++i) {
        out.push_back(static_cast<std::uint8_t>(std::uint64_t{part.size()} >> (8 * i)));
    }
    out.insert(out.end(), part.begin(), part.end());
}

bool take_part(std::span<const std::uint8_t>& bytes, std::span<const std::uint8_t>& part) {
    std::uint64_t size = 0;
    for (int i = 0; i < 8 && bytes.size() >= 8; ++i) {
        size |= std::uint64_t{bytes[static_cast<std::size_t>(i)]} << (8 * i);
    }
    if (bytes.size() < 8 || size > bytes.size() - 8) {
        return false;
    }
    part = bytes.subspan(8, static_cast<std::size_t>(size));
    bytes = bytes.subspan(8 + static_cast<std::size_t>(size));
    return true;
}

}  // namespace

std::vector<std::uint8_t> Player::snapshot() const {
    std::vector<std::uint8_t> state = net::write_state(data_->net, data_->engine.save());
    if (data_->options.coupled.empty()) {
        return state;
    }
    std::vector<std::uint8_t> out;
    add_part(out, state);
    for (const Coupled* c : data_->options.coupled) {
        std::vector<std::uint8_t> part;
        c->save(part);
        add_part(out, part);
    }
    return out;
}

Status Player::restore(std::span<const std::uint8_t> bytes) {
    if (data_->options.coupled.empty()) {
        PUP_TRY(net::State state, net::read_state(data_->net, bytes));
        data_->engine.restore(std::move(state));
        return Ok{};
    }
    const auto damaged = [] {
        return Unexpected(Diagnostics{{.code = "bad-snapshot",
                                       .where = {},
                                       .element = "snapshot",
                                       .message = "these bytes are no snapshot of this net",
                                       .remedy = "take one of the same scene and version"}});
    };
    std::span<const std::uint8_t> part;
    if (!take_part(bytes, part)) {
        return damaged();
    }
    PUP_TRY(net::State state, net::read_state(data_->net, part));
    // Either all are restored or none.
    std::vector<std::vector<std::uint8_t>> before;
    for (std::size_t i = 0; i < data_->options.coupled.size(); ++i) {
        before.emplace_back();
        data_->options.coupled[i]->save(before.back());
        if (!take_part(bytes, part) || !data_->options.coupled[i]->restore(part)) {
            for (std::size_t k = 0; k < i; ++k) {
                data_->options.coupled[k]->restore(before[k]);
            }
            return damaged();
        }
    }
    data_->engine.restore(std::move(state));
    data_->coupled_faulted = false;
    return Ok{};
}

const std::vector<OutsideEvent>& Player::recording() const { return data_->recording; }

}  // namespace puppetri::run
