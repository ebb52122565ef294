// SPDX-License-Identifier: MIT
#include "period.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

constexpr double kSamePose_m = 0.02;

// What goes on at an instant, without the pose: equal moments are candidates for the ends of a
// period.
struct Moment {
    SimTime at;
    std::string doing;
};

std::string what_goes_on(const stage::Performance& performance, SimTime at) {
    std::vector<std::string> lines;
    for (const stage::ScoreEntry& entry : performance.score()) {
        const SimTime left = entry.left == SimTime::never() ? performance.duration() : entry.left;
        if (entry.start <= at && at < left) {
            lines.push_back(entry.actor + '|' + entry.place + '|' + entry.movement + '|' +
                            entry.prop + '|' + std::to_string((at - entry.start).ticks));
        }
    }
    const auto props = static_cast<std::uint32_t>(performance.props().size());
    for (std::uint32_t p = 0; p < props; ++p) {
        lines.push_back(performance.holder({p}, at));
    }
    std::sort(lines.begin(), lines.end());
    std::string all;
    for (const std::string& line : lines) {
        all += line + '\n';
    }
    return all;
}

// The positions of all joints of all actors, each seen from the actor's root.
std::vector<Vec3> positions_from_root(const stage::Performance& performance, SimTime at) {
    std::vector<Vec3> positions;
    figure::Pose pose;
    std::vector<Transform> world_from_joint;
    const auto actors = performance.actors();
    for (std::uint32_t a = 0; a < actors.size(); ++a) {
        performance.pose({a}, at, pose);
        world_from_joint.resize(pose.parent_from_joint.size());
        figure::to_model_space(*actors[a].skeleton, pose, world_from_joint);
        const Transform root_from_world = inverse(world_from_joint.front());
        for (const Transform& joint : world_from_joint) {
            positions.push_back(root_from_world * joint.translation);
        }
    }
    return positions;
}

bool near(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](Vec3 p, Vec3 q) { return length(p - q) <= kSamePose_m; });
}

}  // namespace

std::optional<FrameRange> find_period(const stage::Performance& performance, FrameRate rate,
                                      FrameRange range) {
    const SimTime first = rate.time_of(range.first), last = rate.time_of(range.last);
    std::vector<Moment> moments;
    for (const stage::ScoreEntry& entry : performance.score()) {
        const bool repeated = !moments.empty() && moments.back().at == entry.start;
        if (first <= entry.start && entry.start <= last && !entry.actor.empty() && !repeated) {
            moments.push_back({entry.start, what_goes_on(performance, entry.start)});
        }
    }
    for (std::size_t i = 0; i < moments.size(); ++i) {
        std::vector<Vec3> beginning;
        for (std::size_t j = i + 1; j < moments.size(); ++j) {
            const std::int64_t frames = rate.nearest_frame(moments[j].at - moments[i].at);
            if (frames == 0 || moments[j].doing != moments[i].doing) {
                continue;
            }
            if (beginning.empty()) {
                beginning = positions_from_root(performance, moments[i].at);
            }
            const FrameRange period{rate.nearest_frame(moments[i].at),
                                    rate.nearest_frame(moments[i].at) + frames};
            if (period.last <= range.last &&
                near(beginning, positions_from_root(performance, moments[j].at))) {
                return period;
            }
        }
    }
    return std::nullopt;
}

void close_loop(Take& take) {
    const std::size_t last = take.times.size() - 1;
    for (TakeActor& actor : take.actors) {
        const std::size_t joints = actor.skeleton.joints.size();
        for (std::size_t j = 1; j < joints; ++j) {
            const Transform begin = actor.parent_from_joint[j];
            const Transform end = actor.parent_from_joint[last * joints + j];
            const Vec3 turn = to_rotation_vector(conjugate(end.rotation) * begin.rotation);
            const Vec3 shift = begin.translation - end.translation;
            for (std::size_t key = 1; key < last; ++key) {
                const double s = take.times[key].seconds() / take.times[last].seconds();
                const double w = s * s * (3 - 2 * s);
                Transform& at = actor.parent_from_joint[key * joints + j];
                at.rotation = at.rotation * from_rotation_vector(turn * w);
                at.translation = at.translation + shift * w;
            }
            actor.parent_from_joint[last * joints + j] = begin;
        }
    }
}

}  // namespace puppetri::io
