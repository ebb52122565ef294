// SPDX-License-Identifier: MIT
// Channels: every matching send and receive of two owners is one transition. The oracle is a direct
// interpreter of the two sides, which knows nothing of nets.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>

#include "maker.h"

namespace puppetri::net {
namespace {

bool has(const std::vector<std::string>& codes, const char* code) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

// Adds the end of a channel to transition `name`.
ChannelEnd& send(Maker& m, ChannelDraft& c, const std::string& name, std::uint32_t owner) {
    return c.sends.emplace_back(ChannelEnd{.transition = m.index(name), .owner = owner});
}
ChannelEnd& receive(Maker& m, ChannelDraft& c, const std::string& name, std::uint32_t owner) {
    return c.receives.emplace_back(ChannelEnd{.transition = m.index(name), .owner = owner});
}

// a sends 1 or 2; b takes 1, takes 2, or takes anything into y.
struct Three {
    Maker m;
    DatumIndex x = m.integer("x", 7), y = m.integer("y", 0);
    Three() {
        m.place("a", 1);
        m.place("b", 1);
        m.t("a.one", {"a"}, {"a1"});
        m.t("a.any", {"a"}, {"a2"});
        m.t("b.one", {"b"}, {"b1"});
        m.t("b.two", {"b"}, {"b2"});
        m.t("b.any", {"b"}, {"b3"});
        ChannelDraft c;
        c.path = "c";
        send(m, c, "a.one", 1).message = Expr::integer(1);
        send(m, c, "a.any", 1).message = m.read(x);
        receive(m, c, "b.one", 2).message = Expr::integer(1);
        receive(m, c, "b.two", 2).message = Expr::integer(2);
        receive(m, c, "b.any", 2).into = y;
        m.draft.channels.push_back(c);
    }
};

TEST_CASE("every send meets every receive that may take its message [unit]") {
    Three t;
    const Net net = t.m.net();
    std::set<std::string> paths;
    for (std::uint32_t i = 0; i < net.transition_count(); ++i) {
        paths.insert(std::string(net.transition({i}).path));
    }
    // 1 is not 2, so that a.one never meets b.two; x may be anything.
    CHECK(paths == std::set<std::string>{"a.one|b.one", "a.one|b.any", "a.any|b.one", "a.any|b.two",
                                         "a.any|b.any"});
    CHECK(net.transition_of_draft(t.m.index("a.one")) == net.find_transition("a.one|b.one"));
}

TEST_CASE("a message meets a constant as a guard, and is assigned to a variable [unit]") {
    Three t;
    Run run(t.m.net());
    const auto fireable = [&](const char* path) {
        return run.engine.fireable(run.net.find_transition(path));
    };
    CHECK(fireable("a.one|b.one"));
    CHECK(fireable("a.one|b.any"));
    CHECK(fireable("a.any|b.any"));
    CHECK_FALSE(fireable("a.any|b.one"));  // x = 7
    CHECK_FALSE(fireable("a.any|b.two"));
    t.m.draft.transitions[t.m.index("a.any").value].priority = 3;
    Run first(t.m.net());
    first.until(10);
    CHECK(first.log.text == "0:a.any|b.any");
    CHECK(first.datum("y") == 7);
    CHECK(first.tokens("a2") == 1);
    CHECK(first.tokens("b3") == 1);
}

TEST_CASE("each product has a copy of the variables of both sides [unit]") {
    // The token of `a` carries the message; the receiver binds a variable of its own.
    Maker m;
    for (const char* name : {"a", "b"}) {
        m.place(name).attributes = {{"n", {ValueKind::kInt, 0}}};
        InitialToken token;
        token.attributes = {name[0] == 'a' ? 5 : 6};
        m.place(name).tokens = {token};
    }
    m.place("out").attributes = {{"n", {ValueKind::kInt, 0}}};
    m.place("back").attributes = {{"n", {ValueKind::kInt, 0}}};
    const DatumIndex y = m.integer("y", 0);
    const auto binds = [&](TransitionDraft& t) {
        t.variables = {{"v", {ValueKind::kInt, 0}}};
        PatternDraft p;
        p.binds = 0;
        t.inputs[0].pattern = {p};
        t.outputs[0].attributes = {Maker::variable(t, 0)};
    };
    binds(m.t("say", {"a"}, {"out"}));
    binds(m.t("hear", {"b"}, {"back"}));
    ChannelDraft c;
    c.path = "c";
    send(m, c, "say", 1).message = Maker::variable(m.draft.transitions[0], 0);
    receive(m, c, "hear", 2).into = y;
    m.draft.channels.push_back(c);
    {
        Run run(m.net());
        run.until(1);
        CHECK(run.log.text == "0:say|hear");
        CHECK(run.datum("y") == 5);
        CHECK(run.tokens("back") == 1);
    }
    // A pattern over the receiver's own variable: 5 is not 6.
    m.draft.channels[0].receives[0].into = {};
    m.draft.channels[0].receives[0].message = Maker::variable(m.draft.transitions[1], 0);
    Run run(m.net());
    run.until(1);
    CHECK(run.log.text.empty());
}

TEST_CASE("statements about an end are about any of its products [unit]") {
    Three t;
    NetDraft& d = t.m.draft;
    d.states.push_back(
        {.path = "any",
         .condition = Formula::unary(FormulaOp::kNot, Formula::fires(t.m.index("a.any")))});
    Rule possible{.path = "q", .kind = RuleKind::kQuasiLive};
    possible.transitions = {t.m.index("b.two")};
    d.rules.push_back(possible);
    possible.transitions = {t.m.index("a.any")};
    d.rules.push_back(possible);
    const Net net = t.m.net();
    const NetDraft& now = net.declarations();
    std::set<std::string> named;
    int ors = 0;
    for (const Formula::Node& n : now.states[0].condition.nodes) {
        if (n.op == FormulaOp::kFires) {
            named.insert(std::string(net.transition({n.index}).path));
        }
        ors += n.op == FormulaOp::kOr ? 1 : 0;
    }
    CHECK(named == std::set<std::string>{"a.any|b.one", "a.any|b.two", "a.any|b.any"});
    CHECK(ors == 2);
    CHECK(now.states[0].condition.nodes.back().op == FormulaOp::kNot);
    // b.two meets a.any alone: one transition, named as such.
    CHECK(now.rules[0].kind == RuleKind::kQuasiLive);
    CHECK(now.rules[0].transitions ==
          std::vector<TransitionIndex>{net.find_transition("a.any|b.two")});
    // "Some product fires" is "one of them is possible", exactly.
    CHECK(now.rules[1].kind == RuleKind::kPossible);
    // "Every one of them is live" is not what `live` of the end says.
    Rule live{.path = "l", .kind = RuleKind::kLive};
    live.transitions = {t.m.index("a.any")};
    d.rules.push_back(live);
    CHECK(has(t.m.codes(), "rule-of-many"));
}

TEST_CASE("what a channel cannot be is told [unit]") {
    const auto codes = [](auto change) {
        Three t;
        change(t.m.draft.channels[0], t.m);
        return t.m.codes();
    };
    CHECK(codes([](ChannelDraft&, Maker&) {}).empty());
    CHECK(has(codes([](ChannelDraft& c, Maker&) { c.sends.clear(); }), "unmatched-channel-end"));
    CHECK(has(codes([](ChannelDraft& c, Maker&) { c.receives.clear(); }), "unmatched-channel-end"));
    CHECK(has(codes([](ChannelDraft& c, Maker&) { c.sends[1].owner = 3; }), "two-senders"));
    CHECK(has(codes([](ChannelDraft& c, Maker&) { c.receives[1].owner = 3; }), "two-receivers"));
    CHECK(codes([](ChannelDraft& c, Maker&) {
              c.receives[1].owner = 3;
              c.shared = true;
          }).empty());
    CHECK(has(codes([](ChannelDraft& c, Maker&) {
                  for (ChannelEnd& end : c.receives) {
                      end.owner = 1;
                  }
              }),
              "channel-within"));
    CHECK(has(codes([](ChannelDraft& c, Maker&) {
                  c.receives.push_back({.transition = c.sends[0].transition, .owner = 2});
              }),
              "two-channel-ends"));
    CHECK(has(codes([](ChannelDraft& c, Maker&) { c.receives[0].message = Expr::boolean(true); }),
              "type-mismatch"));
    CHECK(
        has(codes([](ChannelDraft& c, Maker&) { c.sends[0].transition = {99}; }), "unknown-index"));
    Three t;
    t.m.draft.channels[0].sends.pop_back();
    Checked<Net> net = compile(t.m.draft);
    REQUIRE(net.has_value());
    REQUIRE(net->notes().size() == 1);  // b.two waits for a 2 that nobody sends
    CHECK(net->notes()[0].code == "rendezvous-never");
}

// Two or three machines over one channel for each pair in one direction, with a variable each: what
// the paper's definition says, step by step.
struct Machine {
    struct Action {
        int from, to;
        int channel;  // -1: assigns
        bool sends;
        int constant;  // sent, wanted or assigned; -1: the variable
    };
    std::vector<Action> actions;
    int state = 0, variable = 0;
};

TEST_CASE("random machines do what a direct interpreter of them says [oracle]") {
    std::mt19937 random(11);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    int met = 0, alone = 0, stuck = 0;
    for (int round = 0; round < 400; ++round) {
        const int count = 2 + below(2), states = 3;
        std::vector<Machine> machines(static_cast<std::size_t>(count));
        for (int k = 0; k < count; ++k) {
            for (int a = 0; a < 6; ++a) {
                Machine::Action action{below(states), below(states), below(4) - 1, false, 0};
                // Channel c goes from machine c % count to the next.
                if (action.channel >= count) {
                    action.channel = -1;
                }
                if (action.channel >= 0) {
                    const int to = (action.channel + 1) % count;
                    if (k != action.channel && k != to) {
                        action.channel = -1;
                    }
                    action.sends = k == action.channel;
                }
                action.constant = below(4) - 1;
                if (action.channel < 0 && action.constant < 0) {
                    action.constant = 0;
                }
                machines[static_cast<std::size_t>(k)].actions.push_back(action);
            }
        }
        // As a net.
        Maker m;
        std::vector<ChannelDraft> channels(static_cast<std::size_t>(count));
        std::vector<DatumIndex> data;
        for (int k = 0; k < count; ++k) {
            data.push_back(m.integer("v" + std::to_string(k), 0));
        }
        const auto state_name = [](int k, int s) {
            return std::to_string(k) + ".s" + std::to_string(s);
        };
        for (int k = 0; k < count; ++k) {
            m.place(state_name(k, 0), 1);
            const Machine& machine = machines[static_cast<std::size_t>(k)];
            for (std::size_t a = 0; a < machine.actions.size(); ++a) {
                const Machine::Action& action = machine.actions[a];
                const std::string name = std::to_string(k) + ".t" + std::to_string(a);
                TransitionDraft& t =
                    m.t(name, {state_name(k, action.from)}, {state_name(k, action.to)});
                const auto own = data[static_cast<std::size_t>(k)];
                if (action.channel < 0) {
                    t.assignments = {{own, Expr::integer(action.constant), {}}};
                    continue;
                }
                ChannelDraft& c = channels[static_cast<std::size_t>(action.channel)];
                const auto owner = static_cast<std::uint32_t>(k);
                if (action.sends) {
                    send(m, c, name, owner).message =
                        action.constant < 0 ? m.read(own) : Expr::integer(action.constant);
                } else if (action.constant < 0) {
                    receive(m, c, name, owner).into = own;
                } else {
                    receive(m, c, name, owner).message = Expr::integer(action.constant);
                }
            }
        }
        for (std::size_t c = 0; c < channels.size(); ++c) {
            channels[c].path = "c" + std::to_string(c);
            if (channels[c].sends.empty() || channels[c].receives.empty()) {
                // What cannot meet is left out, ends and all: both sides never fire.
                for (const auto* list : {&channels[c].sends, &channels[c].receives}) {
                    for (const ChannelEnd& end : *list) {
                        m.draft.transitions[end.transition.value].guard = Expr::boolean(false);
                    }
                }
                continue;
            }
            m.draft.channels.push_back(channels[c]);
        }
        Run run(m.net(), nullptr, {.seed = static_cast<std::uint64_t>(round)});
        for (int step = 0; step < 30; ++step) {
            // What the machines may do now.
            std::set<std::string> wanted;
            for (int k = 0; k < count; ++k) {
                const Machine& machine = machines[static_cast<std::size_t>(k)];
                for (std::size_t a = 0; a < machine.actions.size(); ++a) {
                    const Machine::Action& action = machine.actions[a];
                    if (action.from != machine.state || (action.channel >= 0 && !action.sends)) {
                        continue;
                    }
                    const std::string name = std::to_string(k) + ".t" + std::to_string(a);
                    if (action.channel < 0) {
                        wanted.insert(name);
                        continue;
                    }
                    const int to = (k + 1) % count;
                    const Machine& other = machines[static_cast<std::size_t>(to)];
                    const int message = action.constant < 0 ? machine.variable : action.constant;
                    for (std::size_t b = 0; b < other.actions.size(); ++b) {
                        const Machine::Action& hears = other.actions[b];
                        if (hears.from == other.state && hears.channel == action.channel &&
                            !hears.sends && (hears.constant < 0 || hears.constant == message)) {
                            wanted.insert(name + "|" + std::to_string(to) + ".t" +
                                          std::to_string(b));
                        }
                    }
                }
            }
            std::set<std::string> got;
            for (std::uint32_t t = 0; t < run.net.transition_count(); ++t) {
                if (run.engine.fireable({t})) {
                    got.insert(std::string(run.net.transition({t}).path));
                }
            }
            REQUIRE(got == wanted);
            if (wanted.empty()) {
                ++stuck;
                break;
            }
            run.log.text.clear();
            run.until(1000, static_cast<std::uint64_t>(step) + 1);
            const std::string fired = run.log.text.substr(run.log.text.find(':') + 1);
            REQUIRE(wanted.count(fired) == 1);
            // And what it does to them.
            const auto digit = [&](std::size_t i) { return fired[i] - '0'; };
            Machine& first = machines[static_cast<std::size_t>(digit(0))];
            const Machine::Action& action = first.actions[static_cast<std::size_t>(digit(3))];
            const int message = action.constant < 0 ? first.variable : action.constant;
            first.state = action.to;
            if (action.channel < 0) {
                first.variable = action.constant;
                ++alone;
            } else {
                Machine& second = machines[static_cast<std::size_t>(digit(5))];
                const Machine::Action& hears = second.actions[static_cast<std::size_t>(digit(8))];
                second.state = hears.to;
                if (hears.constant < 0) {
                    second.variable = message;
                }
                ++met;
            }
            for (int k = 0; k < count; ++k) {
                const Machine& machine = machines[static_cast<std::size_t>(k)];
                REQUIRE(run.datum("v" + std::to_string(k)) == machine.variable);
                REQUIRE(run.tokens(state_name(k, machine.state)) == 1);
            }
        }
    }
    CHECK(met > 500);  // the test is about meetings
    CHECK(alone > 500);
    CHECK(stuck > 10);
}

TEST_CASE("a holding time and a rendezvous in one net keep their numbers [unit]") {
    Maker m;
    m.place("p", 1);
    m.place("q", 1);
    m.place("r", 1);
    m.t("a", {"p"}, {});
    m.t("b", {"q"}, {});
    m.t("work", {"r"}, {"done"}).holding = lasts(2);
    m.p("work.busy");
    m.t("work.end", {}, {});
    m.draft.transitions[2].busy = m.p("work.busy");
    m.draft.transitions[2].end = {3};
    m.draft.rendezvous.push_back({{0}, {1}});
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:a|b 0:work.begin 2:work.end");
    CHECK(run.tokens("done") == 1);
}

}  // namespace
}  // namespace puppetri::net
