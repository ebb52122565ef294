// SPDX-License-Identifier: MIT
// Rules of nets without time against a naive exploration: once edge by edge, once by what markings
// alone decide (walks, reductions, decision diagrams, ...). 300 nets; PUPPETRI_LONG=1 takes 10 000.
// Every witness is played and looked at here.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "puppetri/proof/plain_net.h"
#include "puppetri/run/player.h"
#include "puppetri/verdict/prove.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;
using net::RuleKind;
using proof::Marking;

// All markings, by the shortest code that can be seen to be right.
struct Naive {
    std::vector<Marking> states;
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> edges;  // transition, to
    std::map<Marking, std::uint32_t> number;
    bool whole = true;

    explicit Naive(const proof::PlainNet& net) {
        add(net.initial);
        for (std::uint32_t s = 0; s < states.size() && whole; ++s) {
            std::uint32_t highest = 0;
            for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
                if (net.enabled(states[s], t)) {
                    highest = std::max(highest, net.level[t]);
                }
            }
            for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
                if (net.enabled(states[s], t) && net.level[t] == highest) {
                    Marking next = states[s];
                    net.fire(next, t);
                    const std::uint32_t to = add(next);
                    edges[s].emplace_back(t, to);
                }
            }
            whole = states.size() < 2000;
        }
    }
    std::uint32_t add(const Marking& m) {
        const auto [at, fresh] = number.try_emplace(m, static_cast<std::uint32_t>(states.size()));
        if (fresh) {
            states.push_back(m);
            edges.emplace_back();
        }
        return at->second;
    }
    // From which states a member of the set can be reached.
    std::vector<bool> leading_to(std::vector<bool> set) const {
        for (bool more = true; more;) {
            more = false;
            for (std::uint32_t s = 0; s < states.size(); ++s) {
                for (const auto& [t, to] : edges[s]) {
                    if (set[to] && !set[s]) {
                        set[s] = more = true;
                    }
                }
            }
        }
        return set;
    }
    // From which states every path gets to the set.
    std::vector<bool> bound_for(std::vector<bool> set) const {
        for (bool more = true; more;) {
            more = false;
            for (std::uint32_t s = 0; s < states.size(); ++s) {
                bool all = !edges[s].empty();
                for (const auto& [t, to] : edges[s]) {
                    all = all && set[to];
                }
                if (all && !set[s]) {
                    set[s] = more = true;
                }
            }
        }
        return set;
    }
    std::vector<bool> enabling(std::uint32_t t) const {
        std::vector<bool> set(states.size());
        for (std::uint32_t s = 0; s < states.size(); ++s) {
            for (const auto& [u, to] : edges[s]) {
                set[s] = set[s] || u == t;
            }
        }
        return set;
    }
    template <class Test>
    std::vector<bool> where(Test&& test) const {
        std::vector<bool> set(states.size());
        for (std::uint32_t s = 0; s < states.size(); ++s) {
            set[s] = test(states[s]);
        }
        return set;
    }
    std::vector<bool> dead() const {
        std::vector<bool> set(states.size());
        for (std::uint32_t s = 0; s < states.size(); ++s) {
            set[s] = edges[s].empty();
        }
        return set;
    }
};

bool all(const std::vector<bool>& set) {
    return std::find(set.begin(), set.end(), false) == set.end();
}
bool any(const std::vector<bool>& set) {
    return std::find(set.begin(), set.end(), true) != set.end();
}
std::vector<bool> none_of(std::vector<bool> set) {
    set.flip();
    return set;
}

// What is asked, and the naive answer: whether it holds, and where a witness has to lead (of
// `possible`: one that proves it).
struct Question {
    net::Rule rule;
    bool holds = false;
    std::vector<bool> shown_by;
    bool before_firing = false;  // the state before the last firing shows it
    bool lucky = false;          // it holds unless ties are lost for ever
};

std::vector<Question> questions(RandomStream& stream, const net::Net& net, const Naive& naive) {
    std::vector<Question> list;
    const auto ask = [&](RuleKind kind, std::vector<Formula> operands) -> Question& {
        Question q;
        q.rule.path = "r" + std::to_string(list.size());
        q.rule.kind = kind;
        q.rule.operands = std::move(operands);
        list.push_back(std::move(q));
        return list.back();
    };
    const auto place = [&] { return static_cast<std::uint32_t>(stream.below(net.place_count())); };
    const auto transition = [&] {
        return static_cast<std::uint32_t>(stream.below(net.transition_count()));
    };
    const auto marked = [](std::uint32_t p) { return Formula::marked(net::PlaceIndex{p}); };
    const std::uint32_t a = place(), b = place(), c = place(), t = transition();
    const auto has = [&](std::uint32_t p) {
        return naive.where([p](const Marking& m) { return m[p] > 0; });
    };
    const auto count = [&](bool one) {
        return naive.where([&](const Marking& m) {
            const int n = (m[a] > 0) + (m[b] > 0) + (m[c] > 0);
            return n > 1 || (one && n == 0);
        });
    };
    const auto state_rule = [&](Question& q, std::vector<bool> bad) {
        q.holds = !any(bad);
        q.shown_by = std::move(bad);
    };
    {
        std::vector<bool> both = has(a);
        for (std::uint32_t s = 0; s < both.size(); ++s) {
            both[s] = both[s] && naive.states[s][b] > 0;
        }
        state_rule(ask(RuleKind::kNever, {Formula::binary(FormulaOp::kAnd, marked(a), marked(b))}),
                   both);
        Question& p =
            ask(RuleKind::kPossible, {Formula::binary(FormulaOp::kAnd, marked(a), marked(b))});
        p.holds = any(both);
        p.shown_by = both;
    }
    state_rule(ask(RuleKind::kAlways, {marked(c)}), none_of(has(c)));
    state_rule(ask(RuleKind::kMutex, {marked(a), marked(b), marked(c)}), count(false));
    state_rule(ask(RuleKind::kExactlyOne, {marked(a), marked(b), marked(c)}), count(true));
    {
        const auto most = static_cast<std::uint32_t>(1 + stream.below(3));
        Question& q = ask(RuleKind::kBounded, {marked(a)});
        q.rule.count = most;
        state_rule(q, naive.where([&](const Marking& m) { return m[a] > most; }));
    }
    {
        std::vector<bool> bad = naive.enabling(t);
        for (std::uint32_t s = 0; s < bad.size(); ++s) {
            bad[s] = bad[s] && naive.states[s][a] == 0;
        }
        Question& q = ask(RuleKind::kOnlyIf, {Formula::fires(net::TransitionIndex{t}), marked(a)});
        state_rule(q, bad);
        q.before_firing = true;
    }
    state_rule(ask(RuleKind::kDeadlockFree, {}), naive.dead());
    {
        Question& q = ask(RuleKind::kQuasiLive, {});
        q.rule.transitions = {net::TransitionIndex{t}};
        q.holds = any(naive.enabling(t));
    }
    {
        Question& q = ask(RuleKind::kLive, {});
        std::vector<bool> stuck(naive.states.size());
        for (std::uint32_t u = 0; u < net.transition_count(); ++u) {
            const std::vector<bool> far = none_of(naive.leading_to(naive.enabling(u)));
            for (std::uint32_t s = 0; s < far.size(); ++s) {
                stuck[s] = stuck[s] || far[s];
            }
        }
        state_rule(q, stuck);
    }
    {
        std::vector<bool> start(naive.states.size());
        start[0] = true;
        state_rule(ask(RuleKind::kReversible, {}), none_of(naive.leading_to(start)));
    }
    {
        Question& q = ask(RuleKind::kEnds, {});
        state_rule(q, none_of(naive.leading_to(naive.dead())));
        q.lucky = !all(naive.bound_for(naive.dead()));
    }
    const auto temporal = [&](FormulaOp op, Formula f, bool holds) {
        ask(RuleKind::kFormula, {Formula::unary(op, std::move(f))}).holds = holds;
    };
    temporal(FormulaOp::kSomeFinally, marked(b), any(has(b)));
    temporal(FormulaOp::kAllGlobally, Formula::unary(FormulaOp::kSomeFinally, marked(b)),
             all(naive.leading_to(has(b))));
    temporal(FormulaOp::kAllFinally, marked(c), naive.bound_for(has(c))[0]);
    temporal(FormulaOp::kFinally, marked(c), naive.bound_for(has(c))[0]);
    temporal(FormulaOp::kGlobally, marked(c), all(has(c)));
    return list;
}

// Plays a witness; the states along it by number.
std::vector<std::uint32_t> played(const net::Net& net, const Witness& w, const Naive& naive) {
    net::ScriptedChooser chooser(w.choices);
    run::Player player(net, {.seed = w.seed, .chooser = &chooser});
    std::vector<std::uint32_t> along;
    const auto look = [&] {
        Marking m;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            m.push_back(player.tokens(net::PlaceIndex{p}));
        }
        const auto at = naive.number.find(m);
        REQUIRE(at != naive.number.end());
        along.push_back(at->second);
    };
    look();
    for (const Witness::Step& step : w.steps) {
        REQUIRE(player.step() == run::Stop::kNone);
        CHECK(net.transition(player.last()).path == step.transition);
        look();
    }
    return along;
}

test::Features without_time() {
    test::Features f;
    f.timed = f.intervals = f.delays = f.cuts = f.data = f.records = f.any = f.events = false;
    f.siblings = f.odds = f.servers = f.holdings = f.expressions = false;
    return f;
}

TEST_CASE("rules of nets without time agree with naive exploration [oracle]") {
    const bool many = std::getenv("PUPPETRI_LONG") != nullptr;
    const int nets = many ? 10'000 : 300;
    std::uint64_t asked = 0, open = 0, shown = 0, compared = 0, by_markings = 0;
    for (int i = 0; i < nets; ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "untimed", "net"), 0};
        net::NetDraft draft = test::random_net(stream, without_time());
        auto first = net::compile(draft);
        REQUIRE(first.has_value());
        if (first->place_count() == 0 || first->transition_count() == 0 || !first->paced() ||
            first->place_count() != draft.places.size() ||
            first->transition_count() != draft.transitions.size()) {
            continue;  // lowering has renumbered it
        }
        const proof::Plain plain = proof::plain(*first);
        if (plain.unsound || !plain.net.exact()) {
            continue;
        }
        const Naive naive(plain.net);
        if (!naive.whole) {
            continue;
        }
        ++compared;
        const std::vector<Question> list = questions(stream, *first, naive);
        for (const Question& q : list) {
            draft.rules.push_back(q.rule);
        }
        const auto compiled = net::compile(draft);
        REQUIRE(compiled.has_value());
        for (const std::uint32_t few : {100'000u, 1u}) {
            ProveOptions options;
            options.built_in = false;
            options.budget.seconds = 5;
            options.first_look_states = few;
            const std::vector<Verdict> verdicts = prove(draft, *compiled, options);
            REQUIRE(verdicts.size() == list.size());
            for (std::size_t k = 0; k < list.size(); ++k) {
                const Question& q = list[k];
                const Verdict& v = verdicts[k];
                CAPTURE(i);
                CAPTURE(k);
                CAPTURE(few);
                CAPTURE(v.method);
                CAPTURE(v.reason);
                ++asked;
                open += v.answer == Answer::kUnknown ? 1 : 0;
                by_markings += v.method != "readiness graph" ? 1 : 0;
                if (v.answer == Answer::kUnknown) {
                    continue;
                }
                CHECK_MESSAGE((v.answer == Answer::kProved) == q.holds, test::show(draft));
                if (q.rule.kind == RuleKind::kEnds && q.holds) {
                    CHECK((v.force == Force::kProbabilityOne) == q.lucky);
                }
                const bool possible = q.rule.kind == RuleKind::kPossible;
                if (v.answer == (possible ? Answer::kProved : Answer::kRefuted) &&
                    !q.shown_by.empty()) {
                    REQUIRE(v.witness.has_value());
                    const std::vector<std::uint32_t> along = played(*compiled, *v.witness, naive);
                    REQUIRE(v.witness->violates_after < along.size());
                    const std::size_t at =
                        v.witness->violates_after - (q.before_firing ? std::size_t{1} : 0);
                    CHECK(q.shown_by[along[at]]);
                    ++shown;
                } else if (v.witness && v.witness->lasso_from != Witness::kNone) {
                    const std::vector<std::uint32_t> along = played(*compiled, *v.witness, naive);
                    CHECK(along[v.witness->lasso_from] == along.back());
                    ++shown;
                }
            }
        }
    }
    MESSAGE(compared << " nets, " << asked << " rules, " << open << " open, " << shown
                     << " witnesses, " << by_markings << " not by the readiness graph");
    CHECK(compared > static_cast<std::uint64_t>(nets / 4));
    CHECK(open * 50 < asked);
    CHECK(by_markings * 3 > asked);
}

}  // namespace
}  // namespace puppetri::verdict
