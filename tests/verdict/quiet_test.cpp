// SPDX-License-Identifier: MIT
// Who has come to an end rests there, though machines go on asking; who waits in vain is frozen,
// though machines go on asking. Both against an interpreter of little nets that knows nothing of
// graphs, clocks and methods.
#include <array>
#include <map>
#include <set>

#include "puppetri/base/random.h"
#include "verdict/proved_scene.h"

using namespace puppetri;
using namespace puppetri::verdict;

namespace {

const char* const kCast = "cast { ana: mannequin }\n";

TEST_CASE("an end at which somebody still polls is a rest, whether asked in vain or for nothing") {
    for (const char* polls :
         {// Nobody takes the event any more.
          "event tick every 1 s\nasks: bows + one -> bows + two on tick\n",
          // It is taken again and again, and nothing comes of it.
          "event tick every 1 s\nplace asker tokens 1\nasks: asker -> asker on tick\n"}) {
        const ProvedScene s(std::string(kCast) +
                            "place bows does ana.bow() takes 1 s tokens 1\nplace stands\n"
                            "place one tokens 1\nplace two\n"
                            "done: bows -> stands\n" +
                            polls + "end { stands }\nrule freezes nobody_freezes(ana)\n");
        CHECK(s.of("freezes").answer == Answer::kProved);
    }
}

TEST_CASE("who waits in vain beside a poll is frozen, and that is a deadlock [oracle]") {
    const std::string frozen = std::string(kCast) +
                               "place bows does ana.bow() takes 1 s tokens 1\nplace stands\nplace "
                               "never\nplace out\ndone: bows -> stands\n"
                               "again: stands + never -> bows\n"
                               "event tick every 1 s\nasks: never -> out on tick\n"
                               "rule freezes nobody_freezes(ana)\nrule dead deadlock_free\n";
    const ProvedScene s(frozen);
    CHECK(s.says("freezes") == "REFUTED");
    CHECK(s.says("dead") == "REFUTED");
    // An end elsewhere helps nobody; one just here does.
    const ProvedScene other(frozen + "end { out }\n");
    CHECK(other.says("freezes") == "REFUTED");
    CHECK(other.says("dead") == "REFUTED");
    const ProvedScene here(frozen + "end { stands }\nrule ends ends\n");
    CHECK(here.of("freezes").answer == Answer::kProved);
    CHECK(here.of("dead").answer == Answer::kProved);
    CHECK(here.of("ends").answer == Answer::kProved);
    // Where something goes on working for what she stands in there is no rest: then she is frozen.
    const ProvedScene works(frozen +
                            "place works takes 1 s tokens 1\nturn: works -> works while stands\n"
                            "end { stands }\n");
    CHECK(works.says("freezes") == "REFUTED");
    CHECK(works.of("dead").answer == Answer::kProved);
}

// A net whose tokens become ready a tick after they came; at each tick every transition that hears
// of it may fire once, ties in any order; the others fire before it as often as they can.
struct Little {
    struct Transition {
        std::vector<int> takes, gives;
    };
    int places = 0;
    std::vector<Transition> transitions;
    std::vector<int> start;
    int figure = 0, end = 0;  // the place that is a movement, the one that is an end

    std::string text() const {
        std::string out = std::string(kCast) + "event tick every 1 s\n";
        for (int p = 0; p < places; ++p) {
            out += "place p" + std::to_string(p) + (p == figure ? " does ana.bow()" : "") +
                   " takes 1 s" +
                   (start[static_cast<std::size_t>(p)] > 0
                        ? " tokens " + std::to_string(start[static_cast<std::size_t>(p)])
                        : std::string()) +
                   "\n";
        }
        for (std::size_t t = 0; t < transitions.size(); ++t) {
            const auto list = [](const std::vector<int>& places_of) {
                std::string text;
                for (const int p : places_of) {
                    text += (text.empty() ? "p" : " + p") + std::to_string(p);
                }
                return text;
            };
            out += "t" + std::to_string(t) + ": " + list(transitions[t].takes) + " -> " +
                   list(transitions[t].gives) + " on tick\n";
        }
        return out + "end { p" + std::to_string(end) +
               " }\nrule freezes nobody_freezes(ana)\nrule dead deadlock_free\n";
    }
};

using Marking = std::vector<int>;

struct Truth {
    bool freezes = false, dead = false;
};

// By hand: markings at ticks, and from each what ticks can make of it.
Truth truth_of(const Little& net) {
    struct Moment {
        Marking next;
        bool fires = false, moves = false;
    };
    std::map<Marking, std::vector<Moment>> ticks;
    const auto explore = [&](const Marking& from) {
        std::set<std::tuple<Marking, Marking, unsigned, bool>> seen;
        std::vector<std::tuple<Marking, Marking, unsigned, bool>> open{
            {from, Marking(from.size(), 0), 0u, false}};
        std::vector<Moment> out;
        while (!open.empty()) {
            auto [ready, fresh, fired, moves] = open.back();
            open.pop_back();
            if (!seen.insert({ready, fresh, fired, moves}).second) {
                continue;
            }
            bool any = false;
            for (unsigned t = 0; t < net.transitions.size(); ++t) {
                const Little::Transition& tr = net.transitions[t];
                const bool marked = std::all_of(tr.takes.begin(), tr.takes.end(), [&](int p) {
                    return ready[static_cast<std::size_t>(p)] > 0;
                });
                if ((fired & (1u << t)) != 0 || !marked) {
                    continue;
                }
                any = true;
                Marking r = ready, f = fresh;
                bool m = moves;
                for (const int p : tr.takes) {
                    --r[static_cast<std::size_t>(p)];
                }
                for (const int p : tr.gives) {
                    ++f[static_cast<std::size_t>(p)];
                    m = m || p == net.figure;
                }
                open.emplace_back(std::move(r), std::move(f), fired | (1u << t), m);
            }
            if (!any) {
                for (std::size_t p = 0; p < ready.size(); ++p) {
                    ready[p] += fresh[p];
                }
                out.push_back({std::move(ready), fired != 0, moves});
            }
        }
        return out;
    };
    std::vector<Marking> open{net.start};
    while (!open.empty()) {
        const Marking m = open.back();
        open.pop_back();
        if (ticks.count(m) != 0) {
            continue;
        }
        ticks[m] = explore(m);
        for (const Moment& next : ticks[m]) {
            open.push_back(next.next);
        }
    }
    Truth truth;
    std::set<Marking> good;  // somebody can move again, or everything rests in an end
    for (const auto& [m, moments] : ticks) {
        const bool still = std::none_of(moments.begin(), moments.end(),
                                        [](const Moment& next) { return next.fires; });
        const bool final = m[static_cast<std::size_t>(net.end)] > 0;
        truth.dead = truth.dead || (still && !final);
        if (still && final) {
            good.insert(m);
        }
    }
    for (bool more = true; more;) {
        more = false;
        for (const auto& [m, moments] : ticks) {
            for (const Moment& next : moments) {
                more =
                    ((next.moves || good.count(next.next) != 0) && good.insert(m).second) || more;
            }
        }
    }
    truth.freezes = good.size() != ticks.size();
    return truth;
}

TEST_CASE("on little nets that poll, verdicts are those of an interpreter by hand [oracle]") {
    RandomStream dice{20, 5};
    std::array<int, 4> counts{};
    for (int i = 0; i < 200; ++i) {
        Little net;
        net.places = 3 + static_cast<int>(dice.below(3));
        const auto any = [&] {
            return static_cast<int>(dice.below(static_cast<std::uint64_t>(net.places)));
        };
        const std::size_t transitions = 2 + dice.below(4);
        for (std::size_t t = 0; t < transitions; ++t) {
            // As many taken as given, so that nothing grows; each place once on a side.
            Little::Transition made;
            made.takes = {any()};
            made.gives = {any()};
            if (dice.below(3) == 0) {
                const int p = any(), q = any();
                if (p != made.takes[0] && q != made.gives[0]) {
                    made.takes.push_back(p);
                    made.gives.push_back(q);
                }
            }
            net.transitions.push_back(std::move(made));
        }
        net.start.assign(static_cast<std::size_t>(net.places), 0);
        ++net.start[static_cast<std::size_t>(any())];
        ++net.start[static_cast<std::size_t>(any())];
        net.figure = any();
        net.end = any();
        if (std::none_of(net.transitions.begin(), net.transitions.end(), [&](const auto& t) {
                return std::find(t.gives.begin(), t.gives.end(), net.figure) != t.gives.end();
            })) {
            continue;  // of who never moves nothing is asked
        }
        const Truth truth = truth_of(net);
        const std::string text = net.text();
        CAPTURE(text);
        ProveOptions options;
        options.built_in = false;
        const ProvedScene s(text, options);
        // Some rule may be answered UNKNOWN, never wrongly.
        const Verdict& freezes = s.of("freezes");
        const Verdict& dead = s.of("dead");
        CHECK(freezes.answer != (truth.freezes ? Answer::kProved : Answer::kRefuted));
        CHECK(dead.answer != (truth.dead ? Answer::kProved : Answer::kRefuted));
        counts[0] += freezes.answer == Answer::kProved ? 1 : 0;
        counts[1] += freezes.answer == Answer::kRefuted ? 1 : 0;
        counts[2] += dead.answer == Answer::kProved ? 1 : 0;
        counts[3] += dead.answer == Answer::kRefuted ? 1 : 0;
    }
    CAPTURE(counts[0]);
    CAPTURE(counts[1]);
    CAPTURE(counts[2]);
    CAPTURE(counts[3]);
    for (const int n : counts) {
        CHECK(n > 5);
    }
}

}  // namespace
