// SPDX-License-Identifier: MIT
#include "puppetri/motion/walk_cycle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "clip_root.h"
#include "puppetri/motion/clip_edit.h"

namespace puppetri::motion {
namespace {

constexpr double kStep_s = 1.0 / 120;  // of looking
constexpr double kAround_s = 0.1;      // ends of a stride are tried within this of the landings
constexpr double kVelocityWeight_s = 0.1;

Unexpected<Diagnostics> failure(const char* code, std::string element, std::string message,
                                std::string remedy) {
    return Unexpected(Diagnostics{
        {Severity::kError, code, {}, std::move(element), std::move(message), std::move(remedy)}});
}

// Places of all joints in the world, every kStep_s.
class Places {
 public:
    Places(const Clip& clip, const figure::Skeleton& skeleton) : joints_(skeleton.joints.size()) {
        const ClipBinding binding = bind_clip(clip, skeleton);
        const figure::Pose rest = figure::rest_pose(skeleton);
        figure::Pose pose = rest;
        std::vector<Transform> model(joints_);
        for (std::size_t k = 0; static_cast<double>(k) * kStep_s <= clip.duration_s + 1e-9; ++k) {
            pose = rest;
            sample_clip(clip, binding, static_cast<double>(k) * kStep_s, pose);
            figure::to_model_space(skeleton, pose, model);
            for (const Transform& t : model) {
                places_.push_back(t.translation);
            }
        }
    }
    std::size_t count() const { return places_.size() / std::max<std::size_t>(joints_, 1); }
    std::size_t joints() const { return joints_; }
    Vec3 at(std::size_t k, std::size_t joint) const { return places_[k * joints_ + joint]; }
    Vec3 velocity(std::size_t k, std::size_t joint) const {
        const std::size_t a = k > 0 ? k - 1 : 0, b = std::min(k + 1, count() - 1);
        return (at(b, joint) - at(a, joint)) *
               (1 / (static_cast<double>(std::max<std::size_t>(b - a, 1)) * kStep_s));
    }

 private:
    std::size_t joints_;
    std::vector<Vec3> places_;
};

std::vector<ClipMark> contacts_of(const Places& places, const figure::Skeleton& skeleton,
                                  const FootJoints& foot, const ContactThresholds& limits) {
    std::vector<std::size_t> points;
    for (const std::string& name : {foot.foot, foot.toes}) {
        if (const figure::JointIndex j = skeleton.find(name); j.valid()) {
            points.push_back(j.value);
        }
    }
    std::vector<ClipMark> marks;
    const std::size_t n = places.count();
    if (points.empty() || n < 2) {
        return marks;
    }
    std::vector<double> floor;
    for (const std::size_t p : points) {
        std::vector<double> heights;
        for (std::size_t k = 0; k < n; ++k) {
            heights.push_back(places.at(k, p).y);
        }
        const auto low = heights.begin() + static_cast<std::ptrdiff_t>(n / 20);
        std::nth_element(heights.begin(), low, heights.end());
        floor.push_back(*low);
    }
    bool stands = false;
    std::vector<char> down(n, 0);
    for (std::size_t k = 0; k < n; ++k) {
        bool lands = false, stays = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double height = places.at(k, points[i]).y - floor[i];
            const double speed = length(places.velocity(k, points[i]));
            lands = lands || (height < limits.low_m && speed < limits.slow_m_s);
            stays = stays || (height < limits.high_m && speed < limits.fast_m_s);
        }
        stands = stands ? stays : lands;
        down[k] = stands;
    }
    // Spans, then gaps, that are too short to be true.
    const auto shortest = static_cast<std::size_t>(std::max(limits.shortest_s / kStep_s, 1.0));
    for (const char value : {char{0}, char{1}}) {  // gaps first: they split contacts
        for (std::size_t begin = 0; begin < n;) {
            std::size_t end = begin;
            while (end < n && down[end] == down[begin]) {
                ++end;
            }
            if (down[begin] == value && end - begin < shortest && begin > 0 && end < n) {
                std::fill(down.begin() + static_cast<std::ptrdiff_t>(begin),
                          down.begin() + static_cast<std::ptrdiff_t>(end),
                          static_cast<char>(1 - value));
            }
            begin = end;
        }
    }
    for (std::size_t begin = 0; begin < n;) {
        std::size_t end = begin;
        while (end < n && down[end] == down[begin]) {
            ++end;
        }
        if (down[begin]) {
            marks.push_back({static_cast<double>(begin) * kStep_s,
                             static_cast<double>(end - 1) * kStep_s, "contact", foot.foot});
        }
        begin = end;
    }
    return marks;
}

// Where the root stands and looks at sample k: its place, and the way that it goes within the
// stride, which is steadier than where the hips look.
struct Frame {
    Vec3 origin;
    Quat to_path;  // turns the world so that the path goes along +Z
};

// The mean distance of the joints of two instants, velocities weighed in, each seen from the root.
double distance(const Places& places, std::size_t a, const Frame& fa, std::size_t b,
                const Frame& fb) {
    double sum = 0;
    for (std::size_t j = 0; j < places.joints(); ++j) {
        const Vec3 pa = rotate(fa.to_path, places.at(a, j) - fa.origin);
        const Vec3 pb = rotate(fb.to_path, places.at(b, j) - fb.origin);
        const Vec3 va = rotate(fa.to_path, places.velocity(a, j));
        const Vec3 vb = rotate(fb.to_path, places.velocity(b, j));
        sum += length(pa - pb) + kVelocityWeight_s * length(va - vb);
    }
    return sum / static_cast<double>(places.joints());
}

// Turns the root's path and heading by an angle that grows evenly from 0 to -turn over the clip, so
// that a stride that bends goes straight. Keys become linear and dense enough.
void straighten(Clip& clip, double turn_rad) {
    const double rate = -turn_rad / clip.duration_s;
    const auto own = resampled(clip, 120);
    for (VectorTrack& track : clip.translations) {
        if (track.target != clip.root) {
            continue;
        }
        const VectorTrack& from = *own.find_translation(clip.root);
        Vec3 at = from.keys.front().value;
        track.keys = {from.keys.front()};
        for (std::size_t k = 1; k < from.keys.size(); ++k) {
            const double middle_s = (from.keys[k - 1].t_s + from.keys[k].t_s) / 2;
            const Vec3 step = from.keys[k].value - from.keys[k - 1].value;
            at = at + rotate(about_y(rate * middle_s), step);
            VectorKey key = from.keys[k];
            key.value = {at.x, from.keys[k].value.y, at.z};
            track.keys.push_back(key);
        }
    }
    for (RotationTrack& track : clip.rotations) {
        if (track.target != clip.root) {
            continue;
        }
        track.keys = own.find_rotation(clip.root)->keys;
        for (RotationKey& key : track.keys) {
            key.value = about_y(rate * key.t_s) * key.value;
        }
    }
}

}  // namespace

std::vector<ClipMark> find_contacts(const Clip& clip, const figure::Skeleton& skeleton,
                                    const FootJoints& foot, const ContactThresholds& thresholds) {
    return contacts_of(Places(clip, skeleton), skeleton, foot, thresholds);
}

Checked<WalkCycle> cut_walk_cycle(const Clip& clip, const figure::Skeleton& skeleton,
                                  const std::array<FootJoints, 2>& feet,
                                  const CycleOptions& options) {
    const figure::JointIndex root = skeleton.find(clip.root);
    if (!root.valid() || clip.find_translation(clip.root) == nullptr) {
        return failure("no-root", "clip " + clip.name, "it has no joint that travels",
                       "name the root: a joint with a translation track");
    }
    for (const FootJoints& foot : feet) {
        if (!skeleton.find(foot.foot).valid()) {
            return failure("no-foot", "joint " + foot.foot, "the figure has no such joint",
                           "name the joints of both feet");
        }
    }
    const Places places(clip, skeleton);
    std::array<std::vector<ClipMark>, 2> contacts;
    for (std::size_t side = 0; side < 2; ++side) {
        contacts[side] = contacts_of(places, skeleton, feet[side], options.contacts);
    }
    const double first_s = std::max(options.begin_s, 0.0),
                 last_s = std::min(options.end_s, clip.duration_s);

    // The best pair of ends near two landings of the left foot, one after the other.
    struct Best {
        std::size_t begin = 0, end = 0;
        double distance = std::numeric_limits<double>::infinity();
    };
    std::optional<Best> best;
    const std::vector<ClipMark>& left = contacts[0];
    for (std::size_t i = 0; i + 1 < left.size(); ++i) {
        const double begin_s = left[i].t_s, end_s = left[i + 1].t_s;
        const double margin = 0.2 * (end_s - begin_s);
        const bool between =
            !options.alternating ||
            std::any_of(contacts[1].begin(), contacts[1].end(), [&](const ClipMark& m) {
                return m.t_s > begin_s + margin && m.t_s < end_s - margin;
            });
        if (begin_s <= 0 || begin_s < first_s || end_s > last_s ||
            end_s - begin_s < options.shortest_s || end_s - begin_s > options.longest_s ||
            !between) {
            continue;
        }
        const auto index = [&](double t) {
            return static_cast<std::ptrdiff_t>(std::nearbyint(t / kStep_s));
        };
        const auto around = index(kAround_s);
        const auto count = static_cast<std::ptrdiff_t>(places.count());
        const auto a = index(begin_s);
        for (std::ptrdiff_t b = index(end_s) - around; b <= index(end_s) + around; ++b) {
            if (b <= a || b >= count || static_cast<double>(b) * kStep_s > last_s) {
                continue;
            }
            const auto ua = static_cast<std::size_t>(a), ub = static_cast<std::size_t>(b);
            const auto frame = [&](std::size_t k) {
                const Vec3 p = places.at(k, root.value);
                return Frame{{p.x, 0, p.z}, {}};
            };
            Frame fa = frame(ua), fb = frame(ub);
            // Both ends are turned alike but for the turn of the stride.
            const Transform pa = planar_root(clip, static_cast<double>(ua) * kStep_s),
                            pb = planar_root(clip, static_cast<double>(ub) * kStep_s);
            fa.to_path = conjugate(pa.rotation);
            fb.to_path = conjugate(pb.rotation);
            const double d = distance(places, ua, fa, ub, fb);
            if (!best || d < best->distance) {
                best = {ua, ub, d};
            }
        }
    }
    if (!best) {
        return failure("no-stride", "clip " + clip.name,
                       "no stride was found: the left foot (" + feet[0].foot + ") landed " +
                           std::to_string(left.size()) + " times, the right foot " +
                           std::to_string(contacts[1].size()) +
                           (options.alternating ? " times, never well in between" : " times"),
                       "check the scale, look elsewhere in the take, or ask for hops");
    }

    if (best->distance > options.worst_mismatch_m) {
        return failure("no-stride", "clip " + clip.name,
                       "no stride repeats: even the best one's ends are " +
                           std::to_string(std::lround(1000 * best->distance)) + " mm apart",
                       "look elsewhere in the take, or ask for hops");
    }
    const double begin_s = static_cast<double>(best->begin) * kStep_s,
                 end_s = static_cast<double>(best->end) * kStep_s;
    Clip source = clip;
    source.marks.clear();
    for (const std::vector<ClipMark>& side : contacts) {
        for (const ClipMark& mark : side) {
            if (mark.end_s > begin_s + kStep_s && mark.t_s < end_s - kStep_s) {
                source.marks.push_back(mark);
                if (mark.t_s >= begin_s && mark.t_s < end_s) {
                    source.marks.push_back({mark.t_s, mark.t_s, "foot_strike", mark.target});
                }
            }
        }
    }
    std::stable_sort(source.marks.begin(), source.marks.end(),
                     [](const ClipMark& a, const ClipMark& b) { return a.t_s < b.t_s; });
    WalkCycle out;
    out.begin_s = begin_s;
    out.mismatch_m = best->distance;
    out.clip = copied(source, begin_s, end_s);
    Clip& cycle = out.clip;
    cycle.root = clip.root;

    const double turn = turn_between(heading_of(planar_root(cycle, 0).rotation),
                                     heading_of(planar_root(cycle, cycle.duration_s).rotation));
    if (options.straight && std::fabs(turn) < radians(30)) {
        straighten(cycle, turn);
    }
    cycle = closed(cycle, clamp(options.blend_s, 1e-3, cycle.duration_s));
    // From the origin along +Z.
    const Transform from = planar_root(cycle, 0), to = planar_root(cycle, cycle.duration_s);
    const Vec3 way = to.translation - from.translation;
    out.travel_m = length(way);
    const double heading = out.travel_m > 0.05 ? heading_of(way) : heading_of(from.rotation);
    const Quat turned = about_y(-heading);
    carry_root(cycle, {turned, rotate(turned, -from.translation)});
    double stood = 0;
    for (const ClipMark& mark : cycle.marks) {
        if (mark.name == "contact") {
            stood += mark.end_s - mark.t_s;
        }
    }
    out.duty_factor = stood / (2 * cycle.duration_s);
    return out;
}

}  // namespace puppetri::motion
