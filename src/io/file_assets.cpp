// SPDX-License-Identifier: MIT
#include "puppetri/io/file_assets.h"

#include "puppetri/figure/character.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/io/humanoid_clips.h"
#include "puppetri/motion/clip.h"
#include "puppetri/scene/file_source.h"

namespace puppetri::io {
namespace {

Unexpected<Diagnostics> unreadable(const std::string& path, std::string message) {
    return Unexpected(Diagnostics{
        {Severity::kError,
         "cannot-read",
         {path, 0, 0, 1},
         "file",
         std::move(message),
         "name a file that is there, seen from the folder of the scene, or say where it is: "
         "--file NAME=PATH"}});
}

}  // namespace

Checked<scene::LoadedCharacter> FileAssets::character(const scene::CharacterRequest& request) {
    auto bytes = files_.read(request.path);
    if (!bytes) {
        return unreadable(request.path, bytes.error().message);
    }
    PUP_TRY(const GltfDocument document,
            GltfDocument::parse(std::move(*bytes), request.path, &files_));
    scene::LoadedCharacter loaded;
    PUP_TRY(figure::Character character, read_character(document, request, loaded.notes));
    loaded.character = std::make_shared<const figure::Character>(std::move(character));
    return loaded;
}

Checked<scene::LoadedClips> FileAssets::clips(const scene::ClipRequest& request) {
    auto bytes = files_.read(request.path);
    if (!bytes) {
        return unreadable(request.path, bytes.error().message);
    }
    PUP_TRY(ClipFile file,
            parse_clips(std::move(*bytes), request.path, {.scale = request.scale}, &files_));
    return clips_for_figures(std::move(file), request.path);
}

}  // namespace puppetri::io
