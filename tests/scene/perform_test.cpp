// SPDX-License-Identifier: MIT
// Performing over long times: what a run costs is what happens in it.
#include "puppetri/scene/perform.h"

#include <doctest/doctest.h>

#include "puppetri/scene/scene.h"

namespace puppetri::scene {
namespace {

constexpr const char* kShop = R"(scene "Somebody comes every hour"
until 100 h
place door takes 1 h tokens 1
place chair takes 20 min
come: door  -> door + chair
go:   chair ->
)";

struct Asked {
    int times = 0, at_most = 1'000'000;
    double share = 0;
    static bool go_on(void* context, double share_done) {
        auto& asked = *static_cast<Asked*>(context);
        CHECK(share_done >= asked.share);
        asked.share = share_done;
        return ++asked.times < asked.at_most;
    }
};

Scene loaded() {
    MemoryFiles files;
    files.add("shop.pup", kShop);
    return load(files, "shop.pup").value();
}

}  // namespace

TEST_CASE("a run in which little happens is asked rarely whether it goes on, however long it is") {
    const Scene scene = loaded();
    const auto alone = perform(scene);
    REQUIRE(alone.has_value());
    CHECK(alone->firings == 100 + 99);  // the last to come is still there
    Asked asked;
    const auto watched = perform(scene, {.go_on = Asked::go_on, .context = &asked});
    REQUIRE(watched.has_value());
    CHECK(watched->log_hash == alone->log_hash);
    CHECK(watched->end == alone->end);
    CHECK(asked.times < 1000);  // 7.2 million twentieths of a second
    // Ten times as long, asked three or four times more often: intervals grow
    Asked longer;
    const auto ten = perform(scene, {.horizon = {.time = SimTime{3600'000 * kTicksPerSecond}},
                                     .go_on = Asked::go_on,
                                     .context = &longer});
    REQUIRE(ten.has_value());
    CHECK(ten->firings == 1000 + 999);
    CHECK(longer.times < 1000);
}

TEST_CASE("who is asked may end a run, which then has what came before") {
    const Scene scene = loaded();
    Asked asked{.at_most = 3};
    const auto part = perform(scene, {.go_on = Asked::go_on, .context = &asked});
    REQUIRE(part.has_value());
    CHECK(part->interrupted);
    CHECK(asked.times == 3);
    CHECK(part->end < SimTime{3600 * kTicksPerSecond});
}

}  // namespace puppetri::scene
