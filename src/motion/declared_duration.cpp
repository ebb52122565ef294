// SPDX-License-Identifier: MIT
#include "puppetri/motion/declared_duration.h"

#include <algorithm>

#include "puppetri/motion/arguments.h"
#include "puppetri/motion/gait.h"
#include "puppetri/motion/own_movement.h"
#include "times.h"

namespace puppetri::motion {
namespace {

DurationRange exactly(SimTime duration) { return {duration, duration}; }

SimTime step_of(StepKind kind) {
    return whole_milliseconds(step_duration_s({.transfer = Side::kLeft, .kind = kind}));
}
SimTime walk_of(double steps) {
    const std::int64_t whole = walked_steps(steps) - 1;
    return step_of(StepKind::kFirstHalf) + step_of(StepKind::kLastHalf) +
           SimTime{whole * step_of(StepKind::kWhole).ticks};
}

}  // namespace

DurationRange declared_duration(const BoundCall& call) {
    const MovementSignature& signature = signature_of(call, call.subject.kind);
    const Arguments arguments(call, signature);
    if (call.own != nullptr) {
        return call.own->maker().declared(arguments);
    }
    const DurationRange row{signature.shortest, signature.longest};
    const std::string_view name = signature.name;
    if (name == "support" || name == "transfer") {
        return arguments.get<TokenAttribute>("half") != nullptr
                   ? DurationRange{step_of(StepKind::kFirstHalf), step_of(StepKind::kWhole)}
                   : exactly(
                         step_of(arguments.flag("half") ? StepKind::kFirstHalf : StepKind::kWhole));
    }
    if (name == "walk" && arguments.get<TokenAttribute>("steps") == nullptr) {
        return exactly(walk_of(arguments.number("steps")));
    }
    if (name == "idle" || name == "stand") {
        return exactly(standing_time(arguments.number("lasting")));
    }
    return row;
}

}  // namespace puppetri::motion
