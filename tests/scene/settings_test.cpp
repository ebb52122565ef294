// SPDX-License-Identifier: MIT
#include "puppetri/scene/settings.h"

#include <doctest/doctest.h>

#include <vector>

namespace puppetri::scene {
namespace {

constexpr const char* kScene = R"(scene "Sweeps"
seed 7
until 1 min

data level: 0 .. 9 = 4   # comments stay
data plain: 0 .. 9

net shop(arrival: time, service = 20 s, chairs = 3) { place door tokens 1 }
net bare(x = 1) { place door tokens 1 }

use shop(10 s, chairs: 4) as barber
use bare
place chair  takes 2 s  tokens 1
place empty
)";

std::string set(const std::string& path, const std::string& value) {
    const Setting s{path, value};
    auto text = with_settings(kScene, "sweeps.pup", {&s, 1});
    REQUIRE(text.has_value());
    return *text;
}

// The scene with `before` replaced by `after`.
std::string changed(const std::string& before, const std::string& after) {
    std::string text = kScene;
    const std::size_t at = text.find(before);
    REQUIRE(at != std::string::npos);
    return text.replace(at, before.size(), after);
}

}  // namespace

TEST_CASE("a setting writes what an author would have written, and touches nothing else") {
    CHECK(set("seed", "8") == changed("seed 7", "seed 8"));
    CHECK(set("level", "5") == changed("= 4", "= 5"));
    CHECK(set("plain", "5") == changed("data plain: 0 .. 9", "data plain: 0 .. 9 = 5"));
    CHECK(set("barber.chairs", "6") == changed("chairs: 4", "chairs: 6"));
    CHECK(set("barber.arrival", "12 s") == changed("10 s", "12 s"));
    CHECK(set("barber.service", "exponential(9 s)") ==
          changed("chairs: 4", "chairs: 4, service: exponential(9 s)"));
    CHECK(set("bare.x", "2") == changed("use bare", "use bare(x: 2)"));
    CHECK(set("chair.takes", "1 .. 3 s") == changed("takes 2 s", "takes 1 .. 3 s"));
    CHECK(set("chair.tokens", "2") == changed("tokens 1\nplace empty", "tokens 2\nplace empty"));
    CHECK(set("empty.takes", "4 s") == changed("place empty", "place empty takes 4 s"));
}

TEST_CASE("several settings are one change") {
    const std::vector<Setting> both{{"level", "1"}, {"barber.chairs", "2"}};
    const auto text = with_settings(kScene, "sweeps.pup", both);
    REQUIRE(text.has_value());
    CHECK(text->find("= 1") != std::string::npos);
    CHECK(text->find("chairs: 2") != std::string::npos);
    const std::vector<Setting> meeting{{"bare.x", "2"}, {"bare.y", "3"}};
    const auto together = with_settings(kScene, "sweeps.pup", meeting);
    REQUIRE(together.has_value());
    CHECK(together->find("use bare(x: 2, y: 3)") != std::string::npos);
}

TEST_CASE("a name that is not there is told with those that are") {
    const std::vector<Setting> bad{{"barbr.chairs", "6"}, {"level", "3"}};
    const auto text = with_settings(kScene, "sweeps.pup", bad);
    REQUIRE_FALSE(text.has_value());
    REQUIRE(text.error().size() == 1);
    CHECK(text.error()[0].code == "unknown-setting");
    CHECK(text.error()[0].remedy.find("barber.chairs") != std::string::npos);
}

TEST_CASE("a value that is no expression is refused") {
    const std::vector<Setting> bad{{"level", "3 +"}};
    CHECK_FALSE(with_settings(kScene, "sweeps.pup", bad).has_value());
}

}  // namespace puppetri::scene
