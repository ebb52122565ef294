// SPDX-License-Identifier: MIT
// `puppetri run SCENE`: performs a scene and tells what happened: log, score, hash, a chart.
#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "commands.h"
#include "interrupt.h"
#include "live_input.h"
#include "logs.h"
#include "measures.h"
#include "performing.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/notation/foreign_file.h"
#include "puppetri/run/course_book.h"
#include "puppetri/scene/events.h"
#include "puppetri/scene/perform.h"
#include "puppetri/scene/sundials.h"
#include "puppetri/sim/meter.h"
#include "puppetri/verdict/explain.h"
#include "run_net.h"
#include "scene_files.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

bool go_on(void* progress, double share_done) {
    static_cast<Progress*>(progress)->show(share_done);
    return !interrupted();
}

bool write_or_say(const std::string& path, const std::string& text) {
    if (path == "-") {
        std::fwrite(text.data(), 1, text.size(), stdout);
        return true;
    }
    if (auto written = io::write_file(path, text); !written) {
        say_diagnostics(written.error());
        return false;
    }
    return true;
}

// The first few of each kind: a long run may lose hundreds of events.
void say_notes(const Diagnostics& notes) {
    constexpr std::size_t kShown = 5;
    std::map<std::string, std::size_t> told;
    Diagnostics shown;
    for (const Diagnostic& d : notes) {
        if (++told[d.code] <= kShown) {
            shown.push_back(d);
        }
    }
    say_diagnostics(shown);
    for (const auto& [code, count] : told) {
        if (count > kShown) {
            say("  and " + std::to_string(count - kShown) + " more of this kind [" + code +
                "]; --json has them");
        }
    }
}

// The files that the equations of a scene play off, written anew: each with the parts of those that
// name it. Gives   whether all could be written.
bool write_baked(const scene::Scene& scene, run::CourseBook made) {
    std::map<std::string, run::CourseBook> books;
    std::size_t part = 0;
    for (const run::EquationSystem& s : scene.equations) {
        if (!s.baked_in.empty()) {
            run::CourseBook& book = books[s.baked_in];
            book.solver = scene::sundials_version();
            book.parts.push_back(std::move(made.parts[part++]));
        }
    }
    for (const auto& [path, book] : books) {
        if (!write_or_say(path, run::write_courses(book))) {
            return false;
        }
        say("baked " + path);
    }
    return true;
}

// What baking is about to mend needs no telling.
Diagnostics but_for_baking(Diagnostics notes) {
    std::erase_if(notes, [](const Diagnostic& d) {
        return d.code == "not-baked" || d.code == "stale-course";
    });
    return notes;
}

// Each firing of a witness, with what begins by it.
void tell_story(const std::string& path, const scene::Scene& scene) {
    if (const auto witness = load_witness(path, scene.net); witness) {
        for (const std::string& line : verdict::story(scene.net, *witness)) {
            say(line);
        }
    }
}

int run(const Arguments& arguments) {
    if (!notation::is_scene_file(arguments.text("scene"))) {
        return run_net(arguments);
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
    say_diagnostics(arguments.given("--bake") ? but_for_baking(scene->notes) : scene->notes);
    auto options = perform_options(arguments, *scene);
    if (!options) {
        return options.error();
    }
    options->record = arguments.given("--record");
    run::CourseBook baked;
    if (arguments.given("--bake")) {
        if (std::none_of(scene->equations.begin(), scene->equations.end(),
                         [](const run::EquationSystem& s) { return !s.baked_in.empty(); })) {
            say_error(
                "--bake: no equations of this scene name a file: write `solver stiff by sundials` "
                "and `baked \"NAME.courses\"` among their lines");
            return kBadInput;
        }
        options->bake = &baked;
    }
    std::optional<CsvLog> log;
    if (arguments.given("--log")) {
        const std::string path = arguments.text("--log");
        auto opened = CsvLog::open(path == "-" ? "/dev/stdout" : path, scene->net);
        if (!opened) {
            say_diagnostics(opened.error());
            return kFailed;
        }
        log.emplace(std::move(*opened));
        options->sink = &*log;
    }
    const auto metrics = measures_asked(scene->net, arguments.texts("--measure"));
    if (!metrics) {
        say_error(metrics.error());
        return kBadInput;
    }
    sim::Meter meter(scene->net, *metrics);
    options->observer = metrics->empty() ? nullptr : &meter;
    std::optional<Checked<scene::Performed>> performed;
    std::vector<double> measured(metrics->size());
    {
        Progress progress("running");
        options->go_on = go_on;
        options->context = &progress;
        scene::Session session(*scene, *options);
        if (arguments.text("--events") == "-") {
            play_with_stdin(session, scene->net);
        } else {
            session.run();
        }
        performed.emplace(session.finish());
        if (*performed) {  // equations are measured while they are there
            meter.finish((*performed)->end, measured);
        }
    }
    if (!*performed) {
        say_diagnostics(performed->error());
        return kBadInput;
    }
    const scene::Performed& result = **performed;
    bool good = true;
    if (meter.fault() && !result.fault) {
        say_diagnostics({*meter.fault()});
        good = false;
    }
    if (log) {
        if (auto written = log->commit(); !written) {
            say_diagnostics(written.error());
            good = false;
        }
    }
    if (arguments.given("--score")) {
        good = write_or_say(arguments.text("--score"), score_csv(*result.performance)) && good;
    }
    if (arguments.given("--record")) {
        good = write_or_say(arguments.text("--record"),
                            scene::write_event_list(result.recording, result.seed,
                                                    scene::event_names(scene->net))) &&
               good;
    }
    if (options->bake != nullptr && !result.fault && !result.interrupted) {
        good = write_baked(*scene, std::move(baked)) && good;
    }
    say_notes(result.notes);
    if (result.fault) {
        say_diagnostics({*result.fault});
    }
    if (arguments.given("--json")) {
        std::puts(run_json(*scene, result, measures_json(scene->net, *metrics, measured)).c_str());
    } else if (arguments.given("--hash")) {
        std::puts(hash_text_of(result.log_hash).c_str());
    } else {
        if (arguments.given("--witness")) {
            tell_story(arguments.text("--witness"), *scene);
        }
        say(run_summary(*scene, result));
        const std::string table = measures_table(scene->net, *metrics, measured);
        std::fwrite(table.data(), 1, table.size(), stdout);
    }
    if (result.fault) {
        return status_of_fault(*result.fault);
    }
    return good && !result.interrupted ? kFine : kFailed;
}

}  // namespace

Command run_command() {
    return {
        "run",
        "perform a scene: log, score, statistics",
        "Plays the scene from time 0 to its horizon (`until` in the file, or --for) and shows who "
        "moved when. The\n"
        "same file, seed and events give the same log everywhere; --hash prints its "
        "fingerprint.\n\n"
        "Log columns:   tick,seconds,transition\n"
        "Score columns: "
        "start_tick,end_tick,left_tick,start_seconds,end_seconds,place,actor,limbs,movement,prop,"
        "instance\n"
        "One tick is 1/705600000 s. Events are lines `2.5 s NAME`; on stdin (--events -) the run "
        "follows real\n"
        "time and also takes `now NAME`. Measures that the scene declares (`measure wait mean of "
        "time "
        "in queue`)\n"
        "are told on stdout.\n\n"
        "Examples:\n"
        "  puppetri run ball.pup                           a chart of the score\n"
        "  puppetri run ball.pup --for 20s --seed 3        also 480f (frames), 500x (firings)\n"
        "  puppetri run ball.pup --log log.csv --score -   - is stdout\n"
        "  puppetri run show.pup --events - --record session.txt\n"
        "  puppetri run show.pup --events session.txt --hash\n"
        "  puppetri run duet.pup --witness out/everybody.witness.json\n"
        "  puppetri run net.pnml --witness out/deadlock_free.witness.json   also --for 1000x",
        {{"scene", Value::kText, "SCENE",
          "a scene (.pup, .scxml, .tookima) or a net (.pnml, .xml, .net)", true},
         {"--seed", Value::kInteger, "N", "instead of the scene's seed", false},
         {"--for", Value::kText, "HOW LONG",
          "a time (40s), frames (960f) or firings (1000x), instead of the scene's", false},
         {"--log", Value::kText, "FILE", "write each firing as CSV", false},
         {"--score", Value::kText, "FILE", "write each movement as CSV", false},
         {"--events", Value::kText, "FILE",
          "outside events from a list or a recorded session; - for stdin", false},
         {"--record", Value::kText, "FILE",
          "write the outside events of this session, to be replayed", false},
         {"--witness", Value::kText, "FILE",
          "play the run of a witness that `puppetri prove` has written, step by step", false},
         {"--measure", Value::kTexts, "MEASURE",
          "what to measure, as `puppetri sweep` says; without: what the scene declares", false},
         {"--bake", Value::kFlag, "",
          "solve `solver stiff by sundials` here and write the files that the scene names `baked`",
          false},
         {"--hash", Value::kFlag, "", "print the fingerprint of the log alone", false},
         {"--json", Value::kFlag, "", "the summary as JSON on stdout", false},
         file_option()},
        run};
}

}  // namespace puppetri::cli
