// SPDX-License-Identifier: MIT
// The reference of the language says nothing that the parser does not: every example parses and is
// in canonical form.
#include "lang/language_doc.h"

#include <doctest/doctest.h>

#include "lang/survive.h"
#include "puppetri/lang/units.h"

using namespace puppetri;
using namespace puppetri::lang;

TEST_CASE("every example of the language's pages parses [golden]") {
    const std::vector<testing::DocExample> examples = testing::doc_examples();
    REQUIRE(examples.size() >= 20);
    for (const testing::DocExample& example : examples) {
        const Parsed result = parse(example.text, example.page);
        for (const Diagnostic& d : result.diagnostics) {
            FAIL_CHECK(example.page
                       << ", example at line " << example.line << ": "
                       << format_diagnostic(d, result.file.line_text(d.where.line), false));
        }
        CHECK_MESSAGE(testing::broken_law(example.text) == "", example.text);
        const Checked<std::string> canonical = format(example.text, example.page);
        REQUIRE(canonical.has_value());
        CHECK_MESSAGE(canonical.value() == example.text,
                      "at line " << example.line << " of " << example.page);
    }
}

TEST_CASE("the reference tells of every keyword and every unit [golden]") {
    const std::string page = testing::doc_page();
    for (const std::string_view word : keywords()) {
        CHECK_MESSAGE(page.find(word) != std::string::npos, word);
    }
    for (const std::string& unit : unit_names()) {
        CHECK_MESSAGE(page.find(unit) != std::string::npos, unit);
    }
}
