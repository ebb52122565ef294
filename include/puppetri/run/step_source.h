// SPDX-License-Identifier: MIT
// Where the steps of equations come from that our own integrator does not solve: a library that a
// build may lack, or a file of its results (run/course_book.h).
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "puppetri/math/ode.h"

namespace puppetri::run {

struct EquationSystem;

class StepSource {
 public:
    enum class Outcome : std::uint8_t {
        kStepped,
        kBlewUp,   // the solution ends here, or the right side has no value
        kUnknown,  // it does not know; why() says why
    };
    // Why a source does not know: the code of a diagnostic, what is wrong, what to do.
    struct Why {
        std::string code, message, remedy;
    };

    virtual ~StepSource() = default;
    // Begins anew at t_s; no step goes beyond until_s. `data` is what the net says from there on,
    // until the next start. The same start gives the same steps.
    virtual Outcome start(OdeSystem& system, double t_s, double until_s, std::span<const double> x,
                          std::span<const double> data) = 0;
    // One step from where the last one ended, with the interpolant of OdeMethod::kGiven.
    virtual Outcome step(OdeSystem& system, OdeStep& out) = 0;
    // Where the last step ended; the next begins there, to the last bit.
    virtual double now_s() const = 0;
    virtual Why why() const = 0;
};

class StepSources {
 public:
    virtual ~StepSources() = default;
    // Never null: a part that is missing is a source that says so.
    virtual std::unique_ptr<StepSource> source(const EquationSystem& system) = 0;
};

}  // namespace puppetri::run
