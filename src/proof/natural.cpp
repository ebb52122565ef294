// SPDX-License-Identifier: MIT
#include "puppetri/proof/natural.h"

#include <algorithm>

namespace puppetri::proof {

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

std::string Natural::decimal() const {
    if (zero()) {
        return "0";
    }
    constexpr std::uint32_t kChunk = 1'000'000'000;
    std::string reversed;
    std::vector<std::uint32_t> rest = words_;
    while (!rest.empty()) {
        std::uint64_t remainder = 0;
        for (std::size_t i = rest.size(); i-- > 0;) {
            remainder = remainder << 32 | rest[i];
            rest[i] = static_cast<std::uint32_t>(remainder / kChunk);
            remainder %= kChunk;
        }
        while (!rest.empty() && rest.back() == 0) {
            rest.pop_back();
        }
        for (int digit = 0; digit < 9 && (remainder != 0 || !rest.empty()); ++digit) {
            reversed.push_back(static_cast<char>('0' + remainder % 10));
            remainder /= 10;
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

}  // namespace puppetri::proof
