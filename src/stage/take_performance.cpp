// SPDX-License-Identifier: MIT
// The finished take as a Performance.
#include "take_performance.h"

#include <algorithm>
#include <mutex>
#include <optional>

#include "puppetri/figure/mannequin_mesh.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/figure/stick_mesh.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/gaze.h"

namespace puppetri::stage {
namespace {

const figure::Palette& palette_named(const std::string& name) {
    const figure::Palette* found = figure::find_palette(name);
    return found != nullptr ? *found : figure::palettes().front();
}

// Where the head shall turn beyond its movement at that instant.
Vec3 wanted_gaze(const Take& take, ActorIndex actor, SimTime at) {
    Vec3 target;
    if (!take.gaze_target(actor, at, target)) {
        return {};
    }
    const ActorTake& a = take.actors[actor.value];
    if (!a.figure->humanoid()) {
        return {};
    }
    motion::Controls controls;
    a.timeline.sample(at, controls);
    const Quat wanted = motion::gaze_at(*a.figure, controls, target);
    return to_rotation_vector(wanted * conjugate(controls.body.chest_from_head));
}

GazeTrack make_gaze_track(const Take& take, ActorIndex actor) {
    GazeTrack track(wanted_gaze(take, actor, SimTime{0}));
    constexpr std::int64_t kPeriod = kTicksPerSecond / GazeTrack::kRate_hz;
    for (std::int64_t t = kPeriod; t < take.end.ticks + kPeriod; t += kPeriod) {
        track.follow(wanted_gaze(take, actor, SimTime{std::min(t, take.end.ticks)}));
    }
    return track;
}

class TakePerformance final : public Performance {
 public:
    explicit TakePerformance(Take take) : take_(std::move(take)) {
        actor_meshes_.reserve(take_.actors.size());
        std::optional<std::size_t> first_mannequin;
        for (std::size_t i = 0; i < take_.actors.size(); ++i) {
            const Actor& actor = take_.cast.actors[i];
            if (actor.body == BodyKind::kCharacter) {
                actor_meshes_.emplace_back();  // it brings its own
                show_character(actor);
                continue;
            }
            const figure::Skeleton& skeleton = take_.actors[i].figure->skeleton;
            const figure::Palette& palette = palette_named(actor.palette);
            if (actor.body == BodyKind::kStick) {
                actor_meshes_.push_back(figure::make_stick_mesh(skeleton, palette));
            } else if (!first_mannequin) {
                first_mannequin = i;
                actor_meshes_.push_back(figure::make_mannequin_mesh(skeleton, palette));
            } else {  // the skin is made once
                actor_meshes_.push_back(figure::fit_mannequin_mesh(
                    actor_meshes_[*first_mannequin],
                    actor.height_m / take_.cast.actors[*first_mannequin].height_m, palette));
            }
            actor_views_.push_back(
                {actor.name, &skeleton, &actor_meshes_[i], take_.actors[i].figure->hips});
        }
        prop_meshes_.reserve(take_.props.size());
        for (std::size_t i = 0; i < take_.props.size(); ++i) {
            const Prop& prop = take_.cast.props[i];
            const figure::Palette& palette = palette_named(prop.palette);
            prop_meshes_.push_back(mesh_of(prop, palette));
            prop_views_.push_back({prop.name, prop.shape, prop.size_m, &prop_meshes_[i]});
        }
    }

    SimTime duration() const override { return take_.end; }
    std::span<const ActorView> actors() const override { return actor_views_; }
    std::span<const PropView> props() const override { return prop_views_; }
    std::span<const ScoreEntry> score() const override { return take_.score; }
    std::span<const StageEvent> events() const override { return take_.events; }

    void pose(ActorIndex actor, SimTime at, figure::Pose& out) const override {
        PUP_REQUIRE(actor.value < take_.actors.size());
        look_around();
        const Actor& who = take_.cast.actors[actor.value];
        if (who.body != BodyKind::kCharacter || !who.character->humanoid) {
            take_.pose(actor, inside(at), out);
            return;
        }
        static thread_local figure::Pose moved;  // scratch: results never depend on what it holds
        take_.pose(actor, inside(at), moved);
        who.character->carry(moved, out);
    }
    Transform world_from_prop(PropIndex prop, SimTime at) const override {
        PUP_REQUIRE(prop.value < take_.props.size());
        look_around();
        return take_.world_from_prop(prop, inside(at));
    }
    std::string holder(PropIndex prop, SimTime at) const override {
        PUP_REQUIRE(prop.value < take_.props.size());
        const Hold& hold = take_.props[prop.value].at(inside(at));
        if (hold.kind == Holding::kHands) {
            return take_.cast.actors[hold.actor.value].name + ".hands";
        }
        if (hold.kind == Holding::kOneHand) {
            return take_.cast.actors[hold.actor.value].name +
                   (hold.hand == motion::Side::kLeft ? ".left_hand" : ".right_hand");
        }
        return hold.kind == Holding::kFlight && inside(at) < hold.flight.rest() ? "air" : "floor";
    }
    motion::Phase phase(ActorIndex actor, motion::Limb limb, SimTime at) const override {
        PUP_REQUIRE(actor.value < take_.actors.size());
        return take_.actors[actor.value].timeline.phase(limb, inside(at));
    }

 private:
    static figure::Mesh mesh_of(const Prop& prop, const figure::Palette& palette) {
        switch (prop.shape) {
            case PropShape::kSphere:
                return figure::make_ball_mesh(prop.size_m.x, palette);
            case PropShape::kCylinder:
                return figure::make_cylinder_mesh(prop.size_m.x, prop.size_m.y, palette);
            case PropShape::kFork:
                return figure::make_fork_mesh(prop.size_m, palette);
            case PropShape::kBox:
                break;
        }
        return figure::make_box_mesh(prop.size_m, palette);
    }

    void show_character(const Actor& actor) {
        const figure::Character& c = *actor.character;
        actor_views_.push_back({actor.name, &c.skeleton, &c.mesh,
                                c.humanoid ? c.humanoid->rig.raw_hips : figure::JointIndex{}, &c});
    }

    // The tracks of gazes go through the whole take, which may be days long: made when the first
    // pose is asked for, so that who wants the score alone does not wait for them.
    void look_around() const {
        std::call_once(looked_, [this] {
            std::vector<GazeTrack> tracks;
            for (std::uint32_t i = 0; i < take_.actors.size(); ++i) {
                tracks.push_back(make_gaze_track(take_, ActorIndex{i}));
            }
            for (std::size_t i = 0; i < tracks.size(); ++i) {
                take_.actors[i].gaze_track = std::move(tracks[i]);
            }
        });
    }

    SimTime inside(SimTime at) const { return std::clamp(at, SimTime{0}, take_.end); }

    mutable Take take_;  // its gazes, by look_around
    mutable std::once_flag looked_;
    std::vector<figure::Mesh> actor_meshes_, prop_meshes_;
    std::vector<ActorView> actor_views_;
    std::vector<PropView> prop_views_;
};

}  // namespace

std::unique_ptr<const Performance> make_take_performance(Take take) {
    return std::make_unique<TakePerformance>(std::move(take));
}

}  // namespace puppetri::stage
