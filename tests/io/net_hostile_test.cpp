// SPDX-License-Identifier: MIT
// Truncations and single-byte corruptions of every file of tests/corpus/nets give a net or defects,
// never a crash; what can be read is written and read again. Run it under the sanitizers too. The
// long form, every truncation and all 255 corruptions of every byte: PUPPETRI_LONG=1.
#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

#include "io/corrupt.h"
#include "io/survive_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

void survive(const std::string& name, const std::string& text) {
    const std::string law = broken_file_law(name, text);
    REQUIRE_MESSAGE(law == "", name << ": " << law << "\n" << text);
}

}  // namespace

TEST_CASE("the corpus itself is read, written and read again [hostile]") {
    for (const auto& [name, text] : net_corpus()) {
        survive(name, text);
        CHECK_MESSAGE(is_read(name, text), name);
    }
}

TEST_CASE("every truncation of a net is survived [hostile]") {
    const std::size_t step = long_form() ? 1 : 7;
    for (const auto& [name, text] : net_corpus()) {
        for (std::size_t n = 0; n < text.size(); n += step) {
            survive(name, text.substr(0, n));
        }
    }
}

TEST_CASE("single-byte corruptions of a net are survived [hostile]") {
    std::mt19937 random(5);
    const std::string marks(
        "<>/\"'&;=[]{}()*?!-,#: \n\t\0\x01\x80\xFF"
        "0919aw",
        35);
    for (const auto& [name, text] : net_corpus()) {
        const std::string& file = name;
        corrupt(text, marks, random,
                [&](const std::string& broken, std::size_t) { survive(file, broken); });
    }
}

TEST_CASE("bombs end in a defect: depth, numbers, entities, copies [hostile]") {
    const auto code = [](const Checked<NetFile>& file) {
        return file ? std::string("fine") : file.error()[0].code;
    };
    const std::string head = "<pnml><net id=\"n\" type=\"ptnet\">";
    std::string pages = head;
    for (int i = 0; i < 100'000; ++i) {
        pages += "<page id=\"p\">";
    }
    CHECK(code(read_pnml(pages, "n.pnml")) == "bad-xml");
    for (int i = 0; i < 100'000; ++i) {
        pages += "</page>";
    }
    CHECK(code(read_pnml(pages + "</net></pnml>", "n.pnml")) == "nested-too-deep");
    // An entity of one's own is no entity here: nothing grows.
    const std::string laughs =
        "<!DOCTYPE pnml [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]>" +
        head +
        "<page id=\"g\"><place id=\"p\"><name><text>&b;</text></name></place></page></net></pnml>";
    const Checked<NetFile> laughing = read_pnml(laughs, "n.pnml");
    REQUIRE(laughing.has_value());
    CHECK(laughing->draft.places.at(0).caption == "&b;");
    CHECK(code(read_pnml(head + "<page id=\"g\"><place id=\"p\"><initialMarking><text>" +
                             std::string(1000, '9') +
                             "</text></initialMarking></place></page></net></pnml>",
                         "n.pnml")) == "number-too-large");
    NetLimits small;
    small.bytes = 100;
    CHECK(code(read_pnml(laughs, "n.pnml", small)) == "file-too-large");
    CHECK(code(read_tina(laughs, "n.net", small)) == "file-too-large");
    CHECK(code(read_pipe(laughs, "n.xml", small)) == "file-too-large");
    CHECK(code(read_pnml(std::string("\xFF\xFEp\0n\0", 6), "n.pnml")) == "bad-encoding");
    CHECK(code(read_pnml("<?xml version=\"1.0\" encoding=\"EBCDIC\"?><pnml/>", "n.pnml")) ==
          "bad-encoding");
}

TEST_CASE("all defects of a file are told at once, each with its line and element [unit]") {
    const Checked<NetFile> file = read_pnml(
        "<pnml><net id=\"n\" type=\"ptnet\"><page id=\"g\">\n"
        "<place id=\"p\"><initialMarking><text>-3</text></initialMarking></place>\n"
        "<place id=\"p\"/>\n"
        "<transition id=\"t\"><delay>3</delay></transition>\n"
        "<arc id=\"a\" source=\"p\" target=\"q\"/>\n"
        "<arc id=\"b\" source=\"p\" target=\"t\" type=\"transport\"/>\n"
        "<arc id=\"c\" source=\"p\" target=\"p\"/>\n"
        "<arc id=\"d\" source=\"p\" target=\"t\"><inscription><text>0</text></inscription></arc>\n"
        "<referencePlace id=\"r\" ref=\"s\"/><referencePlace id=\"s\" ref=\"r\"/>\n"
        "</page></net></pnml>\n",
        "n.pnml");
    REQUIRE(!file.has_value());
    std::vector<std::pair<std::string, std::uint32_t>> found;
    for (const Diagnostic& d : file.error()) {
        found.emplace_back(d.code, d.where.line);
        CHECK(!d.element.empty());
        CHECK(!d.remedy.empty());
    }
    for (const auto& expected :
         std::vector<std::pair<std::string, std::uint32_t>>{{"number-too-small", 2},
                                                            {"duplicate-id", 3},
                                                            {"unknown-label", 4},
                                                            {"unknown-id", 5},
                                                            {"unknown-arc-type", 6},
                                                            {"arc-joins-alike", 7},
                                                            {"number-too-small", 8},
                                                            {"wrong-reference", 9}}) {
        CAPTURE(expected.first);
        CHECK(std::count(found.begin(), found.end(), expected) == 1);
    }
    CHECK(found.size() == 8);
}
