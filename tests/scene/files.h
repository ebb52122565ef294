// SPDX-License-Identifier: MIT
// Scenes for tests: from memory, and the examples of the project from the disk.
#pragma once
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "doctest/doctest.h"
#include "puppetri/scene/assets.h"
#include "puppetri/scene/scene.h"

namespace puppetri::scene {

class ExampleFiles final : public FileSource {
 public:
    Result<std::string, FileProblem> read(const std::string& path) override {
        std::ifstream in(PUP_SOURCE_DIR "/examples/" + path, std::ios::binary);
        if (!in) {
            return Unexpected(FileProblem{"there is no such file"});
        }
        return std::string(std::istreambuf_iterator<char>(in), {});
    }
};

// Scenes in memory, with somebody who makes characters and clips.
template <class SomeAssets>
class FilesWith final : public FileSource {
 public:
    MemoryFiles memory;
    Result<std::string, FileProblem> read(const std::string& path) override {
        return memory.read(path);
    }
    Assets* assets() override { return &assets_; }

 private:
    SomeAssets assets_;
};

inline std::string told(const Diagnostics& list) {
    std::string text;
    for (const Diagnostic& d : list) {
        text += format_diagnostic(d, "", false);
    }
    return text;
}

inline Scene must(Checked<Scene> scene) {
    if (!scene) {
        FAIL(told(scene.error()));
    }
    return std::move(*scene);
}

inline Scene example(const std::string& path) {
    ExampleFiles files;
    return must(load(files, path));
}

// A scene with this body after the usual header and cast (three lines: the body begins in line 4).
inline std::string with_cast(const std::string& body) {
    return "language 1\nscene \"test\" \nframes 24 per second, until 60 s\n" + body +
           "\ncast {\n ana: mannequin { at (-1.5, 0, 0) m }\n rui: mannequin { at (1.5, 0, 0) m }\n"
           " ball: sphere { diameter 22 cm, held by ana.hands }\n road: set { model road }\n}\n";
}

inline Scene from_text(const std::string& body, const std::string& other = "") {
    MemoryFiles files;
    files.add("scene.pup", with_cast(body));
    if (!other.empty()) {
        files.add("other.pup", other);
    }
    return must(load(files, "scene.pup"));
}

inline Diagnostics defects_of(const std::string& body, const std::string& other = "") {
    MemoryFiles files;
    files.add("scene.pup", with_cast(body));
    if (!other.empty()) {
        files.add("other.pup", other);
    }
    return check(files, "scene.pup");
}

}  // namespace puppetri::scene
