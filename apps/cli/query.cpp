// SPDX-License-Identifier: MIT
// `puppetri query NET.pnml --queries FILE.xml`: the questions of the Model Checking Contest,
// answered in the contest's form.
#include <atomic>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "puppetri/base/text.h"
#include "puppetri/io/contest_queries.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/load_net.h"
#include "puppetri/verdict/contest.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using verdict::ContestAnswer;
using verdict::Examination;

constexpr Examination kExaminations[] = {
    Examination::kStateSpace,    Examination::kReachabilityDeadlock,
    Examination::kQuasiLiveness, Examination::kLiveness,
    Examination::kOneSafe,       Examination::kStableMarking};

// A number and the unit behind it, in the least unit of the table.
struct Unit {
    const char* name;
    double factor;
};
std::optional<double> with_unit(const std::string& text, const std::vector<Unit>& units) {
    std::size_t end = 0;
    while (end < text.size() && (text[end] == '.' || (text[end] >= '0' && text[end] <= '9'))) {
        ++end;
    }
    const std::optional<double> number = parse_number(text.substr(0, end));
    for (const Unit& unit : units) {
        if (number.has_value() && text.substr(end) == unit.name) {
            return *number * unit.factor;
        }
    }
    return std::nullopt;
}

std::string json_of(const ContestAnswer& a) {
    std::string text = "{\"id\": \"" + json_escaped(a.id) + "\", \"value\": ";
    text += a.value.empty()      ? "null"
            : a.value == "TRUE"  ? "true"
            : a.value == "FALSE" ? "false"
                                 : a.value;
    if (!a.techniques.empty()) {
        text += ", \"techniques\": \"" + json_escaped(a.techniques) + "\"";
    }
    if (!a.reason.empty()) {
        text += ", \"reason\": \"" + json_escaped(a.reason) + "\"";
    }
    return text + "}";
}

std::atomic<bool> stop{false};

int run(const Arguments& arguments) {
    proof::Budget budget;
    budget.cancelled = &stop;
    // What is long says now and then that it goes on, and hears whether it shall.
    budget.progress = [](void*, const proof::Progress&) {
        if (interrupted()) {
            stop.store(true);
        }
    };
    if (arguments.given("--time")) {
        const auto seconds = with_unit(
            arguments.text("--time"), {{"", 1}, {"s", 1}, {"ms", 0.001}, {"min", 60}, {"h", 3600}});
        if (!seconds.has_value()) {
            say_error("--time: write 30s, 5min or 1h");
            return kBadInput;
        }
        budget.seconds = *seconds;
    }
    if (arguments.given("--memory")) {
        constexpr double kMega = 1024.0 * 1024.0;
        const auto bytes =
            with_unit(arguments.text("--memory"), {{"", kMega}, {"M", kMega}, {"G", 1024 * kMega}});
        if (!bytes.has_value() || *bytes > 1e15) {
            say_error("--memory: write 500M or 2G");
            return kBadInput;
        }
        budget.bytes = static_cast<std::uint64_t>(*bytes);
    }
    const std::int64_t threads = arguments.integer("--threads", 1);
    if (threads < 1 || threads > 1024) {
        say_error("--threads: write a number from 1 to 1024");
        return kBadInput;
    }
    budget.threads = static_cast<unsigned>(threads);

    std::optional<Examination> examination;
    const std::string name = arguments.text("--examination");
    for (const Examination e : kExaminations) {
        if (name == verdict::name_of(e)) {
            examination = e;
        }
    }
    if (arguments.given("--queries") == examination.has_value()) {
        say_error(examination.has_value()
                      ? "--queries: " + name + " needs no file of queries"
                      : "say which questions: --queries FILE, or --examination with StateSpace, "
                        "ReachabilityDeadlock, QuasiLiveness, Liveness, OneSafe or StableMarking");
        return kBadInput;
    }

    const auto file = io::load_net(arguments.text("net"));
    if (!file.has_value()) {
        say_diagnostics(file.error());
        return kBadInput;
    }
    const auto net = net::compile(file->draft);
    if (!net.has_value()) {
        say_diagnostics(net.error());
        return kBadInput;
    }
    std::vector<ContestAnswer> answers;
    const bool json = arguments.given("--json");
    if (examination.has_value()) {
        answers = verdict::answer_examination(*net, *examination, budget);
    } else {
        const std::string path = arguments.text("--queries");
        const auto text = io::DiskFiles().read(path);
        if (!text.has_value()) {
            say_error(path + ": " + text.error().message);
            return kBadInput;
        }
        const auto queries = io::read_contest_queries(*text, path, *file);
        if (!queries.has_value()) {
            say_diagnostics(queries.error());
            return kBadInput;
        }
        answers = verdict::answer_queries(*net, queries->queries, budget);
    }
    bool all = true;
    std::string out;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        all = all && !answers[i].value.empty();
        out += json ? (i > 0 ? ",\n  " : "\n  ") + json_of(answers[i])
                    : contest_line(answers[i]) + "\n";
        if (!json && answers[i].value.empty()) {
            say(answers[i].id + ": " + answers[i].reason);
        }
    }
    if (json) {
        out = "{\"answers\": [" + out + "]}\n";
    }
    std::fputs(out.c_str(), stdout);
    return all ? kFine : kUnknown;
}

}  // namespace

Command query_command() {
    return {
        "query",
        "answer questions of the Model Checking Contest about a net",
        "Each answer is a line in the contest's form, in the order of the file:\n"
        "  FORMULA id TRUE|FALSE|number TECHNIQUES ...\n"
        "  CANNOT_COMPUTE\n"
        "Answers are right or missing. Exits 0 when all questions are answered, 3 otherwise.\n\n"
        "Examples:\n"
        "  puppetri query model.pnml --queries CTLFireability.xml --time 60s\n"
        "  puppetri query model.pnml --examination ReachabilityDeadlock",
        {{"net", Value::kText, "NET", "a net: PNML, PIPE, TINA or a scene", true},
         {"--queries", Value::kText, "FILE", "the contest's XML file of properties", false},
         {"--examination", Value::kText, "NAME",
          "StateSpace, ReachabilityDeadlock, QuasiLiveness, Liveness, OneSafe, StableMarking; "
          "beside --queries it is only a name",
          false},
         {"--time", Value::kText, "T", "give up after so long (60s, 5min; default 60s)", false},
         {"--memory", Value::kText, "M", "hold at most so much (500M, 2G; default 4G)", false},
         {"--threads", Value::kInteger, "N", "work on so many cores; the answers are the same",
          false},
         {"--json", Value::kFlag, "", "the answers as one JSON object on stdout", false}},
        run};
}

}  // namespace puppetri::cli
