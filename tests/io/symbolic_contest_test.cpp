// SPDX-License-Identifier: MIT
// Symbolic state spaces of nets that nobody of this project wrote, against answers that nobody of
// this project computed: the Model Checking Contest's oracle, and verifypn for inhibitor arcs.
#include <doctest/doctest.h>

#include <map>
#include <sstream>

#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/symbolic.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io::testing;
using proof::SymbolicSpace;

namespace {

// Rows of a table by the first column; each row by the names in the header.
std::map<std::string, std::map<std::string, std::string>> table(const std::string& text) {
    const auto split = [](const std::string& line) {
        std::vector<std::string> cells;
        std::stringstream in(line);
        for (std::string cell; std::getline(in, cell, '\t');) {
            cells.push_back(cell);
        }
        return cells;
    };
    std::map<std::string, std::map<std::string, std::string>> rows;
    std::stringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = split(line);
    while (std::getline(lines, line)) {
        const std::vector<std::string> cells = split(line);
        for (std::size_t i = 1; i < cells.size() && i < names.size(); ++i) {
            rows[cells[0]][names[i]] = cells[i];
        }
    }
    return rows;
}

proof::PlainNet plain_net(const std::string& path) {
    const Checked<io::NetFile> file = io::load_net(path);
    REQUIRE(file.has_value());
    const Checked<net::Net> net = net::compile(file->draft);
    REQUIRE(net.has_value());
    const proof::Plain plain = proof::plain(*net);
    REQUIRE_FALSE(plain.unsound);
    return plain.net;
}

std::string truth(std::optional<bool> value) {
    return !value.has_value() ? "?" : *value ? "TRUE" : "FALSE";
}

template <class Rule>
std::string all_transitions(SymbolicSpace& space, Rule rule) {
    for (std::uint32_t t = 0; t < space.net().transition_count(); ++t) {
        if (const std::optional<bool> one = rule(t); one != true) {
            return truth(one);
        }
    }
    return "TRUE";
}

TEST_CASE("the contest's nets have the contest's states, edges, bounds and rules [oracle]") {
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        const std::filesystem::path folder = std::filesystem::path(path).parent_path();
        const auto rows = table(file_text(folder.parent_path() / "answers.tsv"));
        CAPTURE(path);
        const auto wanted = rows.at(folder.filename().string());
        proof::Budget budget;
        budget.bytes = std::uint64_t{1} << 30;
        SymbolicSpace space(plain_net(path), budget);
        const auto facts = space.facts();
        REQUIRE(facts.has_value());
        CHECK(facts->states.decimal() == wanted.at("states"));
        CHECK(facts->edges.decimal() == wanted.at("edges"));
        CHECK(std::to_string(facts->max_in_place) == wanted.at("maxTokPlace"));
        CHECK(std::to_string(facts->max_in_marking) == wanted.at("maxTokMarking"));
        CHECK(truth(facts->dead_reachable) == wanted.at("deadlock"));
        CHECK(truth(facts->max_in_place <= 1) == wanted.at("oneSafe"));
        CHECK(all_transitions(space, [&](std::uint32_t t) { return space.quasi_live(t); }) ==
              wanted.at("quasiLive"));
        CHECK(all_transitions(space, [&](std::uint32_t t) { return space.live(t); }) ==
              wanted.at("live"));
        CHECK(space.peak_bytes() < budget.bytes);
        const auto death = space.path_to(space.dead());
        CHECK(death.has_value() == facts->dead_reachable);
        proof::Marking marking = space.net().initial;
        for (const std::uint32_t t : death.value_or(std::vector<std::uint32_t>{})) {
            REQUIRE(space.net().enabled(marking, t));
            space.net().fire(marking, t);
        }
        CHECK((!death.has_value() || space.contains(space.dead(), marking) == true));
        bool stable = false;
        for (std::uint32_t p = 0; p < space.net().place_count() && !stable; ++p) {
            stable = space.stable(p) == true;
        }
        std::stringstream lines(file_text(folder.parent_path() / "query-answers.tsv"));
        const std::string prefix = folder.filename().string() + "\tStableMarking\t-\t";
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(prefix)) {
                CHECK(truth(stable) == line.substr(prefix.size()));
            }
        }
    }
}

TEST_CASE("nets with inhibitor arcs have the states, bounds and deadlocks of verifypn [oracle]") {
    for (const std::string& path : shared_nets("inhibitor", "")) {
        const std::filesystem::path file = path;
        if (file.extension() != ".pnml") {
            continue;
        }
        const auto rows = table(file_text(file.parent_path().parent_path() / "answers.tsv"));
        const auto row = rows.find(file.parent_path().filename().string());
        CAPTURE(path);
        REQUIRE(row != rows.end());
        SymbolicSpace space(plain_net(path), {});
        const auto facts = space.facts();
        REQUIRE(facts.has_value());
        CHECK(facts->states.decimal() == row->second.at("states"));
        CHECK(std::to_string(facts->max_in_place) == row->second.at("max_tokens_in_place"));
        CHECK(truth(facts->dead_reachable) == row->second.at("deadlock"));
    }
}

TEST_CASE("a diagram that has to be swept again and again counts the same [agree]") {
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        if (path.find("MutEx-PT-3") == std::string::npos) {
            continue;
        }
        const proof::PlainNet net = plain_net(path);
        SymbolicSpace roomy(net, {});
        const auto wanted = roomy.facts();
        REQUIRE(wanted.has_value());
        for (std::uint64_t bytes = 5 << 18; bytes <= std::uint64_t{20} << 20; bytes += bytes / 4) {
            proof::Budget budget;
            budget.bytes = bytes;
            SymbolicSpace space(net, budget);
            const auto facts = space.facts();
            CHECK((facts.has_value() || space.ended() == proof::Ended::kMemory));
            CHECK(space.peak_bytes() < bytes + (3u << 20));
            if (facts.has_value()) {
                CHECK(facts->states == wanted->states);
                CHECK(facts->edges == wanted->edges);
                CHECK(truth(space.live(0)) == truth(roomy.live(0)));
            }
        }
    }
}

}  // namespace
