// SPDX-License-Identifier: MIT
// Who lowers which kind of block: one function, and one source file, for each. A function gets the
// block and the file that it stands in, finds name, parameters and span of the net filled in, and
// adds the body and its diagnostics.
#pragma once
#include "puppetri/notation/notation.h"

namespace puppetri::notation {

void lower_automaton(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_cells(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_equations(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_event_graph(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_linda(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_logic(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_markov(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_messages(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_pulses(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_queue(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_script(const lang::Block& block, const lang::File& file, Lowered& out);
void lower_unit(const lang::Block& block, const lang::File& file, Lowered& out);

}  // namespace puppetri::notation
