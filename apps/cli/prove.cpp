// SPDX-License-Identifier: MIT
// `puppetri prove SCENE`: every rule with its verdict, before a frame exists.
#include <algorithm>
#include <array>
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
#include "puppetri/verdict/times.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using verdict::Answer;
using verdict::TimeAnswer;
using verdict::TimeEnd;
using verdict::Verdict;

// Witnesses as files: one per verdict, for answers of the quickest and of the slowest run.
struct Files {
    std::vector<std::string> of_verdict;
    std::vector<std::array<std::string, 2>> of_answer;
};

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

void print_assumptions(std::vector<std::string> assumptions, bool verbose) {
    if (!assumptions.empty()) {
        std::printf("\nassuming:\n");
        std::sort(assumptions.begin(), assumptions.end());
        assumptions.erase(std::unique(assumptions.begin(), assumptions.end()), assumptions.end());
        for (const std::string& a : verbose ? assumptions : said_once(assumptions)) {
            print_paragraph(a, 2);
        }
    }
}

void print_rules(const std::vector<Verdict>& verdicts, const std::vector<std::string>& witnesses,
                 bool verbose) {
    std::size_t names = 4, rules = 4, methods = 6, sizes = 4;
    for (const Verdict& v : verdicts) {
        names = std::max(names, verdict::name_of(v).size());
        rules = std::max<std::size_t>(rules, count_code_points(v.rule));
        methods = std::max(methods, v.method.size());
        sizes = std::max(sizes, size_of(v).size());
    }
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
    }
}

std::string size_of(const TimeAnswer& a) {
    return a.states == 0 ? "" : std::to_string(a.states) + " states";
}

const char* form_of(net::TimeQuestionKind kind) {
    switch (kind) {
        case net::TimeQuestionKind::kShortest:
            return "shortest time";
        case net::TimeQuestionKind::kLongest:
            return "longest time";
        default:
            return "cycle time";
    }
}

void print_answers(const std::vector<TimeAnswer>& answers, FrameRate rate,
                   const std::vector<std::array<std::string, 2>>& witnesses) {
    std::size_t names = 0, forms = 0, texts = 0, methods = 0, sizes = 0;
    for (const TimeAnswer& a : answers) {
        names = std::max<std::size_t>(names, count_code_points(a.question));
        forms = std::max(forms, std::string_view(form_of(a.kind)).size());
        texts = std::max(texts, verdict::text(a, rate).size());
        methods = std::max(methods, a.method.size());
        sizes = std::max(sizes, size_of(a).size());
    }
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const TimeAnswer& a = answers[i];
        std::printf("%s  %s  %s%s%s  %s  %s  %s\n", padded(a.question, names).c_str(),
                    padded(form_of(a.kind), forms).c_str(),
                    colours() && !a.known() ? "\033[33m" : "",
                    padded(verdict::text(a, rate), texts).c_str(),
                    colours() && !a.known() ? "\033[0m" : "", padded(a.method, methods).c_str(),
                    padded(size_of(a), sizes).c_str(), seconds_text(a.seconds).c_str());
        const std::string indent(names + 2, ' ');
        std::string last;
        for (const auto* end : {&a.quickest, &a.slowest}) {
            if (*end && !(*end)->reason.empty() && (*end)->reason != last) {
                last = (*end)->reason;
                print_paragraph(last, indent.size());
            }
        }
        for (const std::string& note : a.notes) {
            print_paragraph(note, indent.size());
        }
        for (const std::string& file : witnesses[i]) {
            if (!file.empty()) {
                std::printf("%switness: %s\n", indent.c_str(), file.c_str());
            }
        }
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

void add_texts(io::JsonWriter& json, const char* name, const std::vector<std::string>& list) {
    json.key(name).begin_array();
    for (const std::string& text : list) {
        json.string(text);
    }
    json.end_array();
}

void add_rule(io::JsonWriter& json, const Verdict& v, const std::string& witness) {
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
    add_texts(json, "assumptions", v.assumptions);
    add_texts(json, "notes", v.notes);
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
    if (!witness.empty()) {
        json.member("witness", witness);
    }
    json.end_object();
}

void add_end(io::JsonWriter& json, const char* name, const TimeEnd& end,
             const std::string& witness) {
    const char* words[] = {"time", "never", "no bound", "unknown"};
    json.key(name).begin_object().member("answer", words[static_cast<std::size_t>(end.says)]);
    if (end.says == TimeEnd::Says::kTime) {
        json.member("seconds", end.time.seconds())
            .member("exactly", verdict::exact_seconds(end.time))
            .member("exact", end.exact);
    }
    json.member("reason", end.reason);
    if (!witness.empty()) {
        json.member("witness", witness);
        if (end.says != TimeEnd::Says::kNoBound) {
            json.member("witness_seconds", end.shown.seconds());
        }
    }
    json.end_object();
}

void add_answer(io::JsonWriter& json, const TimeAnswer& a, FrameRate rate,
                const std::array<std::string, 2>& witnesses) {
    json.begin_object()
        .member("question", a.question)
        .member("caption", a.caption)
        .member("file", a.where.file)
        .member("line", static_cast<std::int64_t>(a.where.line))
        .member("asks", form_of(a.kind))
        .member("text", verdict::text(a, rate));
    if (a.quickest) {
        add_end(json, "quickest", *a.quickest, witnesses[0]);
    }
    if (a.slowest) {
        add_end(json, "slowest", *a.slowest, witnesses[1]);
    }
    json.member("method", a.method);
    add_texts(json, "assumptions", a.assumptions);
    add_texts(json, "notes", a.notes);
    json.member("states", static_cast<std::int64_t>(a.states))
        .member("edges", static_cast<std::int64_t>(a.edges))
        .member("seconds", a.seconds)
        .end_object();
}

std::string json_of(const std::vector<Verdict>& verdicts, const std::vector<TimeAnswer>& answers,
                    FrameRate rate, const Files& files, int status) {
    io::JsonWriter json;
    json.begin_object().member("exit", status).key("rules").begin_array();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        add_rule(json, verdicts[i], files.of_verdict[i]);
    }
    json.end_array().key("questions").begin_array();
    for (std::size_t i = 0; i < answers.size(); ++i) {
        add_answer(json, answers[i], rate, files.of_answer[i]);
    }
    json.end_array().end_object();
    return json.take();
}

// Gives the path; empty: it could not be written, which has been said.
std::string written(const std::string& folder, const std::string& name,
                    const verdict::Witness& witness) {
    const std::string path = witness_path(folder, name);
    auto folders = io::make_parent_folders(path);
    auto done = folders ? io::write_file(path, io::write_witness(witness)) : std::move(folders);
    if (!done) {
        say_diagnostics(done.error());
        return "";
    }
    return path;
}

Files write_witnesses(const std::string& folder, const std::vector<Verdict>& verdicts,
                      const std::vector<TimeAnswer>& answers) {
    Files files;
    for (const Verdict& v : verdicts) {
        files.of_verdict.push_back(v.witness ? written(folder, v.rule, *v.witness) : "");
    }
    for (const TimeAnswer& a : answers) {
        std::array<std::string, 2> paths;
        const bool both = a.quickest && a.quickest->witness && a.slowest && a.slowest->witness &&
                          *a.quickest->witness != *a.slowest->witness;
        if (a.quickest && a.quickest->witness) {
            paths[0] =
                written(folder, a.question + (both ? ".quickest" : ""), *a.quickest->witness);
        }
        if (a.slowest && a.slowest->witness && (both || paths[0].empty())) {
            paths[1] = written(folder, a.question + (both ? ".slowest" : ""), *a.slowest->witness);
        }
        files.of_answer.push_back(std::move(paths));
    }
    return files;
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
    std::vector<TimeAnswer> answers;
    {
        ProvingProgress progress(*options);
        const double begun = clock_s();
        verdicts = prove_subject(*subject, *options);
        if (subject->scene) {
            options->budget.seconds = std::max(0.0, options->budget.seconds - (clock_s() - begun));
            answers = verdict::answer_times(*subject->scene, *options);
        }
    }
    if (verdicts.empty() && answers.empty() && !options->only.empty()) {
        say_error("there is no rule or question " + options->only);
        return kBadInput;
    }
    if (verdicts.empty() && answers.empty() && !arguments.given("--json")) {
        std::puts("there is nothing to prove: it has no rules, and no figures that move");
    }
    const Files files = write_witnesses(arguments.text("--output", "out"), verdicts, answers);
    const int status = verdict::exit_status(verdicts, answers, arguments.given("--accept-sampled"));
    const FrameRate rate = subject->scene ? subject->scene->frame_rate : FrameRate{};
    if (arguments.given("--json")) {
        std::puts(json_of(verdicts, answers, rate, files, status).c_str());
    } else {
        const bool verbose = arguments.given("--verbose");
        print_rules(verdicts, files.of_verdict, verbose);
        if (!answers.empty()) {
            std::printf("%squestions:\n", verdicts.empty() ? "" : "\n");
            print_answers(answers, rate, files.of_answer);
        }
        std::vector<std::string> assumptions;
        for (const Verdict& v : verdicts) {
            assumptions.insert(assumptions.end(), v.assumptions.begin(), v.assumptions.end());
        }
        for (const TimeAnswer& a : answers) {
            assumptions.insert(assumptions.end(), a.assumptions.begin(), a.assumptions.end());
        }
        print_assumptions(std::move(assumptions), verbose);
        const auto refuted = std::find_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) {
            return v.answer == Answer::kRefuted && v.witness;
        });
        if (refuted != verdicts.end() && subject->scene) {
            std::printf("\nwhy, and what would mend it: puppetri explain %s %s\n",
                        arguments.text("scene").c_str(), refuted->rule.c_str());
        }
    }
    if (interrupted()) {
        say("stopped: what is UNKNOWN may be known with more time");
    }
    return status;
}

}  // namespace

Command prove_command() {
    return {
        "prove", "prove the rules of a scene or a net, and answer its questions",
        "Proves each rule of the scene, and those that every scene has to keep (builtin.*), for "
        "all ways the net can go,\n"
        "or refutes it by a run that you can watch; otherwise the answer is UNKNOWN, with the "
        "reason. Then answers its questions\n"
        "(shortest and longest time to a state, cycle time) with numbers. docs/proof.md says\n"
        "what each verdict means. A net of another program without rules is asked for deadlock, "
        "bounds and liveness.\n"
        "Exit code: 0 all proved, 1 some rule refuted, 2 bad input, 3 something unknown.\n\n"
        "Examples:\n"
        "  puppetri prove ball.pup\n"
        "  puppetri prove ball.pup --rule caught --json\n"
        "  puppetri run duet.pup --witness out/everybody.witness.json\n"
        "  puppetri prove net.pnml --time 5min --memory 8G",
        with_proving_options(
            {{"scene", Value::kText, "SCENE",
              "a scene (.pup, .scxml, .tookima) or a net (.pnml, .xml, .net)", true},
             {"--rule", Value::kText, "NAME",
              "this rule or question only (of a loop: all its instances)", false},
             {"--samples", Value::kInteger, "N", "sample so many runs where nothing else answers",
              false},
             {"--accept-sampled", Value::kFlag, "", "let SAMPLED count as proved", false},
             {"-v,--verbose", Value::kFlag, "", "invariants and assumptions in full", false},
             {"--json", Value::kFlag, "", "the verdicts as JSON on stdout", false}}),
        prove};
}

}  // namespace puppetri::cli
