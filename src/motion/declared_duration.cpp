// SPDX-License-Identifier: MIT
#include "puppetri/motion/declared_duration.h"

#include <algorithm>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/arguments.h"
#include "puppetri/motion/gait.h"
#include "puppetri/motion/gestures.h"
#include "puppetri/motion/jump.h"
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
    if (name == "jump") {
        return exactly(whole_milliseconds(jump_duration_s(arguments.number("height"))));
    }
    const auto count = [&](const char* parameter, int most) {
        return static_cast<int>(clamp(arguments.number(parameter), 1, most));
    };
    if (name == "wave" && arguments.get<TokenAttribute>("times") == nullptr) {
        return exactly(whole_milliseconds(wave_duration_s(count("times", kMostWaves))));
    }
    if (name == "eat" && arguments.get<TokenAttribute>("bites") == nullptr) {
        return exactly(whole_milliseconds(eat_duration_s(count("bites", kMostBites))));
    }
    return row;
}

}  // namespace puppetri::motion
