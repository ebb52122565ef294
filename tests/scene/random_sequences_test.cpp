// SPDX-License-Identifier: MIT
// Four movements of the library in any order, each as long as a net may prescribe: no join jumps,
// no joint leaves its limits, no foot goes into the floor.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "measured.h"
#include "puppetri/base/random.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

struct Sequence {
    Scene scene;
    std::string story;  // "bow() takes 1.250 s, jump() ..."
};

Sequence sequence_of(std::uint64_t seed) {
    // With about the time that each takes by itself; the first ones also of who sits.
    struct Call {
        const char* text;
        double own_s;
    };
    static constexpr Call kCalls[] = {{"idle()", 1.5},
                                      {"wave()", 2},
                                      {"eat()", 2.5},
                                      {"swing()", 1},
                                      {"look((1, 1, 1) m)", 1},
                                      {"stand_up()", 1.5},
                                      {"bow()", 2},
                                      {"sit()", 1.5},
                                      {"jump()", 1.2},
                                      {"walk(steps: 2)", 1.7},
                                      {"turn(60 deg)", 0.8},
                                      {"step(left)", 0.85},
                                      {"half_step(right)", 0.45},
                                      {"go((0.4, 0, 0.8) m)", 4},
                                      {"reach((0.2, 1.3, 0.6) m)", 0.8},
                                      {"hold(ball)", 1},
                                      {"point((2, 1.4, 2) m)", 0.8},
                                      {"pick_up(ball)", 2}};
    constexpr std::size_t kOfWhoSits = 6;
    RandomStream random{stream_key(seed, "random_sequences_test", "movements")};
    std::string text =
        "language 1\nscene \"sequence\"\nuntil 20 s\ncast {\n  ana: mannequin\n"
        "  ball: sphere { diameter 22 cm, at (0, 0.11, 0.4) m }\n}\n";
    Sequence made;
    bool sits = false;
    for (int k = 0; k < 4; ++k) {
        const std::size_t choice = sits ? kOfWhoSits : std::size(kCalls);
        const Call& call =
            kCalls[static_cast<std::size_t>(random.uniform() * static_cast<double>(choice))];
        sits = (sits && std::string_view(call.text) != "stand_up()") ||
               std::string_view(call.text) == "sit()";
        // A third quicker to twice as slow.
        char takes[24];
        std::snprintf(takes, sizeof takes, "%.3f s", call.own_s * (0.67 + 1.33 * random.uniform()));
        const std::string number = std::to_string(k), before = std::to_string(k - 1);
        text += "place p" + number + " does ana." + call.text + " takes " + takes +
                (k == 0 ? " tokens 1\n" : "\n");
        text += k > 0 ? "t" + number + ": p" + before + " -> p" + number + "\n" : "";
        made.story += std::string(call.text) + " " + takes + ", ";
    }
    text += "place p4 does ana.idle(lasting: 1.5 s)\nt4: p3 -> p4\nend { p4 }\n";
    MemoryFiles files;
    files.add("scene.pup", text);
    made.scene = must(load(files, "scene.pup"));
    return made;
}

// By how much joints jump where one tick of the clock (1.4 ns) ends a movement and the next begins.
double jump_m(const Performed& p, const figure::Figure& figure, SimTime at) {
    std::vector<Transform> world[3];
    figure::Pose pose;
    for (int i = 0; i < 3; ++i) {
        p.performance->pose({0}, SimTime{at.ticks + i - 1}, pose);
        world[i].resize(figure.skeleton.joints.size());
        figure::to_model_space(figure.skeleton, pose, world[i]);
    }
    double jump = 0;
    for (std::size_t j = 0; j < world[0].size(); ++j) {
        jump = std::max(jump, length(world[2][j].translation - world[1][j].translation * 2 +
                                     world[0][j].translation));
    }
    return jump;
}

}  // namespace

TEST_CASE(
    "any four movements of any durations join without a jump, within limits and above the "
    "floor [law]") {
    const int kSequences = std::getenv("PUPPETRI_LONG") != nullptr ? 200 : 40;
    const figure::Figure figure = figure::make_mannequin(1.75);
    int joins = 0;
    for (int seed = 0; seed < kSequences; ++seed) {
        const Sequence s = sequence_of(static_cast<std::uint64_t>(seed));
        CAPTURE(seed);
        CAPTURE(s.story);
        const Performed p = performed(s.scene);
        for (const stage::ScoreEntry& row : p.performance->score()) {
            if (row.start > SimTime{0}) {
                ++joins;
                CAPTURE(row.place);
                CHECK(jump_m(p, figure, row.start) < 1e-8);  // the table: 1e-6 m
            }
        }
        const test::Measures m = measured(p, s.scene);
        CHECK(m.limit_excess_deg.value < 1e-4);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.swing_sink_mm.value < 2);
    }
    CHECK(joins >= 4 * kSequences);
}
