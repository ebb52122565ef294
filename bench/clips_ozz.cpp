// SPDX-License-Identifier: MIT
// The same work by ozz-animation: as its samples do it, with a context per figure and optimised
// clips.
#include <algorithm>
#include <cmath>

#include "clips_work.h"
#include "ozz/animation/offline/animation_builder.h"
#include "ozz/animation/offline/animation_optimizer.h"
#include "ozz/animation/offline/raw_animation.h"
#include "ozz/animation/offline/raw_skeleton.h"
#include "ozz/animation/offline/skeleton_builder.h"
#include "ozz/animation/runtime/animation.h"
#include "ozz/animation/runtime/blending_job.h"
#include "ozz/animation/runtime/local_to_model_job.h"
#include "ozz/animation/runtime/sampling_job.h"
#include "ozz/animation/runtime/skeleton.h"
#include "ozz/base/maths/simd_math.h"
#include "ozz/base/maths/soa_transform.h"

namespace puppetri::bench {
namespace {

namespace oa = ozz::animation;

ozz::math::Float3 to_ozz(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
ozz::math::Quaternion to_ozz(Quat q) {
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
            static_cast<float>(q.w)};
}

class Ozz final : public Doer {
 public:
    explicit Ozz(const Material& m) : duration_(m.clips[0].duration_s) {
        oa::offline::RawSkeleton raw;
        raw.roots.resize(1);
        add(m.skeleton, 0, raw.roots[0]);
        skeleton_ = oa::offline::SkeletonBuilder()(raw);
        order_.resize(m.skeleton.joints.size());
        for (int j = 0; j < skeleton_->num_joints(); ++j) {
            order_[m.skeleton.find(skeleton_->joint_names()[j]).value] = j;
        }
        for (int c = 0; c < 2; ++c) {
            animations_[c] = animation(m, m.clips[c]);
        }
        const auto soa = static_cast<std::size_t>(skeleton_->num_soa_joints());
        for (int i = 0; i < kMostMembers; ++i) {
            members_.push_back(std::make_unique<Member>());
            Member& member = *members_.back();
            for (int c = 0; c < 2; ++c) {
                member.context[c].Resize(skeleton_->num_joints());
                member.local[c].resize(soa);
            }
            member.blended.resize(soa);
            member.model.resize(order_.size());
            const auto rest = skeleton_->joint_rest_poses();
            std::copy(rest.begin(), rest.end(), member.local[0].begin());
        }
    }

    void run(Work work, int members, int rounds) override {
        for (int r = 0; r < rounds; ++r) {
            const double t = round_++ / 60.0;
            for (int i = 0; i < members; ++i) {
                Member& m = *members_[static_cast<std::size_t>(i)];
                const double at = start_of(i) + t;
                switch (work) {
                    case Work::kSample:
                        sample(m, 0, at);
                        break;
                    case Work::kTree:
                    case Work::kTreeMatrices:  // its trees are of matrices
                        tree(m, m.local[0]);
                        break;
                    case Work::kBlend:
                        sample(m, 0, at);
                        sample(m, 1, at);
                        blend(m);
                        tree(m, m.blended);
                        break;
                }
            }
        }
    }
    Vec3 place(int member, int joint) const override {
        const ozz::math::Float4x4& at =
            members_[static_cast<std::size_t>(member)]
                ->model[static_cast<std::size_t>(order_[static_cast<std::size_t>(joint)])];
        float v[4];
        ozz::math::StorePtrU(at.cols[3], v);
        return {v[0], v[1], v[2]};
    }

 private:
    struct Member {
        oa::SamplingJob::Context context[2];
        ozz::vector<ozz::math::SoaTransform> local[2], blended;
        ozz::vector<ozz::math::Float4x4> model;
    };

    static void add(const figure::Skeleton& skeleton, std::uint32_t joint,
                    oa::offline::RawSkeleton::Joint& out) {
        const figure::Joint& j = skeleton.joints[joint];
        out.name = j.name.c_str();
        out.transform.translation = to_ozz(j.parent_from_joint_rest.translation);
        out.transform.rotation = to_ozz(j.parent_from_joint_rest.rotation);
        out.transform.scale = ozz::math::Float3::one();
        for (std::uint32_t k = 0; k < skeleton.joints.size(); ++k) {
            if (skeleton.joints[k].parent == figure::JointIndex{joint}) {
                out.children.emplace_back();
            }
        }
        std::size_t child = 0;
        for (std::uint32_t k = 0; k < skeleton.joints.size(); ++k) {
            if (skeleton.joints[k].parent == figure::JointIndex{joint}) {
                add(skeleton, k, out.children[child++]);
            }
        }
    }

    ozz::unique_ptr<oa::Animation> animation(const Material& m, const motion::Clip& clip) {
        oa::offline::RawAnimation raw;
        raw.duration = static_cast<float>(clip.duration_s);
        raw.tracks.resize(m.skeleton.joints.size());
        for (std::size_t j = 0; j < m.skeleton.joints.size(); ++j) {
            auto& track = raw.tracks[static_cast<std::size_t>(order_[j])];
            const figure::Joint& joint = m.skeleton.joints[j];
            for (const motion::RotationKey& key : clip.find_rotation(joint.name)->keys) {
                track.rotations.push_back(
                    {std::min(static_cast<float>(key.t_s), raw.duration), to_ozz(key.value)});
            }
            if (const motion::VectorTrack* t = clip.find_translation(joint.name)) {
                for (const motion::VectorKey& key : t->keys) {
                    track.translations.push_back(
                        {std::min(static_cast<float>(key.t_s), raw.duration), to_ozz(key.value)});
                }
            } else {
                track.translations.push_back({0, to_ozz(joint.parent_from_joint_rest.translation)});
            }
        }
        oa::offline::RawAnimation optimized;
        oa::offline::AnimationOptimizer optimizer;
        if (!optimizer(raw, *skeleton_, &optimized)) {
            optimized = raw;
        }
        return oa::offline::AnimationBuilder()(optimized);
    }

    void sample(Member& m, int clip, double t) {
        oa::SamplingJob job;
        job.animation = animations_[clip].get();
        job.context = &m.context[clip];
        job.ratio = static_cast<float>((t - std::floor(t / duration_) * duration_) / duration_);
        job.output = ozz::make_span(m.local[clip]);
        job.Run();
    }
    void blend(Member& m) {
        oa::BlendingJob::Layer layers[2];
        for (int c = 0; c < 2; ++c) {
            layers[c].transform = ozz::make_span(m.local[c]);
            layers[c].weight = 0.5f;
        }
        oa::BlendingJob job;
        job.layers = layers;
        job.rest_pose = skeleton_->joint_rest_poses();
        job.output = ozz::make_span(m.blended);
        job.Run();
    }
    void tree(Member& m, const ozz::vector<ozz::math::SoaTransform>& local) {
        oa::LocalToModelJob job;
        job.skeleton = skeleton_.get();
        job.input = ozz::make_span(local);
        job.output = ozz::make_span(m.model);
        job.Run();
    }

    double duration_ = 1;
    ozz::unique_ptr<oa::Skeleton> skeleton_;
    ozz::unique_ptr<oa::Animation> animations_[2];
    std::vector<int> order_;  // of our joints: theirs
    std::vector<std::unique_ptr<Member>> members_;
    int round_ = 0;
};

}  // namespace

std::unique_ptr<Doer> make_ozz(const Material& m) { return std::make_unique<Ozz>(m); }

}  // namespace puppetri::bench
