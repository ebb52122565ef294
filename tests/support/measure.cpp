// SPDX-License-Identifier: MIT
// Samples on an even grid; velocities and accelerations are differences of neighbours.
#include "support/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/join.h"

namespace puppetri::test {
namespace {

using figure::Figure;
using figure::JointIndex;

double degrees(double rad) { return rad * 180 / kPi; }

void take(Worst& worst, double value, double at_s, const std::string& where) {
    if (value > worst.value) {
        worst = {value, at_s, where};
    }
}

struct Contact {
    Vec3 heel, ball, tip;
    double lowest() const { return std::min({heel.y, ball.y, tip.y}); }
};

class Instrument {
 public:
    explicit Instrument(const MeasureInput& input) : in_(input), f_(input.figure) {
        joint_count_ = f_.skeleton.joints.size();
        dt_ = 1 / in_.rate_hz;
        count_ = static_cast<int>(std::floor((in_.end_s - in_.begin_s) * in_.rate_hz + 1e-6)) + 1;
        world_.resize(joint_count_ * count_);
        for (int i = 0; i < count_; ++i) {
            in_.sample(time(i), {&world_[i * joint_count_], joint_count_});
        }
    }

    Measures run() {
        feet();
        knees();
        pelvis();
        joints();
        joins();
        return std::move(m_);
    }

 private:
    double time(int i) const { return in_.begin_s + i * dt_; }
    const Transform& at(int i, JointIndex j) const { return world_[i * joint_count_ + j.value]; }
    const std::string& name(JointIndex j) const { return f_.skeleton.joints[j.value].name; }
    Quat local(int i, std::uint32_t j) const {
        const JointIndex parent = f_.skeleton.joints[j].parent;
        const Quat q = at(i, {j}).rotation;
        return parent.valid() ? conjugate(at(i, parent).rotation) * q : q;
    }
    Contact contact(int i, int side) const {
        const figure::Leg& leg = f_.legs[side];
        const Vec3 floor{0, in_.floor_y, 0};
        return {at(i, leg.ankle) * leg.heel_foot - floor, at(i, leg.toes) * leg.ball_toes - floor,
                at(i, leg.toes) * leg.toe_tip_toes - floor};
    }
    double knee_deg(int i, int side) const {
        return degrees(angle_of(local(i, f_.legs[side].knee.value)));
    }
    bool planted(int i, int side) const {
        return std::any_of(in_.planted.begin(), in_.planted.end(), [&](const Planted& p) {
            return p.side == side && time(i) >= p.begin_s - 1e-9 && time(i) <= p.end_s + 1e-9;
        });
    }

    void feet() {
        for (int side = 0; side < 2; ++side) {
            const std::string foot = name(f_.legs[side].ankle);
            for (const Planted& p : in_.planted) {
                if (p.side == side) {
                    stand(p, foot);
                }
            }
            for (int i = 0; i < count_; ++i) {
                take(m_.swing_sink_mm, -1000 * contact(i, side).lowest(), time(i), foot);
            }
            swings(side);
            detect(side);
        }
    }

    void stand(const Planted& p, const std::string& foot) {
        bool heel_was = false, ball_was = false;
        Vec3 heel_home, ball_home;
        for (int i = 0; i < count_; ++i) {
            if (time(i) < p.begin_s - 1e-9 || time(i) > p.end_s + 1e-9) {
                continue;
            }
            const Contact c = contact(i, p.side);
            const double lowest = std::min(c.heel.y, c.ball.y);
            take(m_.hover_mm, 1000 * lowest, time(i), foot);
            take(m_.sink_mm, -1000 * c.lowest(), time(i), foot);
            const bool heel = c.heel.y < lowest + 5e-4, ball = c.ball.y < lowest + 5e-4;
            slip(heel, heel_was, c.heel, heel_home, i, foot + " heel");
            slip(ball, ball_was, c.ball, ball_home, i, foot + " ball");
        }
    }
    void slip(bool on, bool& was, Vec3 point, Vec3& home, int i, const std::string& where) {
        if (on && !was) {
            home = point;
        }
        if (on) {
            take(m_.slip_mm, 1000 * std::hypot(point.x - home.x, point.z - home.z), time(i), where);
        }
        was = on;
    }

    void swings(int side) {
        if (in_.planted.empty()) {
            return;
        }
        for (int i = 1; i < count_; ++i) {
            if (planted(i, side) || !planted(i - 1, side)) {
                continue;
            }
            int end = i;
            while (end < count_ && !planted(end, side)) {
                ++end;
            }
            if (end == count_) {
                return;
            }
            const figure::Leg &leg = f_.legs[side], &stance = f_.legs[1 - side];
            Step step{side, time(i - 1), time(end), 0, 0, 0, 0, 0};
            const Vec3 from = at(i - 1, leg.ankle).translation, to = at(end, leg.ankle).translation;
            step.length_m = std::hypot(to.x - from.x, to.z - from.z);
            int middle = (i + end) / 2;
            for (int k = i; k < end; ++k) {
                step.knee_deg = std::max(step.knee_deg, knee_deg(k, side));
                step.highest_mm = std::max(step.highest_mm, 1000 * contact(k, side).lowest());
                const double before =
                    dot(at(k - 1, leg.ankle).translation - at(k - 1, stance.ankle).translation,
                        to - from);
                const double now =
                    dot(at(k, leg.ankle).translation - at(k, stance.ankle).translation, to - from);
                if (before < 0 && now >= 0 && k > i + 1 && k < end - 2) {
                    middle = k;
                }
            }
            step.clearance_mm = 1000 * contact(middle, side).lowest();
            m_.steps.push_back(step);
            i = end;
        }
    }

    // At rest: the sole's lowest point within 2 mm of the floor and slower than 0.15 m/s.
    void detect(int side) {
        bool was = false;
        for (int i = 0; i + 1 < count_; ++i) {
            const Contact a = contact(i, side), b = contact(i + 1, side);
            const bool heel = a.heel.y < a.ball.y;
            const double speed = length(heel ? b.heel - a.heel : b.ball - a.ball) / dt_;
            const bool on = std::min(a.heel.y, a.ball.y) < 2e-3 && speed < 0.15;
            if (on && !was) {
                m_.detected.push_back({side, time(i), time(i)});
            }
            if (on) {
                m_.detected.back().end_s = time(i);
            }
            was = on;
        }
    }

    void knees() {
        for (int side = 0; side < 2; ++side) {
            for (int i = 0; i < count_; ++i) {
                if (!planted(i, side)) {
                    continue;
                }
                const std::string& knee = name(f_.legs[side].knee);
                take(m_.knee_planted_deg, knee_deg(i, side), time(i), knee);
                // Push-off: both stand, and this foot is the one that stood first, i.e. the other
                // landed later.
                bool push_off = false;
                if (planted(i, 1 - side)) {
                    double mine = -1e9, others = -1e9;
                    for (const Planted& p : in_.planted) {
                        if (time(i) >= p.begin_s - 1e-9 && time(i) <= p.end_s + 1e-9) {
                            (p.side == side ? mine : others) = p.begin_s;
                        }
                    }
                    push_off = others > mine;
                }
                if (!push_off) {
                    take(m_.knee_stance_deg, knee_deg(i, side), time(i), knee);
                }
            }
        }
    }

    void pelvis() {
        const Vec3 first = at(0, f_.hips).translation, last = at(count_ - 1, f_.hips).translation;
        const Vec3 way = normalized({last.x - first.x, 0, last.z - first.z}, {0, 0, 1});
        const Vec3 across{way.z, 0, -way.x};
        double lo = 1e9, hi = -1e9;
        for (int i = 0; i < count_; ++i) {
            const double w = dot(at(i, f_.hips).translation - first, across);
            lo = std::min(lo, w);
            hi = std::max(hi, w);
            if (i > 0 && i + 1 < count_) {
                const Vec3 a = (at(i + 1, f_.hips).translation - at(i, f_.hips).translation * 2 +
                                at(i - 1, f_.hips).translation) *
                               (1 / (dt_ * dt_));
                take(m_.pelvis_acceleration, length(a), time(i), "hips");
                if (time(i) >= in_.steady_begin_s && time(i) <= in_.steady_end_s) {
                    take(m_.pelvis_steady, length(a), time(i), "hips");
                }
            }
        }
        m_.sway_mm = 1000 * (hi - lo);
        std::sort(m_.steps.begin(), m_.steps.end(),
                  [](const Step& a, const Step& b) { return a.begin_s < b.begin_s; });
        for (std::size_t k = 0; k + 1 < m_.steps.size(); ++k) {
            const double from = (m_.steps[k].begin_s + m_.steps[k].end_s) / 2;
            const double to = (m_.steps[k + 1].begin_s + m_.steps[k + 1].end_s) / 2;
            double low = 1e9, high = -1e9;
            for (int i = 0; i < count_; ++i) {
                if (time(i) >= from && time(i) <= to) {
                    low = std::min(low, at(i, f_.hips).translation.y);
                    high = std::max(high, at(i, f_.hips).translation.y);
                }
            }
            m_.steps[k].pelvis_rise_mm = 1000 * (high - low);
            m_.rise_mm = std::max(m_.rise_mm, m_.steps[k].pelvis_rise_mm);
        }
    }

    JointMeasures* group(std::uint32_t j) {
        switch (motion::group_of(f_, {j})) {
            case motion::JointGroup::kNone:
                return nullptr;
            case motion::JointGroup::kKnee:
                return &m_.knee;
            case motion::JointGroup::kHip:
                return &m_.hip;
            case motion::JointGroup::kAnkle:
                return &m_.ankle;
            case motion::JointGroup::kToes:
                return &m_.toes;
            case motion::JointGroup::kSpine:
                return &m_.spine;
            case motion::JointGroup::kNeck:
                return &m_.neck;
            case motion::JointGroup::kArm:
                return &m_.arm;
            case motion::JointGroup::kFingers:
                return &m_.fingers;
        }
        return nullptr;
    }

    void joints() {
        for (std::uint32_t j = 0; j < joint_count_; ++j) {
            const std::string& joint = name({j});
            JointMeasures* to = group(j);
            Vec3 before;
            for (int i = 0; i < count_; ++i) {
                take(m_.limit_excess_deg,
                     degrees(figure::limit_excess_rad(f_.limits[j], local(i, j))), time(i), joint);
                if (to == nullptr || i == 0) {
                    continue;
                }
                const Vec3 w = angular_velocity(local(i - 1, j), local(i, j), dt_);
                take(to->speed_rad_s, length(w), time(i) - dt_ / 2, joint);
                if (i > 1) {
                    take(to->acceleration_rad_s2, length(w - before) / dt_, time(i - 1), joint);
                }
                before = w;
            }
        }
    }

    void joins() {
        const auto sample = [](void* context, double t_s, std::span<Transform> world) {
            static_cast<const MeasureInput*>(context)->sample(t_s, world);
        };
        for (const double t : in_.joins_s) {
            const motion::JoinMeasures join =
                motion::measure_join({.figure = f_,
                                      .sample = sample,
                                      .context = const_cast<MeasureInput*>(&in_),
                                      .at_s = t,
                                      .begin_s = in_.begin_s,
                                      .end_s = in_.end_s,
                                      .rate_hz = in_.rate_hz});
            const auto worst = [&](Worst& to, const motion::JoinValue& from) {
                if (from.value > 0) {
                    take(to, from.value, t, name(from.joint));
                }
            };
            worst(m_.join_position_m, join.position_m);
            worst(m_.join_pelvis_m_s, join.pelvis_m_s);
            worst(m_.join_hand_m_s, join.hand_m_s);
            worst(m_.join_foot_m_s, join.foot_m_s);
            worst(m_.join_acceleration_ratio, join.acceleration_ratio);
        }
    }

    const MeasureInput& in_;
    const Figure& f_;
    std::size_t joint_count_ = 0;
    double dt_ = 0;
    int count_ = 0;
    std::vector<Transform> world_;
    Measures m_;
};

}  // namespace

Measures measure(const MeasureInput& input) { return Instrument(input).run(); }

std::string report(const Measures& m) {
    std::string text;
    char line[200];
    auto add = [&](const char* what, const Worst& w, const char* unit) {
        std::snprintf(line, sizeof line, "%-22s %10.4g %-8s at %8.4f s  %s\n", what, w.value, unit,
                      w.at_s, w.where.c_str());
        text += line;
    };
    auto pair = [&](const char* what, const JointMeasures& w) {
        add((std::string(what) + " speed").c_str(), w.speed_rad_s, "rad/s");
        add((std::string(what) + " accel").c_str(), w.acceleration_rad_s2, "rad/s2");
    };
    add("slip", m.slip_mm, "mm");
    add("sink", m.sink_mm, "mm");
    add("hover", m.hover_mm, "mm");
    add("swing sink", m.swing_sink_mm, "mm");
    add("knee stance", m.knee_stance_deg, "deg");
    add("knee planted", m.knee_planted_deg, "deg");
    for (const Step& s : m.steps) {
        std::snprintf(line, sizeof line,
                      "  swing %s %.4f .. %.4f s  knee %.1f deg  clearance %.1f mm (highest %.1f)  "
                      "length %.3f m  rise %.1f mm\n",
                      s.side == 0 ? "left " : "right", s.begin_s, s.end_s, s.knee_deg,
                      s.clearance_mm, s.highest_mm, s.length_m, s.pelvis_rise_mm);
        text += line;
    }
    std::snprintf(line, sizeof line, "rise %.1f mm, sway %.1f mm\n", m.rise_mm, m.sway_mm);
    text += line;
    add("pelvis acceleration", m.pelvis_acceleration, "m/s2");
    add("pelvis steady", m.pelvis_steady, "m/s2");
    pair("knee", m.knee);
    pair("hip", m.hip);
    pair("ankle", m.ankle);
    pair("toes", m.toes);
    pair("spine", m.spine);
    pair("neck", m.neck);
    pair("arm", m.arm);
    pair("fingers", m.fingers);
    add("limit excess", m.limit_excess_deg, "deg");
    add("join position", m.join_position_m, "m");
    add("join pelvis", m.join_pelvis_m_s, "m/s");
    add("join hand", m.join_hand_m_s, "m/s");
    add("join foot", m.join_foot_m_s, "m/s");
    add("join accel ratio", m.join_acceleration_ratio, "");
    return text;
}

}  // namespace puppetri::test
