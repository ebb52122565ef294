// SPDX-License-Identifier: MIT
// Crossings of sensors. What a figure does is smooth between the instants of the net, and nothing
// moves faster than limbs do: a quantity is looked at every kLook, and where it comes near to its
// threshold and goes away again, its turning point is looked for.
#include "puppetri/stage/sensors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::stage {
namespace {

constexpr SimTime kLook{kTicksPerSecond / 250};
constexpr SimTime kMoment{kTicksPerSecond / 10'000};  // over which speeds are taken

constexpr SimTime kPatience{60 * kTicksPerSecond};

SimTime whole_ms_from(SimTime at) {
    const std::int64_t ms = (at.ticks + kTicksPerMillisecond - 1) / kTicksPerMillisecond;
    return {ms * kTicksPerMillisecond};
}

}  // namespace

Sensors::Sensors(const std::vector<Sensor>& sensors, Stage& stage)
    : sensors_(sensors), stage_(stage), true_(sensors.size(), 0) {}

Vec3 Sensors::place(const SensorPoint& point, SimTime at) const {
    if (point.prop.valid()) {
        return stage_.world_from_prop(point.prop, at).translation;
    }
    if (!point.actor.valid()) {
        return point.at_world;
    }
    thread_local figure::Pose pose;  // scratch: results never depend on what it holds
    stage_.pose(point.actor, at, pose);
    const figure::Skeleton& skeleton = stage_.figure(point.actor).skeleton;
    std::uint32_t joint = 0;
    for (std::uint32_t i = 0; i < skeleton.joints.size(); ++i) {
        joint = skeleton.joints[i].name == point.joint ? i : joint;
    }
    Transform t = pose.parent_from_joint[joint];
    for (figure::JointIndex p = skeleton.joints[joint].parent; p.valid();
         p = skeleton.joints[p.value].parent) {
        t = pose.parent_from_joint[p.value] * t;
    }
    return t.translation;
}

double Sensors::value(std::uint32_t number, SimTime at) const {
    PUP_REQUIRE(number < sensors_.size());
    const Sensor& s = sensors_[number];
    double quantity = 0;
    switch (s.kind) {
        case SensorKind::kDistance:
            quantity = length(place(s.a, at) - place(s.b, at));
            break;
        case SensorKind::kHeight:
            quantity = place(s.a, at).y;
            break;
        case SensorKind::kSpeed:
            quantity = length(place(s.a, at + kMoment) - place(s.a, at)) / kMoment.seconds();
            break;
        case SensorKind::kAngle: {
            thread_local figure::Pose pose;
            stage_.pose(s.a.actor, at, pose);
            const figure::Figure& f = stage_.figure(s.a.actor);
            const figure::DofIndex dof = f.dofs.find(s.dof);
            PUP_REQUIRE(dof.valid());
            const figure::JointIndex joint = f.dofs.dofs[dof.value].joint;
            const figure::DofSet::Range range = f.dofs.of_joint(joint);
            std::array<double, 8> values{};
            PUP_REQUIRE(range.count <= values.size());
            figure::values_of(std::span(f.dofs.dofs).subspan(range.first, range.count),
                              f.skeleton.joints[joint.value].parent_from_joint_rest,
                              pose.parent_from_joint[joint.value],
                              std::span(values.data(), range.count));
            quantity = values[dof.value - range.first];
            break;
        }
        case SensorKind::kInside: {
            const Vec3 p = place(s.a, at);
            quantity = std::min({p.x - s.low_world.x, s.high_world.x - p.x, p.y - s.low_world.y,
                                 s.high_world.y - p.y, p.z - s.low_world.z, s.high_world.z - p.z});
            break;
        }
    }
    return s.above ? quantity - s.threshold : s.threshold - quantity;
}

bool Sensors::next(const net::State& state, SimTime until, Crossings& out, Diagnostic&) {
    out = {};
    const SimTime now{state.now};
    if (until <= now) {
        return true;  // the instant is not over
    }
    if (state.firings != firings_ || searched_ < now) {
        // Something may have begun: all from here on is new.
        changed_ = state.firings != firings_ ? now : changed_;
        firings_ = state.firings;
        searched_ = now;
        found_.clear();
        at_ = SimTime::never();
        // What the instant left to be settled on the stage is settled: time passes here.
        stage_.pass_to(now + SimTime{1});
    }
    const auto holds = [this](std::uint32_t i, SimTime t) { return value(i, t) > 0; };
    until = std::min(until, changed_ + kPatience + kLook);
    while (found_.empty() && searched_ < until) {
        SimTime first = SimTime::never();
        const SimTime from = searched_;
        const SimTime to = std::min(until, from + kLook);
        for (std::uint32_t i = 0; i < sensors_.size(); ++i) {
            const bool was = true_[i] != 0;
            SimTime at = SimTime::never();
            if (holds(i, from) != was) {
                at = from;
            } else if (to > from) {
                SimTime low = from, high = to;
                bool changed = holds(i, to) != was;
                if (!changed) {
                    // Nearer in the middle than at both ends: perhaps there and back.
                    const double sign = was ? 1 : -1;
                    const auto f = [&](SimTime t) { return sign * value(i, t); };
                    const SimTime step{std::max<std::int64_t>((to - from).ticks / 64, 1)};
                    if (f(from + step) < f(from) && f(to - step) < f(to)) {
                        SimTime a = from, b = to;
                        while ((b - a).ticks > 3 && !changed) {
                            const SimTime third{(b - a).ticks / 3};
                            const SimTime x = a + third, y = b - third;
                            (f(x) < f(y) ? b : a) = f(x) < f(y) ? y : x;
                            changed = holds(i, a + third) != was;
                            high = changed ? a + third : high;
                        }
                    }
                }
                if (changed) {
                    while ((high - low).ticks > 1) {
                        const SimTime middle{low.ticks + (high - low).ticks / 2};
                        (holds(i, middle) != was ? high : low) = middle;
                    }
                    at = high;
                }
            }
            if (at == SimTime::never()) {
                continue;
            }
            at = std::max(whole_ms_from(at), whole_ms_from(now + SimTime{1}));
            if (at < first) {
                first = at;
                found_.clear();
            }
            if (at == first) {
                found_.push_back(i);
            }
        }
        at_ = first;
        if (found_.empty()) {
            searched_ = to;
        }
    }
    if (found_.empty() || at_ > until) {
        return true;
    }
    out.at = at_;
    for (const std::uint32_t i : found_) {
        out.events.push_back(true_[i] != 0 ? sensors_[i].ends : sensors_[i].begins);
    }
    return true;
}

bool Sensors::may_cross() const { return !sensors_.empty() && searched_ < changed_ + kPatience; }

void Sensors::deliver() {
    for (const std::uint32_t i : found_) {
        true_[i] = true_[i] != 0 ? 0 : 1;
    }
    searched_ = at_;
    found_.clear();
    at_ = SimTime::never();
}

void Sensors::save(std::vector<std::uint8_t>& out) const {
    out.insert(out.end(), true_.begin(), true_.end());
}

bool Sensors::restore(std::span<const std::uint8_t> bytes) {
    if (bytes.size() != true_.size() ||
        std::any_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b > 1; })) {
        return false;
    }
    true_.assign(bytes.begin(), bytes.end());
    searched_ = {-1};
    firings_ = ~std::uint64_t{0};
    changed_ = {0};
    found_.clear();
    at_ = SimTime::never();
    return true;
}

}  // namespace puppetri::stage
