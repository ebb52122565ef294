// SPDX-License-Identifier: MIT
// The movements of the library one after another, every ordered pair: joins, limits, feet.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

#include "measured.h"
#include "puppetri/motion/join.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

// Every ordered pair of calls follows each other once in this order (an Eulerian circuit of the
// complete directed graph with loops: for each i, i i+1 i i+2 ... , cut into one chain).
std::vector<std::size_t> all_pairs(std::size_t count) {
    std::vector<std::size_t> order{0};
    for (std::size_t i = 0; i < count; ++i) {
        order.push_back(i);
        for (std::size_t j = i + 1; j < count; ++j) {
            order.push_back(j);
            order.push_back(i);
        }
        if (i + 1 < count) {
            order.push_back(i + 1);
        }
    }
    return order;
}

Scene chain(const std::vector<std::string>& calls, const std::vector<std::size_t>& order,
            const std::string& definitions = "", const char* until = "600 s") {
    std::string text = std::string("language 1\nscene \"pairs\"\nuntil ") + until +
                       "\ncast { ana: mannequin }\n" + definitions + "\n";
    for (std::size_t k = 0; k < order.size(); ++k) {
        text += "place p" + std::to_string(k) + " does ana." + calls[order[k]] +
                (k == 0 ? " tokens 1\n" : "\n");
        if (k > 0) {
            text += "t" + std::to_string(k) + ": p" + std::to_string(k - 1) + " -> p" +
                    std::to_string(k) + "\n";
        }
    }
    text += "end { p" + std::to_string(order.size() - 1) + " }\n";
    MemoryFiles files;
    files.add("scene.pup", text);
    return must(load(files, "scene.pup"));
}

struct Sampler {
    const stage::Performance* performance;
    const figure::Figure* figure;
    figure::Pose pose;
};
void sample(void* context, double t_s, std::span<Transform> out) {
    auto& s = *static_cast<Sampler*>(context);
    s.performance->pose({0}, SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond + 0.5)},
                        s.pose);
    figure::to_model_space(s.figure->skeleton, s.pose, out);
}

void check_joins(const std::vector<std::string>& calls, const std::string& definitions = "") {
    const std::vector<std::size_t> order = all_pairs(calls.size());
    const Scene scene = chain(calls, order, definitions);
    const Performed p = performed(scene);
    REQUIRE(p.performance->score().size() == order.size());
    const figure::Figure figure = figure::make_mannequin(1.75);
    Sampler sampler{p.performance.get(), &figure, {}};
    std::set<std::pair<std::size_t, std::size_t>> seen;
    for (std::size_t k = 1; k < order.size(); ++k) {
        const double at = p.performance->score()[k].start.seconds();
        const motion::JoinLimits limits;
        const motion::JoinMeasures m =
            motion::measure_join({.figure = figure,
                                  .sample = sample,
                                  .context = &sampler,
                                  .at_s = at,
                                  .begin_s = 0,
                                  .end_s = p.performance->duration().seconds()},
                                 &limits);
        const motion::JoinFault fault = motion::fault_of(m, limits);
        CHECK_MESSAGE(
            fault.quantity == nullptr,
            calls[order[k - 1]]
                << " then " << calls[order[k]] << " at " << at
                << " s: " << std::string(fault.quantity ? fault.quantity : "") << " " << fault.value
                << " " << figure.skeleton.joints[fault.joint.valid() ? fault.joint.value : 0].name);
        seen.insert({order[k - 1], order[k]});
    }
    CHECK(seen.size() == calls.size() * calls.size());
}

}  // namespace

TEST_CASE("every ordered pair of library movements joins within the table [law]") {
    check_joins({"idle(lasting: 1.2 s)", "bow()", "wave()", "eat()", "sit()", "stand_up()",
                 "jump()", "walk(steps: 2)", "turn(60 deg)"});
}

namespace {

bool is(const std::string& call, const char* movement) { return call.rfind(movement, 0) == 0; }
bool wants_held(const std::string& call) {
    return is(call, "hand_over") || is(call, "throw") || is(call, "carry") || is(call, "hold");
}

// `first`, then `second`, with somebody and a ball where they need them: in the hands, on the
// floor, or on its way. What cannot be (who has thrown a ball throws it again) is told by a
// warning, and joins all the same.
Scene pair_of(const std::string& first, const std::string& second, double height_m) {
    const bool caught = is(first, "catch");
    const bool held =
        wants_held(first) || (wants_held(second) && !is(first, "pick_up") && !is(first, "catch"));
    const bool floor = is(first, "pick_up") || is(second, "pick_up");
    double apart = 0.92;
    if (caught || is(first, "throw") || is(first, "ready") || is(second, "throw")) {
        apart = is(first, "hand_over") ? apart : 3;
    } else if (is(first, "hug") || (is(second, "hug") && !is(first, "hand_over"))) {
        apart = 0.37;
    }
    const std::string height = "height " + std::to_string(height_m) + " m";
    std::string text = "language 1\nscene \"pair\"\nuntil 9 s\ncast {\n  ana: mannequin { " +
                       height + " }\n  rui: mannequin { " + height +
                       ", facing 180 deg, at (0, 0, " + std::to_string(apart) +
                       ") m }\n  ball: sphere { diameter 22 cm, " +
                       (held     ? "held by ana.hands"
                        : caught ? "held by rui.hands"
                        : floor  ? "at (0, 0.11, 0.4) m"
                                 : "at (3, 0.11, 3) m") +
                       " }\n}\n";
    if (caught) {
        text += R"(place s does ana.ready(ball, from: rui) takes 1 s tokens 1
place r does rui.throw(ball, to: ana) takes 1 s tokens 1
place f does ball.fly(from: rui, to: ana)
place w
place rr does rui.idle()
let_go: r -> f + rr
wait: s -> w
begin: f + w -> a
)";
    } else {
        text += "place s does ana.idle(lasting: 1 s) tokens 1\nbegin: s -> a\n";
    }
    text += "place a does ana." + first + "\nplace b does ana." + second +
            "\nplace e does ana.idle(lasting: 1.5 s)\nab: a -> b\nbe: b -> e\nend { e }\n";
    MemoryFiles files;
    files.add("scene.pup", text);
    return must(load(files, "scene.pup"));
}

const std::vector<std::string>& whole_library() {
    static const std::vector<std::string> calls{"idle(lasting: 1 s)",
                                                "bow()",
                                                "wave()",
                                                "eat()",
                                                "sit()",
                                                "stand_up()",
                                                "jump()",
                                                "walk(steps: 2)",
                                                "turn(60 deg)",
                                                "go((0.4, 0, 0.8) m)",
                                                "face(rui)",
                                                "look((1, 1, 1) m)",
                                                "reach((0.2, 1.3, 0.6) m)",
                                                "point((2, 1.4, 2) m)",
                                                "aim((1, 1.3, 3) m)",
                                                "pick_up(ball)",
                                                "hand_over(ball, to: rui)",
                                                "hug(rui)",
                                                "throw(ball, to: rui)",
                                                "ready(ball, from: rui)",
                                                "catch(ball)",
                                                "carry(ball)",
                                                "hold(ball)",
                                                "swing()"};
    return calls;
}

// The whole table at 480 Hz; that of running where somebody jumps.
void check_table(const test::Measures& m, const std::string& what, bool runs) {
    check_good(m, what);
    const auto slow = [&](const test::JointMeasures& j, double speed, double acceleration,
                          const char* joint) {
        CHECK_MESSAGE(j.speed_rad_s.value <= speed, what << ": " << std::string(joint) << " "
                                                         << j.speed_rad_s.value << " rad/s at "
                                                         << j.speed_rad_s.at_s);
        CHECK_MESSAGE(j.acceleration_rad_s2.value <= acceleration,
                      what << ": " << std::string(joint) << " " << j.acceleration_rad_s2.value
                           << " rad/s^2 at " << j.acceleration_rad_s2.at_s);
    };
    slow(m.knee, runs ? 18 : 10, runs ? 1200 : 400, "knee");
    slow(m.hip, runs ? 12 : 6, runs ? 1200 : 400, "hip");
    slow(m.ankle, runs ? 14 : 8, runs ? 1200 : 400, "ankle");
    slow(m.spine, runs ? 5 : 3, 400, "spine");
    slow(m.arm, 20, 1500, "arm");
    slow(m.neck, 6, runs ? 1200 : 400, "neck");
    // Of throws and catches the table asks nothing of the pelvis.
    if (!runs && what.find("throw") == std::string::npos &&
        what.find("catch") == std::string::npos) {
        CHECK_MESSAGE(m.pelvis_acceleration.value <= 4,
                      what << ": pelvis " << m.pelvis_acceleration.value << " m/s^2 at "
                           << m.pelvis_acceleration.at_s);
    }
}

bool told(const Performed& p, const char* code) {
    return std::any_of(p.notes.begin(), p.notes.end(),
                       [&](const Diagnostic& d) { return d.code == code; });
}

}  // namespace

TEST_CASE(
    "handling, ball game, reaching, pointing: every ordered pair with all others joins [law]") {
    // Without PUPPETRI_LONG a third of the pairs, by joins; with it all, by the whole table.
    const bool every = std::getenv("PUPPETRI_LONG") != nullptr;
    const auto& calls = whole_library();
    const figure::Figure figure = figure::make_mannequin(1.75);
    for (std::size_t i = 0; i < calls.size(); ++i) {
        for (std::size_t k = 0; k < calls.size(); ++k) {
            const std::string what = calls[i] + " then " + calls[k];
            if (!every && (2 * i + k) % 3 != 0) {
                continue;
            }
            const Scene scene = pair_of(calls[i], calls[k], 1.75);
            const Performed p = performed(scene);
            Sampler sampler{p.performance.get(), &figure, {}};
            for (const stage::ScoreEntry& row : p.performance->score()) {
                if (row.actor != "ana" || row.start == SimTime{0}) {
                    continue;
                }
                const motion::JoinLimits limits;
                const motion::JoinMeasures m =
                    motion::measure_join({.figure = figure,
                                          .sample = sample,
                                          .context = &sampler,
                                          .at_s = row.start.seconds(),
                                          .begin_s = 0,
                                          .end_s = p.performance->duration().seconds()},
                                         &limits);
                const motion::JoinFault fault = motion::fault_of(m, limits);
                CHECK_MESSAGE(fault.quantity == nullptr,
                              what << " at " << row.place << ": "
                                   << std::string(fault.quantity ? fault.quantity : "") << " "
                                   << fault.value);
            }
            // Who sits and shall walk, has nothing to throw, or shall reach behind its back is
            // warned, and does what it can.
            if (every && !told(p, "seated") && !told(p, "not-held") && !told(p, "cannot-reach")) {
                check_table(measured(p, scene), what, is(what, "jump") || is(calls[k], "jump"));
            }
        }
    }
}

TEST_CASE("library movements keep limits, floor and planted feet, and are not too fast [law]") {
    const auto look = [](const std::string& call) {
        const Scene scene = chain({"idle(lasting: 1 s)", call}, {0, 1, 0}, "", "6 s");
        const Performed p = performed(scene);
        CHECK(p.notes.empty());
        const test::Measures m = measured(p, scene);
        check_table(m, call, is(call, "jump"));
    };
    for (const char* call : {"bow(deep: 60 deg)", "wave(2, left)", "eat()", "sit(0.4 m)",
                             "jump(5 cm)", "jump()", "jump(35 cm)", "jump(50 cm)"}) {
        look(call);
    }
}

TEST_CASE("who sits has its hips on the seat, its feet planted, and eats there [unit]") {
    const Scene scene = chain({"idle(lasting: 1 s)", "sit(0.45 m)", "eat()", "stand_up()"},
                              {0, 1, 2, 3, 0}, "", "10 s");
    const Performed p = performed(scene);
    check_good(measured(p, scene), "sit, eat, stand up");
    const figure::Figure figure = figure::make_mannequin(1.75);
    Sampler sampler{p.performance.get(), &figure, {}};
    std::vector<Transform> world(figure.skeleton.joints.size());
    for (double t = 2.7; t < 4.7; t += 0.1) {
        sample(&sampler, t, world);
        const Vec3 hips = world[figure.hips.value].translation;
        CHECK(hips.y == doctest::Approx(0.45 + 0.052 * 1.75).epsilon(0.01));
        const Vec3 ankle = world[figure.legs[0].ankle.value].translation;
        CHECK(ankle.z - hips.z > 0.3);  // on a seat behind the feet
    }
    int bites = 0;
    for (const stage::StageEvent& e : p.performance->events()) {
        bites += e.name == "bite";
    }
    CHECK(bites == 1);
    sample(&sampler, 7.2, world);
    CHECK(world[figure.hips.value].translation.y > 0.88);
}

TEST_CASE("who jumps flies as a stone does, and lands where it stood [oracle]") {
    const Scene scene = chain({"idle(lasting: 1 s)", "jump(25 cm)"}, {0, 1, 0}, "", "6 s");
    const Performed p = performed(scene);
    const figure::Figure figure = figure::make_mannequin(1.75);
    Sampler sampler{p.performance.get(), &figure, {}};
    std::vector<Transform> world(figure.skeleton.joints.size());
    const auto hips = [&](double t) {
        sample(&sampler, t, world);
        return world[figure.hips.value].translation;
    };
    double off = -1, on = -1;
    for (const stage::StageEvent& e : p.performance->events()) {
        if (e.name == "foot_off") {
            off = e.at.seconds();
        } else if (e.name == "foot_strike") {
            on = e.at.seconds();
        }
    }
    CHECK(on - off == doctest::Approx(2 * std::sqrt(2 * 0.25 / 9.80665)).epsilon(1e-3));
    const double h = 0.01;
    for (double t = off + 2 * h; t < on - 2 * h; t += h) {
        const double g = (hips(t + h).y - 2 * hips(t).y + hips(t - h).y) / (h * h);
        CHECK(std::fabs(g + 9.80665) < 0.1);
    }
    double top = 0;
    for (double t = off; t < on; t += 0.002) {
        top = std::fmax(top, hips(t).y);
    }
    CHECK(top - hips(off).y == doctest::Approx(0.25).epsilon(0.02));
    hips(0.9);
    const Vec3 before = world[figure.legs[0].ankle.value].translation;
    hips(p.performance->duration().seconds());
    CHECK(length(world[figure.legs[0].ankle.value].translation - before) < 1e-3);
}
