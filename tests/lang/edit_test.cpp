// SPDX-License-Identifier: MIT
// Edits change what they are told to change and no other byte.
#include "puppetri/lang/edit.h"

#include <doctest/doctest.h>

#include "puppetri/lang/parse.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

const std::string kText =
    "net n {  # a net\n"
    "  # the first\n"
    "  place a takes 2 s  # two\n"
    "  go: a -> a  # round\n"
    "}\n"
    "net small { place b }\n";

std::string edited(const File& file, Edit edit) {
    Checked<std::string> out = apply(file, std::span(&edit, 1));
    REQUIRE(out.has_value());
    return std::move(out).value();
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    return text;
}

}  // namespace

TEST_CASE("an edit leaves all comments where they are [unit]") {
    const Parsed parsed = parse(kText, "t.pup");
    const File& file = parsed.file;
    const Net& net = file.body.nets[0];
    CHECK(edited(file, replace(net.body.places[0].takes.span, "takes 3 s")) ==
          replaced(kText, "takes 2 s", "takes 3 s"));
    CHECK(edited(file, add_clause(file, net.body.transitions[0].span, "priority 2")) ==
          replaced(kText, "-> a  #", "-> a priority 2  #"));
    CHECK(edited(file, insert_after(file, net.body.places[0].span, "place c")) ==
          replaced(kText, "# two\n", "# two\n  place c\n"));
    CHECK(edited(file, append_to_block(file, net.span, "place c")) ==
          replaced(kText, "# round\n", "# round\n  place c\n"));
    CHECK(edited(file, remove_statement(file, net.body.transitions[0].span)) ==
          replaced(kText, "  go: a -> a  # round\n", ""));
}

TEST_CASE("blocks on one line are opened where they must be [unit]") {
    const Parsed parsed = parse(kText, "t.pup");
    const Net& small = parsed.file.body.nets[1];
    CHECK(edited(parsed.file, append_to_block(parsed.file, small.span, "place c")) ==
          replaced(kText, "{ place b }", "{ place b\n  place c\n}"));
    const Parsed after =
        parse(edited(parsed.file, insert_after(parsed.file, small.body.places[0].span, "place c")),
              "t.pup");
    CHECK(after.diagnostics.empty());
    CHECK(after.file.body.nets[1].body.places.size() == 2);
    CHECK(edited(parsed.file, remove_statement(parsed.file, small.body.places[0].span)) ==
          replaced(kText, "{ place b }", "{  }"));
}

TEST_CASE("a statement can follow the last line even without a line end [unit]") {
    const Parsed parsed = parse("place a", "t.pup");
    CHECK(edited(parsed.file, insert_after(parsed.file, parsed.file.body.places[0].span,
                                           "place b")) == "place a\nplace b\n");
}

TEST_CASE("edits are applied together or not at all [unit]") {
    const Parsed parsed = parse(kText, "t.pup");
    const Net& net = parsed.file.body.nets[0];
    const Edit good = add_clause(parsed.file, net.body.transitions[0].span, "priority 2");
    const Edit overlapping[] = {replace(net.span, ""), good};
    CHECK(apply(parsed.file, overlapping).error()[0].code == "edit-refused");
    const Edit broken[] = {good, replace(net.body.places[0].span, "plce a")};
    CHECK(apply(parsed.file, broken).error()[0].code == "unknown-keyword");
    const Edit outside[] = {{{1000, 1001, 0}, ""}};
    CHECK(apply(parsed.file, outside).error()[0].code == "edit-refused");
    const Edit both[] = {good, replace(net.body.places[0].takes.span, "takes auto")};
    CHECK(apply(parsed.file, both).has_value());
}
