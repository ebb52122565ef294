// SPDX-License-Identifier: MIT
// The whole scenes in docs/language.md and docs/notations/ have no defect, and load.
#include "lang/language_doc.h"

#include <doctest/doctest.h>

#include "puppetri/scene/scene.h"

using namespace puppetri;

TEST_CASE("every whole scene of the language's pages checks clean and loads [golden]") {
    int scenes = 0;
    for (const lang::testing::DocExample& example : lang::testing::doc_examples()) {
        if (!example.is_scene) {
            continue;
        }
        ++scenes;
        scene::MemoryFiles files;
        files.add("doc.pup", example.text);
        for (const Diagnostic& d : scene::check(files, "doc.pup")) {
            FAIL_CHECK(example.page << ", scene at line " << example.line << ", its line "
                                    << format_diagnostic(d, "", false));
        }
        CHECK_MESSAGE(scene::load(files, "doc.pup").has_value(), example.text);
    }
    CHECK(scenes >= 12);
}
