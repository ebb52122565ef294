// SPDX-License-Identifier: MIT
// Streams and hashes: their laws, and their values pinned for every system.
#include "puppetri/base/random.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"

namespace {

using namespace puppetri;

// Chi-square of counts that should be equal, as a normal deviate (Wilson and Hilferty 1931).
double deviate(const std::vector<int>& counts) {
    double total = 0;
    for (const int n : counts) {
        total += n;
    }
    const double expected = total / static_cast<double>(counts.size());
    double chi2 = 0;
    for (const int n : counts) {
        chi2 += (n - expected) * (n - expected) / expected;
    }
    const double k = static_cast<double>(counts.size()) - 1;
    return (std::cbrt(chi2 / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

int set_bits(std::uint64_t x) {
    int n = 0;
    for (; x != 0; x &= x - 1) {
        ++n;
    }
    return n;
}

}  // namespace

TEST_CASE("the k-th value of a stream depends on its key and k alone [unit]") {
    RandomStream a{.key = 5, .count = 0};
    for (int i = 0; i < 10; ++i) {
        a.bits();
    }
    RandomStream b{.key = 5, .count = 10};
    CHECK(a == b);
    CHECK(a.bits() == b.bits());
    CHECK(RandomStream{.key = 5, .count = 3}.bits() == random_bits(5, 3));
}

TEST_CASE("uniform is never 0 or 1, also at the ends [unit]") {
    CHECK(uniform_from_bits(0) == 0x1p-53);
    CHECK(uniform_from_bits(~std::uint64_t{0}) == 1 - 0x1p-53);
    CHECK(uniform_from_bits(~std::uint64_t{0}) < 1);
}

TEST_CASE("uniform fills 1000 cells evenly, also over neighbouring keys and in pairs [law]") {
    std::vector<int> within(1000);
    std::vector<int> across(1000);
    std::vector<int> pairs(1024);
    RandomStream stream{.key = stream_key(1, "net.place", "duration"), .count = 0};
    for (std::uint64_t i = 0; i < 1000000; ++i) {
        ++within[static_cast<std::size_t>(stream.uniform() * 1000)];
        ++across[static_cast<std::size_t>(uniform_from_bits(random_bits(i, 0)) * 1000)];
        const auto x =
            static_cast<std::size_t>(uniform_from_bits(random_bits(i / 1000, i % 1000)) * 32);
        const auto y =
            static_cast<std::size_t>(uniform_from_bits(random_bits(i / 1000 + 1, i % 1000)) * 32);
        ++pairs[x * 32 + y];
    }
    CHECK(std::fabs(deviate(within)) < 4);
    CHECK(std::fabs(deviate(across)) < 4);
    CHECK(std::fabs(deviate(pairs)) < 4);
}

TEST_CASE("each bit of key and counter flips each bit of the value half the time [law]") {
    for (int bit = 0; bit < 64; ++bit) {
        int key_flips = 0;
        int count_flips = 0;
        for (std::uint64_t i = 0; i < 1000; ++i) {
            const std::uint64_t key = mix64(i);
            key_flips +=
                set_bits(random_bits(key, i) ^ random_bits(key ^ (std::uint64_t{1} << bit), i));
            count_flips +=
                set_bits(random_bits(key, i) ^ random_bits(key, i ^ (std::uint64_t{1} << bit)));
        }
        CHECK(std::fabs(key_flips / 1000.0 - 32) < 1);  // standard error 4 / sqrt(1000) = 0.13
        CHECK(std::fabs(count_flips / 1000.0 - 32) < 1);
    }
}

TEST_CASE("streams whose keys differ by the step of the counter do not repeat each other [law]") {
    constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15u;
    int equal = 0;
    for (std::uint64_t k = 0; k < 1000; ++k) {
        equal += random_bits(42, k + 1) == random_bits(42 + kStep, k) ? 1 : 0;
    }
    CHECK(equal == 0);
}

TEST_CASE("below is unbiased, also for sizes near 2^64 [law]") {
    RandomStream stream{.key = 9, .count = 0};
    std::vector<int> dice(6);
    int upper = 0;
    const std::uint64_t huge =
        3 * (std::uint64_t{1} << 62);  // a modulo would favour the lowest third
    for (int i = 0; i < 600000; ++i) {
        ++dice[stream.below(6)];
        upper += stream.below(huge) >= (std::uint64_t{1} << 63) ? 1 : 0;
    }
    CHECK(std::fabs(deviate(dice)) < 4);
    CHECK(std::fabs(upper - 200000) < 4 * std::sqrt(600000 * 2.0 / 9));
    CHECK(stream.below(1) == 0);
}

TEST_CASE("between includes both ends, also of the whole range [unit]") {
    RandomStream stream{.key = 2, .count = 0};
    std::set<std::int64_t> seen;
    for (int i = 0; i < 200; ++i) {
        seen.insert(stream.between(-2, 2));
    }
    CHECK(seen == std::set<std::int64_t>{-2, -1, 0, 1, 2});
    CHECK(stream.between(INT64_MAX, INT64_MAX) == INT64_MAX);
    const std::int64_t any = stream.between(INT64_MIN, INT64_MAX);
    CHECK(any == any);
}

TEST_CASE("keys differ by seed, path and purpose, and texts do not run together [unit]") {
    const std::set<std::uint64_t> keys = {stream_key(1, "a", "b"), stream_key(2, "a", "b"),
                                          stream_key(1, "ab", ""), stream_key(1, "", "ab"),
                                          stream_key(1, "b", "a")};
    CHECK(keys.size() == 5);
}

TEST_CASE("a hash sees every word, every byte and the lengths [unit]") {
    std::set<std::uint64_t> seen;
    std::string text;
    for (int i = 0; i < 40; ++i) {
        seen.insert(hash_text(text));
        text += '\0';
    }
    CHECK(seen.size() == 40);
    CHECK(Hash64().add_u64(0).value() != Hash64().value());
    CHECK(Hash64().add_u64(0).add_u64(0).value() != Hash64().add_u64(0).value());
    CHECK(Hash64().add_u64(1).add_u64(2).value() != Hash64().add_u64(2).add_u64(1).value());
    CHECK(Hash64().add_f64(0.0).value() == Hash64().add_f64(-0.0).value());
    CHECK(Hash64().add_f64(std::nan("1")).value() == Hash64().add_f64(-std::nan("2")).value());
    CHECK(Hash64(1).value() != Hash64(2).value());
}

TEST_CASE("hashes and streams have these values on every system [golden]") {
    constexpr std::uint64_t kText = hash_text("the net pulls the strings");
    CHECK(kText == 2538249954744385730u);
    CHECK(random_bits(1, 2) == 9181652608134208812u);
    CHECK(stream_key(7, "a.throw", "ticket") == 8576849112801259417u);
}
