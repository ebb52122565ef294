// SPDX-License-Identifier: MIT
// The rules that nobody has to write: every scene is asked whether time goes on, modules end clean,
// data stay in their ranges, figures never freeze, limbs and props have one master.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/stage/stage.h"

namespace puppetri::verdict {

// What is asked of a graph as a whole, beyond the kinds of rules of the language.
enum class Question : std::uint8_t {
    kRule,
    kTimeGoesOn,       // no instant with endlessly many firings
    kModulesEndClean,  // no run stops because something is left in a module
    kDataInRange,      // no run stops because a datum leaves its range
    kNothingStops,     // no run stops for another reason
    kJoins,            // movements of the figure `subjects[0]` that follow each other join
    kOneOfEach,        // tokens that name an actor or a prop are conserved one by one
};

struct Asked {
    net::Rule rule;
    Question question = Question::kRule;
    bool built_in = false;
    // Of kOneOfEach.
    std::vector<std::uint32_t> places, attributes;
};

// play may be null: a net without figures.
std::vector<Asked> built_in_rules(const net::Net& net, const net::NetDraft& draft,
                                  const stage::Play* play);

// True for the codes of faults that break the answer to this question.
bool concerns(Question question, const std::string& fault_code);

}  // namespace puppetri::verdict
