// SPDX-License-Identifier: MIT
#include "puppetri/base/frame_rate.h"

#include <doctest/doctest.h>

#include <limits>

using namespace puppetri;

TEST_CASE("frame rates are read as exact ratios [unit]") {
    CHECK(parse_frame_rate("24") == FrameRate{24, 1});
    CHECK(parse_frame_rate("23.976") == FrameRate{24000, 1001});
    CHECK(parse_frame_rate("29.97") == FrameRate{30000, 1001});
    CHECK(parse_frame_rate("60000/1001") == FrameRate{60000, 1001});
    CHECK(parse_frame_rate("12.5") == FrameRate{25, 2});
    CHECK(parse_frame_rate("48/2") == FrameRate{24, 1});
    for (const char* bad : {"", "0", "-24", "24fps", "1e2", "24/0", "/", "24/", "..5", "1001",
                            "99999999999999999999"}) {
        CHECK_MESSAGE(!parse_frame_rate(bad), bad);
    }
    CHECK(parse_frame_rate(to_string({24000, 1001})) == FrameRate{24000, 1001});
}

TEST_CASE("frames and instants agree, at every rate and after hours [law]") {
    for (const FrameRate rate : {FrameRate{24, 1}, FrameRate{24000, 1001}, FrameRate{30000, 1001},
                                 FrameRate{120, 1}, FrameRate{25, 2}, FrameRate{7, 3}}) {
        for (const std::int64_t frame : {0, 1, 2, 23, 24, 25, 959, 960, 86'400, 9'999'999}) {
            const SimTime at = rate.time_of(frame);
            CHECK(rate.frame_at_or_before(at) == frame);
            if (frame > 0) {
                CHECK(rate.frame_at_or_before({at.ticks - 1}) == frame - 1);
            }
            CHECK(rate.nearest_frame(at) == frame);
            CHECK(rate.nearest_frame({at.ticks + 1000}) == frame);
        }
    }
    // One hour of 23.976: 86 400 frames take an hour and 3.6 seconds, to the tick.
    CHECK(FrameRate{24000, 1001}.time_of(86'400).ticks ==
          3603 * kTicksPerSecond + kTicksPerSecond * 6 / 10);
}

TEST_CASE("a frame that no tick can count has no time [unit]") {
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    CHECK_FALSE(FrameRate{24, 1}.time_of_frame(-1));
    CHECK_FALSE(FrameRate{24, 1}.time_of_frame(most));
    CHECK_FALSE(FrameRate{24000, 1001}.time_of_frame(most / 1001));
    CHECK_FALSE(FrameRate{1, 1'000'000'000}.time_of_frame(100));
    CHECK(FrameRate{1, 1'000'000'000}.time_of_frame(10) ==
          SimTime{10'000'000'000 * kTicksPerSecond});
    // Three frames in 7 seconds: frame 1 is at 7/3 s = 1 646 400 000 ticks.
    CHECK(FrameRate{3, 7}.time_of_frame(1) == SimTime{1'646'400'000});
}
