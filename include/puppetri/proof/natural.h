// SPDX-License-Identifier: MIT
// Natural numbers of any size, as far as counting needs them: sets of states of 3^100 elements are
// counted exactly, never as a rounded double.
#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace puppetri::proof {

class Natural {
 public:
    Natural(std::uint64_t value = 0);  // implicit on purpose: numbers compare with literals

    Natural& operator+=(const Natural& other);
    Natural& operator*=(std::uint32_t factor);
    friend Natural operator+(Natural a, const Natural& b) { return a += b; }

    bool zero() const { return words_.empty(); }
    std::string decimal() const;
    // Gives  nothing above 2^64 - 1.
    std::optional<std::uint64_t> small() const;
    double approximate() const;  // infinity when too large

    std::strong_ordering operator<=>(const Natural& other) const;
    bool operator==(const Natural& other) const = default;

 private:
    std::vector<std::uint32_t> words_;  // least significant first, no leading zero
};

}  // namespace puppetri::proof
