// SPDX-License-Identifier: MIT
// Single-byte corruptions of a file: all of them, or some at random.
#pragma once
#include <cstdlib>
#include <random>
#include <string>

namespace puppetri::io::testing {

inline bool long_form() { return std::getenv("PUPPETRI_LONG") != nullptr; }

// `each` gets the damaged bytes and where. In the long form every value of every byte, otherwise
// 1500 damages: a byte changed to one of `marks` (which mean something in the format) or by a bit,
// one more, one less.
template <class Each>
void corrupt(const std::string& bytes, const std::string& marks, std::mt19937& random, Each each) {
    if (long_form()) {
        for (std::size_t at = 0; at < bytes.size(); ++at) {
            for (int byte = 0; byte < 256; ++byte) {
                std::string broken = bytes;
                broken[at] = static_cast<char>(byte);
                each(broken, at);
            }
        }
        return;
    }
    for (int round = 0; round < 1500; ++round) {
        std::string broken = bytes;
        const std::size_t at = random() % bytes.size();
        switch (random() % 4) {
            case 0:
                broken[at] = marks[random() % marks.size()];
                break;
            case 1:
                broken.insert(at, 1, marks[random() % marks.size()]);
                break;
            case 2:
                broken.erase(at, 1);
                break;
            default:
                broken[at] = static_cast<char>(broken[at] ^ (1 << (random() % 8)));
        }
        each(broken, at);
    }
}

}  // namespace puppetri::io::testing
