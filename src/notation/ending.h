// SPDX-License-Identifier: MIT
// How a block comes to its end, where a place or a state of a machine runs it: the line `ends ...`
// of notations that would go on for ever, and the ways in and out that it makes.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "line.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

// A place of a net within this one.
struct InnerPlace {
    lang::Path place;
    bool begins = false;  // it has a token when the net begins
};

struct Ending {
    lang::Span span;                 // of the line
    bool said = false;               // there is such a line: else the block goes on for ever
    std::string counts;              // the place whose tokens are counted; empty: none
    lang::Expr count;                // so many of them
    lang::Expr when;                 // and this holds
    std::string given;               // the place whose token ends it; empty: none
    std::vector<InnerPlace> within;  // what else is begun and called off; nothing is in it before

    explicit operator bool() const { return said; }
};

// Whether this is a line `ends`, `ends after ...` or `ends when ...`: anything else may be about
// something that is called so.
bool is_ending(const lang::Property& property);

// Notes that the line is there, and takes its word.
// Fails  with a diagnostic where there is another such line, or the word is another; `form` is how
// to write it.
bool begin_ending(Line& line, std::string_view word, std::string_view form, Teller& teller,
                  Ending& to);

// `ends after NUMBER UNITS`; one of them without its s. The tokens of the place `counts` are
// counted.
void read_count(Line& line, std::string_view units, std::string_view counts, Teller& teller,
                Ending& to);

// The net has got all that the block says, as one that goes on for ever. It now begins by
// KIND_starts with a token in KIND_begin, as at time 0: tokens and data are as they were then, and
// times count from then. While it goes on there is a token in KIND_running; nothing that comes from
// outside is heard otherwise. KIND_ends, of this priority, ends it when the Ending says so: tokens
// that are left are gone, and there is one in KIND_done. Data stay as they are until it begins
// again.
void make_ways(const std::string& kind, const Ending& ending, std::int64_t priority, Teller& teller,
               lang::Body& body);

}  // namespace puppetri::notation
