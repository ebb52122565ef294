// SPDX-License-Identifier: MIT
// Sampling of clips, joint trees, blends: nanoseconds per figure, beside a plain loop and, where
// its library is given (PUPPETRI_OZZ), ozz-animation. Doers take turns in one process; the least of
// many turns counts. Poses are compared before anything is told.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include "clips_work.h"
#include "puppetri/base/hash.h"
#include "puppetri/motion/packed_clip.h"

namespace puppetri::bench {
namespace {

class Packed final : public Doer {
 public:
    explicit Packed(const Material& m)
        : skeleton_(m.skeleton),
          a_(motion::pack_clip(m.clips[0], m.skeleton, skeleton_)),
          b_(motion::pack_clip(m.clips[1], m.skeleton, skeleton_)),
          local_(kMostMembers, motion::PackedPose(skeleton_)),
          model_(local_),
          scratch_{motion::PackedPose(skeleton_), motion::PackedPose(skeleton_)},
          tree_(skeleton_),
          crowd_(kMostMembers),
          matrices_(std::size_t{12} * skeleton_.joint_count() * kMostMembers) {}

    void run(Work work, int members, int rounds) override {
        for (int r = 0; r < rounds; ++r) {
            const double t = round_++ / 60.0;
            for (int m = 0; m < members; ++m) {
                const auto i = static_cast<std::size_t>(m);
                switch (work) {
                    case Work::kSample:
                        a_.sample(start_of(m) + t, local_[i]);
                        break;
                    case Work::kTree:
                        motion::to_model_space(skeleton_, local_[i], model_[i]);
                        break;
                    case Work::kTreeMatrices: {
                        const std::size_t size = std::size_t{12} * skeleton_.joint_count();
                        // The tree is on the way only: one pose serves all.
                        motion::to_model_space(skeleton_, local_[i], tree_);
                        motion::to_matrices(skeleton_, tree_,
                                            std::span(matrices_).subspan(i * size, size));
                        break;
                    }
                    case Work::kBlend:
                        crowd_[i] = {&a_, start_of(m) + t, &b_, start_of(m) + t, 0.5f};
                        break;
                }
            }
            if (work == Work::kBlend) {
                const auto n = static_cast<std::size_t>(members);
                motion::pose_crowd(skeleton_, std::span(crowd_).first(n),
                                   std::span(model_).first(n), scratch_);
            }
        }
    }
    Vec3 place(int member, int joint) const override {
        return model_[static_cast<std::size_t>(member)]
            .at(skeleton_.slot_of({static_cast<std::uint32_t>(joint)}))
            .translation;
    }

 private:
    motion::PackedSkeleton skeleton_;
    motion::PackedClip a_, b_;
    std::vector<motion::PackedPose> local_, model_;
    std::array<motion::PackedPose, 2> scratch_;
    motion::PackedPose tree_;
    std::vector<motion::CrowdMember> crowd_;
    std::vector<float> matrices_;
    int round_ = 0;
};

// Frames in an array, joints one after the other, doubles, slerp.
class Plain final : public Doer {
 public:
    explicit Plain(const Material& m) : material_(m) {
        for (int c = 0; c < 2; ++c) {
            const motion::ClipBinding binding = motion::bind_clip(m.clips[c], m.skeleton);
            figure::Pose pose = figure::rest_pose(m.skeleton);
            for (int k = 0; k <= std::lround(m.clips[c].duration_s * 30); ++k) {
                motion::sample_clip(m.clips[c], binding, k / 30.0, pose);
                frames_[c].push_back(pose);
            }
        }
        local_.assign(kMostMembers, figure::rest_pose(m.skeleton));
        other_ = local_[0];
        model_.assign(kMostMembers, std::vector<Transform>(m.skeleton.joints.size()));
    }
    void run(Work work, int members, int rounds) override {
        for (int r = 0; r < rounds; ++r) {
            const double t = round_++ / 60.0;
            for (int m = 0; m < members; ++m) {
                const auto i = static_cast<std::size_t>(m);
                if (work == Work::kSample || work == Work::kBlend) {
                    sample(0, start_of(m) + t, local_[i]);
                }
                if (work == Work::kBlend) {
                    sample(1, start_of(m) + t, other_);
                    mix(local_[i], other_, 0.5, local_[i]);
                }
                if (work != Work::kSample) {
                    figure::to_model_space(material_.skeleton, local_[i], model_[i]);
                }
            }
        }
    }
    Vec3 place(int member, int joint) const override {
        return model_[static_cast<std::size_t>(member)][static_cast<std::size_t>(joint)]
            .translation;
    }

 private:
    static void mix(const figure::Pose& a, const figure::Pose& b, double ratio, figure::Pose& out) {
        for (std::size_t j = 0; j < a.parent_from_joint.size(); ++j) {
            const Transform &p = a.parent_from_joint[j], &q = b.parent_from_joint[j];
            out.parent_from_joint[j] = {slerp(p.rotation, q.rotation, ratio),
                                        lerp(p.translation, q.translation, ratio)};
        }
    }
    void sample(int clip, double t, figure::Pose& out) const {
        const double duration = material_.clips[clip].duration_s;
        const double at = (t - std::floor(t / duration) * duration) * 30;
        const auto k = std::min(static_cast<std::size_t>(at), frames_[clip].size() - 2);
        mix(frames_[clip][k], frames_[clip][k + 1], at - static_cast<double>(k), out);
    }
    const Material& material_;
    std::vector<figure::Pose> frames_[2];
    std::vector<figure::Pose> local_;
    figure::Pose other_;
    std::vector<std::vector<Transform>> model_;
    int round_ = 0;
};

Material make_material() {
    Material m;
    // The tree of a capture: hips, two legs of five, a trunk, two arms of seven.
    constexpr int kParents[31] = {-1, 0,  1,  2,  3,  4,  0,  6,  7,  8,  9,  0,  11, 12, 13, 14,
                                  15, 13, 17, 18, 19, 20, 21, 20, 13, 24, 25, 26, 27, 28, 27};
    for (int j = 0; j < 31; ++j) {
        figure::Joint joint;
        joint.name = "joint" + std::to_string(j);
        if (j > 0) {
            joint.parent = {static_cast<std::uint32_t>(kParents[j])};
            joint.parent_from_joint_rest.translation = {0.05 * (j % 3 - 1), 0.12, 0.02 * (j % 5)};
        }
        m.skeleton.joints.push_back(std::move(joint));
    }
    for (int c = 0; c < 2; ++c) {
        motion::Clip& clip = m.clips[c];
        clip.name = c == 0 ? "a" : "b";
        clip.duration_s = 10;
        clip.loops = true;
        motion::VectorTrack travel{"joint0", {}};
        for (int k = 0; k <= 300; ++k) {
            motion::VectorKey key;
            key.t_s = k / 30.0;
            key.value = {0.1 * std::sin(0.2 * k), 1 + 0.03 * std::sin(0.7 * k), 0.01 * k};
            travel.keys.push_back(key);
        }
        clip.translations.push_back(std::move(travel));
        for (int j = 0; j < 31; ++j) {
            motion::RotationTrack track{m.skeleton.joints[static_cast<std::size_t>(j)].name, {}};
            for (int k = 0; k <= 300; ++k) {
                const double phase = 2 * 3.14159265358979 * (k / 30.0) * 0.9 + 0.3 * j + c;
                motion::RotationKey key;
                key.t_s = k / 30.0;
                key.value =
                    from_rotation_vector({0.6 * std::sin(phase), 0.2 * std::sin(1.7 * phase + j),
                                          0.3 * std::cos(0.8 * phase)});
                track.keys.push_back(key);
            }
            clip.rotations.push_back(std::move(track));
        }
    }
    return m;
}

double cpu_ns() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

struct Row {
    const char* name;
    Work work;
    int members;
};

double worst_difference(Doer& a, Doer& b) {
    a.run(Work::kBlend, 100, 1);
    b.run(Work::kBlend, 100, 1);
    double worst = 0;
    for (int m = 0; m < 100; ++m) {
        for (int j = 0; j < 31; ++j) {
            worst = std::max(worst, length(a.place(m, j) - b.place(m, j)));
        }
    }
    return worst;
}

}  // namespace

std::unique_ptr<Doer> make_packed(const Material& m) { return std::make_unique<Packed>(m); }
std::unique_ptr<Doer> make_plain(const Material& m) { return std::make_unique<Plain>(m); }

namespace {

int measure(int turns, bool csv) {
    const Material material = make_material();
    std::vector<std::pair<const char*, std::unique_ptr<Doer>>> doers;
    doers.emplace_back("puppetri", make_packed(material));
    doers.emplace_back("plain", make_plain(material));
#if defined(PUPPETRI_WITH_OZZ)
    doers.emplace_back("ozz", make_ozz(material));
#endif
    // Different ways to the same poses. ozz stores rotations in fewer bits: millimetres.
    for (std::size_t d = 1; d < doers.size(); ++d) {
        auto ours = make_packed(material);
        const double off = worst_difference(*ours, *doers[d].second);
        const double allowed = std::strcmp(doers[d].first, "ozz") == 0 ? 5e-3 : 1e-4;
        if (off > allowed) {
            std::fprintf(stderr, "%s is %g m away from puppetri\n", doers[d].first, off);
            return 1;
        }
        // Both have gone on by one round; none of it is timed.
    }
    Hash64 hash;
    for (int m = 0; m < 100; ++m) {
        auto& packed = *doers[0].second;
        if (m == 0) {
            packed.run(Work::kBlend, 100, 1);
        }
        for (int j = 0; j < 31; ++j) {
            const Vec3 p = packed.place(m, j);
            hash.add_f64(p.x).add_f64(p.y).add_f64(p.z);
        }
    }
    const Row rows[] = {{"sample, one figure", Work::kSample, 1},
                        {"sample, 1000 figures", Work::kSample, 1000},
                        {"tree, one figure", Work::kTree, 1},
                        {"tree, 1000 figures", Work::kTree, 1000},
                        {"tree with matrices, one figure", Work::kTreeMatrices, 1},
                        {"tree with matrices, 1000 figures", Work::kTreeMatrices, 1000},
                        {"two clips, blend, tree, one figure", Work::kBlend, 1},
                        {"two clips, blend, tree, 1000 figures", Work::kBlend, 1000}};
    std::printf(csv ? "what,who,ns,ratio\n" : "%-38s %-10s %10s %8s\n", "what", "who", "ns",
                "ratio");
    for (const Row& row : rows) {
        std::vector<double> best(doers.size(), 1e300);
        const int rounds = row.members == 1 ? 2000 : 4;
        for (int turn = 0; turn < turns; ++turn) {
            for (std::size_t d = 0; d < doers.size(); ++d) {
                doers[d].second->run(row.work, row.members, row.members == 1 ? 100 : 1);
                const double begin = cpu_ns();
                doers[d].second->run(row.work, row.members, rounds);
                best[d] = std::min(best[d], (cpu_ns() - begin) / rounds / row.members);
            }
        }
        for (std::size_t d = 0; d < doers.size(); ++d) {
            std::printf(csv ? "\"%s\",%s,%.1f,%.2f\n" : "%-38s %-10s %10.1f %8.2f\n", row.name,
                        doers[d].first, best[d], best[d] / best[0]);
        }
    }
    std::printf(csv ? "hash,%016llx,,\n" : "hash of the poses %016llx\n",
                static_cast<unsigned long long>(hash.value()));
    return 0;
}

}  // namespace
}  // namespace puppetri::bench

int main(int argc, char** argv) {
    int turns = 40;
    bool csv = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--csv") == 0) {
            csv = true;
        } else {
            turns = std::max(1, std::atoi(argv[i]));
        }
    }
    return puppetri::bench::measure(turns, csv);
}
