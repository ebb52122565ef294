// SPDX-License-Identifier: MIT
// The functions behind the table of movements.
#include "puppetri/motion/prepare.h"

#include <algorithm>
#include <string>

#include "compose.h"
#include "finish_stride.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arguments.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/gait.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/gestures.h"
#include "puppetri/motion/go.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/handling.h"
#include "puppetri/motion/hug.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/jump.h"
#include "puppetri/motion/look.h"
#include "puppetri/motion/one_hand.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/motion/sitting.h"
#include "puppetri/motion/turn.h"
#include "times.h"

namespace puppetri::motion {
namespace {

// Hands faster than this swing on about the shoulders before they do anything else.
constexpr double kFastHand_m_s = 2.0;
// How fast a figure turns at most to look at somebody, so that hips keep within 6 rad/s whatever it
// did before: 97 degrees in half a second (a turn from standing may be a quarter faster). In too
// short a time it turns as far as it gets, and chest and eyes do the rest.
constexpr double kTurning_rad_s = 3.4;
// A ball farther than this from where the hands would hold it is not caught.
constexpr double kCatch_m = 0.02;
// What hands and eyes leave of a turn or a way before somebody sees it.
constexpr double kShown_rad = radians(5), kMiss_m = 0.05;

std::string centimetres(double m) {
    return std::to_string(static_cast<long long>(std::nearbyint(m * 100))) + " cm";
}

class Preparer {
 public:
    Preparer(const BoundCall& call, const MovementSignature& signature,
             const MotionContext& context, const Surroundings& around, Diagnostics& notes)
        : call_(call),
          signature_(signature),
          arguments_(call, signature),
          context_(context),
          around_(around),
          notes_(notes) {}

    Prepared run();

 private:
    void tell_long_stroke(double stroke_m);
    void tell_seated();

    // Whole movements.
    void stand();
    void step(StepKind kind, double stroke_m);
    void walk();
    void go();
    void turn_to(double heading_rad);
    void turn();
    void face();
    void stand_first();
    double in_time(double heading_rad) const;
    void ready();
    void throw_ball();
    void catch_ball();
    // Single limbs and arms alone.
    void leg(bool support);
    void arm_swing(double sign);
    void reach();
    void point(bool straight);
    void look();
    void keep(ArmMovement made, bool wants_rotation);
    bool hands_full(double duration_s);
    Vec3 looked_at(const ArgumentValue& value) const;
    Vec3 target(const char* parameter);
    std::optional<Vec3> optional_target(const char* parameter) const;
    std::optional<double> elbow() const;
    void carry(bool stay);
    void own();
    void whole(MovementPtr made);
    void stand_for(double own_s);
    void pick_up();
    void hand_over();
    void take();
    void lay();
    void hug();

    StepKind half_kind(Side transfer) const;
    LimbSet main_limbs();
    void finish(MovementPtr main);
    Vec3 head_of(ActorIndex actor) const;
    Vec3 place_of(const ArgumentValue& value) const;
    const Grip& grip(PropIndex prop) const { return around_.props[prop.value].grip; }
    bool holds(PropIndex prop) const { return prop.valid() && around_.holds == prop; }
    void note(const char* code, const char* message, const char* remedy) {
        notes_.push_back({Severity::kWarning, code, {}, call_.movement, message, remedy});
    }

    const BoundCall& call_;
    const MovementSignature& signature_;
    Arguments arguments_;
    MotionContext context_;
    const Surroundings& around_;
    Diagnostics& notes_;
    LimbSet limbs_;                    // of the main movement
    MovementPtr arms_;                 // what the arms are left to, or null
    std::vector<MovementPtr> before_;  // what the main movement waits for
    Prepared result_;
};

Vec3 Preparer::head_of(ActorIndex actor) const {
    const ActorState& a = around_.actors[actor.value];
    return a.controls.pelvis.position_world + Vec3{0, 0.4 * a.figure->height_m, 0};
}

Vec3 Preparer::place_of(const ArgumentValue& value) const {
    if (const auto* actor = std::get_if<ActorIndex>(&value)) {
        return around_.actors[actor->value].controls.pelvis.position_world;
    }
    if (const auto* prop = std::get_if<PropIndex>(&value)) {
        return around_.props[prop->value].position_world;
    }
    if (const auto* set = std::get_if<SetIndex>(&value)) {
        return around_.sets[set->value].position_world;
    }
    const auto* point = std::get_if<Vec3>(&value);
    PUP_REQUIRE(point != nullptr);
    return *point;
}

// What the main movement drives. When the arms are left to another movement, when the hands hold
// something, or when they are still fast from a throw, they are not its business.
LimbSet Preparer::main_limbs() {
    const BoundCall* nested =
        signature_.arms_parameter.empty() ? nullptr : arguments_.nested(signature_.arms_parameter);
    if (nested != nullptr && nested->movement != "swing") {
        const MovementSignature& signature = signature_of(*nested, SubjectKind::kActor);
        PUP_REQUIRE(signature.as_argument);
        Preparer inner(*nested, signature, context_, around_, notes_);
        const Prepared prepared = inner.run();
        arms_ = prepared.movement;
        result_.prop = prepared.prop;
    } else if (around_.holds.valid()) {
        arms_ = make_carry(context_, {.grip = grip(around_.holds)});
        result_.prop = around_.holds;
    } else if (length(context_.rate.arms[0].hand_velocity_chest) > kFastHand_m_s ||
               length(context_.rate.arms[1].hand_velocity_chest) > kFastHand_m_s) {
        arms_ = make_relax(context_, 1);
    }
    return arms_ == nullptr ? kAllLimbs : without(kAllLimbs, arms_->limbs);
}

void Preparer::finish(MovementPtr main) {
    if (!before_.empty()) {
        before_.push_back(std::move(main));
        main = in_turn(std::move(before_));
    }
    result_.movement = arms_ == nullptr ? std::move(main) : side_by_side(std::move(main), arms_);
}

void Preparer::stand() {
    const LimbSet limbs = main_limbs();
    finish(make_idle(
        context_,
        {.limbs = limbs, .duration_s = standing_time(arguments_.number("lasting")).seconds()}));
}

// The first half step leaves standing, with the feet side by side; the last one reaches it.
StepKind Preparer::half_kind(Side transfer) const {
    const LegControl& swing = context_.now.legs[index_of(transfer)];
    const LegControl& other_leg = context_.now.legs[index_of(other(transfer))];
    const Vec3 ahead = rotate(about_y(heading_of(context_.now.pelvis.rotation_world)), {0, 0, 1});
    const double behind = dot(other_leg.ankle_world - swing.ankle_world, ahead);
    return std::fabs(behind) < 0.1 ? StepKind::kFirstHalf : StepKind::kLastHalf;
}

void Preparer::tell_long_stroke(double stroke_m) {
    const double most_m = longest_stroke_m(context_.figure, arguments_.number("duty"));
    if (stroke_m > most_m + 1e-9) {
        notes_.push_back(
            {Severity::kWarning,
             "long-stroke",
             {},
             call_.movement,
             "a stroke of " + centimetres(stroke_m) +
                 " is longer than these legs reach: it is shortened to " + centimetres(most_m),
             "write a shorter stroke (a walk: at most 43 % of the height, less with a duty above "
             "0.62 and with long feet on short legs), or let it run with a smaller duty"});
    }
}

void Preparer::step(StepKind kind, double stroke_m) {
    tell_seated();
    tell_long_stroke(stroke_m);
    const LimbSet limbs = main_limbs();
    finish(make_step(context_, {.transfer = arguments_.side("side"),
                                .kind = kind,
                                .stroke_m = stroke_m,
                                .duty_factor = arguments_.number("duty"),
                                .limbs = limbs}));
}

void Preparer::walk() {
    tell_seated();
    tell_long_stroke(arguments_.number("stroke"));
    const int steps = static_cast<int>(walked_steps(arguments_.number("steps")));
    const LimbSet limbs = main_limbs();
    const StepSpec spec{.transfer = arguments_.side("side"),
                        .stroke_m = arguments_.number("stroke"),
                        .duty_factor = arguments_.number("duty"),
                        .limbs = limbs};
    finish(make_walk(context_, spec, steps));
}

// To a place; before what stands or lies there by an arm's length; before a seat so far that
// sitting down brings the hips onto it.
void Preparer::go() {
    const ArgumentValue* to = arguments_.find("to");
    PUP_REQUIRE(to != nullptr);
    stand_first();
    GoSpec spec{.to_world = place_of(*to), .limbs = limbs_};
    const Vec3 way = spec.to_world - context_.now.pelvis.position_world;
    if (length(Vec3{way.x, 0, way.z}) > kFarthestWay_m) {
        note("far-way", "the place is more than 200 m away: it goes that far",
             "let it begin nearer");
    }
    if (const ArgumentValue* facing = arguments_.find("facing")) {
        if (const double* heading = std::get_if<double>(facing)) {
            spec.heading_rad = *heading;
        } else if (const auto* set = std::get_if<SetIndex>(facing)) {
            spec.heading_rad = around_.sets[set->value].direction_rad;
        } else {
            const Vec3 there = place_of(*facing) - spec.to_world;
            spec.heading_rad = heading_of(there);
        }
    }
    if (arguments_.find("seat") != nullptr) {
        const double heading = spec.heading_rad.value_or(
            heading_of(context_.now.pelvis.position_world - spec.to_world));
        spec.heading_rad = heading;
        const Vec3 hips = seated_hips(context_.figure, arguments_.number("seat"));
        spec.to_world = spec.to_world - rotate(about_y(heading), {0, 0, hips.z});
    } else if (arguments_.find("before") != nullptr) {
        spec.before_m = arguments_.number("before");
    } else if (std::holds_alternative<ActorIndex>(*to)) {
        spec.before_m = 0.52 * context_.figure.height_m;
    } else if (std::holds_alternative<PropIndex>(*to)) {
        spec.before_m = 0.23 * context_.figure.height_m;
    }
    finish(make_go(context_, spec));
}

// Who sits and shall do what needs both feet under the body.
void Preparer::tell_seated() {
    if (sits(context_)) {
        note("seated", "it sits, and gets up faster than anybody could", "let it stand_up() first");
    }
}

// The stride is finished before the turn: no leg could follow a body that turns away from it.
void Preparer::stand_first() {
    tell_seated();
    limbs_ = main_limbs();
    const double given_s = context_.duration.seconds();
    before_ = finish_stride(context_, limbs_);
    double gone_s = 0;
    for (const MovementPtr& part : before_) {
        gone_s += part->duration.seconds();
    }
    if (given_s > 0 && context_.duration.seconds() + gone_s > given_s + 1e-9) {
        note("stride", "it is cut in its stride, which takes longer to finish than it is given",
             "write takes auto, or let the walk end before");
    }
}

void Preparer::turn() {
    stand_first();
    turn_to(heading_of(context_.now.pelvis.rotation_world) + arguments_.number("by"));
}

void Preparer::turn_to(double heading_rad) {
    const double by = turn_between(heading_of(context_.now.pelvis.rotation_world), heading_rad);
    finish(make_turn(context_, {.heading_rad = heading_rad,
                                .duration_s = std::fmax(turn_duration_s(std::fabs(by)), 0.2),
                                .limbs = limbs_}));
}

double Preparer::in_time(double heading_rad) const {
    if (context_.duration.ticks < 0) {
        return heading_rad;
    }
    const double now = heading_of(pelvis_over_feet(context_.figure, context_.now).rotation_world);
    const double most = kTurning_rad_s * context_.duration.seconds();
    return now + clamp(turn_between(now, heading_rad), -most, most);
}

void Preparer::face() {
    const ArgumentValue* toward = arguments_.find("toward");
    PUP_REQUIRE(toward != nullptr);
    stand_first();
    if (const double* heading = std::get_if<double>(toward)) {
        turn_to(*heading);
    } else if (const auto* set = std::get_if<SetIndex>(toward)) {
        turn_to(around_.sets[set->value].direction_rad);
    } else {
        if (const auto* actor = std::get_if<ActorIndex>(toward)) {
            result_.gaze = {.kind = GazeKind::kActor, .actor = *actor};
        } else if (const auto* prop = std::get_if<PropIndex>(toward)) {
            result_.gaze = {.kind = GazeKind::kProp, .prop = *prop};
        } else {
            result_.gaze = {.kind = GazeKind::kPoint, .point_world = place_of(*toward)};
        }
        turn_to(in_time(heading_to(context_.now, place_of(*toward))));
    }
}

void Preparer::ready() {
    tell_seated();
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    const double heading = in_time(heading_to(context_.now, place_of(*arguments_.find("from"))));
    const double by = turn_between(heading_of(context_.now.pelvis.rotation_world), heading);
    result_.gaze = {.kind = GazeKind::kProp, .prop = ball};
    if (around_.holds.valid()) {
        note("hands-full", "the hands that shall be ready hold a prop already",
             "throw it first, or face the other with `arms: carry(...)`");
        turn_to(heading);
        return;
    }
    Ready made =
        make_ready(context_, {.grip = grip(ball),
                              .heading_rad = heading,
                              .duration_s = std::fmax(turn_duration_s(std::fabs(by)) + 0.1, 0.4)});
    result_.movement = std::move(made.movement);
    result_.catches_at_world = made.catches_at_world;
}

void Preparer::throw_ball() {
    tell_seated();
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    const ArgumentValue* to = arguments_.find("to");
    PUP_REQUIRE(to != nullptr);
    Vec3 target = place_of(*to);
    if (const auto* actor = std::get_if<ActorIndex>(to)) {
        const ActorState& other_actor = around_.actors[actor->value];
        target = other_actor.catches_at_world.value_or(
            catching_point(*other_actor.figure, other_actor.controls));
        result_.gaze = {.kind = GazeKind::kActor, .actor = *actor};
    }
    result_.releases_prop = holds(ball);
    if (!result_.releases_prop) {
        note("not-held", "it throws what its hands do not hold",
             "let it catch or carry the prop first");
    }
    if (std::fabs(aside_rad(context_.figure, context_.now, target)) > kMostAside_rad) {
        note("not-facing", "it throws without facing the target", "let it face the target first");
    }
    result_.movement = make_throw(
        context_, {.grip = grip(ball), .target_world = target, .held = around_.holds.valid()});
}

void Preparer::catch_ball() {
    tell_seated();
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    result_.gaze = {.kind = GazeKind::kProp, .prop = ball};
    if (around_.holds.valid() && !holds(ball)) {
        note("hands-full", "its hands hold another prop", "throw that first");
        result_.movement = side_by_side(make_idle(context_, {.limbs = without(kAllLimbs, kBothArms),
                                                             .duration_s = CatchSpec{}.duration_s}),
                                        make_carry(context_, {.grip = grip(around_.holds)}));
        return;
    }
    if (!holds(ball)) {
        const Vec3 hands = world_from_chest(context_.figure, context_.now) *
                           held_ball(context_, grip(ball)).chest_from_ball.translation;
        const double off = length(hands - around_.props[ball.value].position_world);
        if (off > kCatch_m) {
            note("out-of-reach",
                 "the ball is not between its hands when it shall catch it: they close on air",
                 "let it be ready before the ball is thrown, and catch at the instant the flight "
                 "ends");
        }
        result_.takes_prop = off <= kCatch_m;
    }
    result_.movement =
        make_catch(context_, {.grip = grip(ball), .held = holds(ball) || result_.takes_prop});
}

void Preparer::own() {
    MovementPtr made = call_.own->maker().make({arguments_, context_, around_, notes_});
    PUP_REQUIRE(made != nullptr);
    whole(std::move(made));
}

// What hands hold they go on holding, whatever such a movement says about the arms.
void Preparer::whole(MovementPtr made) {
    const bool carries = shared(made->limbs, kBothArms).bits != 0 && around_.holds.valid();
    if (carries) {
        note("hands-full", "the arms that it moves hold a prop: they go on carrying it",
             "let it throw the prop or put it down first");
        arms_ = make_carry(context_, {.grip = grip(around_.holds)});
        result_.prop = around_.holds;
    }
    finish(std::move(made));
}

void Preparer::pick_up() {
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    result_.gaze = {.kind = GazeKind::kProp, .prop = ball};
    const PropState& state = around_.props[ball.value];
    if (around_.holds.valid() || state.held_by.valid()) {
        note("hands-full", "it picks up what somebody holds, or with hands that hold something",
             "let the prop lie, and let the hands be free");
        stand_for(PickUpSpec{}.duration_s);
        return;
    }
    PickUp made = make_pick_up(context_, {.grip = state.grip, .ball_world = state.position_world});
    result_.movement = std::move(made.movement);
    if (made.too_flat) {
        note("too-flat", "palms beside a thing as flat as that would go into the floor",
             "let it lie on something or stand on its edge, or let one hand `take` it");
    } else if (made.reaches) {
        result_.grasps_after = made.grasps_after;
    } else {
        note("out-of-reach", "the prop lies too far off: the hands close on air",
             "let it walk there first, and face the prop");
    }
}

void Preparer::hand_over() {
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    const auto* to = arguments_.get<ActorIndex>("to");
    PUP_REQUIRE(to != nullptr);
    result_.gaze = {.kind = GazeKind::kActor, .actor = *to};
    if (!holds(ball) || *to == around_.me) {
        note("not-held", "it hands over what its hands do not hold, or to itself",
             "let it catch or pick up the prop first");
        stand_for(GiveSpec{}.duration_s);
        return;
    }
    const ActorState& other_actor = around_.actors[to->value];
    const HandOver meeting =
        meeting_of(context_.figure, context_.now, *other_actor.figure, other_actor.controls);
    const bool busy = std::any_of(around_.props.begin(), around_.props.end(),
                                  [&](const PropState& p) { return p.held_by == *to; });
    if (!meeting.near || busy) {
        note("out-of-reach", "the other stands too far off or too near, or its hands are full",
             "let them stand about 0.9 m apart, facing each other");
        stand_for(GiveSpec{}.duration_s);
        return;
    }
    result_.movement =
        make_give(context_, {.grip = grip(ball), .meeting_world = meeting.meeting_world});
    result_.grasps_after = to_time(kHandOver_s);
    result_.gives_to = *to;
    result_.meeting_world = meeting.meeting_world;
}

void Preparer::take() {
    const PropIndex thing = result_.prop = arguments_.prop("thing");
    const Side side = arguments_.side("side");
    result_.gaze = {.kind = GazeKind::kProp, .prop = thing};
    const TakeInHandSpec none;
    if (hands_full(none.duration_s)) {
        return;
    }
    const PropState& state = around_.props[thing.value];
    const bool full = std::any_of(
        around_.props.begin(), around_.props.end(),
        [&](const PropState& p) { return p.held_by == around_.me && p.in_hand == side; });
    const OneHandMove made = make_take_in_hand(
        context_, {.side = side,
                   .world_from_thing = {state.rotation_world, state.position_world},
                   .size_m = state.size_m});
    result_.movement = made.movement;
    if (full || state.held_by.valid()) {
        note("hands-full", "it takes what somebody holds, or with a hand that holds something",
             "let the thing lie, and let the hand be free");
    } else if (made.residual_m > kCatch_m) {
        note("out-of-reach", "the thing lies too far off: the hand closes on air",
             "let the figure come nearer, or take the other hand");
    } else {
        result_.one_hand = side;
        result_.takes_after = made.touches;
    }
}

void Preparer::lay() {
    const PropIndex thing = result_.prop = arguments_.prop("thing");
    const PropState& state = around_.props[thing.value];
    const Side side = arguments_.side("side");
    if (state.held_by != around_.me || state.in_hand != side) {
        note("not-held", "it lays down what that hand does not hold", "let it take it first");
        result_.movement = make_idle(
            context_, {.limbs = limb_set(arm_of(side)), .duration_s = LayDownSpec{}.duration_s});
        return;
    }
    const double heading = arguments_.find("facing") != nullptr
                               ? arguments_.number("facing")
                               : heading_of(context_.now.pelvis.rotation_world);
    const auto* at = arguments_.get<Vec3>("at");
    PUP_REQUIRE(at != nullptr);
    const OneHandMove made = make_lay_down(context_, {.side = side,
                                                      .hand_from_thing = state.hand_from_thing,
                                                      .world_from_thing = {about_y(heading), *at}});
    result_.movement = made.movement;
    result_.gaze = {.kind = GazeKind::kPoint, .point_world = *at};
    if (made.residual_m > kCatch_m) {
        note("out-of-reach", "the arm does not reach that place: it goes on holding the thing",
             "choose a nearer place");
    } else {
        result_.one_hand = side;
        result_.lays_after = made.touches;
    }
}

void Preparer::hug() {
    const auto* who = arguments_.get<ActorIndex>("who");
    PUP_REQUIRE(who != nullptr);
    const ActorState& other_actor = around_.actors[who->value];
    Hug made = make_hug(context_, {*other_actor.figure, other_actor.controls});
    if (*who == around_.me || !made.near) {
        note("out-of-reach", "nobody stands close enough before it to be embraced",
             "let them stand about 0.4 m apart, facing each other");
        stand_for(kHug_s);
        return;
    }
    whole(std::move(made.movement));
}

// Nothing else can be done: alive, with whatever the hands hold.
void Preparer::stand_for(double own_s) { whole(make_idle(context_, {.duration_s = own_s})); }

void Preparer::leg(bool support) {
    const bool left = call_.subject.limb == Limb::kLeftLeg;
    const Side me = left ? Side::kLeft : Side::kRight;
    const Side transfer = support ? other(me) : me;
    const bool half = arguments_.flag("half");
    const double stroke = arguments_.number("stroke");
    tell_long_stroke(half ? 2 * stroke : stroke);
    result_.movement = make_step(
        context_, {.transfer = transfer,
                   .kind = half ? half_kind(transfer) : StepKind::kWhole,
                   .stroke_m = half ? 2 * stroke : stroke,
                   .duty_factor = arguments_.number("duty"),
                   .limbs = support ? support_limbs(transfer) : transfer_limbs(transfer)});
}

void Preparer::arm_swing(double sign) {
    const Side side = call_.subject.limb == Limb::kLeftArm ? Side::kLeft : Side::kRight;
    if (around_.holds.valid()) {
        note("hands-full", "the arm that shall swing holds a prop",
             "leave both arms to carry(...)");
        result_.movement = make_carry(
            context_, {.grip = grip(around_.holds), .duration_s = ArmSwingSpec{}.duration_s});
        return;
    }
    result_.movement =
        make_arm_swing(context_, {.side = side, .angle_rad = sign * arguments_.number("angle")});
}

Vec3 Preparer::looked_at(const ArgumentValue& value) const {
    const auto* actor = std::get_if<ActorIndex>(&value);
    return actor != nullptr ? head_of(*actor) : place_of(value);
}

// A point or a prop, or the head of an actor; and the eyes go there.
Vec3 Preparer::target(const char* parameter) {
    const ArgumentValue* value = arguments_.find(parameter);
    PUP_REQUIRE(value != nullptr);
    result_.prop = arguments_.prop(parameter);
    const Vec3 point = looked_at(*value);
    result_.gaze = {.kind = GazeKind::kPoint, .point_world = point};
    return point;
}

std::optional<Vec3> Preparer::optional_target(const char* parameter) const {
    const ArgumentValue* value = arguments_.find(parameter);
    return value == nullptr ? std::nullopt : std::optional(looked_at(*value));
}

std::optional<double> Preparer::elbow() const {
    return arguments_.find("elbow") == nullptr ? std::nullopt
                                               : std::optional(arguments_.number("elbow"));
}

// Hands that hold something go on holding it.
bool Preparer::hands_full(double duration_s) {
    if (!around_.holds.valid()) {
        return false;
    }
    note("hands-full", "the hand that shall move holds a prop", "throw it first");
    result_.movement =
        make_carry(context_, {.grip = grip(around_.holds), .duration_s = duration_s});
    return true;
}

void Preparer::keep(ArmMovement made, bool wants_rotation) {
    if (wants_rotation && made.residual_rad > kShown_rad) {
        note("cannot-turn", "the hand cannot be turned as asked within the arm's limits",
             "let palm or fingers free, or let the figure face the target");
    }
    result_.movement = std::move(made.movement);
}

void Preparer::reach() {
    const Vec3 to = target("to");
    if (hands_full(ReachSpec{}.duration_s)) {
        return;
    }
    const ReachSpec spec{.side = arguments_.side("side"),
                         .target_world = to,
                         .palm_to_world = optional_target("palm"),
                         .fingers_to_world = optional_target("fingers"),
                         .elbow_rad = elbow()};
    ArmMovement made = make_reach(context_, spec);
    const bool wishes = spec.palm_to_world || spec.fingers_to_world;
    if (!wishes && made.residual_rad > kShown_rad) {
        note("cannot-reach", "the arm does not go there: the hand stops on the way",
             "let the figure face the target first, or take the other arm");
    }
    keep(std::move(made), wishes);
}

void Preparer::point(bool straight) {
    const Vec3 at = target("at");
    if (hands_full(PointSpec{}.duration_s)) {
        return;
    }
    PointSpec spec{
        .side = arguments_.side("side"), .target_world = at, .elbow_rad = elbow(), .grip = 0.3};
    if (!straight) {
        spec.flexion_rad = arguments_.number("flexion");
        spec.grip = 0.8;
    }
    ArmMovement made = make_point(context_, spec);
    if (made.residual_m > kMiss_m) {
        note("cannot-aim", "the arm cannot point there within its limits",
             "let the figure face the target first, or take the other arm");
    }
    keep(std::move(made), false);
}

void Preparer::look() {
    const LookMovement made =
        make_look(context_, {.target_world = target("at"), .trunk = arguments_.number("trunk")});
    if (made.residual_rad > kShown_rad) {
        note("cannot-look", "trunk and neck do not turn that far", "let it turn or face first");
    }
    result_.movement = made.movement;
}

void Preparer::carry(bool stay) {
    const PropIndex ball = result_.prop = arguments_.prop("ball");
    if (!holds(ball)) {
        note("not-held", "it carries what its hands do not hold", "let it catch the prop first");
    }
    result_.movement = make_carry(
        context_,
        {.grip = grip(ball), .held = around_.holds.valid(), .stay = stay && around_.holds.valid()});
}

Prepared Preparer::run() {
    const std::string_view name = signature_.name;
    if (call_.own != nullptr) {
        own();
    } else if (signature_.subject == SubjectKind::kLimb) {
        if (name == "support" || name == "transfer") {
            leg(name == "support");
        } else {
            arm_swing(name == "swing_forward" ? 1 : -1);
        }
    } else if (name == "idle" || name == "stand") {
        stand();
    } else if (name == "step") {
        step(StepKind::kWhole, arguments_.number("stroke"));
    } else if (name == "half_step") {
        step(half_kind(arguments_.side("side")), 2 * arguments_.number("stroke"));
    } else if (name == "walk") {
        walk();
    } else if (name == "go") {
        go();
    } else if (name == "face") {
        face();
    } else if (name == "turn") {
        turn();
    } else if (name == "ready") {
        ready();
    } else if (name == "throw") {
        throw_ball();
    } else if (name == "catch") {
        catch_ball();
    } else if (name == "carry" || name == "hold") {
        carry(name == "hold");
    } else if (name == "reach") {
        reach();
    } else if (name == "point" || name == "aim") {
        point(name == "point");
    } else if (name == "look") {
        look();
    } else if (name == "pick_up") {
        pick_up();
    } else if (name == "hand_over") {
        hand_over();
    } else if (name == "take") {
        take();
    } else if (name == "lay") {
        lay();
    } else if (name == "hug") {
        hug();
    } else if (name == "bow") {
        whole(make_bow(context_, {.deep_rad = arguments_.number("deep")}));
    } else if (name == "sit") {
        whole(make_sit(context_, {.seat_height_m = arguments_.number("seat")}));
    } else if (name == "stand_up") {
        whole(make_stand_up(context_, {}));
    } else if (name == "jump") {
        tell_seated();
        if (arguments_.number("height") > kHighestJump_m + 1e-9) {
            note("high-jump", "nobody jumps higher than 50 cm from the stand: it jumps that high",
                 "write a height of at most 50 cm");
        }
        whole(make_jump(context_, {.height_m = arguments_.number("height")}));
    } else if (name == "wave") {
        whole(make_wave(context_, {.side = arguments_.side("side"),
                                   .times = static_cast<int>(
                                       clamp(arguments_.number("times"), 1, kMostWaves))}));
    } else if (name == "eat") {
        whole(make_eat(context_, {.side = arguments_.side("side"),
                                  .bites = static_cast<int>(
                                      clamp(arguments_.number("bites"), 1, kMostBites))}));
    } else {
        PUP_REQUIRE(name == "swing");
        if (!hands_full(1)) {
            result_.movement = make_relax(context_, 1);
        }
    }
    return std::move(result_);
}

}  // namespace

std::int64_t walked_steps(double steps) {
    return static_cast<std::int64_t>(clamp(steps, 1, 10'000));
}
SimTime standing_time(double lasting_s) {
    return whole_milliseconds(clamp(lasting_s, 0.001, 86'400));
}

Prepared prepare(const BoundCall& call, const MotionContext& context, const Surroundings& around,
                 Diagnostics& notes) {
    return Preparer(call, signature_of(call, call.subject.kind), context, around, notes).run();
}

}  // namespace puppetri::motion
