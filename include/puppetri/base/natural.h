// SPDX-License-Identifier: MIT
// Natural numbers of any size, as far as counting and printing need them: sets of states of 3^100
// elements are counted exactly, and a double is printed with the digits that it has.
#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace puppetri {

class Natural {
 public:
    Natural(std::uint64_t value = 0);  // implicit on purpose: numbers compare with literals

    Natural& operator+=(const Natural& other);
    // Needs  *this >= other.
    Natural& operator-=(const Natural& other);
    Natural& operator*=(std::uint32_t factor);
    Natural& operator<<=(unsigned bits);
    friend Natural operator+(Natural a, const Natural& b) { return a += b; }
    void multiply_power_of_ten(unsigned exponent);
    // Divides in place. Needs  divisor > 0. Gives  the remainder.
    std::uint32_t divide(std::uint32_t divisor);

    bool zero() const { return words_.empty(); }
    bool odd() const { return !words_.empty() && (words_[0] & 1u) != 0; }
    std::uint32_t bit_count() const;  // of the binary digits; 0 of zero
    std::string decimal() const;
    // Gives  nothing above 2^64 - 1.
    std::optional<std::uint64_t> small() const;
    double approximate() const;  // infinity when too large

    std::strong_ordering operator<=>(const Natural& other) const;
    bool operator==(const Natural& other) const = default;

 private:
    void trim();
    std::vector<std::uint32_t> words_;  // least significant first, no leading zero
};

}  // namespace puppetri
