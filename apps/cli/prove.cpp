// SPDX-License-Identifier: MIT
// `puppetri prove SCENE`: every rule with its verdict, before a frame exists.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "paragraph.h"
#include "proving.h"
#include "puppetri/base/text.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/io/witness_file.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using verdict::Answer;
using verdict::Verdict;

const char* colour_of(const Verdict& v) {
    switch (v.answer) {
        case Answer::kProved:
            return "\033[32m";
        case Answer::kRefuted:
            return "\033[1;31m";
        default:
            return "\033[33m";
    }
}

std::string padded(std::string text, std::size_t width) {
    const std::size_t length = count_code_points(text);
    return text.append(length < width ? width - length : 0, ' ');
}

std::string size_of(const Verdict& v) {
    return v.states == 0 ? "" : std::to_string(v.states) + " states";
}

void print_table(const std::vector<Verdict>& verdicts, const std::vector<std::string>& witnesses,
                 const std::string& scene, bool verbose) {
    std::size_t names = 4, rules = 4, methods = 6, sizes = 4;
    for (const Verdict& v : verdicts) {
        names = std::max(names, verdict::name_of(v).size());
        rules = std::max<std::size_t>(rules, count_code_points(v.rule));
        methods = std::max(methods, v.method.size());
        sizes = std::max(sizes, size_of(v).size());
    }
    std::vector<std::string> assumptions;
    const Verdict* refuted = nullptr;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        const Verdict& v = verdicts[i];
        std::printf("%s%s%s  %s  %s  %s  %s\n", colours() ? colour_of(v) : "",
                    padded(verdict::name_of(v), names).c_str(), colours() ? "\033[0m" : "",
                    padded(v.rule, rules).c_str(), padded(v.method, methods).c_str(),
                    padded(size_of(v), sizes).c_str(), seconds_text(v.seconds).c_str());
        const std::string indent(names + 2, ' ');
        if (v.answer != Answer::kProved && !v.caption.empty()) {
            std::printf("%s\"%s\"\n", indent.c_str(), v.caption.c_str());
        }
        if (!v.reason.empty()) {
            print_paragraph(v.reason, indent.size());
        }
        if (v.sample) {
            std::printf("%s%s of %s runs kept it: probability %s to %s (confidence %s)\n",
                        indent.c_str(), std::to_string(v.sample->kept).c_str(),
                        std::to_string(v.sample->runs).c_str(),
                        number_to_text_fixed(v.sample->low, 4).c_str(),
                        number_to_text_fixed(v.sample->high, 4).c_str(),
                        number_to_text(v.sample->confidence).c_str());
        }
        const std::size_t room = columns() > indent.size() ? columns() - indent.size() : 0;
        for (const std::string& note : v.notes) {
            print_paragraph(verbose ? note : short_sum(note, room), indent.size());
        }
        if (!witnesses[i].empty()) {
            std::printf("%switness: %s\n", indent.c_str(), witnesses[i].c_str());
        }
        assumptions.insert(assumptions.end(), v.assumptions.begin(), v.assumptions.end());
        if (refuted == nullptr && v.answer == Answer::kRefuted && v.witness) {
            refuted = &v;
        }
    }
    if (!assumptions.empty()) {
        std::printf("\nassuming:\n");
        std::sort(assumptions.begin(), assumptions.end());
        assumptions.erase(std::unique(assumptions.begin(), assumptions.end()), assumptions.end());
        for (const std::string& a : verbose ? assumptions : said_once(assumptions)) {
            print_paragraph(a, 2);
        }
    }
    if (refuted != nullptr && !scene.empty()) {
        std::printf("\nwhy, and what would mend it: puppetri explain %s %s\n", scene.c_str(),
                    refuted->rule.c_str());
    }
}

const char* word_of(Answer answer) {
    switch (answer) {
        case Answer::kProved:
            return "proved";
        case Answer::kRefuted:
            return "refuted";
        case Answer::kSampled:
            return "sampled";
        default:
            return "unknown";
    }
}

std::string json_of(const std::vector<Verdict>& verdicts, const std::vector<std::string>& witnesses,
                    int status) {
    io::JsonWriter json;
    json.begin_object().member("exit", status).key("rules").begin_array();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        const Verdict& v = verdicts[i];
        json.begin_object()
            .member("rule", v.rule)
            .member("caption", v.caption)
            .member("file", v.where.file)
            .member("line", static_cast<std::int64_t>(v.where.line))
            .member("built_in", v.built_in)
            .member("answer", word_of(v.answer))
            .member("verdict", verdict::name_of(v))
            .member("method", v.method)
            .member("reason", v.reason);
        const auto texts = [&](const char* name, const std::vector<std::string>& list) {
            json.key(name).begin_array();
            for (const std::string& text : list) {
                json.string(text);
            }
            json.end_array();
        };
        texts("assumptions", v.assumptions);
        texts("notes", v.notes);
        json.member("states", static_cast<std::int64_t>(v.states))
            .member("edges", static_cast<std::int64_t>(v.edges))
            .member("seconds", v.seconds);
        if (v.sample) {
            json.key("sample")
                .begin_object()
                .member("runs", static_cast<std::int64_t>(v.sample->runs))
                .member("kept", static_cast<std::int64_t>(v.sample->kept))
                .member("low", v.sample->low)
                .member("high", v.sample->high)
                .member("confidence", v.sample->confidence)
                .end_object();
        }
        if (!witnesses[i].empty()) {
            json.member("witness", witnesses[i]);
        }
        json.end_object();
    }
    json.end_array().end_object();
    return json.take();
}

int prove(const Arguments& arguments) {
    auto subject = load_subject(arguments.text("scene"), arguments);
    if (!subject) {
        return subject.error();
    }
    auto options = proving_options(arguments);
    if (!options) {
        return options.error();
    }
    options->only = arguments.text("--rule");
    if (arguments.given("--samples")) {
        options->samples = static_cast<std::uint64_t>(
            std::clamp<std::int64_t>(arguments.integer("--samples"), 0, 1'000'000'000));
    }
    std::vector<Verdict> verdicts;
    {
        ProvingProgress progress(*options);
        verdicts = prove_subject(*subject, *options);
    }
    if (verdicts.empty() && !options->only.empty()) {
        say_error("there is no rule " + options->only);
        return kBadInput;
    }
    if (verdicts.empty() && !arguments.given("--json")) {
        std::puts("there is nothing to prove: it has no rules, and no figures that move");
    }
    const std::string folder = arguments.text("--output", "out");
    std::vector<std::string> witnesses(verdicts.size());
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        if (!verdicts[i].witness) {
            continue;
        }
        const std::string path = witness_path(folder, verdicts[i].rule);
        auto folders = io::make_parent_folders(path);
        auto written = folders ? io::write_file(path, io::write_witness(*verdicts[i].witness))
                               : std::move(folders);
        if (!written) {
            say_diagnostics(written.error());
        } else {
            witnesses[i] = path;
        }
    }
    const int status = verdict::exit_status(verdicts, arguments.given("--accept-sampled"));
    if (arguments.given("--json")) {
        std::puts(json_of(verdicts, witnesses, status).c_str());
    } else {
        print_table(verdicts, witnesses, subject->scene ? arguments.text("scene") : "",
                    arguments.given("--verbose"));
    }
    if (interrupted()) {
        say("stopped: what is UNKNOWN may be known with more time");
    }
    return status;
}

}  // namespace

Command prove_command() {
    return {
        "prove", "prove the rules of a scene or a net",
        "Proves each rule of the scene, and those that every scene has to keep (builtin.*), for "
        "all ways the net can go,\n"
        "or refutes it by a run that you can watch; otherwise the answer is UNKNOWN, with the "
        "reason. docs/proof.md says\n"
        "what each verdict means. A net of another program without rules is asked for deadlock, "
        "bounds and liveness.\n"
        "Exit code: 0 all proved, 1 some rule refuted, 2 bad input, 3 something unknown.\n\n"
        "Examples:\n"
        "  puppetri prove ball.pup\n"
        "  puppetri prove ball.pup --rule caught --json\n"
        "  puppetri run duet.pup --witness out/everybody.witness.json\n"
        "  puppetri prove net.pnml --time 5min --memory 8G",
        with_proving_options(
            {{"scene", Value::kText, "SCENE", "a scene (.pup) or a net (.pnml, .xml, .net)", true},
             {"--rule", Value::kText, "NAME", "this rule only (of a loop: all its instances)",
              false},
             {"--samples", Value::kInteger, "N", "sample so many runs where nothing else answers",
              false},
             {"--accept-sampled", Value::kFlag, "", "let SAMPLED count as proved", false},
             {"-v,--verbose", Value::kFlag, "", "invariants and assumptions in full", false},
             {"--json", Value::kFlag, "", "the verdicts as JSON on stdout", false}}),
        prove};
}

}  // namespace puppetri::cli
