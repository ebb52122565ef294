// SPDX-License-Identifier: MIT
// The explorer on nets that others wrote, with the answers that others computed: the Model Checking
// Contest's oracle, and verifypn on nets with inhibitors. PUPPETRI_PROOF_MODELS=all takes the large
// ones too (17 million edges, some seconds in all).
#include <doctest/doctest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "puppetri/proof/explorer.h"
#include "support/tiny_pnml.h"

namespace puppetri::proof {
namespace {

// Rows of a table with a line of titles, as title -> cell.
std::vector<std::map<std::string, std::string>> table(const std::string& path) {
    std::istringstream text(test::text_of_file(path));
    std::vector<std::string> titles;
    std::vector<std::map<std::string, std::string>> rows;
    for (std::string line; std::getline(text, line);) {
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, '\t');) {
            row.push_back(cell);
        }
        if (titles.empty()) {
            titles = row;
            continue;
        }
        rows.emplace_back();
        for (std::size_t i = 0; i < row.size() && i < titles.size(); ++i) {
            rows.back()[titles[i]] = row[i];
        }
    }
    return rows;
}

bool all_models() {
    const char* text = std::getenv("PUPPETRI_PROOF_MODELS");
    return text != nullptr && std::string(text) == "all";
}

const std::string kNets = PUP_SOURCE_DIR "/../shared/nets/";

TEST_CASE("contest models have the oracle's states, edges, token counts and deadlocks [oracle]") {
    const auto rows = table(kNets + "mcc/answers.tsv");
    if (rows.empty()) {
        MESSAGE("skipped: no ../shared/nets/mcc");
        return;
    }
    const std::uint64_t most = all_models() ? 20'000'000 : 100'000;
    int explored = 0;
    for (const auto& row : rows) {
        if (std::stoull(row.at("states")) > most) {
            continue;
        }
        ++explored;
        INFO(row.at("model"));
        const PlainNet net = test::tiny_pnml(kNets + "mcc/" + row.at("model") + "/model.pnml");
        REQUIRE(net.place_count() == std::stoul(row.at("places")));
        REQUIRE(net.transition_count() == std::stoul(row.at("transitions")));
        for (const unsigned threads : {1u, 2u}) {
            Budget budget;
            budget.threads = threads;
            const Exploration e = explore(net, {.find_dead = true}, budget);
            CHECK(e.complete);
            CHECK(e.states == std::stoull(row.at("states")));
            CHECK(e.edges == std::stoull(row.at("edges")));
            CHECK(e.max_tokens_in_place == std::stoul(row.at("maxTokPlace")));
            CHECK(e.max_tokens_per_marking == std::stoull(row.at("maxTokMarking")));
            CHECK(e.dead.found == (row.at("deadlock") == "TRUE"));
            if (e.states > 200'000) {  // below, segments and first tables count
                CHECK(static_cast<double>(e.bytes) / static_cast<double>(e.states) <= 16);
            }
        }
    }
    CHECK(explored >= 14);
}

TEST_CASE("nets with inhibitors have verifypn's states, token counts and deadlocks [oracle]") {
    const auto rows = table(kNets + "inhibitor/answers.tsv");
    if (rows.empty()) {
        MESSAGE("skipped: no ../shared/nets/inhibitor");
        return;
    }
    for (const auto& row : rows) {
        INFO(row.at("net"));
        const PlainNet net = test::tiny_pnml(kNets + "inhibitor/" + row.at("net") + "/model.pnml");
        const Exploration e = explore(net, {.find_dead = true}, {});
        CHECK(e.complete);
        CHECK(e.states == std::stoull(row.at("states")));
        CHECK(e.max_tokens_in_place == std::stoul(row.at("max_tokens_in_place")));
        CHECK(e.dead.found == (row.at("deadlock") == "TRUE"));
    }
    CHECK(rows.size() == 59);
}

}  // namespace
}  // namespace puppetri::proof
