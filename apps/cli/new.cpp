// SPDX-License-Identifier: MIT
// `puppetri new NAME --template T`: a scene to start from, in the current folder. Nothing is
// overwritten.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "puppetri/io/disk_files.h"
#include "templates.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

std::string template_names() {
    std::string names;
    std::string_view last;
    for (const TemplateFile& file : template_files()) {
        if (file.of != last) {
            names += (names.empty() ? "" : ", ") + std::string(file.of);
            last = file.of;
        }
    }
    return names;
}

// Writes a file that must not exist yet; gives the reason where it fails.
std::string create(const std::string& path, std::string_view text) {
    std::FILE* file = std::fopen(path.c_str(), "wbx");
    if (file == nullptr) {
        return errno == EEXIST ? path + " exists already; choose another name"
                               : "cannot write " + path + ": " + std::strerror(errno);
    }
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if ((std::fclose(file) != 0) || !written) {
        std::remove(path.c_str());
        return "cannot write " + path + ": " + std::strerror(errno);
    }
    return "";
}

// Whether the file is there with this very text.
bool holds(const std::string& path, std::string_view text) {
    const auto found = io::DiskFiles().read(path);
    return found && *found == text;
}

// NAME or NAME.pup, a file name of letters, digits, - and _ (folders before it are allowed).
bool good_name(const std::string& name) {
    const std::size_t slash = name.rfind('/');
    const std::string base = slash == std::string::npos ? name : name.substr(slash + 1);
    for (const char c : base) {
        const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' || c == '-';
        if (!word) {
            return false;
        }
    }
    return !base.empty();
}

int run(const Arguments& arguments) {
    std::string name = arguments.text("name");
    if (name.size() > 4 && name.ends_with(".pup")) {
        name.resize(name.size() - 4);
    }
    if (!good_name(name)) {
        say_error("a scene's name has letters, digits, - and _: `puppetri new duet`");
        return kBadInput;
    }
    const std::string wanted = arguments.text("--template", "toss");
    const std::size_t slash = name.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
    std::vector<std::pair<std::string, std::string_view>> files;
    for (const TemplateFile& file : template_files()) {
        if (file.of == wanted) {
            files.emplace_back(files.empty() ? name + ".pup" : folder + std::string(file.name),
                               file.text);
        }
    }
    if (files.empty()) {
        say_error("there is no template " + wanted + "; there are " + template_names());
        return kBadInput;
    }
    // What the scene imports first, so that a scene that exists is whole.
    std::vector<std::string> made;
    for (std::size_t i = files.size(); i-- > 0;) {
        if (i > 0 && holds(files[i].first, files[i].second)) {
            continue;  // another scene brought it already
        }
        const std::string problem = create(files[i].first, files[i].second);
        if (!problem.empty()) {
            for (const std::string& path : made) {
                std::remove(path.c_str());
            }
            say_error(problem);
            return kFailed;
        }
        made.push_back(files[i].first);
    }
    say("wrote " + files[0].first + "; now: puppetri run " + files[0].first);
    return kFine;
}

}  // namespace

Command new_command() {
    return {"new",
            "start a scene from a template",
            "Writes NAME.pup (and what it imports) into the folder of NAME; overwrites nothing.\n\n"
            "Examples:\n"
            "  puppetri new duet                   two figures toss a ball, 20 lines\n"
            "  puppetri new park --template ball   the ball game with its walk",
            {{"name", Value::kText, "NAME", "the new scene, without .pup", true},
             {"--template", Value::kText, "T", "one of: " + template_names() + " (default: toss)"}},
            run};
}

}  // namespace puppetri::cli
