// SPDX-License-Identifier: MIT
// What is claimed of movements before they are prepared must hold of those that are performed.
#include "puppetri/verdict/figure_lowering.h"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "puppetri/scene/perform.h"

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

TEST_CASE("no leg is ever in the air that its movement was said not to lift [law]") {
    for (const char* name : {"02_walk/twice.pup", "02_walk/limbs.pup", "03_ball/ball.pup",
                             "03_ball/figure5.pup", "03_ball/waits.pup"}) {
        Disk files;
        const auto scene = scene::load(files, std::string(PUP_SOURCE_DIR "/examples/") + name);
        REQUIRE_MESSAGE(scene.has_value(), name);
        scene::PerformOptions options;
        options.horizon.time = SimTime{20 * kTicksPerSecond};
        const auto performed = scene::perform(*scene, options);
        REQUIRE(performed.has_value());
        const stage::Performance& performance = *performed->performance;
        const auto actors = performance.actors();
        for (std::uint32_t a = 0; a < actors.size(); ++a) {
            for (std::int64_t t = 0; t < performance.duration().ticks; t += kTicksPerSecond / 240) {
                bool may_left = false, may_right = false, both = false;
                for (const stage::ScoreEntry& entry : performance.score()) {
                    if (entry.actor != actors[a].name || entry.start > SimTime{t} ||
                        entry.left <= SimTime{t}) {
                        continue;
                    }
                    for (const stage::Action& action : scene->play.actions) {
                        if (action.place == entry.place) {
                            const Swings s = swings_of(action.call, true);
                            both = both || s.both || (may_left && s.right) || (may_right && s.left);
                            may_left = may_left || s.left;
                            may_right = may_right || s.right;
                        }
                    }
                }
                const stage::ActorIndex actor{a};
                const bool left = performance.phase(actor, motion::Limb::kLeftLeg, SimTime{t}) ==
                                  motion::Phase::kSwing;
                const bool right = performance.phase(actor, motion::Limb::kRightLeg, SimTime{t}) ==
                                   motion::Phase::kSwing;
                REQUIRE_MESSAGE((!left || may_left), name << " " << t);
                REQUIRE_MESSAGE((!right || may_right), name << " " << t);
                REQUIRE_MESSAGE((!(left && right) || both), name << " " << t);
            }
        }
    }
}

}  // namespace
}  // namespace puppetri::verdict
