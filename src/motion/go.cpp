// SPDX-License-Identifier: MIT
// Each turn shifts the point between the feet (turn.cpp), by a way that depends on its angle. So
// the place where the last turn begins and the direction of the walk are found together, by
// iteration: the shift is a few centimetres and changes slowly with the angle.
#include "puppetri/motion/go.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "compose.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/turn.h"
#include "times.h"

namespace puppetri::motion {
namespace {

constexpr double kNear_m = 0.01;             // a way that is not worth a step
constexpr double kStraight = radians(0.05);  // an angle that is not worth one
constexpr int kRounds = 12;
// Longer strokes, of the tall, take their time: in the usual one they would stop too sharply.
constexpr double kQuickStroke_m = 0.6;

Vec3 between_feet(const Controls& c) {
    const Vec3 middle = (c.legs[0].ankle_world + c.legs[1].ankle_world) * 0.5;
    return {middle.x, 0, middle.z};
}

double heading_of_feet(const figure::Figure& figure, const Controls& c) {
    return heading_of(pelvis_over_feet(figure, c).rotation_world);
}

class Way {
 public:
    Way(const MotionContext& context, const GoSpec& spec)
        : figure_(context.figure), spec_(spec), seed_(context.seed) {
        from_heading_ = heading_of_feet(figure_, context.now);
        from_ = between_feet(context.now);
        goal_ = {spec.to_world.x, 0, spec.to_world.z};
        const Vec3 straight = goal_ - from_;
        heading_ = length(straight) > 1e-6 ? heading_of(straight) : from_heading_;
        double length_m = 0;
        for (int round = 0; round < kRounds; ++round) {
            const Vec3 shifted = after_turn(context, heading_);
            const double last = spec.heading_rad.value_or(heading_);
            const Vec3 turns_at = goal_ - shift_of(heading_, last);
            const Vec3 way = turns_at - shifted;
            length_m = length(way);
            if (length_m < spec.before_m + kNear_m) {
                length_m = 0;  // it is there: it only turns
                break;
            }
            heading_ = heading_of(way);
            length_m -= spec.before_m;
        }
        if (length_m == 0) {
            heading_ = spec.heading_rad.value_or(heading_of(straight));
        }
        const double size = figure_.height_m / 1.75;
        const double most = std::fmin(spec.most_stroke_m * size, longest_stroke_m(figure_, 0.62));
        length_m = std::fmin(length_m, kFarthestWay_m);
        steps_ = length_m > 0 ? static_cast<int>(std::ceil(length_m / most - 1e-6)) : 0;
        stroke_m_ = steps_ > 0 ? length_m / steps_ : 0;
        step_s_ *= std::fmax(1, stroke_m_ / kQuickStroke_m);
    }

    // The parts with the durations that they would have alone; `spec.duration_s` of none.
    MovementPtr make(const MotionContext& context) const {
        const double last = spec_.heading_rad.value_or(heading_);
        const double first_s = turn_s(turn_between(from_heading_, heading_)),
                     last_s = steps_ > 0 ? turn_s(turn_between(heading_, last)) : 0;
        const double walk_s = steps_ * step_s_;
        const bool given = context.duration.ticks > 0;
        const double own_s = first_s + walk_s + last_s;
        const double share = given && own_s > 0 ? context.duration.seconds() / own_s : 1;
        std::vector<MovementPtr> parts;
        MotionContext now = context;
        SimTime gone;
        const auto add = [&](double own_part_s, auto&& make_part, bool is_last) {
            now.duration = {-1};
            if (given) {
                now.duration =
                    is_last ? context.duration - gone : whole_milliseconds(share * own_part_s);
            }
            parts.push_back(make_part());
            gone = gone + parts.back()->duration;
            advance_over(now, *parts.back());
        };
        if (first_s > 0) {
            add(
                first_s, [&] { return turn(now, heading_, first_s); }, steps_ == 0);
        }
        if (steps_ > 0) {
            add(
                walk_s,
                [&] {
                    return make_walk(
                        now, {.stroke_m = stroke_m_, .duration_s = step_s_, .limbs = spec_.limbs},
                        steps_);
                },
                last_s == 0);
        }
        if (last_s > 0) {
            add(
                last_s, [&] { return turn(now, last, last_s); }, true);
        }
        if (parts.empty()) {
            return make_turn(
                context,
                {.heading_rad = heading_, .duration_s = turn_duration_s(0), .limbs = spec_.limbs});
        }
        return in_turn(std::move(parts));
    }

 private:
    static double turn_s(double angle) {
        return std::fabs(angle) < kStraight
                   ? 0
                   : std::fmax(turn_duration_s(std::fabs(angle)), std::fabs(angle) < 0.1 ? 0.5 : 0);
    }
    MovementPtr turn(const MotionContext& context, double heading, double duration_s) const {
        return make_turn(context, {.heading_rad = heading,
                                   .duration_s = duration_s,
                                   .limbs = spec_.limbs,
                                   .no_step_rad = kStraight / 2});
    }
    // Where a figure in that state is when it has turned.
    Vec3 after_turn(const MotionContext& context, double heading) const {
        const double s = turn_s(turn_between(from_heading_, heading));
        if (s == 0) {
            return from_;
        }
        MotionContext free = context;
        free.duration = {-1};
        const MovementPtr made = turn(free, heading, s);
        Controls end = context.now;
        made->sample(made->duration.seconds(), end);
        return between_feet(end);
    }
    // How far a turn of a standing figure shifts it.
    Vec3 shift_of(double from, double to) const {
        const double s = turn_s(turn_between(from, to));
        if (s == 0) {
            return {};
        }
        const MotionContext stands{
            figure_, standing(figure_, {}, from), {}, SimTime{0}, SimTime{-1}, seed_};
        const MovementPtr made = turn(stands, to, s);
        Controls end = stands.now;
        made->sample(made->duration.seconds(), end);
        return between_feet(end);
    }

    const figure::Figure& figure_;
    const GoSpec& spec_;
    std::uint64_t seed_;
    Vec3 from_, goal_;
    double from_heading_ = 0, heading_ = 0;
    int steps_ = 0;
    double stroke_m_ = 0, step_s_ = StepSpec{}.duration_s;
};

}  // namespace

MovementPtr make_walk(const MotionContext& context, StepSpec spec, int steps) {
    const SimTime given = context.duration;
    if (given.ticks > 0) {
        spec.duration_s = given.seconds() / steps;
    }
    std::vector<MovementPtr> parts;
    MotionContext now = context;
    SimTime gone;
    for (int i = 0; i <= steps; ++i) {
        spec.kind = i == 0       ? StepKind::kFirstHalf
                    : i == steps ? StepKind::kLastHalf
                                 : StepKind::kWhole;
        now.duration = {-1};
        if (given.ticks > 0) {
            const double share = i == steps ? 1.0 : (i + 0.5) / steps;
            const SimTime end{static_cast<std::int64_t>(share * static_cast<double>(given.ticks))};
            now.duration = (i == steps ? given : end) - gone;
            gone = gone + now.duration;
        }
        parts.push_back(make_step(now, spec));
        advance_over(now, *parts.back());
        spec.transfer = other(spec.transfer);
    }
    return in_turn(std::move(parts));
}

MovementPtr make_go(const MotionContext& context, const GoSpec& spec) {
    return Way(context, spec).make(context);
}

}  // namespace puppetri::motion
