// SPDX-License-Identifier: MIT
// Symmetric nets: their unfolding is the place/transition net that the contest ships beside them,
// element by element; and each term by hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "io/net_files.h"
#include "puppetri/io/contest_queries.h"
#include "puppetri/io/load_net.h"
#include "puppetri/io/pnml.h"
#include "puppetri/io/write_net.h"
#include "puppetri/net/net.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

std::string wrap(const std::string& declarations, const std::string& inside) {
    return "<pnml><net id=\"n\" type=\".../symmetricnet\"><declaration><structure><declarations>" +
           declarations + "</declarations></structure></declaration><page id=\"g\">" + inside +
           "</page></net></pnml>";
}
std::string sub(const std::string& term) { return "<subterm>" + term + "</subterm>"; }
std::string sort(const std::string& id) { return "<usersort declaration=\"" + id + "\"/>"; }
std::string var(const std::string& id) { return "<variable refvariable=\"" + id + "\"/>"; }
std::string value(const std::string& id) { return "<useroperator declaration=\"" + id + "\"/>"; }
std::string op(const std::string& name, const std::vector<std::string>& operands) {
    std::string out = "<" + name + ">";
    for (const std::string& o : operands) {
        out += sub(o);
    }
    return out + "</" + name + ">";
}
std::string number(int n) { return "<numberconstant value=\"" + std::to_string(n) + "\"/>"; }
std::string place(const std::string& id, const std::string& of, const std::string& marking = "") {
    return "<place id=\"" + id + "\"><type><structure>" + of + "</structure></type>" +
           (marking.empty()
                ? ""
                : "<hlinitialMarking><structure>" + marking + "</structure></hlinitialMarking>") +
           "</place>";
}
std::string transition(const std::string& id, const std::string& condition = "") {
    return "<transition id=\"" + id + "\">" +
           (condition.empty() ? ""
                              : "<condition><structure>" + condition + "</structure></condition>") +
           "</transition>";
}
std::string arc(const std::string& from, const std::string& to, const std::string& term) {
    static int ids = 0;
    return "<arc id=\"arc" + std::to_string(++ids) + "\" source=\"" + from + "\" target=\"" + to +
           "\"><hlinscription><structure>" + term + "</structure></hlinscription></arc>";
}
std::string enumeration(const std::string& id, int size, bool cyclic) {
    const std::string kind = cyclic ? "cyclicenumeration" : "finiteenumeration";
    std::string out = "<namedsort id=\"" + id + "\" name=\"" + id + "\"><" + kind + ">";
    for (int i = 0; i < size; ++i) {
        out += "<feconstant id=\"" + id + std::to_string(i) + "\" name=\"" + std::to_string(i) +
               "\"/>";
    }
    return out + "</" + kind + "></namedsort>";
}
std::string variable(const std::string& id, const std::string& of) {
    return "<variabledecl id=\"" + id + "\" name=\"" + id + "\">" + sort(of) + "</variabledecl>";
}

// "Eat(3,4)" as the contest names it: "Eat_3_4".
std::string contest_name(std::string path) {
    for (char& c : path) {
        c = c == '(' || c == ',' ? '_' : c;
    }
    path.erase(std::remove(path.begin(), path.end(), ')'), path.end());
    return path;
}

// A net as a set of sentences, whatever the order of its elements.
std::set<std::string> sentences(const net::NetDraft& draft) {
    std::set<std::string> out;
    const auto name = [&](net::PlaceIndex p) { return contest_name(draft.places[p.value].path); };
    for (const net::PlaceDraft& p : draft.places) {
        std::uint64_t tokens = 0;
        for (const net::InitialToken& t : p.tokens) {
            tokens += t.count;
        }
        out.insert(contest_name(p.path) + " has " + std::to_string(tokens));
    }
    for (const net::TransitionDraft& t : draft.transitions) {
        std::map<std::string, std::int64_t> takes, gives;
        for (const net::ArcDraft& a : t.inputs) {
            takes[name(a.place)] += a.weight;
        }
        for (const net::OutputDraft& o : t.outputs) {
            gives[name(o.place)] += o.weight;
        }
        std::string sentence = contest_name(t.path) + " takes";
        for (const auto& [p, weight] : takes) {
            sentence += " " + std::to_string(weight) + "*" + p;
        }
        sentence += " gives";
        for (const auto& [p, weight] : gives) {
            sentence += " " + std::to_string(weight) + "*" + p;
        }
        out.insert(sentence);
    }
    return out;
}

NetFile read(const std::string& text) {
    const Checked<NetFile> file = read_pnml(text, "n.pnml");
    if (!file) {
        FAIL(file.error()[0].code << ": " << file.error()[0].message);
    }
    return *file;
}

std::string code_of(const std::string& text, const NetLimits& limits = {}) {
    const Checked<NetFile> file = read_pnml(text, "n.pnml", limits);
    return file ? "fine" : file.error()[0].code;
}

void same_as_contest(const std::string& model, const NetFile& ours) {
    for (const std::string& path : shared_nets("mcc/" + model, "model.pnml")) {
        const NetFile theirs = *load_net(path);
        CHECK(ours.draft.places.size() == theirs.draft.places.size());
        CHECK(ours.draft.transitions.size() == theirs.draft.transitions.size());
        CHECK(sentences(ours.draft) == sentences(theirs.draft));
    }
}

}  // namespace

TEST_CASE("the coloured philosophers unfold to the contest's uncoloured ones [oracle]") {
    // Numbered from 1 to N; the fork to the left of p is that of its predecessor.
    for (const int size : {5, 10, 20}) {
        std::string constants;
        for (int i = 1; i <= size; ++i) {
            constants += "<feconstant id=\"c" + std::to_string(i) + "\" name=\"" +
                         std::to_string(i) + "\"/>";
        }
        const std::string p = var("p"), left = op("predecessor", {var("p")});
        const std::string all = "<all>" + sort("Phil") + "</all>";
        const NetFile file = read(
            wrap("<namedsort id=\"Phil\"><cyclicenumeration>" + constants +
                     "</cyclicenumeration></namedsort>" + variable("p", "Phil"),
                 place("Think", sort("Phil"), all) + place("Fork", sort("Phil"), all) +
                     place("Catch1", sort("Phil")) + place("Catch2", sort("Phil")) +
                     place("Eat", sort("Phil")) + transition("FF1a") + transition("FF1b") +
                     transition("FF2a") + transition("FF2b") + transition("End") +
                     arc("Think", "FF1a", p) + arc("Fork", "FF1a", left) +
                     arc("FF1a", "Catch1", p) + arc("Think", "FF1b", p) + arc("Fork", "FF1b", p) +
                     arc("FF1b", "Catch2", p) + arc("Catch1", "FF2a", p) + arc("Fork", "FF2a", p) +
                     arc("FF2a", "Eat", p) + arc("Catch2", "FF2b", p) + arc("Fork", "FF2b", left) +
                     arc("FF2b", "Eat", p) + arc("Eat", "End", p) + arc("End", "Think", p) +
                     arc("End", "Fork", op("add", {p, left}))));
        const std::string digits = std::to_string(size);
        same_as_contest("Philosophers-PT-" + std::string(6 - digits.size(), '0') + digits, file);
        REQUIRE(file.ids.find_places("Eat") != nullptr);
        CHECK(file.ids.find_places("Eat")->size() == static_cast<std::size_t>(size));
        CHECK(file.draft.places[file.ids.find_places("Eat")->at(2).value].path == "Eat(3)");
    }
}

TEST_CASE("the coloured token ring unfolds to the contest's uncoloured one [oracle]") {
    // Dijkstra's ring of six: who differs from its predecessor takes its value over; the first
    // moves on when the last has its value.
    std::string marking;
    for (int i = 0; i < 6; ++i) {
        marking +=
            sub(op("tuple", {value("S" + std::to_string(i)), value("S" + std::to_string(i))}));
    }
    const auto state = [&](const std::string& a, const std::string& b) {
        return op("tuple", {a, b});
    };
    const std::string i = var("i"), j = var("j"), k = var("k");
    const std::string before = op("predecessor", {i});
    const NetFile file = read(wrap(
        enumeration("S", 6, true) + "<namedsort id=\"SS\"><productsort>" + sort("S") + sort("S") +
            "</productsort></namedsort>" + variable("i", "S") + variable("j", "S") +
            variable("k", "S"),
        place("State", sort("SS"), "<add>" + marking + "</add>") +
            transition("OtherProcess",
                       op("and", {op("inequality", {i, value("S0")}), op("inequality", {j, k})})) +
            transition("MainProcess") + arc("State", "OtherProcess", state(i, j)) +
            arc("State", "OtherProcess", state(before, k)) +
            arc("OtherProcess", "State", op("add", {state(i, k), state(before, k)})) +
            arc("State", "MainProcess", op("add", {state(value("S0"), k), state(value("S5"), k)})) +
            arc("MainProcess", "State",
                op("add", {state(value("S0"), op("successor", {k})), state(value("S5"), k)}))));
    same_as_contest("TokenRing-PT-005", file);
}

TEST_CASE("terms: sums, differences, products with all, numbers, conditions [unit]") {
    const NetFile file = *load_net(PUP_SOURCE_DIR "/tests/corpus/nets/coloured.pnml");
    const net::NetDraft& draft = file.draft;
    REQUIRE(draft.places.size() == 3 * 3 + 3 + 1);
    std::map<std::string, std::uint64_t> marking;
    for (const net::PlaceDraft& p : draft.places) {
        marking[p.path] = p.tokens.empty() ? 0 : p.tokens[0].count;
    }
    // 2'(0,1) + (all, 0); all - 1; one dot.
    CHECK(marking.at("State(0,1)") == 2);
    CHECK(marking.at("State(0,0)") == 1);
    CHECK(marking.at("State(2,0)") == 1);
    CHECK(marking.at("State(2,2)") == 0);
    CHECK(marking.at("Free(0)") == 1);
    CHECK(marking.at("Free(1)") == 0);
    CHECK(marking.at("Lock") == 1);
    // step(p,q,n): p != q and (n < 2 or not p = q + 1): of 6 pairs 3 are p = q + 1.
    CHECK(file.ids.find_transitions("step")->size() == 6 * 2 + 3);
    const net::TransitionDraft& sweep =
        draft.transitions[file.ids.find_transitions("sweep")->at(0).value];
    CHECK(sweep.path == "sweep");
    CHECK(sweep.inputs.at(0).kind == net::ArcKind::kUnless);
    REQUIRE(sweep.outputs.size() == 3);
    CHECK(sweep.outputs[0].weight == 3);
    CHECK(file.ids.find_places("Far")->size() == 3);
    CHECK(net::compile(draft).has_value());
    // What comes out is a plain net.
    const Checked<WrittenNet> written = write_net(file, NetFormat::kPnml);
    REQUIRE(written.has_value());
    const NetFile again = read(written->text);
    CHECK(draft_text(again.draft) == draft_text(draft));
}

TEST_CASE("contest queries speak of coloured nodes as the sum over their colours [unit]") {
    const NetFile file = *load_net(PUP_SOURCE_DIR "/tests/corpus/nets/coloured.pnml");
    const Checked<ContestQueries> read = read_contest_queries(
        "<property-set><property><id>x</id><formula><place-bound><place>Free</place>"
        "</place-bound></formula></property><property><id>y</id><formula><is-fireable>"
        "<transition>step</transition></is-fireable></formula></property></property-set>",
        "q.xml", file);
    REQUIRE(read.has_value());
    std::size_t counts = 0;
    for (const Expr::Node& n : read->queries[0].bound.nodes()) {
        counts += n.op == ExprOp::kSlot ? 1 : 0;
    }
    CHECK(counts == 3);
    CHECK(read->queries[1].formula.nodes.size() == 2 * 15 - 1);
}

TEST_CASE("what a coloured net says wrongly is refused by name [unit]") {
    const std::string abc = enumeration("A", 3, false) + enumeration("C", 3, true) +
                            variable("x", "A") + variable("y", "C");
    const auto net = [&](const std::string& term, const std::string& condition = "") {
        return wrap(abc, place("p", sort("A")) + transition("t", condition) + arc("p", "t", term));
    };
    CHECK(code_of(net(var("x"))) == "fine");
    CHECK(code_of(net(var("y"))) == "wrong-sort");
    CHECK(code_of(net(var("z"))) == "unknown-id");
    CHECK(code_of(net(value("A9"))) == "unknown-id");
    CHECK(code_of(net(op("successor", {var("x")}))) == "wrong-sort");
    CHECK(code_of(net(op("tuple", {var("x"), var("x")}))) == "wrong-sort");
    CHECK(code_of(net(op("numberof", {number(2), var("x")}))) == "fine");
    CHECK(code_of(net(op("numberof", {var("x"), var("x")}))) == "not-a-number");
    CHECK(code_of(net(op("subtract", {var("x"), value("A0")}))) == "number-too-small");
    CHECK(code_of(net(op("subtract", {"<all>" + sort("A") + "</all>", var("x")}))) == "fine");
    CHECK(code_of(net("<mystery/>")) == "not-supported");
    CHECK(code_of(net(var("x"), op("mystery", {}))) == "not-supported");
    CHECK(code_of(net(var("x"), op("equality", {var("x"), var("y")}))) == "wrong-sort");
    CHECK(code_of(net(var("x"), op("not", {}))) == "wrong-operands");
    CHECK(code_of(wrap(abc, "<place id=\"p\"/>")) == "unknown-label");
    CHECK(code_of(wrap(abc, place("p", sort("B")))) == "unknown-id");
    CHECK(code_of(wrap("<partition id=\"q\"/>", place("p", "<dot/>"))) == "not-supported");
    CHECK(
        code_of(wrap("<namedsort id=\"L\"><productsort>" + sort("L") + "</productsort></namedsort>",
                     place("p", sort("L")))) == "wrong-reference");
    CHECK(code_of(wrap(abc, place("p", sort("A"), var("x")))) == "wrong-operands");
}

TEST_CASE("an unfolding that is too large is refused before it is made [unit]") {
    std::string variables, tuple;
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
        variables += variable(name, "N");
        tuple += sub(var(name));
    }
    std::string sorts = "<namedsort id=\"N\"><finiteintrange start=\"1\" end=\"100\"/></namedsort>";
    std::string product = "<productsort>";
    for (int i = 0; i < 6; ++i) {
        product += sort("N");
    }
    product += "</productsort>";
    CHECK(code_of(wrap(sorts + variables, place("p", product) + transition("t"))) ==
          "net-too-large");
    // Six variables of 100 colours each: 10^12 bindings, stopped after a thousand.
    std::string arcs;
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
        arcs += arc("q", "t", var(name));
    }
    NetLimits few;
    few.bindings = 1000;
    CHECK(code_of(wrap(sorts + variables, place("q", sort("N")) + transition("t") + arcs), few) ==
          "net-too-large");
    NetLimits small;
    small.elements = 1000;
    CHECK(code_of(wrap(sorts + variables, place("q", sort("N")) + transition("t") + arcs), small) ==
          "net-too-large");
}
