// SPDX-License-Identifier: MIT
#include "puppetri/run/equations.h"

#include <utility>

#include "equation_course.h"
#include "puppetri/base/require.h"
#include "puppetri/run/course_book.h"

namespace puppetri::run {

Equations::Equations(std::vector<EquationSystem> systems, const EquationsOptions& options)
    : systems_(std::move(systems)), options_(options) {
    if (options.bake != nullptr) {
        for (const EquationSystem& s : systems_) {
            if (!s.baked_in.empty()) {
                options.bake->parts.push_back({s.path, hash_of(s), 0, {}});
            }
        }
    }
    std::size_t part = 0;
    for (const EquationSystem& s : systems_) {
        std::unique_ptr<StepSource> source;
        if (s.options.method == OdeMethod::kGiven) {
            const bool reads = !s.baked_in.empty() && options.bake == nullptr;
            PUP_REQUIRE(reads || options.sources != nullptr);
            source = reads ? baked_source(s) : options.sources->source(s);
            if (!s.baked_in.empty() && options.bake != nullptr) {
                source = recording_source(std::move(source), options.bake->parts[part++]);
            }
        }
        courses_.push_back(std::make_unique<Course>(s, options, std::move(source)));
    }
}
Equations::~Equations() = default;

void Equations::fired(SimTime, net::TransitionIndex transition) {
    for (const auto& c : courses_) {
        c->fired(transition);
    }
}

bool Equations::next(const net::State& state, SimTime until, Crossings& out, Diagnostic& fault) {
    out.events.clear();
    out.at = SimTime::never();
    found_ = ~std::uint32_t{0};
    for (std::uint32_t i = 0; i < courses_.size(); ++i) {
        Course& c = *courses_[i];
        if (!c.next(state, until, fault)) {
            return false;
        }
        const bool sooner =
            c.crossing_at() < out.at || (found_ != ~std::uint32_t{0} && c.crossing_at() == out.at &&
                                         c.root_s() < courses_[found_]->root_s());
        if (c.crossing_at() <= until && sooner) {
            out.at = c.crossing_at();
            found_ = i;
        }
    }
    if (found_ != ~std::uint32_t{0}) {
        courses_[found_]->crossings(out.events);
    }
    return true;
}

void Equations::deliver() {
    PUP_REQUIRE(found_ < courses_.size());
    courses_[found_]->deliver();
}

bool Equations::may_cross() const {
    for (const auto& c : courses_) {
        if (c->may_cross()) {
            return true;
        }
    }
    return false;
}

bool Equations::carry_to(SimTime at, Diagnostic& fault) {
    for (const auto& c : courses_) {
        if (!c->carry_to(at.seconds(), fault)) {
            return false;
        }
    }
    return true;
}

std::uint64_t Equations::given_hash(SimTime end) const {
    Hash64 hash;
    bool any = false;
    for (const auto& c : courses_) {
        any = c->add_given(end.seconds(), hash) || any;
    }
    return any ? hash.value() : 0;
}

const std::vector<EquationSystem>& Equations::systems() const { return systems_; }

double Equations::value(std::uint32_t system, std::uint32_t variable, SimTime at) const {
    PUP_REQUIRE(system < systems_.size() && variable < systems_[system].variables.size());
    return courses_[system]->value(variable, at.seconds());
}

double Equations::output(std::uint32_t system, std::uint32_t output, SimTime at) const {
    PUP_REQUIRE(system < systems_.size() && output < systems_[system].outputs.size());
    return courses_[system]->output(systems_[system].outputs[output], at.seconds());
}

}  // namespace puppetri::run
