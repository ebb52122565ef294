// SPDX-License-Identifier: MIT
// Scenes from the disk: what fills the scene module's FileSource in programs.
#pragma once
#include <cstdint>
#include <string>

#include "puppetri/scene/file_source.h"

namespace puppetri::io {

// Fails   with a sentence for people when there is no such file, when it is a folder or another
// thing that has no end, when
//         it may not be read, or when it has more than kLargestFile bytes.
class DiskFiles final : public scene::FileSource {
 public:
    static constexpr std::uint64_t kLargestFile = 1u << 28;

    Result<std::string, scene::FileProblem> read(const std::string& path) override;
};

}  // namespace puppetri::io
