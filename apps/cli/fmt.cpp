// SPDX-License-Identifier: MIT
// `puppetri fmt FILE`: the canonical form of a file, comments kept.
#include <cstdio>
#include <iostream>
#include <iterator>
#include <string>

#include "commands.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/lang/format.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

int run(const Arguments& arguments) {
    const std::string path = arguments.text("file");
    std::string text;
    if (path == "-") {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
    } else {
        auto read = io::DiskFiles().read(path);
        if (!read) {
            say_error(path + ": " + read.error().message);
            return kBadInput;
        }
        text = std::move(*read);
    }
    auto formatted = lang::format(text, path);
    if (!formatted) {
        say_diagnostics(formatted.error());
        return kBadInput;
    }
    const bool same = *formatted == text;
    if (arguments.given("--check")) {
        if (!same) {
            say(path + ": not in canonical form; `puppetri fmt " + path + " --write` changes it");
        }
        return same ? kFine : kFailed;
    }
    if (!arguments.given("--write") || path == "-") {
        std::fwrite(formatted->data(), 1, formatted->size(), stdout);
        return kFine;
    }
    if (!same) {
        if (auto written = io::write_file(path, *formatted); !written) {
            say_diagnostics(written.error());
            return kFailed;
        }
    }
    say(path + (same ? ": unchanged" : ": formatted"));
    return kFine;
}

}  // namespace

Command fmt_command() {
    return {"fmt",
            "bring a file into its canonical form",
            "Prints the file as everybody writes it: one layout, all comments kept, nothing else "
            "changed. A file with\n"
            "a defect is not formatted.\n\n"
            "Examples:\n"
            "  puppetri fmt ball.pup               print it\n"
            "  puppetri fmt ball.pup --write       change the file\n"
            "  puppetri fmt ball.pup --check       exit 1 if it would change\n"
            "  puppetri fmt - < ball.pup           from stdin to stdout",
            {{"file", Value::kText, "FILE", "a .pup file, or - for stdin", true},
             {"--check", Value::kFlag, "",
              "change nothing; exit 1 if the file is not in canonical form", false},
             {"--write", Value::kFlag, "", "change the file itself", false}},
            run};
}

}  // namespace puppetri::cli
