// SPDX-License-Identifier: MIT
// The movement host. Within one instant the net first takes tokens and then gives new ones, several
// times over; what a movement is prepared from is always the state just before the instant, so that
// the order inside it does not matter. What can be known only when the instant is over (a limb that
// nobody took, two movements on one limb, a ball that was let go without a flight) is settled when
// time advances.
#include "puppetri/stage/stage.h"

#include <algorithm>

#include "puppetri/base/hash.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/library.h"
#include "puppetri/motion/turn.h"
#include "take.h"
#include "take_performance.h"

namespace puppetri::stage {
namespace {

using motion::Controls;
using motion::Limb;
using motion::LimbSet;
using motion::MotionContext;
using motion::MovementPtr;
using motion::SubjectKind;

constexpr SimTime kMoment{kTicksPerSecond / 10'000};  // over which rates are taken
constexpr double kFastFlight_m_s = 9, kFarFlight_m = 6;

// One performance of an action.
struct Activity {
    net::ActionIndex action;
    SimTime start, left = SimTime::never();
    bool cut = false;
    MovementPtr movement;  // null for a prop's
    ActorIndex actor;
    PropIndex releases;   // at its end, unless it is cut before
    std::size_t row = 0;  // of the score
};

// The six charges of an actor as one movement, for what goes on below a movement that the stage
// adds.
class Goes final : public motion::Movement {
 public:
    Goes(const ActorTimeline& timeline, SimTime at) : start_(at) {
        limbs = motion::kAllLimbs;
        for (int i = 0; i < motion::kLimbCount; ++i) {
            const Limb limb = static_cast<Limb>(i);
            Charge charge = timeline.in_charge(limb, at);
            charge.from = SimTime{-1};
            timeline_.take(motion::limb_set(limb), charge);
        }
    }
    void sample(double t_s, Controls& out) const override {
        timeline_.sample(start_ + SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, out);
    }

 private:
    SimTime start_;
    ActorTimeline timeline_;
};

}  // namespace

struct Stage::Data {
    Play play;
    Take take;
    SimTime now{-1};
    std::vector<Activity> activities;
    std::vector<net::RaisedEvent> raised;
    std::uint32_t raised_by = ~0u;
    Diagnostics diagnostics;

    // To be settled when time advances.
    struct Overlap {
        std::uint32_t first, second;
    };
    std::vector<Overlap> overlaps;
    std::vector<std::uint32_t> cuts;  // activities that were cut at `now`
    struct Release {
        SimTime at;
        std::uint32_t activity;
    };
    std::vector<Release> releases;

    // Per actor, for the surroundings.
    struct Waiting {
        PropIndex prop;
        Vec3 at_world;
        std::uint32_t owner = ~0u;
    };
    std::vector<Waiting> waiting;

    explicit Data(Play p) : play(std::move(p)) {
        PUP_REQUIRE(!has_errors(check(play.cast)));
        take.cast = play.cast;
        waiting.resize(play.cast.actors.size());
        for (std::uint32_t i = 0; i < play.cast.actors.size(); ++i) {
            place_actor(ActorIndex{i});
        }
        for (std::uint32_t i = 0; i < play.cast.props.size(); ++i) {
            place_prop(PropIndex{i});
        }
    }

    // ---- the beginning ----

    PropIndex initially_held_by(ActorIndex actor) const {
        for (std::uint32_t i = 0; i < play.cast.props.size(); ++i) {
            if (play.cast.props[i].held_by == actor) {
                return PropIndex{i};
            }
        }
        return {};
    }

    void place_actor(ActorIndex index) {
        const Actor& actor = play.cast.actors[index.value];
        ActorTake made;
        made.figure = std::make_unique<figure::Figure>(figure::make_mannequin(actor.height_m));
        const figure::Figure& figure = *made.figure;
        MotionContext context{
            figure,      motion::standing(figure, actor.position_world, actor.heading_rad),
            {},          SimTime{0},
            SimTime{-1}, seed(index)};
        const PropIndex held = initially_held_by(index);
        LimbSet idle = motion::kAllLimbs;
        if (held.valid()) {
            const double radius = take.radius(held);
            motion::lay_hands(figure, motion::carried_ball_chest(figure, radius), radius, 0,
                              context.now);
            idle = motion::without(idle, motion::kBothArms);
            made.timeline.take(
                motion::kBothArms,
                {SimTime{-1}, SimTime{0}, motion::make_carry(context, {.radius_m = radius})});
        }
        made.timeline.take(idle,
                           {SimTime{-1}, SimTime{0}, motion::make_idle(context, {.limbs = idle})});
        take.actors.push_back(std::move(made));
    }

    void place_prop(PropIndex index) {
        const Prop& prop = play.cast.props[index.value];
        PropTimeline line;
        if (prop.held_by.valid()) {
            line.take({.from = SimTime{-1}, .kind = Holding::kHands, .actor = prop.held_by});
        } else {
            line.take({.from = SimTime{-1}, .lies = {{}, prop.position_world}});
        }
        take.props.push_back(std::move(line));
    }

    static std::uint64_t seed(ActorIndex actor) { return mix64(actor.value + 1); }

    // ---- the state just before an instant ----

    MotionContext context_of(ActorIndex actor, SimTime at, SimTime duration) const {
        const ActorTake& a = take.actors[actor.value];
        MotionContext context{*a.figure, {}, {}, at, duration, seed(actor)};
        a.timeline.sample(at, context.now, true);
        if (at >= kMoment) {
            Controls earlier;
            a.timeline.sample(at - kMoment, earlier, true);
            context.rate = motion::rate_between(earlier, context.now, kMoment.seconds());
        }
        return context;
    }

    // What the hands have just before the instant and do not let go at it.
    PropIndex held_by(ActorIndex actor, SimTime at) const {
        for (std::uint32_t i = 0; i < take.props.size(); ++i) {
            const Hold& hold = take.props[i].at(at, true);
            if (hold.kind == Holding::kHands && hold.actor == actor &&
                !lets_go(actor, PropIndex{i}, at)) {
                return PropIndex{i};
            }
        }
        return {};
    }
    bool lets_go(ActorIndex actor, PropIndex prop, SimTime at) const {
        return std::any_of(releases.begin(), releases.end(), [&](const Release& release) {
            const Activity& a = activities[release.activity];
            return release.at <= at && !a.cut && a.actor == actor && a.releases == prop;
        });
    }

    struct Seen {
        std::vector<motion::ActorState> actors;
        std::vector<motion::PropState> props;
        std::vector<motion::SetState> sets;
    };
    Seen look_around(SimTime at) const {
        Seen seen;
        for (std::uint32_t i = 0; i < take.actors.size(); ++i) {
            motion::ActorState state{take.actors[i].figure.get(), {}, {}};
            take.actors[i].timeline.sample(at, state.controls, true);
            if (waiting[i].prop.valid()) {
                state.catches_at_world = waiting[i].at_world;
            }
            seen.actors.push_back(std::move(state));
        }
        for (std::uint32_t i = 0; i < take.props.size(); ++i) {
            const Hold& hold = take.props[i].at(at, true);
            seen.props.push_back({take.world_from_prop(PropIndex{i}, at, true).translation,
                                  take.radius(PropIndex{i}),
                                  hold.kind == Holding::kHands ? hold.actor : ActorIndex{}});
        }
        for (const Set& set : play.cast.sets) {
            seen.sets.push_back({set.position_world, set.direction_rad});
        }
        return seen;
    }

    // ---- time ----

    void advance(SimTime at) {
        PUP_REQUIRE(at >= now);
        if (at == now) {
            return;
        }
        for (const Overlap& o : overlaps) {
            if (activities[o.first].left > now) {
                warn(activities[o.second].action, "limb-driven-twice",
                     "it takes a limb that " + place_of(o.first) + " is still moving",
                     "leave the arms of one to the other, or let one end first");
            }
        }
        overlaps.clear();
        for (const std::uint32_t number : cuts) {
            rest_after_cut(number);
        }
        cuts.clear();
        while (!releases.empty() && releases.front().at < at) {
            let_go(releases.front());
            releases.erase(releases.begin());
        }
        now = at;
    }

    // Limbs that were cut and that nobody took at that instant come to rest.
    void rest_after_cut(std::uint32_t number) {
        const Activity& activity = activities[number];
        LimbSet free;
        const ActorTimeline& timeline = take.actors[activity.actor.value].timeline;
        for (int i = 0; i < motion::kLimbCount; ++i) {
            const Limb limb = static_cast<Limb>(i);
            if (activity.movement->limbs.has(limb) &&
                timeline.in_charge(limb, now).owner == number) {
                free = free.with(limb);
            }
        }
        if (free.bits == 0) {
            return;
        }
        const MotionContext context = context_of(activity.actor, now, SimTime{-1});
        const PropIndex held = held_by(activity.actor, now);
        if (held.valid() && free.has(Limb::kLeftArm) && free.has(Limb::kRightArm)) {
            free = motion::without(free, motion::kBothArms);
            take_limbs(activity.actor, motion::kBothArms,
                       motion::make_carry(context, {.radius_m = take.radius(held)}), ~0u);
        }
        if (free.bits != 0) {
            take_limbs(activity.actor, free, motion::make_idle(context, {.limbs = free}), ~0u);
        }
    }

    // A ball whose throw ended without a flight in the net flies all the same.
    void let_go(const Release& release) {
        const Activity& activity = activities[release.activity];
        const PropIndex prop = activity.releases;
        const Hold& hold = take.props[prop.value].at(release.at);
        if (activity.cut || hold.kind != Holding::kHands || hold.actor != activity.actor) {
            return;
        }
        const Transform before = take.world_from_prop(prop, release.at - kMoment, true);
        const Transform then = take.world_from_prop(prop, release.at, true);
        motion::Flight flight{
            .start = release.at,
            .duration = {},
            .start_world = then.translation,
            .velocity_world = (then.translation - before.translation) * (1 / kMoment.seconds()),
            .start_rotation_world = then.rotation,
            .spin_world = {},
            .radius_m = take.radius(prop)};
        take.props[prop.value].take({.from = release.at,
                                     .kind = Holding::kFlight,
                                     .actor = activity.actor,
                                     .flight = flight});
    }

    void take_limbs(ActorIndex actor, LimbSet limbs, MovementPtr movement, std::uint32_t owner) {
        take.actors[actor.value].timeline.take(limbs, {now, now, std::move(movement), owner});
    }

    // ---- what goes wrong ----

    std::string place_of(std::uint32_t activity) const {
        return play.actions[activities[activity].action.value].place;
    }
    void warn(net::ActionIndex action, const char* code, std::string message, std::string remedy) {
        const Action& a = play.actions[action.value];
        for (const Diagnostic& d : diagnostics) {  // once per place
            if (d.code == code && d.element == "place " + a.place) {
                return;
            }
        }
        diagnostics.push_back({Severity::kWarning, code, a.where, "place " + a.place,
                               std::move(message), std::move(remedy)});
    }
    void report(net::ActionIndex action, const Diagnostics& list) {
        for (const Diagnostic& d : list) {
            if (d.severity == Severity::kWarning) {
                warn(action, d.code.c_str(), d.message, d.remedy);
            } else {
                const Action& a = play.actions[action.value];
                diagnostics.push_back(
                    {d.severity, d.code, a.where, "place " + a.place, d.message, d.remedy});
            }
        }
    }

    SimTime begin_actor(std::uint32_t number, const motion::BoundCall& call, SimTime duration);
    SimTime begin_flight(std::uint32_t number, const motion::BoundCall& call, SimTime duration);
    void attend(ActorIndex thrower, const motion::BoundCall& call);
    void receive(ActorIndex catcher, PropIndex prop, const motion::Flight& flight);
    bool planted(ActorIndex actor) const;
};

namespace {

// Attributes of the token in the places where the call names them.
void resolve(motion::BoundCall& call, std::span<const std::int64_t> attributes,
             SubjectKind subject) {
    const motion::MovementSignature* signature = motion::find_movement(call.movement, subject);
    PUP_REQUIRE(signature != nullptr);
    for (motion::Argument& argument : call.arguments) {
        const auto* attribute = std::get_if<motion::TokenAttribute>(&argument.value);
        if (attribute == nullptr) {
            continue;
        }
        PUP_REQUIRE(attribute->index < attributes.size());
        const std::int64_t value = attributes[attribute->index];
        const auto index = static_cast<std::uint32_t>(value);
        for (const motion::Parameter& p : signature->parameters) {
            if (p.name != argument.parameter) {
                continue;
            }
            if (p.types.has(motion::ParameterType::kActor)) {
                argument.value = ActorIndex{index};
            } else if (p.types.has(motion::ParameterType::kProp)) {
                argument.value = PropIndex{index};
            } else if (p.types.has(motion::ParameterType::kSet)) {
                argument.value = SetIndex{index};
            } else if (p.types.has(motion::ParameterType::kBool)) {
                argument.value = value != 0;
            } else {
                argument.value = value;
            }
        }
    }
    for (motion::BoundCall& nested : call.nested) {
        resolve(nested, attributes, SubjectKind::kActor);
    }
}

}  // namespace

SimTime Stage::Data::begin_actor(std::uint32_t number, const motion::BoundCall& call,
                                 SimTime duration) {
    Activity& activity = activities[number];
    activity.actor = call.subject.actor;
    PUP_REQUIRE(activity.actor.value < take.actors.size());
    attend(activity.actor, call);
    const MotionContext context = context_of(activity.actor, now, duration);
    const Seen seen = look_around(now);
    const motion::Surroundings around{seen.actors, seen.props, seen.sets, activity.actor,
                                      held_by(activity.actor, now)};
    Diagnostics notes;
    Checked<motion::Prepared> prepared = motion::prepare(call, context, around, notes);
    report(activity.action, notes);
    if (!prepared) {
        report(activity.action, prepared.error());
        return SimTime{-1};
    }
    activity.movement = prepared->movement;
    const LimbSet limbs = activity.movement->limbs;
    const ActorTimeline& timeline = take.actors[activity.actor.value].timeline;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        const std::uint32_t owner = timeline.in_charge(static_cast<Limb>(i), now).owner;
        if (limbs.has(static_cast<Limb>(i)) && owner != ~0u && activities[owner].left > now) {
            overlaps.push_back({owner, number});
        }
    }
    take_limbs(activity.actor, limbs, activity.movement, number);
    if (limbs.has(Limb::kBody) || prepared->gaze.kind != motion::GazeKind::kOwn) {
        take.actors[activity.actor.value].gazes.push_back({now, prepared->gaze});
    }
    Waiting& wait = waiting[activity.actor.value];
    if (prepared->catches_at_world) {
        wait = {prepared->prop, *prepared->catches_at_world, number};
    } else if (limbs.has(Limb::kLeftArm) || limbs.has(Limb::kRightArm)) {
        wait = {};
    }
    if (prepared->takes_prop) {
        PropTimeline& line = take.props[prepared->prop.value];
        const Transform prop = take.world_from_prop(prepared->prop, now, true);
        const Transform hands =
            take.between_hands(activity.actor, take.radius(prepared->prop), now);
        line.take({.from = now,
                   .kind = Holding::kHands,
                   .actor = activity.actor,
                   .hands_from_prop = normalized(conjugate(hands.rotation) * prop.rotation)});
    }
    if (prepared->releases_prop) {
        activity.releases = prepared->prop;
        const Release release{now + activity.movement->duration, number};
        releases.insert(
            std::upper_bound(releases.begin(), releases.end(), release,
                             [](const Release& a, const Release& b) { return a.at < b.at; }),
            release);
    }
    ScoreEntry& row = take.score[activity.row];
    row.actor = play.cast.actors[activity.actor.value].name;
    row.limbs = limbs;
    row.prop = prepared->prop.valid() ? play.cast.props[prepared->prop.value].name : "";
    return activity.movement->duration;
}

// No leg will be off the floor from now on.
bool Stage::Data::planted(ActorIndex actor) const {
    const ActorTimeline& timeline = take.actors[actor.value].timeline;
    for (const Limb leg : {Limb::kLeftLeg, Limb::kRightLeg}) {
        const Charge& charge = timeline.in_charge(leg, now);
        for (const motion::PhaseSpan& span : charge.movement->phases) {
            if (span.limb == leg && span.phase == motion::Phase::kSwing &&
                charge.start + span.end > now) {
                return false;
            }
        }
    }
    return true;
}

SimTime Stage::Data::begin_flight(std::uint32_t number, const motion::BoundCall& call,
                                  SimTime duration) {
    Activity& activity = activities[number];
    const PropIndex prop = call.subject.prop;
    PUP_REQUIRE(prop.value < take.props.size());
    const Transform from = take.world_from_prop(prop, now, true);
    const motion::ArgumentValue* to = call.find("to");
    PUP_REQUIRE(to != nullptr);
    const ActorIndex* catcher = std::get_if<ActorIndex>(to);
    Vec3 target;
    if (catcher == nullptr) {
        target = std::get<Vec3>(*to);
    } else if (waiting[catcher->value].prop == prop) {
        target = waiting[catcher->value].at_world;
    } else {
        Controls controls;
        take.actors[catcher->value].timeline.sample(now, controls, true);
        target = motion::catching_point(*take.actors[catcher->value].figure, controls);
    }
    const bool prescribed = duration.ticks > 0;
    motion::Flight flight{
        .start = now,
        .duration = prescribed ? duration : motion::flight_duration(from.translation, target),
        .start_world = from.translation,
        .velocity_world = {},
        .start_rotation_world = from.rotation,
        .spin_world = {},
        .radius_m = take.radius(prop)};
    flight.velocity_world = motion::launch_velocity(from.translation, target, flight.duration);
    const Vec3 level{flight.velocity_world.x, 0, flight.velocity_world.z};
    constexpr double kBackspin_rad_s = 4;  // the fingers roll off below the ball
    flight.spin_world = cross(normalized(level, {0, 0, 1}), Vec3{0, 1, 0}) * kBackspin_rad_s;
    const Vec3 way = target - from.translation;
    if (length(flight.velocity_world) > kFastFlight_m_s) {
        warn(activity.action, "fast-throw", "the ball would fly faster than 9 m/s",
             "give it more time, or come closer");
    }
    if (length(Vec3{way.x, 0, way.z}) > kFarFlight_m) {
        warn(activity.action, "far-throw", "the ball would fly farther than 6 m",
             "let the actors come closer");
    }
    const Hold& before = take.props[prop.value].at(now, true);
    const ActorIndex* named = nullptr;
    if (const motion::ArgumentValue* thrower = call.find("from")) {
        named = std::get_if<ActorIndex>(thrower);
    }
    take.props[prop.value].take({.from = now,
                                 .kind = Holding::kFlight,
                                 .actor = before.kind == Holding::kHands ? before.actor
                                          : named != nullptr             ? *named
                                                                         : ActorIndex{},
                                 .target = catcher != nullptr ? *catcher : ActorIndex{},
                                 .flight = flight});
    if (catcher != nullptr) {
        receive(*catcher, prop, flight);
    }
    take.score[activity.row].prop = play.cast.props[prop.value].name;
    return duration.ticks >= 0 ? duration : flight.duration;
}

// Who waits for a ball turns to its holder as soon as that one turns to it or begins to throw:
// since it got ready, the other may have walked on.
void Stage::Data::attend(ActorIndex thrower, const motion::BoundCall& call) {
    constexpr double kNearEnough_rad = 0.07, kMost_rad = 1.5, kTurning_rad_s = 2.2;
    const motion::ArgumentValue* to = call.find(call.movement == "throw" ? "to" : "toward");
    const ActorIndex* catcher = to != nullptr ? std::get_if<ActorIndex>(to) : nullptr;
    if (catcher == nullptr || *catcher == thrower || !planted(*catcher)) {
        return;
    }
    Waiting& wait = waiting[catcher->value];
    if (!wait.prop.valid() || held_by(thrower, now) != wait.prop) {
        return;
    }
    MotionContext context = context_of(*catcher, now, SimTime{-1});
    Controls other;
    take.actors[thrower.value].timeline.sample(now, other, true);
    const double faces =
        heading_of(motion::pelvis_over_feet(context.figure, context.now).rotation_world);
    const double turn =
        turn_between(faces, motion::heading_to(context.now, other.pelvis.position_world));
    if (std::fabs(turn) < kNearEnough_rad) {
        return;
    }
    const double by = clamp(turn, -kMost_rad, kMost_rad);  // the rest when the throw begins
    motion::Ready ready =
        motion::make_ready(context, {.radius_m = take.radius(wait.prop),
                                     .heading_rad = faces + by,
                                     .duration_s = std::fmax(0.5, std::fabs(by) / kTurning_rad_s)});
    wait.at_world = ready.catches_at_world;
    const std::uint32_t owner =
        take.actors[catcher->value].timeline.in_charge(Limb::kLeftArm, now).owner;
    take_limbs(*catcher, motion::kAllLimbs, std::move(ready.movement), owner);
}

// The hands of whom the ball flies to go to where it will be, if they are free and it is ready or
// stands.
void Stage::Data::receive(ActorIndex catcher, PropIndex prop, const motion::Flight& flight) {
    const bool waits = waiting[catcher.value].prop == prop;
    if (held_by(catcher, now).valid() || (!waits && !planted(catcher))) {
        return;
    }
    const ActorTimeline& timeline = take.actors[catcher.value].timeline;
    const std::uint32_t owner = timeline.in_charge(Limb::kLeftArm, now).owner;
    auto base = std::make_shared<Goes>(timeline, now);
    MovementPtr movement =
        motion::make_receive(context_of(catcher, now, SimTime{-1}),
                             {.base = std::move(base), .base_age_s = 0, .flight = flight});
    take_limbs(catcher, motion::kBothArms, std::move(movement), owner);
}

Stage::Stage(Play play) : data_(std::make_unique<Data>(std::move(play))) {}
Stage::~Stage() = default;
Stage::Stage(Stage&&) noexcept = default;
Stage& Stage::operator=(Stage&&) noexcept = default;

SimTime Stage::begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                     SimTime duration, std::span<const std::int64_t> attributes) {
    Data& d = *data_;
    PUP_REQUIRE(action.value < d.play.actions.size());
    PUP_REQUIRE(activity.value == d.activities.size());
    d.advance(at);
    const Action& a = d.play.actions[action.value];
    motion::BoundCall call = a.call;
    resolve(call, attributes, call.subject.kind);
    Activity made;
    made.action = action;
    made.start = at;
    made.row = d.take.score.size();
    d.activities.push_back(std::move(made));
    ScoreEntry row;
    row.start = row.end = at;
    row.left = SimTime::never();
    row.place = a.place;
    row.movement = call.movement;
    row.instance = a.instance;
    d.take.score.push_back(std::move(row));
    const bool flies = call.subject.kind == SubjectKind::kProp;
    const SimTime lasts = flies ? d.begin_flight(activity.value, call, duration)
                                : d.begin_actor(activity.value, call, duration);
    d.raised.clear();
    d.raised_by = activity.value;
    if (lasts.ticks < 0) {
        return lasts;
    }
    d.take.score.back().end = at + lasts;
    if (!flies) {
        for (const motion::MovementEvent& event : d.activities[activity.value].movement->events) {
            for (const RaisedName& name : a.raises) {
                if (name.name == event.name) {
                    d.raised.push_back({at + event.after_start, name.event});
                }
            }
        }
    }
    return lasts;
}

std::span<const net::RaisedEvent> Stage::raised(net::ActivityIndex activity) {
    PUP_REQUIRE(activity.value == data_->raised_by);
    return data_->raised;
}

void Stage::cut(net::ActivityIndex activity, SimTime at) {
    Data& d = *data_;
    d.advance(at);
    Activity& a = d.activities[activity.value];
    a.cut = true;
    ScoreEntry& row = d.take.score[a.row];
    row.end = std::min(row.end, at);
    if (a.movement != nullptr) {
        d.cuts.push_back(activity.value);
    }
}

void Stage::left(net::ActivityIndex activity, SimTime at) {
    Data& d = *data_;
    d.advance(at);
    Activity& a = d.activities[activity.value];
    a.left = at;
    d.take.score[a.row].left = at;
}

std::span<const ScoreEntry> Stage::score() const { return data_->take.score; }
const Diagnostics& Stage::diagnostics() const { return data_->diagnostics; }

std::unique_ptr<const Performance> Stage::finish(SimTime end) {
    Data& d = *data_;
    PUP_REQUIRE(end >= d.now);
    d.advance(SimTime{end.ticks + 1});
    Take take = std::move(d.take);
    take.end = end;
    for (const Activity& a : d.activities) {
        if (a.movement == nullptr) {
            continue;
        }
        const SimTime last = std::min(a.cut ? a.left : SimTime::never(), end);
        for (const motion::MovementEvent& event : a.movement->events) {
            const SimTime at = a.start + event.after_start;
            if (at > last) {
                continue;
            }
            const bool of_prop = event.name == "release" || event.name == "catch";
            take.events.push_back(
                {at, event.name, take.score[a.row].actor,
                 of_prop ? std::string() : std::string(motion::name_of(event.limb)),
                 of_prop ? take.score[a.row].prop : std::string()});
        }
    }
    std::stable_sort(take.events.begin(), take.events.end(),
                     [](const StageEvent& x, const StageEvent& y) { return x.at < y.at; });
    data_ = std::make_unique<Data>(Play{});
    return make_take_performance(std::move(take));
}

}  // namespace puppetri::stage
