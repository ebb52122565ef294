// SPDX-License-Identifier: MIT
#include "puppetri/verdict/pursue.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "figure_judge.h"
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

// Where the run may be in the graph.
class Track {
 public:
    Track(const Hunt& hunt, const std::vector<std::uint32_t>& distance)
        : hunt_(hunt), p_(hunt.finding->product), distance_(distance), nodes_(p_.first) {
        close();
    }

    bool lost() const { return nodes_.empty(); }
    std::uint32_t distance() const { return nearest(nodes_); }
    bool all_targets() const {
        return std::all_of(nodes_.begin(), nodes_.end(),
                           [&](std::uint32_t n) { return hunt_.finding->targets[n] != 0; });
    }

    void fired(std::uint32_t transition) {
        const std::uint32_t label = mapped(hunt_.transitions, transition);
        if (label != kNoLabel) {
            nodes_ = after(label);
            close();
        }
    }
    void occurred(std::uint32_t event) {
        const std::uint32_t e = mapped(hunt_.events, event);
        if (e != kNoLabel) {
            std::vector<std::uint32_t> next = after(proof::Edge::kEvent | e);
            // Occurrences that change nothing need not be edges.
            if (!next.empty()) {
                nodes_ = std::move(next);
                close();
            }
        }
    }
    // How near the target is after this firing.
    std::uint32_t score(std::uint32_t transition) const {
        const std::uint32_t label = mapped(hunt_.transitions, transition);
        return label == kNoLabel ? distance() : nearest(after(label));
    }
    // The event of the outside that the nearest way begins with, or none. Only if no firing begins
    // a way as near; `here`: without waiting for anything.
    std::optional<std::uint32_t> wanted_event(bool here) const {
        const std::uint32_t best = distance();
        if (best == kFar || best == 0) {
            return std::nullopt;
        }
        std::optional<std::uint32_t> found;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const std::uint32_t n = nodes_[i];
            if (distance_[n] != best || (here && i >= direct_)) {
                continue;
            }
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                if (distance_[p_.targets[e]] != best - 1) {
                    continue;
                }
                const std::uint32_t label = p_.label(e);
                if (label == proof::Edge::kPass || (label & proof::Edge::kEvent) == 0) {
                    return std::nullopt;
                }
                found = label & ~proof::Edge::kEvent;
            }
        }
        if (!found || hunt_.events.empty()) {
            return found;
        }
        const auto at = std::find(hunt_.events.begin(), hunt_.events.end(), *found);
        return at == hunt_.events.end()
                   ? std::nullopt
                   : std::optional(static_cast<std::uint32_t>(at - hunt_.events.begin()));
    }

 private:
    static constexpr std::uint32_t kNoLabel = ~std::uint32_t{0};

    static std::uint32_t mapped(const std::vector<std::uint32_t>& map, std::uint32_t index) {
        return map.empty() ? index : index < map.size() ? map[index] : kNoLabel;
    }
    std::uint32_t nearest(const std::vector<std::uint32_t>& nodes) const {
        std::uint32_t best = kFar;
        for (const std::uint32_t n : nodes) {
            best = std::min(best, distance_[n]);
        }
        return best;
    }
    std::vector<std::uint32_t> after(std::uint32_t label) const {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t n : nodes_) {
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                if (p_.label(e) == label) {
                    next.push_back(p_.targets[e]);
                }
            }
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        return next;
    }
    // Time may pass unseen.
    void close() {
        direct_ = nodes_.size();
        std::vector<std::uint32_t> seen = nodes_;
        std::sort(seen.begin(), seen.end());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const std::uint32_t n = nodes_[i];
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                const std::uint32_t to = p_.targets[e];
                if (p_.label(e) != proof::Edge::kPass) {
                    continue;
                }
                const auto at = std::lower_bound(seen.begin(), seen.end(), to);
                if (at == seen.end() || *at != to) {
                    seen.insert(at, to);
                    nodes_.push_back(to);
                }
            }
        }
    }

    const Hunt& hunt_;
    const Product& p_;
    const std::vector<std::uint32_t>& distance_;
    std::vector<std::uint32_t> nodes_;
    std::size_t direct_ = 0;  // so many of them without time passing
};

// One choice of an attempt: the answers in the order in which they are tried.
struct Decision {
    std::vector<std::int64_t> answers;
    std::size_t taken = 0;
};

// Takes what leads nearest, or, on a later attempt, what was decided to be tried instead.
class GuidedChooser final : public net::Chooser {
 public:
    GuidedChooser(std::vector<Decision>& decisions, bool longest, bool coincide)
        : decisions_(decisions), longest_(longest), coincide_(coincide) {}
    const Track* track = nullptr;
    std::vector<std::int64_t> answers;

    std::int64_t choose(const net::Choice& choice) override {
        if (at_ == decisions_.size()) {
            decisions_.push_back(options_of(choice));
        }
        const Decision& d = decisions_[at_++];
        std::int64_t answer = d.answers[d.taken];
        // The same choice is asked again in the same order, but a host may have changed its mind.
        if (choice.options != 0) {
            answer = std::clamp<std::int64_t>(answer, 0, choice.options - 1);
        } else {
            answer = std::clamp(answer, choice.low.ticks, choice.high.ticks);
        }
        answers.push_back(answer);
        return answer;
    }
    std::size_t used() const { return at_; }

 private:
    Decision options_of(const net::Choice& choice) const {
        Decision d;
        if (choice.options == 0) {
            const std::int64_t drawn =
                std::clamp(choice.drawn.ticks, choice.low.ticks, choice.high.ticks);
            d.answers = {choice.low.ticks, choice.high.ticks, drawn};
            const bool continuous =
                choice.kind == net::ChoiceKind::kDuration || choice.kind == net::ChoiceKind::kDelay;
            if (continuous && !coincide_ && choice.low != choice.high) {
                // Never the same twice, nor an end of the support.
                const auto aside = static_cast<std::int64_t>(7919 * (at_ + 1));
                const std::int64_t high = choice.high.ticks;
                d.answers = {drawn};
                if (high - choice.low.ticks > 2 * aside) {
                    d.answers.push_back(choice.low.ticks + aside);
                    const std::int64_t late = std::min(high, drawn < high / 4 ? drawn * 4 : high);
                    d.answers.push_back(late - aside);
                }
                for (std::int64_t& a : d.answers) {
                    a = std::clamp(a, choice.low.ticks, high);
                }
            } else if (choice.high == SimTime::never()) {
                d.answers = {drawn, choice.low.ticks};
            } else if (longest_) {
                std::swap(d.answers[0], d.answers[1]);
            }
            std::vector<std::int64_t> once;
            for (const std::int64_t a : d.answers) {
                if (std::find(once.begin(), once.end(), a) == once.end()) {
                    once.push_back(a);
                }
            }
            d.answers = std::move(once);
            return d;
        }
        std::vector<std::pair<std::uint32_t, std::int64_t>> ranked;
        for (std::uint32_t i = 0; i < choice.options; ++i) {
            const bool tie = choice.kind == net::ChoiceKind::kTie && track != nullptr &&
                             i < choice.transitions.size();
            ranked.push_back({tie ? track->score(choice.transitions[i]) : 0, i});
        }
        std::stable_sort(ranked.begin(), ranked.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [score, option] : ranked) {
            d.answers.push_back(option);
        }
        return d;
    }

    std::vector<Decision>& decisions_;
    const bool longest_, coincide_;
    std::size_t at_ = 0;
};

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
        Says says = watch_.begin();
        bool maybe = says == Says::kMaybe;
        if (says == Says::kBroken && wants(Target::kBroken)) {
            return found(0);
        }
        if (hopeless()) {
            return found(0);
        }
        remember();
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
            if (hunt_.obligation->when_settled) {
                stop = player_.step({.until = player_.now()});
                if (stop == run::Stop::kLimit && watch_.time_passes() == Says::kBroken &&
                    target_ != Target::kFires) {
                    return found(player_.firings());
                }
            }
            if (stop == run::Stop::kLimit) {
                stop = player_.step(limits(maybe, maybe_at));
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
                    return found(player_.firings());
                }
                break;
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
            const Says late_or_not = watch_.fired(actors_.listener.occurred);
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
            if (late_or_not == Says::kMaybe && !maybe) {
                maybe = true;
                maybe_at = player_.now();
            }
            if (target_ == Target::kFires && player_.last().value == hunt_.finding->transition) {
                return found(player_.firings());
            }
            if (hopeless()) {
                return found(player_.firings());
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
        if (!event) {
            return false;
        }
        player_.push(net::EventIndex{*event});
        return true;
    }

    bool rested(bool final_marking) {
        if (watch_.ended(player_.now(), true) == Says::kBroken) {
            return found(player_.firings());
        }
        if (target_ == Target::kRest && !final_marking &&
            (hunt_.obligation->kind == net::RuleKind::kDeadlockFree ||
             hunt_.obligation->kind == net::RuleKind::kEnds)) {
            return found(player_.firings());
        }
        reason = "the run came to rest before";
        return false;
    }

    // Of all nodes that the run may be in, none leads to what should stay possible.
    bool hopeless() const {
        return target_ == Target::kHopeless && track_ != nullptr && !track_->lost() &&
               track_->all_targets();
    }

    void remember() {
        if (target_ == Target::kEndless && !theatre_.auto_durations) {
            went_round();
        }
    }
    // The same state again, and something owed all the time between.
    bool went_round() {
        if (target_ != Target::kEndless || theatre_.auto_durations) {
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
        const auto [at, is_new] = seen_.try_emplace(std::move(state), player_.firings());
        if (!is_new) {
            witness.lasso_from = static_cast<std::uint32_t>(at->second);
        }
        return !is_new;
    }

    bool figures() {
        if (!actors_.stage) {
            reason = "figures decide, and nobody performs them";
            return false;
        }
        const auto seen =
            judge_figures(*theatre_.scene, *hunt_.obligation, *actors_.stage, player_.now());
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
    std::map<std::vector<std::uint8_t>, std::uint64_t> seen_;
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
    if (hunt.finding->target == Target::kHopeless) {
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
                                  std::string* trouble) {
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
    for (const proof::Script::Firing& f : script.firings) {
        w.steps.push_back({f.at, std::string(theatre.net->transition(f.transition).path)});
    }
    net::ScriptedChooser chooser(w.choices);
    Performers actors(theatre, chooser);
    actors.player->schedule(events);
    for (const proof::Script::Firing& f : script.firings) {
        const run::Stop stop = actors.player->step();
        if (stop != run::Stop::kNone || actors.player->last() != f.transition ||
            actors.player->now() != f.at) {
            *trouble = theatre.auto_durations ? "on the stage movements take other times"
                                              : "the player fires something else";
            return std::nullopt;
        }
    }
    return w;
}

}  // namespace puppetri::verdict
