// SPDX-License-Identifier: MIT
// Edits of clips against what sampling the original says: an edit of times is a change of the time
// that is asked, an edit of sides a reflection of the pose.
#include "puppetri/motion/clip_edit.h"

#include <doctest/doctest.h>

#include <random>

#include "puppetri/motion/clip_layers.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

std::mt19937 g_random(5);
double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(g_random);
}
Vec3 vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }

constexpr Interpolation kSmooth[] = {Interpolation::kLinear,   Interpolation::kCatmullRom,
                                     Interpolation::kCardinal, Interpolation::kKochanekBartels,
                                     Interpolation::kHermite,  Interpolation::kBezier};

template <class Key>
void fill(ClipTrack<Key>& track, int how, auto value, auto rate) {
    for (double t = 0; t < 2.001; t += 0.25) {
        Key key;
        key.t_s = std::min(t, 2.0);
        key.value = value();
        key.interpolation = how < 0 ? kSmooth[g_random() % 6] : kSmooth[how];
        key.shape = {real(-0.5, 0.5), real(-0.5, 0.5), real(-0.5, 0.5)};
        key.in = rate();
        key.out = rate();
        key.easing = {real(0, 1), real(0, 1), real(0, 1), real(0, 1)};
        track.keys.push_back(key);
    }
}

// Two seconds, a number, a translation and a rotation, all interpolations mixed.
Clip some_clip(int how = -1) {
    Clip clip;
    clip.name = "some";
    clip.duration_s = 2;
    clip.root = "hips";
    clip.numbers.push_back({"head.flex", {}});
    fill(
        clip.numbers[0], how, [] { return real(-1, 1); }, [] { return real(-2, 2); });
    clip.translations.push_back({"hips", {}});
    fill(
        clip.translations[0], how, [] { return vector(1); }, [] { return vector(2); });
    clip.rotations.push_back({"leftUpperArm", {}});
    fill(
        clip.rotations[0], how, [] { return from_rotation_vector(vector(0.5)); },
        [] { return vector(1); });
    clip.marks = {{0.25, 0.75, "contact", "leftFoot"}, {1.5, 1.5, "strike", "rightFoot"}};
    return clip;
}

double number(const Clip& c, double t) { return sample(c.numbers[0], t, c.loops, c.duration_s); }
Vec3 place(const Clip& c, double t) { return sample(c.translations[0], t, c.loops, c.duration_s); }
Quat turn(const Clip& c, double t) { return sample(c.rotations[0], t, c.loops, c.duration_s); }

void same_at(const Clip& a, double ta, const Clip& b, double tb, double turn_tolerance = 1e-9,
             double tolerance = 1e-9) {
    REQUIRE(number(a, ta) == doctest::Approx(number(b, tb)).epsilon(tolerance).scale(1));
    REQUIRE(length(place(a, ta) - place(b, tb)) < 10 * tolerance);
    REQUIRE(angle_between(turn(a, ta), turn(b, tb)) < turn_tolerance);
}

}  // namespace

TEST_CASE("keys put into a curve do not change it, whatever it is [law]") {
    for (int round = 0; round < 40; ++round) {
        const Clip clip = some_clip(round % 7 - 1);
        Clip more = clip;
        for (const double t : {0.1, 0.61, 1.0, 1.33, 1.9}) {
            more = with_keys_at(more, t);
        }
        REQUIRE(check(more).has_value());
        CHECK(more.numbers[0].keys.size() == clip.numbers[0].keys.size() + 4);
        for (double t = 0; t <= 2; t += 0.017) {
            // Rotations through a new key are the same curve to the fourth order only.
            same_at(clip, t, more, t, 2e-2);
        }
        for (const double t : {0.1, 0.61, 1.0, 1.33, 1.9}) {
            same_at(clip, t, more, t);
        }
    }
}

TEST_CASE("a copy is the stretch that it was copied from; what is left closes up [law]") {
    for (int round = 0; round < 20; ++round) {
        const Clip clip = some_clip();
        const CutClip parts = cut(clip, 0.4, 1.3);
        REQUIRE(check(parts.piece).has_value());
        REQUIRE(check(parts.rest).has_value());
        CHECK(parts.piece.duration_s == doctest::Approx(0.9));
        CHECK(parts.rest.duration_s == doctest::Approx(1.1));
        for (double t = 0; t <= 0.9; t += 0.02) {
            same_at(parts.piece, t, clip, 0.4 + t, 2e-2);
        }
        for (double t = 0; t < 0.399; t += 0.02) {
            same_at(parts.rest, t, clip, t, 2e-2);
        }
        for (double t = 0.401; t <= 1.1; t += 0.02) {
            same_at(parts.rest, t, clip, t + 0.9, 2e-2, 1e-4);  // after a jump of a microsecond
        }
        CHECK(parts.piece.marks.size() == 1);
        CHECK(parts.piece.marks[0].end_s == doctest::Approx(0.35));
        CHECK(parts.rest.marks.size() == 2);
        CHECK(parts.rest.marks[1].t_s == doctest::Approx(0.6));
    }
    // Of some tracks only: they go straight over the gap, the others do not notice.
    const Clip clip = some_clip(1);
    const Clip gap = without(clip, 0.5, 1.0, {{"head.flex"}});
    CHECK(gap.duration_s == 2);
    CHECK(number(gap, 0.75) == doctest::Approx((number(clip, 0.5) + number(clip, 1)) / 2));
    CHECK(place(gap, 0.75) == place(clip, 0.75));
    CHECK(number(gap, 1.6) == doctest::Approx(number(clip, 1.6)));
}

TEST_CASE("pasting writes over, inserting makes room [law]") {
    for (int round = 0; round < 20; ++round) {
        const Clip clip = some_clip();
        Clip piece = copied(some_clip(), 0.3, 0.9);
        piece.translations.clear();
        const Clip over = pasted(clip, 0.7, piece);
        REQUIRE(check(over).has_value());
        CHECK(over.duration_s == 2);
        CHECK(number(over, 1.0) == doctest::Approx(number(piece, 0.3)));
        CHECK(number(over, 0.5) == doctest::Approx(number(clip, 0.5)));
        CHECK(number(over, 1.7) == doctest::Approx(number(clip, 1.7)));
        CHECK(length(place(over, 1.0) - place(clip, 1.0)) < 1e-9);
        const Clip room = inserted(clip, 0.7, piece);
        REQUIRE(check(room).has_value());
        CHECK(room.duration_s == doctest::Approx(2.6));
        CHECK(number(room, 1.0) == doctest::Approx(number(piece, 0.3)));
        CHECK(number(room, 0.5) == doctest::Approx(number(clip, 0.5)));
        CHECK(number(room, 2.0) == doctest::Approx(number(clip, 1.4)));
        CHECK(length(place(room, 2.0) - place(clip, 1.4)) < 1e-9);
        CHECK(length(place(room, 1.0) - place(clip, 0.7)) < 1e-9);  // waits
        CHECK(room.marks.back().t_s == doctest::Approx(2.1));
        // Beyond the end the clip grows; a new track is added.
        Clip tail = copied(clip, 0, 0.5);
        tail.numbers[0].target = "tail.wag";
        const Clip grown = pasted(clip, 1.8, tail);
        REQUIRE(check(grown).has_value());
        CHECK(grown.duration_s == doctest::Approx(2.3));
        CHECK(grown.find_number("tail.wag") != nullptr);
    }
}

TEST_CASE("cutting a piece out and putting it back changes nothing [law]") {
    for (int round = 0; round < 20; ++round) {
        const Clip clip = some_clip();
        const CutClip parts = cut(clip, 0.6, 1.1);
        const Clip again = inserted(parts.rest, 0.6, parts.piece);
        REQUIRE(check(again).has_value());
        for (double t = 0.011; t < 2; t += 0.05) {
            same_at(again, t, clip, t, 2e-2, 1e-4);
        }
    }
}

TEST_CASE("backwards is the mirror of time, twice is the clip itself [law]") {
    for (int round = 0; round < 20; ++round) {
        const Clip clip = some_clip(round % 7 - 1);
        const Clip back = reversed(clip);
        REQUIRE(check(back).has_value());
        for (double t = 0; t <= 2; t += 0.03) {
            same_at(back, 2 - t, clip, t, 2e-2);
            same_at(reversed(back), t, clip, t, 1e-7);
        }
        CHECK(back.marks[0].t_s == doctest::Approx(0.5));
        CHECK(back.marks[1].end_s == doctest::Approx(1.75));
    }
    Clip steps = some_clip(0);
    for (NumberKey& key : steps.numbers[0].keys) {
        key.interpolation = Interpolation::kStep;
    }
    const Clip back = reversed(steps);
    for (double t = 0.01; t < 2; t += 0.05) {
        CHECK(number(back, 2 - t) == number(steps, t));
    }
}

TEST_CASE("stretching and warping ask the clip at another time [law]") {
    for (int round = 0; round < 20; ++round) {
        const Clip clip = some_clip();
        const Clip slow = stretched(clip, 2.5);
        const std::vector<WarpPoint> points{{0, 0}, {0.5, 1.0}, {1.2, 1.3}, {2, 3}};
        const Clip bent = warped(clip, points);
        REQUIRE(check(slow).has_value());
        REQUIRE(check(bent).has_value());
        CHECK(bent.duration_s == 3);
        for (double t = 0; t <= 2; t += 0.03) {
            same_at(slow, t * 2.5, clip, t, 1e-7);
            const double u = t < 0.5   ? t * 2
                             : t < 1.2 ? 1 + (t - 0.5) * 0.3 / 0.7
                                       : 1.3 + (t - 1.2) * 1.7 / 0.8;
            same_at(bent, u, clip, t, 2e-2);
        }
        CHECK(bent.marks[1].t_s == doctest::Approx(1.3 + 0.3 * 1.7 / 0.8));
    }
}

TEST_CASE("a repeated clip travels on, a joined one starts where the first came to [law]") {
    Clip step;
    step.duration_s = 1;
    step.root = "root";
    step.translations = {
        {"root",
         {VectorKey{.t_s = 0, .value = {1, 0.5, 0}}, VectorKey{.t_s = 1, .value = {1, 0.5, 2}}}}};
    step.rotations = {
        {"root", {RotationKey{.t_s = 0}, RotationKey{.t_s = 1, .value = about_y(kPi / 2)}}}};
    const Clip twice = repeated(step, 2);
    REQUIRE(check(twice).has_value());
    // After a quarter turn the second metre goes along +X.
    CHECK(length(sample(twice.translations[0], 2, false, 2) - Vec3{3, 0.5, 2}) < 1e-9);
    CHECK(heading_of(sample(twice.rotations[0], 2, false, 2)) == doctest::Approx(kPi));
    CHECK(twice.translations[0].keys.size() == 3);
    const Clip four = repeated(step, 4);
    CHECK(length(sample(four.translations[0], 4, false, 4) - Vec3{1, 0.5, 0}) < 1e-9);
}

TEST_CASE("a closed clip meets its beginning in value and rate, and keeps what came before [law]") {
    for (int round = 0; round < 20; ++round) {
        Clip clip = some_clip(round % 5);
        clip.root.clear();
        const Clip loop = closed(clip, 0.5);
        REQUIRE(check(loop).has_value());
        CHECK(loop.loops);
        for (double t = 0; t < 1.49; t += 0.05) {
            same_at(loop, t, clip, t, 2e-2);
        }
        CHECK(std::fabs(number(loop, 2) - number(loop, 0)) < 1e-12);
        CHECK(length(place(loop, 2) - place(loop, 0)) < 1e-12);
        CHECK(angle_between(turn(loop, 2), turn(loop, 0)) < 1e-9);
        const double d = 1e-5;
        const auto rate = [&](auto f) { return (f(d) - f(0)) * (1 / d); };
        const Vec3 leaves = rate([&](double t) { return place(loop, t); });
        const Vec3 arrives = rate([&](double t) { return place(loop, 2 - d + t); });
        CHECK(length(leaves - arrives) < 5e-3);
        const Vec3 w0 = change_between(turn(loop, 0), turn(loop, d)) * (1 / d);
        const Vec3 w1 = change_between(turn(loop, 2 - d), turn(loop, 2)) * (1 / d);
        CHECK(length(w0 - w1) < 1e-2);
    }
    // With a root: it goes on travelling, its height closes.
    Clip walk;
    walk.duration_s = 1;
    walk.root = "hips";
    walk.translations = {{"hips",
                          {VectorKey{.t_s = 0, .value = {0, 1, 0}},
                           VectorKey{.t_s = 1, .value = {0.02, 1.1, 1.4}}}}};
    const Clip loop = closed(walk, 0.3);
    const Vec3 end = sample(loop.translations[0], 1, false, 1);
    CHECK(length(end - Vec3{0.02, 1, 1.4}) < 1e-12);
    CHECK(length(root_travel(loop, 3).translation - Vec3{0.06, 0, 4.2}) < 1e-9);
}

TEST_CASE("names change sides, and only names that have one [unit]") {
    for (const auto& [left, right] : std::vector<std::pair<std::string, std::string>>{
             {"leftFoot", "rightFoot"},
             {"mixamorig:LeftArm", "mixamorig:RightArm"},
             {"left_elbow.flex", "right_elbow.flex"},
             {"hand.L", "hand.R"},
             {"LHipJoint", "RHipJoint"},
             {"thigh_l", "thigh_r"},
             {"Bip01 L Thigh", "Bip01 R Thigh"},
             {"leg_joint_L_2", "leg_joint_R_2"}}) {
        CHECK(mirrored_name(left) == right);
        CHECK(mirrored_name(right) == left);
    }
    for (const char* name : {"hips", "Root", "LowerBack", "tail", "l", "spine_01", "Roll"}) {
        CHECK(mirrored_name(name) == name);
    }
}

TEST_CASE("mirrored poses are mirror images, in whatever axes, and twice is the clip [oracle]") {
    for (int round = 0; round < 20; ++round) {
        // A symmetric tree at rest, whose joints have any axes.
        figure::Skeleton skeleton;
        const auto add = [&](const char* name, int parent, Vec3 at_model) {
            figure::Joint joint;
            joint.name = name;
            std::vector<Transform> model(skeleton.joints.size());
            figure::to_model_space(skeleton, figure::rest_pose(skeleton), model);
            const Transform above =
                parent < 0 ? Transform{} : model[static_cast<std::size_t>(parent)];
            if (parent >= 0) {
                joint.parent = {static_cast<std::uint32_t>(parent)};
            }
            joint.parent_from_joint_rest =
                inverse(above) * Transform{from_rotation_vector(vector(2)), at_model};
            skeleton.joints.push_back(joint);
        };
        add("root", -1, {0, 0, 0});
        add("hips", 0, {0, 1, 0.1});
        add("leftArm", 1, {0.2, 1.4, 0});
        add("leftHand", 2, {0.6, 1.4, 0.1});
        add("rightArm", 1, {-0.2, 1.4, 0});
        add("rightHand", 4, {-0.6, 1.4, 0.1});
        add("head", 1, {0, 1.7, 0});
        Clip clip;
        clip.duration_s = 2;
        for (const figure::Joint& joint : skeleton.joints) {
            clip.rotations.push_back({joint.name, {}});
            fill(
                clip.rotations.back(), -1, [] { return from_rotation_vector(vector(0.5)); },
                [] { return vector(1); });
        }
        clip.translations.push_back({"root", {}});
        fill(
            clip.translations[0], -1, [] { return vector(1); }, [] { return vector(1); });
        clip.marks = {{1, 1, "foot_strike", "leftFoot"}};
        clip.numbers = {{"head.twist", {NumberKey{.value = 1}}},
                        {"left_elbow.flex", {NumberKey{.value = 0.3}}},
                        {"right_elbow.flex", {NumberKey{.value = 0.7}}}};
        const Clip other = mirrored(clip, skeleton);
        REQUIRE(check(other).has_value());
        CHECK(other.marks[0].target == "rightFoot");
        CHECK(other.find_number("head.twist")->keys[0].value == -1);
        CHECK(other.find_number("left_elbow.flex")->keys[0].value == 0.7);
        const auto model_of = [&](const Clip& c, double t) {
            figure::Pose pose = figure::rest_pose(skeleton);
            sample_clip(c, bind_clip(c, skeleton), t, pose);
            std::vector<Transform> model(pose.parent_from_joint.size());
            figure::to_model_space(skeleton, pose, model);
            return model;
        };
        for (double t = 0; t <= 2; t += 0.13) {
            const std::vector<Transform> a = model_of(clip, t), b = model_of(other, t);
            for (std::uint32_t j = 0; j < a.size(); ++j) {
                const auto p = skeleton.find(mirrored_name(skeleton.joints[j].name));
                const Vec3 at = a[j].translation;
                REQUIRE(length(b[p.value].translation - Vec3{-at.x, at.y, at.z}) < 1e-9);
            }
        }
        const Clip twice = mirrored(other, skeleton);
        for (std::size_t i = 0; i < clip.rotations.size(); ++i) {
            REQUIRE(twice.rotations[i].target == clip.rotations[i].target);
            for (double t = 0; t <= 2; t += 0.21) {
                REQUIRE(angle_between(sample(twice.rotations[i], t, false, 2),
                                      sample(clip.rotations[i], t, false, 2)) < 1e-9);
            }
        }
    }
}

TEST_CASE("fewer keys stay within the tolerance, resampled ones on the curve [law]") {
    const Clip fine = resampled(some_clip(1), 200);
    CHECK(fine.numbers[0].keys.size() == 401);
    const Clip few = reduced(fine, {0.01, 0.01});
    CHECK(few.numbers[0].keys.size() < 200);
    for (double t = 0; t <= 2; t += 0.005) {
        CHECK(std::fabs(number(few, t) - number(fine, t)) <= 0.0101);
        CHECK(length(place(few, t) - place(fine, t)) <= 0.0101);
        CHECK(angle_between(turn(few, t), turn(fine, t)) <= 0.0101);
    }
}

TEST_CASE("layers override, add, fade, and keep to their masks [unit]") {
    figure::Skeleton skeleton;
    skeleton.joints = {{"hips", {}, {}, {}}, {"arm", {0}, {}, {}}, {"hand", {1}, {}, {}}};
    const auto still = [](const char* joint, double angle) {
        Clip clip;
        clip.duration_s = 2;
        clip.rotations = {{joint, {RotationKey{.value = about_x(angle)}}}};
        return clip;
    };
    const Clip arm = still("arm", 0.8), hand = still("hand", 0.4), more = still("arm", 0.2);
    const LayerMask below = mask_below(skeleton, "arm");
    CHECK(below.weight_of("hips") == 0);
    CHECK(below.weight_of("hand") == 1);
    const ClipLayer stack[] = {
        {.clip = &arm},
        {.clip = &hand, .weight = 0.5, .mask = below},
        {.clip = &more, .mode = LayerMode::kAdditive},
        {.clip = &more, .mode = LayerMode::kAdditive, .mask = {{{"hand", 1}}, 0}}};
    figure::Pose pose = figure::rest_pose(skeleton);
    apply_layers(stack, skeleton, 1, pose);
    CHECK(angle_between(pose.parent_from_joint[1].rotation, about_x(1.0)) < 1e-9);
    CHECK(angle_between(pose.parent_from_joint[2].rotation, about_x(0.2)) < 1e-9);
    const ClipLayer fading[] = {{.clip = &arm, .begin_s = 0.5, .fade_in_s = 1, .fade_out_s = 1}};
    const Clip flat = flattened(fading, skeleton, 3, 100);
    REQUIRE(check(flat).has_value());
    const auto angle = [&](double t) {
        return angle_of(sample(*flat.find_rotation("arm"), t, false, 3));
    };
    CHECK(angle(0.2) < 1e-9);
    CHECK(angle(1.0) == doctest::Approx(0.4).epsilon(1e-3));
    CHECK(angle(1.5) == doctest::Approx(0.8).epsilon(1e-3));
    CHECK(angle(2.9) < 1e-9);
    // A difference added to its own reference is the clip.
    Clip swing = some_clip();
    const Clip difference = to_additive(swing, 0.3);
    for (double t = 0; t < 2; t += 0.1) {
        CHECK(angle_between(normalized(turn(swing, 0.3) * turn(difference, t)), turn(swing, t)) <
              1e-9);
    }
}
