// SPDX-License-Identifier: MIT
// Figures that follow a statechart: use "x.scxml" as head { STATE: MOVEMENT }.
#include <algorithm>

#include "playing.h"
#include "puppetri/scene/perform.h"

namespace puppetri::notation {
namespace {

constexpr const char* kChart =
    "<scxml xmlns=\"http://www.w3.org/2005/07/scxml\" version=\"1.0\" datamodel=\"ecmascript\">"
    "<state id=\"up\"><transition event=\"bell\" target=\"down\"/></state>"
    "<state id=\"down\"><transition event=\"ended.down\" target=\"rest\"/></state>"
    "<state id=\"rest\"/></scxml>";

scene::MemoryFiles scene_with(const std::string& lines) {
    scene::MemoryFiles files;
    files.add("head.scxml", kChart);
    files.add("scene.pup",
              "language 1\nscene \"test\"\nuntil 20 s\ncast { ana: mannequin }\n"
              "movement nod(me: actor) { takes 2 s, me.head.flex = 10 deg }\n"
              "event ring at 3 s\ntell: -> on ring raises h.bell\n"
              "use \"head.scxml\" as h {\n" +
                  lines + "}\n");
    return files;
}

TEST_CASE("a bound state begins its movement, cuts it, and hears of its end [unit]") {
    scene::MemoryFiles files = scene_with("  up: ana.idle(lasting: 5 s)\n  down: ana.nod()\n");
    Checked<scene::Scene> scene = scene::load(files, "scene.pup");
    if (!scene) {
        FAIL(told(scene.error()));
    }
    struct Log final : run::LogSink {
        const net::Net* net = nullptr;
        std::string lines;
        void fired(SimTime at, net::TransitionIndex t) override {
            const std::string path(net->transition(t).path);
            if (path.rfind("h_", 0) == 0) {
                lines += std::to_string(at.ticks / kTicksPerSecond) + " " + path + "\n";
            }
        }
    } log;
    log.net = &scene->net;
    scene::PerformOptions options;
    options.sink = &log;
    const auto performed = scene::perform(*scene, options);
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    // The bell cuts what goes with `up` at 3 s; the nod of 2 s ends by itself, which brings the
    // chart to rest.
    CHECK(log.lines ==
          "0 h_up_begins\n3 h_up_cut\n3 h_down_begins\n5 h_down_ends\n5 h_down_left\n");
}

TEST_CASE("a binding to no state of the chart is told with a remedy [unit]") {
    scene::MemoryFiles files =
        scene_with("  upp: ana.nod()\n  down: ana.nod()\n  down: ana.nod()\n");
    std::string got;
    for (const Diagnostic& d : scene::check(files, "scene.pup")) {
        got += std::to_string(d.where.line) + " " + d.code + " " + d.remedy + "\n";
    }
    CHECK(got == "9 unknown-name did you mean up?\n11 name-twice remove one of the lines\n");
}

TEST_CASE("states of a chart that no way leads to are warned of, the outermost alone [unit]") {
    scene::MemoryFiles files;
    files.add(
        "c.scxml",
        "<scxml xmlns=\"http://www.w3.org/2005/07/scxml\" version=\"1.0\">\n"
        "<state id=\"a\"><transition event=\"x\" target=\"b\"/></state>\n"
        "<state id=\"b\"><history id=\"h\"><transition target=\"b1\"/></history>\n"
        "<state id=\"b1\"/><state id=\"b2\"><transition event=\"y\" target=\"a\"/></state>\n"
        "<transition event=\"z\" target=\"a\"/></state>\n"
        "<state id=\"c\"><state id=\"c1\"><transition event=\"x\" target=\"d\"/></state></state>\n"
        "<state id=\"d\"><transition event=\"x\" target=\"c\"/></state>\n"
        "<parallel id=\"p\"><state id=\"q\"/></parallel>\n"
        "</scxml>");
    std::string got;
    for (const Diagnostic& d : scene::check(files, "c.scxml")) {
        got += std::to_string(d.where.line) + " " + d.code + "\n";
    }
    CHECK(got == "4 never-entered\n6 never-entered\n7 never-entered\n8 never-entered\n");
}

}  // namespace
}  // namespace puppetri::notation
