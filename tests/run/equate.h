// SPDX-License-Identifier: MIT
// Systems of equations built by hand, as the scene builds them from text, and played beside a net.
#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "net/maker.h"
#include "puppetri/run/equations.h"
#include "puppetri/run/player.h"

namespace puppetri::run {

using net::lasts;
using net::Maker;
using net::seconds;

// An expression with operators.
struct X {
    Expr e;
    X(double number) : e(Expr::real(number)) {}
    X(Expr made) : e(std::move(made)) {}
};
inline X two(ExprOp op, const X& a, const X& b) {
    auto made = Expr::binary(op, a.e, b.e);
    REQUIRE(made);
    return X{std::move(*made)};
}
inline X one(ExprOp op, const X& a) {
    auto made = Expr::unary(op, a.e);
    REQUIRE(made);
    return X{std::move(*made)};
}
inline X operator+(const X& a, const X& b) { return two(ExprOp::kAdd, a, b); }
inline X operator-(const X& a, const X& b) { return two(ExprOp::kSubtract, a, b); }
inline X operator*(const X& a, const X& b) { return two(ExprOp::kMultiply, a, b); }
inline X slot(EquationSlot kind, std::uint32_t index) {
    return X{Expr::slot({static_cast<std::uint32_t>(kind), index}, {ValueKind::kReal})};
}
inline X var(std::uint32_t i) { return slot(EquationSlot::kVariable, i); }
inline X time() { return slot(EquationSlot::kTime, 0); }

struct Equate {
    EquationSystem s;

    ProgramIndex add(const X& x) {
        auto index = s.code.add(x.e);
        REQUIRE(index);
        return *index;
    }
    std::uint32_t variable(const char* name, double initial) {
        s.variables.push_back({.name = name, .initial = initial});
        return static_cast<std::uint32_t>(s.variables.size() - 1);
    }
    void rate(std::uint32_t v, const X& x) { s.variables[v].rate = add(x); }
    void event(net::EventIndex e, const X& x, CrossingDirection d, bool plain = true) {
        s.events.push_back({.event = e,
                            .value = add(x),
                            .direction = d,
                            .plain = plain,
                            .name = "e" + std::to_string(e.value)});
    }
    X past(std::uint32_t v, double ago_s) {
        s.pasts.push_back({v, ago_s});
        return slot(EquationSlot::kPast, static_cast<std::uint32_t>(s.pasts.size() - 1));
    }
};

struct Log final : LogSink {
    void fired(SimTime at, net::TransitionIndex) override { times.push_back(at); }
    std::vector<SimTime> times;
};

struct Ran {
    Stop stop = Stop::kNone;
    std::vector<SimTime> times;
    std::uint64_t hash = 0;
    Diagnostic fault;
};

// Nets of which time is asked: their events are crossings.
inline net::Net timed(Maker& m) {
    for (net::EventDraft& e : m.draft.events) {
        e.crossing = true;
        e.outside = false;
    }
    return m.net();
}

inline Ran play(const net::Net& net, Equations& equations, SimTime until, SimTime slice = {}) {
    Log log;
    Player p(net, {.sink = &log, .coupled = {&equations}});
    Ran out;
    if (slice.ticks == 0) {
        out.stop = p.run({.until = until});
    } else {
        while (p.now() < until && out.stop != Stop::kFault) {
            out.stop = p.run({.until = std::min(until, p.now() + slice)});
        }
    }
    out.times = log.times;
    out.hash = p.log_hash();
    if (out.stop == Stop::kFault) {
        out.fault = p.fault();
    }
    return out;
}

}  // namespace puppetri::run
