// SPDX-License-Identifier: MIT
// A take: a stretch of a performance sampled for files. Every exporter writes takes, so that frame
// ranges, rates, root modes, rest poses and loops mean the same in every format. Key 0 is at time 0
// of the file; the last frame is inside.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/frame_rate.h"
#include "puppetri/base/time.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/stage/performance.h"

namespace puppetri::io {

inline constexpr double kLowestExportRate = 23.976;
inline constexpr double kHighestExportRate = 120;

// Where the travel of a figure goes.
enum class RootMode : std::uint8_t {
    kMotion,   // the joint `root` carries planar travel and heading
    kInPlace,  // `root` stays where the take begins (it keeps turning): for engines that move the
               // figure themselves
    kHips,  // `root` stays at the origin and `hips` carries everything: for programs without a root
            // joint
};

enum class RestPose : std::uint8_t {
    kT,
    kA,  // upper arms 45 degrees down; poses are the same, only what they are measured from differs
         // (characters from files keep the rest pose of their file)
};

// Frames of the performance, both ends inside.
struct FrameRange {
    std::int64_t first = 0;
    std::int64_t last = 0;
};

struct TakeOptions {
    FrameRate rate;
    std::optional<FrameRange> frames;  // none: all
    std::int64_t handles_frames =
        0;  // more frames before and after `frames`, as far as there are any
    RootMode root = RootMode::kMotion;
    // None: the figure's own, of mannequins the T-pose, of characters that of their file. Creatures
    // keep theirs in any case.
    std::optional<RestPose> rest;
    // Joints of characters get the names of the bones that they are (docs/conventions.md) instead
    // of those of their file, so that the writers' sets of names apply to them.
    bool bone_names = false;
    // Besides the frames: keys at events, and where a held prop would leave the hand by more than
    // 0.25 mm between keys.
    bool keys_at_events = true;
    // Cuts one period out of `frames`: the earliest stretch in which every figure comes back to
    // what it did and how it stood. Its last key equals its first in everything but the travel of
    // the root.
    bool loop = false;
};

struct TakeActor {
    std::string name;
    figure::Skeleton skeleton;  // in the chosen rest pose
    figure::JointIndex hips;    // none where there are none; joint 0 is the root
    figure::Mesh mesh;          // bound to it
    // Key-major: transforms[key * joints + joint].
    std::vector<Transform> parent_from_joint;
    // From the root at the first key to the root at the last, in the first's space. Before the root
    // mode was applied.
    Transform root_delta;
};

struct HolderChange {
    SimTime at;          // of the file
    std::string holder;  // from then on: "ana.hands", "air", "floor"
};

struct TakeProp {
    std::string name;
    const figure::Mesh* mesh = nullptr;  // of the performance; may be null
    std::vector<Transform> world_from_prop;
    std::vector<HolderChange> holders;  // the first at 0
};

struct TakeEvent {
    SimTime at;              // of the file
    std::int64_t frame = 0;  // of the file, the nearest
    std::string name, actor, limb, prop;
};

struct Take {
    std::string name;  // of the clip; empty for the whole
    FrameRate rate;
    std::int64_t first_frame = 0;  // of the performance: what frame 0 of the file shows
    std::int64_t frame_count = 0;
    std::int64_t handle_before = 0, handle_after = 0;
    bool loop = false;
    std::vector<SimTime> times;  // of the keys, of the file, increasing, distinct as 32-bit seconds
    std::vector<std::uint32_t>
        frame_keys;  // the keys that are frames; frame k of the file is times[frame_keys[k]]
    std::vector<TakeActor> actors;
    std::vector<TakeProp> props;
    std::vector<TakeEvent> events;

    std::span<const Transform> pose(std::size_t actor, std::size_t key) const {
        const TakeActor& a = actors[actor];
        return std::span(a.parent_from_joint)
            .subspan(key * a.skeleton.joints.size(), a.skeleton.joints.size());
    }
};

// Samples the performance. Needs the performance to outlive the take.
// Fails   "bad-range": frames that the performance does not have, or negative handles; "no-period":
// nothing repeats;
//         "bad-rate": outside 23.976 to 120; "nothing-to-show": neither figures nor props.
// Cost    one pose per key and actor.
Checked<Take> sample_take(const stage::Performance& performance, const TakeOptions& options);

// One take per actor and place of the net whose movement the actor performs, of its first
// performance within the range, beginning with the root at the origin: "ana_throw"; where several
// places run one movement, the place is added. Props are left out. Fails as sample_take; handles
// and loop do not apply.
Checked<std::vector<Take>> sample_clips(const stage::Performance& performance,
                                        const TakeOptions& options);

}  // namespace puppetri::io
