// SPDX-License-Identifier: MIT
// Scenes with a few words exchanged, doubled or dropped: each either loads whole and runs, or tells
// why not. Never a crash, never half a scene, always a remedy.
#include <cstdint>
#include <string>
#include <vector>

#include "files.h"
#include "puppetri/base/random.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {
namespace {

// Words, numbers and single signs, with the space before each.
std::vector<std::string> pieces(const std::string& text) {
    std::vector<std::string> out;
    std::string piece;
    const auto is_word = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_';
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        piece += text[i];
        const bool more =
            i + 1 < text.size() && (text[i] == ' ' || (is_word(text[i]) && is_word(text[i + 1])));
        if (!more) {
            out.push_back(std::move(piece));
            piece.clear();
        }
    }
    return out;
}

std::string joined(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& piece : list) {
        text += piece;
    }
    return text;
}

}  // namespace

TEST_CASE("scenes with exchanged, doubled and dropped words load whole or not at all [hostile]") {
    ExampleFiles examples;
    int loaded = 0, refused = 0;
    for (const char* path :
         {"03_ball/ball.pup", "02_walk/limbs.pup", "01_toss/toss.pup", "03_ball/figure5.pup"}) {
        const std::vector<std::string> original = pieces(*examples.read(path));
        RandomStream random{stream_key(1, path, "mutation"), 0};
        for (int round = 0; round < 60; ++round) {
            std::vector<std::string> list = original;
            for (std::uint64_t k = 1 + random.below(2); k > 0; --k) {
                const std::size_t a = random.below(list.size());
                const std::size_t b = random.below(list.size());
                switch (random.below(3)) {
                    case 0:
                        list[a] = list[b];
                        break;
                    case 1:
                        list.insert(list.begin() + static_cast<std::ptrdiff_t>(a), list[b]);
                        break;
                    default:
                        list.erase(list.begin() + static_cast<std::ptrdiff_t>(a));
                        break;
                }
            }
            MemoryFiles files;
            files.add("03_ball/scene.pup", joined(list));
            files.add("02_walk/walk.pup", *examples.read("02_walk/walk.pup"));
            const auto scene = load(files, "03_ball/scene.pup");
            if (!scene) {
                ++refused;
                REQUIRE(has_errors(scene.error()));
                for (const Diagnostic& d : scene.error()) {
                    const bool helpful = d.severity != Severity::kError || !d.remedy.empty();
                    CHECK_MESSAGE(helpful, told({d}));
                }
                continue;
            }
            ++loaded;
            const auto performed =
                perform(*scene, {.horizon = {.time = SimTime{5 * kTicksPerSecond}, .firings = 60}});
            CHECK(performed.has_value());
        }
    }
    CHECK(loaded > 20);
    CHECK(refused > 50);
}

}  // namespace puppetri::scene
