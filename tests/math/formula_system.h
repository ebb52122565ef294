// SPDX-License-Identifier: MIT
// Equations of a test, as a function (t, x, rates), with the number of its calls.
#pragma once
#include "puppetri/math/ode.h"

namespace puppetri {

template <class F>
struct FormulaSystem final : OdeSystem {
    FormulaSystem(std::uint32_t count, F function) : n(count), f(function) {}
    std::uint32_t size() const override { return n; }
    bool rates(double t, std::span<const double> x, std::span<double> out) override {
        ++calls;
        f(t, x, out);
        return true;
    }
    std::uint32_t n;
    F f;
    int calls = 0;
};
template <class F>
FormulaSystem(std::uint32_t, F) -> FormulaSystem<F>;

}  // namespace puppetri
