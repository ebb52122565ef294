// SPDX-License-Identifier: MIT
// Scripts of TOOKIMA: extended state machines that are looked at in samples (Camargo, Magalhaes,
// Raposo, "Local and Global Control in Computer Animation", 1995, section 4). What a script says,
// line by line; tookima_net.cpp says which net it stands for.
#pragma once
#include <string>
#include <vector>

#include "puppetri/base/rational.h"
#include "puppetri/lang/parse.h"

namespace puppetri::notation::tookima {

// A name, or a text in quotes, and where it stands.
struct Word {
    std::string text;
    lang::Span span;
};

enum class When : std::uint8_t { kTrue, kMatch, kEvent };
enum class Task : std::uint8_t { kNothing, kSend, kSendState, kCall };

// ACTION(MACHINE, "from", when, task, "to")
struct Action {
    Word from, to;
    When when = When::kTrue;
    Word subject;  // the channel of MATCH, or the event
    Word message;  // that MATCH waits for
    Task task = Task::kNothing;
    Word target;  // the channel that gets something, or the function that is called
    Word sent;
    lang::Span span;
};

// DEF_ESM(NAME, "initial state"), then BEGIN_ESM(NAME) ... END_ESM
struct Machine {
    Word name, initial;
    std::vector<Word> channels, events;
    std::vector<Action> actions;
    bool defined = false, begun = false;
};

struct Script {
    std::vector<Machine> machines;  // in the order of their definition
    std::vector<Word> events, channels, functions;
    Rational from, to;  // seconds
    lang::Span interval;
    std::int64_t samples = 0;
    lang::Span sampled;
};

// Reads the text of `out.file`. Every slip is told with its remedy; after an error the script is
// not whole, after warnings alone it is what its author most likely meant.
Script parse(lang::Parsed& out, std::uint32_t file);

// What scripts may say where.
inline constexpr std::size_t kMaxSamples = 100'000, kMaxMessages = 200;

// Tells a defect of the script.
void tell(lang::Parsed& out, Severity severity, std::string code, lang::Span where,
          std::string element, std::string message, std::string remedy);

// Index of the word with this text, or -1.
template <class List>
std::ptrdiff_t index_of(const List& list, std::string_view text) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].text == text) {
            return static_cast<std::ptrdiff_t>(i);
        }
    }
    return -1;
}

}  // namespace puppetri::notation::tookima
