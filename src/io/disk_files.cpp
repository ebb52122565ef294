// SPDX-License-Identifier: MIT
#include "puppetri/io/disk_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace puppetri::io {
namespace {

Unexpected<scene::FileProblem> problem(std::string message) {
    return Unexpected(scene::FileProblem{std::move(message)});
}

Unexpected<scene::FileProblem> problem_of(int error) {
    if (error == ENOENT || error == ENOTDIR) {
        return problem("there is no such file");
    }
    return problem("it cannot be read: " +
                   std::error_code(error, std::generic_category()).message());
}

// Closes at the end of its scope.
struct Descriptor {
    int value = -1;
    ~Descriptor() {
        if (value >= 0) {
            ::close(value);
        }
    }
};

}  // namespace

std::string DiskFiles::resolve(const std::string& importer, const std::string& written) {
    const auto replaced = replaced_.find(written);
    return replaced != replaced_.end() ? replaced->second : scene::path_beside(importer, written);
}

Result<std::string, scene::FileProblem> DiskFiles::read(const std::string& path) {
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    struct stat found {};
    if (file.value < 0 || ::fstat(file.value, &found) != 0) {
        return problem_of(errno);
    }
    if (S_ISDIR(found.st_mode)) {
        return problem("it is a folder, not a file");
    }
    std::string bytes;
    const auto too_large = [&] { return bytes.size() > kLargestFile; };
    // A pipe (<(...), /dev/stdin) has no size: read until the end, but not for ever.
    if (S_ISREG(found.st_mode) && static_cast<std::uint64_t>(found.st_size) <= kLargestFile) {
        bytes.reserve(static_cast<std::size_t>(found.st_size));
    }
    char block[1 << 16];
    while (!too_large()) {
        const ssize_t count = ::read(file.value, block, sizeof block);
        if (count == 0) {
            return bytes;
        }
        if (count > 0) {
            bytes.append(block, static_cast<std::size_t>(count));
        } else if (errno != EINTR) {
            return problem_of(errno);
        }
    }
    return problem("it is larger than " + std::to_string(kLargestFile >> 20) + " MB");
}

}  // namespace puppetri::io
