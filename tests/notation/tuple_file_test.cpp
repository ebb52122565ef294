// SPDX-License-Identifier: MIT
// Tuple files of others drive figures: the example of the paper, its defects, and a file written
// from tuples that is read back.
#include <algorithm>

#include "playing.h"
#include "puppetri/notation/foreign_file.h"
#include "puppetri/notation/keyframe_tuples.h"

namespace puppetri::notation {
namespace {

constexpr const char* kScene = R"(language 1
scene "test"
frames 20 per second
import dinner from "dinner.tuples"
cast {
  ana: mannequin { at (-1, 0, 0) m }
  rui: mannequin { at (1, 0, 0) m }
}
keyframes lift(me: actor) {
  takes 1 s
  at 1 s: me.right_elbow.flex = 60 deg
}
use dinner(man1: ana, man3: rui, RESTING: idle(), EATING1: lift(), EATING2: lift()) as d
)";

scene::Scene scene_of(const std::string& tuples) {
    scene::MemoryFiles files;
    files.add("scene.pup", kScene);
    files.add("dinner.tuples", tuples);
    Checked<scene::Scene> loaded = scene::load(files, "scene.pup");
    if (!loaded) {
        FAIL(told(loaded.error()));
    }
    return std::move(*loaded);
}

TEST_CASE("a place of an object lasts until its tuple says that the keyframe is reached [unit]") {
    // The lines of the paper, as they are printed.
    const scene::Scene scene = scene_of(
        "40 man3 RESTING\n45 man1 RESTING\n46 man3 EATING1\n65 man1 EATING1\n74 man3 EATING2\n"
        "82 man3 EATING1\n85 man1 EATING2\n89 man1 EATING1\n90 man3 RESTING\n");
    // What happens at one instant comes in an order that chance decides.
    std::vector<std::string> log = log_of(scene, 100);
    REQUIRE(log.size() == 9);
    std::sort(log.begin(), log.begin() + 2);
    CHECK(log == std::vector<std::string>{
                     "0 s d.man1_to_45", "0 s d.man3_to_40", "2 s d.man3_to_46",
                     "2.25 s d.man1_to_65", "2.3 s d.man3_to_74", "3.25 s d.man1_to_85",
                     "3.7 s d.man3_to_82", "4.1 s d.man3_to_90", "4.25 s d.man1_to_89"});
    const net::PlaceIndex last = scene.net.find_place("d.man1_89");
    REQUIRE(last.valid());
    CHECK(scene.net.place(last).caption == "EATING1");
    CHECK(scene.net.place(last).where.file == "dinner.tuples");
    CHECK(scene.net.place(last).where.line == 8);
    run::Player player(scene.net);
    CHECK(player.run({.until = {100 * kTicksPerSecond}}) == run::Stop::kFinal);
}

TEST_CASE("the order of lines in a tuple file says nothing [law]") {
    const char* sorted = "10 man1 RESTING\n20 man3 EATING1\n30 man1 EATING2\n";
    const char* mixed = "30 man1 EATING2\n20 man3 EATING1\n\n# a comment\n10 man1 RESTING\n";
    // Parameters come in the order of the file; the runs are the same.
    auto a = log_of(scene_of(sorted), 9), b = log_of(scene_of(mixed), 9);
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    CHECK(a == b);
}

TEST_CASE("defects of a tuple file are told by its own lines [unit]") {
    const auto codes = [](const char* tuples) {
        std::string out;
        for (const Diagnostic& d : parse(tuples, "a/dinner.tuples", 0).diagnostics) {
            CHECK(d.where.file == "a/dinner.tuples");
            out += d.code + ":" + std::to_string(d.where.line) + " ";
        }
        return out;
    };
    CHECK(codes("1 man1 A\n2 man1\n") == "bad-tuple:2 ");
    CHECK(codes("1 man1 A\n1 man1 B\n") == "bad-tuple:2 ");
    CHECK(codes("1 begin B\n") == "name-twice:1 ");
    CHECK(codes("1 A B\n2 B A\n") == "name-twice:1 name-twice:2 ");
    CHECK(codes("0 man1 A\n9 man1 B\n") == "late-keyframe:1 ");
    CHECK(codes("\xff\n") == "invalid-utf8:1 ");
    CHECK(codes("") == "");
}

TEST_CASE("formats are found by their endings, in alphabetical order [unit]") {
    std::string_view before;
    for (const ForeignFormat& f : foreign_formats()) {
        CHECK(before < f.ending);
        CHECK(find_foreign_format("x/y" + std::string(f.ending)) == &f);
        before = f.ending;
    }
    CHECK(find_foreign_format("scene.pup") == nullptr);
    CHECK(find_foreign_format(".tuples") == nullptr);
}

}  // namespace
}  // namespace puppetri::notation
