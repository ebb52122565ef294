// SPDX-License-Identifier: MIT
// Real nets: every element of the text arrives, counted by searching the text.
#include <doctest/doctest.h>

#include <sstream>

#include "puppetri/io/pnml.h"
#include "puppetri/net/net.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

std::size_t elements(const std::string& text, const std::string& name) {
    return occurrences(text, "<" + name + " ") + occurrences(text, "<" + name + ">");
}

// The sum of the numbers in the labels of that name, by a pattern over the text.
std::int64_t sum_of_labels(const std::string& text, const std::string& name) {
    std::int64_t sum = 0;
    std::size_t at = 0;
    while ((at = text.find("<" + name + ">", at)) != std::string::npos) {
        const std::size_t end = text.find("</" + name + ">", at);
        const std::size_t begin = text.find("<text>", at);
        REQUIRE(begin < end);
        sum += std::stoll(text.substr(begin + 6));
        at = end;
    }
    return sum;
}

void check_model(const std::string& path) {
    CAPTURE(path);
    const std::string text = file_text(path);
    const Checked<NetFile> file = read_pnml(text, path);
    REQUIRE(file.has_value());
    const net::NetDraft& draft = file->draft;
    CHECK(draft.places.size() == elements(text, "place"));
    CHECK(draft.transitions.size() == elements(text, "transition"));
    std::size_t arcs = 0, inhibitors = 0;
    std::int64_t weights = 0, tokens = 0;
    for (const net::TransitionDraft& t : draft.transitions) {
        arcs += t.inputs.size() + t.outputs.size();
        for (const net::ArcDraft& a : t.inputs) {
            inhibitors += a.kind == net::ArcKind::kUnless ? 1 : 0;
            weights += a.weight - 1;
        }
        for (const net::OutputDraft& a : t.outputs) {
            weights += a.weight - 1;
        }
    }
    for (const net::PlaceDraft& p : draft.places) {
        for (const net::InitialToken& token : p.tokens) {
            tokens += token.count;
        }
    }
    CHECK(arcs == elements(text, "arc"));
    CHECK(inhibitors == occurrences(text, "type=\"inhibitor\""));
    const auto inscribed = static_cast<std::int64_t>(elements(text, "inscription"));
    CHECK(weights + inscribed == sum_of_labels(text, "inscription"));
    CHECK(tokens == sum_of_labels(text, "initialMarking"));
    const Checked<net::Net> net = net::compile(draft);
    REQUIRE(net.has_value());
    CHECK(net->paced());
}

}  // namespace

TEST_CASE("every element of the contest's nets arrives [oracle]") {
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        check_model(path);
    }
}

TEST_CASE("every element of the nets with inhibitor arcs arrives [oracle]") {
    for (const std::string& path : shared_nets("inhibitor", "model.pnml")) {
        check_model(path);
    }
}

TEST_CASE("the contest's own counts of places, transitions and arcs are ours [oracle]") {
    for (const std::string& table : shared_nets("mcc", "answers.tsv")) {
        std::istringstream rows(file_text(table));
        std::string row;
        std::getline(rows, row);
        while (std::getline(rows, row)) {
            std::istringstream fields(row);
            std::string model;
            std::size_t places = 0, transitions = 0, arcs = 0;
            const bool whole{fields >> model >> places >> transitions >> arcs};
            REQUIRE(whole);
            CAPTURE(model);
            const std::string path =
                table.substr(0, table.rfind('/')) + "/" + model + "/model.pnml";
            const Checked<NetFile> file = read_pnml(file_text(path), path);
            REQUIRE(file.has_value());
            CHECK(file->draft.places.size() == places);
            CHECK(file->draft.transitions.size() == transitions);
            std::size_t found = 0;
            for (const net::TransitionDraft& t : file->draft.transitions) {
                found += t.inputs.size() + t.outputs.size();
            }
            CHECK(found == arcs);
        }
    }
}
