// SPDX-License-Identifier: MIT
#include "compose.h"

#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/motion/context.h"

namespace puppetri::motion {
namespace {

void sort_phases(std::vector<PhaseSpan>& phases) {
    std::stable_sort(phases.begin(), phases.end(), [](const PhaseSpan& a, const PhaseSpan& b) {
        return a.limb != b.limb ? a.limb < b.limb : a.begin < b.begin;
    });
}

class SideBySide final : public Movement {
 public:
    SideBySide(MovementPtr main, MovementPtr arms)
        : main_(std::move(main)), arms_(std::move(arms)) {
        limbs = both(main_->limbs, arms_->limbs);
        overlays = both(without(main_->overlays, arms_->limbs), arms_->overlays);
        duration = main_->duration;
        phases = main_->phases;
        phases.insert(phases.end(), arms_->phases.begin(), arms_->phases.end());
        sort_phases(phases);
        events = main_->events;
        for (const MovementEvent& e : arms_->events) {
            if (e.after_start <= duration) {
                events.push_back(e);
            }
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
    }
    void sample(double t_s, Controls& out) const override {
        main_->sample(t_s, out);
        arms_->sample(t_s, out);
    }
    Stride stride_at(double t_s) const override { return main_->stride_at(t_s); }
    void overlay(double t_s, LimbSet which, figure::Pose& pose) const override {
        main_->overlay(t_s, without(shared(which, main_->overlays), arms_->limbs), pose);
        arms_->overlay(t_s, shared(which, arms_->overlays), pose);
    }

 private:
    MovementPtr main_, arms_;
};

class InTurn final : public Movement {
 public:
    explicit InTurn(std::vector<MovementPtr> parts) : parts_(std::move(parts)) {
        PUP_REQUIRE(!parts_.empty());
        for (const MovementPtr& part : parts_) {
            starts_s_.push_back(duration.seconds());
            limbs = both(limbs, part->limbs);
            overlays = both(overlays, part->overlays);
            for (PhaseSpan span : part->phases) {
                if (part != parts_.back()) {  // the next part says how it goes on
                    span.end = std::min(span.end, part->duration);
                }
                if (span.begin < span.end) {
                    span.begin = span.begin + duration;
                    span.end = span.end + duration;
                    phases.push_back(span);
                }
            }
            for (MovementEvent event : part->events) {
                event.after_start = event.after_start + duration;
                events.push_back(event);
            }
            duration = duration + part->duration;
        }
        sort_phases(phases);
    }
    void sample(double t_s, Controls& out) const override {
        const std::size_t i = part_at(t_s);
        parts_[i]->sample(t_s - starts_s_[i], out);
    }
    Stride stride_at(double t_s) const override {
        const std::size_t i = part_at(t_s);
        Stride stride = parts_[i]->stride_at(t_s - starts_s_[i]);
        stride.end_s += starts_s_[i];
        return stride;
    }
    void overlay(double t_s, LimbSet which, figure::Pose& pose) const override {
        const std::size_t i = part_at(t_s);
        parts_[i]->overlay(t_s - starts_s_[i], shared(which, parts_[i]->overlays), pose);
    }

 private:
    std::size_t part_at(double t_s) const {
        const auto after = std::upper_bound(starts_s_.begin() + 1, starts_s_.end(), t_s);
        return static_cast<std::size_t>(after - starts_s_.begin()) - 1;
    }
    std::vector<MovementPtr> parts_;
    std::vector<double> starts_s_;
};

}  // namespace

void advance_over(MotionContext& context, const Movement& movement) {
    constexpr double kMoment_s = 1e-4;
    const double end_s = movement.duration.seconds();
    Controls earlier = context.now;
    movement.sample(std::fmax(end_s - kMoment_s, 0), earlier);
    movement.sample(end_s, context.now);
    context.rate = rate_between(earlier, context.now, kMoment_s);
    context.at = context.at + movement.duration;
    context.onward = nullptr;
}

MovementPtr side_by_side(MovementPtr main, MovementPtr arms) {
    return std::make_shared<SideBySide>(std::move(main), std::move(arms));
}
MovementPtr in_turn(std::vector<MovementPtr> parts) {
    return std::make_shared<InTurn>(std::move(parts));
}

}  // namespace puppetri::motion
