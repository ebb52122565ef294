// SPDX-License-Identifier: MIT
// Scenes from the disk: what fills the scene module's FileSource in programs.
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "puppetri/io/file_assets.h"
#include "puppetri/scene/file_source.h"

namespace puppetri::io {

// Fails   with a sentence for people when there is no such file, when it is a folder or another
// thing that has no end, when
//         it may not be read, or when it has more than kLargestFile bytes.
class DiskFiles final : public scene::FileSource {
 public:
    DiskFiles() = default;
    DiskFiles(const DiskFiles&) = delete;  // its assets read from it
    DiskFiles& operator=(const DiskFiles&) = delete;

    static constexpr std::uint64_t kLargestFile = 1u << 28;

    Result<std::string, scene::FileProblem> read(const std::string& path) override;

    // `name`, written so in a scene, is the file at `path` instead of the one beside the scene.
    void replace(std::string name, std::string path) {
        replaced_[std::move(name)] = std::move(path);
    }
    std::string resolve(const std::string& importer, const std::string& written) override;

    scene::Assets* assets() override { return &assets_; }

 private:
    std::map<std::string, std::string> replaced_;
    FileAssets assets_{*this};
};

}  // namespace puppetri::io
