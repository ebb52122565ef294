// SPDX-License-Identifier: MIT
#include "puppetri/verdict/pursue.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "figure_judge.h"
#include "guide.h"
#include "linear_rule.h"
#include "puppetri/net/state.h"
#include "puppetri/net/tables.h"
#include "puppetri/stage/stage.h"
#include "run_hosts.h"

namespace puppetri::verdict {
namespace {

using Target = Finding::Target;
using Says = RunWatch::Says;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// How long to wait for a firing: a thousand rounds of what is scheduled again and again.
SimTime patience_of(const net::Net& net) {
    std::int64_t longest = 0;
    for (const net::ScheduledEvent& e : net.declarations().schedule) {
        if (e.every) {
            longest = std::max({longest, e.every->ticks, e.at.ticks});
        }
    }
    constexpr std::int64_t kRounds = 1000;
    return longest == 0 || longest > SimTime::never().ticks / (4 * kRounds)
               ? SimTime::never()
               : SimTime{longest * kRounds};
}

std::vector<std::uint8_t> state_of(const net::Net& net, const run::Player& player) {
    const std::vector<std::uint8_t> bytes = player.snapshot();
    const auto state = net::read_state(net, bytes);
    std::vector<std::uint8_t> out;
    if (state) {
        net::canonical(net, *state, out);
    }
    return out;
}

// One attempt, or a replay: plays and watches until the rule is broken.
class Attempt {
 public:
    Attempt(const Theatre& theatre, const Hunt& hunt, net::Chooser& chooser, Track* track)
        : theatre_(theatre),
          hunt_(hunt),
          actors_(theatre, chooser),
          player_(*actors_.player),
          watch_(*hunt.obligation, *hunt.reader, player_),
          track_(track) {}

    Witness witness;
    std::string reason;  // when nothing was found

    void schedule(const std::vector<run::OutsideEvent>& events) { player_.schedule(events); }

    // `script`: how many firings a witness has, or none.
    bool play(std::uint64_t firings, double until_s, const std::atomic<bool>* cancelled,
              const Witness* script) {
        target_ = hunt_.finding->target;
        note_marking();
        Says says = watch_.begin();
        bool maybe = says == Says::kMaybe;
        if (says == Says::kBroken && wants(Target::kBroken)) {
            return found(0);
        }
        if (target_ == Target::kLinear) {
            linear_.emplace(*hunt_.finding->game, *hunt_.obligation, *hunt_.reader, player_);
            linear_->begin();
        }
        if (decided()) {
            return goes_on();
        }
        went_round();
        SimTime maybe_at = player_.now();
        while (player_.firings() < firings) {
            if ((player_.firings() & 63) == 0 &&
                (now_s() > until_s || (cancelled != nullptr && cancelled->load()))) {
                reason = "the time for looking for a run was used up";
                break;
            }
            if (script == nullptr && track_ != nullptr) {
                push_wanted(true);
            }
            actors_.listener.occurred.clear();
            run::Stop stop = run::Stop::kLimit;
            if (hunt_.obligation->when_settled || linear_) {
                stop = player_.step({.until = player_.now()});
                if (linear_) {
                    linear_->occurred(actors_.listener.occurred);
                }
                if (stop == run::Stop::kLimit && linear_) {
                    linear_->time_passes();
                }
                if (stop == run::Stop::kLimit && watch_.time_passes() == Says::kBroken &&
                    target_ != Target::kFires) {
                    return found(player_.firings());
                }
            }
            const std::size_t before = linear_ ? actors_.listener.occurred.size() : 0;
            if (stop == run::Stop::kLimit) {
                run::Limits limit = limits(maybe, maybe_at);
                if (maybe && script != nullptr) {
                    limit.until = script->until;  // as long as it was looked at
                }
                stop = player_.step(limit);
            }
            if (track_ != nullptr) {
                for (const std::uint32_t e : actors_.listener.occurred) {
                    track_->occurred(e);
                }
            }
            if (stop == run::Stop::kFault) {
                fault_ = true;
                reason =
                    "the run stops: " + player_.fault().message +
                    (player_.fault().element.empty() ? "" : " (" + player_.fault().element + ")");
                if (hunt_.fault_counts != nullptr && hunt_.fault_counts(player_.fault().code)) {
                    reason = player_.fault().message;
                    return found(steps_.size());  // the firing that cannot be is none
                }
                break;
            }
            if (stop != run::Stop::kNone &&
                watch_.occurred(actors_.listener.occurred) == Says::kBroken &&
                wants(Target::kBroken)) {
                return found(player_.firings());
            }
            if (stop == run::Stop::kDead || stop == run::Stop::kFinal) {
                if (script == nullptr && track_ != nullptr && push_wanted(false)) {
                    continue;
                }
                return rested(stop == run::Stop::kFinal) || (maybe && figures());
            }
            if (stop != run::Stop::kNone) {
                if (maybe) {
                    return figures();
                }
                break;
            }
            steps_.push_back(
                {player_.now(), std::string(theatre_.net->transition(player_.last()).path)});
            note_marking();
            const Says late_or_not = watch_.fired(actors_.listener.occurred);
            if (linear_) {
                linear_->occurred(std::span(actors_.listener.occurred).subspan(before));
                linear_->fired();
            }
            if (track_ != nullptr) {
                track_->fired(player_.last().value);
                if (track_->lost()) {
                    reason = "the run left the graph";
                    track_ = nullptr;
                }
            }
            if (late_or_not == Says::kBroken &&
                (wants(Target::kBroken) || wants(Target::kTooLong) || wants(Target::kRest) ||
                 wants(Target::kEndless) || wants(Target::kHopeless))) {
                return found(player_.firings());
            }
            // Figures may do it while time passes, too, where no firing is.
            const bool there = hunt_.obligation->about_figures && wants(Target::kBroken) &&
                               (script != nullptr ? player_.firings() == script->violates_after
                                                  : track_ != nullptr && track_->distance() == 0);
            if ((late_or_not == Says::kMaybe || there) && !maybe) {
                maybe = true;
                maybe_at = player_.now();
            }
            if (target_ == Target::kFires && player_.last().value == hunt_.finding->transition) {
                return found(player_.firings());
            }
            if (decided()) {
                return goes_on();
            }
            if (script == nullptr && track_ != nullptr && hunt_.finding->product.complete &&
                track_->distance() == kFar && !maybe && target_ != Target::kTooLong) {
                reason = "this run can no longer get there";
                break;
            }
            if (went_round()) {
                return found(player_.firings());
            }
        }
        if (maybe) {
            return figures();
        }
        if (reason.empty()) {
            reason = "no run was found that does it";
        }
        return false;
    }

    bool faulted() const { return fault_; }
    const std::vector<Witness::Step>& steps() const { return steps_; }

 private:
    bool wants(Target t) const { return target_ == t; }

    run::Limits limits(bool maybe, SimTime at) const {
        // Figures decide within some seconds after the firing.
        constexpr SimTime kLook{5 * kTicksPerSecond};
        if (maybe) {
            return {.until = at + kLook};
        }
        // Events that come again and again and find nobody would keep time going for ever.
        const SimTime patience = patience_of(*theatre_.net);
        return patience == SimTime::never() ? run::Limits{}
                                            : run::Limits{.until = player_.now() + patience};
    }

    bool push_wanted(bool here) {
        const auto event = track_->wanted_event(here);
        // Crossings come by themselves, or not at all.
        if (!event || theatre_.net->declarations().events[*event].crossing) {
            return false;
        }
        player_.push(net::EventIndex{*event});
        return true;
    }

    bool rested(bool final_marking) {
        if (watch_.ended(player_.now(), true) == Says::kBroken) {
            return found(player_.firings());
        }
        if ((target_ == Target::kRest || target_ == Target::kHopeless) && !final_marking &&
            (hunt_.obligation->kind == net::RuleKind::kDeadlockFree ||
             hunt_.obligation->kind == net::RuleKind::kEnds)) {
            return found(player_.firings());
        }
        reason = "the run came to rest before";
        return false;
    }

    // However it goes on, or however long what takes, the rule is broken: of all nodes that the run
    // may be in each is one of those that settle it.
    bool decided() const {
        if (track_ == nullptr || track_->lost()) {
            return false;
        }
        if (target_ == Target::kHopeless) {
            return track_->hopeless();
        }
        if (target_ != Target::kLinear) {
            return false;
        }
        const std::vector<std::uint32_t> here = track_->here();
        return std::all_of(here.begin(), here.end(), [&](std::uint32_t n) {
            const std::uint32_t moment = hunt_.finding->product.state[n];
            const auto& cases = linear_->cases();
            return std::all_of(cases.begin(), cases.end(), [&](const auto& states) {
                return std::any_of(states.begin(), states.end(), [&](std::uint32_t q) {
                    return hunt_.finding->game->wins(moment, q);
                });
            });
        });
    }

    // Decided; where that is about what happens for ever, the run goes on until it has gone round.
    bool goes_on() {
        found(player_.firings());
        const net::RuleKind kind = hunt_.obligation->kind;
        if (kind != net::RuleKind::kLeadsTo && kind != net::RuleKind::kEnds && !linear_) {
            return true;
        }
        constexpr int kMost = 400;
        struct Visit {
            std::size_t steps, moments;
        };
        std::map<std::vector<std::uint32_t>, std::vector<Visit>> met;
        std::size_t kept = steps_.size(), set = 0;
        bool shown = !linear_;
        // Notes where it is; true: it has been here before, and what it did since will do for ever.
        const auto comes_back = [&] {
            std::vector<std::uint32_t> key = track_->here();
            if (linear_) {
                for (const std::vector<std::uint32_t>& states : linear_->cases()) {
                    key.push_back(kFar);
                    key.insert(key.end(), states.begin(), states.end());
                }
            }
            std::vector<Visit>& visits = met[std::move(key)];
            for (const Visit& v : visits) {
                if (!linear_ || linear_->breaks(v.moments + 1)) {
                    witness.lasso_from = static_cast<std::uint32_t>(v.steps);
                    return true;
                }
            }
            visits.push_back({steps_.size(), linear_ ? linear_->moments() : 0});
            return false;
        };
        const auto narrow = [&] {
            if (!linear_) {
                return;
            }
            track_->narrow([&](std::uint32_t n) {
                const auto& cases = linear_->cases();
                return std::any_of(cases.begin(), cases.end(), [&](const auto& states) {
                    return std::binary_search(states.begin(), states.end(),
                                              hunt_.finding->product.monitor[n]);
                });
            });
            const auto& ranks = hunt_.finding->game->ranks;
            const std::uint32_t rank = track_->distance();
            track_->follow(ranks[set]);
            if (rank == 0 || track_->distance() >= last_rank_) {
                set = (set + 1) % ranks.size();  // the next set in turn
                track_->follow(ranks[set]);
            }
            last_rank_ = track_->distance();
        };
        narrow();
        comes_back();
        for (int i = 0; i < kMost; ++i) {
            actors_.listener.occurred.clear();
            run::Stop stop = player_.step({.until = player_.now()});
            const std::size_t before = actors_.listener.occurred.size();
            if (linear_) {
                linear_->occurred(actors_.listener.occurred);
            }
            if (stop == run::Stop::kLimit) {
                if (linear_) {
                    linear_->time_passes();
                }
                stop = player_.step(limits(false, {}));
            }
            for (const std::uint32_t e : actors_.listener.occurred) {
                track_->occurred(e);
            }
            if (stop == run::Stop::kDead || stop == run::Stop::kFinal) {
                if (linear_) {
                    linear_->occurred(std::span(actors_.listener.occurred).subspan(before));
                    linear_->time_passes();
                    shown = linear_->breaks(linear_->moments());
                }
                break;
            }
            if (stop != run::Stop::kNone) {
                break;
            }
            steps_.push_back(
                {player_.now(), std::string(theatre_.net->transition(player_.last()).path)});
            if (linear_) {
                linear_->occurred(std::span(actors_.listener.occurred).subspan(before));
                linear_->fired();
            }
            track_->fired(player_.last().value);
            if (!decided()) {
                break;
            }
            kept = steps_.size();
            narrow();
            if (comes_back()) {
                shown = true;
                break;
            }
        }
        if (!shown) {
            reason = "the way on could not be shown";
            return false;
        }
        steps_.resize(kept);
        witness.steps = steps_;
        if (kept > 0) {
            witness.until = std::max(witness.until, steps_.back().at);
        }
        return true;
    }

    // The same state again, something owed all the time between, and nothing that only the
    // performance decides.
    bool went_round() {
        if (target_ != Target::kEndless) {
            return false;
        }
        const bool owes =
            hunt_.obligation->kind == net::RuleKind::kEnds || watch_.owes_since().has_value();
        if (!owes) {
            seen_.clear();
            return false;
        }
        std::vector<std::uint8_t> state = state_of(*theatre_.net, player_);
        for (const std::uint32_t s : watch_.states()) {
            state.push_back(static_cast<std::uint8_t>(s));
        }
        const Seen now{player_.firings(), actors_.counting.decided};
        const auto [at, is_new] = seen_.try_emplace(std::move(state), now);
        if (is_new || at->second.decided != now.decided) {
            at->second = now;
            return false;
        }
        witness.lasso_from = static_cast<std::uint32_t>(at->second.firings);
        return true;
    }

    void note_marking() {
        if (!hunt_.obligation->about_figures) {
            return;
        }
        std::vector<std::uint32_t> tokens;
        for (std::uint32_t p = 0; p < theatre_.net->place_count(); ++p) {
            tokens.push_back(player_.tokens(net::PlaceIndex{p}));
        }
        log_.at.push_back(player_.now());
        log_.tokens.push_back(std::move(tokens));
    }

    bool figures() {
        if (!actors_.stage) {
            reason = "figures decide, and nobody performs them";
            return false;
        }
        const auto seen =
            judge_figures(*theatre_.scene, *hunt_.obligation, *actors_.stage, log_, player_.now());
        if (!seen) {
            reason = "figures decide, and in the runs that were played they keep the rule";
            return false;
        }
        std::uint64_t firings = 0;
        while (firings < steps_.size() && steps_[firings].at <= *seen) {
            ++firings;
        }
        return found(firings);
    }

    bool found(std::uint64_t firings) {
        witness.steps = steps_;
        witness.violates_after = static_cast<std::uint32_t>(firings);
        witness.until = player_.now();
        for (const run::OutsideEvent& e : player_.recording()) {
            witness.events.push_back({e.at, std::string(theatre_.net->event(e.event).path)});
        }
        return true;
    }

    const Theatre& theatre_;
    const Hunt& hunt_;
    Performers actors_;
    run::Player& player_;
    RunWatch watch_;
    Track* track_;
    Target target_ = Target::kBroken;
    bool fault_ = false;
    std::vector<Witness::Step> steps_;
    MarkingLog log_;
    struct Seen {
        std::uint64_t firings = 0, decided = 0;
    };
    std::map<std::vector<std::uint8_t>, Seen> seen_;
    std::optional<LinearWatch> linear_;
    std::uint32_t last_rank_ = 0;
};

}  // namespace

Theatre theatre_of(const net::Net& net) {
    Theatre t;
    t.net = &net;
    const net::NetTables& tables = net.tables();
    for (const net::DurationTable& d : tables.durations) {
        t.auto_durations = t.auto_durations || d.kind == net::DurationKind::kAuto;
    }
    return t;
}

Theatre theatre_of(const scene::Scene& scene) {
    Theatre t = theatre_of(scene.net);
    t.scene = &scene;
    t.seed = scene.seed;
    t.beat = scene.beat;
    for (const motion::DurationRange& r : stage::declared_durations(scene.play)) {
        t.actions.push_back({r.shortest.ticks, r.longest.ticks});
    }
    return t;
}

Caught pursue(const Theatre& theatre, const Hunt& hunt, const PursueLimits& limits) {
    Caught out;
    const Finding& f = *hunt.finding;
    const double until = now_s() + limits.seconds;
    std::vector<std::uint32_t> distance;
    if (f.target == Target::kFires) {
        std::vector<std::uint8_t> edges(f.product.targets.size(), 0);
        const std::uint32_t wanted =
            hunt.transitions.empty() ? f.transition : hunt.transitions[f.transition];
        for (std::uint64_t e = 0; e < edges.size(); ++e) {
            edges[e] = f.product.label(e) == wanted ? 1 : 0;
        }
        distance = distances_to_edges(f.product, edges, {});
    } else {
        distance = distances(f.product, f.targets);
    }
    std::vector<Decision> decisions;
    for (std::uint32_t run = 0; run < limits.runs; ++run) {
        GuidedChooser chooser(decisions, f.target == Target::kTooLong, limits.coincide);
        Track track(hunt, distance);
        chooser.track = &track;
        Attempt attempt(theatre, hunt, chooser, &track);
        if (attempt.play(limits.firings, until, limits.cancelled, nullptr)) {
            Witness w = std::move(attempt.witness);
            w.rule = hunt.obligation->rule;
            w.net_hash = theatre.net->hash();
            w.seed = theatre.seed;
            w.choices = chooser.answers;
            const Replayed again = replay(theatre, w, hunt);
            if (again.breaks) {
                out.witness = std::move(w);
                out.reason = attempt.faulted() ? attempt.reason : f.reason;
                return out;
            }
            out.reason = "a run was found but did not replay: " + again.trouble;
            return out;
        }
        out.reason = attempt.reason;
        if (now_s() > until) {
            break;
        }
        // The deepest choice that has an answer left.
        decisions.resize(chooser.used());
        while (!decisions.empty() &&
               decisions.back().taken + 1 >= decisions.back().answers.size()) {
            decisions.pop_back();
        }
        if (decisions.empty()) {
            break;  // there are no other runs
        }
        ++decisions.back().taken;
    }
    return out;
}

Replayed replay(const Theatre& theatre, const Witness& witness, const Hunt& hunt) {
    Replayed out;
    if (witness.net_hash != theatre.net->hash()) {
        out.trouble = "it belongs to another net";
        return out;
    }
    net::ScriptedChooser chooser(witness.choices);
    std::optional<Track> track;
    std::vector<std::uint32_t> none;
    if (hunt.finding->target == Target::kHopeless || hunt.finding->target == Target::kLinear) {
        none.assign(hunt.finding->product.size(), 0);
        track.emplace(hunt, none);
    }
    Attempt attempt(theatre, hunt, chooser, track ? &*track : nullptr);
    std::vector<run::OutsideEvent> events;
    for (const Witness::Event& e : witness.events) {
        const net::EventIndex event = theatre.net->find_event(e.path);
        if (!event.valid()) {
            out.trouble = "there is no event " + e.path;
            return out;
        }
        events.push_back({e.at, event});
    }
    attempt.schedule(events);
    out.breaks = attempt.play(witness.steps.size() + 1, now_s() + 3600, nullptr, &witness);
    out.same = attempt.steps() == witness.steps && !chooser.misfit();
    if (!out.breaks) {
        out.trouble = attempt.reason;
    } else if (!out.same) {
        out.breaks = false;
        out.trouble = "other transitions fired, or at other times";
    }
    return out;
}

std::optional<Witness> witness_of(const Theatre& theatre, const proof::Script& script,
                                  std::string* trouble, const std::vector<std::uint32_t>& rounds) {
    Witness w;
    w.net_hash = theatre.net->hash();
    w.seed = theatre.seed;
    w.choices = script.answers;
    w.until = script.until;
    std::vector<run::OutsideEvent> events;
    for (const proof::Script::Outside& e : script.outside) {
        w.events.push_back({e.at, std::string(theatre.net->event(e.event).path)});
        events.push_back({e.at, e.event});
    }
    net::ScriptedChooser chooser(w.choices);
    Performers actors(theatre, chooser);
    actors.player->schedule(events);
    struct Round {
        std::uint32_t firings = 0;
        SimTime at;
        std::uint64_t decided = 0;
        std::vector<std::uint8_t> state;
    };
    std::vector<Round> ended;
    for (const proof::Script::Firing& f : script.firings) {
        const run::Stop stop = actors.player->step();
        if (stop != run::Stop::kNone || actors.player->last() != f.transition ||
            actors.player->now() != f.at) {
            *trouble = theatre.auto_durations ? "on the stage movements take other times"
                                              : "the player fires something else";
            return std::nullopt;
        }
        w.steps.push_back({f.at, std::string(theatre.net->transition(f.transition).path)});
        const auto firings = static_cast<std::uint32_t>(w.steps.size());
        if (std::find(rounds.begin(), rounds.end(), firings) == rounds.end()) {
            continue;
        }
        Round now{firings, f.at, actors.counting.decided, state_of(*theatre.net, *actors.player)};
        for (const Round& before : ended) {
            if (before.state == now.state && before.at < now.at && before.decided == now.decided) {
                w.lasso_from = before.firings;
                w.until = f.at;
                return w;
            }
        }
        ended.push_back(std::move(now));
    }
    if (!rounds.empty()) {
        *trouble = "it does not come back to the very same state";
        return std::nullopt;
    }
    return w;
}

}  // namespace puppetri::verdict
