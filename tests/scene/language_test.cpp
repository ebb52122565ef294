// SPDX-License-Identifier: MIT
// The reference of the language (docs/language.md) is true: every example that is a whole scene
// loads and runs.
#include <fstream>
#include <iterator>
#include <sstream>

#include "files.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {

TEST_CASE("every whole scene of docs/language.md loads without a defect and runs [unit]") {
    std::ifstream in(PUP_SOURCE_DIR "/docs/language.md");
    std::string line, text;
    bool inside = false;
    int scenes = 0;
    while (std::getline(in, line)) {
        if (line.rfind("```pup scene", 0) == 0) {
            inside = true;
            text.clear();
        } else if (inside && line.rfind("```", 0) == 0) {
            inside = false;
            ++scenes;
            MemoryFiles files;
            files.add("scene.pup", text);
            const auto scene = load(files, "scene.pup");
            CHECK_MESSAGE(scene.has_value(), text << (scene ? "" : told(scene.error())));
            if (scene) {
                const auto performed = perform(*scene);
                REQUIRE_MESSAGE(performed.has_value(), text);
                CHECK_MESSAGE(performed->firings > 0, text);
                CHECK_MESSAGE(!performed->fault,
                              text << (performed->fault ? told({*performed->fault}) : ""));
            }
        } else if (inside) {
            text += line + "\n";
        }
    }
    CHECK(scenes >= 14);
}

}  // namespace puppetri::scene
