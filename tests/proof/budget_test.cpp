// SPDX-License-Identifier: MIT
// A budget ends a method for the reason that it gives.
#include "puppetri/proof/budget.h"

#include <doctest/doctest.h>

namespace puppetri::proof {
namespace {

TEST_CASE("each limit of a budget is told apart [unit]") {
    std::atomic<bool> cancelled{false};
    Budget budget{.seconds = 1000, .bytes = 100, .states = 10, .cancelled = &cancelled};
    Meter meter(budget, "test");
    CHECK(meter.look(10, 5, 0, 100) == Ended::kDone);
    CHECK(meter.look(11, 5, 0, 100) == Ended::kStates);
    CHECK(meter.look(10, 5, 0, 101) == Ended::kMemory);
    cancelled = true;
    CHECK(meter.look(10, 5, 0, 100) == Ended::kCancelled);
    CHECK(meter.seconds() >= 0);
    const Budget none{.seconds = 0};
    CHECK(Meter(none, "test").look(0, 0, 0, 0) == Ended::kTime);
}

TEST_CASE("progress is told to whoever listens, about ten times a second [unit]") {
    int told = 0;
    Budget budget;
    budget.context = &told;
    budget.progress = [](void* context, const Progress& p) {
        ++*static_cast<int*>(context);
        CHECK(p.states == 3);
        CHECK(p.seconds >= 0.1);
    };
    Meter meter(budget, "test");
    while (meter.seconds() < 0.15) {
        CHECK(meter.look(3, 0, 0, 0) == Ended::kDone);
    }
    CHECK(told == 1);
}

}  // namespace
}  // namespace puppetri::proof
