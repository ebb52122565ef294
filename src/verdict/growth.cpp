// SPDX-License-Identifier: MIT
#include "growth.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "cutting.h"
#include "part.h"
#include "puppetri/net/state.h"
#include "puppetri/net/tables.h"
#include "puppetri/net/visit.h"
#include "questions.h"
#include "run_hosts.h"

namespace puppetri::verdict {
namespace {

constexpr std::uint64_t kMostFirings = 3000;  // of a run that is to come back
constexpr std::uint64_t kMostEdges = 4'000'000;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Ties as a plan wants them, as far as it can be followed; durations short, long, or by turns.
class PlannedChooser final : public net::Chooser {
 public:
    enum class Lasts : std::uint8_t { kShort, kLong };
    PlannedChooser(const std::vector<std::uint32_t>& prefix, const std::vector<std::uint32_t>& pump,
                   Lasts lasts)
        : prefix_(prefix), pump_(pump), lasts_(lasts) {}

    std::vector<std::int64_t> answers;

    std::int64_t choose(const net::Choice& choice) override {
        answers.push_back(answer_to(choice));
        return answers.back();
    }
    std::optional<std::uint32_t> wanted(std::size_t ahead = 0) const {
        const std::size_t i = at_ + ahead;
        if (i < prefix_.size()) {
            return prefix_[i];
        }
        return pump_.empty() ? std::nullopt
                             : std::optional(pump_[(i - prefix_.size()) % pump_.size()]);
    }
    void fired(std::uint32_t transition) {
        if (wanted() == transition) {
            ++at_;
        }
    }

 private:
    std::int64_t answer_to(const net::Choice& choice) const {
        if (choice.options == 0) {
            return lasts_ == Lasts::kShort || choice.high == SimTime::never() ? choice.low.ticks
                                                                              : choice.high.ticks;
        }
        if (choice.kind == net::ChoiceKind::kTie) {
            const std::size_t plan = prefix_.size() + pump_.size();
            for (std::size_t ahead = 0; ahead < plan; ++ahead) {
                const auto found = std::find(choice.transitions.begin(), choice.transitions.end(),
                                             wanted(ahead).value_or(~std::uint32_t{0}));
                if (found != choice.transitions.end()) {
                    return found - choice.transitions.begin();
                }
            }
        }
        return 0;
    }

    const std::vector<std::uint32_t>&prefix_, &pump_;
    const Lasts lasts_;
    std::size_t at_ = 0;
};

}  // namespace

Growing::Growing(const Theatre& theatre, const net::NetDraft& lowered, const stage::Play* play)
    : theatre_(theatre),
      net_(*theatre.net),
      lowered_(lowered),
      play_(play),
      may_grow_(net_.place_count(), 1),
      tested_(net_.place_count(), 0) {
    const net::NetTables& tables = net_.tables();
    for (std::uint32_t p = 0; p < may_grow_.size(); ++p) {
        const net::PlaceDraft& place = lowered.places[p];
        if (!place.attributes.empty() || place.capacity || place.keeps_order ||
            place.discipline != net::Discipline::kOldest || place.busy || place.action.valid() ||
            (!tables.place_rich.empty() && tables.place_rich[p] != net::kNoIndex)) {
            may_grow_[p] = 0;
        }
    }
    const auto never = [&](std::uint32_t p) { may_grow_[p] = 0; };
    for (const net::TransitionDraft& t : lowered.transitions) {
        std::map<std::uint32_t, std::int64_t> takes;  // parallel arcs add
        for (const net::ArcDraft& arc : t.inputs) {
            const std::uint32_t p = arc.place.value;
            const bool plain = arc.kind != net::ArcKind::kTakeAll &&
                               arc.kind != net::ArcKind::kTakeAllNow && arc.pattern.empty() &&
                               !arc.time_left;
            if (!plain || (t.delay && t.delay->servers != 1)) {
                never(p);
            }
            takes[p] += arc.weight;  // more than any one test asks for
            tested_[p] = std::max(tested_[p], takes[p]);
        }
    }
    // Whoever counts tokens in an expression, has a module in the place, or makes its tokens ready.
    net::NetDraft others = lowered;
    others.rules.clear();
    others.states.clear();
    others.questions.clear();
    others.measures.clear();
    others.finals.clear();
    for (net::TransitionDraft& t : others.transitions) {
        t.inputs.clear();
        t.outputs.clear();
    }
    net::each_place_mention(others, [&](std::uint32_t& p) { never(p); });
    for (net::NetDraft copy = lowered; net::TransitionDraft & t : copy.transitions) {
        net::each_expr(t, [&](Expr& e) {
            e.rename_slots([&](Slot s) {
                if (net::speaks_of_place(s)) {
                    never(s.index);
                }
                return s;
            });
        });
    }
}

bool Growing::comes_back() const {
    if (draws_times(net_)) {
        return false;
    }
    for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
        const std::uint32_t d = net_.tables().place[p].duration;
        const net::ActionIndex a = net_.action(net::PlaceIndex{p});
        if (d != net::kNoIndex && net_.tables().durations[d].kind == net::DurationKind::kAuto &&
            (!a.valid() || a.value >= theatre_.actions.size() ||
             theatre_.actions[a.value].low != theatre_.actions[a.value].high)) {
            return false;
        }
        // A movement tells its events when it does.
        if (play_ != nullptr && a.valid() && a.value < play_->actions.size() &&
            !play_->actions[a.value].raises.empty()) {
            return false;
        }
    }
    return true;
}

// One run, watched for coming back with more.
class Growing::Round {
 public:
    Round(const Growing& growing, net::Chooser& chooser, const std::vector<std::uint32_t>& places)
        : g_(growing), actors_(growing.theatre_, chooser), places_(places) {}

    run::Player& player() { return *actors_.player; }
    const std::vector<Witness::Step>& steps() const { return steps_; }

    // The first firing after which it is where it was after an earlier one (from), but for more.
    struct Found {
        std::uint64_t from = 0, to = 0;
        std::uint32_t place = 0;
        std::uint32_t more = 0;
    };
    std::optional<Found> begin() { return look(); }
    std::optional<Found> fired() {
        const std::uint32_t t = player().last().value;
        steps_.push_back({player().now(), std::string(g_.net_.transition(player().last()).path)});
        between_ = ready_.back();
        for (const net::ArcDraft& arc : g_.lowered_.transitions[t].inputs) {
            if (arc.kind == net::ArcKind::kTake || arc.kind == net::ArcKind::kTakeNow) {
                between_[arc.place.value] -= arc.weight;
            }
        }
        return look();
    }

 private:
    std::optional<Found> look() {
        auto state = net::read_state(g_.net_, player().snapshot());
        if (!state) {
            return std::nullopt;
        }
        std::vector<std::int64_t> ready(state->counts.size());
        for (std::size_t p = 0; p < ready.size(); ++p) {
            net::Counts& c = state->counts[p];
            ready[p] = c.ready;
            if (g_.may_grow_[p] != 0) {
                c.total -= c.ready;
                c.ready = 0;
            }
        }
        std::vector<std::uint8_t> key;
        net::canonical(g_.net_, *state, key);
        // The least number of ready tokens since the firing before, also between taking and giving.
        std::vector<std::int64_t> least = ready;
        for (std::size_t p = 0; p < between_.size(); ++p) {
            least[p] = std::min(least[p], between_[p]);
        }
        ready_.push_back(ready);
        least_.push_back(std::move(least));
        const std::uint64_t now = ready_.size() - 1;
        std::vector<std::uint64_t>& before = seen_[std::move(key)];
        for (const std::uint64_t then : before) {
            if (auto found = grown(then, now)) {
                return found;
            }
        }
        before.push_back(now);
        return std::nullopt;
    }

    std::optional<Found> grown(std::uint64_t from, std::uint64_t to) const {
        Found out{.from = from, .to = to};
        // An instant without end is not for ever.
        const SimTime then = from == 0 ? SimTime{} : steps_[from - 1].at;
        if (to == 0 || steps_[to - 1].at == then) {
            return std::nullopt;
        }
        for (std::size_t p = 0; p < ready_[to].size(); ++p) {
            if (g_.may_grow_[p] == 0) {
                continue;  // equal, else the key would differ
            }
            const std::int64_t more = ready_[to][p] - ready_[from][p];
            if (more < 0) {
                return std::nullopt;
            }
            if (more == 0) {
                continue;
            }
            std::int64_t least = ready_[from][p];
            for (std::uint64_t i = from + 1; i <= to; ++i) {
                least = std::min(least, least_[i][p]);
            }
            if (least < g_.tested_[p]) {
                return std::nullopt;
            }
            const bool counts =
                places_.empty() || std::find(places_.begin(), places_.end(), p) != places_.end();
            if (out.more == 0 && counts) {
                out.place = static_cast<std::uint32_t>(p);
                out.more = static_cast<std::uint32_t>(more);
            }
        }
        return out.more != 0 ? std::optional(out) : std::nullopt;
    }

    const Growing& g_;
    Performers actors_;
    const std::vector<std::uint32_t>& places_;
    std::vector<Witness::Step> steps_;
    std::vector<std::vector<std::int64_t>> ready_, least_;  // per firing, 0: the start
    std::vector<std::int64_t> between_;
    std::map<std::vector<std::uint8_t>, std::vector<std::uint64_t>> seen_;
};

std::optional<Growth> Growing::by_runs(const std::vector<std::uint32_t>& prefix,
                                       const std::vector<std::uint32_t>& pump,
                                       const std::vector<std::uint32_t>& places, bool outside,
                                       const proof::Budget& budget) const {
    if (!comes_back()) {
        return std::nullopt;
    }
    const double until = now_s() + budget.seconds;
    using Lasts = PlannedChooser::Lasts;
    for (const Lasts lasts : {Lasts::kShort, Lasts::kLong}) {
        PlannedChooser chooser(prefix, pump, lasts);
        Round round(*this, chooser, places);
        run::Player& player = round.player();
        auto found = round.begin();
        std::uint64_t pushed = 0;
        while (!found && player.firings() < kMostFirings) {
            if (now_s() > until || (budget.cancelled != nullptr && budget.cancelled->load())) {
                return std::nullopt;
            }
            const run::Stop stop =
                player.step({.until = player.now() + SimTime{3600 * kTicksPerSecond}});
            if (stop == run::Stop::kNone) {
                chooser.fired(player.last().value);
                found = round.fired();
                continue;
            }
            // Nothing happens by itself: the outside does what the plan waits for, a second later.
            const auto next = chooser.wanted();
            if (!outside || !next || pushed >= kMostFirings || stop == run::Stop::kFault) {
                break;
            }
            const std::vector<net::EventIndex>& events = lowered_.transitions[*next].events;
            const auto event = std::find_if(events.begin(), events.end(), [&](net::EventIndex e) {
                return lowered_.events[e.value].outside;
            });
            if (event == events.end()) {
                break;
            }
            const run::OutsideEvent occurrence{player.now() + SimTime{kTicksPerSecond}, *event};
            player.schedule({&occurrence, 1});
            ++pushed;
        }
        if (!found) {
            continue;
        }
        Witness w;
        w.net_hash = net_.hash();
        w.seed = theatre_.seed;
        w.choices = chooser.answers;
        w.steps = round.steps();
        w.lasso_from = static_cast<std::uint32_t>(found->from);
        w.violates_after = static_cast<std::uint32_t>(found->to);
        w.until = player.now();
        for (const run::OutsideEvent& e : player.recording()) {
            w.events.push_back({e.at, std::string(net_.event(e.event).path)});
        }
        std::string loop;
        for (std::uint64_t i = found->from; i < found->to; ++i) {
            loop += (loop.empty() ? "" : ", ") + w.steps[i].transition;
            if (loop.size() > 200) {
                loop += ", ...";
                break;
            }
        }
        const std::string name(net_.place(net::PlaceIndex{found->place}).path);
        Growth growth{.place = found->place,
                      .reason = "place " + name + " grows without end: " + loop +
                                " can go round for ever, and each round leaves " +
                                std::to_string(found->more) +
                                (found->more == 1 ? " token" : " tokens") + " more there",
                      .witness = std::nullopt,
                      .assumptions = {"no run is longer than 414 years, where the clock ends"}};
        if (play_ != nullptr && !play_->actions.empty()) {
            growth.assumptions.emplace_back("every movement can be performed when it begins");
        }
        w.says = growth.reason;
        // Played again, from the script alone: it comes back at the same firings.
        net::ScriptedChooser script(w.choices);
        Round again(*this, script, places);
        std::vector<run::OutsideEvent> events;
        for (const Witness::Event& e : w.events) {
            events.push_back({e.at, net_.find_event(e.path)});
        }
        again.player().schedule(events);
        auto same = again.begin();
        while (!same && again.steps().size() < w.steps.size() &&
               again.player().step() == run::Stop::kNone) {
            same = again.fired();
        }
        if (same && same->from == found->from && same->to == found->to &&
            same->place == found->place && again.steps() == w.steps && !script.misfit()) {
            growth.witness = std::move(w);
            return growth;
        }
    }
    return std::nullopt;
}

std::optional<Growth> Growing::by_every_run(const std::vector<std::uint32_t>& places,
                                            std::uint32_t outside_events,
                                            const proof::Budget& budget) const {
    net::NetDraft draft = lowered_;
    draft.rules.clear();
    const std::vector<std::uint32_t> collecting = collectors(draft);
    if (collecting.empty()) {
        return std::nullopt;
    }
    const auto part = Part::of(without_collectors(std::move(draft)), theatre_, play_);
    if (part == nullptr) {
        return std::nullopt;
    }
    std::string why;
    const proof::TimedGraph* timed = part->whole_graph(
        Method::kReadiness, {.budget = budget, .outside_events = outside_events}, why);
    if (timed == nullptr || !timed->graph.over || timed->graph.ended != proof::Ended::kDone) {
        return std::nullopt;
    }
    const Product p = make_product(timed->graph, nullptr, kMostEdges, timed->stops);
    const Nodes all(p.size(), 1);
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        if (!p.complete || p.rests(n)) {
            return std::nullopt;
        }
    }
    for (const std::uint32_t place : collecting) {
        if (!places.empty() && std::find(places.begin(), places.end(), place) == places.end()) {
            continue;
        }
        std::vector<std::uint8_t> feeds(part->net().transition_count(), 0);
        std::string who;
        for (std::uint32_t t = 0; t < lowered_.transitions.size(); ++t) {
            for (const net::OutputDraft& out : lowered_.transitions[t].outputs) {
                if (out.place.value == place && out.weight > 0 &&
                    part->transitions[t] < feeds.size()) {
                    feeds[part->transitions[t]] = 1;
                    who += (who.empty() ? "" : ", ") + lowered_.transitions[t].path;
                }
            }
        }
        std::vector<std::uint8_t> feeding(p.targets.size(), 0);
        for (std::uint64_t e = 0; e < feeding.size(); ++e) {
            feeding[e] = p.label(e) < feeds.size() ? feeds[p.label(e)] : 0;
        }
        if (endless(p, all, feeding, &timed->waits)) {
            continue;  // some path may go on without
        }
        const std::string name(net_.place(net::PlaceIndex{place}).path);
        Growth growth{.place = place,
                      .reason = "place " + name + " grows without end: in every run " + who +
                                " fires again and again, whatever the timing, and nothing takes "
                                "from " +
                                name,
                      .witness = std::nullopt,
                      .assumptions = timed->assumptions};
        // A run that shows the beginning of it: three tokens more.
        const std::vector<std::uint32_t> none;
        PlannedChooser chooser(none, none, PlannedChooser::Lasts::kShort);
        Performers actors(theatre_, chooser);
        run::Player& player = *actors.player;
        const std::uint32_t wanted = player.tokens(net::PlaceIndex{place}) + 3;
        Witness w;
        while (player.firings() < kMostFirings && player.tokens(net::PlaceIndex{place}) < wanted &&
               player.step() == run::Stop::kNone) {
            w.steps.push_back({player.now(), std::string(net_.transition(player.last()).path)});
        }
        if (player.tokens(net::PlaceIndex{place}) < wanted) {
            continue;
        }
        w.net_hash = net_.hash();
        w.seed = theatre_.seed;
        w.choices = chooser.answers;
        w.violates_after = static_cast<std::uint32_t>(w.steps.size());
        w.until = player.now();
        w.says = growth.reason;
        net::ScriptedChooser script(w.choices);
        Performers others(theatre_, script);
        std::vector<Witness::Step> again;
        while (again.size() < w.steps.size() && others.player->step() == run::Stop::kNone) {
            again.push_back(
                {others.player->now(), std::string(net_.transition(others.player->last()).path)});
        }
        if (again == w.steps) {
            growth.witness = std::move(w);
            return growth;
        }
    }
    return std::nullopt;
}

void refute_bounded(const Theatre& theatre, const net::NetDraft& lowered, const stage::Play* play,
                    const net::Rule& rule, const proof::BoundednessAnswer& pump,
                    std::uint32_t outside_events, const proof::Budget& budget, Verdict& verdict) {
    std::vector<std::uint32_t> places;
    for (const net::Formula& f : rule.operands) {
        for (const net::Formula::Node& n : f.nodes) {
            if (n.op == net::FormulaOp::kMarked) {
                places.push_back(n.index);
            }
        }
    }
    const Growing growing(theatre, lowered, play);
    const bool outside = outside_events == proof::GraphRequest::kAnyNumber;
    const char* method = "a run that comes back";
    auto growth = growing.by_runs(pump.prefix, pump.pump, places, outside, budget);
    if (!growth) {
        method = name_of(Method::kReadiness);
        growth = growing.by_every_run(places, outside_events, budget);
    }
    if (!growth) {
        return;
    }
    verdict.answer = Answer::kRefuted;
    verdict.method = method;
    verdict.reason = std::move(growth->reason);
    verdict.assumptions = std::move(growth->assumptions);
    verdict.witness = std::move(growth->witness);
    verdict.witness->rule = rule.path;
}

}  // namespace puppetri::verdict
