// SPDX-License-Identifier: MIT
// The pages of docs/ are true: every example that is a whole scene loads and runs.
#include <fstream>
#include <iterator>
#include <sstream>

#include "files.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {

namespace {

// How many scenes the page has, all loaded and run.
int scenes_of(const char* page) {
    std::ifstream in(std::string(PUP_SOURCE_DIR "/docs/") + page);
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
    return scenes;
}

}  // namespace

TEST_CASE("every whole scene of docs/language.md loads without a defect and runs [unit]") {
    CHECK(scenes_of("language.md") >= 14);
}

TEST_CASE("so does every whole scene of docs/inverse_kinematics.md [unit]") {
    CHECK(scenes_of("inverse_kinematics.md") >= 1);
}

}  // namespace puppetri::scene
