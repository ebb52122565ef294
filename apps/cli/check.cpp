// SPDX-License-Identifier: MIT
// `puppetri check FILE`: every defect of a file and of what it imports, in milliseconds.
#include <cstdio>
#include <string>

#include "commands.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/scene/scene.h"
#include "scene_files.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

std::string counted(std::size_t n, const std::string& what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

int run(const Arguments& arguments) {
    io::DiskFiles files;
    if (!use_files(arguments, files)) {
        return kBadInput;
    }
    const std::string path = arguments.text("file");
    const Diagnostics list = scene::check(files, path);
    std::size_t errors = 0, warnings = 0;
    for (const Diagnostic& d : list) {
        errors += d.severity == Severity::kError ? 1 : 0;
        warnings += d.severity == Severity::kWarning ? 1 : 0;
    }
    if (arguments.given("--json")) {
        std::string text = "{\"file\": \"" + json_escaped(path) +
                           "\", \"errors\": " + std::to_string(errors) +
                           ", \"warnings\": " + std::to_string(warnings) + ", \"diagnostics\": [";
        for (std::size_t i = 0; i < list.size(); ++i) {
            text += (i > 0 ? ",\n  " : "\n  ") + to_json(list[i]);
        }
        std::puts((text + (list.empty() ? "]}" : "\n]}")).c_str());
    } else {
        say_diagnostics(list);
        say(errors > 0 ? path + ": " + counted(errors, "error") +
                             (warnings > 0 ? ", " + counted(warnings, "warning") : "")
            : warnings > 0 ? path + ": no errors, " + counted(warnings, "warning")
                           : path + ": fine");
    }
    return errors > 0 ? kBadInput : kFine;
}

}  // namespace

Command check_command() {
    return {
        "check",
        "tell every defect of a scene or of a library of nets",
        "Reads the file and what it imports, looks up every name, compares every unit and type, "
        "and tells all\n"
        "defects at once, each with its place, what it is about and what to do. Nothing is run.\n"
        "Exits 0 when there are no errors, 2 otherwise.\n\n"
        "Examples:\n"
        "  puppetri check ball.pup\n"
        "  puppetri check ball.pup --json      for editors: one object on stdout",
        {{"file", Value::kText, "FILE", "a .pup file", true},
         {"--json", Value::kFlag, "", "the defects as JSON on stdout", false},
         file_option()},
        run};
}

}  // namespace puppetri::cli
