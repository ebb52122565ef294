// SPDX-License-Identifier: MIT
// Numbers as bytes: the examples of Protocol Buffers' documentation, and back again at all sizes.
#include "puppetri/base/varint.h"

#include <doctest/doctest.h>

#include <cstdint>

namespace puppetri {
namespace {

TEST_CASE("numbers are written as Protocol Buffers' documentation writes them [oracle]") {
    std::vector<std::uint8_t> bytes;
    put_varint(bytes, 1);
    put_varint(bytes, 150);
    CHECK(bytes == std::vector<std::uint8_t>{0x01, 0x96, 0x01});
    CHECK(zigzag(0) == 0);
    CHECK(zigzag(-1) == 1);
    CHECK(zigzag(1) == 2);
    CHECK(zigzag(-2) == 3);
    CHECK(zigzag(INT32_MAX) == 0xFFFF'FFFEu);
    CHECK(zigzag(INT32_MIN) == 0xFFFF'FFFFu);
}

TEST_CASE("what was written is read again, one number after the other") {
    std::vector<std::int64_t> numbers = {0, INT64_MAX, INT64_MIN};
    for (int shift = 0; shift < 63; ++shift) {
        const std::int64_t power = std::int64_t{1} << shift;
        for (const std::int64_t x : {power - 1, power, -power, -power - 1}) {
            numbers.push_back(x);
        }
    }
    std::vector<std::uint8_t> bytes;
    for (const std::int64_t x : numbers) {
        put_varint(bytes, zigzag(x));
    }
    std::size_t at = 0;
    for (const std::int64_t x : numbers) {
        CHECK(unzigzag(get_varint(bytes, at)) == x);
    }
    CHECK(at == bytes.size());
}

}  // namespace
}  // namespace puppetri
