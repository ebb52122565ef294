// SPDX-License-Identifier: MIT
// The ball game without a net: a small script that calls the stage as the net would, for one
// exchange after the other.
#pragma once
#include <string>
#include <vector>

#include "puppetri/math/rotation.h"
#include "puppetri/stage/stage.h"

namespace puppetri::test {

inline SimTime ms(std::int64_t n) { return {n * kTicksPerMillisecond}; }
inline SimTime frames(std::int64_t n) { return {n * (kTicksPerSecond / 24)}; }

// Builds calls: `call("face", ana).to("toward", ActorIndex{1}).arms("carry", ball)`.
struct Calls {
    using ActorIndex = motion::ActorIndex;
    using PropIndex = motion::PropIndex;

    static motion::BoundCall actor(const char* movement, std::uint32_t who) {
        motion::BoundCall c;
        c.movement = movement;
        c.subject.actor = ActorIndex{who};
        return c;
    }
    static motion::BoundCall limb(const char* movement, std::uint32_t who, motion::Limb limb) {
        motion::BoundCall c = actor(movement, who);
        c.subject.kind = motion::SubjectKind::kLimb;
        c.subject.limb = limb;
        return c;
    }
    static motion::BoundCall prop(const char* movement, std::uint32_t which) {
        motion::BoundCall c;
        c.movement = movement;
        c.subject.kind = motion::SubjectKind::kProp;
        c.subject.prop = PropIndex{which};
        return c;
    }
    static motion::BoundCall with(motion::BoundCall c, const char* name,
                                  motion::ArgumentValue value) {
        c.arguments.push_back({name, value});
        return c;
    }
    static motion::BoundCall carrying(motion::BoundCall c, std::uint32_t ball) {
        motion::BoundCall carry;
        carry.movement = "carry";
        carry.subject = c.subject;
        carry.arguments.push_back({"ball", PropIndex{ball}});
        c.nested.push_back(carry);
        c.arguments.push_back(
            {"arms", motion::NestedCall{static_cast<std::uint32_t>(c.nested.size() - 1)}});
        return c;
    }
};

// Drives a stage by hand: begins movements and ends them when they are over.
class Hand {
 public:
    explicit Hand(stage::Cast cast) { play_.cast = std::move(cast); }

    // All actions first.
    std::uint32_t add(const char* place, motion::BoundCall call) {
        play_.actions.push_back({std::move(call), place, "", {}, {}});
        return static_cast<std::uint32_t>(play_.actions.size() - 1);
    }
    void open() { stage_ = std::make_unique<stage::Stage>(play_); }

    struct Token {
        std::uint32_t activity = 0;
        SimTime ready;
    };
    Token begin(std::uint32_t action, SimTime at, SimTime duration = {-1}) {
        Token token{count_++, {}};
        const SimTime lasts = stage_->begin(net::ActionIndex{action},
                                            net::ActivityIndex{token.activity}, at, duration, {});
        token.ready = lasts.ticks < 0 ? SimTime{-1} : at + lasts;
        return token;
    }
    void end(const Token& token, SimTime at) {
        stage_->left(net::ActivityIndex{token.activity}, at);
    }
    void cut(const Token& token, SimTime at) {
        stage_->cut(net::ActivityIndex{token.activity}, at);
        stage_->left(net::ActivityIndex{token.activity}, at);
    }
    stage::Stage& stage() { return *stage_; }

 private:
    stage::Play play_;
    std::unique_ptr<stage::Stage> stage_;
    std::uint32_t count_ = 0;
};

inline stage::Cast two_players() {
    stage::Cast cast;
    cast.actors.push_back({.name = "ana", .height_m = 1.75, .position_world = {-1.5, 0, 0}});
    cast.actors.push_back(
        {.name = "rui", .height_m = 1.68, .position_world = {1.5, 0, 0}, .palette = "amber"});
    cast.props.push_back({.name = "ball", .held_by = motion::ActorIndex{0}});
    cast.sets.push_back({.name = "road", .kind = stage::SetKind::kRoad, .length_m = 60});
    return cast;
}

// The phases of the game as they follow each other, both players in turn: instants of interest per
// exchange.
struct Exchange {
    int thrower = 0;
    SimTime face, throw_begin, release, caught, catch_end;
};

struct Game {
    std::unique_ptr<const stage::Performance> performance;
    std::vector<Exchange> exchanges;
    Diagnostics diagnostics;
};

// `late` delays the readiness of the catcher: the thrower waits in its pose. Walks of some steps in
// between.
inline Game play_game(int exchanges, SimTime late = {}, int steps = 0) {
    using C = Calls;
    using motion::ActorIndex;
    using motion::PropIndex;
    using motion::SetIndex;
    Hand hand(two_players());
    struct Actions {
        std::uint32_t face, throws, flies, turns, ready, catches, turns_with, walk_with, walk;
    } a[2];
    for (std::uint32_t i = 0; i < 2; ++i) {
        const ActorIndex other{1 - i};
        a[i].face =
            hand.add("to_throw", C::carrying(C::with(C::actor("face", i), "toward", other), 0));
        a[i].throws = hand.add(
            "throwing", C::with(C::with(C::actor("throw", i), "ball", PropIndex{0}), "to", other));
        a[i].flies = hand.add(
            "flight", C::with(C::with(C::prop("fly", 0), "from", ActorIndex{i}), "to", other));
        a[i].turns = hand.add("from_throw", C::with(C::actor("face", i), "toward", SetIndex{0}));
        a[i].ready = hand.add(
            "to_get", C::with(C::with(C::actor("ready", i), "ball", PropIndex{0}), "from", other));
        a[i].catches = hand.add("getting", C::with(C::actor("catch", i), "ball", PropIndex{0}));
        a[i].turns_with = hand.add(
            "from_get", C::carrying(C::with(C::actor("face", i), "toward", SetIndex{0}), 0));
        a[i].walk_with =
            hand.add("with_ball",
                     C::carrying(C::with(C::actor("walk", i), "steps", std::int64_t{steps}), 0));
        a[i].walk =
            hand.add("without_ball", C::with(C::actor("walk", i), "steps", std::int64_t{steps}));
    }
    hand.open();
    Game game;
    SimTime t = ms(500);
    for (int n = 0; n < exchanges; ++n) {
        const int x = n % 2, y = 1 - x;
        if (steps > 0) {
            const SimTime lasts = frames(20 * steps);
            const auto with = hand.begin(a[x].walk_with, t, lasts),
                       without = hand.begin(a[y].walk, t, lasts);
            t = t + lasts;
            hand.end(with, t);
            hand.end(without, t);
        }
        Exchange e;
        e.thrower = x;
        e.face = t;
        const auto face = hand.begin(a[x].face, t, frames(12));
        const auto ready = hand.begin(a[y].ready, t + late, frames(12));
        t = t + late + frames(12);
        hand.end(face, t);
        e.throw_begin = t;
        const auto throwing = hand.begin(a[x].throws, t);
        e.release = t = throwing.ready;
        hand.end(throwing, t);
        const auto turning = hand.begin(a[x].turns, t, frames(12));
        const auto flight = hand.begin(a[x].flies, t);
        hand.end(turning, turning.ready);
        e.caught = t = std::max(flight.ready, turning.ready);
        hand.end(flight, t);
        hand.end(ready, t);
        const auto catching = hand.begin(a[y].catches, t);
        e.catch_end = t = catching.ready;
        hand.end(catching, t);
        const auto back = hand.begin(a[y].turns_with, t, frames(12));
        t = t + frames(12);
        hand.end(back, t);
        game.exchanges.push_back(e);
    }
    game.diagnostics = hand.stage().diagnostics();
    game.performance = hand.stage().finish(t + ms(1000));
    return game;
}

}  // namespace puppetri::test
