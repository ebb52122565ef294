// SPDX-License-Identifier: MIT
// What an author wants to know of a run as a number: `measure wait mean of stay in queue`. A
// statistic of something that is seen: of the state all the time, at firings, of stays of tokens,
// of the time from one firing to another. Part of the net's declarations; who plays the net
// measures (sim/meter.h).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/time.h"
#include "puppetri/net/indices.h"

namespace puppetri::net {

enum class Statistic : std::uint8_t {
    kMean,
    kMost,
    kLeast,
    kTotal,       // of a state the integral over time in seconds, else the sum
    kFinal,       // of a state at the end, else the last
    kShare,       // of the time, or of what was seen, that is true (or above a time)
    kPercentile,  // the least that so many percent do not exceed; not of a state
    kCount,       // how many were seen; not of a state
    kRate,        // how many per second; not of a state
};

enum class Seen : std::uint8_t {
    kState,     // `value` at every time
    kFirings,   // `value` just before each firing of one of `from`
    kStays,     // how long tokens were in `place`, of those that left
    kPassages,  // from a firing of `from` to the next one of `to` that belongs to it
    kCourse     // `course`, which goes on continuously beside the net, at every time
};

// A variable of equations, or a part of them that has a name (run/equations.h): the net itself
// knows no more than where to ask.
struct CourseQuantity {
    std::uint32_t system = 0;  // number of the equations among those of the scene
    std::uint32_t index = 0;   // of the variable, or of the part
    bool part = false;
};

// A transition, and what is evaluated just before it fires, its variables bound: what is seen there
// (kFirings; of kCount and kRate whether it is seen), or which passage begins or ends there
// (kPassages): they belong together if the values are equal, and the first that began ends first.
// `keyed` false: every firing is seen, all passages are alike.
struct Moment {
    TransitionIndex transition;
    Expr value;
    bool keyed = false;
};

struct MeasureDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    Statistic statistic = Statistic::kMean;
    Seen seen = Seen::kState;
    double percent = 50;           // of kPercentile, above 0, at most 100
    std::optional<SimTime> above;  // of kShare of times
    Expr value;                    // of kState: a number or a time, of kShare a bool
    PlaceIndex place;
    std::vector<Moment> from, to;
    CourseQuantity course;  // of kCourse: mean, most, least, total, final
    std::string unit;       // of kCourse: of the number that is told
};

// "s", "1/s", or nothing; of kCourse its own.
const char* unit_of(const MeasureDraft& measure);
// "mean", ..., as the language writes them.
const char* name_of(Statistic statistic);

}  // namespace puppetri::net
