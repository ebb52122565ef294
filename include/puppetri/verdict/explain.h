// SPDX-License-Identifier: MIT
// A verdict in words: the story of its witness, who waits for what at the end, which token is
// missing and which transition took it, and a repair where theory gives one.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

// One line per firing: when, which transition, what begins. With captions where there are any; a
// mark where the rule is broken and where it goes round.
std::vector<std::string> story(const net::Net& net, const Witness& witness);

// Somebody who cannot go on.
struct Wait {
    std::string place;       // where the token is, with its caption
    std::string transition;  // what it waits for to fire
    std::string missing;     // the place without a token
    std::string taken_by;    // the firing that took the last one from there, and when; empty: never
                             // had one
    std::vector<std::string> givers;  // the transitions that could give one
    std::string words;                // all of it in a sentence
};

struct Explanation {
    std::string what;                 // the verdict and its reason
    std::vector<std::string> story;   // of the witness
    std::vector<Wait> waits;          // where it ends
    std::vector<std::string> siphon;  // places that are empty for ever, together
};
// Plays the witness again. Without one: what there is to say.
Explanation explain(const scene::Scene& scene, const Verdict& verdict);

// A change of the scene's text.
struct Repair {
    std::string idea;             // in a sentence
    std::string source;           // the theorem behind it
    std::string text;             // the whole file, changed
    std::string diff;             // lines with - and +
    std::vector<Verdict> proved;  // of the changed scene: the rule is proved, nothing got worse
};
// By a supervisor place: for `mutex`, `never` of two places and `bounded` after Moody and
// Antsaklis, for a deadlock or somebody who freezes a monitor of the siphon that was emptied.
// Offered only if the changed scene, loaded and proved again, keeps the rule and whatever else it
// kept before. Only transitions that stand in the scene's own file, outside of nets, are changed.
struct RepairAnswer {
    std::optional<Repair> repair;
    std::string reason;  // if not: why
};
RepairAnswer repair(scene::FileSource& files, const scene::Scene& scene,
                    const std::vector<Verdict>& verdicts, const std::string& rule,
                    const proof::Budget& budget);

}  // namespace puppetri::verdict
