// SPDX-License-Identifier: MIT
// `puppetri convert IN OUT`: a net, or motion, from one format into another. Which of both, the
// ending of IN says.
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "commands.h"
#include "convert_motion.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/load_net.h"
#include "puppetri/io/write_net.h"
#include "puppetri/net/net.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

int run(const Arguments& arguments) {
    const std::string in = arguments.text("in"), out = arguments.text("out");
    if (io::clip_format_of(in) || in.ends_with(".tuples")) {
        return convert_motion(arguments);
    }
    const std::string to = arguments.text("--to");
    const std::optional<io::NetFormat> format =
        to.empty() ? io::written_format_of(out) : io::written_format_named(to);
    if (!format) {
        say_error(to.empty() ? "the ending of " + out + " names no format: say --to FORMAT"
                             : "no format is called " + to);
        say("formats are pnml, pipe, tina, lola, dot and pup");
        return kBadInput;
    }
    Checked<io::NetFile> file = io::load_net(in);
    if (!file) {
        say_diagnostics(file.error());
        return kBadInput;
    }
    say_diagnostics(file->notes);
    // A draft that cannot be compiled is no net in any format.
    if (const Checked<net::Net> net = net::compile(file->draft); !net) {
        say_diagnostics(net.error());
        return kBadInput;
    }
    if (file->format == io::NetFormat::kScene) {
        Checked<net::NetDraft> lowered = net::lower(file->draft);
        if (!lowered) {
            say_diagnostics(lowered.error());
            return kBadInput;
        }
        file->draft = std::move(*lowered);
        file->ids = {};
        // What has been written out as places and transitions is no composition any more.
        file->draft.fusions.clear();
        file->draft.rendezvous.clear();
        file->draft.refinements.clear();
    }
    const Checked<io::WrittenNet> written =
        io::write_net(*file, *format, {.lossy = arguments.given("--lossy")});
    if (!written) {
        say_diagnostics(written.error());
        return kFailed;
    }
    say_diagnostics(written->notes);
    if (out == "-") {
        std::fwrite(written->text.data(), 1, written->text.size(), stdout);
        return kFine;
    }
    if (const Status status = io::write_file(out, written->text); !status) {
        say_diagnostics(status.error());
        return kFailed;
    }
    say(out + ": " + std::to_string(file->draft.places.size()) + " places, " +
        std::to_string(file->draft.transitions.size()) + " transitions, in the format of " +
        io::name_of(*format));
    return kFine;
}

}  // namespace

Command convert_command() {
    Command command{
        "convert",
        "write a net or a motion in another format",
        "Nets: reads PNML, PIPE (.xml), TINA (.net) and the nets of scenes (.pup); coloured nets "
        "are unfolded. Writes PNML,\n"
        "PIPE, TINA, LoLA, Graphviz and scenes. What the other format has no words for is "
        "refused, element by element;\n"
        "with --lossy it is dropped, and each kind is told.\n"
        "Motion: reads keyframe files (.keys), BVH, glTF (.glb, .gltf, .vrm) and VRM animations "
        "(.vrma). Writes .keys, .bvh,\n"
        ".glb and .gltf: all clips, or those of --clip. A capture that is not in centimetres "
        "needs --scale: of CMU 0.056444. A tuple file (.tuples: FRAME OBJECT EVENT) becomes "
        "absolute keyframes.\n"
        "The formats: docs/formats.\n\n"
        "Examples:\n"
        "  puppetri convert model.pnml model.net\n"
        "  puppetri convert gspn.xml gspn.pup          to be run, proved and edited\n"
        "  puppetri convert ball.pup ball.pnml --lossy the net without movements and times\n"
        "  puppetri convert model.pnml - --to dot | dot -Tsvg > model.svg\n"
        "  puppetri convert take.bvh take.glb --scale 0.056444\n"
        "  puppetri convert take.bvh man.glb --scale 0.056444 --onto CesiumMan.glb\n"
        "  puppetri convert fox.glb run.keys --clip Run",
        {{"in", Value::kText, "IN", "a net, a scene, or a file of motion", true},
         {"out", Value::kText, "OUT", "the file to write; of nets also - for stdout", true},
         {"--to", Value::kText, "FORMAT",
          "nets: pnml, pipe, tina, lola, dot or pup; else by the ending of OUT", false},
         {"--poses", Value::kText, "FILE", "tuples: the keyframes that they name", false},
         {"--lossy", Value::kFlag, "", "nets: drop what the format has no words for", false}},
        run};
    for (Option& option : motion_options()) {
        command.options.push_back(std::move(option));
    }
    return command;
}

}  // namespace puppetri::cli
