// SPDX-License-Identifier: MIT
// The rest of the stride is what the movement that is cut would have done; the last half step is
// the one of every walk (gait.h).
#include "finish_stride.h"

#include <algorithm>
#include <utility>

#include "compose.h"
#include "puppetri/motion/gait.h"
#include "times.h"

namespace puppetri::motion {
namespace {

constexpr double kLeast_s = 0.3;  // for what comes after it

class Remainder final : public Movement {
 public:
    Remainder(MovementPtr onward, LimbSet which, double length_s) : onward_(std::move(onward)) {
        limbs = which;
        duration = whole_milliseconds(length_s);
        for (const PhaseSpan& span : onward_->phases) {
            if (limbs.has(span.limb) && span.begin < duration) {
                phases.push_back(span);
            }
        }
        for (const MovementEvent& event : onward_->events) {
            if (limbs.has(event.limb) && event.after_start <= duration) {
                events.push_back(event);
            }
        }
    }
    void sample(double t_s, Controls& out) const override {
        Controls c = out;
        onward_->sample(t_s, c);
        copy_limbs(limbs, c, out);
    }
    Stride stride_at(double t_s) const override { return onward_->stride_at(t_s); }

 private:
    MovementPtr onward_;
};

}  // namespace

std::vector<MovementPtr> finish_stride(MotionContext& context, LimbSet limbs) {
    std::vector<MovementPtr> parts;
    const Stride stride = context.onward == nullptr ? Stride{} : context.onward->stride_at(0);
    const double length_s = stride.end_s + (stride.closes ? stride.step_s / 2 : 0);
    if (!stride.under_way || length_s > kLongestFinish_s) {
        return parts;
    }
    const SimTime given = context.duration;
    SimTime gone;
    const auto add = [&](MovementPtr part) {
        gone = gone + part->duration;
        advance_over(context, *part);
        parts.push_back(std::move(part));
    };
    context.duration = {-1};
    if (stride.end_s > 0) {
        add(std::make_shared<Remainder>(context.onward, limbs, stride.end_s));
    }
    if (stride.closes) {
        add(make_step(context, {.transfer = stride.transfer,
                                .kind = StepKind::kLastHalf,
                                .stroke_m = stride.stroke_m,
                                .duration_s = stride.step_s,
                                .duty_factor = stride.duty_factor,
                                .limbs = limbs}));
    }
    context.duration =
        given.ticks > 0 ? std::max(given - gone, whole_milliseconds(kLeast_s)) : given;
    return parts;
}

}  // namespace puppetri::motion
