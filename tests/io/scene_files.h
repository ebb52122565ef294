// SPDX-License-Identifier: MIT
// Scenes and other files in memory, everything else on the disk; and the real characters and
// motion, where they are.
#pragma once
#include <cstdio>
#include <map>
#include <string>

#include "puppetri/io/disk_files.h"
#include "puppetri/scene/file_source.h"

namespace puppetri::io::testing {

inline const std::string kMotion = PUP_SOURCE_DIR "/../shared/motion/";

// Says that something is skipped where the file is missing.
inline bool there(const char* file) {
    const bool found = DiskFiles().read(kMotion + file).has_value();
    if (!found) {
        std::printf("skipped: ../shared/motion/%s is missing\n", file);
    }
    return found;
}

class SceneFiles final : public scene::FileSource {
 public:
    explicit SceneFiles(std::string text) { add("scene.pup", std::move(text)); }
    SceneFiles(const SceneFiles&) = delete;  // its assets read from it
    SceneFiles& operator=(const SceneFiles&) = delete;

    void add(const std::string& path, std::string text) { texts_[path] = std::move(text); }
    Result<std::string, scene::FileProblem> read(const std::string& path) override {
        const auto found = texts_.find(path);
        return found == texts_.end() ? disk_.read(path) : found->second;
    }
    std::string resolve(const std::string& importer, const std::string& written) override {
        return disk_.resolve(importer, written);
    }
    scene::Assets* assets() override { return &assets_; }

 private:
    std::map<std::string, std::string> texts_;
    DiskFiles disk_;
    FileAssets assets_{*this};
};

}  // namespace puppetri::io::testing
