// SPDX-License-Identifier: MIT
// Sensors: questions about where figures and props are, as yes or no. Each sets a datum of the net,
// which changes only at crossings: roots of the prepared motions, never samples of frames, rounded
// up to whole milliseconds.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/motion/bound_call.h"
#include "puppetri/net/indices.h"
#include "puppetri/run/coupled.h"
#include "puppetri/stage/stage.h"

namespace puppetri::stage {

enum class SensorKind : std::uint8_t {
    kDistance,  // of two points, metres
    kHeight,    // of a point above the floor, metres
    kSpeed,     // of a point, metres per second
    kAngle,     // a degree of freedom of an actor, radians or metres
    kInside,    // how deep a point is within a box; negative outside
};

// A point of an actor, the centre of a prop, or a fixed place.
struct SensorPoint {
    motion::ActorIndex actor = {};
    std::string joint = {};  // by name in the actor's skeleton
    motion::PropIndex prop = {};
    Vec3 at_world = {};
};

struct Sensor {
    SensorKind kind = SensorKind::kDistance;
    SensorPoint a = {}, b = {};
    std::string dof = {};                  // of a.actor, kAngle
    Vec3 low_world = {}, high_world = {};  // kInside
    double threshold = 0;
    bool above = false;  // true where the quantity is above the threshold; else where it is below
    net::EventIndex begins = {}, ends = {};
    std::string name = {};  // "distance(ana.right_hand, ball) < 0.3 m"
    SourceSpan where = {};
};

// Watches a stage while its run goes on. A sensor begins as `no`; what is true from the start or
// jumps (a figure that is cut) becomes so a millisecond later at most, never within the instant.
class Sensors final : public run::Coupled {
 public:
    // Both outlive it.
    Sensors(const std::vector<Sensor>& sensors, Stage& stage);

    bool next(const net::State& state, SimTime until, Crossings& out, Diagnostic& fault) override;
    void deliver() override;
    // Figures at rest cross nothing: asked a minute after the net did something for the last time.
    bool may_cross() const override;
    void save(std::vector<std::uint8_t>& out) const override;
    bool restore(std::span<const std::uint8_t> bytes) override;

    // The quantity less its threshold, with the sign that is positive where the sensor is true.
    double value(std::uint32_t sensor, SimTime at) const;

 private:
    Vec3 place(const SensorPoint& point, SimTime at) const;

    const std::vector<Sensor>& sensors_;
    Stage& stage_;
    std::vector<std::uint8_t> true_;    // per sensor, as the net knows it
    std::vector<std::uint32_t> found_;  // to be delivered
    SimTime searched_ = {-1};           // up to here, as long as the net does nothing
    SimTime changed_ = {0};             // when the net did something for the last time
    std::uint64_t firings_ = ~std::uint64_t{0};
    SimTime at_ = SimTime::never();
};

}  // namespace puppetri::stage
