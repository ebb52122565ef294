// SPDX-License-Identifier: MIT
// The examples of docs/language.md. A block ```pup is a piece of a file, a block ```pup scene is a
// whole scene.
#pragma once
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace puppetri::lang::testing {

struct DocExample {
    std::string text;
    int line = 0;  // of the page
    bool is_scene = false;
};

inline std::string doc_page() {
    std::ifstream in(PUP_SOURCE_DIR "/docs/language.md", std::ios::binary);
    std::stringstream buffer;
    buffer << in.rdbuf();
    return buffer.str();
}

inline std::vector<DocExample> doc_examples() {
    std::vector<DocExample> out;
    std::istringstream lines(doc_page());
    bool inside = false;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (inside && line == "```") {
            inside = false;
        } else if (inside) {
            out.back().text += line + "\n";
        } else if (line == "```pup" || line == "```pup scene") {
            inside = true;
            out.push_back({"", number + 1, line != "```pup"});
        }
    }
    return out;
}

}  // namespace puppetri::lang::testing
