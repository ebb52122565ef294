// SPDX-License-Identifier: MIT
// Files that are whole or absent. What is written goes to a hidden temporary file in the same
// folder; only commit() gives it its name, in one step of the file system, after the bytes have
// reached the disk. A writer that dies on the way (an error, Ctrl-C, a full disk) leaves the old
// file, if there was one, and nothing new.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"

namespace puppetri::io {

// A file that is being made by somebody: another program (ffmpeg), a library, or AtomicFile below.
// Gives   the temporary has the extension of the path and stands in its folder. A path that exists
// and is not a plain
//         file (/dev/stdout, a pipe) is written in place: temporary() == path().
// Fails   "cannot-write": the folder is missing, or not writable, or the path is a folder.
class PendingFile {
 public:
    static Result<PendingFile, Diagnostics> open(std::string path);
    PendingFile(PendingFile&&) noexcept;
    PendingFile& operator=(PendingFile&&) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    ~PendingFile();  // removes the temporary unless committed

    const std::string& path() const { return path_; }
    const std::string& temporary() const { return temporary_; }

    // Flushes the temporary to the disk and renames it to path(). After a failure both are as
    // before open().
    Status commit();

 private:
    PendingFile() = default;
    void discard() noexcept;

    std::string path_, temporary_;
    int slot_ = -1;  // in the table of what a signal removes
};

// A whole file written piece by piece.
class AtomicFile {
 public:
    static Result<AtomicFile, Diagnostics> open(std::string path);
    AtomicFile(AtomicFile&&) noexcept;
    AtomicFile& operator=(AtomicFile&&) noexcept;
    ~AtomicFile();

    // Fails   "disk-full" with the remedy to free space or to write elsewhere; "cannot-write"
    // otherwise. After a
    //         failure every further call fails alike.
    Status write(std::string_view bytes);
    Status commit();

 private:
    explicit AtomicFile(PendingFile pending, int descriptor);
    void close() noexcept;

    PendingFile pending_;
    int descriptor_ = -1;
};

// open, write, commit.
Status write_file(const std::string& path, std::string_view bytes);

// Creates the folder that `path` stands in, with all above it, where missing.
Status make_parent_folders(const std::string& path);

// Removes the temporaries of all files that are being written. Calls nothing that a signal handler
// may not: it is what a program does last when a signal ends it.
void remove_unfinished_files() noexcept;

}  // namespace puppetri::io
