// SPDX-License-Identifier: MIT
// The ball game of Bicho, Raposo, Magalhaes (2001). Each place of its net has one way in and one
// way out (a timed event graph), so that an independent recursion gives every firing time: t fires
// for the k-th time when the last of its input places is ready,
//     x_t(k) = max over input places p of  x_{source of p}(k - M0(p)) + d_p(k)
// (Baccelli, Cohen, Olsder, Quadrat, "Synchronization and Linearity", 1992, chapter 2). The
// durations d_p that movements decide themselves are read from the score; all others are the
// scene's.
#include <map>
#include <string>
#include <vector>

#include "files.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {
namespace {

constexpr std::int64_t kFrame = kTicksPerSecond / 24;

struct Arc {
    const char *place, *from, *to;
    int tokens;
};
// SCENES: "t1 P1→P2 · t2 P2+P9→P3 · ..." as producer and consumer of each place.
constexpr Arc kArcs[] = {
    {"P1", "t8", "t1", 1},    {"P2", "t1", "t2", 0},    {"P3", "t2", "t3", 0},
    {"P4", "t3", "t4", 0},    {"P5", "t4", "t5", 0},    {"P6", "t5", "t6", 0},
    {"P7", "t6", "t7", 0},    {"P8", "t7", "t8", 0},    {"P9", "t9", "t2", 0},
    {"P10", "t3", "t10", 0},  {"P11", "t5", "t14", 0},  {"P12", "t15", "t6", 0},
    {"P13", "t16", "t9", 1},  {"P14", "t9", "t10", 0},  {"P15", "t10", "t11", 0},
    {"P16", "t11", "t12", 0}, {"P17", "t12", "t13", 0}, {"P18", "t13", "t14", 0},
    {"P19", "t14", "t15", 0}, {"P20", "t15", "t16", 0},
};
// The same net with the names of the example with modules.
const std::map<std::string, std::string> kModular = {
    {"P1", "a.with_ball"},     {"P2", "a.to_throw"},     {"P3", "a.throwing"},
    {"P4", "a.from_throw"},    {"P5", "a.without_ball"}, {"P6", "a.to_get"},
    {"P7", "a.getting"},       {"P8", "a.from_get"},     {"P9", "b.can_grasp"},
    {"P10", "a.flight"},       {"P11", "a.can_grasp"},   {"P12", "b.flight"},
    {"P13", "b.without_ball"}, {"P14", "b.to_get"},      {"P15", "b.getting"},
    {"P16", "b.from_get"},     {"P17", "b.with_ball"},   {"P18", "b.to_throw"},
    {"P19", "b.throwing"},     {"P20", "b.from_throw"},  {"t1", "a.stop"},
    {"t2", "a.throw"},         {"t3", "a.let_go"},       {"t4", "a.go"},
    {"t5", "a.wait"},          {"t6", "a.catch"},        {"t7", "a.turn"},
    {"t8", "a.walk_on"},       {"t9", "b.wait"},         {"t10", "b.catch"},
    {"t11", "b.turn"},         {"t12", "b.walk_on"},     {"t13", "b.stop"},
    {"t14", "b.throw"},        {"t15", "b.let_go"},      {"t16", "b.go"},
};

std::string named(const std::string& name, bool modular) {
    return modular ? kModular.at(name) : name;
}

class Times final : public run::LogSink {
 public:
    explicit Times(const net::Net& net) : net_(net) {}
    void fired(SimTime at, net::TransitionIndex t) override {
        times[std::string(net_.transition(t).path)].push_back(at.ticks);
    }
    std::map<std::string, std::vector<std::int64_t>> times;

 private:
    const net::Net& net_;
};

using Durations =
    std::map<std::string, std::vector<std::int64_t>>;  // by place (P1 ...) and occurrence

// The recursion, as far as the durations reach and until the limit.
std::map<std::string, std::vector<std::int64_t>> expected(const Durations& durations,
                                                          std::int64_t limit) {
    std::map<std::string, std::vector<std::int64_t>> x;
    for (bool more = true; more;) {
        more = false;
        for (int t = 1; t <= 16; ++t) {
            const std::string name = "t" + std::to_string(t);
            const std::size_t k = x[name].size();
            std::int64_t ready = 0;
            bool known = true;
            for (const Arc& arc : kArcs) {
                if (arc.to != name) {
                    continue;
                }
                const std::vector<std::int64_t>& d = durations.at(arc.place);
                const bool initial = static_cast<int>(k) < arc.tokens;
                const std::size_t source = initial ? 0 : k - static_cast<std::size_t>(arc.tokens);
                if (k >= d.size() || (!initial && source >= x[arc.from].size())) {
                    known = false;
                    break;
                }
                ready = std::max(ready, (initial ? 0 : x[arc.from][source]) + d[k]);
            }
            if (known && ready <= limit) {
                x[name].push_back(ready);
                more = true;
            }
        }
    }
    return x;
}

// Walks last steps * 20 frames, positions 12; throw, flight and catch answer themselves.
Durations durations_of(const Performed& performed, bool modular, int out, int back) {
    Durations d;
    const auto fill = [&](const char* place, std::int64_t ticks) { d[place].assign(100, ticks); };
    for (const char* place : {"P1", "P17"}) {
        fill(place, out * 20 * kFrame);
    }
    for (const char* place : {"P5", "P13"}) {
        fill(place, back * 20 * kFrame);
    }
    for (const char* place : {"P2", "P4", "P6", "P8", "P14", "P16", "P18", "P20", "P9", "P11"}) {
        fill(place, 12 * kFrame);
    }
    for (const char* place : {"P3", "P7", "P10", "P12", "P15", "P19"}) {
        for (const stage::ScoreEntry& e : performed.performance->score()) {
            if (e.place == named(place, modular)) {
                d[place].push_back(e.end.ticks - e.start.ticks);
            }
        }
    }
    return d;
}

void compare_with_recursion(const Scene& scene, bool modular, int out, int back) {
    Times log(scene.net);
    auto performed = perform(scene, {.sink = &log});
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    const std::int64_t limit = 960 * kFrame;
    const auto x = expected(durations_of(*performed, modular, out, back), limit);
    for (int t = 1; t <= 16; ++t) {
        const std::string name = "t" + std::to_string(t);
        CHECK_MESSAGE(log.times[named(name, modular)] == x.at(name), name);
    }
    CHECK(x.at("t2").size() + x.at("t14").size() >= 4);  // several rounds were played
    CHECK(performed->end.ticks == limit);
}

// Plays the scene and hands every state (after each firing, and at the start) to `look`.
template <class Look>
run::Stop each_state(const Scene& scene, SimTime until, Look&& look) {
    stage::Stage stage(scene.play);
    run::Player player(scene.net, {.seed = scene.seed, .host = &stage});
    look(player);
    const run::Limits limits{.until = until};
    run::Stop stop = player.step(limits);
    while (stop == run::Stop::kNone) {
        look(player);
        stop = player.step(limits);
    }
    return stop;
}

class Count {
 public:
    Count(const Scene& scene, const run::Player& player, bool modular)
        : scene_(scene), player_(player), modular_(modular) {}
    int operator()(std::initializer_list<const char*> places) const {
        int sum = 0;
        for (const char* p : places) {
            const net::PlaceIndex place = scene_.net.find_place(named(p, modular_));
            REQUIRE(place.valid());
            sum += static_cast<int>(player_.tokens(place));
        }
        return sum;
    }

 private:
    const Scene& scene_;
    const run::Player& player_;
    bool modular_;
};

void check_invariants(const char* file, bool modular) {
    const Scene scene = example(file);
    int states = 0;
    each_state(scene, SimTime{120 * kTicksPerSecond}, [&](const run::Player& player) {
        const Count count(scene, player, modular);
        ++states;
        CHECK(count({"P1", "P2", "P3", "P7", "P8", "P10", "P12", "P15", "P16", "P17", "P18",
                     "P19"}) == 1);
        CHECK(count({"P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8"}) == 1);
        CHECK(count({"P13", "P14", "P15", "P16", "P17", "P18", "P19", "P20"}) == 1);
        CHECK(count({"P9", "P3", "P10"}) == count({"P14"}));
        CHECK(count({"P11", "P19", "P12"}) == count({"P6"}));
    });
    CHECK(states > 100);
}

}  // namespace

TEST_CASE("the ball game fires when the recursion of event graphs says [oracle]") {
    compare_with_recursion(example("03_ball/figure5.pup"), false, 3, 2);
    compare_with_recursion(example("03_ball/ball.pup"), true, 3, 2);
}

TEST_CASE("other step counts: the thrower waits until the other is ready [oracle]") {
    const Scene scene = example("03_ball/waits.pup");
    compare_with_recursion(scene, true, 2, 4);
    // a stands ready at frame 2*20 + 12; b has walked and can grasp at frame 4*20 + 12: then, not
    // before, it throws.
    Times log(scene.net);
    REQUIRE(perform(scene, {.sink = &log}).has_value());
    REQUIRE_FALSE(log.times["a.throw"].empty());
    CHECK(log.times["a.throw"][0] == (4 * 20 + 12) * kFrame);
}

TEST_CASE("the invariants of the ball game hold in every state of a run [law]") {
    check_invariants("03_ball/figure5.pup", false);
    check_invariants("03_ball/ball.pup", true);
    check_invariants("03_ball/waits.pup", true);
}

TEST_CASE("possession alternates, and nobody throws to one who is not ready [law]") {
    const Scene scene = example("03_ball/ball.pup");
    const net::TransitionIndex a = scene.net.find_transition("a.throw"),
                               b = scene.net.find_transition("b.throw");
    const net::PlaceIndex grasp_a = scene.net.find_place("a.can_grasp"),
                          grasp_b = scene.net.find_place("b.can_grasp");
    REQUIRE(grasp_a.valid());
    std::string throwers;
    std::uint32_t ready_a = 0, ready_b = 0;
    each_state(scene, SimTime{120 * kTicksPerSecond}, [&](const run::Player& player) {
        if (player.firings() > 0 && player.last() == a) {
            throwers += 'a';
            CHECK(ready_b >= 1);
            CHECK(player.tokens(grasp_b) == 0);
        } else if (player.firings() > 0 && player.last() == b) {
            throwers += 'b';
            CHECK(ready_a >= 1);
        }
        ready_a = player.tokens(grasp_a);
        ready_b = player.tokens(grasp_b);
    });
    REQUIRE(throwers.size() > 10);
    for (std::size_t i = 0; i < throwers.size(); ++i) {
        CHECK(throwers[i] == (i % 2 == 0 ? 'a' : 'b'));
    }
}

TEST_CASE(
    "figure 5 has 20 places, 16 transitions and 40 arcs; each walk of the module is a net of its "
    "own [unit]") {
    const Scene flat = example("03_ball/figure5.pup");
    CHECK(flat.draft.places.size() == 20);
    CHECK(flat.draft.transitions.size() == 16);
    std::size_t arcs = 0;
    for (const net::TransitionDraft& t : flat.draft.transitions) {
        arcs += t.inputs.size() + t.outputs.size();
    }
    CHECK(arcs == 40);
    const Scene modular = example("03_ball/ball.pup");
    CHECK(modular.draft.places.size() ==
          2 * (10 + 2 * 10));  // a player: 10 places, two of them with a walk of 10
    CHECK(modular.net.find_place("a.with_ball.P4").valid());
    CHECK(modular.net.find_place("b.without_ball.P9").valid());
}

TEST_CASE("figures do not drift apart: each walks as many steps in a round as the other [law]") {
    for (const char* file : {"03_ball/ball.pup", "03_ball/waits.pup"}) {
        const Scene scene = example(file);
        const auto performed =
            perform(scene, {.horizon = {.time = SimTime{120 * kTicksPerSecond}}});
        REQUIRE(performed.has_value());
        figure::Pose ana, rui;
        double most = 0;
        for (int s = 0; s <= 120; s += 5) {
            performed->performance->pose({0}, SimTime{s * kTicksPerSecond}, ana);
            performed->performance->pose({1}, SimTime{s * kTicksPerSecond}, rui);
            const Vec3 apart =
                ana.parent_from_joint[0].translation - rui.parent_from_joint[0].translation;
            most = std::max(most, std::fabs(apart.z));
        }
        CHECK(most < 4 * 0.6 + 0.5);  // at most the steps of one phase ahead
    }
}

TEST_CASE("a limit of frames ends the run there and changes nothing before [law]") {
    const Scene scene = example("03_ball/ball.pup");
    Times whole(scene.net), part(scene.net);
    REQUIRE(perform(scene, {.sink = &whole}).has_value());
    const std::optional<SimTime> limit = scene.frame_rate.time_of_frame(333);
    REQUIRE(limit.has_value());
    const auto performed = perform(scene, {.horizon = {.time = limit}, .sink = &part});
    REQUIRE(performed.has_value());
    CHECK(performed->stop == run::Stop::kLimit);
    CHECK(performed->end.ticks == 333 * kFrame);
    CHECK(performed->performance->duration() == performed->end);
    for (auto& [transition, times] : whole.times) {
        std::erase_if(times, [&](std::int64_t t) { return t > 333 * kFrame; });
        CHECK_MESSAGE(part.times[transition] == times, transition);
    }
}

TEST_CASE("seeded bugs do what the theory says [oracle]") {
    const SimTime long_enough{300 * kTicksPerSecond};
    {
        // Two balls: dead at P2 + P18.
        const Scene scene = example("03_ball/two_balls.pup");
        std::map<std::string, std::uint32_t> last;
        const run::Stop stop = each_state(scene, long_enough, [&](const run::Player& player) {
            last.clear();
            for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
                if (player.tokens({p}) > 0) {
                    last[std::string(scene.net.place({p}).path)] = player.tokens({p});
                }
            }
        });
        CHECK(stop == run::Stop::kDead);
        CHECK(last == std::map<std::string, std::uint32_t>{{"a.to_throw", 1}, {"b.to_throw", 1}});
    }
    {
        // No ball: dead at P6 + P9 + P11 + P14.
        const Scene scene = example("03_ball/no_ball.pup");
        std::map<std::string, std::uint32_t> last;
        const run::Stop stop = each_state(scene, long_enough, [&](const run::Player& player) {
            last.clear();
            for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
                if (player.tokens({p}) > 0) {
                    last[std::string(scene.net.place({p}).path)] = player.tokens({p});
                }
            }
        });
        CHECK(stop == run::Stop::kDead);
        CHECK(last ==
              std::map<std::string, std::uint32_t>{
                  {"a.to_get", 1}, {"a.can_grasp", 1}, {"b.to_get", 1}, {"b.can_grasp", 1}});
    }
    {
        // t2 without P9: nothing takes its tokens, one more in each round.
        const Scene scene = example("03_ball/impatient.pup");
        const net::PlaceIndex p9 = scene.net.find_place("P9");
        std::uint32_t most = 0;
        each_state(scene, long_enough,
                   [&](const run::Player& player) { most = std::max(most, player.tokens(p9)); });
        CHECK(most >= 10);
    }
}

TEST_CASE("the toss: a throw only to one who is ready, in turn, one ball [law]") {
    const Scene scene = example("01_toss/toss.pup");
    std::string throwers;
    const net::TransitionIndex a = scene.net.find_transition("a.throw"),
                               b = scene.net.find_transition("b.throw");
    each_state(scene, SimTime{60 * kTicksPerSecond}, [&](const run::Player& player) {
        int balls = 0;
        for (const char* place : {"a.holding", "a.throwing", "a.flight", "a.catching", "b.holding",
                                  "b.throwing", "b.flight", "b.catching"}) {
            balls += static_cast<int>(player.tokens(scene.net.find_place(place)));
        }
        CHECK(balls == 1);
        if (player.firings() > 0 && (player.last() == a || player.last() == b)) {
            throwers += player.last() == a ? 'a' : 'b';
        }
    });
    REQUIRE(throwers.size() > 5);
    for (std::size_t i = 0; i < throwers.size(); ++i) {
        CHECK(throwers[i] == (i % 2 == 0 ? 'a' : 'b'));
    }
}

}  // namespace puppetri::scene
