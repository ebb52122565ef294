// SPDX-License-Identifier: MIT
// PNML by hand: pages, references, every dialect of arc types, and what is refused.
#include "puppetri/io/pnml.h"

#include <doctest/doctest.h>

#include "io/net_files.h"
#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;
using net::ArcKind;

namespace {

std::string wrap(const std::string& inside, const std::string& type = "ptnet") {
    return "<pnml><net id=\"n\" type=\"" + type + "\"><page id=\"g\">" + inside +
           "</page></net></pnml>";
}

std::string code_of(const std::string& text) {
    const Checked<NetFile> file = read_pnml(text, "n.pnml");
    return file ? "fine" : file.error()[0].code;
}

constexpr const char* kNodes = "<place id=\"p\"/><place id=\"q\"/><transition id=\"t\"/>";

// The one arc from p to t, written so.
net::ArcDraft arc(const std::string& attributes, const std::string& inside = "") {
    const Checked<NetFile> file =
        read_pnml(wrap(std::string(kNodes) + "<arc id=\"a\" source=\"p\" target=\"t\" " +
                       attributes + ">" + inside + "</arc>"),
                  "n.pnml");
    if (!file) {
        FAIL(file.error()[0].message);
    }
    return file->draft.transitions.at(0).inputs.at(0);
}

std::string arc_code(const std::string& attributes, const std::string& inside = "",
                     const std::string& from = "p", const std::string& to = "t") {
    return code_of(wrap(std::string(kNodes) + "<arc id=\"a\" source=\"" + from + "\" target=\"" +
                        to + "\" " + attributes + ">" + inside + "</arc>"));
}

}  // namespace

TEST_CASE("pages are one net, and references stand for what they lead to [unit]") {
    const Checked<NetFile> file = load_net(PUP_SOURCE_DIR "/tests/corpus/nets/pages.pnml");
    REQUIRE(file.has_value());
    const net::NetDraft& draft = file->draft;
    CHECK(draft.name == "Pages & references");
    REQUIRE(draft.places.size() == 3);
    REQUIRE(draft.transitions.size() == 2);
    CHECK(draft.places[0].path == "idle");
    CHECK(draft.places[0].caption == "she is idle");
    CHECK(draft.places[0].tokens.at(0).count == 3);
    CHECK(draft.places[0].where.line == 7);
    // begin takes two of r1, which is r2, which is idle; the reset arc is at rt, which is begin.
    const net::TransitionDraft& begin = draft.transitions[0];
    CHECK(begin.path == "begin");
    REQUIRE(begin.inputs.size() == 2);
    CHECK(begin.inputs[0].place.value == 0);
    CHECK(begin.inputs[0].weight == 2);
    CHECK(begin.inputs[1].kind == ArcKind::kTakeAll);
    CHECK(draft.places[begin.inputs[1].place.value].path == "blocked");
    const net::TransitionDraft& end = draft.transitions[1];
    REQUIRE(end.inputs.size() == 4);
    CHECK(end.inputs[1].kind == ArcKind::kUnless);
    CHECK(end.inputs[2].kind == ArcKind::kUnless);
    CHECK(end.inputs[2].weight == 3);
    CHECK(end.inputs[3].kind == ArcKind::kRead);
    CHECK(end.outputs.at(0).place.value == 0);
    for (const char* id : {"idle", "r1", "r2"}) {
        REQUIRE(file->ids.find_places(id) != nullptr);
        CHECK(file->ids.find_places(id)->at(0).value == 0);
    }
    CHECK(file->ids.find_transitions("rt")->at(0).value == 0);
    CHECK(file->ids.find_transitions("idle") == nullptr);
    CHECK(file->look.places.at(0).at == std::optional<DrawingPoint>({210, 150}));
}

TEST_CASE("arc types in all dialects [unit]") {
    CHECK(arc("").kind == ArcKind::kTake);
    CHECK(arc("type=\"normal\"").kind == ArcKind::kTake);
    for (const char* word : {"inhibitor", "read", "test", "reset"}) {
        const ArcKind kind = std::string(word) == "inhibitor" ? ArcKind::kUnless
                             : std::string(word) == "reset"   ? ArcKind::kTakeAll
                                                              : ArcKind::kRead;
        const std::string quoted = "\"" + std::string(word) + "\"";
        CHECK(arc("type=" + quoted).kind == kind);
        CHECK(arc("", "<type value=" + quoted + "/>").kind == kind);
        CHECK(arc("", "<type><text>" + std::string(word) + "</text></type>").kind == kind);
        CHECK(arc("", "<arctype><text>" + std::string(word) + "</text></arctype>").kind == kind);
        CHECK(arc_code("type=" + quoted, "", "t", "p") == "arc-type-backwards");
    }
    CHECK(arc("", "<inscription><text> 4 </text></inscription>").weight == 4);
    CHECK(arc("", "<inscription><value>4</value></inscription>").weight == 4);
}

TEST_CASE("an unknown arc type is refused, never read as an ordinary arc [unit]") {
    for (const char* word :
         {"transport", "transfer", "timed", "stopwatch", "Inhibitor", "", "flush"}) {
        CAPTURE(word);
        CHECK(arc_code("type=\"" + std::string(word) + "\"") == "unknown-arc-type");
        CHECK(arc_code("", "<type value=\"" + std::string(word) + "\"/>") == "unknown-arc-type");
    }
    CHECK(arc_code("type=\"read\"", "<type value=\"inhibitor\"/>") == "unknown-arc-type");
    const Checked<NetFile> file =
        read_pnml(wrap(std::string(kNodes) +
                       "\n<arc id=\"odd\" source=\"p\" target=\"t\" type=\"transport\"/>"),
                  "n.pnml");
    REQUIRE(!file.has_value());
    CHECK(file.error()[0].where.line == 2);
    CHECK(file.error()[0].element == "arc odd");
    CHECK(file.error()[0].message.find("transport") != std::string::npos);
}

TEST_CASE("of parallel inhibitor arcs the strictest counts; parallel ordinary arcs add [unit]") {
    const Checked<NetFile> file = read_pnml(
        wrap(
            std::string(kNodes) +
            "<arc id=\"a\" source=\"p\" target=\"t\" type=\"inhibitor\"><inscription><text>5</text>"
            "</inscription></arc>"
            "<arc id=\"b\" source=\"q\" target=\"t\"/><arc id=\"c\" source=\"q\" target=\"t\"/>"
            "<arc id=\"d\" source=\"p\" target=\"t\" type=\"inhibitor\"><inscription><text>2</text>"
            "</inscription></arc>"),
        "n.pnml");
    REQUIRE(file.has_value());
    const net::TransitionDraft& t = file->draft.transitions[0];
    REQUIRE(t.inputs.size() == 3);
    CHECK(t.inputs[0].weight == 2);
    CHECK(t.inputs[1].kind == ArcKind::kTake);
    CHECK(t.inputs[2].kind == ArcKind::kTake);
    CHECK(file->notes.at(0).code == "parallel-tests");
    // The look of what is left still fits.
    REQUIRE(file->look.arcs.size() == 3);
    CHECK(file->look.arcs[2].id == "c");
    CHECK(file->look.arcs[2].number == 2);
}

TEST_CASE("what could change the behaviour and is not understood is refused [unit]") {
    CHECK(code_of(wrap("<place id=\"p\"><capacity><text>1</text></capacity></place>")) ==
          "unknown-label");
    CHECK(code_of(wrap("<place id=\"p\" initialMarking=\"2\"/>")) == "unknown-attribute");
    CHECK(code_of(wrap("<transition id=\"t\"><interval/></transition>")) == "unknown-label");
    CHECK(code_of(wrap("<place id=\"p\"><type><structure/></type></place>")) == "unknown-label");
    CHECK(code_of(wrap("<gate id=\"x\"/>")) == "unknown-label");
    CHECK(code_of(wrap("<place id=\"p\">3</place>")) == "unknown-label");
    CHECK(code_of(wrap("<place id=\"p\"><initialMarking><text>1</text></initialMarking>"
                       "<initialMarking><text>2</text></initialMarking></place>")) ==
          "duplicate-label");
    CHECK(code_of(wrap("", "http://example.org/timednet")) == "unknown-net-type");
    CHECK(code_of("<pnml><net id=\"a\"/><net id=\"b\"/></pnml>") == "many-nets");
    CHECK(code_of("<pnml/>") == "not-pnml");
    CHECK(code_of("<html/>") == "not-pnml");
    CHECK(code_of("pnml") == "bad-xml");
    CHECK(code_of("") == "bad-xml");
    CHECK(code_of(wrap("<place/>")) == "missing-id");
    CHECK(code_of(
              wrap("<place id=\"p\"><initialMarking><text>two</text></initialMarking></place>")) ==
          "not-a-number");
    CHECK(code_of(wrap("<place id=\"p\"><initialMarking/></place>")) == "not-a-number");
    CHECK(code_of(wrap("<place id=\"p\"/><transition id=\"p\"/>")) == "duplicate-id");
    CHECK(code_of(wrap("<transition id=\"t\"/><referencePlace id=\"r\" ref=\"t\"/>")) ==
          "wrong-reference");
    CHECK(code_of(wrap("<referencePlace id=\"r\" ref=\"nobody\"/>")) == "unknown-id");
}

TEST_CASE("harmless things are harmless: prefixes, comments, encodings, a byte order mark [unit]") {
    CHECK(code_of(
              "\xEF\xBB\xBF<?xml version=\"1.0\"?><!-- a --><p:pnml xmlns:p=\"x\"><p:net id=\"n\" "
              "type=\"http://www.pnml.org/version-2009/grammar/ptnet\"><p:page id=\"g\">"
              "<p:place id=\"p\"><p:initialMarking><p:text>1<!-- one --></p:text>"
              "</p:initialMarking></p:place></p:page></p:net></p:pnml>") == "fine");
    const Checked<NetFile> latin =
        read_pnml("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" +
                      wrap("<place id=\"p\"><name><text>caf\xE9</text></name></place>"),
                  "n.pnml");
    REQUIRE(latin.has_value());
    CHECK(latin->draft.places[0].caption == "caf\xC3\xA9");
    CHECK(code_of(wrap("<place id=\"p\"><name><text>caf\xE9</text></name></place>")) ==
          "bad-encoding");
    CHECK(code_of(wrap("<place id=\"p\"/>", "")) == "fine");
}

TEST_CASE("a net with sources is a net, and one that nothing takes time in is paced [unit]") {
    const Checked<NetFile> file = read_pnml(
        wrap(std::string(kNodes) + "<arc id=\"a\" source=\"t\" target=\"p\"/>"), "n.pnml");
    REQUIRE(file.has_value());
    const Checked<net::Net> net = net::compile(file->draft);
    REQUIRE(net.has_value());
    CHECK(net->paced());
}

TEST_CASE("files are told apart by ending and content [unit]") {
    CHECK(net_format_of("a.pnml", "") == NetFormat::kPnml);
    CHECK(net_format_of("a.net", "") == NetFormat::kTina);
    CHECK(net_format_of("a.PUP", "") == NetFormat::kScene);
    CHECK(net_format_of("a.xml", "<pnml><net type=\"P/T net\"/></pnml>") == NetFormat::kPipe);
    CHECK(net_format_of("a.xml", "<pnml><net type=\"x/ptnet\"/></pnml>") == NetFormat::kPnml);
    CHECK(net_format_of("a", "<pnml>") == NetFormat::kPnml);
    CHECK(net_format_of("a.txt", "hello") == std::nullopt);
    CHECK(load_net("/nowhere/a.pnml").error()[0].code == "cannot-read");
    CHECK(read_net("hello", "a.txt").error()[0].code == "not-a-net-file");
}
