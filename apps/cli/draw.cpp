// SPDX-License-Identifier: MIT
// `puppetri draw SCENE --as math`: the scene's net in the notation of the textbooks.
#include <cstdio>
#include <string>

#include "commands.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/scene/mathematics.h"
#include "puppetri/scene/scene.h"
#include "scene_files.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

int run(const Arguments& arguments) {
    if (arguments.text("--as", "math") != "math") {
        say_error("--as: there is only `math`: P, T, F, w, M0 and the incidence matrix");
        return kBadInput;
    }
    io::DiskFiles files;
    if (!use_files(arguments, files)) {
        return kBadInput;
    }
    const auto scene = scene::load(files, arguments.text("scene"));
    if (!scene) {
        say_diagnostics(scene.error());
        return kBadInput;
    }
    std::fputs(scene::to_mathematics(scene->draft).c_str(), stdout);
    return kFine;
}

}  // namespace

Command draw_command() {
    return {"draw",
            "the net of a scene in mathematical notation",
            "Prints places P, transitions T, arcs F, weights w, the initial marking M0 and the "
            "incidence matrix C\n"
            "(rows P, columns T: tokens given minus tokens taken).\n\n"
            "Example:\n"
            "  puppetri draw three_arcs.pup --as math",
            {{"scene", Value::kText, "SCENE", "a .pup file with a scene", true},
             {"--as", Value::kText, "KIND", "math (the only kind)", false},
             file_option()},
            run};
}

}  // namespace puppetri::cli
