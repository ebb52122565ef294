// SPDX-License-Identifier: MIT
// Notations: other ways than a Petri net to say who acts when. Each *lowers* to the language's own
// syntax tree, to a net of places and transitions that could have been written by hand, so that one
// elaboration, one engine and one prover serve all of them, and several live in one scene.
//   A block `KIND NAME(PARAMETERS) { LINES }` of a notation becomes `net NAME(PARAMETERS) { ... }`:
// it is instantiated by `use NAME(...) as x`, refines a place by `runs NAME(...)`, and is imported
// by its name, like any net. Every node made carries the span of the line that it came from, so
// that diagnostics, logs and witnesses speak of what the author wrote.
#pragma once
#include <span>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

struct Lowered {
    lang::Net net;            // name, parameters and span of the block
    Diagnostics diagnostics;  // with an error: do not elaborate the net
};

// One kind of block.
struct Notation {
    std::string_view kind;     // the word that opens a block: "queue"
    std::string_view summary;  // one line for lists of kinds
    void (*lower)(const lang::Block& block, const lang::File& file, Lowered& out);
};

// All of them, in alphabetical order of their kinds.
std::span<const Notation> notations();

// Null where no notation has this kind.
const Notation* find_notation(std::string_view kind);

// The net that a machine stands for (docs/notations/machine.md): its states are places and one
// token is in one of them; a transition from a state to itself stays there, without beginning it
// anew; `poll every d` waits for an event of the machine's own. Everything in it is public.
Lowered lower_machine(const lang::Net& machine, const lang::File& file);

// The net that `block`, of file `file` and of a kind that find_notation knows, stands for. Tells
// all defects of the block at once.
Lowered lower(const Notation& notation, const lang::Block& block, const lang::File& file);

}  // namespace puppetri::notation
