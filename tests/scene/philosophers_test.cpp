// SPDX-License-Identifier: MIT
// The dining philosophers: the net is the listed one, no prop jumps, whoever eats has both forks,
// and the motion holds its table.
#include <doctest/doctest.h>

#include <map>

#include "measured.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

SimTime at(double t_s) { return {static_cast<std::int64_t>(t_s * kTicksPerSecond)}; }

// I(t) and O(t) of S = <P, T, I, O>, by the rule behind the list.
std::map<std::string, std::multiset<std::string>> listed(bool outputs) {
    std::map<std::string, std::multiset<std::string>> arcs;
    const auto p = [](int i) { return "p" + std::to_string(i); };
    for (int i = 0; i < 5; ++i) {
        const std::multiset<std::string> all{p(2 * i), p(2 * i + 1), p((2 * i + 2) % 10)};
        for (int level = 0; level < 4; ++level) {
            const std::string t = "t" + std::to_string(5 * level + i);
            arcs[t] = outputs ? level == 3 ? all : std::multiset<std::string>{p(10 + 5 * level + i)}
                      : level == 0 ? all
                                   : std::multiset<std::string>{p(5 + 5 * level + i)};
        }
    }
    return arcs;
}

void moves_well(const Performed& p, const Scene& scene, double end_s) {
    for (std::uint32_t who = 0; who < 5; ++who) {
        check_good(measured(p, scene, who, 0, end_s), scene.play.cast.actors[who].name);
    }
}

}  // namespace

TEST_CASE("the net has the places, transitions, inputs and outputs of the list [oracle]") {
    const Scene scene = example("09_philosophers/listed.pup");
    CHECK(scene.draft.places.size() == 25);
    CHECK(scene.draft.transitions.size() == 20);
    const auto inputs = listed(false), outputs = listed(true);
    for (const net::TransitionDraft& t : scene.draft.transitions) {
        std::multiset<std::string> in, out;
        for (const net::ArcDraft& arc : t.inputs) {
            in.insert(scene.draft.places[arc.place.value].path);
        }
        for (const net::OutputDraft& arc : t.outputs) {
            out.insert(scene.draft.places[arc.place.value].path);
        }
        CHECK(in == inputs.at(t.path));
        CHECK(out == outputs.at(t.path));
    }
    for (std::size_t i = 0; i < 25; ++i) {
        CHECK(scene.draft.places[i].tokens.size() == (i < 10 ? 1u : 0u));
    }
}

TEST_CASE("with keyframes alone and out of a foreign tuple file the philosophers move well [law]") {
    for (const char* name : {"listed.pup", "foreign.pup"}) {
        const Scene scene = example(std::string("09_philosophers/") + name);
        const Performed p = performed(scene);
        CHECK_MESSAGE(p.notes.empty(), told(p.notes));
        moves_well(p, scene, 6);
    }
}

TEST_CASE("whoever eats has two forks in his hands, and they lie as they lay afterwards [law]") {
    const Scene scene = example("09_philosophers/dinner.pup");
    const Performed p = performed(scene);
    CHECK_MESSAGE(p.notes.empty(), told(p.notes));
    const stage::Performance& shown = *p.performance;
    const auto prop = [&](const std::string& name) {
        for (std::uint32_t i = 0; i < shown.props().size(); ++i) {
            if (shown.props()[i].name == name) {
                return stage::PropIndex{i};
            }
        }
        FAIL("no prop " << name);
        return stage::PropIndex{};
    };
    int eaten = 0;
    for (const stage::ScoreEntry& row : shown.score()) {
        if (row.movement != "EATING2") {
            continue;
        }
        ++eaten;
        const int who = row.actor.back() - '0';
        const std::string left = "fork" + std::to_string(who),
                          right = "fork" + std::to_string(who % 5 + 1);
        CHECK(shown.holder(prop(left), row.start) == row.actor + ".left_hand");
        CHECK(shown.holder(prop(right), row.start) == row.actor + ".right_hand");
    }
    CHECK(eaten >= 8);
    // A fork never jumps: 4 m/s at most, and at rest it lies where it lay first, to two
    // millimetres.
    for (int k = 1; k <= 5; ++k) {
        const stage::PropIndex fork = prop("fork" + std::to_string(k));
        const Transform first = shown.world_from_prop(fork, at(0));
        Vec3 last = first.translation;
        for (double t = 0; t < 20; t += 1 / 240.0) {
            const Transform now = shown.world_from_prop(fork, at(t));
            CHECK(length(now.translation - last) < 4 / 240.0);
            last = now.translation;
            if (shown.holder(fork, at(t)) == "floor") {
                CHECK(length(now.translation - first.translation) < 0.002);
                CHECK(std::fabs((conjugate(now.rotation) * first.rotation).w) > std::cos(0.02));
            }
        }
    }
    moves_well(p, scene, 12);
}

TEST_CASE("a hand that is full, or that has nothing, is told [unit]") {
    const std::string cast =
        "language 1\nscene \"s\"\nuntil 9 s\ncast {\n ana: mannequin\n"
        " cup: cylinder { diameter 7 cm, height 10 cm, at (-0.2, 0.9, 0.4) m }\n"
        " far: box { at (0, 0.9, 3) m }\n}\n";
    const auto codes = [&](const std::string& net) {
        MemoryFiles files;
        files.add("scene.pup", cast + net);
        const Scene scene = must(load(files, "scene.pup"));
        std::string out;
        for (const Diagnostic& d : performed(scene).notes) {
            out += d.code + " ";
        }
        return out;
    };
    CHECK(codes("place a does ana.take(cup) tokens 1\n") == "");
    CHECK(codes("place a does ana.take(far) tokens 1\n") == "out-of-reach ");
    CHECK(codes("place a does ana.lay(cup, at: (0, 1, 0.3) m) tokens 1\n") == "not-held ");
    CHECK(codes("place a does ana.take(cup) tokens 1\nplace b does ana.lay(cup, at: (0, 1, 4) m)\n"
                "t: a -> b\n") == "out-of-reach ");
}
