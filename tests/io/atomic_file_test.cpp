// SPDX-License-Identifier: MIT
#include "puppetri/io/atomic_file.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace fs = std::filesystem;
using namespace puppetri;

namespace {

// A folder of its own, removed at the end.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "puppetri-io-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~Folder() { fs::remove_all(path); }
    std::string file(const char* name) const { return (path / name).string(); }
    std::ptrdiff_t entries() const {
        return std::distance(fs::directory_iterator(path), fs::directory_iterator());
    }
};

std::string content(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Runs `work` in a process of its own; gives what waitpid says.
template <class F>
int in_child(F work) {
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

}  // namespace

TEST_CASE("a committed file is there with all its bytes and nothing beside it [unit]") {
    Folder folder;
    auto file = io::AtomicFile::open(folder.file("take.bvh"));
    REQUIRE(file);
    CHECK(file->write("HIERARCHY\n"));
    CHECK(file->write("ROOT"));
    CHECK_FALSE(fs::exists(folder.file("take.bvh")));
    CHECK(file->commit());
    CHECK(content(folder.file("take.bvh")) == "HIERARCHY\nROOT");
    CHECK(folder.entries() == 1);
}

TEST_CASE("a file that is given up leaves the old one as it was [unit]") {
    Folder folder;
    REQUIRE(io::write_file(folder.file("take.glb"), "old"));
    {
        auto file = io::AtomicFile::open(folder.file("take.glb"));
        REQUIRE(file);
        CHECK(file->write("half of a new"));
    }
    CHECK(content(folder.file("take.glb")) == "old");
    CHECK(folder.entries() == 1);
}

TEST_CASE(
    "the temporary of a pending file keeps folder and extension, so that other programs can write "
    "it [unit]") {
    Folder folder;
    auto file = io::PendingFile::open(folder.file("ball.mp4"));
    REQUIRE(file);
    const fs::path temporary = file->temporary();
    CHECK(temporary.parent_path() == folder.path);
    CHECK(temporary.extension() == ".mp4");
    std::ofstream(temporary) << "film";
    CHECK(file->commit());
    CHECK(content(folder.file("ball.mp4")) == "film");
}

TEST_CASE("a full disk is named, with a remedy, and leaves nothing [hostile]") {
    const Status full = io::write_file("/dev/full", "x");
    REQUIRE_FALSE(full);
    CHECK(full.error().at(0).code == "disk-full");
    CHECK_FALSE(full.error().at(0).remedy.empty());

    Folder folder;
    const std::string path = folder.file("long.glb");
    const int status = in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1 << 16, 1 << 16};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const Status written = io::write_file(path, std::string(1 << 20, 'x'));
        ::_exit(!written && written.error().at(0).code == "disk-full" ? 7 : 8);
    });
    CHECK(WEXITSTATUS(status) == 7);
    CHECK(folder.entries() == 0);
}

TEST_CASE("places that cannot be written are refused before any work [hostile]") {
    Folder folder;
    CHECK(io::AtomicFile::open(folder.file("no/such/folder.glb")).error().at(0).code ==
          "cannot-write");
    CHECK(io::AtomicFile::open(folder.path.string()).error().at(0).code == "cannot-write");
    CHECK(io::AtomicFile::open("").error().at(0).code == "cannot-write");
}

TEST_CASE("a signal that ends the program removes what was not finished [unit]") {
    Folder folder;
    REQUIRE(io::write_file(folder.file("take.glb"), "old"));
    const int status = in_child([&] {
        std::signal(SIGTERM, [](int signal) {
            io::remove_unfinished_files();
            std::signal(signal, SIG_DFL);
            std::raise(signal);
        });
        auto one = io::AtomicFile::open(folder.file("take.glb"));
        auto two = io::PendingFile::open(folder.file("take.mp4"));
        if (one && two && one->write("half")) {
            std::raise(SIGTERM);
        }
    });
    CHECK(WIFSIGNALED(status));
    CHECK(folder.entries() == 1);
    CHECK(content(folder.file("take.glb")) == "old");
}

TEST_CASE("a symbolic link stays a link, and the file it names is written [unit]") {
    Folder folder;
    REQUIRE(io::write_file(folder.file("real.glb"), "old"));
    fs::create_symlink("real.glb", folder.file("link.glb"));
    CHECK(io::write_file(folder.file("link.glb"), "new"));
    CHECK(fs::is_symlink(folder.file("link.glb")));
    CHECK(content(folder.file("real.glb")) == "new");
}

TEST_CASE("missing folders are made on demand [unit]") {
    Folder folder;
    const std::string path = folder.file("a/b/c.glb");
    CHECK(io::make_parent_folders(path));
    CHECK(io::write_file(path, "x"));
    CHECK(io::make_parent_folders("plain.glb"));
}
