// SPDX-License-Identifier: MIT
// A finished performance answers in any order, from any thread, without allocating.
#include <atomic>
#include <thread>

#include "doctest/doctest.h"
#include "exchange.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::test;

namespace {

struct Frame {
    figure::Pose poses[2];
    Transform ball;
    std::string holder;
};
Frame look(const stage::Performance& p, SimTime at) {
    Frame f;
    p.pose({0}, at, f.poses[0]);
    p.pose({1}, at, f.poses[1]);
    f.ball = p.world_from_prop({0}, at);
    f.holder = p.holder({0}, at);
    return f;
}
bool same(const Frame& a, const Frame& b) {
    return a.poses[0].parent_from_joint == b.poses[0].parent_from_joint &&
           a.poses[1].parent_from_joint == b.poses[1].parent_from_joint && a.ball == b.ball &&
           a.holder == b.holder;
}

}  // namespace

TEST_CASE(
    "asked in any order and from several threads, the answers are the same bit for bit [law]") {
    const Game game = play_game(2);
    const stage::Performance& p = *game.performance;
    constexpr int kCount = 400;
    const auto time = [&](int i) { return SimTime{p.duration().ticks / kCount * i}; };
    std::vector<Frame> in_order;
    for (int i = 0; i < kCount; ++i) {
        in_order.push_back(look(p, time(i)));
    }
    for (int i = 0; i < kCount; ++i) {
        const int j = (i * 177 + 31) % kCount;
        CHECK(same(look(p, time(j)), in_order[static_cast<std::size_t>(j)]));
    }
    std::atomic<int> different{0};
    std::vector<std::thread> threads;
    for (int k = 0; k < 3; ++k) {
        threads.emplace_back([&, k] {
            for (int i = 0; i < kCount; ++i) {
                const int j = (i * (61 + 2 * k) + k) % kCount;
                different += !same(look(p, time(j)), in_order[static_cast<std::size_t>(j)]);
            }
        });
    }
    for (std::thread& t : threads) {
        t.join();
    }
    CHECK(different == 0);
}

TEST_CASE("two stages that hear the same calls take the same performance [law]") {
    const Game one = play_game(2), two = play_game(2);
    for (SimTime t; t < one.performance->duration(); t = t + ms(97)) {
        CHECK(same(look(*one.performance, t), look(*two.performance, t)));
    }
}

TEST_CASE("after the first pose nothing is allocated [alloc]") {
    const Game game = play_game(1);
    const stage::Performance& p = *game.performance;
    figure::Pose pose;
    p.pose({0}, {}, pose);
    Transform ball = p.world_from_prop({0}, {});
    const std::uint64_t before = allocations();
    for (SimTime t; t < p.duration(); t = t + ms(20)) {
        p.pose({0}, t, pose);
        p.pose({1}, t, pose);
        ball = p.world_from_prop({0}, t);
    }
    CHECK(allocations() == before);
    CHECK(ball.translation.y > 0);
}

TEST_CASE("times outside the take answer its first and last instant [unit]") {
    const Game game = play_game(1);
    const stage::Performance& p = *game.performance;
    CHECK(same(look(p, {-5}), look(p, {})));
    CHECK(same(look(p, p.duration() + ms(10)), look(p, p.duration())));
}

TEST_CASE("the score has a row per movement: when, who, which limbs, which prop [unit]") {
    const Game game = play_game(1);
    const auto score = game.performance->score();
    REQUIRE(score.size() == 7);
    const auto find = [&](const char* movement) -> const stage::ScoreEntry& {
        for (const stage::ScoreEntry& row : score) {
            if (row.movement == movement) {
                return row;
            }
        }
        FAIL(movement);
        return score[0];
    };
    const Exchange& e = game.exchanges[0];
    CHECK(find("throw").start == e.throw_begin);
    CHECK(find("throw").end == e.release);
    CHECK(find("throw").left == e.release);
    CHECK(find("throw").actor == "ana");
    CHECK(find("throw").prop == "ball");
    CHECK(find("throw").place == "throwing");
    CHECK(find("fly").actor.empty());
    CHECK(find("fly").limbs.bits == 0);
    CHECK(find("fly").prop == "ball");
    CHECK(find("ready").actor == "rui");
    CHECK(find("ready").left == e.caught);
    CHECK(find("face").limbs == motion::LimbSet{0x3f});
    for (std::size_t i = 1; i < score.size(); ++i) {
        CHECK(score[i - 1].start <= score[i].start);
    }
}
