// SPDX-License-Identifier: MIT
// Where the cells of a cellular automaton lie: their names, and the terms that say in which states
// a cell's neighbours are.
#pragma once
#include <cstdint>
#include <string>

#include "make.h"

namespace puppetri::notation {

struct CellGrid {
    struct Offset {
        int right = 0, down = 0;
    };

    std::int64_t columns = 0, rows = 1;
    bool wraps = false;    // edges meet
    bool flat = false;     // columns and rows; else one row
    bool diamond = false;  // neighbours are counted in steps along rows and columns
    int radius = 1;
    std::string outside;  // the state beyond the edges

    // cell[3], or cell[2][3]: row, then column, from 1; column and row here from 0.
    lang::Name name(std::string text, std::int64_t column, std::int64_t row, lang::Span span) const;
    // The state of the cell that lies so far from this one.
    lang::Expr state(std::int64_t column, std::int64_t row, Offset offset, lang::Span span) const;
    // How many neighbours are in a state.
    lang::Expr count(std::int64_t column, std::int64_t row, const lang::Path& state,
                     lang::Span span) const;
};

}  // namespace puppetri::notation
