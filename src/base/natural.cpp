// SPDX-License-Identifier: MIT
#include "puppetri/base/natural.h"

#include <algorithm>
#include <bit>

namespace puppetri {

Natural::Natural(std::uint64_t value) {
    for (; value != 0; value >>= 32) {
        words_.push_back(static_cast<std::uint32_t>(value));
    }
}

Natural& Natural::operator+=(const Natural& other) {
    if (words_.size() < other.words_.size()) {
        words_.resize(other.words_.size());
    }
    std::uint64_t carry = 0;
    const std::size_t theirs = other.words_.size();  // read first: other may be *this
    for (std::size_t i = 0; i < words_.size() && (i < theirs || carry != 0); ++i) {
        carry += std::uint64_t{words_[i]} + (i < theirs ? other.words_[i] : 0);
        words_[i] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
    }
    if (carry != 0) {
        words_.push_back(static_cast<std::uint32_t>(carry));
    }
    return *this;
}

Natural& Natural::operator*=(std::uint32_t factor) {
    if (factor == 0) {
        words_.clear();
        return *this;
    }
    std::uint64_t carry = 0;
    for (std::uint32_t& word : words_) {
        carry += std::uint64_t{word} * factor;
        word = static_cast<std::uint32_t>(carry);
        carry >>= 32;
    }
    if (carry != 0) {
        words_.push_back(static_cast<std::uint32_t>(carry));
    }
    return *this;
}

Natural& Natural::operator-=(const Natural& other) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
        const std::uint64_t take = (i < other.words_.size() ? other.words_[i] : 0) + borrow;
        borrow = words_[i] < take ? 1 : 0;
        words_[i] = static_cast<std::uint32_t>(words_[i] - take);
    }
    trim();
    return *this;
}

Natural& Natural::operator<<=(unsigned bits) {
    if (zero()) {
        return *this;
    }
    words_.insert(words_.begin(), bits / 32, 0);
    return bits % 32 != 0 ? *this *= std::uint32_t{1} << (bits % 32) : *this;
}

void Natural::multiply_power_of_ten(unsigned exponent) {
    for (; exponent >= 9; exponent -= 9) {
        *this *= 1'000'000'000;
    }
    for (; exponent > 0; --exponent) {
        *this *= 10;
    }
}

std::uint32_t Natural::divide(std::uint32_t divisor) {
    std::uint64_t rest = 0;
    for (std::size_t i = words_.size(); i-- > 0;) {
        rest = rest << 32 | words_[i];
        words_[i] = static_cast<std::uint32_t>(rest / divisor);
        rest %= divisor;
    }
    trim();
    return static_cast<std::uint32_t>(rest);
}

std::uint32_t Natural::bit_count() const {
    return zero()
               ? 0
               : static_cast<std::uint32_t>(words_.size() * 32 -
                                            static_cast<unsigned>(std::countl_zero(words_.back())));
}

void Natural::trim() {
    while (!words_.empty() && words_.back() == 0) {
        words_.pop_back();
    }
}

std::string Natural::decimal() const {
    if (zero()) {
        return "0";
    }
    std::string reversed;
    Natural rest = *this;
    while (!rest.zero()) {
        std::uint32_t part = rest.divide(1'000'000'000);
        for (int digit = 0; digit < 9 && (part != 0 || !rest.zero()); ++digit) {
            reversed.push_back(static_cast<char>('0' + part % 10));
            part /= 10;
        }
    }
    std::reverse(reversed.begin(), reversed.end());
    return reversed;
}

std::optional<std::uint64_t> Natural::small() const {
    if (words_.size() > 2) {
        return std::nullopt;
    }
    std::uint64_t value = 0;
    for (std::size_t i = words_.size(); i-- > 0;) {
        value = value << 32 | words_[i];
    }
    return value;
}

double Natural::approximate() const {
    double value = 0;
    for (std::size_t i = words_.size(); i-- > 0;) {
        value = value * 4294967296.0 + words_[i];
    }
    return value;
}

std::strong_ordering Natural::operator<=>(const Natural& other) const {
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

}  // namespace puppetri
