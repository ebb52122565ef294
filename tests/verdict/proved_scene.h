// SPDX-License-Identifier: MIT
// Scenes from text, proved: `of("rule")` is a verdict.
#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "puppetri/scene/scene.h"
#include "puppetri/verdict/prove.h"

namespace puppetri::verdict {

struct ProvedScene {
    explicit ProvedScene(const std::string& body, ProveOptions options = {}) {
        scene::MemoryFiles files;
        files.add("test.pup",
                  "language 1\nscene \"test\"\nframes 24 per second, until 10 s\n" + body);
        auto loaded = scene::load(files, "test.pup");
        if (!loaded) {
            for (const Diagnostic& d : loaded.error()) {
                FAIL_CHECK(d.where.line << ": " << d.message << " " << d.remedy);
            }
        }
        REQUIRE(loaded.has_value());
        scene.emplace(std::move(*loaded));
        options.budget.seconds = std::min(options.budget.seconds, 20.0);
        verdicts = prove(*scene, options);
    }
    const Verdict& of(const std::string& rule) const {
        const auto found = std::find_if(verdicts.begin(), verdicts.end(),
                                        [&](const Verdict& v) { return v.rule == rule; });
        REQUIRE_MESSAGE(found != verdicts.end(), rule);
        INFO(rule << ": " << name_of(*found) << " by " << found->method << " " << found->reason);
        return *found;
    }
    std::string says(const std::string& rule) const {
        const Verdict& v = of(rule);
        // A refutation is a run, or the impossibility of one.
        if (v.answer == Answer::kRefuted) {
            const bool possible = v.reason.find("never fires") != std::string::npos ||
                                  v.reason.find("no run") != std::string::npos;
            CHECK_MESSAGE((v.witness.has_value() || possible), rule << ": " << v.reason);
            CHECK((!v.witness || v.witness->violates_after == Witness::kNone ||
                   v.witness->violates_after <= v.witness->steps.size()));
        }
        return name_of(v) + (v.answer == Answer::kUnknown ? " (" + v.reason + ")" : "");
    }
    bool has_note(const std::string& rule, const std::string& part) const {
        const Verdict& v = of(rule);
        return std::any_of(v.notes.begin(), v.notes.end(),
                           [&](const std::string& n) { return n.find(part) != std::string::npos; });
    }

    std::optional<scene::Scene> scene;
    std::vector<Verdict> verdicts;
};

}  // namespace puppetri::verdict
