// SPDX-License-Identifier: MIT
// Clips and poses in the form that machines read: frames of floats, component by component, in an
// order of joints that lets many be worked on at once. For crowds: no allocation, no search, the
// same bits at every width of the processor's registers. People edit clip.h; pack_clip freezes it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/figure/dof.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// How many joints are worked on at once. Results are the same bits.
enum class Lanes : std::uint8_t { k1 = 1, k4 = 4, k8 = 8 };
Lanes widest_lanes();  // of this processor

struct alignas(64) FloatLine {
    float v[16] = {};
};

// Joints in slots: level by level of the tree, so that a whole level is computed from the one
// above. Made once per skeleton.
class PackedSkeleton {
 public:
    PackedSkeleton() = default;
    explicit PackedSkeleton(const figure::Skeleton& skeleton);

    std::uint32_t joint_count() const { return static_cast<std::uint32_t>(joint_of_.size()); }
    std::uint32_t slot_of(figure::JointIndex joint) const { return slot_of_[joint.value]; }
    figure::JointIndex joint_of(std::uint32_t slot) const { return {joint_of_[slot]}; }
    const std::uint32_t* joints_of_slots() const { return joint_of_.data(); }
    // Floats from one component of a pose to the next.
    std::uint32_t stride() const { return stride_; }

    // A run of slots that is computed at once: the slots begin .. begin + count - 1, whose parents
    // are the slots parents[0 .. lanes); from_before: they are all in the run before this one,
    // and within[] are their lanes there.
    struct Run {
        std::int32_t begin = 0, count = 0;
        bool from_before = false;
        std::int32_t parents[8] = {}, within[8] = {};
    };
    std::span<const Run> runs(Lanes lanes) const;
    std::uint32_t root_count() const { return roots_; }  // the first slots have no parent

 private:
    std::vector<std::uint32_t> joint_of_, slot_of_;
    std::vector<Run> runs_1_, runs_4_, runs_8_;
    std::uint32_t stride_ = 0, roots_ = 0;
};

// A pose, of joints relative to their parents or in model space, in the slots of a PackedSkeleton:
// x of all rotations, then y, z, w, then x, y, z of all translations.
class PackedPose {
 public:
    PackedPose() = default;
    explicit PackedPose(const PackedSkeleton& skeleton);  // all identities

    float* component(int k) { return lines_.data()->v + stride_ * static_cast<std::size_t>(k); }
    const float* component(int k) const {
        return lines_.data()->v + stride_ * static_cast<std::size_t>(k);
    }
    Transform at(std::uint32_t slot) const;
    void set(std::uint32_t slot, const Transform& transform);
    std::uint32_t stride() const { return stride_; }

 private:
    std::uint32_t stride_ = 0;
    std::vector<FloatLine> lines_;
};

// How far the packed form may be from the editable one at any time.
struct PackTolerance {
    double angle_rad = 1e-4, length_m = 1e-4;
};

// A clip sampled at instants dense enough that straight lines between them stay within the
// tolerance: for clips linear between keys these are the keys, so that there is nothing but
// rounding to floats (and the difference between slerp and its chord). Joints without tracks stay
// at rest.
class PackedClip {
 public:
    PackedClip() = default;

    double duration_s() const { return duration_s_; }
    bool loops() const { return loops_; }
    std::uint32_t frame_count() const { return static_cast<std::uint32_t>(times_.size()); }
    std::uint64_t bytes() const;

    // Writes the whole pose at that time, which is taken into the clip as for Clip.
    // Needs   a pose of the skeleton that the clip was packed for.
    // Cost    two frames of memory are read; no allocation.
    void sample(double t_s, PackedPose& out, Lanes lanes = widest_lanes()) const;
    // Starts to load what sample will need at that time.
    void prefetch(double t_s) const;

 private:
    friend PackedClip pack_clip(const Clip&, const figure::Skeleton&, const PackedSkeleton&,
                                const figure::DofSet*, const PackTolerance&);
    struct Place {
        std::uint32_t frame = 0;
        float ratio = 0;
    };
    Place place_of(double t_s) const;

    double duration_s_ = 0;
    bool loops_ = false;
    bool even_ = false;                // the frames are equally far apart
    double per_second_ = 0;            // even: frames; else buckets
    std::vector<double> times_;        // of the frames, increasing
    std::vector<std::uint32_t> hint_;  // uneven, by bucket: the last frame not after its begin
    std::uint32_t joints_ = 0, lines_per_frame_ = 0;
    std::vector<FloatLine> frames_;  // rotations: x of all slots, y, z, w, then moving translations
    std::vector<std::uint32_t> moving_;  // slots whose translation changes
    std::vector<FloatLine> rest_;        // translations of the others: x, y, z
};

// Needs   a checked clip; `dofs` of the figure for tracks of degrees of freedom, or null.
// Cost    proportional to frames times joints.
PackedClip pack_clip(const Clip& clip, const figure::Skeleton& skeleton,
                     const PackedSkeleton& packed, const figure::DofSet* dofs = nullptr,
                     const PackTolerance& tolerance = {});

// Between two poses: rotations along the chord, made unit again; translations straight.
// weight 0 gives a, 1 gives b. `out` may be a or b.
void blend(const PackedPose& a, const PackedPose& b, float weight, PackedPose& out,
           Lanes lanes = widest_lanes());

// The products along the tree. `out` is another pose than `local`.
void to_model_space(const PackedSkeleton& skeleton, const PackedPose& local, PackedPose& out,
                    Lanes lanes = widest_lanes());

// Matrices for skinning, column after column (12 floats: three columns of the rotation, then the
// translation), by joint of the skeleton, of a pose in model space.
void to_matrices(const PackedSkeleton& skeleton, const PackedPose& model, std::span<float> out,
                 Lanes lanes = widest_lanes());

// One figure of a crowd: what it plays. With a second clip it plays a blend of both.
struct CrowdMember {
    const PackedClip* clip = nullptr;
    double t_s = 0;
    const PackedClip* other = nullptr;
    double other_t_s = 0;
    float other_weight = 0;
};
// Poses of a crowd in model space: for each member sampled, blended, multiplied along the tree.
// Needs   poses of that skeleton, as many as members, and two more as working memory.
void pose_crowd(const PackedSkeleton& skeleton, std::span<const CrowdMember> members,
                std::span<PackedPose> out, std::span<PackedPose, 2> scratch,
                Lanes lanes = widest_lanes());

}  // namespace puppetri::motion
