// SPDX-License-Identifier: MIT
#include "living.h"

#include "puppetri/base/elementary.h"
#include "puppetri/base/random.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {

Living::Living(const figure::Figure& figure, std::uint64_t seed, double liveliness)
    : height_m_(figure.height_m), liveliness_(liveliness) {
    RandomStream random{stream_key(seed, "", "living")};
    for (double& phase : phase_) {
        phase = 2 * kPi * random.uniform();
    }
}

// In [-1, 1]; two sines whose periods have the golden ratio, so that it never repeats in sight.
double Living::wave(int channel, double period_s, double t_s) const {
    const double w = 2 * kPi / period_s;
    return 0.66 * puppetri::sin(w * t_s + phase_[channel]) +
           0.34 * puppetri::sin(1.618 * w * t_s + phase_[channel + 1]);
}

void Living::add(double t_s, double part, Controls& c) const {
    const double k = liveliness_ * part, h = height_m_;
    const double weight = k * wave(0, 7.5, t_s), lean = k * wave(2, 5.1, t_s),
                 glance = k * wave(4, 6.3, t_s);
    const Quat home = c.pelvis.rotation_world;
    // A little lower: room for the weight's way from leg to leg.
    c.pelvis.position_world =
        c.pelvis.position_world + rotate(home, Vec3{0.009 * weight, 0, 0.003 * lean} * h);
    c.pelvis.position_world.y -= 0.002 * h * part;
    // The hip of the free leg drops; the trunk stays upright over it.
    const double list = radians(1.2) * weight;
    c.pelvis.rotation_world = home * about_y(radians(1.5) * lean) * about_z(list);
    c.body.pelvis_from_chest = about_z(-1.5 * list) * about_y(radians(1.2) * glance) *
                               about_x(radians(1.5) * part + radians(0.8) * lean) *
                               c.body.pelvis_from_chest;
    c.body.chest_from_head = about_y(radians(7) * glance) *
                             about_x(radians(-1.5) * part + radians(2.5) * k * wave(6, 4.7, t_s)) *
                             about_z(0.5 * list) * c.body.chest_from_head;
    c.body.breath += k * (0.5 - 0.5 * puppetri::cos(2 * kPi * t_s / 3.9 + phase_[8]));
    for (int i = 0; i < 2; ++i) {
        const double s = i == 0 ? 1 : -1;
        Vec3& hand = c.arms[i].chest_from_hand.translation;
        hand = hand + Vec3{-0.003 * weight, 0, 0.004 * lean - s * 0.002 * glance} * h;
    }
}

void Living::add_seated(double t_s, Controls& c) const {
    const double k = liveliness_;
    const double weight = k * wave(0, 7.5, t_s), lean = k * wave(2, 5.1, t_s),
                 glance = k * wave(4, 6.3, t_s);
    c.body.pelvis_from_chest = about_z(radians(0.7) * weight) * about_y(radians(1.2) * glance) *
                               about_x(radians(0.8) * lean) * c.body.pelvis_from_chest;
    c.body.chest_from_head = about_y(radians(7) * glance) *
                             about_x(radians(2.5) * k * wave(6, 4.7, t_s)) *
                             about_z(radians(-0.4) * weight) * c.body.chest_from_head;
    c.body.breath += k * (0.5 - 0.5 * puppetri::cos(2 * kPi * t_s / 3.9 + phase_[8]));
}

double smooth_rise(double t_s, double over_s) {
    const double r = clamp(t_s / over_s, 0, 1);
    return r * r * r * (10 - r * (15 - 6 * r));
}

}  // namespace puppetri::motion
