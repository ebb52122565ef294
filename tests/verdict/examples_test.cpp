// SPDX-License-Identifier: MIT
// The examples: what is right is proved, the seeded bugs are refuted where SCENES says they are.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "puppetri/run/player.h"
#include "puppetri/verdict/explain.h"
#include "puppetri/verdict/prove.h"
#include "support/proof_scenes.h"

namespace puppetri::verdict {
namespace {

class Disk final : public scene::FileSource {
 public:
    Result<std::string, scene::FileProblem> read(const std::string& path) override {
        std::ifstream file(path, std::ios::binary);
        if (!file) {
            return Unexpected(scene::FileProblem{"there is no such file"});
        }
        return std::string(std::istreambuf_iterator<char>(file), {});
    }
};

struct Example {
    explicit Example(const std::string& name) {
        auto loaded = scene::load(files, std::string(PUP_SOURCE_DIR "/examples/") + name);
        REQUIRE_MESSAGE(loaded.has_value(), name);
        scene.emplace(std::move(*loaded));
        ProveOptions options;
        options.budget.seconds = 20;
        verdicts = prove(*scene, options);
    }
    const Verdict& of(const std::string& rule) const {
        const auto found = std::find_if(verdicts.begin(), verdicts.end(),
                                        [&](const Verdict& v) { return v.rule == rule; });
        REQUIRE_MESSAGE(found != verdicts.end(), rule);
        return *found;
    }
    Disk files;
    std::optional<scene::Scene> scene;
    std::vector<Verdict> verdicts;
};

// The places that are marked after the last firing of a witness.
std::vector<std::string> marked_at_end(const scene::Scene& scene, const Witness& w) {
    stage::Stage stage(scene.play);
    net::ScriptedChooser chooser(w.choices);
    run::Player player(scene.net, {.seed = w.seed, .host = &stage, .chooser = &chooser});
    while (player.firings() < w.steps.size() && player.step() == run::Stop::kNone) {
    }
    std::vector<std::string> out;
    for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
        if (player.tokens(net::PlaceIndex{p}) > 0) {
            out.emplace_back(scene.net.place(net::PlaceIndex{p}).path);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST_CASE("every rule of the walk and of the ball game is proved [agree]") {
    for (const char* name : {"02_walk/twice.pup", "02_walk/figure.pup", "02_walk/limbs.pup",
                             "03_ball/ball.pup", "03_ball/figure5.pup"}) {
        const Example e(name);
        for (const Verdict& v : e.verdicts) {
            CHECK_MESSAGE(v.answer == Answer::kProved,
                          name << ": " << v.rule << " " << name_of(v) << " " << v.reason);
        }
    }
}

TEST_CASE("what a tuple space and an event graph say of their figures is proved [agree]") {
    for (const char* name : {"19_tuple_space/yard.pup", "11_barber_shop/events.pup"}) {
        const Example e(name);
        for (const Verdict& v : e.verdicts) {
            if (v.rule.rfind("builtin.", 0) != 0) {
                CHECK_MESSAGE(v.answer == Answer::kProved,
                              name << ": " << v.rule << " " << name_of(v) << " " << v.reason);
            }
        }
    }
}

TEST_CASE("throwing without looking is refuted: P9 fills up [agree]") {
    const Example e("03_ball/impatient.pup");
    CHECK_MESSAGE(e.of("bounds").answer == Answer::kRefuted, e.of("bounds").reason);
    REQUIRE(e.of("bounds").witness.has_value());
    // It is P9 that has a second token, after t9 has fired a second time.
    CHECK(e.of("bounds").witness->steps.back().transition == "t9");
    // Without a number it is refuted as well, for every timing; a run shows the beginning.
    CHECK_MESSAGE(e.of("fills_up").answer == Answer::kRefuted, e.of("fills_up").reason);
    CHECK(e.of("fills_up").reason.find("place P9 grows without end") != std::string::npos);
    REQUIRE(e.of("fills_up").witness.has_value());
    // Nothing tests how many P9 has, so all else is known. Untimed ready_a fails as well; in these
    // times rui is always ready before ana throws.
    for (const Verdict& v : e.verdicts) {
        // How movements join is another matter: runs show it, as far as there is time.
        if (v.rule != "bounds" && v.rule != "fills_up" &&
            v.rule.find("movements_join") == std::string::npos) {
            CHECK_MESSAGE(v.answer == Answer::kProved,
                          v.rule << " " << name_of(v) << " " << v.reason);
        }
    }
}

TEST_CASE("two balls end dead with both about to throw [agree]") {
    const Example e("03_ball/two_balls.pup");
    REQUIRE(e.of("goes_on").answer == Answer::kRefuted);
    CHECK(marked_at_end(*e.scene, *e.of("goes_on").witness) ==
          std::vector<std::string>{"a.to_throw", "b.to_throw"});
}

TEST_CASE("without a ball both are ready to grasp, for ever [agree]") {
    const Example e("03_ball/no_ball.pup");
    REQUIRE(e.of("goes_on").answer == Answer::kRefuted);
    CHECK(marked_at_end(*e.scene, *e.of("goes_on").witness) ==
          std::vector<std::string>{"a.can_grasp", "a.to_get", "b.can_grasp", "b.to_get"});
}

TEST_CASE("the duet goes on while two are frozen; explained, repaired, proved [agree]") {
    const Example e("05_duet/duet.pup");
    CHECK(e.of("goes_on").answer == Answer::kProved);
    const Verdict& frozen = e.of("everybody");
    REQUIRE_MESSAGE(frozen.answer == Answer::kRefuted, frozen.reason);
    REQUIRE(frozen.witness.has_value());
    const Explanation why = explain(*e.scene, frozen);
    REQUIRE(why.waits.size() == 2);
    // The witness ends when nothing can help any more; both are told where they will wait.
    CHECK(why.waits[0].place.find("ana_waits") == 0);
    CHECK(why.waits[0].missing.find("carpet_free") == 0);
    CHECK(why.waits[0].taken_by.find("rui_goes") == 0);
    CHECK(why.waits[1].place.find("rui_opens") == 0);
    CHECK(why.waits[1].missing.find("to_rui") == 0);
    CHECK(why.waits[1].taken_by.empty());
    Disk files;
    const RepairAnswer answer = repair(files, *e.scene, e.verdicts, "everybody", {});
    REQUIRE_MESSAGE(answer.repair.has_value(), answer.reason);
    for (const Verdict& v : answer.repair->proved) {
        CHECK_MESSAGE(v.answer == Answer::kProved, v.rule << " " << v.reason);
    }
    const Example repaired("05_duet/repaired.pup");
    for (const Verdict& v : repaired.verdicts) {
        CHECK_MESSAGE(v.answer == Answer::kProved, v.rule << " " << v.reason);
    }
}

TEST_CASE("never both legs in the transfer state: proved of each form of the machines [agree]") {
    for (const char* name : {"10_two_legs/two_legs.pup", "10_two_legs/waiting.pup",
                             "10_two_legs/sampled.pup", "10_two_legs/legs.tookima"}) {
        const Example e(name);
        for (const Verdict& v : e.verdicts) {
            CHECK_MESSAGE(v.answer == Answer::kProved, std::string(name)
                                                           << ": " << v.rule << " " << name_of(v)
                                                           << " " << v.reason);
        }
    }
}

// Whispers are sent at times that belong to the notation; nobody else makes them come.
TEST_CASE("whispers go on for ever, and so does everybody who passes them on [agree]") {
    const Example e("15_whispers/whispers.pup");
    for (const Verdict& v : e.verdicts) {
        CHECK_MESSAGE(v.answer == Answer::kProved, v.rule << " " << name_of(v) << " " << v.reason);
    }
}

TEST_CASE("the machines as printed: time does not go on, and samples see a leg too late [agree]") {
    const Example literal("10_two_legs/literal.pup");
    CHECK(literal.of("builtin.time_goes_on").answer == Answer::kRefuted);
    CHECK(std::any_of(literal.scene->notes.begin(), literal.scene->notes.end(),
                      [](const Diagnostic& d) { return d.code == "zero-time-poll"; }));
    // In the manner of the printed script: legs report at every instant, so that the controller
    // takes a report from before its own command for news.
    scene::MemoryFiles files;
    files.add("reports.tookima", R"(DEF_ESM(CTRL, "L1") DEF_ESM(LEFT, "SL") DEF_ESM(RIGHT, "SR")
DEF_EVENT(BL) DEF_EVENT(BR) DEF_CHANNEL(ML) DEF_CHANNEL(MR) DEF_CHANNEL(CL) DEF_CHANNEL(CR)
TIME_INTERVAL(0., 11.) SAMPLES(12) FUNCTION(go_left) FUNCTION(go_right)
START_SIMULATION
BEGIN_ESM(CTRL) CHANNEL(ML) CHANNEL(MR) CHANNEL(CL) CHANNEL(CR)
ACTION(CTRL, "L1", MATCH(ML, "SL"), CR="AR", "L2")
ACTION(CTRL, "L2", MATCH(MR, "SR"), CL="AL", "L1")
END_ESM
BEGIN_ESM(LEFT) CHANNEL(ML) CHANNEL(CL) EVENT(BL)
ACTION(LEFT, "SL", MATCH(CL, "AL"), go_left(), "TL")
ACTION(LEFT, "SL", TRUE, ML=LEFT, "SL")
ACTION(LEFT, "TL", BL, NO_TASK, "SL")
ACTION(LEFT, "TL", TRUE, ML=LEFT, "TL")
END_ESM
BEGIN_ESM(RIGHT) CHANNEL(MR) CHANNEL(CR) EVENT(BR)
ACTION(RIGHT, "SR", MATCH(CR, "AR"), go_right(), "TR")
ACTION(RIGHT, "SR", TRUE, MR=RIGHT, "SR")
ACTION(RIGHT, "TR", BR, NO_TASK, "SR")
ACTION(RIGHT, "TR", TRUE, MR=RIGHT, "TR")
END_ESM
END_SIMULATION
)");
    files.add("main.pup", R"(language 1
scene "as printed"
cast { ana: mannequin }
use "reports.tookima" as legs {
  LEFT:  ana.left_leg
  RIGHT: ana.right_leg
}
rule specification never (legs.LEFT.TL and legs.RIGHT.TR)
)");
    const auto scene = scene::load(files, "main.pup");
    REQUIRE(scene.has_value());
    ProveOptions options;
    options.budget.seconds = 20;
    for (const Verdict& v : prove(*scene, options)) {
        if (v.rule == "specification") {
            CHECK_MESSAGE(v.answer == Answer::kRefuted, name_of(v) << " " << v.reason);
        }
    }
}

TEST_CASE(
    "many pairs and a ring of balls with identity are proved part by part and by theorems "
    "[agree]") {
    scene::MemoryFiles files;
    files.add("pairs.pup", made::pairs_of_players(10));
    files.add("ring.pup", made::ring_of_players(100, 10));
    for (const char* name : {"pairs.pup", "ring.pup"}) {
        const auto scene = scene::load(files, name);
        REQUIRE(scene.has_value());
        ProveOptions options;
        options.budget.seconds = 20;
        const std::vector<Verdict> verdicts = prove(*scene, options);
        std::uint64_t states = 0;
        for (const Verdict& v : verdicts) {
            CHECK_MESSAGE(v.answer == Answer::kProved, std::string(name)
                                                           << ": " << v.rule << " " << v.reason);
            states = std::max(states, v.states);
        }
        // Never the product of the parts.
        CHECK(states < 10'000);
    }
}

}  // namespace
}  // namespace puppetri::verdict
