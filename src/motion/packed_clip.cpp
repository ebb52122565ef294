// SPDX-License-Identifier: MIT
// From an editable clip to frames, and back to poses.
#include "puppetri/motion/packed_clip.h"

#include <algorithm>
#include <cmath>

#include "clip_segment.h"
#include "packed_kernels.h"
#include "packed_width.h"
#include "puppetri/base/require.h"

namespace puppetri::motion {
namespace {

constexpr double kShortest_s = 1e-7;  // frames are not closer: a step takes this long
constexpr int kDeepest = 12;          // halvings between two keys

struct Frame {
    double t_s = 0;
    std::vector<Transform> pose;  // by joint
};

// Looks between two frames: how far is the straight line from the clip? A line that is within the
// tolerance at a quarter, the middle and three quarters is taken for good.
class FrameMaker {
 public:
    FrameMaker(const Clip& clip, const figure::Skeleton& skeleton, const figure::DofSet* dofs,
               const PackTolerance& tolerance)
        : clip_(clip),
          binding_(bind_clip(clip, skeleton, dofs)),
          tolerance_(tolerance),
          rest_(figure::rest_pose(skeleton)) {}

    std::vector<Frame> make() {
        for (const double t : instants()) {
            Frame next = frame_at(t);
            if (!frames_.empty()) {
                refine(Frame(frames_.back()), next, kDeepest);
            }
            frames_.push_back(std::move(next));
        }
        return std::move(frames_);
    }

 private:
    // The times of all keys, the ends, and just before the jumps of steps.
    std::vector<double> instants() const {
        std::vector<double> times{0, clip_.duration_s};
        const auto add = [&](const auto& tracks) {
            for (const auto& track : tracks) {
                for (std::size_t k = 0; k < track.keys.size(); ++k) {
                    const double t = track.keys[k].t_s;
                    times.push_back(t);
                    if (k > 0 && track.keys[k - 1].interpolation == Interpolation::kStep) {
                        times.push_back(std::max(t - kShortest_s, track.keys[k - 1].t_s));
                    }
                }
            }
        };
        add(clip_.rotations);
        add(clip_.translations);
        add(clip_.numbers);
        std::sort(times.begin(), times.end());
        std::vector<double> distinct;
        for (const double t : times) {
            if (distinct.empty() || t - distinct.back() > kShortest_s / 2) {
                distinct.push_back(t);
            }
        }
        return distinct;
    }

    Frame frame_at(double t) {
        pose_ = rest_;
        sample_clip(clip_, binding_, t, pose_);
        return {t, pose_.parent_from_joint};
    }

    bool straight(const Frame& a, const Frame& b) {
        for (const double ratio : {0.25, 0.5, 0.75}) {
            const Frame at = frame_at(a.t_s + (b.t_s - a.t_s) * ratio);
            for (std::size_t j = 0; j < at.pose.size(); ++j) {
                const Transform &p = a.pose[j], &q = b.pose[j], &exact = at.pose[j];
                const Vec3 off =
                    p.translation + (q.translation - p.translation) * ratio - exact.translation;
                if (length(off) > tolerance_.length_m) {
                    return false;
                }
                Quat end = q.rotation;
                if (p.rotation == end) {
                    if (angle_between(end, exact.rotation) > tolerance_.angle_rad) {
                        return false;
                    }
                    continue;
                }
                const Quat s = p.rotation;
                if (s.x * end.x + s.y * end.y + s.z * end.z + s.w * end.w < 0) {
                    end = {-end.x, -end.y, -end.z, -end.w};
                }
                const Quat chord =
                    normalized(Quat{s.x + (end.x - s.x) * ratio, s.y + (end.y - s.y) * ratio,
                                    s.z + (end.z - s.z) * ratio, s.w + (end.w - s.w) * ratio});
                if (angle_between(chord, exact.rotation) > tolerance_.angle_rad) {
                    return false;
                }
            }
        }
        return true;
    }

    void refine(const Frame& a, const Frame& b, int depth) {
        if (depth == 0 || b.t_s - a.t_s < 2 * kShortest_s || straight(a, b)) {
            return;
        }
        Frame middle = frame_at((a.t_s + b.t_s) / 2);
        refine(a, middle, depth - 1);
        frames_.push_back(middle);
        refine(middle, b, depth - 1);
    }

    const Clip& clip_;
    ClipBinding binding_;
    PackTolerance tolerance_;
    figure::Pose rest_, pose_;
    std::vector<Frame> frames_;
};

std::uint32_t round_up_8(std::uint32_t n) { return (n + 7) / 8 * 8; }

}  // namespace

PackedClip pack_clip(const Clip& clip, const figure::Skeleton& skeleton,
                     const PackedSkeleton& packed, const figure::DofSet* dofs,
                     const PackTolerance& tolerance) {
    PUP_REQUIRE(packed.joint_count() == skeleton.joints.size());
    const std::vector<Frame> frames = FrameMaker(clip, skeleton, dofs, tolerance).make();
    const std::uint32_t joints = packed.joint_count();

    PackedClip out;
    out.duration_s_ = clip.duration_s;
    out.loops_ = clip.loops;
    out.joints_ = round_up_8(joints);
    for (std::uint32_t slot = 0; slot < joints; ++slot) {
        const std::uint32_t j = packed.joint_of(slot).value;
        if (std::any_of(frames.begin(), frames.end(), [&](const Frame& f) {
                return f.pose[j].translation != frames[0].pose[j].translation;
            })) {
            out.moving_.push_back(slot);
        }
    }
    const auto moving = static_cast<std::uint32_t>(out.moving_.size());
    out.lines_per_frame_ = (4 * out.joints_ + 3 * moving + 15) / 16;
    out.rest_.resize((3 * out.joints_ + 15) / 16);
    float* rest = out.rest_.data()->v;
    for (std::uint32_t slot = 0; slot < joints; ++slot) {
        const Vec3 t = frames[0].pose[packed.joint_of(slot).value].translation;
        rest[slot] = static_cast<float>(t.x);
        rest[out.joints_ + slot] = static_cast<float>(t.y);
        rest[2 * out.joints_ + slot] = static_cast<float>(t.z);
    }

    out.frames_.resize(std::size_t{out.lines_per_frame_} * frames.size());
    std::vector<Quat> before(joints);
    for (std::size_t f = 0; f < frames.size(); ++f) {
        out.times_.push_back(frames[f].t_s);
        float* to = out.frames_[f * out.lines_per_frame_].v;
        std::fill_n(to + 3 * out.joints_, out.joints_, 1.0f);
        for (std::uint32_t slot = 0; slot < joints; ++slot) {
            Quat q = frames[f].pose[packed.joint_of(slot).value].rotation;
            const Quat& b = before[slot];
            if (f > 0 && q.x * b.x + q.y * b.y + q.z * b.z + q.w * b.w < 0) {
                q = {-q.x, -q.y, -q.z, -q.w};  // neighbours in one hemisphere
            }
            before[slot] = q;
            to[slot] = static_cast<float>(q.x);
            to[out.joints_ + slot] = static_cast<float>(q.y);
            to[2 * out.joints_ + slot] = static_cast<float>(q.z);
            to[3 * out.joints_ + slot] = static_cast<float>(q.w);
        }
        float* translations = to + 4 * out.joints_;
        for (const std::uint32_t slot : out.moving_) {
            const Vec3 t = frames[f].pose[packed.joint_of(slot).value].translation;
            *translations++ = static_cast<float>(t.x);
            *translations++ = static_cast<float>(t.y);
            *translations++ = static_cast<float>(t.z);
        }
    }

    const std::size_t spans = out.times_.size() - 1;
    if (spans > 0) {
        const double step = clip.duration_s / static_cast<double>(spans);
        out.even_ = true;
        for (std::size_t f = 0; f <= spans; ++f) {
            out.even_ =
                out.even_ && std::fabs(out.times_[f] - static_cast<double>(f) * step) < 1e-6 * step;
        }
        const std::size_t buckets = out.even_ ? spans : 2 * spans;
        out.per_second_ = static_cast<double>(buckets) / clip.duration_s;
        for (std::size_t b = 0, f = 0; !out.even_ && b < buckets; ++b) {
            const double begin = static_cast<double>(b) / out.per_second_;
            while (f + 1 < spans && out.times_[f + 1] <= begin) {
                ++f;
            }
            out.hint_.push_back(static_cast<std::uint32_t>(f));
        }
    }
    return out;
}

std::uint64_t PackedClip::bytes() const {
    return frames_.size() * sizeof(FloatLine) + rest_.size() * sizeof(FloatLine) +
           times_.size() * sizeof(double) + (hint_.size() + moving_.size()) * 4;
}

PackedClip::Place PackedClip::place_of(double t_s) const {
    if (times_.size() < 2) {
        return {};
    }
    const double t = clip_time(t_s, loops_, duration_s_);
    const auto last = static_cast<std::uint32_t>(times_.size() - 2);
    const double at = t * per_second_;
    if (even_) {
        const std::uint32_t frame = std::min(static_cast<std::uint32_t>(at), last);
        return {frame, static_cast<float>(at - frame)};
    }
    std::uint32_t frame = hint_[std::min(static_cast<std::size_t>(at), hint_.size() - 1)];
    while (frame < last && times_[frame + 1] <= t) {
        ++frame;
    }
    const double ratio = (t - times_[frame]) / (times_[frame + 1] - times_[frame]);
    return {frame, static_cast<float>(clamp(ratio, 0, 1))};
}

void PackedClip::prefetch(double t_s) const {
    const Place place = place_of(t_s);
    const FloatLine* from = frames_.data() + std::size_t{place.frame} * lines_per_frame_;
    for (std::uint32_t i = 0; i < 2 * lines_per_frame_ && times_.size() > 1; ++i) {
        __builtin_prefetch(from + i);
    }
}

void PackedClip::sample(double t_s, PackedPose& out, Lanes lanes) const {
    const std::size_t stride = out.stride();
    PUP_REQUIRE(stride >= joints_ && !times_.empty());
    const Place place = place_of(t_s);
    const float* a = frames_[std::size_t{place.frame} * lines_per_frame_].v;
    const float* b = times_.size() > 1 ? a + std::size_t{lines_per_frame_} * 16 : a;
    kernels(lanes).sample(a, b, place.ratio, joints_, joints_, out.component(0), stride);
    const float* rest = rest_.data()->v;
    for (int k = 0; k < 3; ++k) {
        std::copy_n(rest + k * static_cast<std::ptrdiff_t>(joints_), joints_, out.component(4 + k));
    }
    a += 4 * std::size_t{joints_};
    b += 4 * std::size_t{joints_};
    float *x = out.component(4), *y = out.component(5), *z = out.component(6);
    for (const std::uint32_t slot : moving_) {
        x[slot] = a[0] + (b[0] - a[0]) * place.ratio;
        y[slot] = a[1] + (b[1] - a[1]) * place.ratio;
        z[slot] = a[2] + (b[2] - a[2]) * place.ratio;
        a += 3;
        b += 3;
    }
}

}  // namespace puppetri::motion
