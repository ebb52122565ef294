// SPDX-License-Identifier: MIT
// The two legs and their controller walk as the net of the walk does: the same score and the same
// poses, for every number of steps.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "puppetri/scene/perform.h"
#include "puppetri/stage/performance.h"

using namespace puppetri;

namespace {

std::string example_text(const std::string& name) {
    std::ifstream file(PUP_SOURCE_DIR "/examples/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Walk {
    std::unique_ptr<scene::Scene> scene;
    scene::Performed performed;
};

Walk walk(const std::string& body) {
    scene::MemoryFiles files;
    files.add("walk.pup", example_text("02_walk/walk.pup"));
    files.add("machines.pup", example_text("10_two_legs/machines.pup"));
    files.add("main.pup",
              "language 1\nscene \"test\"\nframes 24 per second\nuntil 8 s\n"
              "cast { ana: mannequin { at (0, 0, -1) m } }\n" +
                  body);
    auto loaded = scene::load(files, "main.pup");
    REQUIRE(loaded.has_value());
    Walk out{std::make_unique<scene::Scene>(std::move(*loaded)), {}};
    auto performed = scene::perform(*out.scene);
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    out.performed = std::move(*performed);
    return out;
}

std::string machines(const std::string& controller, int steps) {
    return "import Phase, Command, leg, " + controller +
           " from \"machines.pup\"\n"
           "channel l of Command\nchannel r of Command\nchannel sl of Phase\nchannel sr of "
           "Phase\n"
           "use leg(ana, left, 18 frames, 0.5 m, l, sl) as left_leg\n"
           "use leg(ana, right, 18 frames, 0.5 m, r, sr) as right_leg\n"
           "use " +
           controller + "(" + std::to_string(steps) + ", l, r, sl, sr)\n";
}

}  // namespace

TEST_CASE("two legs and a controller have the score of the net of the walk [agree]") {
    for (int steps = 1; steps <= 6; ++steps) {
        const Walk net =
            walk("import walk from \"walk.pup\"\nplace w runs walk(ana, steps: " +
                 std::to_string(steps) +
                 ", n: 18 frames, x: 0.5 m) tokens 1\nplace there\nends: w -> there\n");
        for (const char* controller : {"controller", "waiting_controller"}) {
            CAPTURE(controller);
            CAPTURE(steps);
            const Walk legs = walk(machines(controller, steps));
            const auto wanted = net.performed.performance->score();
            const auto got = legs.performed.performance->score();
            REQUIRE(got.size() == wanted.size());
            REQUIRE(got.size() == static_cast<std::size_t>(steps) + 1);
            for (std::size_t i = 0; i < got.size(); ++i) {
                CHECK(got[i].start == wanted[i].start);
                CHECK(got[i].end == wanted[i].end);
                CHECK(got[i].movement == wanted[i].movement);
                CHECK(got[i].actor == wanted[i].actor);
                CHECK(got[i].limbs == wanted[i].limbs);
            }
            // And the figure stands alike at every moment: strokes and sides are the same.
            figure::Pose one, other;
            double worst = 0;
            for (int k = 0; k <= 8 * 60; ++k) {
                const SimTime at{k * (kTicksPerSecond / 60)};
                net.performed.performance->pose({0}, at, one);
                legs.performed.performance->pose({0}, at, other);
                REQUIRE(one.parent_from_joint.size() == other.parent_from_joint.size());
                for (std::size_t j = 0; j < one.parent_from_joint.size(); ++j) {
                    const Transform& a = one.parent_from_joint[j];
                    const Transform& b = other.parent_from_joint[j];
                    for (const double d :
                         {a.rotation.x - b.rotation.x, a.rotation.y - b.rotation.y,
                          a.rotation.z - b.rotation.z, a.rotation.w - b.rotation.w,
                          a.translation.x - b.translation.x, a.translation.y - b.translation.y,
                          a.translation.z - b.translation.z}) {
                        worst = std::max(worst, std::fabs(d));
                    }
                }
            }
            CHECK(worst == 0);
        }
    }
}
