// SPDX-License-Identifier: MIT
#include "puppetri/scene/file_source.h"

#include <vector>

namespace puppetri::scene {

std::string path_beside(const std::string& importer, const std::string& written) {
    const std::size_t slash = importer.rfind('/');
    const bool absolute = !written.empty() && written[0] == '/';
    const std::string whole =
        absolute || slash == std::string::npos ? written : importer.substr(0, slash + 1) + written;
    // "." and ".." removed as far as the text allows: a path that leaves its root keeps its "..".
    std::vector<std::string> steps;
    std::size_t at = 0;
    while (at <= whole.size()) {
        std::size_t end = whole.find('/', at);
        end = end == std::string::npos ? whole.size() : end;
        const std::string step = whole.substr(at, end - at);
        at = end + 1;
        if (step == ".." && !steps.empty() && steps.back() != "..") {
            steps.pop_back();
        } else if (!step.empty() && step != ".") {
            steps.push_back(step);
        }
    }
    std::string path = !whole.empty() && whole[0] == '/' ? "/" : "";
    for (std::size_t i = 0; i < steps.size(); ++i) {
        path += (i > 0 ? "/" : "") + steps[i];
    }
    return path;
}

Result<std::string, FileProblem> MemoryFiles::read(const std::string& path) {
    const auto at = files_.find(path);
    if (at == files_.end()) {
        return Unexpected(FileProblem{"there is no such file"});
    }
    return at->second;
}

}  // namespace puppetri::scene
