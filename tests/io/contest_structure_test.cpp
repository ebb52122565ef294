// SPDX-License-Identifier: MIT
// Structure of the contest's nets against answers that nobody of this project computed:
// GenericPropertiesVerdict.xml and answers.tsv of ../shared/nets/mcc.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "puppetri/io/pnml.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/net_class.h"
#include "puppetri/proof/reductions.h"
#include "puppetri/proof/semiflows.h"
#include "puppetri/proof/state_equation.h"
#include "puppetri/proof/structural_liveness.h"

using namespace puppetri;
using namespace puppetri::proof;

namespace {

const std::string kFolder = PUP_SOURCE_DIR "/../shared/nets/mcc";

std::vector<std::string> models() {
    std::vector<std::string> out;
    if (!std::filesystem::exists(kFolder)) {
        MESSAGE("skipped: no ", kFolder);
        return out;
    }
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.is_directory()) {
            out.push_back(entry.path().filename().string());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

PlainNet net_of(const std::string& model) {
    const std::string path = kFolder + "/" + model + "/model.pnml";
    std::ifstream in(path, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    const auto file = io::read_pnml(text.str(), path);
    REQUIRE(file);
    const auto net = net::compile(file->draft);
    REQUIRE(net);
    Plain picture = plain(*net);
    REQUIRE(picture.net.exact());
    return picture.net;
}

// model -> column -> value
std::map<std::string, std::map<std::string, std::string>> answers() {
    std::map<std::string, std::map<std::string, std::string>> out;
    std::ifstream in(kFolder + "/answers.tsv");
    std::string line, cell;
    std::vector<std::string> columns;
    while (std::getline(in, line)) {
        std::stringstream cells(line);
        std::vector<std::string> row;
        while (std::getline(cells, cell, '\t')) {
            row.push_back(cell);
        }
        if (columns.empty()) {
            columns = row;
            continue;
        }
        for (std::size_t i = 1; i < row.size() && i < columns.size(); ++i) {
            out[row[0]][columns[i]] = row[i];
        }
    }
    return out;
}

}  // namespace

TEST_CASE("structural classes of the contest's nets are those that the contest states [oracle]") {
    int compared = 0;
    for (const std::string& model : models()) {
        CAPTURE(model);
        const NetClass c = classify(net_of(model));
        const std::map<std::string, NetClass::Property> ours = {
            {"ORDINARY", c.ordinary},
            {"SIMPLE_FREE_CHOICE", c.simple_free_choice},
            {"EXTENDED_FREE_CHOICE", c.extended_free_choice},
            {"STATE_MACHINE", c.state_machine},
            {"MARKED_GRAPH", c.marked_graph},
            {"CONNECTED", c.connected},
            {"STRONGLY_CONNECTED", c.strongly_connected},
            {"SOURCE_PLACE", c.source_place},
            {"SINK_PLACE", c.sink_place},
            {"SOURCE_TRANSITION", c.source_transition},
            {"SINK_TRANSITION", c.sink_transition},
            {"LOOP_FREE", c.loop_free},
            {"CONSERVATIVE", c.conservative},
            {"SUBCONSERVATIVE", c.subconservative},
        };
        pugi::xml_document xml;
        REQUIRE(xml.load_file((kFolder + "/" + model + "/GenericPropertiesVerdict.xml").c_str()));
        for (const pugi::xml_node& verdict : xml.child("toolspecific").children("verdict")) {
            const auto found = ours.find(verdict.attribute("reference").value());
            const std::string value = verdict.attribute("value").value();
            if (found != ours.end() && value != "unknown") {
                CAPTURE(found->first);
                CHECK(found->second.holds == (value == "true"));
                ++compared;
            }
        }
    }
    CHECK((compared == 0 || compared > 250));
}

TEST_CASE("bounds, deadlock and liveness by structure agree with the contest's answers [oracle]") {
    const auto stated = answers();
    int proved = 0;
    for (const std::string& model : models()) {
        CAPTURE(model);
        const PlainNet net = net_of(model);
        const auto& row = stated.at(model);
        Budget budget;
        budget.seconds = 2;
        // The greatest count of a place, and of a marking.
        std::int64_t most = 0;
        LinearSum all;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            const auto bound = upper_bound(net, {{{p, 1}}}, budget);
            most = bound ? std::max(most, *bound) : std::int64_t{1} << 40;
            all.terms.push_back({p, 1});
        }
        CHECK(most >= std::stoll(row.at("maxTokPlace")));
        const auto together = upper_bound(net, all, budget);
        CHECK((!together || *together >= std::stoll(row.at("maxTokMarking"))));
        // Deadlock, on the whole net and on the reduced one.
        const bool dead = row.at("deadlock") == "TRUE";
        const Reduction reduced = reduce(net, {Preserves::kDeadlock, {}}, budget);
        for (const PlainNet* n : {&net, &reduced.net}) {
            StateEquationOptions options;
            options.cases = 500;
            const auto answer =
                solve_state_equation(*n, Predicate::no_successor(*n), budget, options);
            const bool never = answer.kind == StateEquationAnswer::kImpossible ||
                               structural_liveness(*n, budget).deadlock_free;
            CHECK_FALSE((never && dead));
            proved += never ? 1 : 0;
        }
        const StructuralLiveness structure = structural_liveness(net, budget);
        CHECK_FALSE((structure.live && row.at("live") != "TRUE"));
        CHECK_FALSE((structure.not_live && row.at("live") == "TRUE"));
    }
    // All 12 models without a deadlock but Lamport's two.
    CHECK((stated.empty() || proved >= 20));
}
