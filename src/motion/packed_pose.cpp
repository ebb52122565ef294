// SPDX-License-Identifier: MIT
// Slots, poses, and the choice of the width.
#include <algorithm>

#include "packed_kernels.h"
#include "packed_width.h"
#include "puppetri/base/require.h"

namespace puppetri::motion {
namespace {

constexpr std::uint32_t round_up(std::uint32_t n, std::uint32_t to) {
    return (n + to - 1) / to * to;
}

std::vector<PackedSkeleton::Run> runs_of(const std::vector<std::int32_t>& parent_slot,
                                         const std::vector<std::uint32_t>& level_begin,
                                         std::int32_t lanes) {
    std::vector<PackedSkeleton::Run> runs;
    for (std::size_t level = 0; level + 1 < level_begin.size(); ++level) {
        const auto end = static_cast<std::int32_t>(level_begin[level + 1]);
        for (auto begin = static_cast<std::int32_t>(level_begin[level]); begin < end;
             begin += lanes) {
            PackedSkeleton::Run run;
            run.begin = begin;
            run.count = std::min(lanes, end - begin);
            run.from_before = !runs.empty();
            for (std::int32_t i = 0; i < 8; ++i) {
                const auto slot = static_cast<std::size_t>(begin + (i < run.count ? i : 0));
                run.parents[i] = parent_slot[slot];
                if (!runs.empty()) {
                    run.within[i] = run.parents[i] - runs.back().begin;
                    run.from_before =
                        run.from_before && run.within[i] >= 0 && run.within[i] < runs.back().count;
                }
            }
            runs.push_back(run);
        }
    }
    return runs;
}

}  // namespace

Lanes widest_lanes() {
#if defined(PUPPETRI_MOTION_AVX2)
    static const Lanes widest = __builtin_cpu_supports("avx2") ? Lanes::k8 : Lanes::k4;
    return widest;
#else
    return Lanes::k4;
#endif
}

const PackedKernels& kernels(Lanes lanes) {
#if defined(PUPPETRI_MOTION_AVX2)
    if (lanes == Lanes::k8 && widest_lanes() == Lanes::k8) {
        return kKernels8;
    }
#endif
    return lanes == Lanes::k1 ? kKernels1 : kKernels4;
}

PackedSkeleton::PackedSkeleton(const figure::Skeleton& skeleton) {
    const std::size_t n = skeleton.joints.size();
    std::vector<std::uint32_t> level(n, 0);
    std::uint32_t levels = n == 0 ? 0 : 1;
    for (std::size_t j = 0; j < n; ++j) {
        if (const figure::JointIndex parent = skeleton.joints[j].parent; parent.valid()) {
            PUP_REQUIRE(parent.value < j);
            level[j] = level[parent.value] + 1;
            levels = std::max(levels, level[j] + 1);
        }
    }
    std::vector<std::uint32_t> level_begin{0};
    slot_of_.resize(n);
    for (std::uint32_t l = 0; l < levels; ++l) {
        for (std::uint32_t j = 0; j < n; ++j) {
            if (level[j] == l) {
                slot_of_[j] = static_cast<std::uint32_t>(joint_of_.size());
                joint_of_.push_back(j);
            }
        }
        level_begin.push_back(static_cast<std::uint32_t>(joint_of_.size()));
    }
    std::vector<std::int32_t> parent_slot(n, -1);
    for (std::size_t j = 0; j < n; ++j) {
        if (const figure::JointIndex parent = skeleton.joints[j].parent; parent.valid()) {
            parent_slot[slot_of_[j]] = static_cast<std::int32_t>(slot_of_[parent.value]);
        }
    }
    roots_ = levels > 0 ? level_begin[1] : 0;
    runs_1_ = runs_of(parent_slot, level_begin, 1);
    runs_4_ = runs_of(parent_slot, level_begin, 4);
    runs_8_ = runs_of(parent_slot, level_begin, 8);
    // Eight lanes may be stored from any slot on.
    stride_ = round_up(static_cast<std::uint32_t>(n) + 7, 8);
}

std::span<const PackedSkeleton::Run> PackedSkeleton::runs(Lanes lanes) const {
    return lanes == Lanes::k8 && widest_lanes() == Lanes::k8 ? runs_8_
           : lanes == Lanes::k1                              ? runs_1_
                                                             : runs_4_;
}

PackedPose::PackedPose(const PackedSkeleton& skeleton) : stride_(skeleton.stride()) {
    lines_.resize(round_up(7 * stride_, 16) / 16);
    std::fill_n(component(3), stride_, 1.0f);
}

Transform PackedPose::at(std::uint32_t slot) const {
    PUP_REQUIRE(slot < stride_);
    const auto c = [&](int k) { return static_cast<double>(component(k)[slot]); };
    return {{c(0), c(1), c(2), c(3)}, {c(4), c(5), c(6)}};
}

void PackedPose::set(std::uint32_t slot, const Transform& t) {
    PUP_REQUIRE(slot < stride_);
    const double values[7] = {t.rotation.x,    t.rotation.y,    t.rotation.z,   t.rotation.w,
                              t.translation.x, t.translation.y, t.translation.z};
    for (int k = 0; k < 7; ++k) {
        component(k)[slot] = static_cast<float>(values[k]);
    }
}

void blend(const PackedPose& a, const PackedPose& b, float weight, PackedPose& out, Lanes lanes) {
    PUP_REQUIRE(a.stride() == b.stride() && a.stride() == out.stride());
    kernels(lanes).blend(a.component(0), b.component(0), weight, a.stride(), a.stride(),
                         out.component(0));
}

void to_model_space(const PackedSkeleton& skeleton, const PackedPose& local, PackedPose& out,
                    Lanes lanes) {
    PUP_REQUIRE(local.stride() == skeleton.stride() && out.stride() == skeleton.stride() &&
                &local != &out);
    const std::span<const PackedSkeleton::Run> runs = skeleton.runs(lanes);
    kernels(lanes).to_model(runs.data(), runs.size(), skeleton.stride(), local.component(0),
                            out.component(0));
}

void to_matrices(const PackedSkeleton& skeleton, const PackedPose& model, std::span<float> out,
                 Lanes lanes) {
    PUP_REQUIRE(model.stride() == skeleton.stride() &&
                out.size() == std::size_t{12} * skeleton.joint_count());
    kernels(lanes).to_matrices(model.component(0), skeleton.stride(), skeleton.joints_of_slots(),
                               skeleton.joint_count(), out.data());
}

void pose_crowd(const PackedSkeleton& skeleton, std::span<const CrowdMember> members,
                std::span<PackedPose> out, std::span<PackedPose, 2> scratch, Lanes lanes) {
    PUP_REQUIRE(out.size() == members.size());
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (i + 1 < members.size()) {
            const CrowdMember& next = members[i + 1];
            next.clip->prefetch(next.t_s);
            if (next.other != nullptr) {
                next.other->prefetch(next.other_t_s);
            }
        }
        const CrowdMember& member = members[i];
        member.clip->sample(member.t_s, scratch[0], lanes);
        if (member.other != nullptr) {
            member.other->sample(member.other_t_s, scratch[1], lanes);
            blend(scratch[0], scratch[1], member.other_weight, scratch[0], lanes);
        }
        to_model_space(skeleton, scratch[0], out[i], lanes);
    }
}

}  // namespace puppetri::motion
