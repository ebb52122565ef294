// SPDX-License-Identifier: MIT
// `puppetri query NET.pnml --queries FILE.xml`: the questions of the Model Checking Contest,
// answered in the contest's form.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "budget_arguments.h"
#include "commands.h"
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

int run(const Arguments& arguments) {
    const std::unique_ptr<WatchedBudget> watched = WatchedBudget::from(arguments);
    if (watched == nullptr) {
        return kBadInput;
    }
    const proof::Budget& budget = watched->budget();
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
    watched->wipe();
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
    std::vector<Option> options = {
        {"net", Value::kText, "NET", "a net: PNML, PIPE, TINA or a scene", true},
        {"--queries", Value::kText, "FILE", "the contest's XML file of properties", false},
        {"--examination", Value::kText, "NAME",
         "StateSpace, ReachabilityDeadlock, QuasiLiveness, Liveness, OneSafe, StableMarking; "
         "beside "
         "--queries it is only a name",
         false},
        {"--json", Value::kFlag, "", "the answers as one JSON object on stdout", false}};
    const std::vector<Option> budget = budget_options();
    options.insert(options.end(), budget.begin(), budget.end());
    return {
        "query", "answer questions of the Model Checking Contest about a net",
        "Each answer is a line in the contest's form, in the order of the file:\n"
        "  FORMULA id TRUE|FALSE|number TECHNIQUES ...\n"
        "  CANNOT_COMPUTE\n"
        "Answers are right or missing. Exits 0 when all questions are answered, 3 otherwise.\n\n"
        "Examples:\n"
        "  puppetri query model.pnml --queries CTLFireability.xml --time 60s\n"
        "  puppetri query model.pnml --examination ReachabilityDeadlock",
        std::move(options), run};
}

}  // namespace puppetri::cli
