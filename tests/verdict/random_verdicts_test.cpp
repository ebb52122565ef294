// SPDX-License-Identifier: MIT
// No run may contradict a verdict: random nets that use the whole kernel, random rules, and many
// random runs of the player, watched from outside. 300 nets in the tests; PUPPETRI_LONG=1 takes
// 10 000.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/run/player.h"
#include "puppetri/verdict/prove.h"
#include "puppetri/verdict/run_watch.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;
using net::RuleKind;

class AnyChooser final : public net::Chooser {
 public:
    explicit AnyChooser(RandomStream& stream) : stream_(stream) {}
    std::int64_t choose(const net::Choice& choice) override {
        if (choice.options != 0) {
            return static_cast<std::int64_t>(stream_.below(choice.options));
        }
        const std::int64_t low = choice.low.ticks, high = choice.high.ticks;
        switch (stream_.below(3)) {
            case 0:
                return low;
            case 1:
                return high == SimTime::never().ticks ? std::max(low, choice.drawn.ticks) : high;
            default:
                return std::clamp(choice.drawn.ticks, low, high);
        }
    }

 private:
    RandomStream& stream_;
};

std::vector<net::Rule> random_rules(RandomStream& stream, const net::Net& net) {
    const auto place = [&] {
        return Formula::marked(
            net::PlaceIndex{static_cast<std::uint32_t>(stream.below(net.place_count()))},
            static_cast<std::int64_t>(1 + stream.below(2) / 2));
    };
    const auto ready = [&] {
        return Formula::ready(
            net::PlaceIndex{static_cast<std::uint32_t>(stream.below(net.place_count()))});
    };
    const auto fires = [&] {
        return Formula::fires(
            net::TransitionIndex{static_cast<std::uint32_t>(stream.below(net.transition_count()))});
    };
    std::vector<net::Rule> rules;
    const auto add = [&](RuleKind kind, std::vector<Formula> operands) -> net::Rule& {
        net::Rule rule;
        rule.path = "r" + std::to_string(rules.size());
        rule.kind = kind;
        rule.operands = std::move(operands);
        rule.when_settled = stream.below(6) == 0 && kind != RuleKind::kOnlyIf;
        rules.push_back(std::move(rule));
        return rules.back();
    };
    const auto both = [&](Formula a, Formula b) {
        return Formula::binary(FormulaOp::kAnd, std::move(a), std::move(b));
    };
    const auto units = [&] {
        return SimTime{test::kRandomNetUnit * static_cast<std::int64_t>(stream.below(6))};
    };
    add(RuleKind::kNever, {place()});
    add(RuleKind::kNever, {both(place(), place())});
    add(RuleKind::kAlways, {Formula::binary(FormulaOp::kOr, place(), place())});
    add(RuleKind::kMutex, {place(), place(), place()});
    add(RuleKind::kExactlyOne, {place(), place()});
    add(RuleKind::kNever, {both(fires(), place())}).when_settled = false;
    add(RuleKind::kOnlyIf, {fires(), place()});
    add(RuleKind::kOnlyIf, {place(), place()});
    add(RuleKind::kUntil, {fires(), fires(), fires()}).when_settled = false;
    add(RuleKind::kUntil, {fires(), place(), fires()}).when_settled = false;
    add(RuleKind::kAlternate, {fires(), fires()}).when_settled = false;
    add(RuleKind::kAlternate, {place(), place()});
    add(RuleKind::kLeadsTo, {fires(), place()}).when_settled = false;
    add(RuleKind::kLeadsTo, {place(), place()}).within = units();
    add(RuleKind::kLeadsTo, {fires(), place()}).within = units();
    rules.back().when_settled = false;
    add(RuleKind::kTakesAtMost, {place()}).within = units();
    add(RuleKind::kPossible, {both(place(), place())});
    add(RuleKind::kPossible, {both(place(), Formula::unary(FormulaOp::kNot, ready()))});
    add(RuleKind::kDeadlockFree, {});
    add(RuleKind::kQuasiLive, {}).transitions = {
        net::TransitionIndex{static_cast<std::uint32_t>(stream.below(net.transition_count()))}};
    return rules;
}

TEST_CASE("no run contradicts a verdict on random nets [agree]") {
    const char* wanted = std::getenv("PUPPETRI_LONG");
    const int nets = wanted != nullptr ? 10'000 : 300;
    std::uint64_t answered = 0, proved = 0, refuted = 0, watched = 0;
    for (int i = 0; i < nets; ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "verdicts", "net"), 0};
        net::NetDraft draft = test::random_net(stream);
        {
            auto first = net::compile(draft);
            REQUIRE(first.has_value());
            if (first->place_count() == 0 || first->transition_count() == 0 ||
                first->place_count() != draft.places.size() ||
                first->transition_count() != draft.transitions.size()) {
                continue;  // lowering has renumbered it
            }
            draft.rules = random_rules(stream, *first);
        }
        auto compiled = net::compile(draft);
        REQUIRE(compiled.has_value());
        const net::Net& net = *compiled;
        ProveOptions options;
        options.built_in = false;
        options.budget.seconds = 0.4;
        options.budget.states = 3000;
        const std::vector<Verdict> verdicts = prove(draft, net, options);
        REQUIRE(verdicts.size() == draft.rules.size());
        Atoms atoms;
        std::vector<Obligation> obligations;
        for (const net::Rule& rule : net.declarations().rules) {
            obligations.push_back(make_obligation(net, rule, nullptr, atoms));
        }
        const AtomReader reader(net, atoms.formulas());
        for (const Verdict& v : verdicts) {
            answered += v.answer != Answer::kUnknown ? 1 : 0;
            proved += v.answer == Answer::kProved ? 1 : 0;
            refuted += v.answer == Answer::kRefuted ? 1 : 0;
        }
        constexpr int kRuns = 25;
        for (int r = 0; r < kRuns; ++r) {
            AnyChooser chooser(stream);
            run::Player player(net, {.seed = static_cast<std::uint64_t>(r), .chooser = &chooser});
            std::vector<RunWatch> watches;
            std::vector<std::uint8_t> over(obligations.size(), 0);
            for (const Obligation& o : obligations) {
                watches.emplace_back(o, reader, player);
            }
            const auto contradicts = [&](std::size_t k, bool broken) {
                if (!broken || over[k] != 0) {
                    return;
                }
                over[k] = 1;
                ++watched;
                const bool possible = obligations[k].kind == RuleKind::kPossible ||
                                      obligations[k].kind == RuleKind::kQuasiLive;
                const Answer wrong = possible ? Answer::kRefuted : Answer::kProved;
                CHECK_MESSAGE(verdicts[k].answer != wrong, "net " << i << ", rule " << k << " "
                                                                  << name_of(verdicts[k]) << " by "
                                                                  << verdicts[k].method << "\n"
                                                                  << test::show(draft));
            };
            for (std::size_t k = 0; k < watches.size(); ++k) {
                contradicts(k, watches[k].begin() == RunWatch::Says::kBroken);
            }
            for (int step = 0; step < 40; ++step) {
                if (net.event_count() > 0 && stream.below(4) == 0) {
                    const net::EventIndex e{
                        static_cast<std::uint32_t>(stream.below(net.event_count()))};
                    if (net.declarations().events[e.value].outside) {
                        player.push(e);
                    }
                }
                run::Stop stop = player.step({.until = player.now()});
                if (stop == run::Stop::kLimit) {
                    for (std::size_t k = 0; k < watches.size(); ++k) {
                        contradicts(k, watches[k].time_passes() == RunWatch::Says::kBroken);
                    }
                    // Events that come again and again may find nobody for ever.
                    stop = player.step(
                        {.until = player.now() + SimTime{10'000 * test::kRandomNetUnit}});
                }
                if (stop != run::Stop::kNone) {
                    const bool rests = stop == run::Stop::kDead || stop == run::Stop::kFinal;
                    for (std::size_t k = 0; rests && k < watches.size(); ++k) {
                        contradicts(
                            k, watches[k].ended(player.now(), true) == RunWatch::Says::kBroken ||
                                   (obligations[k].kind == RuleKind::kDeadlockFree &&
                                    stop == run::Stop::kDead));
                    }
                    break;
                }
                for (std::size_t k = 0; k < watches.size(); ++k) {
                    const bool fired =
                        obligations[k].kind == RuleKind::kQuasiLive &&
                        std::find(obligations[k].transitions.begin(),
                                  obligations[k].transitions.end(),
                                  player.last().value) != obligations[k].transitions.end();
                    contradicts(k, watches[k].fired({}) == RunWatch::Says::kBroken || fired);
                }
            }
        }
    }
    MESSAGE(answered << " answers, " << proved << " proved, " << refuted << " refuted, " << watched
                     << " rules broken or reached by runs");
    CHECK(proved > static_cast<std::uint64_t>(nets));
    CHECK(refuted > static_cast<std::uint64_t>(nets));
}

}  // namespace
}  // namespace puppetri::verdict
