// SPDX-License-Identifier: MIT
#include "puppetri/io/take.h"

#include <algorithm>
#include <cmath>

#include "period.h"
#include "rest_pose.h"

namespace puppetri::io {
namespace {

Diagnostics defect(std::string code, std::string message, std::string remedy) {
    Diagnostic d;
    d.code = std::move(code);
    d.element = "take";
    d.message = std::move(message);
    d.remedy = std::move(remedy);
    return {std::move(d)};
}

Checked<FrameRange> checked_range(const stage::Performance& performance,
                                  const TakeOptions& options) {
    const double rate = options.rate.per_second();
    if (rate < kLowestExportRate || rate > kHighestExportRate) {
        return Unexpected(
            defect("bad-rate",
                   "files have 23.976 to 120 frames per second, not " + to_string(options.rate),
                   "choose a rate in that range with --fps"));
    }
    const FrameRange all{0, options.rate.frame_at_or_before(performance.duration())};
    const FrameRange asked = options.frames.value_or(all);
    if (asked.first < 0 || asked.last < asked.first || asked.last > all.last) {
        return Unexpected(defect("bad-range",
                                 "frames " + std::to_string(asked.first) + "-" +
                                     std::to_string(asked.last) + " are not in the performance",
                                 "it has frames 0-" + std::to_string(all.last) + " at " +
                                     to_string(options.rate) + " per second"));
    }
    if (options.handles_frames < 0) {
        return Unexpected(defect("bad-range", "handles cannot be negative",
                                 "give a number of frames, or leave it out"));
    }
    return asked;
}

// Keys of the file: frames, and events within where asked for; a key is dropped that a float could
// not tell from its neighbour, events before frames.
struct Key {
    SimTime at;
    bool frame = false;
};

std::vector<Key> keys_of(const stage::Performance& performance, SimTime start,
                         std::vector<Key> frames, bool at_events) {
    const SimTime end = frames.back().at;
    std::vector<Key> keys = std::move(frames);
    if (at_events) {
        for (const stage::StageEvent& event : performance.events()) {
            if (start <= event.at && event.at - start <= end) {
                keys.push_back({event.at - start, false});
            }
        }
        std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
            return a.at != b.at ? a.at < b.at : a.frame > b.frame;
        });
    }
    std::vector<Key> distinct;
    for (const Key& key : keys) {
        const bool same = !distinct.empty() && static_cast<float>(distinct.back().at.seconds()) >=
                                                   static_cast<float>(key.at.seconds());
        if (!same) {
            distinct.push_back(key);
        } else if (key.frame) {
            distinct.back() = key;
        }
    }
    return distinct;
}

// Without the travel in the floor's plane, or without a root joint's doing at all.
void apply_root_mode(RootMode mode, figure::JointIndex hips, const Transform& first_root,
                     std::span<Transform> parent_from_joint) {
    Transform& root = parent_from_joint[0];
    if (mode == RootMode::kInPlace) {
        root.translation = first_root.translation;
    } else if (mode == RootMode::kHips && hips.valid()) {
        Transform& parent_from_hips = parent_from_joint[hips.value];
        parent_from_hips = root * parent_from_hips;
        root = {};
    }
}

struct ActorPlan {
    std::uint32_t actor = 0;
    bool from_origin = false;  // begins with the root at the origin
};

TakeActor sample_actor(const stage::Performance& performance, const ActorPlan& plan, SimTime start,
                       std::span<const SimTime> times, const TakeOptions& options) {
    const stage::ActorView& view = performance.actors()[plan.actor];
    TakeActor actor;
    actor.name = view.name;
    actor.skeleton = options.rest == RestPose::kA ? with_a_pose(*view.skeleton) : *view.skeleton;
    if (view.mesh != nullptr) {
        actor.mesh = options.rest == RestPose::kA
                         ? rebound(*view.mesh, *view.skeleton, actor.skeleton)
                         : *view.mesh;
    }
    const std::size_t joints = actor.skeleton.joints.size();
    PUP_REQUIRE(joints > 0);
    const figure::JointIndex hips = actor.skeleton.find("hips");
    actor.parent_from_joint.resize(times.size() * joints);
    figure::Pose pose;
    Transform first_root, origin_from_world;
    for (std::size_t key = 0; key < times.size(); ++key) {
        performance.pose({plan.actor}, start + times[key], pose);
        PUP_REQUIRE(pose.parent_from_joint.size() == joints);
        if (key == 0) {
            first_root = pose.parent_from_joint[0];
            origin_from_world = plan.from_origin ? inverse(first_root) : Transform{};
        }
        if (key + 1 == times.size()) {
            actor.root_delta = inverse(first_root) * pose.parent_from_joint[0];
        }
        pose.parent_from_joint[0] = origin_from_world * pose.parent_from_joint[0];
        apply_root_mode(options.root, hips, origin_from_world * first_root, pose.parent_from_joint);
        std::copy(pose.parent_from_joint.begin(), pose.parent_from_joint.end(),
                  actor.parent_from_joint.begin() + static_cast<std::ptrdiff_t>(key * joints));
    }
    return actor;
}

TakeProp sample_prop(const stage::Performance& performance, std::uint32_t prop, SimTime start,
                     std::span<const SimTime> times) {
    const stage::PropView& view = performance.props()[prop];
    TakeProp result;
    result.name = view.name;
    result.mesh = view.mesh;
    for (const SimTime at : times) {
        result.world_from_prop.push_back(performance.world_from_prop({prop}, start + at));
        std::string holder = performance.holder({prop}, start + at);
        if (result.holders.empty() || result.holders.back().holder != holder) {
            result.holders.push_back({at, std::move(holder)});
        }
    }
    return result;
}

// Keys, events and frames of the take; `only` keeps the events of one actor.
void fill_times(Take& take, const stage::Performance& performance, SimTime start,
                std::vector<Key> frames, bool at_events, const std::string& only) {
    const SimTime end = frames.back().at;
    for (const Key& key : keys_of(performance, start, std::move(frames), at_events)) {
        if (key.frame) {
            take.frame_keys.push_back(static_cast<std::uint32_t>(take.times.size()));
        }
        take.times.push_back(key.at);
    }
    take.frame_count = static_cast<std::int64_t>(take.frame_keys.size());
    for (const stage::StageEvent& event : performance.events()) {
        if (start <= event.at && event.at - start <= end && (only.empty() || event.actor == only)) {
            const SimTime at = event.at - start;
            take.events.push_back(
                {at, take.rate.nearest_frame(at), event.name, event.actor, event.limb, event.prop});
        }
    }
}

}  // namespace

Checked<Take> sample_take(const stage::Performance& performance, const TakeOptions& options) {
    PUP_TRY(FrameRange range, checked_range(performance, options));
    const std::int64_t last = options.rate.frame_at_or_before(performance.duration());
    Take take;
    take.rate = options.rate;
    take.loop = options.loop;
    if (options.loop) {
        const std::optional<FrameRange> period = find_period(performance, options.rate, range);
        if (!period) {
            return Unexpected(defect("no-period", "nothing in these frames repeats itself",
                                     "export a longer stretch, or leave --loop out"));
        }
        range = *period;
    } else {
        take.handle_before = std::min(options.handles_frames, range.first);
        take.handle_after = std::min(options.handles_frames, last - range.last);
        range = {range.first - take.handle_before, range.last + take.handle_after};
    }
    take.first_frame = range.first;
    const SimTime start = take.rate.time_of(range.first);
    std::vector<Key> frames;
    for (std::int64_t frame = range.first; frame <= range.last; ++frame) {
        frames.push_back({take.rate.time_of(frame) - start, true});
    }
    fill_times(take, performance, start, std::move(frames), options.keys_at_events, "");
    for (std::uint32_t a = 0; a < performance.actors().size(); ++a) {
        take.actors.push_back(sample_actor(performance, {a, false}, start, take.times, options));
    }
    for (std::uint32_t p = 0; p < performance.props().size(); ++p) {
        take.props.push_back(sample_prop(performance, p, start, take.times));
    }
    if (options.loop) {
        close_loop(take);
    }
    return take;
}

Checked<std::vector<Take>> sample_clips(const stage::Performance& performance,
                                        const TakeOptions& options) {
    PUP_TRY(const FrameRange range, checked_range(performance, options));
    const SimTime begin = options.rate.time_of(range.first), end = options.rate.time_of(range.last);
    std::vector<Take> clips;
    const auto actors = performance.actors();
    for (std::uint32_t a = 0; a < actors.size(); ++a) {
        std::vector<const stage::ScoreEntry*> chosen;  // the first of each place
        for (const stage::ScoreEntry& entry : performance.score()) {
            const bool inside = begin <= entry.start && entry.start < entry.end && entry.end <= end;
            const bool known = std::any_of(
                chosen.begin(), chosen.end(),
                [&](const stage::ScoreEntry* other) { return other->place == entry.place; });
            if (entry.actor == actors[a].name && inside && !known) {
                chosen.push_back(&entry);
            }
        }
        for (const stage::ScoreEntry* entry : chosen) {
            const auto alike = [&](auto same_place) {
                return std::count_if(
                    chosen.begin(), chosen.end(), [&](const stage::ScoreEntry* other) {
                        return other->movement == entry->movement && same_place(other->place);
                    });
            };
            Take take;
            take.rate = options.rate;
            take.name = actors[a].name + "_" + entry->movement;
            if (alike([](const std::string&) { return true; }) > 1) {
                const std::string_view place = last_part(entry->place);
                const bool clear =
                    alike([&](const std::string& p) { return last_part(p) == place; }) == 1;
                take.name += "_" + (clear ? std::string(place) : entry->place);
            }
            take.name = node_name(take.name);
            take.first_frame = options.rate.nearest_frame(entry->start);
            const SimTime duration = entry->end - entry->start;
            std::vector<Key> frames;
            for (std::int64_t k = 0; options.rate.time_of(k) <= duration; ++k) {
                frames.push_back({options.rate.time_of(k), true});
            }
            if (frames.back().at < duration) {
                frames.push_back({duration, false});
            }
            fill_times(take, performance, entry->start, std::move(frames), options.keys_at_events,
                       actors[a].name);
            take.actors.push_back(
                sample_actor(performance, {a, true}, entry->start, take.times, options));
            clips.push_back(std::move(take));
        }
    }
    if (clips.empty()) {
        return Unexpected(defect("bad-range", "no movement begins and ends within these frames",
                                 "export a longer stretch, or leave --clips out"));
    }
    return clips;
}

}  // namespace puppetri::io
