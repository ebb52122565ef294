// SPDX-License-Identifier: MIT
#include "puppetri/motion/join.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

using figure::Figure;
using figure::JointIndex;

constexpr double kBeside_s = 1e-5;   // between samples on one side
constexpr double kReach_s = 0.06;    // what counts as either side
constexpr double kCalm_rad_s2 = 20;  // below this nothing is a jerk

// Of joints that differ by rounding alone the first one is named.
void take(JoinValue& worst, double value, std::uint32_t joint) {
    if (value > worst.value * (1 + 1e-6)) {
        worst.joint = {joint};
    }
    worst.value = std::max(worst.value, value);
}

class Ruler {
 public:
    explicit Ruler(const JoinInput& input)
        : in_(input),
          f_(input.figure),
          joints_(f_.skeleton.joints.size()),
          dt_(1 / input.rate_hz) {}

    JoinMeasures run(const JoinLimits* enough) {
        if (in_.at_s - 4 * kBeside_s < in_.begin_s || in_.at_s + 4 * kBeside_s > in_.end_s) {
            return {};
        }
        m_.measured = true;
        limits_from_both_sides();
        accelerations(enough);
        return m_;
    }

 private:
    Quat local(const std::vector<Transform>& world, std::uint32_t j) const {
        const JointIndex parent = f_.skeleton.joints[j].parent;
        return parent.valid() ? conjugate(world[parent.value].rotation) * world[j].rotation
                              : world[j].rotation;
    }

    // Samples t - 3.5 h .. t - h / 2 and t + h / 2 .. t + 3.5 h: off the instant itself.
    void limits_from_both_sides() {
        constexpr double h = kBeside_s;
        std::vector<Transform> grid[4];
        for (int k = 0; k < 4; ++k) {
            grid[k].resize(joints_);
            in_.sample(in_.context, in_.at_s + (k - 2 + 0.5) * h, grid[k]);
        }
        for (std::uint32_t j = 0; j < joints_; ++j) {
            const auto p = [&](int k) { return grid[k][j].translation; };
            const Vec3 left_v = (p(1) - p(0)) * (1 / h), right_v = (p(3) - p(2)) * (1 / h);
            const Vec3 left = p(1) + left_v * (h / 2), right = p(2) - right_v * (h / 2);
            take(m_.position_m, length(right - left), j);
            const double jump = length(right_v - left_v);
            if (j == f_.hips.value) {
                take(m_.pelvis_m_s, jump, j);
            }
            for (int side = 0; side < 2; ++side) {
                if (j == f_.arms[side].hand.value) {
                    take(m_.hand_m_s, jump, j);
                }
                if (j == f_.legs[side].ankle.value) {
                    take(m_.foot_m_s, jump, j);
                }
            }
        }
    }

    const std::vector<Transform>& on_grid(int i) {
        std::vector<Transform>& world = grid_[i - first_];
        if (world.empty()) {
            world.resize(joints_);
            in_.sample(in_.context, in_.begin_s + i * dt_, world);
        }
        return world;
    }
    double acceleration(int i, std::uint32_t j) {
        const Quat a = local(on_grid(i - 1), j), b = local(on_grid(i), j),
                   c = local(on_grid(i + 1), j);
        return length(angular_velocity(b, c, dt_) - angular_velocity(a, b, dt_)) / dt_;
    }

    void accelerations(const JoinLimits* enough) {
        const int reach = static_cast<int>(kReach_s / dt_);
        const int k = static_cast<int>(std::floor((in_.at_s - in_.begin_s) / dt_ + 1e-6));
        const int last = static_cast<int>(std::floor((in_.end_s - in_.begin_s) / dt_ + 1e-6)) - 1;
        const int from = std::max(1, k - reach), to = std::min(last, k + 1 + reach);
        if (from > to) {
            return;
        }
        first_ = from - 1;
        grid_.resize(static_cast<std::size_t>(to - from) + 3);
        struct Joint {
            std::uint32_t joint;
            double across, sides;
        };
        std::vector<Joint> open;
        for (std::uint32_t j = 0; j < joints_; ++j) {
            const JointGroup group = group_of(f_, {j});
            if (group == JointGroup::kNone || group == JointGroup::kFingers) {
                continue;
            }
            double across = 0;
            for (int i = std::max(from, k); i <= std::min(to, k + 1); ++i) {
                across = std::max(across, acceleration(i, j));
            }
            open.push_back({j, across, kCalm_rad_s2});
        }
        // Outward from the join, as far as it has to be known.
        for (int d = 1; d <= reach; ++d) {
            if (enough != nullptr) {
                std::erase_if(open, [&](const Joint& o) {
                    const bool good = o.across <= enough->acceleration_ratio * o.sides;
                    if (good) {
                        take(m_.acceleration_ratio, o.across / o.sides, o.joint);
                    }
                    return good;
                });
            }
            if (open.empty()) {
                break;
            }
            for (const int i : {k - d, k + 1 + d}) {
                if (i < from || i > to) {
                    continue;
                }
                for (Joint& o : open) {
                    o.sides = std::max(o.sides, acceleration(i, o.joint));
                }
            }
        }
        for (const Joint& o : open) {
            take(m_.acceleration_ratio, o.across / o.sides, o.joint);
        }
    }

    const JoinInput& in_;
    const Figure& f_;
    const std::size_t joints_;
    const double dt_;
    int first_ = 0;
    std::vector<std::vector<Transform>> grid_;  // samples as they are needed
    JoinMeasures m_;
};

}  // namespace

JointGroup group_of(const Figure& f, JointIndex joint) {
    for (const figure::Leg& leg : f.legs) {
        if (joint == leg.hip) {
            return JointGroup::kHip;
        }
        if (joint == leg.knee) {
            return JointGroup::kKnee;
        }
        if (joint == leg.ankle) {
            return JointGroup::kAnkle;
        }
        if (joint == leg.toes) {
            return JointGroup::kToes;
        }
    }
    if (joint == f.spine || joint == f.chest || joint == f.upper_chest) {
        return JointGroup::kSpine;
    }
    if (joint == f.neck || joint == f.head) {
        return JointGroup::kNeck;
    }
    for (const figure::Arm& arm : f.arms) {
        if (joint == arm.clavicle || joint == arm.shoulder || joint == arm.elbow ||
            joint == arm.hand || joint == arm.shoulder_twist || joint == arm.elbow_twist) {
            return JointGroup::kArm;
        }
        if (std::find(arm.fingers.begin(), arm.fingers.end(), joint) != arm.fingers.end()) {
            return JointGroup::kFingers;
        }
    }
    return JointGroup::kNone;
}

JoinMeasures measure_join(const JoinInput& input, const JoinLimits* enough) {
    return Ruler(input).run(enough);
}

JoinFault fault_of(const JoinMeasures& m, const JoinLimits& limits) {
    const JoinFault all[] = {
        {"position", "m", m.position_m.value, limits.position_m, m.position_m.joint},
        {"velocity", "m/s", m.pelvis_m_s.value, limits.pelvis_m_s, m.pelvis_m_s.joint},
        {"velocity", "m/s", m.hand_m_s.value, limits.hand_m_s, m.hand_m_s.joint},
        {"velocity", "m/s", m.foot_m_s.value, limits.foot_m_s, m.foot_m_s.joint},
        {"angular acceleration", "", m.acceleration_ratio.value, limits.acceleration_ratio,
         m.acceleration_ratio.joint}};
    for (const JoinFault& f : all) {
        if (f.value > f.limit) {
            return f;
        }
    }
    return {};
}

}  // namespace puppetri::motion
