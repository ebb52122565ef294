// SPDX-License-Identifier: MIT
// PIPE's files: real ones, counted by searching their texts, and each construct by hand.
#include "puppetri/io/pipe.h"

#include <doctest/doctest.h>

#include <map>

#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

std::string wrap(const std::string& inside) {
    return "<pnml><net id=\"n\" type=\"P/T net\">" + inside + "</net></pnml>";
}

std::string place(const std::string& id, const std::string& marking, const std::string& more = "") {
    return "<place id=\"" + id + "\"><initialMarking><value>" + marking +
           "</value></initialMarking>" + more + "</place>";
}

std::string arc(const std::string& from, const std::string& to, const std::string& weight,
                const std::string& more = "") {
    return "<arc id=\"a\" source=\"" + from + "\" target=\"" + to + "\"><inscription><value>" +
           weight + "</value></inscription>" + more + "</arc>";
}

std::string code_of(const std::string& inside) {
    const Checked<NetFile> file = read_pipe(wrap(inside), "n.xml");
    return file ? "fine" : file.error()[0].code;
}

std::int64_t tokens(const net::PlaceDraft& p) {
    std::int64_t sum = 0;
    for (const net::InitialToken& t : p.tokens) {
        sum += t.count;
    }
    return sum;
}

}  // namespace

TEST_CASE("every net that PIPE ships loads and compiles, with all its elements [oracle]") {
    for (const std::string& path : shared_nets("pipe", "")) {
        CAPTURE(path);
        const std::string text = file_text(path);
        const Checked<NetFile> file = load_net(path);
        if (!file) {
            FAIL(file.error()[0].message);
        }
        CHECK(file->format == NetFormat::kPipe);
        CHECK(net::compile(file->draft).has_value());
        // Each element has an id, whatever it was unfolded to.
        CHECK(file->draft.transitions.size() == occurrences(text, "<transition id="));
        const bool coloured = occurrences(text, "<token id=") > 1;
        const std::size_t places = occurrences(text, "<place id=");
        std::size_t arcs = 0, timed = 0;
        for (const net::TransitionDraft& t : file->draft.transitions) {
            arcs += t.inputs.size() + t.outputs.size();
            timed += t.delay ? 1 : 0;
        }
        if (coloured) {
            CHECK(file->draft.places.size() > places);
            CHECK(arcs >= occurrences(text, "<arc id="));
        } else {
            CHECK(file->draft.places.size() == places);
            CHECK(arcs == occurrences(text, "<arc id="));
        }
        // Of each <timed> the value "true".
        std::size_t expected = 0;
        for (std::size_t at = text.find("<timed>"); at != std::string::npos;
             at = text.find("<timed>", at + 1)) {
            const std::size_t end = text.find("</timed>", at);
            expected += text.substr(at, end - at).find("true") != std::string::npos ? 1 : 0;
        }
        CHECK(timed == expected);
    }
}

TEST_CASE("the readers and writers of PIPE's coloured example are counted per class [oracle]") {
    for (const std::string& path : shared_nets("pipe", "Coloured Reader Writer.xml")) {
        const Checked<NetFile> file = load_net(path);
        REQUIRE(file.has_value());
        // Written in the file: Waiting Default,0,Writers,2,Readers,3; Resource Default,3.
        std::map<std::string, std::int64_t> marking;
        for (const net::PlaceDraft& p : file->draft.places) {
            marking[p.path] = tokens(p);
        }
        CHECK(marking.at("Waiting for access(Writers)") == 2);
        CHECK(marking.at("Waiting for access(Readers)") == 3);
        CHECK(marking.at("Resource(Default)") == 3);
        CHECK(marking.at("Accessing(Readers)") == 0);
        REQUIRE(file->ids.find_places("Waiting for access") != nullptr);
        CHECK(file->ids.find_places("Waiting for access")->size() == 2);
    }
}

TEST_CASE("timed and immediate transitions of PIPE [unit]") {
    const Checked<NetFile> file = read_pipe(
        wrap(place("p", "Default,2", "<capacity><value>3</value></capacity>") + place("q", "0") +
             "<transition id=\"t\"><rate><value>4.0</value></rate><timed><value>true</value>"
             "</timed><infiniteServer><value>true</value></infiniteServer><priority><value>7"
             "</value></priority></transition>"
             "<transition id=\"u\"><rate><value>0.25</value></rate><timed><value>false</value>"
             "</timed><priority><value>2</value></priority></transition>" +
             arc("p", "t", "Default,2") + arc("t", "q", "1") +
             arc("q", "u", "3", "<type value=\"inhibitor\"/>") +
             arc("p", "u", "1", "<type value=\"normal\"/>")),
        "n.xml");
    REQUIRE(file.has_value());
    const net::NetDraft& draft = file->draft;
    CHECK(tokens(draft.places[0]) == 2);
    CHECK(draft.places[0].capacity == std::optional<std::uint32_t>(3));
    CHECK(!draft.places[1].capacity);
    const net::TransitionDraft& t = draft.transitions[0];
    REQUIRE(t.delay.has_value());
    CHECK(t.delay->duration.distribution == DistributionKind::kExponential);
    CHECK(real_of_value(t.delay->duration.parameters.at(0).literal_value()) == 0.25);
    CHECK(t.delay->servers == net::DelayDraft::kInfiniteServers);
    CHECK(t.priority == 0);
    CHECK(t.inputs.at(0).weight == 2);
    const net::TransitionDraft& u = draft.transitions[1];
    CHECK(!u.delay);
    CHECK(u.priority == 2);
    CHECK(real_of_value(u.odds->literal_value()) == 0.25);
    CHECK(u.inputs.at(0).kind == net::ArcKind::kUnless);
    CHECK(u.inputs.at(0).weight == 3);
    CHECK(u.inputs.at(1).kind == net::ArcKind::kTake);
    CHECK(net::compile(draft).has_value());
}

TEST_CASE("what PIPE says and cannot be meant here is refused by name [unit]") {
    const std::string two = place("p", "1") + "<transition id=\"t\"/>";
    const std::string classes = "<token id=\"Default\"/><token id=\"Red\"/>";
    CHECK(code_of(two + arc("p", "t", "1")) == "fine");
    CHECK(code_of(two + arc("p", "t", "1", "<type value=\"reset\"/>")) == "unknown-arc-type");
    CHECK(code_of(two + arc("t", "p", "1", "<type value=\"inhibitor\"/>")) == "arc-type-backwards");
    CHECK(code_of(two + arc("p", "t", "1", "<tagged><value>true</value></tagged>")) ==
          "not-supported");
    CHECK(code_of(two + arc("p", "t", "0")) == "number-too-small");
    CHECK(code_of(two + arc("p", "t", "x")) == "not-a-number");
    CHECK(code_of(two + arc("p", "t", "Blue,1")) == "unknown-id");
    CHECK(code_of(two + arc("p", "q", "1")) == "unknown-id");
    CHECK(code_of(two + arc("p", "p", "1")) == "arc-joins-alike");
    CHECK(code_of(two + place("p", "1")) == "duplicate-id");
    CHECK(code_of(place("p", "99999999999")) == "number-too-large");
    CHECK(code_of(place("p", "1", "<invariant><value>3</value></invariant>")) == "unknown-label");
    CHECK(code_of("<transition id=\"t\"><rate><value>#(p)*2</value></rate></transition>") ==
          "not-a-number");
    CHECK(code_of("<transition id=\"t\"><timed><value>maybe</value></timed></transition>") ==
          "not-a-number");
    CHECK(
        code_of(classes + two + arc("p", "t", "Red,1,Default,1", "<type value=\"inhibitor\"/>")) ==
        "not-supported");
    CHECK(code_of(classes + place("p", "Red,1,Default,1",
                                  "<capacity><value>3</value></capacity>")) == "not-supported");
}
