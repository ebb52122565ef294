// SPDX-License-Identifier: MIT
// What `puppetri prove NET` asks of every net, against the contest's answers and verifypn's: all
// nets of ../shared/nets/mcc and ../shared/nets/inhibitor. The two largest nets (six seconds) only
// with PUPPETRI_LONG=1. Witnesses are played here, firing by firing, on the markings alone.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "puppetri/io/pnml.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/verdict/prove.h"
#include "shared_nets.h"

namespace puppetri::io {

using testing::file_text;
using testing::shared_nets;
using verdict::Answer;
using verdict::Verdict;

namespace {

// Rows by their first field; the first row names the columns.
std::map<std::string, std::map<std::string, std::string>> table(const std::string& path) {
    std::map<std::string, std::map<std::string, std::string>> rows;
    std::vector<std::string> names;
    std::istringstream lines(file_text(path));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        std::vector<std::string> row;
        for (std::string field; std::getline(fields, field, '\t');) {
            row.push_back(field);
        }
        if (names.empty()) {
            names = row;
            continue;
        }
        for (std::size_t i = 0; i < row.size() && i < names.size(); ++i) {
            rows[row[0]][names[i]] = row[i];
        }
    }
    return rows;
}

struct Proved {
    net::Net net;
    std::map<std::string, Verdict> verdicts;
};
Proved proved(const std::string& path, double seconds) {
    const auto file = read_pnml(file_text(path), path);
    REQUIRE(file.has_value());
    auto net = net::compile(file->draft);
    REQUIRE(net.has_value());
    verdict::ProveOptions options;
    options.budget.seconds = seconds;
    options.budget.bytes = std::uint64_t{2} << 30;
    Proved out{std::move(*net), {}};
    for (Verdict& v : verdict::prove(file->draft, out.net, options)) {
        out.verdicts.emplace(v.rule, std::move(v));
    }
    return out;
}

// The marking after a witness; each firing is enabled where it happens.
proof::Marking after(const proof::PlainNet& plain, const net::Net& net,
                     const verdict::Witness& witness) {
    proof::Marking m = plain.initial;
    for (const verdict::Witness::Step& step : witness.steps) {
        const std::uint32_t t = net.find_transition(step.transition).value;
        REQUIRE(t < plain.transition_count());
        REQUIRE(plain.enabled(m, t));
        plain.fire(m, t);
    }
    return m;
}

bool dead(const proof::PlainNet& plain, const proof::Marking& m) {
    for (std::uint32_t t = 0; t < plain.transition_count(); ++t) {
        if (plain.enabled(m, t)) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("rules asked of every net agree with the contest's answers [oracle]") {
    const bool all = std::getenv("PUPPETRI_LONG") != nullptr;
    std::map<std::string, std::map<std::string, std::string>> answers;
    for (const std::string& path : shared_nets("mcc", "answers.tsv")) {
        answers = table(path);
    }
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        const std::string model = std::filesystem::path(path).parent_path().filename().string();
        CAPTURE(model);
        if (!all && (model == "Dekker-PT-015" || model == "LamportFastMutEx-PT-4")) {
            continue;
        }
        REQUIRE(answers.count(model) == 1);
        const Proved p = proved(path, 60);
        const proof::PlainNet plain = proof::plain(p.net).net;
        const auto expect = [&](const char* rule, bool holds) {
            CAPTURE(rule);
            const Verdict& v = p.verdicts.at(rule);
            CAPTURE(v.reason);
            CHECK(v.answer == (holds ? Answer::kProved : Answer::kRefuted));
        };
        const auto& answer = answers[model];
        expect("deadlock_free", answer.at("deadlock") == "FALSE");
        expect("live", answer.at("live") == "TRUE");
        expect("quasi_live", answer.at("quasiLive") == "TRUE");
        expect("bounded", true);
        const Verdict& back = p.verdicts.at("reversible");
        CHECK(back.answer != Answer::kUnknown);
        if (answer.at("deadlock") == "TRUE") {
            CHECK(back.answer == Answer::kRefuted);
            const Verdict& stops = p.verdicts.at("deadlock_free");
            REQUIRE(stops.witness.has_value());
            CHECK(dead(plain, after(plain, p.net, *stops.witness)));
        }
        for (const auto& [rule, v] : p.verdicts) {
            if (v.answer == Answer::kRefuted && rule != "quasi_live") {
                CAPTURE(rule);
                REQUIRE(v.witness.has_value());
                after(plain, p.net, *v.witness);
            }
        }
    }
}

TEST_CASE("nets with inhibitor arcs come to rest where verifypn says so [oracle]") {
    std::map<std::string, std::map<std::string, std::string>> answers;
    for (const std::string& path : shared_nets("inhibitor", "answers.tsv")) {
        answers = table(path);
    }
    int asked = 0;
    for (const std::string& path : shared_nets("inhibitor", "model.pnml")) {
        const std::string model = std::filesystem::path(path).parent_path().filename().string();
        CAPTURE(model);
        const auto answer = answers.find(model);
        if (answer == answers.end()) {
            continue;
        }
        ++asked;
        const Proved p = proved(path, 20);
        const Verdict& v = p.verdicts.at("deadlock_free");
        CAPTURE(v.reason);
        CHECK(v.answer ==
              (answer->second.at("deadlock") == "TRUE" ? Answer::kRefuted : Answer::kProved));
        if (v.witness) {
            const proof::PlainNet plain = proof::plain(p.net).net;
            CHECK(dead(plain, after(plain, p.net, *v.witness)));
        }
    }
    CHECK((answers.empty() || asked > 50));
}

}  // namespace puppetri::io
