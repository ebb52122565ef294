// SPDX-License-Identifier: MIT
// The table of movements. One row per name and kind of subject, ordered by name, then subject;
// `prepare.cpp` has the function behind each row.
#include <algorithm>
#include <array>

#include "puppetri/motion/library.h"

namespace puppetri::motion {
namespace {

using enum ParameterType;

constexpr double kDegree = 3.14159265358979323846 / 180;

constexpr SimTime milliseconds(std::int64_t ms) { return {ms * kTicksPerMillisecond}; }
constexpr LimbSet limbs_of(std::initializer_list<Limb> limbs) {
    LimbSet set;
    for (Limb limb : limbs) {
        set = set.with(limb);
    }
    return set;
}
constexpr TypeSet types(std::initializer_list<ParameterType> list) {
    TypeSet set;
    for (ParameterType type : list) {
        set = set.with(type);
    }
    return set;
}

constexpr LimbSet kLegs = limbs_of({Limb::kLeftLeg, Limb::kRightLeg});
constexpr LimbSet kArms = limbs_of({Limb::kLeftArm, Limb::kRightArm});
constexpr LimbSet kWhole = limbs_of(
    {Limb::kPelvis, Limb::kBody, Limb::kLeftLeg, Limb::kRightLeg, Limb::kLeftArm, Limb::kRightArm});

constexpr Parameter kArmsParameter{.name = "arms",
                                   .types = types({kMovement}),
                                   .optional = true,
                                   .doc = "leaves both arms to this movement"};
constexpr Parameter kBallParameter{
    .name = "ball", .types = types({kProp}), .doc = "what both hands hold"};
constexpr Parameter kStrokeParameter{.name = "stroke",
                                     .types = types({kLength}),
                                     .default_text = "0.6 m",
                                     .default_value = 0.6,
                                     .doc = "the way of the body; the foot swings twice as far"};
constexpr Parameter kHalfStrokeParameter{.name = "stroke",
                                         .types = types({kLength}),
                                         .default_text = "0.3 m",
                                         .default_value = 0.3,
                                         .doc = "the way of the body"};
constexpr Parameter kDutyParameter{
    .name = "duty",
    .types = types({kReal}),
    .default_text = "0.62",
    .default_value = 0.62,
    .doc = "the part of the time that a foot is on the ground; above 0.5 walks, below runs"};
constexpr Parameter kSideParameter{
    .name = "side", .types = types({kSide}), .doc = "the leg that swings"};

constexpr Parameter kFor[] = {{.name = "lasting",
                               .types = types({kTime}),
                               .default_text = "2 s",
                               .default_value = 2,
                               .doc = "how long, where the place says `takes auto`"},
                              kArmsParameter};
constexpr Parameter kStep[] = {kSideParameter, kStrokeParameter, kArmsParameter, kDutyParameter};
constexpr Parameter kHalfStep[] = {kSideParameter, kHalfStrokeParameter, kArmsParameter,
                                   kDutyParameter};
constexpr Parameter kWalk[] = {{.name = "steps",
                                .types = types({kInt}),
                                .default_text = "4",
                                .default_value = 4,
                                .doc = "how many; the first and the last are half ones"},
                               kStrokeParameter,
                               {.name = "side",
                                .types = types({kSide}),
                                .default_text = "right",
                                .default_value = 1,
                                .doc = "the leg that swings first"},
                               kArmsParameter,
                               kDutyParameter};
constexpr Parameter kFace[] = {
    {.name = "toward",
     .types = types({kActor, kProp, kSet, kPoint, kAngle}),
     .doc = "whom or what; of a road its direction; an angle is a heading"},
    kArmsParameter};
constexpr Parameter kGo[] = {
    {.name = "to",
     .types = types({kActor, kProp, kSet, kPoint}),
     .doc = "where; an actor or a prop: before it"},
    {.name = "facing",
     .types = types({kActor, kProp, kSet, kPoint, kAngle}),
     .optional = true,
     .doc = "what it faces in the end, or its heading; without, the way it came"},
    {.name = "seat",
     .types = types({kLength}),
     .optional = true,
     .doc = "of that height is a seat there: it stops where `sit` will bring the hips onto it"},
    {.name = "before",
     .types = types({kLength}),
     .optional = true,
     .doc = "how far before the place it stops; without, 0 (a prop: 40 cm, an actor: 90 cm)"},
    kArmsParameter};
constexpr Parameter kTurn[] = {{.name = "by",
                                .types = types({kAngle}),
                                .default_text = "90 deg",
                                .default_value = 90 * kDegree,
                                .doc = "to the left where positive"},
                               kArmsParameter};
constexpr Parameter kHold[] = {kBallParameter};
constexpr Parameter kReady[] = {
    kBallParameter,
    {.name = "from", .types = types({kActor, kPoint}), .doc = "where it will come from"}};
constexpr Parameter kHandParameter{.name = "side",
                                   .types = types({kSide}),
                                   .default_text = "right",
                                   .default_value = 1,
                                   .doc = "the hand"};
constexpr Parameter kElbowParameter{
    .name = "elbow",
    .types = types({kAngle}),
    .optional = true,
    .doc =
        "how far it is lifted outward, from hanging; without, the arm moves as little as it can"};
constexpr Parameter kReach[] = {
    {.name = "to", .types = types({kProp, kPoint, kActor}), .doc = "what the hand reaches for"},
    kHandParameter,
    {.name = "palm",
     .types = types({kProp, kPoint, kActor}),
     .optional = true,
     .doc = "what the palm faces"},
    {.name = "fingers",
     .types = types({kProp, kPoint, kActor}),
     .optional = true,
     .doc = "what the fingers point to"},
    kElbowParameter};
constexpr Parameter kAtParameter{
    .name = "at", .types = types({kProp, kPoint, kActor}), .doc = "what, or whose head"};
constexpr Parameter kPointing[] = {kAtParameter, kHandParameter, kElbowParameter};
constexpr Parameter kAim[] = {kAtParameter,
                              kHandParameter,
                              {.name = "flexion",
                               .types = types({kAngle}),
                               .default_text = "60 deg",
                               .default_value = 60 * kDegree,
                               .doc = "the bend of the elbow, or the nearest with which it can"},
                              kElbowParameter};
constexpr Parameter kLook[] = {kAtParameter,
                               {.name = "trunk",
                                .types = types({kReal}),
                                .default_text = "0.3",
                                .default_value = 0.3,
                                .doc = "the part of the turn that the trunk takes, 0 to 1"}};
constexpr Parameter kThrow[] = {kBallParameter,
                                {.name = "to",
                                 .types = types({kActor, kPoint}),
                                 .doc = "who will catch it, or where it lands"}};
constexpr Parameter kCatch[] = {kBallParameter};
constexpr Parameter kPickUp[] = {
    {.name = "ball", .types = types({kProp}), .doc = "what lies on the floor before its feet"}};
constexpr Parameter kHandOver[] = {
    kBallParameter,
    {.name = "to", .types = types({kActor}), .doc = "who stands before it with free hands"}};
constexpr Parameter kTake[] = {
    {.name = "thing", .types = types({kProp}), .doc = "what lies within reach of that hand"},
    kHandParameter};
constexpr Parameter kLay[] = {
    {.name = "thing", .types = types({kProp}), .doc = "what that hand holds"},
    {.name = "at", .types = types({kPoint}), .doc = "where its centre shall lie"},
    kHandParameter,
    {.name = "facing",
     .types = types({kAngle}),
     .optional = true,
     .doc = "its heading there; without, that of the figure"}};
constexpr Parameter kHug[] = {
    {.name = "who", .types = types({kActor}), .doc = "who stands close before it"}};
constexpr Parameter kBow[] = {{.name = "deep",
                               .types = types({kAngle}),
                               .default_text = "40 deg",
                               .default_value = 40 * kDegree,
                               .doc = "how far the trunk bends"}};
constexpr Parameter kWave[] = {{.name = "times",
                                .types = types({kInt}),
                                .default_text = "3",
                                .default_value = 3,
                                .doc = "to and fro"},
                               kHandParameter};
constexpr Parameter kEat[] = {{.name = "bites",
                               .types = types({kInt}),
                               .default_text = "1",
                               .default_value = 1,
                               .doc = "how many"},
                              kHandParameter};
constexpr Parameter kSit[] = {{.name = "seat",
                               .types = types({kLength}),
                               .default_text = "0.45 m",
                               .default_value = 0.45,
                               .doc = "how high the seat is, which is behind the feet"}};
constexpr Parameter kJump[] = {{.name = "height",
                                .types = types({kLength}),
                                .default_text = "0.2 m",
                                .default_value = 0.2,
                                .doc = "how high the hips fly"}};
constexpr Parameter kFly[] = {
    {.name = "from", .types = types({kActor}), .optional = true, .doc = "who threw it"},
    {.name = "to",
     .types = types({kActor, kPoint}),
     .doc = "who will catch it, or where it lands"}};
constexpr Parameter kHalfParameter{.name = "half",
                                   .types = types({kBool}),
                                   .default_text = "no",
                                   .doc = "whether the step leaves or reaches standing"};
constexpr Parameter kLegOfStep[] = {kStrokeParameter, kHalfParameter, kDutyParameter};
constexpr Parameter kArmSwing[] = {{.name = "angle",
                                    .types = types({kAngle}),
                                    .default_text = "22 deg",
                                    .default_value = 22 * kDegree,
                                    .doc = "how far from hanging"}};

constexpr auto kTable = std::to_array<MovementSignature>({
    {.name = "aim",
     .parameters = kAim,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(600),
     .longest = milliseconds(600),
     .doc = "aims at something with a bent arm: the line of the hand passes through it"},
    {.name = "bow",
     .parameters = kBow,
     .limbs = kWhole,
     .shortest = milliseconds(2400),
     .longest = milliseconds(2400),
     .doc = "bends forward from the hips, stays a moment, and comes up again"},
    {.name = "carry",
     .parameters = kHold,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(1000),
     .longest = milliseconds(1000),
     .doc = "carries a ball before the belly with both hands, elbows bent"},
    {.name = "catch",
     .parameters = kCatch,
     .limbs = kWhole,
     .shortest = milliseconds(700),
     .longest = milliseconds(700),
     .doc = "takes a ball out of the air at the instant it begins, gives way and brings it to the "
            "belly"},
    {.name = "eat",
     .parameters = kEat,
     .limbs = limbs_of({Limb::kBody, Limb::kLeftArm, Limb::kRightArm}),
     .shortest = milliseconds(2800),
     .longest = milliseconds(2'800'000),
     .doc = "takes something from before the belly to the mouth; who sits keeps sitting"},
    {.name = "face",
     .parameters = kFace,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(300),
     .longest = milliseconds(979 + 1502),
     .doc = "turns on the spot until it faces someone, something, or along a road"},
    {.name = "fly",
     .subject = SubjectKind::kProp,
     .parameters = kFly,
     .shortest = milliseconds(1),
     .longest = milliseconds(2000),
     .doc = "flies freely from the hands that let it go to the hands that wait"},
    {.name = "go",
     .parameters = kGo,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(300),
     .longest = milliseconds(1'200'000),
     .doc = "goes to a place: turns, walks there, and turns as it shall stand"},
    {.name = "half_step",
     .parameters = kHalfStep,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(417),
     .longest = milliseconds(417),
     .doc = "a step from standing, or into standing"},
    {.name = "hand_over",
     .parameters = kHandOver,
     .limbs = kWhole,
     .shortest = milliseconds(1900),
     .longest = milliseconds(1900),
     .doc = "holds a ball out to somebody, who takes it with both hands"},
    {.name = "hold",
     .parameters = kHold,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(1000),
     .longest = milliseconds(1000),
     .doc = "keeps a ball where the hands have it now"},
    {.name = "hug",
     .parameters = kHug,
     .limbs = kWhole,
     .shortest = milliseconds(3200),
     .longest = milliseconds(3200),
     .doc = "embraces somebody who stands close before it"},
    {.name = "idle",
     .parameters = kFor,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(1),
     .longest = milliseconds(86'400'000),
     .doc = "stands alive: breathes, shifts its weight, looks about"},
    {.name = "jump",
     .parameters = kJump,
     .limbs = kWhole,
     .shortest = milliseconds(1800),
     .longest = milliseconds(2500),
     .doc = "bends the knees, jumps with both feet, and lands where it stood"},
    {.name = "lay",
     .parameters = kLay,
     .limbs = kArms,
     .shortest = milliseconds(1200),
     .longest = milliseconds(1200),
     .doc = "lays down what one hand holds, and draws the hand back"},
    {.name = "look",
     .parameters = kLook,
     .limbs = limbs_of({Limb::kBody}),
     .shortest = milliseconds(600),
     .longest = milliseconds(600),
     .doc = "looks at something, with trunk, neck and head"},
    {.name = "pick_up",
     .parameters = kPickUp,
     .limbs = kWhole,
     .shortest = milliseconds(2400),
     .longest = milliseconds(2400),
     .doc = "takes a ball off the floor with both hands, and comes up with it"},
    {.name = "point",
     .parameters = kPointing,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(600),
     .longest = milliseconds(600),
     .doc = "points at something with an arm that is almost straight"},
    {.name = "reach",
     .parameters = kReach,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(600),
     .longest = milliseconds(600),
     .doc = "brings one hand to a point or a prop, as far as the arm goes"},
    {.name = "ready",
     .parameters = kReady,
     .limbs = kWhole,
     .shortest = milliseconds(300),
     .longest = milliseconds(1079),
     .doc = "turns to where a ball will come from, bends the knees and opens the hands"},
    {.name = "sit",
     .parameters = kSit,
     .limbs = kWhole,
     .shortest = milliseconds(1600),
     .longest = milliseconds(1600),
     .doc = "sits down on a seat behind its feet, which stay where they are, and rests there"},
    {.name = "stand",
     .parameters = kFor,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(1),
     .longest = milliseconds(86'400'000),
     .doc = "the same as idle"},
    {.name = "stand_up",
     .limbs = kWhole,
     .shortest = milliseconds(1500),
     .longest = milliseconds(1500),
     .doc = "stands up from a seat, over the feet"},
    {.name = "step",
     .parameters = kStep,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(834),
     .longest = milliseconds(834),
     .doc = "a whole step in the middle of a walk"},
    {.name = "support",
     .subject = SubjectKind::kLimb,
     .on_limbs = kLegs,
     .parameters = kLegOfStep,
     .limbs = limbs_of({Limb::kPelvis, Limb::kBody}),
     .shortest = milliseconds(417),
     .longest = milliseconds(834),
     .doc = "stands on this leg and carries the pelvis forward over it"},
    {.name = "swing",
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(1000),
     .longest = milliseconds(1000),
     .doc = "as argument: the arms swing as the whole movement has them; alone: they hang"},
    {.name = "swing_backward",
     .subject = SubjectKind::kLimb,
     .on_limbs = kArms,
     .parameters = kArmSwing,
     .limbs = {},
     .shortest = milliseconds(800),
     .longest = milliseconds(800),
     .doc = "swings this arm back"},
    {.name = "swing_forward",
     .subject = SubjectKind::kLimb,
     .on_limbs = kArms,
     .parameters = kArmSwing,
     .limbs = {},
     .shortest = milliseconds(800),
     .longest = milliseconds(800),
     .doc = "swings this arm forward"},
    {.name = "take",
     .parameters = kTake,
     .limbs = kArms,
     .shortest = milliseconds(1200),
     .longest = milliseconds(1200),
     .doc = "takes a thing that lies within reach with one hand"},
    {.name = "throw",
     .parameters = kThrow,
     .limbs = kWhole,
     .shortest = milliseconds(850),
     .longest = milliseconds(850),
     .doc =
         "swings a held ball back and throws it underarm with both hands; ends when it is let go"},
    {.name = "transfer",
     .subject = SubjectKind::kLimb,
     .on_limbs = kLegs,
     .parameters = kLegOfStep,
     .limbs = {},
     .shortest = milliseconds(417),
     .longest = milliseconds(834),
     .doc = "swings this leg through the air to its next place"},
    {.name = "turn",
     .parameters = kTurn,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(300),
     .longest = milliseconds(979 + 1502),
     .doc = "turns on the spot by an angle"},
    {.name = "walk",
     .parameters = kWalk,
     .limbs = kWhole,
     .arms_parameter = "arms",
     .shortest = milliseconds(834),
     .longest = milliseconds(8'340'000),
     .doc = "walks some steps, from standing to standing"},
    {.name = "wave",
     .parameters = kWave,
     .limbs = kArms,
     .as_argument = true,
     .shortest = milliseconds(1800),
     .longest = milliseconds(56'550),
     .doc = "raises one hand beside the head, waves it, and lowers it"},
});

constexpr std::string_view kTypeNames[] = {"actor", "prop",  "set",  "int",  "real",  "length",
                                           "time",  "angle", "bool", "side", "point", "movement"};
constexpr std::string_view kLimbNames[kLimbCount] = {"pelvis",    "body",     "left_leg",
                                                     "right_leg", "left_arm", "right_arm"};

}  // namespace

std::span<const MovementSignature> movement_library() { return kTable; }

const MovementSignature* find_movement(std::string_view name, SubjectKind subject) {
    const auto found = std::find_if(kTable.begin(), kTable.end(), [&](const MovementSignature& m) {
        return m.name == name && m.subject == subject;
    });
    return found == kTable.end() ? nullptr : &*found;
}

std::string_view name_of(ParameterType type) { return kTypeNames[static_cast<int>(type)]; }

std::optional<Limb> limb_named(std::string_view name) {
    for (int i = 0; i < kLimbCount; ++i) {
        if (kLimbNames[i] == name) {
            return static_cast<Limb>(i);
        }
    }
    return std::nullopt;
}

std::string_view name_of(Limb limb) { return kLimbNames[static_cast<int>(limb)]; }

}  // namespace puppetri::motion
