// SPDX-License-Identifier: MIT
// A chain of movements without a net: each is prepared from the state in which it finds the figure,
// as the stage does.
#pragma once
#include <vector>

#include "puppetri/motion/context.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/movement.h"
#include "puppetri/motion/solve_controls.h"
#include "support/measure.h"

namespace puppetri::test {

class Chain {
 public:
    Chain(const figure::Figure& figure, motion::Controls start) : f_(figure), start_(start) {}

    motion::MotionContext context(double duration_s = -1) const {
        motion::MotionContext c{
            .figure = f_, .now = at(now_s_), .rate = {}, .at = ticks(now_s_), .seed = 7};
        if (!parts_.empty()) {
            constexpr double h = 1e-4;
            c.rate = motion::rate_between(at(now_s_ - h), at(now_s_), h);
        }
        if (duration_s >= 0) {
            c.duration = ticks(duration_s);
        }
        return c;
    }
    // All of `movements` start now; time goes on by duration_s.
    void run(std::vector<motion::MovementPtr> movements, double duration_s) {
        if (now_s_ > 0) {
            joins_.push_back(now_s_);
        }
        for (auto& m : movements) {
            parts_.push_back({now_s_, now_s_ + duration_s, std::move(m)});
        }
        now_s_ += duration_s;
    }
    double steady_begin_s = 0, steady_end_s = -1;
    double now_s() const { return now_s_; }
    const std::vector<double>& joins() const { return joins_; }

    // The state at t, each limb from the last movement for it that began before t (at a join: the
    // earlier one).
    motion::Controls at(double t) const {
        motion::Controls out = start_;
        for (const Part& part : parts_) {
            if (part.begin_s < t || part.begin_s == 0) {
                part.movement->sample(t - part.begin_s, out);
            }
        }
        return out;
    }
    std::vector<Planted> planted() const {
        std::vector<Planted> list;
        for (const Part& part : parts_) {
            for (const motion::PhaseSpan& span : part.movement->phases) {
                const bool left = span.limb == motion::Limb::kLeftLeg;
                if (span.phase != motion::Phase::kSupport ||
                    (!left && span.limb != motion::Limb::kRightLeg)) {
                    continue;
                }
                const double begin = part.begin_s + span.begin.seconds();
                const double end = std::fmin(part.begin_s + span.end.seconds(), part.end_s);
                if (end <= begin) {
                    continue;
                }
                bool grown = false;
                for (Planted& p : list) {
                    if (p.side == (left ? 0 : 1) && std::fabs(p.end_s - begin) < 1e-6) {
                        p.end_s = end;
                        grown = true;
                    }
                }
                if (!grown) {
                    list.push_back({left ? 0 : 1, begin, end});
                }
            }
        }
        return list;
    }
    Measures measured(double rate_hz = 480) const {
        figure::Pose pose;
        return measure({.figure = f_,
                        .sample =
                            [&](double t, std::span<Transform> world) {
                                motion::solve_controls(f_, at(t), pose);
                                figure::to_model_space(f_.skeleton, pose, world);
                            },
                        .begin_s = 0,
                        .end_s = now_s_,
                        .rate_hz = rate_hz,
                        .planted = planted(),
                        .joins_s = joins_,
                        .steady_begin_s = steady_begin_s,
                        .steady_end_s = steady_end_s});
    }
    std::vector<Transform> world(double t) const {
        figure::Pose pose;
        std::vector<Transform> world(f_.skeleton.joints.size());
        motion::solve_controls(f_, at(t), pose);
        figure::to_model_space(f_.skeleton, pose, world);
        return world;
    }
    static SimTime ticks(double s) {
        return {static_cast<std::int64_t>(std::nearbyint(s * kTicksPerSecond))};
    }

 private:
    struct Part {
        double begin_s, end_s;
        motion::MovementPtr movement;
    };
    const figure::Figure& f_;
    motion::Controls start_;
    std::vector<Part> parts_;
    std::vector<double> joins_;
    double now_s_ = 0;
};

}  // namespace puppetri::test
