// SPDX-License-Identifier: MIT
// Every truncation of each file and many single-byte corruptions give a tree or defects, never a
// crash; what parses is formatted and parses again. Run it under the sanitizers too.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "lang/survive.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

struct Sample {
    std::string text;
    // Examples are many and long: a part of what is done to the corpus, all of it in the long form.
    std::size_t step = 1;  // between truncations
    int rounds = 1500;     // of corruptions
};

std::vector<Sample> files() {
    std::vector<Sample> out;
    const bool all = std::getenv("PUPPETRI_LONG") != nullptr;
    for (const char* folder : {PUP_SOURCE_DIR "/tests/corpus", PUP_SOURCE_DIR "/examples"}) {
        if (!std::filesystem::exists(folder)) {
            continue;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.path().extension() == ".pup") {
                std::ifstream in(entry.path(), std::ios::binary);
                std::stringstream buffer;
                buffer << in.rdbuf();
                const std::size_t size = buffer.str().size();
                const bool example = entry.path().string().find("/examples/") != std::string::npos;
                out.push_back({buffer.str()});
                if (example && !all) {
                    out.back().step = 1 + size / 60;
                    out.back().rounds = 60;
                }
            }
        }
    }
    return out;
}

void survive(const std::string& text) { REQUIRE_MESSAGE(testing::broken_law(text) == "", text); }

}  // namespace

TEST_CASE("every truncation is survived [hostile]") {
    for (const Sample& file : files()) {
        for (std::size_t n = 0; n < file.text.size(); n += file.step) {
            survive(file.text.substr(0, n));
        }
    }
}

TEST_CASE("single-byte corruptions are survived [hostile]") {
    std::mt19937 random(3);
    const std::string bytes =
        "{}()[]\"'#\\:=->.,?*/^ \n\t\0\r\x80\xFF"
        "a1";
    for (const auto& [text, step, rounds] : files()) {
        for (int round = 0; round < rounds && !text.empty(); ++round) {
            std::string broken = text;
            const std::size_t at = random() % text.size();
            const char byte = bytes[random() % bytes.size()];
            switch (random() % 3) {
                case 0:
                    broken[at] = byte;
                    break;
                case 1:
                    broken.erase(at, 1);
                    break;
                default:
                    broken.insert(at, 1, byte);
            }
            survive(broken);
        }
    }
}

TEST_CASE("tokens in any order are survived [hostile]") {
    std::mt19937 random(5);
    const std::vector<std::string> words = {
        "place",  "net", "{",     "}",     "(",   ")",    "a",      "->", ":",    "\n",     "takes",
        "2",      "s",   "rule",  "never", "for", "in",   "..",     "+",  "-",    "*",      "/",
        "^",      "m",   "\"x\"", "'q'",   "#",   "# c",  "[",      "]",  ",",    "=",      ":=",
        "?",      "not", "and",   "until", "end", "cast", "public", "on", "with", "unless", "ready",
        "tokens", "if",  "only",  "leads", "to",  "\\\n", "."};
    for (int round = 0; round < 20000; ++round) {
        std::string text;
        const std::size_t n = random() % 40;
        for (std::size_t i = 0; i < n; ++i) {
            text += words[random() % words.size()];
            text += random() % 3 == 0 ? "" : " ";
        }
        survive(text);
    }
}

TEST_CASE("noise is survived [hostile]") {
    std::mt19937 random(9);
    for (int round = 0; round < 2000; ++round) {
        std::string text(random() % 300, ' ');
        for (char& c : text) {
            c = static_cast<char>(random() % (round % 2 == 0 ? 128 : 256));
        }
        survive(text);
    }
}

TEST_CASE("long runs of anything take time in proportion [hostile]") {
    for (const char* unit : {"# c\n", "place a # c\n", "\n", "t: a -> b # c\n", "\\\n", "a ", "(",
                             "x {\n", "cast { a: b {\n"}) {
        std::string text;
        while (text.size() < 400000) {
            text += unit;
        }
        survive(text);
    }
}
