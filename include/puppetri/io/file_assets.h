// SPDX-License-Identifier: MIT
// Characters and clips for scenes, out of the files of any source.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "puppetri/scene/assets.h"

namespace puppetri::scene {
class FileSource;
}

namespace puppetri::io {

class FileAssets final : public scene::Assets {
 public:
    // The source must live longer.
    explicit FileAssets(scene::FileSource& files) : files_(files) {}

    Checked<scene::LoadedCharacter> character(const scene::CharacterRequest& request) override;
    Checked<scene::LoadedClips> clips(const scene::ClipRequest& request) override;

 private:
    scene::FileSource& files_;
};

}  // namespace puppetri::io
