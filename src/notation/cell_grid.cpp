// SPDX-License-Identifier: MIT
#include "cell_grid.h"

#include <cstdlib>
#include <utility>

namespace puppetri::notation {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

lang::Name CellGrid::name(std::string text, std::int64_t column, std::int64_t row,
                          lang::Span span) const {
    lang::Name name{std::move(text), {}, span};
    if (flat) {
        name.index.push_back(make_number(Rational{row + 1}, span));
    }
    name.index.push_back(make_number(Rational{column + 1}, span));
    return name;
}

Expr CellGrid::state(std::int64_t column, std::int64_t row, Offset offset, lang::Span span) const {
    column += offset.right;
    row += offset.down;
    if (wraps) {
        column = (column % columns + columns) % columns;
        row = (row % rows + rows) % rows;
    } else if (column < 0 || column >= columns || row < 0 || row >= rows) {
        return make_reference(outside, span);
    }
    return make_reference(make_path({name("cell", column, row, span)}, span));
}

Expr CellGrid::count(std::int64_t column, std::int64_t row, const lang::Path& wanted,
                     lang::Span span) const {
    Expr sum;
    const int high = flat ? radius : 0;
    for (int down = -high; down <= high; ++down) {
        for (int right = -radius; right <= radius; ++right) {
            if ((right == 0 && down == 0) ||
                (diamond && std::abs(right) + std::abs(down) > radius)) {
                continue;
            }
            Expr one = make_choice(make_binary(Op::kEqual, state(column, row, {right, down}, span),
                                               make_reference(wanted)),
                                   make_number(Rational{1}, span), make_number(Rational{0}, span));
            if (!sum) {
                sum = std::move(one);
            } else if (sum.kind == ExprKind::kBinary) {
                sum.args.push_back({{}, std::move(one)});
            } else {
                sum = make_binary(Op::kAdd, std::move(sum), std::move(one));
            }
        }
    }
    return sum;
}

}  // namespace puppetri::notation
