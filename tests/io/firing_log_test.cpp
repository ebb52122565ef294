// SPDX-License-Identifier: MIT
#include "puppetri/io/firing_log.h"

#include <doctest/doctest.h>

namespace puppetri::io {
namespace {

std::vector<LogLine> lines(std::string_view text, const LogFormat& format = {}) {
    auto read = read_firing_log(text, "log", format);
    REQUIRE(read.has_value());
    return *read;
}

constexpr std::int64_t kSecond = kTicksPerSecond;

}  // namespace

TEST_CASE("logs as they are written elsewhere") {
    // Ours
    const auto ours = lines("tick,seconds,transition\n352800000,0.5,a.b\n");
    REQUIRE(ours.size() == 1);
    CHECK(ours[0] == LogLine{{kSecond / 2}, "a.b", "", 2});
    // Columns in any order, semicolons, quotes, a byte order mark, Windows line ends
    const auto other = lines(
        "\xEF\xBB\xBF"
        "Case;Activity;Time\r\n7;\"pay; now\";2.25\r\n");
    CHECK(other[0] == LogLine{{kSecond * 9 / 4}, "pay; now", "7", 2});
    // No head line
    const auto bare = lines("# a comment\n1, come, ana\n2.5, go, ana\n");
    CHECK(bare[1] == LogLine{{kSecond * 5 / 2}, "go", "ana", 3});
    // Tuples: frames
    const auto tuples = lines("24 man1 EATING1\n\n36 man2 EATING2\n");
    CHECK(tuples[0] == LogLine{{kSecond}, "EATING1", "man1", 1});
    CHECK(tuples[1] == LogLine{{kSecond * 3 / 2}, "EATING2", "man2", 3});
    CHECK(lines("3 a b\n", {.frames_per_s = 10}).at(0).at.ticks == kSecond * 3 / 10);
}

TEST_CASE("what is no log says where") {
    for (const char* text :
         {"", "# nothing\n", "1\n", "1,\n2\n", "x,y\n", "-1,a\n", "nan,a\n", "tick,event\n1.5,a\n",
          "1 a\n", "1e300,a\n", "tick,event\n99999999999999999999,a\n"}) {
        CAPTURE(text);
        const auto read = read_firing_log(text, "log");
        REQUIRE(!read.has_value());
        CHECK(read.error()[0].code == "bad-log");
        CHECK(read.error()[0].where.file == "log");
    }
}

}  // namespace puppetri::io
