// SPDX-License-Identifier: MIT
// Where the text of files comes from: a disk (the program), memory (tests, the browser, editors).
// The scene module reads nothing by itself.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "puppetri/base/result.h"

namespace puppetri::scene {

class Assets;  // scene/assets.h

struct FileProblem {
    std::string message;  // "there is no such file"
};

// "a/b/walk.pup" for importer "a/b/scene.pup" and "walk.pup"; `.` and `..` are removed as far as
// the text allows.
std::string path_beside(const std::string& importer, const std::string& written);

class FileSource {
 public:
    virtual ~FileSource() = default;

    // The bytes of a file, by the path that resolve gave (or that the user named).
    virtual Result<std::string, FileProblem> read(const std::string& path) = 0;

    // The path of `import ... from "written"` in the file `importer`. One file must always get one
    // path: files are told apart by it.
    virtual std::string resolve(const std::string& importer, const std::string& written) {
        return path_beside(importer, written);
    }

    // Reads characters and clips; null where there are none to be had.
    virtual Assets* assets() { return nullptr; }
};

// Files in memory, for tests and whoever has the text already.
class MemoryFiles final : public FileSource {
 public:
    void add(std::string path, std::string text) { files_[std::move(path)] = std::move(text); }
    Result<std::string, FileProblem> read(const std::string& path) override;

 private:
    std::map<std::string, std::string> files_;
};

}  // namespace puppetri::scene
