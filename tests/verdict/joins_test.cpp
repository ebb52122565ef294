// SPDX-License-Identifier: MIT
// Movements that join badly on purpose are refuted by a run that shows it; what cannot happen is
// not held against anybody; and no run has a succession that was not foreseen.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "proved_scene.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/readiness.h"
#include "puppetri/proof/successions.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/perform.h"
#include "puppetri/verdict/explain.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

// Goes on from where it finds the figure, but the pelvis first jumps aside, or is at once fast.
class Jumps final : public motion::MovementMaker {
 public:
    Jumps(double jump_m, double speed_m_s) : jump_m_(jump_m), speed_m_s_(speed_m_s) {}
    motion::MovementPtr make(const motion::OwnCall& call) const override {
        struct Made final : motion::Movement {
            motion::Controls from;
            double jump_m = 0, speed_m_s = 0;
            void sample(double t_s, motion::Controls& out) const override {
                out = from;
                out.pelvis.position_world.x += jump_m + speed_m_s * std::fmin(t_s, 0.1);
            }
        };
        auto made = std::make_shared<Made>();
        made->limbs = motion::kAllLimbs;
        made->duration =
            call.context.duration.ticks >= 0 ? call.context.duration : SimTime{kTicksPerSecond};
        made->from = call.context.now;
        made->jump_m = jump_m_;
        made->speed_m_s = speed_m_s_;
        return made;
    }
    motion::DurationRange declared(const motion::Arguments&) const override {
        return {SimTime{kTicksPerSecond}, SimTime{kTicksPerSecond}};
    }

 private:
    double jump_m_, speed_m_s_;
};

// A scene in which the place `bad` does a movement that jumps.
struct Jumping {
    Jumping(const std::string& body, double jump_m, double speed_m_s) {
        scene::MemoryFiles files;
        files.add("test.pup",
                  "language 1\nscene \"test\"\nframes 24 per second, until 10 s\n"
                  "cast {\n ana: mannequin { at (1, 0, 2) m }\n}\n" +
                      body);
        auto loaded = scene::load(files, "test.pup");
        REQUIRE(loaded.has_value());
        scene.emplace(std::move(*loaded));
        const auto own = std::make_shared<const motion::OwnMovement>(
            motion::OwnSignature{.name = "jump"}, std::make_shared<const Jumps>(jump_m, speed_m_s));
        bool found = false;
        for (stage::Action& action : scene->play.actions) {
            if (action.place == "bad") {
                action.call.movement = "jump";
                action.call.arguments.clear();
                action.call.own = own;
                found = true;
            }
        }
        REQUIRE(found);
        ProveOptions options;
        options.budget.seconds = 20;
        verdicts = prove(*scene, options);
    }
    const Verdict& joins() const {
        const auto found = std::find_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) {
            return v.rule == "builtin.movements_join.ana";
        });
        REQUIRE(found != verdicts.end());
        return *found;
    }
    // How far the pelvis comes within two microseconds around an instant of the witness's run, as
    // the finished performance has it.
    double gap_m(SimTime at) const { return length(pelvis(at, 1e-6) - pelvis(at, -1e-6)); }
    double speed_change_m_s(SimTime at) const {
        constexpr double h = 1e-4;
        return length((pelvis(at, 2 * h) - pelvis(at, h)) - (pelvis(at, -h) - pelvis(at, -2 * h))) /
               h;
    }
    void perform_witness() {
        const Witness& w = *joins().witness;
        scene::PerformOptions options;
        options.seed = w.seed;
        options.script = w.choices;
        for (const Witness::Event& e : w.events) {
            options.events.push_back({e.at, scene->net.find_event(e.path)});
        }
        options.horizon.time = w.until;
        auto made = scene::perform(*scene, options);
        REQUIRE(made.has_value());
        performance = std::move(made->performance);
    }

    std::optional<scene::Scene> scene;
    std::vector<Verdict> verdicts;
    std::unique_ptr<const stage::Performance> performance;

 private:
    Vec3 pelvis(SimTime at, double later_s) const {
        figure::Pose pose;
        const figure::Figure figure = figure::make_mannequin(1.75);
        performance->pose(stage::ActorIndex{0},
                          at + SimTime{static_cast<std::int64_t>(later_s * kTicksPerSecond)}, pose);
        std::vector<Transform> world(figure.skeleton.joints.size());
        figure::to_model_space(figure.skeleton, pose, world);
        return world[figure.hips.value].translation;
    }
};

void check_refuted(Jumping& made, const std::string& by, double gap_m, double change_m_s) {
    const Verdict& v = made.joins();
    INFO(name_of(v) << " " << v.reason);
    REQUIRE(v.answer == Answer::kRefuted);
    REQUIRE(v.witness.has_value());
    const Witness& w = *v.witness;
    REQUIRE(w.violates_after > 0);
    REQUIRE(w.violates_after <= w.steps.size());
    CHECK(w.steps[w.violates_after - 1].transition == by);
    CHECK(v.reason.find("bad") != std::string::npos);
    made.perform_witness();
    const SimTime at = w.steps[w.violates_after - 1].at;
    CHECK(made.gap_m(at) == doctest::Approx(gap_m).epsilon(0.01));
    CHECK(made.speed_change_m_s(at) == doctest::Approx(change_m_s).epsilon(0.05));
    // Nowhere else.
    for (const Witness::Step& step : w.steps) {
        const double apart_s = std::fabs(step.at.seconds() - at.seconds());
        if (step.at.ticks > 0 && apart_s > 1e-5 && step.transition != by) {
            CHECK(made.gap_m(step.at) < 1e-5);
        }
    }
    CHECK_FALSE(explain(*made.scene, v).story.empty());
}

const char* const kChain = R"(
place first  does ana.face(40 deg)  takes 1 s  tokens 1
place bad    does ana.idle()        takes 1 s
place last   does ana.face(0 deg)   takes 1 s
one: first -> bad
two: bad   -> last
end { last }
)";

TEST_CASE("a movement that jumps, or is fast at once, is refuted where it begins [witness]") {
    Jumping jump(kChain, 0.05, 0);
    check_refuted(jump, "one", 0.05, 0);
    CHECK(jump.joins().reason.find("position") != std::string::npos);
    Jumping fast(kChain, 0, 0.4);
    check_refuted(fast, "one", 0, 0.4);
    CHECK(fast.joins().reason.find("velocity") != std::string::npos);
    // The table allows 0.05 m/s.
    Jumping good(kChain, 0, 0.03);
    CHECK(good.joins().answer == Answer::kProved);
}

TEST_CASE(
    "where nothing is left to chance and it ends, the one run proves it, without assumptions "
    "[unit]") {
    const Jumping good(kChain, 0, 0);
    CHECK(good.joins().answer == Answer::kProved);
    CHECK(good.joins().assumptions.empty());
    Jumping round(std::string(kChain) + "three: last -> first\n", 0, 0);
    CHECK(round.joins().answer == Answer::kProved);
    CHECK(round.joins().assumptions.size() == 1);
}

TEST_CASE("a bad join behind a rare choice or an event from outside is found [witness]") {
    Jumping rare(R"(
place first  does ana.face(40 deg)  takes 1 .. 2 s  tokens 1
place other  does ana.turn(by: 90 deg)  takes 1 s
place bad    does ana.idle()        takes 1 s
often: first -> other
back:  other -> first
one:   first -> bad   odds 1/1000000
two:   bad   -> first
)",
                 0.02, 0);
    check_refuted(rare, "one", 0.02, 0);
    Jumping called(R"(
event go
event stop
place first  does ana.face(40 deg)   takes 1 s  tokens 1
place ready
place walking does ana.walk(steps: 2)
place bad    does ana.idle()         takes 1 s
get:  first -> ready
one:  ready -> walking       on go
two:  now walking -> bad     on stop
end_: bad -> first
home: walking -> first
)",
                   0.02, 0);
    check_refuted(called, "two", 0.02, 0);
}

TEST_CASE("a succession that no run has is not held against the scene [law]") {
    // `other` has the priority whenever `one` could fire.
    Jumping never(R"(
place first  does ana.face(40 deg)  takes 1 .. 2 s  tokens 1
place other  does ana.turn(by: 90 deg)  takes 1 s
place bad    does ana.idle()        takes 1 s
often: first -> other  priority 2
back:  other -> first
one:   first -> bad
two:   bad   -> first
)",
                  0.02, 0);
    CHECK(never.joins().answer == Answer::kProved);
    CHECK(never.joins().witness == std::nullopt);
    // Two movements need each other's end: in time the second is always the later one.
    Jumping late(R"(
place first  does ana.face(40 deg)  takes 1 s  tokens 1
place clock                         takes 3 s  tokens 1
place next   does ana.face(0 deg)   takes 1 s
place bad    does ana.idle()        takes 1 s
place done
go:   first -> next
one:  first + clock -> bad
stop: next -> done
end { done }
)",
                 0.02, 0);
    CHECK(late.joins().answer == Answer::kProved);
}

TEST_CASE("the good neighbours of a bad join, and other figures, stay proved [unit]") {
    scene::MemoryFiles files;
    files.add("test.pup", R"(language 1
scene "two"
frames 24 per second, until 10 s
cast {
  ana: mannequin
  rui: mannequin { at (2, 0, 0) m, height 1.6 m }
}
place a  does ana.face(40 deg)       takes 1 s  tokens 1
place b  does ana.turn(by: -40 deg)  takes 1 s
place c  does rui.walk(steps: 2)     tokens 1
place d  does rui.idle()             takes 1 s
ab: a -> b
ba: b -> a
cd: c -> d
dc: d -> c
)");
    auto scene = scene::load(files, "test.pup");
    REQUIRE(scene.has_value());
    for (stage::Action& action : scene->play.actions) {
        if (action.place == "d") {
            action.call.own = std::make_shared<const motion::OwnMovement>(
                motion::OwnSignature{.name = "jump"}, std::make_shared<const Jumps>(0.1, 0));
        }
    }
    ProveOptions options;
    options.budget.seconds = 20;
    for (const Verdict& v : prove(*scene, options)) {
        if (v.rule.starts_with("builtin.movements_join")) {
            CHECK_MESSAGE((v.answer == Answer::kRefuted) == v.rule.ends_with("rui"),
                          v.rule << " " << name_of(v) << " " << v.reason);
        }
    }
}

class AnyChooser final : public net::Chooser {
 public:
    explicit AnyChooser(RandomStream& stream) : stream_(stream) {}
    std::int64_t choose(const net::Choice& choice) override {
        if (choice.options != 0) {
            return static_cast<std::int64_t>(stream_.below(choice.options));
        }
        const std::int64_t low = choice.low.ticks, high = choice.high.ticks;
        return stream_.below(3) == 0 ? low
               : high != SimTime::never().ticks && stream_.below(2) == 0
                   ? high
                   : std::clamp(choice.drawn.ticks, low, high);
    }

 private:
    RandomStream& stream_;
};

TEST_CASE("no run of a random net has a succession that its readiness graph has not [agree]") {
    std::size_t nets = 0, seen = 0, foreseen = 0;
    for (std::uint64_t i = 0; i < 800; ++i) {
        RandomStream stream{stream_key(i, "joins", "net"), 0};
        const net::NetDraft draft = test::random_net(stream);
        const auto net = net::compile(draft);
        REQUIRE(net.has_value());
        if (net->place_count() == 0 || net->transition_count() == 0) {
            continue;
        }
        // Some places are movements, on one of two lanes.
        constexpr std::uint32_t kLanes = 2, kNone = ~0u;
        std::vector<std::uint32_t> items(kLanes, 0);
        std::vector<proof::Begin> of_place(net->place_count(), {kNone, 0});
        for (proof::Begin& b : of_place) {
            if (stream.below(3) != 0) {
                b.lane = static_cast<std::uint32_t>(stream.below(kLanes));
                b.item = items[b.lane]++;
            }
        }
        net::Rows<proof::Begin> begins;
        const net::NetTables& tables = net->tables();
        for (std::uint32_t t = 0; t < net->transition_count(); ++t) {
            const auto add = [&](std::uint32_t p) {
                if (of_place[p].lane != kNone) {
                    begins.items.push_back(of_place[p]);
                }
            };
            for (const net::Weighted& w : tables.gives(t)) {
                add(w.place);
            }
            if (tables.transition[t].special != net::kNoIndex) {
                for (const auto& out : tables.specials[tables.transition[t].special].outputs) {
                    add(out.place);
                }
            }
            begins.starts.push_back(static_cast<std::uint32_t>(begins.items.size()));
        }
        std::vector<proof::Begin> initially;
        for (const auto& initial : tables.initial) {
            if (initial.count > 0 && of_place[initial.place].lane != kNone) {
                initially.push_back(of_place[initial.place]);
            }
        }
        proof::Budget budget;
        budget.states = 800;
        budget.seconds = 0.2;
        const proof::TimedGraph graph = proof::readiness_graph({.net = *net, .budget = budget});
        if (!graph.available() || graph.graph.ended != proof::Ended::kDone) {
            continue;
        }
        ++nets;
        const std::vector<proof::Succession> all = proof::successions(
            {.graph = graph.graph, .begins = begins, .items = items, .initially = initially});
        foreseen += all.size();
        std::vector<std::uint8_t> shown(all.size(), 0);
        for (int r = 0; r < 20; ++r) {
            AnyChooser chooser(stream);
            run::Player player(*net, {.seed = static_cast<std::uint64_t>(r), .chooser = &chooser});
            std::vector<std::vector<std::uint32_t>> last;
            for (std::uint32_t l = 0; l < kLanes; ++l) {
                last.push_back({items[l]});
            }
            for (const proof::Begin& b : initially) {
                std::erase(last[b.lane], items[b.lane]);
                last[b.lane].push_back(b.item);
            }
            for (int step = 0; step < 40; ++step) {
                if (net->event_count() > 0 && stream.below(4) == 0) {
                    const net::EventIndex e{
                        static_cast<std::uint32_t>(stream.below(net->event_count()))};
                    if (net->declarations().events[e.value].outside) {
                        player.push(e);
                    }
                }
                if (player.step({.until = player.now() + SimTime{10'000 * test::kRandomNetUnit}}) !=
                    run::Stop::kNone) {
                    break;
                }
                const std::uint32_t t = player.last().value;
                for (const proof::Begin& b : begins.row(t)) {
                    for (const std::uint32_t before : last[b.lane]) {
                        const proof::Succession s{b.lane, before, t, b.item};
                        const auto at = std::lower_bound(all.begin(), all.end(), s);
                        CHECK_MESSAGE((at != all.end() && *at == s), "net " << i << "\n"
                                                                            << test::show(draft));
                        if (at != all.end() && *at == s) {
                            shown[static_cast<std::size_t>(at - all.begin())] = 1;
                        }
                    }
                }
                for (const proof::Begin& b : begins.row(t)) {
                    last[b.lane].clear();
                }
                for (const proof::Begin& b : begins.row(t)) {
                    last[b.lane].push_back(b.item);
                }
            }
        }
        seen += static_cast<std::size_t>(std::count(shown.begin(), shown.end(), 1));
    }
    MESSAGE(nets << " nets, " << foreseen << " successions foreseen, " << seen << " shown by runs");
    CHECK(nets > 200);
    CHECK(seen > 300);
}

}  // namespace
}  // namespace puppetri::verdict
