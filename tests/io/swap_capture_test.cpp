// SPDX-License-Identifier: MIT
// The eighth technique of scene/swap_test.cpp: somebody else's captured motion, read from a BVH
// file and retargeted onto the figure, greets under the same net with the same log.
#include <doctest/doctest.h>

#include <string>

#include "io/scene_files.h"
#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/take.h"
#include "scene/greeting_net.h"
#include "scene/measured.h"

using namespace puppetri;
using namespace puppetri::io::testing;

namespace {

// A man of 1.92 m bows; as a file of other programs.
std::string small_capture() {
    SceneFiles files(
        "language 1\nscene \"capture\"\nframes 60 per second, until 3 s\ncast { tom: mannequin { "
        "height 1.92 m, at (3, 0, 1) m, facing 30 deg } }\nplace p does tom.bow() takes 2.4 s "
        "tokens 1\nend { p }\n");
    const scene::Scene scene = scene::must(scene::load(files, "scene.pup"));
    const scene::Performed p = scene::performed(scene);
    auto take = io::sample_take(*p.performance, {.rate = {60, 1}, .root = io::RootMode::kHips});
    REQUIRE(take.has_value());
    return io::make_bvh(*take, 0, {});
}

// The log of the net, the greeting a clip with these properties. Where `whole` is set feet and
// travel are the capture's too: it starts with a stance of its own, and the table is not asked for.
std::uint64_t log_of(const std::string& file, const std::string& properties, bool whole = false) {
    SceneFiles files(
        test::greeting_with("hail()", "clip hail { from \"" + file + "\", " + properties +
                                          (whole ? "" : ", only arms and body") + " }\n"));
    files.add("tom.bvh", small_capture());
    const scene::Scene scene = scene::must(scene::load(files, "scene.pup"));
    const scene::Performed p = scene::performed(scene);
    if (!whole) {
        scene::check_good(scene::measured(p, scene, 0), file);
    }
    return p.log_hash;
}

}  // namespace

TEST_CASE("a capture of somebody else greets under the same net, with the same log [agree]") {
    SceneFiles plain(test::greeting_with("reach((0, 1.3, 0.2) m)"));
    const scene::Scene reach = scene::must(scene::load(plain, "scene.pup"));
    const std::uint64_t log = scene::performed(reach).log_hash;
    for (const bool whole : {false, true}) {
        CHECK(log_of("tom.bvh", "cut 0 s .. 2.4 s", whole) == log);
        if (there("cmu_01_01.bvh")) {
            CHECK(log_of(kMotion + "cmu_01_01.bvh", "scale 0.0564, cut 3 s .. 5.4 s", whole) ==
                  log);
        }
    }
}
