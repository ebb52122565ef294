// SPDX-License-Identifier: MIT
// The way of one foot through a movement: it stands, rolls over heel and ball, and swings. Standing
// is exact by construction: while the foot's pitch is positive (toes up) it turns about its heel,
// while it is negative about the joint of the toes, which stay flat; both points are constants.
#pragma once
#include <array>
#include <vector>

#include "puppetri/math/quintic.h"
#include "puppetri/motion/context.h"

namespace puppetri::motion {

// A foot as yaw and pitch about its ankle; pitch is positive with the toes up.
struct FootState {
    Motion3 ankle;
    Motion1 yaw, pitch, toe_bend;
    bool planted = false;
};

// Reads the state out of controls: planted when a contact point is within 4 mm of the floor and
// slow (0.25 m/s). The height of the floor is not known to a movement: it is given by the lower
// foot.
FootState foot_state(const figure::Figure& figure, const MotionContext& context, Side side);

// Where a planted foot stands: the contact points' constants. The ankle of the same foot put down
// flat is ankle_flat.
struct Footprint {
    Vec3 heel, toes_joint;  // world, on the floor and just above it
    double yaw_rad = 0;
    Vec3 ankle_flat;
};
Footprint footprint_of(const figure::Figure& figure, Side side, const FootState& planted);
Footprint footprint_at(const figure::Figure& figure, Side side, Vec3 ankle_flat, double yaw_rad);

// The ankle of a foot on its print, for a given motion of its pitch: position, velocity and
// acceleration.
Motion3 ankle_on_print(const figure::Figure& figure, Side side, const Footprint& print,
                       Motion1 pitch);

// Brings a planted foot flat in about at_ease_s: pitch(t) = (R - t)^3 (c0 + c1 (R - t)) from
// position and velocity, so that it ends with velocity and acceleration 0. One that already rolls
// down takes R = 3.2 p / -v, nearly a pure cube, which never changes sign.
Curve1 roll_flat(Motion1 pitch, double at_ease_s);

class FootPath {
 public:
    // Stands on the print from begin_s on.
    void stand(double begin_s, const Footprint& print);
    // Is in the air from begin_s on.
    void swing(double begin_s, const Transform& world_from_path, Curve3 ankle_path, Curve1 yaw,
               Curve1 toe_bend);
    void set_pitch(Curve1 pitch) { pitch_ = std::move(pitch); }
    void set_body(const figure::Figure& figure, Side side);

    LegControl at(double t_s) const;
    bool stands_at(double t_s) const { return segment_at(t_s).stands; }
    const Curve1& pitch() const { return pitch_; }

 private:
    struct Segment {
        double begin_s = 0;
        bool stands = true;
        Footprint print;
        Transform world_from_path;
        Curve3 ankle_path;
        Curve1 yaw, toe_bend;
    };
    const Segment& segment_at(double t_s) const;
    std::vector<Segment> segments_;
    Curve1 pitch_;
    Vec3 heel_foot_, toes_foot_;
};

// How far below the ankle the lowest point of a foot in the air lies, for its pitch and the bend of
// its toes.
double drop_below_ankle(const figure::Figure& figure, Side side, double pitch_rad,
                        double toe_bend_rad);

// The height of the ankle of a foot in the air: the smoothest curve through the points, with more
// points where a part of the foot would go into the floor. For feet that begin anywhere; a few
// microseconds.
Curve1 clear_of_floor(const figure::Figure& figure, Side side, Key1 from,
                      std::vector<Waypoint1> inner, Key1 to, const Curve1& pitch,
                      const Curve1& toe_bend, double floor_y);

// A path that puts the foot down (or rolls it flat where it stands) and leaves it there. A foot in
// the air goes where it makes the figure stand: so that the pelvis, which needs a moment to stop,
// comes to rest between the feet.
struct Landing {
    FootPath path;
    Footprint print;
    double down_s = 0;  // when it stands; 0 when it already does
    double flat_s = 0;  // when it has rolled flat
};
Landing put_down(const figure::Figure& figure, const MotionContext& context, Side side);

// Lowers the pelvis where a standing leg would not reach its foot, and draws it near where even
// that does not help; smooth, and nothing where the legs reach easily.
class KeepReach {
 public:
    KeepReach() = default;
    // What is out of reach where a movement starts it lets go by and by. `stands`, by side, says
    // which feet are on the floor.
    KeepReach(const figure::Figure& figure, std::array<bool, 2> stands, const Controls& now);
    void apply(std::array<bool, 2> stands, double since_start_s, Controls& controls) const;

 private:
    // The pelvis's height above which the leg does not reach; draws the pelvis near first.
    double highest(std::size_t side, Controls& controls) const;

    const figure::Figure* figure_ = nullptr;
    std::array<double, 2> missing_m_{};
    std::array<double, 2> near_{0.70, 0.70};  // of the leg: across the floor nothing is done within
};

// The height of the floor: that of the lower foot while it stands; 0 while the figure flies.
double floor_under(const figure::Figure& figure, const MotionContext& context);

}  // namespace puppetri::motion
