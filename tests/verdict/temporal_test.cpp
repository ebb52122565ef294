// SPDX-License-Identifier: MIT
// Rules in branching and linear time, about firings too: against their definitions on random nets
// without time, against runs that end or come back on random nets with everything, and by hand.
// PUPPETRI_LONG=1 takes many more nets.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "naive_logic.h"
#include "proved_scene.h"
#include "puppetri/net/state.h"
#include "puppetri/run/player.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::RuleKind;

int times(int n) { return std::getenv("PUPPETRI_LONG") != nullptr ? 30 * n : n; }

net::Rule rule_of(Formula f, std::size_t number) {
    net::Rule rule;
    rule.path = "r" + std::to_string(number);
    rule.kind = RuleKind::kFormula;
    rule.operands.push_back(std::move(f));
    return rule;
}

net::NetDraft draft_of(const proof::PlainNet& plain) {
    net::NetDraft draft;
    for (std::uint32_t p = 0; p < plain.place_count(); ++p) {
        net::PlaceDraft place;
        place.path = "p" + std::to_string(p);
        if (plain.initial[p] > 0) {
            place.tokens.push_back({.count = plain.initial[p]});
        }
        draft.places.push_back(std::move(place));
    }
    for (std::uint32_t t = 0; t < plain.transition_count(); ++t) {
        net::TransitionDraft transition;
        transition.path = "t" + std::to_string(t);
        const auto arcs = [&](std::span<const net::Weighted> row, net::ArcKind kind) {
            for (const net::Weighted& w : row) {
                transition.inputs.push_back(
                    {.kind = kind, .place = net::PlaceIndex{w.place}, .weight = w.weight});
            }
        };
        arcs(plain.takes.row(t), net::ArcKind::kTake);
        arcs(plain.reads.row(t), net::ArcKind::kRead);
        arcs(plain.unless.row(t), net::ArcKind::kUnless);
        for (const net::Weighted& w : plain.gives.row(t)) {
            transition.outputs.push_back({.place = net::PlaceIndex{w.place}, .weight = w.weight});
        }
        transition.priority = static_cast<std::int64_t>(plain.level[t]) + 1;
        draft.transitions.push_back(std::move(transition));
    }
    return draft;
}

// Plays the transitions of a witness by hand.
std::vector<naive::Moment> letters(const proof::PlainNet& plain, const Witness& w) {
    std::vector<naive::Moment> out = {{plain.initial, naive::kNothing}};
    proof::Marking m = plain.initial;
    for (const Witness::Step& step : w.steps) {
        const auto t = static_cast<std::uint32_t>(std::stoul(step.transition.substr(1)));
        REQUIRE(plain.enabled(m, t));
        plain.fire(m, t);
        out.push_back({m, t});
    }
    return out;
}

TEST_CASE("temporal rules about firings are what their definitions say, without time [oracle]") {
    int proved = 0, refuted = 0, witnesses = 0;
    for (int i = 0; i < times(250); ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "temporal", "plain"), 0};
        const proof::PlainNet plain =
            test::random_plain_net(stream, {.optional = false, .conserving = true});
        const test::NaiveGraph graph = test::naive_graph(plain, 60);
        // A transition that takes nothing has to wait for something.
        bool sources = false;
        for (std::uint32_t t = 0; t < plain.transition_count(); ++t) {
            sources = sources || plain.takes.row(t).empty();
        }
        if (!graph.complete || sources) {
            continue;
        }
        net::NetDraft draft = draft_of(plain);
        for (std::size_t k = 0; k < 10; ++k) {
            draft.rules.push_back(
                rule_of(naive::random_formula(stream, plain.place_count(), plain.transition_count(),
                                              k % 2 == 0, true, 3),
                        k));
        }
        auto net = net::compile(draft);
        REQUIRE(net.has_value());
        if (net->place_count() != plain.place_count()) {
            continue;
        }
        ProveOptions options;
        options.built_in = false;
        options.budget.seconds = 10;
        const std::vector<Verdict> verdicts = prove(draft, *net, options);
        const naive::Structure all = naive::structure(graph);
        for (std::size_t k = 0; k < verdicts.size(); ++k) {
            const Formula& f = draft.rules[k].operands[0];
            const bool temporal = std::any_of(f.nodes.begin(), f.nodes.end(), [](const auto& n) {
                return n.op >= net::FormulaOp::kAllNext;
            });
            if (!temporal) {
                continue;  // of the start alone
            }
            const Verdict& v = verdicts[k];
            INFO("net " << i << " rule " << k << " " << name_of(v) << " " << v.reason);
            REQUIRE(v.answer != Answer::kSampled);
            if (k % 2 == 1) {
                CHECK(v.answer == (naive::holds(f, all, 0) ? Answer::kProved : Answer::kRefuted));
                (v.answer == Answer::kProved ? proved : refuted)++;
                continue;
            }
            CHECK(v.answer != Answer::kUnknown);
            if (v.answer == Answer::kRefuted) {
                ++refuted;
                REQUIRE(v.witness.has_value());
                std::vector<naive::Moment> run = letters(plain, *v.witness);
                std::size_t back = run.size() - 1;
                if (v.witness->lasso_from != Witness::kNone) {
                    // Round once more, for what has fired when it comes back.
                    REQUIRE(v.witness->lasso_from < v.witness->steps.size());
                    REQUIRE(run[v.witness->lasso_from].tokens == run.back().tokens);
                    back = v.witness->lasso_from + 1;
                    const naive::Moment again = run[back];
                    const std::vector<naive::Moment> rest(
                        run.begin() + static_cast<std::ptrdiff_t>(back) + 1, run.end());
                    const std::size_t first = run.size();
                    run.push_back(again);
                    run.insert(run.end(), rest.begin(), rest.end());
                    back = first;
                } else {
                    // It ends here, or nothing that follows matters.
                    run.push_back({run.back().tokens, naive::kNothing});
                    back = run.size() - 1;
                    bool dead = true;
                    for (std::uint32_t t = 0; t < plain.transition_count(); ++t) {
                        dead = dead && !plain.enabled(run.back().tokens, t);
                    }
                    REQUIRE(dead);
                }
                CHECK_FALSE(naive::holds(f, naive::word(run, back), 0));
                ++witnesses;
                continue;
            }
            ++proved;
            // Random ways until a moment comes again, or nothing follows.
            for (int r = 0; r < 40; ++r) {
                std::vector<std::uint32_t> way = {0};
                std::map<std::uint32_t, std::size_t> at = {{0, 0}};
                std::size_t back = 0;
                for (;;) {
                    const auto& next = all.next[way.back()];
                    if (next.empty()) {
                        back = way.size() - 1;
                        break;
                    }
                    const std::uint32_t to = next[stream.below(next.size())];
                    const auto [found, fresh] = at.try_emplace(to, way.size());
                    if (!fresh && stream.below(3) != 0) {
                        back = found->second;
                        break;
                    }
                    way.push_back(to);
                    at[to] = way.size() - 1;
                }
                std::vector<naive::Moment> run;
                for (const std::uint32_t n : way) {
                    run.push_back(all.moments[n]);
                }
                CHECK(naive::holds(f, naive::word(std::move(run), back), 0));
            }
        }
    }
    MESSAGE(proved << " proved, " << refuted << " refuted, " << witnesses
                   << " witnesses looked at");
    CHECK(proved > 100);
    CHECK(witnesses > 100);
}

TEST_CASE(
    "where a net is dead it stands: one step of EX and AX, whatever the formula asks for [unit]") {
    const ProvedScene s(R"(
place a tokens 1
place b
go: a -> b
rule stays  ctl AG(b implies EX(b))
rule all    ctl AG(b implies AX(b))
rule firing ctl AG(b implies EX(b and not go))
rule either ctl AG(b implies (EX(b) or go))
rule gone   ctl AG(b implies EX(a))
)");
    for (const char* rule : {"stays", "all", "firing", "either"}) {
        CHECK(s.of(rule).answer == Answer::kProved);
    }
    CHECK(s.of("gone").answer == Answer::kRefuted);
}

class AnyChooser final : public net::Chooser {
 public:
    explicit AnyChooser(RandomStream& stream) : stream_(stream) {}
    std::int64_t choose(const net::Choice& choice) override {
        if (choice.options != 0) {
            return static_cast<std::int64_t>(stream_.below(choice.options));
        }
        const std::int64_t low = choice.low.ticks, high = choice.high.ticks;
        return stream_.below(2) == 0 || high == SimTime::never().ticks
                   ? std::clamp(choice.drawn.ticks, low, high)
                   : high;
    }

 private:
    RandomStream& stream_;
};

TEST_CASE("no run that ends or comes back contradicts a temporal verdict [agree]") {
    int proved = 0, refuted = 0, runs = 0;
    for (int i = 0; i < times(250); ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "temporal", "net"), 0};
        net::NetDraft draft = test::random_net(stream);
        auto first = net::compile(draft);
        REQUIRE(first.has_value());
        if (first->place_count() == 0 || first->transition_count() == 0 ||
            first->place_count() != draft.places.size() ||
            first->transition_count() != draft.transitions.size()) {
            continue;  // lowering has renumbered it
        }
        for (std::size_t k = 0; k < 12; ++k) {
            draft.rules.push_back(rule_of(
                naive::random_formula(stream, first->place_count(), first->transition_count(), true,
                                      false, k % 2 == 0 ? 2 : 3),
                k));
        }
        auto net = net::compile(draft);
        REQUIRE(net.has_value());
        ProveOptions options;
        options.built_in = false;
        options.budget.seconds = 0.4;
        options.budget.states = 3000;
        const std::vector<Verdict> verdicts = prove(draft, *net, options);
        for (const Verdict& v : verdicts) {
            proved += v.answer == Answer::kProved ? 1 : 0;
            refuted += v.answer == Answer::kRefuted ? 1 : 0;
        }
        for (int r = 0; r < 25; ++r) {
            AnyChooser chooser(stream);
            run::Player player(*net, {.seed = static_cast<std::uint64_t>(r), .chooser = &chooser});
            std::vector<naive::Moment> word;
            const auto look = [&](std::uint32_t fired) {
                naive::Moment m{{}, fired};
                for (std::uint32_t p = 0; p < net->place_count(); ++p) {
                    m.tokens.push_back(player.tokens(net::PlaceIndex{p}));
                }
                word.push_back(std::move(m));
            };
            look(naive::kNothing);
            std::map<std::vector<std::uint8_t>, std::pair<std::size_t, SimTime>> seen;
            std::optional<std::size_t> back;
            for (int step = 0; step < 80 && !back; ++step) {
                if (net->event_count() > 0 && stream.below(6) == 0) {
                    const net::EventIndex e{
                        static_cast<std::uint32_t>(stream.below(net->event_count()))};
                    if (net->declarations().events[e.value].outside) {
                        player.push(e);
                    }
                }
                run::Stop stop = player.step({.until = player.now()});
                if (stop == run::Stop::kLimit) {
                    look(naive::kNothing);  // time passes
                    stop = player.step(
                        {.until = player.now() + SimTime{10'000 * test::kRandomNetUnit}});
                }
                if (stop == run::Stop::kDead || stop == run::Stop::kFinal) {
                    look(naive::kNothing);
                    back = word.size() - 1;
                } else if (stop != run::Stop::kNone) {
                    break;
                } else {
                    look(player.last().value);
                    std::vector<std::uint8_t> state;
                    const auto bytes = player.snapshot();
                    const auto read = net::read_state(*net, bytes);
                    REQUIRE(read.has_value());
                    net::canonical(*net, *read, state);
                    const auto [at, fresh] =
                        seen.try_emplace(std::move(state), word.size() - 1, player.now());
                    if (!fresh && at->second.second < player.now()) {
                        back = at->second.first + 1;
                    }
                }
            }
            if (!back || *back >= word.size()) {
                continue;
            }
            ++runs;
            const naive::Structure s = naive::word(std::move(word), *back);
            for (std::size_t k = 0; k < verdicts.size(); ++k) {
                if (verdicts[k].answer == Answer::kProved) {
                    CHECK_MESSAGE(naive::holds(draft.rules[k].operands[0], s, 0),
                                  "net " << i << ", rule " << k << " by " << verdicts[k].method
                                         << "\n"
                                         << test::show(draft));
                }
            }
        }
    }
    MESSAGE(proved << " proved, " << refuted << " refuted, " << runs << " runs");
    CHECK(proved > 200);
    CHECK(runs > 200);
}

}  // namespace
}  // namespace puppetri::verdict
