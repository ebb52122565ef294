// SPDX-License-Identifier: MIT
// Truncations and single-byte corruptions of every file of tests/corpus/motion give clips or
// defects, never a crash. Run it under the sanitizers too. The long form, every truncation and all
// 255 corruptions of every byte: PUPPETRI_LONG=1.
#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

#include "io/corrupt.h"
#include "io/survive_motion.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

void survive(const std::string& name, const std::string& bytes, std::size_t at) {
    const std::string law = broken_motion_law(name, bytes);
    REQUIRE_MESSAGE(law == "", name << " at " << at << ": " << law);
}

}  // namespace

TEST_CASE("the corpus of motion itself is read [hostile]") {
    CHECK(motion_corpus().size() >= 6);
    for (const auto& [name, bytes] : motion_corpus()) {
        survive(name, bytes, 0);
        CHECK_MESSAGE(read_motion_as(name, bytes).has_value(), name);
    }
}

TEST_CASE("every truncation of a motion is survived [hostile]") {
    for (const auto& [name, bytes] : motion_corpus()) {
        const std::size_t step = long_form() ? 1 : 1 + bytes.size() / 600;
        for (std::size_t n = 0; n < bytes.size(); n += step) {
            survive(name, bytes.substr(0, n), n);
        }
        // A file cut off within its numbers or its binary part is not taken for a whole one.
        if (!name.ends_with(".keys")) {
            CHECK(!read_motion_as(name, bytes.substr(0, bytes.size() - 6)).has_value());
        }
    }
}

TEST_CASE("single-byte corruptions of a motion are survived [hostile]") {
    std::mt19937 random(9);
    static constexpr char kMarks[] = "{}[]\",:-+.eE0919 \n\t\0\x01\x7f\x80\xff#f<";
    const std::string marks(kMarks, sizeof kMarks - 1);
    for (const auto& [name, bytes] : motion_corpus()) {
        const std::string& file = name;
        corrupt(bytes, marks, random,
                [&](const std::string& broken, std::size_t at) { survive(file, broken, at); });
    }
}
