// SPDX-License-Identifier: MIT
// Scenes of notations, loaded and played, and their logs as text: "20 s l.green_to_yellow".
#pragma once
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "doctest/doctest.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/scene.h"

namespace puppetri::notation {

inline std::string told(const Diagnostics& list) {
    std::string text;
    for (const Diagnostic& d : list) {
        text += format_diagnostic(d, "", false);
    }
    return text;
}

// "language 1" and a scene line before it: the body begins in line 3.
inline scene::Scene from_text(const std::string& body) {
    scene::MemoryFiles files;
    files.add("scene.pup", "language 1\nscene \"test\"\n" + body);
    Checked<scene::Scene> loaded = scene::load(files, "scene.pup");
    if (!loaded) {
        FAIL(told(loaded.error()));
    }
    return std::move(*loaded);
}

inline Diagnostics defects_of(const std::string& body) {
    scene::MemoryFiles files;
    files.add("scene.pup", "language 1\nscene \"test\"\n" + body);
    return scene::check(files, "scene.pup");
}

// What is told and in which line, sorted. Each defect names a remedy, and `element` where one is
// given.
using LinesAndCodes = std::vector<std::pair<std::uint32_t, std::string>>;
inline LinesAndCodes lines_and_codes(const Diagnostics& list, const std::string& element = "") {
    LinesAndCodes out;
    for (const Diagnostic& d : list) {
        out.emplace_back(d.where.line, d.code);
        CHECK_FALSE(d.remedy.empty());
        CHECK((element.empty() || d.element == element));
    }
    std::sort(out.begin(), out.end());
    return out;
}

// Every firing up to `seconds`; a fault ends the list.
inline std::vector<std::string> log_of(const scene::Scene& scene, double seconds,
                                       std::uint64_t seed = 1) {
    struct Log final : run::LogSink {
        const net::Net* net = nullptr;
        std::vector<std::string> lines;
        void fired(SimTime at, net::TransitionIndex t) override {
            char time[40];
            std::snprintf(time, sizeof time, "%.9g s ",
                          static_cast<double>(at.ticks) / static_cast<double>(kTicksPerSecond));
            lines.push_back(time + std::string(net->transition(t).path));
        }
    } log;
    log.net = &scene.net;
    run::Player player(scene.net, {.seed = seed, .sink = &log});
    const auto until = static_cast<std::int64_t>(seconds * static_cast<double>(kTicksPerSecond));
    if (player.run({.until = {until}}) == run::Stop::kFault) {
        log.lines.push_back("fault: " + player.fault().message);
    }
    return log.lines;
}

inline std::vector<std::string> log_of(const std::string& body, double seconds,
                                       std::uint64_t seed = 1) {
    return log_of(from_text(body), seconds, seed);
}

}  // namespace puppetri::notation
