// SPDX-License-Identifier: MIT
// The examples of docs/language.md and of docs/notations/. A block ```pup is a piece of a file, a
// block ```pup scene is a whole scene.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace puppetri::lang::testing {

struct DocExample {
    std::string page;  // its path below docs/
    std::string text;
    int line = 0;  // of the page
    bool is_scene = false;
};

// Paths below docs/.
inline std::vector<std::string> doc_pages() {
    std::vector<std::string> out{"language.md"};
    for (const auto& entry :
         std::filesystem::directory_iterator(PUP_SOURCE_DIR "/docs/notations")) {
        out.push_back("notations/" + entry.path().filename().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

inline std::string doc_page(const std::string& page = "language.md") {
    std::ifstream in(PUP_SOURCE_DIR "/docs/" + page, std::ios::binary);
    std::stringstream buffer;
    buffer << in.rdbuf();
    return buffer.str();
}

inline std::vector<DocExample> doc_examples() {
    std::vector<DocExample> out;
    for (const std::string& page : doc_pages()) {
        std::istringstream lines(doc_page(page));
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
                out.push_back({page, "", number + 1, line != "```pup"});
            }
        }
    }
    return out;
}

}  // namespace puppetri::lang::testing
