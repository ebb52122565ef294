// SPDX-License-Identifier: MIT
// Baked courses: what an integrator that not every machine has made of equations, written down step
// by step, so that every machine plays the same. A book has a part for each system of a scene; a
// part has a segment for each time that the integration began anew, which is found again by what it
// began with, bit for bit: whoever comes to another beginning plays another run than that was
// baked.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/math/ode.h"
#include "puppetri/run/step_source.h"

namespace puppetri::run {

struct CourseSegment {
    double begin_s = 0, until_s = 0;
    std::vector<double> x, data;  // what it began with
    std::vector<OdeStep> steps;   // one after another from begin_s on
    double end_s = 0;             // of the last
};

struct CoursePart {
    std::string path;             // of the instance of equations
    std::uint64_t equations = 0;  // hash_of the system that it was made of
    std::uint32_t size = 0;       // variables, the watched quantities included
    std::vector<CourseSegment> segments;
};

struct CourseBook {
    std::string solver;  // that made it: "SUNDIALS 6.4.1"
    std::vector<CoursePart> parts;

    // Null: there is none of that name.
    const CoursePart* find(std::string_view path) const;
};

// Of everything that decides how a system goes on from a beginning: formulas, options, events.
std::uint64_t hash_of(const EquationSystem& system);

// The bytes of a book, closed by their hash; the same on every machine.
std::string write_courses(const CourseBook& book);
// Fails   "bad-course" when the bytes are no such file, or damaged. Whatever the bytes are, steps
//         are finite, follow each other and have the form of OdeMethod::kGiven.
Checked<CourseBook> read_courses(std::string_view bytes, const std::string& file);

// Plays the part of a system off its book, EquationSystem::baked.
std::unique_ptr<StepSource> baked_source(const EquationSystem& system);
// Writes down in `part`, which must outlive it, what another source makes.
std::unique_ptr<StepSource> recording_source(std::unique_ptr<StepSource> source, CoursePart& part);

// Why the book of a system holds nothing for it; nothing if it does.
std::optional<StepSource::Why> not_baked(const EquationSystem& system);

}  // namespace puppetri::run
