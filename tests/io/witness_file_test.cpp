// SPDX-License-Identifier: MIT
#include "puppetri/io/witness_file.h"

#include <doctest/doctest.h>

namespace puppetri::io {
namespace {

verdict::Witness example() {
    verdict::Witness w;
    w.rule = "one_ball";
    w.says = "two at once, \"really\"";
    w.net_hash = 0xfedcba9876543210u;
    w.seed = 18'446'744'073'709'551'615u;
    w.choices = {0, 2, -1, 9'223'372'036'854'775'807};
    w.events = {{{705'600'000}, "a.whistle"}};
    w.steps = {{{0}, "t1"}, {{352'800'000}, "b.'odd name'"}};
    w.violates_after = 2;
    w.until = {352'800'000};
    return w;
}

TEST_CASE("a witness is read back as it was written [unit]") {
    const verdict::Witness w = example();
    const auto read = read_witness(write_witness(w), "w.json");
    REQUIRE(read);
    CHECK(*read == w);
    verdict::Witness lasso = w;
    lasso.violates_after = verdict::Witness::kNone;
    lasso.lasso_from = 1;
    const auto again = read_witness(write_witness(lasso), "w.json");
    REQUIRE(again);
    CHECK(*again == lasso);
}

TEST_CASE("no truncation or damaged byte of a witness does harm [hostile]") {
    const std::string text = write_witness(example());
    for (std::size_t n = 0; n + 2 < text.size(); ++n) {
        CHECK(!read_witness(text.substr(0, n), "w.json"));
    }
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const char c : {'\0', '"', '{', '9', '-', '\xff', ']'}) {
            std::string damaged = text;
            damaged[i] = c;
            const auto read = read_witness(damaged, "w.json");
            accepted += read ? 1 : 0;
            if (!read) {
                CHECK(read.error().front().code == "bad-witness");
            }
        }
    }
    CHECK(accepted < text.size() * 7);  // inside texts and numbers a byte may be another
}

TEST_CASE("what is out of range in a witness is refused [hostile]") {
    const std::string text = write_witness(example());
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        changed.replace(changed.find(from), from.size(), to);
        return read_witness(changed, "w.json").has_value();
    };
    CHECK(with("\"version\":1", "\"version\":1"));
    CHECK_FALSE(with("\"version\":1", "\"version\":2"));
    CHECK_FALSE(with("\"violates_after\":2", "\"violates_after\":3"));
    CHECK_FALSE(with("\"until_tick\":352800000", "\"until_tick\":-1"));
    CHECK_FALSE(with("\"until_tick\":352800000", "\"until_tick\":1e99"));
    CHECK_FALSE(with("9223372036854775807", "9223372036854775808"));
    CHECK_FALSE(with("fedcba9876543210", "fedcba98765432100"));
    std::string nested(2'000'000, '[');
    CHECK_FALSE(read_witness(nested, "w.json").has_value());
}

}  // namespace
}  // namespace puppetri::io
