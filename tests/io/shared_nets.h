// SPDX-License-Identifier: MIT
// The nets of ../shared/nets (or of the folder that PUPPETRI_NETS names), which this repository
// does not copy: tests that need them say so and go on where the folder is missing.
#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace puppetri::io::testing {

inline std::string file_text(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// All files of that name below ../shared/nets/FOLDER, of any name if it is empty; in order.
inline std::vector<std::string> shared_nets(const std::string& folder, const std::string& name) {
    const char* elsewhere = std::getenv("PUPPETRI_NETS");
    const std::filesystem::path root =
        (elsewhere != nullptr ? std::filesystem::path(elsewhere)
                              : std::filesystem::path(PUP_SOURCE_DIR) / "../shared/nets") /
        folder;
    std::vector<std::string> out;
    if (!std::filesystem::exists(root)) {
        MESSAGE("skipped: no folder " << root.string());
        return out;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        if (entry.is_regular_file() && (name.empty() || entry.path().filename() == name)) {
            out.push_back(entry.path().string());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

// How often `what` stands in a text.
inline std::size_t occurrences(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++n;
    }
    return n;
}

}  // namespace puppetri::io::testing
