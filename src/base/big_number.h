// SPDX-License-Identifier: MIT
// Natural numbers of any size, as far as printing and reading decimals needs them.
#pragma once
#include <compare>
#include <cstdint>
#include <vector>

namespace puppetri {

class BigNumber {
 public:
    explicit BigNumber(std::uint64_t value = 0) {
        for (; value != 0; value >>= 32) {
            words_.push_back(static_cast<std::uint32_t>(value));
        }
    }

    bool zero() const { return words_.empty(); }
    bool odd() const { return !words_.empty() && (words_[0] & 1u) != 0; }

    void multiply_add(std::uint32_t factor, std::uint32_t addend) {
        std::uint64_t carry = addend;
        for (std::uint32_t& word : words_) {
            carry += std::uint64_t{word} * factor;
            word = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0) {
            words_.push_back(static_cast<std::uint32_t>(carry));
        }
    }
    void multiply_power_of_ten(unsigned exponent) {
        for (; exponent >= 9; exponent -= 9) {
            multiply_add(1'000'000'000, 0);
        }
        for (; exponent > 0; --exponent) {
            multiply_add(10, 0);
        }
    }
    void shift_left(unsigned bits) {
        if (zero()) {
            return;
        }
        words_.insert(words_.begin(), bits / 32, 0);
        if (bits % 32 != 0) {
            multiply_add(std::uint32_t{1} << (bits % 32), 0);
        }
    }
    // Gives  the remainder.
    std::uint32_t divide(std::uint32_t divisor) {
        std::uint64_t rest = 0;
        for (std::size_t i = words_.size(); i-- > 0;) {
            rest = rest << 32 | words_[i];
            words_[i] = static_cast<std::uint32_t>(rest / divisor);
            rest %= divisor;
        }
        trim();
        return static_cast<std::uint32_t>(rest);
    }
    void add(const BigNumber& other) {
        if (words_.size() < other.words_.size()) {
            words_.resize(other.words_.size());
        }
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            carry += std::uint64_t{words_[i]} + (i < other.words_.size() ? other.words_[i] : 0);
            words_[i] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0) {
            words_.push_back(static_cast<std::uint32_t>(carry));
        }
    }
    // Needs  *this >= other.
    void subtract(const BigNumber& other) {
        std::uint64_t borrow = 0;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const std::uint64_t take = (i < other.words_.size() ? other.words_[i] : 0) + borrow;
            borrow = words_[i] < take ? 1 : 0;
            words_[i] = static_cast<std::uint32_t>(words_[i] - take);
        }
        trim();
    }
    std::uint32_t bit_count() const {
        std::uint32_t bits = static_cast<std::uint32_t>(words_.size()) * 32;
        for (std::uint32_t top = words_.empty() ? 1u << 31 : words_.back(); (top & 1u << 31) == 0;
             top <<= 1) {
            --bits;
        }
        return bits;
    }
    std::strong_ordering operator<=>(const BigNumber& other) const {
        if (words_.size() != other.words_.size()) {
            return words_.size() <=> other.words_.size();
        }
        for (std::size_t i = words_.size(); i-- > 0;) {
            if (words_[i] != other.words_[i]) {
                return words_[i] <=> other.words_[i];
            }
        }
        return std::strong_ordering::equal;
    }
    bool operator==(const BigNumber& other) const = default;

 private:
    void trim() {
        while (!words_.empty() && words_.back() == 0) {
            words_.pop_back();
        }
    }
    std::vector<std::uint32_t> words_;  // least significant first, no leading zero
};

}  // namespace puppetri
