// SPDX-License-Identifier: MIT
#include "puppetri/io/take.h"

#include <algorithm>
#include <cmath>

#include "character_rest.h"
#include "held_props.h"
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
    if (performance.actors().empty() && performance.props().empty()) {
        return Unexpected(defect("nothing-to-show",
                                 "there are no figures and no props in this scene",
                                 "give it a cast; a net alone is shown by run and draw"));
    }
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

// Without the travel in the floor's plane, or without a root joint's doing at all: then what hangs
// from it carries it.
void apply_root_mode(RootMode mode, const figure::Skeleton& skeleton, bool has_hips,
                     const Transform& first_root, std::span<Transform> parent_from_joint) {
    Transform& root = parent_from_joint[0];
    if (mode == RootMode::kInPlace) {
        root.translation = first_root.translation;
    } else if (mode == RootMode::kHips && has_hips) {
        for (std::size_t j = 1; j < parent_from_joint.size(); ++j) {
            if (skeleton.joints[j].parent.value == 0) {
                parent_from_joint[j] = root * parent_from_joint[j];
            }
        }
        root = {};
    }
}

// Asks the poses of one actor and applies what the options say about its root.
class ActorSampler {
 public:
    // from_origin: the root begins at the origin.
    ActorSampler(const stage::Performance& performance, std::uint32_t actor, SimTime start,
                 bool from_origin, const TakeOptions& options)
        : performance_(performance),
          actor_(actor),
          start_(start),
          mode_(options.root),
          hips_(hips_of(performance.actors()[actor])) {
        performance.pose({actor}, start, pose_);
        PUP_REQUIRE(!pose_.parent_from_joint.empty());
        PUP_REQUIRE(pose_.parent_from_joint.size() ==
                    performance.actors()[actor].skeleton->joints.size());
        world_first_root_ = pose_.parent_from_joint[0];
        file_from_world_ = from_origin ? inverse(world_first_root_) : Transform{};
    }

    // Skeleton and mesh, no keys yet.
    TakeActor actor(const TakeOptions& options, SimTime end) {
        const stage::ActorView& view = performance_.actors()[actor_];
        TakeActor actor;
        actor.name = view.name;
        const figure::Character* character = view.character;
        const bool humanoid = character != nullptr && character->humanoid.has_value();
        actor.skeleton = *view.skeleton;
        if (options.rest && humanoid) {
            actor.skeleton = with_rest(*character, *options.rest == RestPose::kA);
        } else if (options.rest == RestPose::kA && character == nullptr) {
            actor.skeleton = with_a_pose(*view.skeleton);
        }
        actor.hips = hips_;
        if (view.mesh != nullptr) {
            const bool moved = options.rest && (humanoid || options.rest == RestPose::kA);
            actor.mesh = moved ? rebound(*view.mesh, *view.skeleton, actor.skeleton) : *view.mesh;
        }
        if (options.bone_names && humanoid) {
            name_bones(*character, actor.skeleton);
        }
        performance_.pose({actor_}, start_ + end, pose_);
        actor.root_delta = inverse(world_first_root_) * pose_.parent_from_joint[0];
        return actor;
    }

    // The pose at a time of the file. Valid until the next call.
    std::span<const Transform> sample(SimTime at) {
        performance_.pose({actor_}, start_ + at, pose_);
        pose_.parent_from_joint[0] = file_from_world_ * pose_.parent_from_joint[0];
        const stage::ActorView& view = performance_.actors()[actor_];
        apply_root_mode(mode_, *view.skeleton, hips_.valid(), file_from_world_ * world_first_root_,
                        pose_.parent_from_joint);
        return pose_.parent_from_joint;
    }

 private:
    const stage::Performance& performance_;
    std::uint32_t actor_ = 0;
    SimTime start_;
    // Who does not tell has them by their name.
    static figure::JointIndex hips_of(const stage::ActorView& view) {
        return view.hips.valid() || view.character != nullptr ? view.hips
                                                              : view.skeleton->find("hips");
    }

    RootMode mode_ = RootMode::kMotion;
    figure::JointIndex hips_;
    Transform world_first_root_, file_from_world_;
    figure::Pose pose_;
};

TakeActor sample_actor(ActorSampler& sampler, const TakeOptions& options,
                       std::span<const SimTime> times) {
    TakeActor actor = sampler.actor(options, times.back());
    actor.parent_from_joint.reserve(times.size() * actor.skeleton.joints.size());
    for (const SimTime at : times) {
        const auto pose = sampler.sample(at);
        actor.parent_from_joint.insert(actor.parent_from_joint.end(), pose.begin(), pose.end());
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

// How far a held prop may leave the hand between keys.
constexpr double kLooseProp_m = 2.5e-4;

// Adds keys at the given times, in increasing order, none of them a key yet.
void insert_keys(Take& take, std::span<const SimTime> added, std::span<ActorSampler> samplers,
                 const stage::Performance& performance, SimTime start) {
    std::vector<SimTime> times;
    std::vector<std::uint32_t> old_key;  // of each new key; kNew where it was none
    constexpr std::uint32_t kNew = ~std::uint32_t{0};
    for (std::uint32_t key = 0, next = 0; key < take.times.size(); ++key) {
        for (; next < added.size() && added[next] < take.times[key]; ++next) {
            times.push_back(added[next]);
            old_key.push_back(kNew);
        }
        times.push_back(take.times[key]);
        old_key.push_back(key);
    }
    take.times = std::move(times);
    std::uint32_t frame = 0;
    for (std::uint32_t key = 0; key < old_key.size(); ++key) {
        if (frame < take.frame_keys.size() && old_key[key] == take.frame_keys[frame]) {
            take.frame_keys[frame++] = key;
        }
    }
    for (std::size_t a = 0; a < take.actors.size(); ++a) {
        std::vector<Transform>& keys = take.actors[a].parent_from_joint;
        const std::size_t joints = take.actors[a].skeleton.joints.size();
        std::vector<Transform> all;
        all.reserve(take.times.size() * joints);
        for (std::size_t key = 0; key < old_key.size(); ++key) {
            const auto pose = old_key[key] == kNew ? samplers[a].sample(take.times[key])
                                                   : std::span<const Transform>(keys).subspan(
                                                         old_key[key] * joints, joints);
            all.insert(all.end(), pose.begin(), pose.end());
        }
        keys = std::move(all);
    }
    for (std::uint32_t p = 0; p < take.props.size(); ++p) {
        std::vector<Transform>& keys = take.props[p].world_from_prop;
        std::vector<Transform> all;
        all.reserve(take.times.size());
        for (std::size_t key = 0; key < old_key.size(); ++key) {
            all.push_back(old_key[key] == kNew
                              ? performance.world_from_prop({p}, start + take.times[key])
                              : keys[old_key[key]]);
        }
        keys = std::move(all);
    }
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
    std::vector<ActorSampler> samplers;
    for (std::uint32_t a = 0; a < performance.actors().size(); ++a) {
        samplers.emplace_back(performance, a, start, false, options);
        take.actors.push_back(sample_actor(samplers.back(), options, take.times));
    }
    for (std::uint32_t p = 0; p < performance.props().size(); ++p) {
        take.props.push_back(sample_prop(performance, p, start, take.times));
    }
    // Halving a gap quarters the error; four times are enough for any throw.
    for (int i = 0; i < 4 && options.keys_at_events; ++i) {
        const std::vector<SimTime> middles = loose_middles(take, kLooseProp_m);
        if (middles.empty()) {
            break;
        }
        insert_keys(take, middles, samplers, performance, start);
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
            ActorSampler sampler(performance, a, entry->start, true, options);
            take.actors.push_back(sample_actor(sampler, options, take.times));
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
