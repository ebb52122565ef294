// SPDX-License-Identifier: MIT
// Numbers as bytes, the same on every machine, and read back from bytes that anybody may have made.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/expr.h"

namespace puppetri::run {

class BytesWriter {
 public:
    explicit BytesWriter(std::vector<std::uint8_t>& out) : out_(out) {}
    void number(std::uint64_t x) {
        for (int i = 0; i < 8; ++i) {
            out_.push_back(static_cast<std::uint8_t>(x >> (8 * i)));
        }
    }
    void real(double x) { number(static_cast<std::uint64_t>(value_of_real(x))); }
    void reals(std::span<const double> list) {
        number(list.size());
        for (const double x : list) {
            real(x);
        }
    }
    void text(std::string_view t) {
        number(t.size());
        out_.insert(out_.end(), t.begin(), t.end());
    }

 private:
    std::vector<std::uint8_t>& out_;
};

class BytesReader {
 public:
    explicit BytesReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::uint64_t number() {
        if (bytes_.size() < 8) {
            good = false;
            return 0;
        }
        std::uint64_t x = 0;
        for (int i = 0; i < 8; ++i) {
            x |= static_cast<std::uint64_t>(bytes_[static_cast<std::size_t>(i)]) << (8 * i);
        }
        bytes_ = bytes_.subspan(8);
        return x;
    }
    double real() {
        const double x = real_of_value(static_cast<Value>(number()));
        good = good && x - x == 0;
        return x;
    }
    // How many of something that takes at least 8 bytes each.
    std::size_t count(std::uint64_t least = 0, std::uint64_t most = ~std::uint64_t{0}) {
        const std::uint64_t n = number();
        if (n > bytes_.size() / 8 || n < least || n > most) {
            good = false;
            return 0;
        }
        return static_cast<std::size_t>(n);
    }
    std::vector<double> reals() {
        std::vector<double> out(count());
        for (double& x : out) {
            x = real();
        }
        return out;
    }
    std::string text() {
        const std::uint64_t n = number();
        good = good && n <= bytes_.size();
        if (!good) {
            return {};
        }
        const auto size = static_cast<std::size_t>(n);
        std::string out(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
        bytes_ = bytes_.subspan(size);
        return out;
    }
    bool at_end() const { return bytes_.empty(); }
    bool good = true;

 private:
    std::span<const std::uint8_t> bytes_;
};

}  // namespace puppetri::run
