// SPDX-License-Identifier: MIT
// Movements by formula: what they do, that they join, and what is said of wrong ones.
#include <doctest/doctest.h>

#include "measured.h"
#include "puppetri/base/elementary.h"
#include "puppetri/figure/dof.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

// Ana stands a second, does it, and stands again.
std::string play(const std::string& movements, const std::string& call) {
    return movements + "\nplace a does ana.idle(lasting: 1 s) tokens 1\nplace b does ana." + call +
           "\nplace c does ana.idle(lasting: 1 s)\nab: a -> b\nbc: b -> c\nend { c }\n";
}
Scene one(const std::string& movements, const std::string& call, bool ball = false) {
    MemoryFiles files;
    files.add("scene.pup",
              "language 1\nscene \"one\"\nuntil 5 s\ncast {\n ana: mannequin\n rui: "
              "mannequin { at (1, 0, 0.5) m, facing -90 deg }\n ball: sphere { at "
              "(0.3, 1, 0.4) m }\n}\n" +
                  play(movements, call));
    (void)ball;
    return must(load(files, "scene.pup"));
}
Diagnostics defects(const std::string& movements, const std::string& call) {
    MemoryFiles files;
    files.add("scene.pup",
              "language 1\nscene \"one\"\nuntil 5 s\ncast {\n ana: mannequin\n ball: sphere\n}\n" +
                  play(movements, call));
    return check(files, "scene.pup");
}
void refuses(const std::string& movements, const char* code, const std::string& element = "",
             const std::string& call = "m()") {
    const Diagnostics list = defects(movements, call);
    bool found = false;
    for (const Diagnostic& d : list) {
        found = found || (d.code == code && d.severity == Severity::kError && d.where.line > 0 &&
                          !d.remedy.empty() &&
                          (element.empty() || d.element.find(element) != std::string::npos));
    }
    CHECK_MESSAGE(found, movements << " gives " << told(list));
}

double dof_value(const stage::Performance& p, const char* name, double t_s) {
    static const figure::Figure figure = figure::make_mannequin(1.75);
    static const figure::DofSet dofs = figure::humanoid_dofs(figure);
    figure::Pose pose;
    p.pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
    const figure::DofIndex dof = dofs.find(name);
    REQUIRE(dof.valid());
    const auto joint = dofs.dofs[dof.value].joint;
    const auto range = dofs.of_joint(joint);
    std::vector<double> values(range.count);
    figure::values_of({dofs.dofs.data() + range.first, range.count},
                      figure.skeleton.joints[joint.value].parent_from_joint_rest,
                      pose.parent_from_joint[joint.value], values);
    return values[dof.value - range.first];
}

Vec3 joint_at(const stage::Performance& p, const char* name, double t_s) {
    figure::Pose pose;
    p.pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
    const figure::Skeleton& skeleton = *p.actors()[0].skeleton;
    std::vector<Transform> world(skeleton.joints.size());
    to_model_space(skeleton, pose, world);
    return world[skeleton.find(name).value].translation;
}

// A joint in the space of another.
Vec3 joint_in(const stage::Performance& p, const char* space, const char* name, double t_s) {
    figure::Pose pose;
    p.pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, pose);
    const figure::Skeleton& skeleton = *p.actors()[0].skeleton;
    std::vector<Transform> world(skeleton.joints.size());
    to_model_space(skeleton, pose, world);
    return inverse(world[skeleton.find(space).value]) *
           world[skeleton.find(name).value].translation;
}

const char* const kNod =
    "movement m(me: actor, deep = 15 deg) { takes 2 s; me.head.flex = deep * sin(2*pi*t/1 s) }";

}  // namespace

TEST_CASE("a movement by formula poses its degree of freedom as the formula says [unit]") {
    const Scene scene = one(kNod, "m()");
    const Performed p = performed(scene);
    CHECK(p.performance->score()[1].end - p.performance->score()[1].start ==
          SimTime{2 * kTicksPerSecond});
    // Once the state that it found has faded.
    for (double t = 0.5; t < 1.95; t += 0.05) {
        CHECK(dof_value(*p.performance, "head.flex", 1 + t) ==
              doctest::Approx(radians(15) * puppetri::sin(2 * kPi * t)).epsilon(1e-6));
    }
    check_good(measured(p, scene), "nod");
}

TEST_CASE("arguments of a movement by formula have defaults, names, units and types [unit]") {
    const Scene scene = one(kNod, "m(deep: 20 deg)");
    const Performed p = performed(scene);
    CHECK(dof_value(*p.performance, "head.flex", 2.25) ==
          doctest::Approx(radians(20)).epsilon(1e-6));
    refuses(kNod, "wrong-unit", "", "m(deep: 2 s)");
    refuses(kNod, "unknown-name", "", "m(depth: 20 deg)");
    refuses(kNod, "too-many-arguments", "", "m(20 deg, 1)");
    refuses(kNod, "unknown-name", "", "mm()");
}

TEST_CASE("a place that prescribes a duration plays the whole formula in it [unit]") {
    MemoryFiles files;
    files.add("scene.pup",
              std::string("language 1\nscene \"s\"\nuntil 6 s\ncast { ana: mannequin }\n") + kNod +
                  "\nplace a does ana.m() takes 4 s tokens 1\nend { a }\n");
    const Scene scene = must(load(files, "scene.pup"));
    const Performed p = performed(scene);
    CHECK(dof_value(*p.performance, "head.flex", 2.5) ==
          doctest::Approx(radians(15) * puppetri::sin(2 * kPi * 1.25)).epsilon(1e-6));
}

TEST_CASE("many joints, locals and conditions in one formula, joined without a jump [law]") {
    const Scene scene = one(R"(movement m(me: actor, up = 70 deg) {
  takes 2 s
  ramp = t < 0.6 s ? t / 0.6 s : t > 1.4 s ? (2 s - t) / 0.6 s : 1
  soft = ramp^3 * (10 - ramp*(15 - 6*ramp))
  me.right_shoulder.side = up * soft
  me.right_elbow.flex = 100 deg * soft + 15 deg * sin(12*t/1 s) * soft
  me.spine.side = 6 deg * soft
  me.head.twist = -20 deg * soft
})",
                            "m()");
    const Performed p = performed(scene);
    CHECK(dof_value(*p.performance, "right_shoulder.side", 2) ==
          doctest::Approx(radians(70)).epsilon(1e-6));
    CHECK(dof_value(*p.performance, "right_elbow.flex", 2) ==
          doctest::Approx(radians(100 + 15 * puppetri::sin(12.0))).epsilon(1e-6));
    check_good(measured(p, scene), "salute");
}

TEST_CASE("a hand goes along its path before the chest and in the world [oracle]") {
    const Scene chest = one(R"(movement m(me: actor, radius = 0.1 m) {
  takes 2 s
  a = 2*pi*t / 2 s
  me.left_hand.position = (0.25 m + radius*cos(a), 0.1 m + radius*sin(a), 0.35 m) in chest
})",
                            "m(radius: 8 cm)");
    const Performed p = performed(chest);
    for (double t = 0.5; t < 2; t += 0.1) {
        const Vec3 hand = joint_in(*p.performance, "upperChest", "leftHand", 1 + t);
        const double a = kPi * t;
        CHECK(length(hand - Vec3{0.25 + 0.08 * puppetri::cos(a), 0.1 + 0.08 * puppetri::sin(a),
                                 0.35}) < 1e-6);
    }
    check_good(measured(p, chest), "circle");

    const Scene world = one(R"(movement m(me: actor, what: prop) {
  takes 2 s
  me.left_hand.position = what.position + (0, 0.15, 0) m in world
})",
                            "m(ball)");
    const Performed q = performed(world);
    CHECK(length(joint_at(*q.performance, "leftHand", 2) - Vec3{0.3, 1.15, 0.4}) < 1e-6);
    check_good(measured(q, world), "over the ball");

    // Whatever the trunk does: its joints bend by very different amounts, and the hips move.
    const Scene bent = one(R"(movement m(me: actor, what: prop) {
  takes 2 s
  me.hips.flex = 20 deg * sin(pi*t/2 s)
  me.spine.flex = 25 deg * sin(pi*t/2 s)
  me.chest.side = 12 deg * sin(pi*t/1 s)
  me.upper_chest.twist = 15 deg * sin(pi*t/2 s)
  me.pelvis.position = (0.02, -0.04, -0.05) m * sin(pi*t/2 s)
  me.left_hand.position = what.position + (0.1, 0.05, 0) m in world
})",
                           "m(ball)");
    const Performed r = performed(bent);
    // From when it has got there.
    for (double t = 1.4; t < 3; t += 0.05) {
        CHECK_MESSAGE(
            length(joint_at(*r.performance, "leftHand", t) - Vec3{0.4, 1.05, 0.4}) < 0.001, t);
    }
    check_good(measured(r, bent), "over the ball, bent");
}

TEST_CASE(
    "a pelvis that a formula moves leaves the feet planted; a foot goes where it says [law]") {
    const Scene squat = one(R"(movement m(me: actor) {
  takes 2 s
  me.pelvis.position = (0, -0.15, 0.02) m * sin(pi*t/2 s)^2
  me.hips.flex = 12 deg * sin(pi*t/2 s)^2
})",
                            "m()");
    const Performed p = performed(squat);
    check_good(measured(p, squat), "squat");
    CHECK(joint_at(*p.performance, "hips", 1).y - joint_at(*p.performance, "hips", 2).y > 0.12);

    const Scene tap = one(R"(movement m(me: actor) {
  takes 1 s
  up = sin(pi*t/1 s)^2
  me.right_foot.position = (-0.09, 0, 0.02) m + up*(0, 0.15, 0.1) m in start
})",
                          "m()");
    const Performed q = performed(tap);
    CHECK(joint_at(*q.performance, "rightFoot", 1.5).y > 0.2);
}

TEST_CASE("an event at a time inside a movement reaches the net at that time [unit]") {
    MemoryFiles files;
    files.add("scene.pup", R"(language 1
scene "clap"
until 3 s
cast { ana: mannequin }
movement clap(me: actor) {
  takes 1 s
  me.left_elbow.flex = 80 deg
  at 0.25 s raises clapped
}
place a does ana.clap() tokens 1
place waits tokens 1
place heard
hear: waits -> heard on a.clapped
end { a and heard }
)");
    const Scene scene = must(load(files, "scene.pup"));
    const Performed p = performed(scene);
    CHECK(p.firings == 1);
    bool found = false;
    for (const stage::StageEvent& e : p.performance->events()) {
        found = found || (e.name == "clapped" && e.at == SimTime{kTicksPerSecond / 4});
    }
    CHECK(found);
}

TEST_CASE("a formula of the arms alone may stand as an argument of others [unit]") {
    const Scene scene = one(R"(movement wings(me: actor) {
  takes 2 s
  me.left_shoulder.side = 60 deg
  me.right_shoulder.side = 60 deg
})",
                            "walk(steps: 2, arms: wings())");
    const Performed p = performed(scene);
    CHECK(dof_value(*p.performance, "left_shoulder.side", 1.6) ==
          doctest::Approx(radians(60)).epsilon(1e-6));
    check_good(measured(p, scene), "walk with wings");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = 1 deg }", "wrong-type", "",
            "walk(arms: m())");
}

TEST_CASE("movements are imported like nets, and looked at where nobody does them [unit]") {
    MemoryFiles files;
    files.add("other.pup", std::string(kNod) + "\nnet n { place p }\n");
    files.add("scene.pup",
              "language 1\nscene \"s\"\nuntil 3 s\nimport m from \"other.pup\"\n"
              "cast { ana: mannequin }\nplace a does ana.m() tokens 1\nend { a }\n");
    must(load(files, "scene.pup"));
    MemoryFiles unused;
    unused.add("scene.pup",
               "language 1\nscene \"s\"\nuntil 3 s\ncast { ana: mannequin }\n"
               "movement m(me: actor) { takes 1 s; me.head.flex = 1 deg / (t - t) }\n"
               "place a does ana.idle() tokens 1\nend { a }\n");
    CHECK(!load(unused, "scene.pup"));
}

TEST_CASE("a pole is told with movement, degree of freedom and time, wherever it lies [hostile]") {
    const auto pole = [](const char* formula, const char* at) {
        const std::string m =
            std::string("movement m(me: actor) { takes 1 s; me.head.flex = ") + formula + " }";
        refuses(m, "formula-pole", std::string("movement m, head.flex at ") + at);
    };
    pole("1 deg * 0.01 s / (t - 0.5 s)", "0.500 s");
    pole("1 deg * 1e-3 s / (t - 0.33337 s)", "0.333 s");      // between two samples
    pole("1e-9 deg * 1 s^2 / (t - 0.70001 s)^2", "0.700 s");  // without a change of sign
    pole("0.1 deg * tan(3 * t / 1 s)", "0.524 s");            // pi / 6
    pole("1 deg * log(t / 1 s)", "0.000 s");
    pole("1 deg * sqrt(0.5 - t / 1 s)", "0.501 s");  // the first sample beyond
    pole("1 deg * (0.25 - t / 1 s)^0.5", "0.252 s");
    pole("1 deg / (1 - cos(2*pi*t/1 s))", "0.000 s");
    // No poles: guarded, or never zero, or lifted.
    const auto fine = [](const char* formula) {
        const std::string m =
            std::string("movement m(me: actor) { takes 1 s; me.head.flex = ") + formula + " }";
        const Diagnostics list = defects(m, "m()");
        CHECK_MESSAGE(!has_errors(list), formula << told(list));
    };
    fine("t > 0.1 s ? 1 deg * 0.01 s / t : 0");
    fine("1 deg / (1 + (t / 1 s)^2)");
    fine("5 deg * (t = 0 s ? 1 : sin(40*t/1 s) / (40*t/1 s))");
    fine("1 deg * sqrt(t / 1 s)");
    // Only for arguments that make it one.
    const char* const m =
        "movement m(me: actor, when: time) { takes 1 s; me.head.flex = 0.01 deg * 1 s / (t - when) "
        "}";
    refuses(m, "formula-pole", "at 0.250 s", "m(0.25 s)");
    CHECK(!has_errors(defects(m, "m(2 s)")));
}

TEST_CASE("wrong movements are told with place and remedy [hostile]") {
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = 1 s }", "wrong-unit");
    refuses("movement m(me: actor) { takes 1 deg; me.head.flex = 1 deg }", "wrong-unit");
    refuses("movement m(me: actor) { takes 0 s; me.head.flex = 1 deg }", "out-of-range");
    refuses("movement m(me: actor) { me.head.flex = 1 deg }", "no-duration");
    refuses("movement m(me: actor) { takes 1 s }", "nothing-moves");
    refuses("movement m(me: actor) { takes 1 s; me.head.flexx = 1 deg }", "unknown-name");
    refuses("movement m(me: actor) { takes 1 s; you.head.flex = 1 deg }", "wrong-subject");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = 1 deg + 1 s }", "wrong-unit");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = sine(t) * 1 deg }", "unknown-name");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = sin(t) * 1 deg }", "wrong-unit");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = x * 1 deg }", "unknown-name");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = 1 deg / 0 }", "division-by-zero");
    refuses("movement m(me: actor) { takes 1 s; me.head.flex = 1 deg\n me.head.flex = 2 deg }",
            "name-twice");
    refuses("movement m(me: actor) { takes 1 s; me.left_hand.position = (1, 2, 3) s }",
            "wrong-unit");
    refuses("movement m(me: actor) { takes 1 s; me.left_hand.position = (1, 2) m }", "wrong-type");
    refuses("movement m(me: actor) { takes 1 s; me.left_hand.position = (0, 0, 0) m in moon }",
            "unknown-name");
    refuses("movement m { takes 1 s }", "no-subject");
    refuses("movement m(x: time) { takes 1 s }", "wrong-type");
    refuses("movement walk(me: actor) { takes 1 s; me.head.flex = 1 deg }", "name-twice", "",
            "walk()");
    refuses("movement m(me: actor, b: thing) { takes 1 s; me.head.flex = 1 deg }", "unknown-name");
    const Diagnostics out =
        defects("movement m(me: actor) { takes 1 s; me.left_elbow.flex = 200 deg }", "m()");
    CHECK(!has_errors(out));
    CHECK(std::any_of(out.begin(), out.end(),
                      [](const Diagnostic& d) { return d.code == "out-of-range"; }));
}

TEST_CASE("keyframes pose what their keys say, by each interpolation [oracle]") {
    const auto value = [](const char* interpolation, double t_s) {
        const Scene scene = one(
            std::string("keyframes m(me: actor, most = 60 deg) {\n takes 2 s\n ") + interpolation +
                "\n at 0 s: me.left_elbow.flex = 20 deg, me.head.twist = 0 deg\n"
                " at 1 s: me.left_elbow.flex = most\n"
                " at 2 s: me.left_elbow.flex = 20 deg; me.head.twist = 10 deg\n}",
            "m()");
        const Performed p = performed(scene);
        check_good(measured(p, scene), interpolation);
        return dof_value(*p.performance, "left_elbow.flex", 1 + t_s) * 180 / kPi;
    };
    CHECK(value("interpolation linear", 1.0) == doctest::Approx(60).epsilon(1e-6));
    CHECK(value("interpolation linear", 1.75) == doctest::Approx(30).epsilon(1e-6));
    CHECK(value("interpolation step", 0.99) == doctest::Approx(20).epsilon(1e-6));
    // Catmull-Rom: at the middle key the rate is that from end to end, 0; at the ends one-sided.
    CHECK(value("interpolation catmull_rom", 1.0) == doctest::Approx(60).epsilon(1e-6));
    CHECK(value("interpolation tcb(tension: 1)", 1.5) == doctest::Approx(40).epsilon(1e-6));
    CHECK(value("interpolation bezier(0.5, 0, 0.5, 1)", 1.5) == doctest::Approx(40).epsilon(1e-4));
    CHECK(value("interpolation ease", 1.5) == doctest::Approx(40).epsilon(1e-4));
}

TEST_CASE("keys without one at the begin are a pose to be reached when the first says [law]") {
    // 1 s of its own in a place of 2 s: begins at 1 s, reached at 3 s.
    const Scene scene =
        one("keyframes m(me: actor) { takes 1 s; at 1 s: me.left_elbow.flex = 100 deg }",
            "m() takes 2 s");
    const Performed p = performed(scene);
    const double start = dof_value(*p.performance, "left_elbow.flex", 1);
    CHECK(dof_value(*p.performance, "left_elbow.flex", 3) ==
          doctest::Approx(radians(100)).epsilon(1e-6));
    double last = start, fastest = 0;
    for (int i = 1; i <= 480; ++i) {
        const double now = dof_value(*p.performance, "left_elbow.flex", 1 + i / 240.0);
        CHECK(now >= last - 1e-6);  // on its way all the time
        fastest = std::fmax(fastest, (now - last) * 240);
        last = now;
    }
    // As slow as the time allows: nowhere faster than 2.2 times the mean.
    CHECK(fastest < 2.2 * (radians(100) - start) / 2);
    CHECK(fastest > 1.2 * (radians(100) - start) / 2);
}

TEST_CASE("Hermite keys have the rates that they say, of joints and of hands [oracle]") {
    // Between two keys the cubic that has both values and both rates: with h = 1 s, rates m and n,
    // f(u) = a (1 - 3u^2 + 2u^3) + m (u - 2u^2 + u^3) + b (3u^2 - 2u^3) + n (u^3 - u^2).
    const auto cubic = [](double a, double m, double b, double n, double u) {
        return a * (1 - 3 * u * u + 2 * u * u * u) + m * (u - 2 * u * u + u * u * u) +
               b * (3 * u * u - 2 * u * u * u) + n * (u * u * u - u * u);
    };
    const Scene scene = one(R"(keyframes m(me: actor) {
  takes 2 s
  interpolation hermite
  at 0 s: me.left_elbow.flex = 30 deg
  at 1 s: me.left_elbow.flex = 50 deg rate(in: -40 deg/s, out: 80 deg/s)
  at 2 s: me.left_elbow.flex = 60 deg rate(-20 deg/s)
  at 0 s: me.right_hand.position = (-0.2, -0.1, 0.3) m rate((0, 0.4, 0) m/s)
  at 1 s: me.right_hand.position = (-0.2, 0, 0.35) m rate((0.1, 0, 0) m/s)
  at 2 s: me.right_hand.position = (-0.2, -0.1, 0.3) m
})",
                            "m()");
    const Performed p = performed(scene);
    for (double t = 0.5; t < 2; t += 0.125) {
        const double expected = t < 1 ? cubic(30, 0, 50, -40, t) : cubic(50, 80, 60, -20, t - 1);
        CHECK(dof_value(*p.performance, "left_elbow.flex", 1 + t) * 180 / kPi ==
              doctest::Approx(expected).epsilon(1e-6));
        const Vec3 hand{t < 1 ? cubic(-0.2, 0, -0.2, 0.1, t) : cubic(-0.2, 0.1, -0.2, 0, t - 1),
                        t < 1 ? cubic(-0.1, 0.4, 0, 0, t) : cubic(0, 0, -0.1, 0, t - 1),
                        t < 1 ? cubic(0.3, 0, 0.35, 0, t) : cubic(0.35, 0, 0.3, 0, t - 1)};
        const Vec3 chest = joint_in(*p.performance, "upperChest", "rightHand", 1 + t);
        CHECK(length(chest - hand) < 1e-6);
    }
    // A rate may read parameters, and is per second of the movement's own time.
    const Scene with = one(R"(keyframes m(me: actor, fast: real = 60) {
  takes 1 s
  interpolation hermite
  at 0 s: me.left_elbow.flex = 30 deg rate(fast*1 deg/1 s)
  at 1 s: me.left_elbow.flex = 30 deg
})",
                           "m(fast: 120)");
    const Performed q = performed(with);
    CHECK(dof_value(*q.performance, "left_elbow.flex", 1.5) * 180 / kPi ==
          doctest::Approx(cubic(30, 120, 30, 0, 0.5)).epsilon(1e-6));
}

TEST_CASE("a contact holds a foot that keys move to one place on the floor [law]") {
    const char* const keys = R"(keyframes m(me: actor) {
  takes 2 s
  CONTACT
  at 0 s: me.pelvis.position = (0, 0, 0) m
  at 1 s: me.pelvis.position = (0, -0.06, 0.03) m
  at 2 s: me.pelvis.position = (0, 0, 0) m
  at 0 s: me.right_foot.position = (-0.09, 0, 0) m in start
  at 0.5 s: me.right_foot.position = (-0.09, 0.12, 0.1) m
  at 1 s: me.right_foot.position = (-0.1, 0.02, 0.1) m
  at 1.6 s: me.right_foot.position = (-0.12, 0.01, 0.14) m
  at 2 s: me.right_foot.position = (-0.09, 0, 0.1) m
})";
    const auto slide = [&](const std::string& contact) {
        std::string text = keys;
        text.replace(text.find("CONTACT"), 7, contact);
        const Scene scene = one(text, "m()");
        const Performed p = performed(scene);
        const Vec3 at = joint_at(*p.performance, "rightFoot", 2.05);
        double worst = 0;
        for (double t = 1.0; t <= 1.6; t += 0.05) {
            worst = std::fmax(worst, length(joint_at(*p.performance, "rightFoot", 1 + t) - at));
        }
        return worst;
    };
    CHECK(slide("contact right_foot 1 s .. 1.6 s") < 1e-9);
    CHECK(slide("contact left_foot 1 s .. 1.6 s") > 0.02);
}

TEST_CASE("what loops goes round in a place that gives it more time [law]") {
    MemoryFiles files;
    files.add("scene.pup",
              "language 1\nscene \"s\"\nuntil 8 s\ncast { ana: mannequin }\n"
              "movement m(me: actor) {\n takes 1 s\n loop\n"
              " me.head.flex = 15 deg * sin(2*pi*t/1 s)\n at 0.25 s raises nodded\n}\n"
              "place a does ana.m() takes 5.2 s tokens 1\nend { a }\n");
    const Scene scene = must(load(files, "scene.pup"));
    const Performed p = performed(scene);
    // Five whole rounds are nearest: each 1.04 s long.
    for (double t = 0.6; t < 5.1; t += 0.13) {
        CHECK(dof_value(*p.performance, "head.flex", t) ==
              doctest::Approx(radians(15) * puppetri::sin(2 * kPi * t / 1.04)).epsilon(1e-5));
    }
    int nods = 0;
    for (const stage::StageEvent& e : p.performance->events()) {
        nods += e.name == "nodded" ? 1 : 0;
    }
    CHECK(nods == 5);
}

TEST_CASE(
    "what loops does not hurry through a round in a place that gives it less than half [law]") {
    const auto flex_at = [](const char* takes, const char* raises, double t_s) {
        MemoryFiles files;
        files.add("scene.pup",
                  std::string("language 1\nscene \"s\"\nuntil 8 s\ncast { ana: mannequin }\n"
                              "movement m(me: actor) {\n takes 1 s\n loop\n"
                              " me.head.flex = 15 deg * sin(2*pi*t/1 s)\n") +
                      raises + "}\nplace a does ana.m() takes " + takes + " tokens 1\nend { a }\n");
        const Scene scene = must(load(files, "scene.pup"));
        return dof_value(*performed(scene).performance, "head.flex", t_s);
    };
    // As it was in a place that gives it all its time, while it joins too.
    for (double t = 0.02; t < 0.395; t += 0.05) {
        CHECK(flex_at("0.4 s", "", t) == doctest::Approx(flex_at("1 s", "", t)).epsilon(1e-6));
    }
    // From half a round on it is a whole one, and one that raises events raises all of them.
    constexpr double kSettled_s = 0.35;
    CHECK(flex_at("0.6 s", "", kSettled_s) ==
          doctest::Approx(radians(15) * puppetri::sin(2 * kPi * kSettled_s / 0.6)).epsilon(1e-5));
    CHECK(flex_at("0.4 s", "at 0.9 s raises nodded\n", kSettled_s) ==
          doctest::Approx(radians(15) * puppetri::sin(2 * kPi * kSettled_s / 0.4)).epsilon(1e-5));
}

TEST_CASE("wrong keyframes are told with place and remedy [hostile]") {
    const auto keys = [](const char* body) {
        return std::string("keyframes m(me: actor) {\n takes 1 s\n") + body + "\n}";
    };
    refuses(keys("at 2 s: me.head.flex = 1 deg"), "key-after-end");
    refuses(keys("at -1 s: me.head.flex = 1 deg"), "negative-time");
    refuses(keys("at 0 s: me.head.flex = 1 deg, me.head.flex = 2 deg"), "name-twice");
    refuses(keys("at 0 s: me.head.flex = 1 s"), "wrong-unit");
    refuses(keys("at 0 s: me.head.flex = t * 1 deg"), "wrong-type");
    refuses(keys("at 0 s cubic: me.head.flex = 1 deg"), "unknown-name");
    refuses(keys("at 0 s: me.head.flex"), "wrong-property");
    refuses(keys("interpolation tcb(tension: 99)\nat 0 s: me.head.flex = 1 deg"), "out-of-range");
    refuses(keys("me.head.flex = 1 deg\nat 0 s: me.head.flex = 1 deg"), "name-twice");
    refuses(keys("at 0 s: you.head.flex = 1 deg"), "wrong-subject");
    refuses(keys("at 0 s: me.head.flex = 1 deg rate(1 deg/s)\nat 1 s: me.head.flex = 0 deg"),
            "rate-unused");
    const auto hermite = [&](const char* key) {
        return keys((std::string("interpolation hermite\nat 0 s: ") + key +
                     "\nat 1 s: me.head.flex = 0 deg")
                        .c_str());
    };
    refuses(hermite("me.head.flex = 1 deg rate(1 deg)"), "wrong-unit");
    refuses(hermite("me.head.flex = 1 deg rate(before: 1 deg/s)"), "unknown-name");
    refuses(hermite("me.head.flex = 1 deg rate(in: 1 deg/s, in: 2 deg/s)"), "name-twice");
    refuses(hermite("me.head.flex = 1 deg rate()"), "missing-argument");
    refuses(hermite("me.head.flex = 1 deg slowly"), "wrong-property");
    refuses(hermite("me.left_hand.position = (0, 0, 0) m rate((0, 1, 0) m)"), "wrong-unit");
    refuses(hermite("me.left_hand.position = (0, 0, 0) m in moon"), "unknown-name");
    refuses(keys("contact left_foot 0 s .. 2 s\nat 0 s: me.head.flex = 1 deg"), "key-after-end");
    refuses(keys("contact left_foot 0.5 s .. 0.5 s\nat 0 s: me.head.flex = 1 deg"), "out-of-range");
    refuses(keys("contact left_hand 0 s .. 0.5 s\nat 0 s: me.head.flex = 1 deg"), "unknown-name");
    refuses(keys("contact left_foot\nat 0 s: me.head.flex = 1 deg"), "wrong-property");
    refuses(keys("contact left_foot 0 s .. 0.5 s\ncontact left_foot 0.4 s .. 0.6 s\n"
                 "at 0 s: me.head.flex = 1 deg"),
            "name-twice");
}
