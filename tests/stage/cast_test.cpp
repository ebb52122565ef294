// SPDX-License-Identifier: MIT
// A cast is checked as a whole: all its defects come at once.
#include "puppetri/stage/cast.h"

#include <algorithm>

#include "doctest/doctest.h"

using namespace puppetri;
using namespace puppetri::stage;

namespace {
bool has(const Diagnostics& list, const char* code) {
    return std::any_of(list.begin(), list.end(),
                       [&](const Diagnostic& d) { return d.code == code; });
}
}  // namespace

TEST_CASE("the cast of the ball game is fine [unit]") {
    Cast cast;
    cast.actors = {{.name = "ana", .position_world = {-1.5, 0, 0}},
                   {.name = "rui", .height_m = 1.68}};
    cast.props = {{.name = "ball", .held_by = ActorIndex{0}}};
    cast.sets = {{.name = "road", .kind = SetKind::kRoad, .length_m = 60}};
    CHECK(check(cast).empty());
}

TEST_CASE("all defects of a cast are told at once [unit]") {
    Cast cast;
    cast.actors = {{.name = "ana", .height_m = 30}, {.name = "ana", .position_world = {0, 1, 0}}};
    cast.props = {{.name = "", .size_m = {0, 0, 0}},
                  {.name = "bar", .mass_kg = -1, .held_by = ActorIndex{7}}};
    cast.sets = {{.name = "road", .length_m = -3}};
    const Diagnostics found = check(cast);
    for (const char* code : {"height-out-of-range", "name-used-twice", "not-on-floor", "no-name",
                             "size-out-of-range", "mass-out-of-range", "unknown-holder"}) {
        CHECK_MESSAGE(has(found, code), code);
    }
    for (const Diagnostic& d : found) {
        CHECK(d.severity == Severity::kError);
        CHECK(!d.remedy.empty());
    }
}

TEST_CASE("two hands hold one ball, and no box [unit]") {
    Cast cast;
    cast.actors = {{.name = "ana"}};
    cast.props = {{.name = "a", .held_by = ActorIndex{0}}, {.name = "b", .held_by = ActorIndex{0}}};
    CHECK(has(check(cast), "hands-full"));
    cast.props = {{.name = "chest",
                   .shape = PropShape::kBox,
                   .size_m = {0.3, 0.3, 0.3},
                   .held_by = ActorIndex{0}}};
    CHECK(has(check(cast), "cannot-hold"));
}
