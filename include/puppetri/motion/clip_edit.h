// SPDX-License-Identifier: MIT
// Editing clips: what people do at the tracks of a dope sheet. Every function takes a clip and
// gives a new one; what is not named by the selection stays as it is. Between keys that an edit
// does not touch the curve stays what it was: where a cut falls into a spline, the rates of the
// spline are written into the keys around it (of numbers and translations the curve is then the
// same exactly; of rotations at the new keys, with their rates, and between them to the order of
// the fourth power of the segment's length).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// The tracks that an edit is about, by their targets. Empty: all.
struct TrackSelection {
    std::vector<std::string> targets = {};
    bool has(std::string_view target) const;
};

// Puts keys at t on the selected tracks without changing any curve (see above).
Clip with_keys_at(const Clip& clip, double t_s, const TrackSelection& selection = {});

// The stretch [begin, end] as a clip of its own that starts at 0, with the marks that touch it.
// Needs   0 <= begin <= end <= duration.
Clip copied(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection = {});

// Without the stretch. All tracks: what follows moves up, and the clip gets shorter. With a
// selection: the selected tracks have no keys inside the stretch any more, and go straight over it.
Clip without(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection = {});

// cut: what copied gives, and what is left.
struct CutClip {
    Clip piece, rest;
};
CutClip cut(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection = {});

// Writes the piece's tracks over [t, t + piece's duration]: tracks that the clip lacks are added,
// the clip grows where the piece sticks out. pasted replaces; inserted makes room first: what came
// after t comes after the piece.
Clip pasted(const Clip& clip, double t_s, const Clip& piece);
Clip inserted(const Clip& clip, double t_s, const Clip& piece);

// One after the other; the second's root goes on from where the first's root has come.
Clip joined(const Clip& first, const Clip& second);

// As if seen in a mirror: left and right change their roles.
// Needs   the skeleton on which the clip plays, left and right alike at rest. Partners are found by
//         their names (mirrored_name); the sagittal plane is across the axis along which partners
//         lie apart.
// Gives   of degrees of freedom: the partner's; those of the middle called ".side" and ".twist"
//         change their sign. Marks change sides. Twice is the identity.
// Source  with S the reflection, R the rotations of the model at rest and K(j) = (S R(j) S)^-1
//         R(partner of j), the rotation L of joint j below p becomes K(p)^-1 (S L S) K(j) of its
//         partner: the mirror image of the pose, in the partner's own axes.
Clip mirrored(const Clip& clip, const figure::Skeleton& skeleton);

// "leftFoot" -> "rightFoot", "Left_Arm" -> "Right_Arm", "hand.L" -> "hand.R", "LThumb" -> "RThumb";
// other names as they are.
std::string mirrored_name(std::string_view name);

// Runs backwards.
Clip reversed(const Clip& clip);

// `factor` times as long: 2 is half as fast. Needs factor > 0.
Clip stretched(const Clip& clip, double factor);

// Time runs along a curve: what was at `from` is at `to`, straight in between, keys at the corners.
// Needs   at least two points, both times ascending, from 0 to the duration; to starting at 0.
struct WarpPoint {
    double from_s = 0, to_s = 0;
};
Clip warped(const Clip& clip, std::span<const WarpPoint> points);

// The same motion `rounds` times, the travel of the root going on. Needs rounds >= 1.
Clip repeated(const Clip& clip, int rounds);

// Makes the end meet the beginning, in value and rate: what is missing at the end is added over the
// last blend_s, growing as a cubic. The root keeps its travel. The result loops.
// Needs   0 < blend_s <= duration.
Clip closed(const Clip& clip, double blend_s);

// Keys every 1 / rate_hz, linear: of all tracks alike. Needs rate_hz > 0.
Clip resampled(const Clip& clip, double rate_hz);

// Leaves out keys where a straight line between those that stay is within the tolerances.
struct KeyTolerance {
    double angle_rad = 1e-4, length_m = 1e-4;
};
Clip reduced(const Clip& clip, const KeyTolerance& tolerance);

}  // namespace puppetri::motion
