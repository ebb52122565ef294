// SPDX-License-Identifier: MIT
#include "puppetri/run/equations.h"

#include <utility>

#include "equation_course.h"
#include "puppetri/base/require.h"

namespace puppetri::run {

Equations::Equations(std::vector<EquationSystem> systems, const EquationsOptions& options)
    : systems_(std::move(systems)), options_(options) {
    for (const EquationSystem& s : systems_) {
        courses_.push_back(std::make_unique<Course>(s, options));
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
