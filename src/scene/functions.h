// SPDX-License-Identifier: MIT
// The functions of numbers that expressions may call, by name.
#pragma once
#include <span>
#include <string_view>

#include "puppetri/base/expr.h"

namespace puppetri::scene {

struct Function {
    const char* name;
    ExprOp op;
    int operands;                    // min and max take more, too
    double (*fold)(double, double);  // of constants without unit; null: folded by hand
};

std::span<const Function> functions();
// Null when there is none of that name.
const Function* find_function(std::string_view name);

// What a function says about units, besides the number of its operands.
constexpr bool takes_angle(ExprOp op) {
    return op == ExprOp::kSin || op == ExprOp::kCos || op == ExprOp::kTan;
}
constexpr bool gives_angle(ExprOp op) {
    return op == ExprOp::kAsin || op == ExprOp::kAcos || op == ExprOp::kAtan2;
}

}  // namespace puppetri::scene
