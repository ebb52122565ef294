// SPDX-License-Identifier: MIT
// The walk of Bicho, Raposo, Magalhaes (2001): when its transitions fire follows from the paper's
// text alone. The first and the last step last n/2, the others n; the first is P2, the last P7 or
// P8, so that k steps last n/2 + (k-1)n + n/2 = kn, and for the paper's n = 20, k = 3 the borders
// are the frames 10, 30, 50, 60.
#include <map>
#include <string>
#include <vector>

#include "files.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {
namespace {

constexpr std::int64_t kFrame = kTicksPerSecond / 24;

struct Firing {
    std::int64_t frame_ticks;
    std::string transition;
    bool operator==(const Firing&) const = default;
};

class Log final : public run::LogSink {
 public:
    explicit Log(const net::Net& net) : net_(net) {}
    void fired(SimTime at, net::TransitionIndex t) override {
        firings.push_back({at.ticks, std::string(net_.transition(t).path)});
    }
    // All times of one transition, in frames; a time between frames counts as -1.
    std::vector<std::int64_t> frames(const std::string& transition) const {
        std::vector<std::int64_t> out;
        for (const Firing& f : firings) {
            if (f.transition == transition) {
                out.push_back(f.frame_ticks % kFrame == 0 ? f.frame_ticks / kFrame : -1);
            }
        }
        return out;
    }
    std::vector<Firing> firings;

 private:
    const net::Net& net_;
};

using Frames = std::vector<std::int64_t>;

Performed perform_logged(const Scene& scene, Log& log, std::uint64_t seed = 1) {
    auto performed = perform(scene, {.seed = seed, .sink = &log});
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    return std::move(*performed);
}

// A figure that walks once with the module of the example.
Scene one_walk(const std::string& arguments) {
    ExampleFiles examples;
    MemoryFiles files;
    files.add("walk.pup", *examples.read("02_walk/walk.pup"));
    files.add("scene.pup",
              "language 1\nscene \"walk\"\nframes 24 per second\nimport walk from \"walk.pup\"\n"
              "cast { ana: mannequin { } }\nplace w runs walk(ana" +
                  arguments +
                  ") tokens 1\nplace there\n"
                  "arrive: w -> there\nend { there }\n");
    return must(load(files, "scene.pup"));
}

}  // namespace

TEST_CASE("the walk fires at the paper's frames: 0, 10, 30, 50, 60 [oracle]") {
    const Scene scene = example("02_walk/figure.pup");
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Log log(scene.net);
        const Performed performed = perform_logged(scene, log, seed);
        CHECK(log.frames("t1") == Frames{0});
        CHECK(log.frames("t2") == Frames{10});
        CHECK(log.frames("t3") == Frames{30});
        CHECK(log.frames("t5") == Frames{30});
        CHECK(log.frames("t8") == Frames{50});
        CHECK(log.frames("t10") == Frames{60});
        CHECK(log.firings.size() == 6);
        CHECK(performed.stop == run::Stop::kFinal);
        CHECK(performed.end.ticks == 60 * kFrame);
    }
}

TEST_CASE(
    "k steps of n frames last exactly k n, the last one with the right leg for even k [law]") {
    for (const int n : {20, 14}) {
        for (int k = 1; k <= 6; ++k) {
            const Scene scene =
                one_walk(", steps: " + std::to_string(k) + ", n: " + std::to_string(n) + " frames");
            Log log(scene.net);
            const Performed performed = perform_logged(scene, log);
            CHECK(log.frames("arrive") == Frames{k * n});
            CHECK(log.frames("w.t9").size() == (k % 2 == 0 ? 1u : 0u));   // P7, the right leg
            CHECK(log.frames("w.t10").size() == (k % 2 == 1 ? 1u : 0u));  // P8, the left leg
            // A first and a last half step, and whole ones between.
            std::map<std::string, int> movements;
            for (const stage::ScoreEntry& e : performed.performance->score()) {
                movements[e.movement] += 1;
                CHECK(e.actor == "ana");
                CHECK(e.instance == "w");
            }
            CHECK(movements["half_step"] == 2);
            CHECK(movements["step"] == k - 1);
        }
    }
}

TEST_CASE("a walk that is used twice in a row is whole twice [oracle]") {
    const Scene scene = example("02_walk/twice.pup");
    Log log(scene.net);
    const Performed performed = perform_logged(scene, log);
    CHECK(log.frames("again") == Frames{3 * 20});
    CHECK(log.frames("stop") == Frames{3 * 20 + 4 * 16});
    CHECK(performed.stop == run::Stop::kFinal);
    int whole = 0, half = 0;
    for (const stage::ScoreEntry& e : performed.performance->score()) {
        whole += e.movement == "step" ? 1 : 0;
        half += e.movement == "half_step" ? 1 : 0;
    }
    CHECK(whole == 2 + 3);
    CHECK(half == 2 + 2);
}

TEST_CASE("feet take turns, also where each limb has a place of its own [oracle]") {
    // Starts and ends of the legs' movements, by frame: right, left, right, left (table 2 of the
    // paper).
    for (const char* file : {"02_walk/limbs.pup", "02_walk/legs.pup"}) {
        const Scene scene = example(file);
        Log log(scene.net);
        const Performed performed = perform_logged(scene, log);
        CHECK(log.frames("t10") == Frames{60});
        struct Swing {
            std::int64_t begin, end;
            bool left;
            bool operator==(const Swing&) const = default;
        };
        std::vector<Swing> swings;
        bool arms = false;
        for (const stage::ScoreEntry& e : performed.performance->score()) {
            if (e.movement == "transfer") {
                swings.push_back({e.start.ticks / kFrame, e.end.ticks / kFrame,
                                  e.limbs.has(motion::Limb::kLeftLeg)});
            }
            arms =
                arms || e.limbs.has(motion::Limb::kLeftArm) || e.limbs.has(motion::Limb::kRightArm);
        }
        CHECK(swings ==
              std::vector<Swing>{{0, 10, false}, {10, 30, true}, {30, 50, false}, {50, 60, true}});
        CHECK(arms == (std::string(file) == "02_walk/limbs.pup"));
    }
}

TEST_CASE("with every limb a place, four movements run side by side in each step [unit]") {
    const Scene scene = example("02_walk/limbs.pup");
    Log log(scene.net);
    const Performed performed = perform_logged(scene, log);
    std::map<std::int64_t, int> at_once;
    for (const stage::ScoreEntry& e : performed.performance->score()) {
        at_once[e.start.ticks / kFrame] += 1;
    }
    CHECK(at_once == std::map<std::int64_t, int>{{0, 4}, {10, 4}, {30, 4}, {50, 4}});
}

TEST_CASE("the duty factor changes the feet, not the times of the net [law]") {
    const Scene scene = example("02_walk/duty.pup");
    Log log(scene.net);
    const Performed performed = perform_logged(scene, log);
    CHECK(log.frames("stop") == Frames{6 * 20});
    for (const char* walk : {"paper", "usual", "careful"}) {
        CHECK(log.frames(std::string(walk) + ".t5") ==
              Frames{10 + 4 * 20});  // the start of the sixth step
    }
}

TEST_CASE("n, x and the frame rate belong to the file that writes them [unit]") {
    // 20 frames of walk.pup are 20/24 s, in a scene of 48 frames per second, too.
    ExampleFiles examples;
    MemoryFiles files;
    files.add("walk.pup", *examples.read("02_walk/walk.pup"));
    files.add("scene.pup",
              "language 1\nscene \"walk\"\nframes 48 per second\nimport walk from \"walk.pup\"\n"
              "cast { ana: mannequin { } }\nplace w runs walk(ana) tokens 1\nplace v runs "
              "walk(ana, n: 20 frames)\n"
              "place there\nhalf: w -> v\narrive: v -> there\nend { there }\n");
    const Scene scene = must(load(files, "scene.pup"));
    Log log(scene.net);
    perform_logged(scene, log);
    CHECK(log.frames("half") == Frames{60});
    CHECK(log.frames("arrive") == Frames{60 + 30});
}

TEST_CASE("three arcs: only t2 fires, once, and the net rests with its token [oracle]") {
    const Scene scene = example("04_three_arcs/three_arcs.pup");
    Log log(scene.net);
    const Performed performed = perform_logged(scene, log);
    REQUIRE(log.firings.size() == 1);
    CHECK(log.firings[0].transition == "t2");
    CHECK(performed.stop == run::Stop::kDead);
    run::Player player(scene.net);
    player.run({});
    const auto tokens = [&](const char* place) {
        return player.tokens(scene.net.find_place(place));
    };
    CHECK(tokens("P1") == 1);
    CHECK(tokens("P2") == 0);
    CHECK(tokens("P3") == 0);
    CHECK(tokens("P4") == 1);
}

}  // namespace puppetri::scene
