// SPDX-License-Identifier: MIT
// Questions about time: closed forms, random runs that may not contradict an answer, and all runs
// of small nets. 200 random nets; PUPPETRI_LONG=1 takes 10 000.
#include "puppetri/verdict/times.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "proved_scene.h"
#include "puppetri/base/text.h"
#include "puppetri/net/chooser.h"
#include "puppetri/run/player.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::TimeQuestionKind;
using Says = TimeEnd::Says;

struct AnsweredScene {
    explicit AnsweredScene(const std::string& body, const std::string& header = "until 10 s") {
        scene::MemoryFiles files;
        files.add("test.pup",
                  "language 1\nscene \"test\"\nframes 24 per second, " + header + "\n" + body);
        auto loaded = scene::load(files, "test.pup");
        REQUIRE(loaded.has_value());
        scene.emplace(std::move(*loaded));
        ProveOptions options;
        options.budget.seconds = 20;
        answers = answer_times(*scene, options);
    }
    const TimeAnswer& of(const std::string& question) const {
        const auto found = std::find_if(answers.begin(), answers.end(), [&](const TimeAnswer& a) {
            return a.question == question;
        });
        REQUIRE_MESSAGE(found != answers.end(), question);
        return *found;
    }
    std::string says(const std::string& question) const {
        return text(of(question), scene->frame_rate);
    }
    // The run of the witness, played from its script alone.
    bool plays(const Witness& w) const {
        net::ScriptedChooser chooser(w.choices);
        run::Options options;
        options.chooser = &chooser;
        options.beat = scene->beat;
        run::Player player(scene->net, options);
        for (const Witness::Step& step : w.steps) {
            if (player.step() != run::Stop::kNone || player.now() != step.at ||
                scene->net.transition(player.last()).path != step.transition) {
                return false;
            }
        }
        return true;
    }

    std::optional<scene::Scene> scene;
    std::vector<TimeAnswer> answers;
};

TEST_CASE("the walk of k steps takes k * n frames, at the shortest and at the longest [law]") {
    for (int k = 1; k <= 4; ++k) {
        const AnsweredScene s(R"(
place P1  tokens 1
place P2  takes 10 frames
place P3
place P4  takes 20 frames
place P5
place P6  takes 20 frames
place P7  takes 10 frames
place P8  takes 10 frames
place P9
t1:  P1 -> P2 + P3
t2:  P2 -> P4 + P3  priority 2 unless P5
t3:  P4 -> P6 + P3  priority 2 unless P5
t4:  P6 -> P4 + P3  priority 2 unless P5
t5:  )" + std::to_string(k) + R"(*P3 -> P5
t6:  P4 -> P7
t7:  P2 -> P8
t8:  P6 -> P8
t9:  P7 -> P9
t10: P8 -> P9
question soonest shortest time to (P5 and P9)
question latest  longest time to (P5 and P9)
)");
        const std::string expected = number_to_text(std::round(20.0 * k / 24 * 1e6) / 1e6) +
                                     " s (" + std::to_string(20 * k) + " frames)";
        CHECK(s.says("soonest") == expected);
        CHECK(s.says("latest") == expected);
        const TimeEnd& end = *s.of("soonest").quickest;
        CHECK(end.exact);
        const char* fractions[] = {"5/6", "5/3", "5/2", "10/3"};
        CHECK(exact_seconds(end.time) == fractions[k - 1]);
        REQUIRE(end.witness);
        CHECK(s.plays(*end.witness));
        CHECK(end.witness->steps.back().at == SimTime{end.time.ticks});
    }
}

TEST_CASE("intervals: a chain takes the sum of its ends, waiting for two the later one [law]") {
    const AnsweredScene s(R"(
place a  takes 1 .. 3 s  tokens 1
place b  takes 2 .. 5 s
place c
place d  takes 4 .. 4.5 s  tokens 1
place both
ab: a -> b
bc: b -> c
cd: c + d -> both
question chain  shortest time to c
question late   longest time to c
question joined shortest time to cd
question end    longest time to both
)");
    CHECK(s.says("chain") == "3 s (72 frames)");
    CHECK(s.says("late") == "8 s (192 frames)");
    CHECK(s.says("joined") == "4 s (96 frames)");
    CHECK(s.says("end") == "8 s (192 frames)");
    for (const TimeAnswer& a : s.answers) {
        const TimeEnd& end = a.quickest ? *a.quickest : *a.slowest;
        CHECK(end.exact);
        REQUIRE(end.witness);
        CHECK(end.shown == end.time);
        CHECK(s.plays(*end.witness));
    }
}

// Each pass alone could be short, not all of them in one run: a sum of ends is no answer.
TEST_CASE("what two waits share is not saved twice [oracle]") {
    const AnsweredScene s(R"(
place a  takes 1 .. 4 s  tokens 1
place clock  takes 5 s  tokens 1
place b
place c
ab: a -> b
bc: b + clock -> c
question c_soon shortest time to c
question c_late longest time to c
)");
    CHECK(s.says("c_soon") == "5 s (120 frames)");
    CHECK(s.says("c_late") == "5 s (120 frames)");
    CHECK(s.of("c_soon").quickest->exact);
    CHECK(s.of("c_late").slowest->exact);
}

TEST_CASE("without a bound: a loop, a rest, an event that need not come, lost ties [law]") {
    const AnsweredScene s(R"(
place a  takes 1 s  tokens 1
place b
again: a -> a
out:   a -> b
question soon shortest time to b
question late longest time to b
)");
    CHECK(s.says("soon") == "1 s (24 frames)");
    CHECK(s.says("late") == "no bound");
    CHECK(s.of("late").slowest->reason.find("probability 1") != std::string::npos);
    const AnsweredScene rest(R"(
place a  takes 1 s  tokens 1
place b
place c
left:  a -> b
right: a -> c
question late longest time to b
question both shortest time to (b and c)
)");
    CHECK(rest.says("late") == "no bound");
    REQUIRE(rest.of("late").slowest->witness);
    CHECK(rest.plays(*rest.of("late").slowest->witness));
    CHECK(rest.says("both") == "never");
    const AnsweredScene event(R"(
event go
place a  tokens 1
place b
t: a -> b  on go
question late longest time to b
)");
    CHECK(event.says("late") == "no bound");
}

TEST_CASE("of two loops the cycle time says the shorter and the longer [law]") {
    const AnsweredScene s(R"(
place A  takes 1 s  tokens 1
place B  takes 4 s
place C  takes 2 s
ab: A -> B
ac: A -> C
ba: B -> A
ca: C -> A
question home  cycle time of A
question away  cycle time of ab
question never_so cycle time of (B and C)
)");
    CHECK(s.says("home") == "3 s (72 frames), 5 s (120 frames) a round");
    CHECK(s.says("away") == "5 s (120 frames), no bound a round");
    CHECK(s.says("never_so") == "never");
    for (const auto* end : {&s.of("home").quickest, &s.of("home").slowest}) {
        REQUIRE((*end)->witness);
        CHECK(s.plays(*(*end)->witness));
        const Witness& w = *(*end)->witness;
        // Once round from the place in the run where it begins to go round.
        const SimTime from = w.lasso_from == 0 ? SimTime{} : w.steps[w.lasso_from - 1].at;
        CHECK((w.until - from).ticks == (*end)->time.ticks);
    }
}

// Ramamoorthy and Ho 1980: in a marked graph the slowest circuit, time by tokens, decides.
TEST_CASE("two tokens on one circuit, one on another: the slower circuit decides [law]") {
    const AnsweredScene s(R"(
place a  takes 3 s  tokens 1
place b  takes 4 s  tokens 1
place c  takes 5 s
place d             tokens 1
t: a + d -> b + c
u: b -> a
v: c -> d
question round  cycle time of t
question other  cycle time of v
)");
    CHECK(s.says("round") == "5 s (120 frames) a round");
    CHECK(s.says("other") == "5 s (120 frames) a round");
}

TEST_CASE("intervals: a round of two waits lies between the sums of their ends [law]") {
    const AnsweredScene s(R"(
place a  takes 1 .. 2 s  tokens 1
place b  takes 3 .. 5 s
place tick  takes 4 s  tokens 1
ab: a -> b
ba: b -> a
t:  tick -> tick
question round cycle time of ab
question beat  cycle time of t
)");
    CHECK(s.says("round") == "at least 4 s (96 frames), at most 7 s (168 frames) a round");
    CHECK(s.says("beat") == "4 s (96 frames) a round");
    CHECK(s.of("beat").quickest->exact);
}

TEST_CASE("a net without time takes a beat for each firing [law]") {
    const AnsweredScene s(R"(
place a  tokens 1
place b
place c
ab: a -> b
bc: b -> c
ca: c -> a
question there shortest time to c
question round cycle time of ca
)",
                          "until 10 s, pace 0.5 s");
    const std::string there = s.says("there");
    CHECK(s.says("round") == "1.5 s (36 frames) a round");
    // As it is played: the first firing is on the first beat.
    run::Options options;
    options.beat = s.scene->beat;
    run::Player player(s.scene->net, options);
    while (player.tokens(s.scene->net.find_place("c")) == 0) {
        REQUIRE(player.step() == run::Stop::kNone);
    }
    CHECK(there == number_to_text(player.now().seconds()) + " s (" +
                       std::to_string(player.now().ticks * 24 / kTicksPerSecond) + " frames)");
}

TEST_CASE("questions in loops are named with the turn, and --rule picks them [unit]") {
    const std::string body = R"(
net pair(wait: time) {
  public place a  takes wait  tokens 1
  public place b
  public t: a -> b
}
use pair(1 s) as x
use pair(2 s) as y
for p in (x, y) { question done "how soon" shortest time to p.t }
)";
    const AnsweredScene s(body);
    CHECK(s.says("done.x") == "1 s (24 frames)");
    CHECK(s.says("done.y") == "2 s (48 frames)");
    CHECK(s.of("done.x").caption == "how soon");
    ProveOptions options;
    options.only = "done.y";
    CHECK(answer_times(*s.scene, options).size() == 1);
    options.only = "done";
    CHECK(answer_times(*s.scene, options).size() == 2);
}

TEST_CASE("an unanswered question is something unknown [unit]") {
    TimeAnswer a;
    a.quickest.emplace();
    CHECK(exit_status({}, {a}, false) == 3);
    a.quickest->says = Says::kTime;
    CHECK(exit_status({}, {a}, false) == 0);
}

// ---- random nets ----

class AnyChooser final : public net::Chooser {
 public:
    explicit AnyChooser(RandomStream& stream) : stream_(stream) {}
    std::int64_t choose(const net::Choice& choice) override {
        if (choice.options != 0) {
            return static_cast<std::int64_t>(stream_.below(choice.options));
        }
        return stream_.below(2) == 0 || choice.high == SimTime::never() ? choice.low.ticks
                                                                        : choice.high.ticks;
    }

 private:
    RandomStream& stream_;
};

struct Statement {
    bool of_firing = false;
    std::uint32_t index = 0;
};

// When the statement is true first: nothing if not within so many firings; `rests`: nor ever after.
struct FirstTime {
    std::optional<std::int64_t> at;
    std::int64_t waited = 0;  // else so long at least
    bool rests = false;
};
FirstTime first_time(const net::Net& net, const Statement& what, net::Chooser& chooser,
                     int firings) {
    run::Options options;
    options.chooser = &chooser;
    run::Player player(net, options);
    const auto holds = [&](bool fired) {
        return what.of_firing ? fired && player.last().value == what.index
                              : player.tokens(net::PlaceIndex{what.index}) > 0;
    };
    FirstTime out;
    if (holds(false)) {
        out.at = 0;
        return out;
    }
    for (int i = 0; i < firings; ++i) {
        // Events that come again and again may find nobody for ever.
        const run::Stop stop = player.step(
            {.until = player.now() +
                      SimTime{net.paced() ? 2 * kTicksPerSecond : 10'000 * test::kRandomNetUnit}});
        out.waited = player.now().ticks;
        if (stop != run::Stop::kNone) {
            out.rests = stop == run::Stop::kDead || stop == run::Stop::kFinal;
            return out;
        }
        if (holds(true)) {
            out.at = player.now().ticks;
            return out;
        }
    }
    return out;
}

TEST_CASE("no run is quicker or slower than the answers, and exact ones are attained [agree]") {
    const char* wanted = std::getenv("PUPPETRI_LONG");
    const int nets = wanted != nullptr ? 10'000 : 200;
    int times = 0, exact = 0, all_runs = 0, no_bound = 0, never = 0;
    for (int i = 0; i < nets; ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "times", "net"), 0};
        test::Features features;
        features.intervals = i % 2 == 0;
        net::NetDraft draft = test::random_net(stream, features);
        std::vector<Statement> statements;
        {
            const auto first = net::compile(draft);
            REQUIRE(first.has_value());
            if (first->place_count() == 0 || first->transition_count() == 0 ||
                first->place_count() != draft.places.size() ||
                first->transition_count() != draft.transitions.size()) {
                continue;  // lowering has renumbered it
            }
            for (int k = 0; k < 4; ++k) {
                const bool of_firing = k % 2 == 1;
                const auto index = static_cast<std::uint32_t>(
                    stream.below(of_firing ? first->transition_count() : first->place_count()));
                statements.push_back({of_firing, index});
                Formula about = of_firing ? Formula::fires(net::TransitionIndex{index})
                                          : Formula::marked(net::PlaceIndex{index});
                for (const auto kind : {TimeQuestionKind::kShortest, TimeQuestionKind::kLongest}) {
                    draft.questions.push_back({.path = "q" + std::to_string(draft.questions.size()),
                                               .kind = kind,
                                               .about = about});
                }
            }
        }
        const auto compiled = net::compile(draft);
        REQUIRE(compiled.has_value());
        const net::Net& net = *compiled;
        ProveOptions options;
        options.budget.seconds = 1;
        options.budget.states = 3000;
        options.outside_events = 0;  // the runs below have none
        const std::vector<TimeAnswer> answers = answer_times(draft, net, options);
        REQUIRE(answers.size() == 8);
        for (std::size_t k = 0; k < statements.size(); ++k) {
            const TimeEnd& low = *answers[2 * k].quickest;
            const TimeEnd& high = *answers[2 * k + 1].slowest;
            const std::string who = "net " + std::to_string(i) + ", statement " +
                                    std::to_string(k) + ": " + text(answers[2 * k], {}) + " .. " +
                                    text(answers[2 * k + 1], {}) + "\n" + test::show(draft);
            times += (low.says == Says::kTime ? 1 : 0) + (high.says == Says::kTime ? 1 : 0);
            exact += low.exact + high.exact;
            no_bound += high.says == Says::kNoBound ? 1 : 0;
            never += low.says == Says::kNever ? 1 : 0;
            const auto look = [&](const FirstTime& t) {
                if (t.at) {
                    CHECK_MESSAGE(low.says != Says::kNever, who);
                    CHECK_MESSAGE(high.says != Says::kNever, who);
                    CHECK_MESSAGE((low.says != Says::kTime || *t.at >= low.time.ticks), who);
                    CHECK_MESSAGE((high.says != Says::kTime || *t.at <= high.time.ticks), who);
                } else if (high.says == Says::kTime) {
                    CHECK_MESSAGE((!t.rests && t.waited <= high.time.ticks), who);
                }
            };
            for (int r = 0; r < 15; ++r) {
                AnyChooser chooser(stream);
                look(first_time(net, statements[k], chooser, 30));
            }
            // All runs, where they are few: the ends themselves.
            net::ExhaustiveChooser all;
            std::optional<std::int64_t> least, most;
            bool every = true;
            int runs = 0;
            do {
                const FirstTime t = first_time(net, statements[k], all, 8);
                look(t);
                if (t.at) {
                    least = std::min(least.value_or(*t.at), *t.at);
                    most = std::max(most.value_or(*t.at), *t.at);
                }
                every = every && (t.at || t.rests);
                if (!t.at) {
                    most = SimTime::never().ticks;
                }
            } while (++runs < 200 && all.next());
            const bool complete = every && runs < 200;
            if (complete && least && low.exact) {
                ++all_runs;
                CHECK_MESSAGE(low.time.ticks == *least, who);
            }
            if (complete && least && high.exact) {
                CHECK_MESSAGE(high.time.ticks == *most, who);
            }
            if (complete && !least && low.says == Says::kTime) {
                CHECK_MESSAGE(!low.exact, who);
            }
            for (const TimeEnd* end : {&low, &high}) {
                if (end->exact && end->witness && end->says == Says::kTime &&
                    end->shown == end->time) {
                    net::ScriptedChooser script(end->witness->choices);
                    const FirstTime t =
                        first_time(net, statements[k], script,
                                   static_cast<int>(end->witness->steps.size()) + 1);
                    CHECK_MESSAGE(t.at == end->time.ticks, who);
                }
            }
        }
    }
    MESSAGE(times << " times, " << exact << " exact, " << all_runs << " compared with all runs, "
                  << no_bound << " without bound, " << never << " never");
    CHECK(exact > nets);
    CHECK(all_runs > nets / 4);
}

}  // namespace
}  // namespace puppetri::verdict
