// SPDX-License-Identifier: MIT
// `puppetri explain SCENE RULE`: why a rule fails, in words, and what would mend it.
#include "puppetri/verdict/explain.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "commands.h"
#include "proving.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/io/witness_file.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using verdict::Verdict;

void print_lines(const std::vector<std::string>& lines) {
    constexpr std::size_t kHead = 30, kTail = 20;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines.size() > kHead + kTail + 1 && i == kHead) {
            std::printf("  ... %zu more ...\n", lines.size() - kHead - kTail);
            i = lines.size() - kTail - 1;
            continue;
        }
        std::printf("  %s\n", lines[i].c_str());
    }
}

void print(const Verdict& v, const verdict::Explanation& e) {
    std::printf("%s%s%s%s\n%s\n", v.rule.c_str(), v.caption.empty() ? "" : " \"", v.caption.c_str(),
                v.caption.empty() ? "" : "\"", e.what.c_str());
    for (const std::string& note : v.notes) {
        std::printf("%s\n", note.c_str());
    }
    if (!e.story.empty()) {
        std::printf("\nwhat happens:\n");
        print_lines(e.story);
    }
    if (!e.waits.empty()) {
        std::printf("\nwho waits for what:\n");
        for (const verdict::Wait& w : e.waits) {
            std::printf("  %s\n", w.words.c_str());
        }
    }
    constexpr std::size_t kFew = 12;
    if (!e.siphon.empty() && e.siphon.size() <= kFew && !e.waits.empty()) {
        std::printf("\nempty for ever, since each is filled only out of the others:\n");
        for (const std::string& place : e.siphon) {
            std::printf("  %s\n", place.c_str());
        }
    }
}

void print(const verdict::RepairAnswer& answer) {
    if (!answer.repair) {
        std::printf("\nno repair is offered: %s\n", answer.reason.c_str());
        return;
    }
    std::printf("\na repair that was proved: %s\n(%s)\n\n%s", answer.repair->idea.c_str(),
                answer.repair->source.c_str(), answer.repair->diff.c_str());
}

std::string json_of(const Verdict& v, const verdict::Explanation& e,
                    const verdict::RepairAnswer& answer) {
    io::JsonWriter json;
    json.begin_object()
        .member("rule", v.rule)
        .member("verdict", verdict::name_of(v))
        .member("reason", v.reason);
    json.key("story").begin_array();
    for (const std::string& line : e.story) {
        json.string(line);
    }
    json.end_array().key("waits").begin_array();
    for (const verdict::Wait& w : e.waits) {
        json.begin_object()
            .member("place", w.place)
            .member("transition", w.transition)
            .member("missing", w.missing)
            .member("taken_by", w.taken_by)
            .end_object();
    }
    json.end_array();
    if (answer.repair) {
        json.key("repair")
            .begin_object()
            .member("idea", answer.repair->idea)
            .member("source", answer.repair->source)
            .member("diff", answer.repair->diff)
            .end_object();
    } else {
        json.member("no_repair", answer.reason);
    }
    json.end_object();
    return json.take();
}

int explain(const Arguments& arguments) {
    const std::string path = arguments.text("scene"), rule = arguments.text("rule");
    auto subject = load_subject(path, arguments);
    if (!subject) {
        return subject.error();
    }
    if (!subject->scene) {
        say_error("only scenes are explained: " + path + " has no figures and no story");
        return kBadInput;
    }
    auto options = proving_options(arguments);
    if (!options) {
        return options.error();
    }
    std::vector<Verdict> verdicts;
    verdict::RepairAnswer answer;
    verdict::Explanation explanation;
    const Verdict* v = nullptr;
    io::DiskFiles files;
    {
        ProvingProgress progress(*options);
        verdicts = prove_subject(*subject, *options);
        const auto found = std::find_if(verdicts.begin(), verdicts.end(),
                                        [&](const Verdict& x) { return x.rule == rule; });
        if (found == verdicts.end()) {
            say_error("there is no rule " + rule + "; `puppetri prove " + path + "` lists them");
            return kBadInput;
        }
        v = &*found;
        explanation = verdict::explain(*subject->scene, *v);
        if (v->answer == verdict::Answer::kRefuted) {
            answer = verdict::repair(files, *subject->scene, verdicts, rule, options->budget);
        }
    }
    if (v->witness) {
        const std::string file = witness_path(arguments.text("--output", "out"), v->rule);
        if (auto folders = io::make_parent_folders(file); folders) {
            if (auto written = io::write_file(file, io::write_witness(*v->witness)); !written) {
                say_diagnostics(written.error());
            }
        }
    }
    if (arguments.given("--json")) {
        std::puts(json_of(*v, explanation, answer).c_str());
    } else {
        print(*v, explanation);
        if (v->answer == verdict::Answer::kRefuted) {
            print(answer);
        }
        if (v->witness) {
            std::printf("\nwatch it: puppetri run %s --witness %s\n", path.c_str(),
                        witness_path(arguments.text("--output", "out"), v->rule).c_str());
        }
    }
    if (arguments.given("--apply")) {
        if (!answer.repair) {
            say_error("there is nothing to apply");
            return kFailed;
        }
        if (auto written = io::write_file(path, answer.repair->text); !written) {
            say_diagnostics(written.error());
            return kFailed;
        }
        say(path + " is changed");
        return kFine;
    }
    return verdict::exit_status({*v}, false);
}

}  // namespace

Command explain_command() {
    return {
        "explain", "why a rule fails, in words, and what would mend it",
        "Tells the story of the run that refutes the rule: who waits for what at its end, which "
        "token is missing, which\n"
        "transition took it. Where theory gives a repair (a place that keeps a bound, or keeps a "
        "siphon from running\n"
        "empty), the changed scene is proved before it is offered; --apply writes it.\n"
        "Exit code: as of `prove`, for this rule.\n\n"
        "Examples:\n"
        "  puppetri explain duet.pup everybody\n"
        "  puppetri explain duet.pup everybody --apply",
        with_proving_options(
            {{"scene", Value::kText, "SCENE", "a .pup file with a scene", true},
             {"rule", Value::kText, "RULE", "the path of the rule, as `prove` shows it", true},
             {"--apply", Value::kFlag, "", "change the scene's file as offered", false},
             {"--json", Value::kFlag, "", "everything as JSON on stdout", false}}),
        explain};
}

}  // namespace puppetri::cli
