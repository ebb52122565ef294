// SPDX-License-Identifier: MIT
// The work that is measured for clips, and who does it: this project, a plain loop as people would
// write it first (the floor), and, where its library is given, ozz-animation.
#pragma once
#include <memory>
#include <vector>

#include "puppetri/figure/skeleton.h"
#include "puppetri/motion/clip.h"

namespace puppetri::bench {

enum class Work { kSample, kTree, kTreeMatrices, kBlend };

struct Material {
    figure::Skeleton skeleton;  // 31 joints, a humanoid's tree
    motion::Clip clips[2];      // 30 keys per second on all joints, linear
};

// Member m at round r plays at offset(m) + r / 60 s; the second clip of a blend the same, half the
// weight.
class Doer {
 public:
    virtual ~Doer() = default;
    // All members, `rounds` times, on from where the last call ended.
    virtual void run(Work work, int members, int rounds) = 0;
    // Where a joint of a member is in model space after kBlend.
    virtual Vec3 place(int member, int joint) const = 0;
};

inline constexpr int kMostMembers = 1000;
inline double start_of(int member) { return 0.0097 * member; }

std::unique_ptr<Doer> make_packed(const Material& material);
std::unique_ptr<Doer> make_plain(const Material& material);
#if defined(PUPPETRI_WITH_OZZ)
std::unique_ptr<Doer> make_ozz(const Material& material);
#endif

}  // namespace puppetri::bench
