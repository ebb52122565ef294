// SPDX-License-Identifier: MIT
// The contest's questions against the contest's answers: all nets of ../shared/nets/mcc. Short
// form: the nets of at most 10 000 states. Long form, all of them with 60 s
// per file on two cores: PUPPETRI_LONG=1 (about ten minutes). Prints a table per examination.
#include "puppetri/verdict/contest.h"

#include <cstdio>
#include <ctime>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "puppetri/io/contest_queries.h"
#include "puppetri/io/pnml.h"
#include "shared_nets.h"

namespace puppetri::io {

using testing::file_text;
using testing::shared_nets;
using verdict::ContestAnswer;
using verdict::Examination;

namespace {

bool long_form() { return std::getenv("PUPPETRI_LONG") != nullptr; }

constexpr Examination kExaminations[] = {
    Examination::kStateSpace,    Examination::kReachabilityDeadlock,
    Examination::kQuasiLiveness, Examination::kLiveness,
    Examination::kOneSafe,       Examination::kStableMarking};
constexpr const char* kFiles[] = {
    "UpperBounds",    "ReachabilityCardinality", "ReachabilityFireability", "CTLCardinality",
    "CTLFireability", "LTLCardinality",          "LTLFireability"};

std::vector<std::vector<std::string>> table(const std::string& path) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(file_text(path));
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, '\t');) {
            rows.back().push_back(field);
        }
    }
    return rows;
}

double processor_s() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

struct Tally {
    int asked = 0, answered = 0, wrong = 0;
    double seconds = 0, longest = 0;
};

struct Loaded {
    NetFile file;
    net::Net net;
};
std::optional<Loaded> load(const std::string& path) {
    auto file = read_pnml(file_text(path), path);
    if (!file.has_value()) {
        return std::nullopt;
    }
    auto net = net::compile(file->draft);
    if (!net.has_value()) {
        return std::nullopt;
    }
    return Loaded{std::move(*file), std::move(*net)};
}

proof::Budget budget() {
    proof::Budget b;
    b.seconds = 60;
    b.bytes = std::uint64_t{3} << 30;
    b.threads = long_form() ? 2 : 1;
    return b;
}

std::string model_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().filename().string();
}

void print(const char* title, const std::map<std::string, Tally>& tallies) {
    std::printf("%s\n%-26s %6s %9s %6s %11s %10s\n", title, "examination", "asked", "answered",
                "wrong", "processor s", "longest");
    Tally all;
    for (const auto& [name, t] : tallies) {
        std::printf("%-26s %6d %9d %6d %11.2f %10.2f\n", name.c_str(), t.asked, t.answered, t.wrong,
                    t.seconds, t.longest);
        all.asked += t.asked;
        all.answered += t.answered;
        all.wrong += t.wrong;
        all.seconds += t.seconds;
    }
    std::printf("%-26s %6d %9d %6d %11.2f\n", "all", all.asked, all.answered, all.wrong,
                all.seconds);
}

}  // namespace

TEST_CASE("no answer to the contest's questions is wrong, and nearly all are answered [oracle]") {
    // model, examination, index -> answer
    std::map<std::string, std::string> expected;
    for (const std::string& path : shared_nets("mcc", "query-answers.tsv")) {
        for (const auto& row : table(path)) {
            expected[row[0] + "/" + row[1] + "/" + row[2]] = row[3];
        }
    }
    std::map<std::string, double> states;
    for (const std::string& path : shared_nets("mcc", "answers.tsv")) {
        for (const auto& row : table(path)) {
            static const std::pair<const char*, std::size_t> kCounts[] = {
                {"STATES", 4},
                {"TRANSITIONS", 5},
                {"MAX_TOKEN_IN_PLACE", 6},
                {"MAX_TOKEN_PER_MARKING", 7}};
            for (const auto& [name, column] : kCounts) {
                expected[row[0] + "/StateSpace/" + name] = row[column];
            }
            states[row[0]] = std::atof(row[4].c_str());
        }
    }
    std::map<std::string, Tally> tallies;
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        const std::string model = model_of(path);
        if (!long_form() && states[model] > 10'000) {
            continue;
        }
        const auto loaded = load(path);
        REQUIRE(loaded.has_value());
        const auto judge = [&](Tally& tally, const ContestAnswer& a, const std::string& key) {
            INFO(key);
            REQUIRE(expected.count(key) == 1);
            ++tally.asked;
            if (!a.value.empty()) {
                ++tally.answered;
                const bool right = a.value == expected[key];
                tally.wrong += right ? 0 : 1;
                CHECK(a.value == expected[key]);
            } else {
                MESSAGE("not answered: " << key << ": " << a.reason);
            }
        };
        const auto timed = [](Tally& tally, double begun) {
            const double seconds = processor_s() - begun;
            tally.seconds += seconds;
            tally.longest = std::max(tally.longest, seconds);
        };
        for (const Examination e : kExaminations) {
            Tally& tally = tallies[name_of(e)];
            const double begun = processor_s();
            const auto answers = verdict::answer_examination(loaded->net, e, budget());
            timed(tally, begun);
            for (const ContestAnswer& a : answers) {
                judge(tally, a,
                      model + "/" + name_of(e) + "/" +
                          (e == Examination::kStateSpace ? a.id : std::string("-")));
            }
        }
        for (const char* name : kFiles) {
            const std::string xml =
                (std::filesystem::path(path).parent_path() / (std::string(name) + ".xml")).string();
            Tally& tally = tallies[name];
            const double begun = processor_s();
            const auto queries = read_contest_queries(file_text(xml), xml, loaded->file);
            REQUIRE(queries.has_value());
            const auto answers = verdict::answer_queries(loaded->net, queries->queries, budget());
            timed(tally, begun);
            for (std::size_t i = 0; i < answers.size(); ++i) {
                char index[8];
                std::snprintf(index, sizeof index, "%02u", queries->rank[i]);
                judge(tally, answers[i], model + "/" + name + "/" + index);
            }
        }
    }
    if (!tallies.empty()) {
        print("Model Checking Contest", tallies);
        int asked = 0, answered = 0;
        for (const auto& [name, t] : tallies) {
            asked += t.asked;
            answered += t.answered;
        }
        CHECK(answered >= asked * 99 / 100);
    }
}

TEST_CASE("nets with inhibitor arcs have the states and deadlocks that verifypn found [oracle]") {
    std::map<std::string, std::vector<std::string>> expected;
    for (const std::string& path : shared_nets("inhibitor", "answers.tsv")) {
        for (const auto& row : table(path)) {
            expected[row[0]] = row;
        }
    }
    for (const std::string& path : shared_nets("inhibitor", "model.pnml")) {
        const std::string model = model_of(path);
        INFO(model);
        const auto loaded = load(path);
        REQUIRE(loaded.has_value());
        REQUIRE(expected.count(model) == 1);
        const auto counts =
            verdict::answer_examination(loaded->net, Examination::kStateSpace, budget());
        CHECK(counts[0].value == expected[model][1]);
        CHECK(counts[3].value == expected[model][2]);
        const auto dead =
            verdict::answer_examination(loaded->net, Examination::kReachabilityDeadlock, budget());
        CHECK(dead[0].value == expected[model][3]);
        // The ids of its queries tell what they are in TAPAAL's timed original, which does less
        // than the net without time: what is reachable there is reachable here. Not so where the
        // formula asks for a dead marking.
        const std::string xml = (std::filesystem::path(path).parent_path() / "query.xml").string();
        if (!std::filesystem::exists(xml)) {
            continue;
        }
        const std::string text = file_text(xml);
        const auto queries = read_contest_queries(text, xml, loaded->file);
        REQUIRE(queries.has_value());
        const auto answers = verdict::answer_queries(loaded->net, queries->queries, budget());
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const verdict::ContestQuery& q = queries->queries[i];
            INFO(q.id);
            CHECK_FALSE(answers[i].value.empty());
            if (q.kind == verdict::QueryKind::kReachability &&
                text.find("<deadlock") == std::string::npos) {
                const bool exists = q.formula.nodes.back().op == net::FormulaOp::kSomeFinally;
                if (exists && q.id.find("TRUE") != std::string::npos) {
                    CHECK(answers[i].value == "TRUE");
                }
                if (!exists && q.id.find("FALSE") != std::string::npos) {
                    CHECK(answers[i].value == "FALSE");
                }
            }
        }
    }
}

}  // namespace puppetri::io
