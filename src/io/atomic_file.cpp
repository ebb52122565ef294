// SPDX-License-Identifier: MIT
#include "puppetri/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace puppetri::io {
namespace {

// The temporaries that a signal has to remove. A slot is free (0), being filled or emptied (1), or
// holds a path (2); the handler looks at the last alone.
struct Slot {
    std::atomic<int> state{0};
    char path[PATH_MAX];
};
std::array<Slot, 16> slots;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");

int take_slot(const std::string& path) {
    if (path.size() >= sizeof(Slot::path)) {
        return -1;
    }
    for (int i = 0; i < static_cast<int>(slots.size()); ++i) {
        Slot& slot = slots[static_cast<unsigned>(i)];
        int free = 0;
        if (slot.state.compare_exchange_strong(free, 1)) {
            std::memcpy(slot.path, path.c_str(), path.size() + 1);
            slot.state.store(2);
            return i;
        }
    }
    return -1;  // more files at once than slots: a signal leaves its hidden temporary behind
}

void free_slot(int slot) {
    if (slot >= 0) {
        slots[static_cast<unsigned>(slot)].state.store(0);
    }
}

Diagnostics failure(const std::string& path, const char* doing, int error) {
    Diagnostic d;
    d.where.file = path;
    d.element = "file " + path;
    const std::string reason = std::error_code(error, std::generic_category()).message();
    d.message = std::string("cannot ") + doing + ": " + reason;
    if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
        d.code = "disk-full";
        d.remedy =
            error == EFBIG
                ? "raise the limit of file size (ulimit -f), or write a shorter part (--frames A-B)"
                : "free some space, or write to another disk with -o; nothing was left behind";
    } else {
        d.code = "cannot-write";
        d.remedy = error == ENOENT   ? "create the folder first"
                   : error == EACCES ? "choose a folder that you may write to"
                   : error == EISDIR ? "name a file, not a folder"
                                     : "write to another place with -o";
    }
    return {std::move(d)};
}

std::string temporary_for(const std::string& path, int attempt) {
    const std::size_t slash = path.rfind('/');
    const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
    std::size_t dot = path.rfind('.');
    if (dot == std::string::npos || dot <= name) {
        dot = path.size();
    }
    return path.substr(0, name) + "." + path.substr(name, dot - name) + ".part-" +
           std::to_string(::getpid()) + (attempt ? "-" + std::to_string(attempt) : "") +
           path.substr(dot);
}

// Makes a rename survive a crash of the machine. Best effort: some file systems cannot.
void flush_folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::fsync(descriptor);
        ::close(descriptor);
    }
}

}  // namespace

Result<PendingFile, Diagnostics> PendingFile::open(std::string path) {
    PendingFile file;
    file.path_ = std::move(path);
    if (file.path_.empty() || file.path_.back() == '/') {
        return Unexpected(failure(file.path_, "write", EISDIR));
    }
    struct stat found {};
    if (::stat(file.path_.c_str(), &found) == 0) {
        if (S_ISDIR(found.st_mode)) {
            return Unexpected(failure(file.path_, "write", EISDIR));
        }
        if (!S_ISREG(found.st_mode)) {
            file.temporary_ = file.path_;
            return file;
        }
        // Through a symbolic link to the file it names, so that the link stays.
        std::error_code ignored;
        const std::filesystem::path real = std::filesystem::canonical(file.path_, ignored);
        if (!ignored) {
            file.path_ = real.string();
        }
    }
    for (int attempt = 0;; ++attempt) {
        const std::string temporary = temporary_for(file.path_, attempt);
        file.slot_ = take_slot(temporary);
        const int descriptor =
            ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            file.temporary_ = temporary;
            return file;
        }
        const int error = errno;
        free_slot(std::exchange(file.slot_, -1));
        if (error != EEXIST || attempt == 1000) {
            return Unexpected(failure(file.path_, "write", error));
        }
    }
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      slot_(std::exchange(other.slot_, -1)) {}

PendingFile& PendingFile::operator=(PendingFile&& other) noexcept {
    if (this != &other) {
        discard();
        path_ = std::move(other.path_);
        temporary_ = std::exchange(other.temporary_, {});
        slot_ = std::exchange(other.slot_, -1);
    }
    return *this;
}

PendingFile::~PendingFile() { discard(); }

void PendingFile::discard() noexcept {
    if (!temporary_.empty() && temporary_ != path_) {
        ::unlink(temporary_.c_str());
    }
    temporary_.clear();
    free_slot(std::exchange(slot_, -1));
}

Status PendingFile::commit() {
    PUP_REQUIRE(!temporary_.empty());
    if (temporary_ == path_) {
        temporary_.clear();
        return Ok{};
    }
    const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    int error = descriptor < 0 ? errno : 0;
    if (error == 0) {
        if (::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS) {
            error = errno;
        }
        ::close(descriptor);
    }
    if (error == 0 && ::rename(temporary_.c_str(), path_.c_str()) != 0) {
        error = errno;
    }
    if (error != 0) {
        discard();
        return Unexpected(failure(path_, "write", error));
    }
    temporary_.clear();
    free_slot(std::exchange(slot_, -1));
    flush_folder_of(path_);
    return Ok{};
}

AtomicFile::AtomicFile(PendingFile pending, int descriptor)
    : pending_(std::move(pending)), descriptor_(descriptor) {}

Result<AtomicFile, Diagnostics> AtomicFile::open(std::string path) {
    PUP_TRY(PendingFile pending, PendingFile::open(std::move(path)));
    const int descriptor = ::open(pending.temporary().c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return Unexpected(failure(pending.path(), "write", errno));
    }
    return AtomicFile(std::move(pending), descriptor);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : pending_(std::move(other.pending_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this != &other) {
        close();
        pending_ = std::move(other.pending_);
        descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
}

AtomicFile::~AtomicFile() { close(); }

void AtomicFile::close() noexcept {
    if (descriptor_ >= 0) {
        ::close(std::exchange(descriptor_, -1));
    }
}

Status AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (written == 0 || errno != EINTR) {
            const int error = written == 0 ? ENOSPC : errno;
            close();
            return Unexpected(failure(pending_.path(), "write", error));
        }
    }
    return Ok{};
}

Status AtomicFile::commit() {
    if (descriptor_ < 0) {
        return Unexpected(failure(pending_.path(), "write", EBADF));
    }
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        return Unexpected(failure(pending_.path(), "write", errno));
    }
    return pending_.commit();
}

Status write_file(const std::string& path, std::string_view bytes) {
    PUP_TRY(AtomicFile file, AtomicFile::open(path));
    PUP_TRY(Ok written, file.write(bytes));
    (void)written;
    return file.commit();
}

Status make_parent_folders(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    if (!folder.empty()) {
        std::filesystem::create_directories(folder, error);
    }
    if (error) {
        return Unexpected(failure(path, "create its folder", error.value()));
    }
    return Ok{};
}

void remove_unfinished_files() noexcept {
    for (Slot& slot : slots) {
        if (slot.state.load() == 2) {
            ::unlink(slot.path);
        }
    }
}

}  // namespace puppetri::io
