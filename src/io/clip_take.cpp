// SPDX-License-Identifier: MIT
#include "clip_take.h"

#include <algorithm>
#include <cmath>

#include "puppetri/figure/palette.h"
#include "puppetri/figure/stick_mesh.h"

namespace puppetri::io {
namespace {

constexpr double kUsualRate_hz = 60;
constexpr double kMostTransforms = 1e7;
constexpr double kJump_s = 1e-5;  // what a step takes in a file that knows straight lines only

// The rate as people name it, where it is one of those within 1e-5 (0.0083333 s are 120 frames).
FrameRate named_rate(double hz) {
    for (const std::int64_t denominator : {1, 1001}) {
        const double over = denominator == 1 ? 1 : 1001.0 / 1000;
        const double whole = std::nearbyint(hz * over);
        if (whole >= 1 && whole < 1e6 && std::fabs(hz * over / whole - 1) < 1e-5) {
            return denominator == 1 ? FrameRate{static_cast<std::int64_t>(whole), 1}
                                    : FrameRate{static_cast<std::int64_t>(whole) * 1000, 1001};
        }
    }
    return {static_cast<std::int64_t>(std::nearbyint(std::min(hz, 1e5) * 1e3)), 1000};
}

SimTime sim_time(double t_s) {
    return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
}

// The instants of all keys, and whether straight lines between them are the clip.
struct OwnKeys {
    std::vector<double> times;
    bool straight = true;
};
OwnKeys own_keys(const motion::Clip& clip) {
    OwnKeys own;
    const auto add = [&](const auto& tracks) {
        for (const auto& track : tracks) {
            for (std::size_t k = 0; k < track.keys.size(); ++k) {
                const auto& key = track.keys[k];
                own.times.push_back(key.t_s);
                if (k + 1 == track.keys.size()) {
                    continue;
                }
                if (key.interpolation == motion::Interpolation::kStep) {
                    own.times.push_back(std::max(track.keys[k + 1].t_s - kJump_s, key.t_s));
                } else if (key.interpolation != motion::Interpolation::kLinear) {
                    own.straight = false;
                }
            }
        }
    };
    add(clip.rotations);
    add(clip.translations);
    add(clip.numbers);
    own.straight = own.straight && clip.numbers.empty();
    return own;
}

}  // namespace

Checked<Take> take_of(const motion::Clip& clip, const figure::Skeleton& skeleton,
                      const figure::DofSet* dofs, const ClipTakeOptions& options) {
    const double hz = options.rate_hz > 0          ? options.rate_hz
                      : options.source_frame_s > 0 ? 1 / options.source_frame_s
                                                   : kUsualRate_hz;
    // Frames of the source are met exactly, whatever its rate is called.
    const double step_s =
        options.rate_hz > 0 || options.source_frame_s <= 0 ? 1 / hz : options.source_frame_s;
    Take take;
    take.name = clip.name;
    take.rate = named_rate(hz);
    const double frames = std::floor(clip.duration_s / step_s + 1e-6) + 1;
    const std::size_t joints = std::max<std::size_t>(skeleton.joints.size(), 1);
    OwnKeys own;
    if (options.own_keys) {
        own = own_keys(clip);
    }
    if ((frames + static_cast<double>(own.times.size())) * static_cast<double>(joints) >
        kMostTransforms) {
        return Unexpected(Diagnostics{{Severity::kError,
                                       "too-large",
                                       {},
                                       "clip " + clip.name,
                                       "it has too many frames to be written",
                                       "cut it, or ask for fewer frames with --fps"}});
    }
    take.frame_count = static_cast<std::int64_t>(frames);

    // Instants with where they come from: equal ones are one key.
    struct Instant {
        double t_s = 0;
        bool frame = false;
    };
    std::vector<Instant> instants;
    const bool own_only =
        options.own_keys && own.straight && options.rate_hz <= 0 && options.source_frame_s <= 0;
    for (double f = 0; f < frames && !own_only; ++f) {
        instants.push_back({std::min(f * step_s, clip.duration_s), true});
    }
    for (const double t : own.times) {
        instants.push_back({t, false});
    }
    instants.push_back({0, false});
    if (options.own_keys) {
        instants.push_back({clip.duration_s, false});
    }
    std::stable_sort(instants.begin(), instants.end(),
                     [](const Instant& a, const Instant& b) { return a.t_s < b.t_s; });

    TakeActor actor;
    actor.skeleton = skeleton;
    actor.mesh = figure::make_stick_mesh(skeleton, figure::palettes()[0]);
    const motion::ClipBinding binding = motion::bind_clip(clip, skeleton, dofs);
    const figure::Pose rest = figure::rest_pose(skeleton);
    figure::Pose pose = rest;
    const bool snap = std::fabs(take.rate.per_second() * step_s - 1) < 1e-4;
    std::int64_t frame = 0;
    for (const Instant& instant : instants) {
        // Of frames the file says where its rate puts them.
        const SimTime at = instant.frame && snap ? take.rate.time_of(frame) : sim_time(instant.t_s);
        const bool again =
            !take.times.empty() && at.ticks - take.times.back().ticks < kTicksPerSecond / 1'000'000;
        if (!again) {
            take.times.push_back(at);
            pose = rest;
            motion::sample_clip(clip, binding, instant.t_s, pose);
            actor.parent_from_joint.insert(actor.parent_from_joint.end(),
                                           pose.parent_from_joint.begin(),
                                           pose.parent_from_joint.end());
        }
        if (instant.frame) {
            ++frame;
            take.frame_keys.push_back(static_cast<std::uint32_t>(take.times.size() - 1));
        }
    }
    for (const motion::ClipMark& mark : clip.marks) {
        const SimTime at = sim_time(mark.t_s);
        take.events.push_back({at, take.rate.nearest_frame(at), mark.name, "", mark.target, ""});
    }
    if (!clip.root.empty()) {
        const Transform travel = motion::root_travel(clip, clip.duration_s);
        actor.root_delta = travel;
    }
    take.actors.push_back(std::move(actor));
    return take;
}

}  // namespace puppetri::io
