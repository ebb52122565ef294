// SPDX-License-Identifier: MIT
// A clip: recorded or hand-made motion in the form that people edit. Named tracks over any subset
// of what a figure can move (rotations and translations of joints, single degrees of freedom), each
// with its own keys, each key with its own way to the next. A clip knows no skeleton: it plays on
// every figure that has joints or degrees of freedom of these names. Editing: clip_edit.h; layers:
// clip_layers.h; the frozen form for crowds: packed_clip.h; files: io/clip_file.h.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/dof.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/math/spline.h"

namespace puppetri::motion {

// How the value goes from a key to the next one.
enum class Interpolation : std::uint8_t {
    kStep,             // stays until the next key
    kLinear,           // straight; rotations along the shorter arc (slerp)
    kCatmullRom,       // smooth through all keys
    kCardinal,         // the same with the tension of the keys
    kKochanekBartels,  // with tension, continuity and bias of the keys
    kHermite,          // with the rates given at the keys
    kBezier,           // straight, in the time of an easing curve
};
// "step", "linear", "catmull-rom", "cardinal", "kochanek-bartels", "hermite", "bezier".
std::string_view name_of(Interpolation interpolation);

// Rates are per second; of rotations the angular velocity in the joint's own space.
template <class V, class R>
struct ClipKey {
    using Value = V;
    using Rate = R;

    double t_s = 0;
    Value value{};
    Interpolation interpolation = Interpolation::kLinear;  // from here to the next key
    KeyShape shape;                                        // of the splines, on both sides
    Rate in{}, out{};                                      // kHermite: arriving here, leaving
    Easing easing;                                         // kBezier: to the next key
};
using RotationKey = ClipKey<Quat, Vec3>;
using VectorKey = ClipKey<Vec3, Vec3>;
using NumberKey = ClipKey<double, double>;

// Keys in strictly ascending order of time within [0, duration]. Before the first and after the
// last key the value stands still.
template <class Key>
struct ClipTrack {
    std::string target;  // "leftUpperArm"; of a degree of freedom "left_elbow.flex"
    std::vector<Key> keys;
};
using RotationTrack = ClipTrack<RotationKey>;
using VectorTrack = ClipTrack<VectorKey>;
using NumberTrack = ClipTrack<NumberKey>;

// Something that happens at an instant, or (end_s > t_s) while: a contact.
struct ClipMark {
    double t_s = 0, end_s = 0;  // end_s = t_s for an instant
    std::string name;           // "foot_strike", "contact"
    std::string target;         // the joint or limb it is about: "leftFoot"; may be empty
};

struct Clip {
    std::string name;
    double duration_s = 0;
    // The end goes on at the beginning: the last keys equal the first but for the travel of the
    // root; splines look across the seam.
    bool loops = false;
    std::vector<RotationTrack> rotations;   // parent_from_joint, by joint; one per target
    std::vector<VectorTrack> translations;  // parent_from_joint in metres, by joint
    std::vector<NumberTrack> numbers;       // degrees of freedom; radians or metres
    std::vector<ClipMark> marks;            // ordered by t_s
    // The joint whose translation and heading are the clip's travel; empty: it stays where it is.
    std::string root;

    const RotationTrack* find_rotation(std::string_view joint) const;
    const VectorTrack* find_translation(std::string_view joint) const;
    const NumberTrack* find_number(std::string_view dof) const;
};

// All defects: times that are not finite, not ascending or outside [0, duration]; values that are
// not finite or beyond 1e9; durations beyond a million seconds; rotations that are not unit (within
// 1e-3); tracks without keys or twice; easings whose time runs back. Codes "bad-clip-time",
// "bad-clip-value", "bad-clip-track". `file` names the source in them.
Status check(const Clip& clip, std::string_view file = "");

// The value of one track. `loops` and `duration_s` are the clip's. Time outside [0, duration] is
// taken into it by wrapping where the clip loops, else by stopping at the ends.
// Needs   at least one key; a checked clip.
// Cost    logarithmic in the keys, no allocation.
Quat sample(const RotationTrack& track, double t_s, bool loops, double duration_s);
Vec3 sample(const VectorTrack& track, double t_s, bool loops, double duration_s);
double sample(const NumberTrack& track, double t_s, bool loops, double duration_s);

// The rate of one track at that time; at a corner, that of what follows.
Vec3 sample_rate(const RotationTrack& track, double t_s, bool loops, double duration_s);
Vec3 sample_rate(const VectorTrack& track, double t_s, bool loops, double duration_s);
double sample_rate(const NumberTrack& track, double t_s, bool loops, double duration_s);

// Which joint of a skeleton each track moves: looked up once, tracks in the clip's order. None
// where the skeleton has no such joint.
struct ClipBinding {
    // A joint that has tracks of degrees of freedom.
    struct Joint {
        figure::JointIndex joint;
        Transform parent_from_joint_rest;
        std::vector<figure::Dof> dofs;     // all of the joint, at most kMostDofs
        std::vector<std::int32_t> tracks;  // one per dof: in Clip::numbers, -1 for none
        bool all = false;                  // every dof has a track
    };
    static constexpr std::size_t kMostDofs = 6;

    std::vector<figure::JointIndex> rotations, translations;
    std::vector<Joint> joints;
};
// `dofs` of the figure; null: tracks of degrees of freedom move nothing.
ClipBinding bind_clip(const Clip& clip, const figure::Skeleton& skeleton,
                      const figure::DofSet* dofs = nullptr);

// Writes the joints that the clip has tracks of, and nothing else. Degrees of freedom of a joint
// that have no track stay as the pose has them (figure::values_of), if others of it have one. The
// travel of a looping clip starts anew with every round: see root_travel. Cost: no allocation.
void sample_clip(const Clip& clip, const ClipBinding& binding, double t_s, figure::Pose& out);

// Where the root has come since t = 0, planar (x, z and heading), relative to where it stood then:
// root_at_0 * root_travel(t) is the root's planar place at t. Of a looping clip over as many rounds
// as t has. The identity where there is no root.
Transform root_travel(const Clip& clip, double t_s);

}  // namespace puppetri::motion
