// SPDX-License-Identifier: MIT
// One instant: SEMANTICS section 5, and paced nets of section 1.
#include <doctest/doctest.h>

#include "maker.h"

namespace puppetri::net {
namespace {

AssignmentDraft set(DatumIndex d, Expr value) { return {d, std::move(value), {}}; }

TEST_CASE("everything of an instant is ready before anything fires [unit]") {
    // Both tokens and the delay end at 2; the higher priority must see them all.
    Maker m;
    m.place("a", 1, lasts(2));
    m.place("b", 1, lasts(2));
    m.place("c", 1);
    m.t("low", {"a"}, {});
    TransitionDraft& high = m.t("high", {"b", "a"}, {});
    high.priority = 2;
    TransitionDraft& highest = m.t("highest", {"c"}, {});
    highest.priority = 3;
    highest.delay = DelayDraft{lasts(2)};
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "2:highest 2:high");
}

TEST_CASE(
    "an occurrence comes when the instant has settled, to every transition that names it, once "
    "each [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.at(1, e);
    m.place("a", 3);
    m.place("b", 3);
    m.place("late", 1, lasts(1));
    m.t("one", {"a"}, {}).events = {e};
    TransitionDraft& two = m.t("two", {"b"}, {});
    two.events = {e};
    two.priority = -1;
    m.t("settle", {"late"}, {}).priority = -5;
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:settle 1:one 1:two");
    CHECK(run.tokens("a") == 2);
}

TEST_CASE("what a firing with the occurrence makes possible may still use it [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.at(1, e);
    m.place("a", 1);
    m.t("first", {"a"}, {"b"}).events = {e};
    m.t("between", {"b"}, {"c"});
    m.t("second", {"c"}, {}).events = {e};
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:first 1:between 1:second");
}

TEST_CASE("on next: an occurrence is none for who was not waiting when it came [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.at(1, e);
    m.at(1, e);
    m.at(3, e);
    m.place("a", 1);
    for (const auto& [name, from, to] :
         {std::array{"first", "a", "b"}, std::array{"second", "b", "c"},
          std::array{"third", "c", "d"}}) {
        TransitionDraft& t = m.t(name, {from}, {to});
        t.events = {e};
        t.next_event = true;
    }
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:first 1:second 3:third");
}

TEST_CASE("on next: who stops waiting during an occurrence waits for another one [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.at(1, e);
    m.at(2, e);
    m.place("a", 1);
    m.place("go", 1);
    TransitionDraft& again = m.t("again", {"a", "go"}, {"a"});
    again.events = {e};
    again.priority = 2;
    TransitionDraft& t = m.t("t", {"a"}, {});
    t.events = {e};
    t.next_event = true;
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:again 2:t");
}

TEST_CASE("a consumed event is used up by the first; an unused one is lost and logged [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.draft.events[0].consumed = true;
    m.at(1, e);
    m.at(2, e);
    m.at(3, e);
    m.place("a", 1);
    m.place("b", 1);
    m.t("one", {"a"}, {}).events = {e};
    TransitionDraft& two = m.t("two", {"b"}, {});
    two.events = {e};
    two.priority = 0;
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:one 2:two 3:lost-e");
    CHECK(run.engine.notes().size() == 1);
}

TEST_CASE("a transition that names two events fires with either [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    const EventIndex f = m.event("f");
    m.at(1, f);
    m.at(2, e);
    m.place("a", 5);
    m.t("t", {"a"}, {}).events = {e, f};
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:t 2:t");
}

// A host whose movements raise events at given times.
class Host final : public MovementHost {
 public:
    SimTime begin(ActionIndex action, ActivityIndex activity, SimTime at, SimTime duration,
                  std::span<const std::int64_t> attributes) override {
        text += "begin" + std::to_string(action.value) + "." + std::to_string(activity.value) +
                "@" + std::to_string(at.ticks / kTicksPerMillisecond) +
                (attributes.empty() ? "" : "(" + std::to_string(attributes[0]) + ")") + " ";
        events.clear();
        if (action.value < raises.size()) {
            for (const RaisedEvent& r : raises[action.value]) {
                events.push_back({at + r.at, r.event});
            }
        }
        given.push_back(duration);
        return duration.ticks < 0 ? says : duration;
    }
    std::span<const RaisedEvent> raised(ActivityIndex) override { return events; }
    void cut(ActivityIndex activity, SimTime at) override {
        text += "cut" + std::to_string(activity.value) + "@" +
                std::to_string(at.ticks / kTicksPerMillisecond) + " ";
    }
    void left(ActivityIndex activity, SimTime at) override {
        text += "left" + std::to_string(activity.value) + "@" +
                std::to_string(at.ticks / kTicksPerMillisecond) + " ";
    }
    std::vector<std::vector<RaisedEvent>> raises;
    std::vector<RaisedEvent> events;
    std::vector<SimTime> given;
    SimTime says = seconds(0.5);
    std::string text;
};

TEST_CASE(
    "outside events come in file order, then movement events by path, then raised ones in firing "
    "order [unit]") {
    Maker m;
    EventIndex e[7];
    const char* names[] = {"out1", "out2", "move_a", "move_b", "raised1", "raised2", "later"};
    for (int i = 0; i < 7; ++i) {
        e[i] = m.event(names[i]);
        m.place(std::string("p") + names[i], 1);
        m.t(std::string("on_") + names[i], {std::string("p") + names[i]}, {}).events = {e[i]};
    }
    m.draft.transitions[0].raises = {e[4]};
    m.draft.transitions[1].raises = {e[5]};
    m.at(1, e[0]);
    m.at(1, e[1]);
    Host host;
    // The place z.b starts first but a.a comes first by path.
    m.place("z.b", 1, lasts(3)).action = ActionIndex{0};
    m.place("a.a", 1, lasts(3)).action = ActionIndex{1};
    host.raises = {{{seconds(1), e[3]}, {seconds(2), e[6]}}, {{seconds(1), e[2]}}};
    EngineOptions options;
    options.host = &host;
    Run run(m.net(), nullptr, options);
    run.until(10);
    CHECK(run.log.text ==
          "1:on_out1 1:on_out2 1:on_move_a 1:on_move_b 1:on_raised1 1:on_raised2 2:on_later");
}

TEST_CASE(
    "auto asks the movement after all assignments, and rounds up to a whole millisecond [unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 0);
    m.place("go", 1);
    PlaceDraft& step = m.place("step");
    step.action = ActionIndex{0};
    step.attributes = {{"size", {ValueKind::kInt, 0}}};
    TransitionDraft& t = m.t("start", {"go"}, {"step"});
    t.assignments = {set(n, Expr::integer(4))};
    t.outputs[0].attributes = {expr(ExprOp::kAdd, m.read(n), Expr::integer(3))};
    m.t("end", {"step"}, {});
    Host host;
    host.says = {kSecond / 2 + 1};
    EngineOptions options;
    options.host = &host;
    Run run(m.net(), nullptr, options);
    run.until(10);
    CHECK(run.log.text == "0:start 0.501:end");
    CHECK(host.text == "begin0.0@0(3) left0@501 ");  // attributes are of the state before
    CHECK(host.given[0].ticks < 0);
}

TEST_CASE("a movement that cannot be done stops the run and names the place [unit]") {
    Maker m;
    m.place("step", 1).action = ActionIndex{0};
    Host host;
    host.says = {-1};
    EngineOptions options;
    options.host = &host;
    Run run(m.net(), nullptr, options);
    CHECK(run.until(10) == Engine::Outcome::kFault);
    CHECK(run.engine.fault().code == "movement-impossible");
    CHECK(run.engine.fault().element == "place step");
    Run alone(m.net());
    CHECK(alone.until(10) == Engine::Outcome::kFault);
    CHECK(alone.engine.fault().code == "action-needs-host");
}

TEST_CASE(
    "now cuts a movement: it ends there and raises nothing more; at its end nothing is cut "
    "[unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.place("step", 1, lasts(4)).action = ActionIndex{0};
    m.place("tick", 1, lasts(2));
    m.place("p", 5);
    m.t("on", {"p"}, {}).events = {e};
    m.t("cut", {"tick", "now step"}, {});
    Host host;
    host.raises = {{{seconds(1), e}, {seconds(2), e}, {seconds(3), e}}};
    EngineOptions options;
    options.host = &host;
    SUBCASE("cut") {
        Run run(m.net(), nullptr, options);
        run.until(10);
        CHECK(run.log.text == "1:on 2:cut 2:on");
        CHECK(host.text == "begin0.0@0 cut0@2000 left0@2000 ");
    }
    SUBCASE("over") {
        m.place("tick").duration = lasts(4);
        Run run(m.net(), nullptr, options);
        run.until(10);
        CHECK(run.log.text == "1:on 2:on 3:on 4:cut");
        CHECK(host.text == "begin0.0@0 left0@4000 ");
    }
}

TEST_CASE("a crossing sets its sensor before it is offered, and guards see it at once [unit]") {
    Maker m;
    const DatumIndex near = m.datum("near", {ValueKind::kBool, 0}, 0);
    m.draft.data[0].sensor = true;
    const EventIndex rises = m.event("near.rises");
    const EventIndex falls = m.event("near.falls");
    m.draft.events[0].sets = near;
    m.draft.events[0].sets_to = true;
    m.draft.events[1].sets = near;
    m.place("a", 1);
    m.place("b", 1);
    m.t("grab", {"a"}, {"held"}).guard = m.read(near);
    m.t("drop", {"held"}, {}).guard = Expr::unary(ExprOp::kNot, m.read(near)).value();
    m.t("on_rise", {"b"}, {}).events = {rises};
    m.draft.transitions.back().priority = 0;
    m.at(1, rises);
    m.at(2, falls);
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "1:grab 1:on_rise 2:drop");
}

TEST_CASE("an event that is scheduled every so often keeps its place in the file's order [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    const EventIndex f = m.event("f");
    m.at(0, e);
    m.draft.schedule.back().every = seconds(2);
    m.at(0, f);
    m.draft.schedule.back().every = seconds(1);
    m.place("a", 9);
    m.t("te", {"a"}, {}).events = {e};
    m.t("tf", {"a"}, {}).events = {f};
    Run run(m.net());
    run.until(2.5);
    CHECK(run.log.text == "0:te 0:tf 1:tf 2:te 2:tf");
}

TEST_CASE(
    "too many firings in one instant stop the run and name the cycle, or the place that grows "
    "[unit]") {
    Maker m;
    m.place("a", 1);
    m.place("clock", 1, lasts(9));
    m.t("there", {"a"}, {"b"});
    TransitionDraft& back = m.t("back", {"b"}, {"a"});
    SUBCASE("cycle") {
        Run run(m.net());
        CHECK(run.until(10) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().code == "endless-instant");
        CHECK(run.engine.fault().element == "transition there");
        CHECK(run.engine.fault().message.find("there, back") != std::string::npos);
        CHECK(run.engine.state().firings == 100000);
    }
    SUBCASE("growth") {
        back.outputs.push_back(m.output("heap"));
        EngineOptions options;
        options.firings_per_instant = 500;
        Run run(m.net(), nullptr, options);
        CHECK(run.until(10) == Engine::Outcome::kFault);
        CHECK(run.engine.fault().element == "place heap");
        CHECK(run.engine.state().firings == 500);
    }
}

TEST_CASE("a net without any time fires once per beat; its events wait for it to settle [unit]") {
    Maker m;
    const EventIndex e = m.event("e");
    m.place("a", 2);
    m.place("b", 2);
    m.t("t", {"a"}, {"c"});
    m.t("on", {"b", "2*c"}, {}).events = {e};
    EngineOptions options;
    options.beat = seconds(0.5).ticks;
    Run run(m.net(), nullptr, options);
    CHECK(run.net.paced());
    run.engine.occur(e, {0});
    run.engine.occur(e, seconds(7));
    CHECK(run.until(100) == Engine::Outcome::kDead);
    CHECK(run.log.text == "0:t 0.5:t 1:on 7:lost-e");
}

TEST_CASE("pace does not change which firings happen [law]") {
    const auto order = [](bool paced) {
        Maker m;
        for (int i = 0; i < 5; ++i) {
            const std::string n = std::to_string(i);
            m.place("fork" + n, 1);
            m.t("take" + n, {"fork" + n, "fork" + std::to_string((i + 1) % 5)}, {"eat" + n});
        }
        if (!paced) {
            m.place("clock", 1, lasts(100));
        }
        Run run(m.net());
        CHECK(run.net.paced() == paced);
        std::string all;
        while (run.engine.step(50 * kSecond) == Engine::Outcome::kFired) {
            all += std::string(run.net.transition({run.engine.state().last}).path) + " ";
        }
        return all;
    };
    CHECK(order(true) == order(false));
}

TEST_CASE("a run stops at its limit of time with all of that instant played [unit]") {
    Maker m;
    m.place("a", 1, lasts(1));
    m.t("t", {"a"}, {"a"});
    Run run(m.net());
    CHECK(run.until(3) == Engine::Outcome::kSettled);
    CHECK(run.engine.state().firings == 3);
    CHECK(run.engine.state().now == 3 * kSecond);
    CHECK(run.until(3.5) == Engine::Outcome::kSettled);
    CHECK(run.engine.state().now == seconds(3.5).ticks);
    CHECK(run.engine.next_time() == 4 * kSecond);
}

}  // namespace
}  // namespace puppetri::net
