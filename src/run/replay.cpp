// SPDX-License-Identifier: MIT
// The engine with a keeper of clocks that lets nothing end before the log needs it or its latest
// time has come. Instants of the engine carry no time here: several may stand for one logged time.
#include "puppetri/run/replay.h"

#include <algorithm>
#include <set>

#include "puppetri/base/text.h"
#include "puppetri/net/engine.h"
#include "puppetri/net/tables.h"

namespace puppetri::run {
namespace {

using net::ArcKind;
using net::Engine;
using net::NetTables;

constexpr std::int64_t kNever = SimTime::never().ticks;

std::int64_t later(std::int64_t at, std::int64_t by) {
    std::int64_t sum = 0;
    return at == kNever || by == kNever || __builtin_add_overflow(at, by, &sum) ? kNever : sum;
}

std::string seconds(std::int64_t ticks) { return number_to_text(SimTime{ticks}.seconds()) + " s"; }

// What lasts, from when to when it may end.
struct Wait {
    net::Timekeeper::Kind kind = net::Timekeeper::Kind::kToken;
    std::uint32_t element = 0;
    std::int64_t begun = 0, low = 0, high = 0;
};

class Keeper final : public net::Timekeeper {
 public:
    explicit Keeper(std::int64_t tolerance) : tolerance_(tolerance) {}
    std::int64_t now = 0;
    std::vector<Wait> waits;  // by number - 1

    std::int64_t begin(Kind kind, std::uint32_t element, SimTime low, SimTime high) override {
        Wait w{kind, element, now, later(now, low.ticks), later(now, high.ticks)};
        w.low = std::max(now, w.low == kNever ? kNever : w.low - tolerance_);
        waits.push_back(w);
        return static_cast<std::int64_t>(waits.size());
    }

 private:
    std::int64_t tolerance_;
};

// Lets the wanted one win.
class Wanting final : public net::Chooser {
 public:
    std::uint32_t wanted = net::kNoIndex;
    std::int64_t choose(const net::Choice& choice) override {
        if (choice.kind == net::ChoiceKind::kTie) {
            const auto found =
                std::find(choice.transitions.begin(), choice.transitions.end(), wanted);
            return found == choice.transitions.end() ? 0 : found - choice.transitions.begin();
        }
        return choice.options != 0 ? 0 : choice.low.ticks;
    }
};

class Replay {
 public:
    Replay(const net::Net& net, std::span<const Observed> log, const ReplayOptions& options)
        : net_(net),
          tables_(net.tables()),
          log_(log),
          options_(options),
          slack_(2 * options.tolerance.ticks),
          keeper_(slack_),
          engine_(net, chooser_, engine_options()) {
        for (const Observed& o : log) {
            logged_.insert(o.transition.value);
        }
        // Which token of an `any` place, and when tokens were ready that a guard counts, is not in
        // a log
        guessed_ = tables_.token_streams != 0;
        // A clock that stood still goes on later than its first end
        for (const net::DelayTable& d : tables_.delays) {
            guessed_ = guessed_ || d.memory == net::DelayMemory::kAge;
        }
        for (const net::Special& s : tables_.specials) {
            for (const net::ArcTable& arc : s.arcs) {
                guessed_ = guessed_ || arc.time_left != net::kNoIndex;
            }
            for (const ProgramIndex program : {s.guard, s.odds}) {
                for (const Slot slot :
                     program.valid() ? tables_.code.slots(program) : std::vector<Slot>{}) {
                    guessed_ =
                        guessed_ || slot.kind == static_cast<std::uint32_t>(net::SlotKind::kReady);
                }
            }
        }
    }

    Replayed run() {
        engine_.start();
        remember();
        for (index_ = 0; index_ < log_.size(); ++index_) {
            if (!follow(log_[index_])) {
                break;
            }
            out_.firings = index_ + 1;
            remember();
        }
        return std::move(out_);
    }

 private:
    net::EngineOptions engine_options() {
        net::EngineOptions e;
        e.timekeeper = &keeper_;
        e.beat = options_.beat.ticks;
        return e;
    }

    void remember() {
        const net::State& s = engine_.state();
        out_.tokens.clear();
        for (const net::Counts& c : s.counts) {
            out_.tokens.push_back(c.total);
        }
        out_.data = s.data;
    }

    std::string name(std::uint32_t t) const { return std::string(tables_.transitions.path(t)); }

    bool deviates(Deviation::Kind kind, std::int64_t at, std::vector<std::string> reasons) {
        Deviation d{kind, index_, {at}, !guessed_, std::move(reasons), {}};
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            if (engine_.fireable({t})) {
                d.could_fire.push_back({t});
            }
        }
        out_.deviation = std::move(d);
        return false;
    }

    bool fault() {
        return deviates(Deviation::Kind::kFault, keeper_.now,
                        {engine_.fault().element + ": " + engine_.fault().message});
    }

    // -- what waits

    // The numbers of the waits that are under way.
    std::vector<std::int64_t> alive() const {
        const net::State& s = engine_.state();
        std::vector<std::int64_t> numbers;
        const auto add = [&](std::int64_t at) {
            if (net::is_wait(at)) {
                numbers.push_back(at - net::kWaiting);
            }
        };
        for (const net::Pending& p : s.heap.items) {
            if ((p.what & ~net::Pending::kIndexMask) == net::Pending::kPlain) {
                add(p.at);
            }
        }
        for (const net::RichTokens& r : s.rich) {
            for (std::uint32_t i = r.head; i < r.order.size(); ++i) {
                const net::Token& token = r.pool[r.order[i]];
                if (!token.ready) {
                    add(token.ready_at);
                }
            }
        }
        for (const auto& clocks : s.clocks) {
            for (const net::Clock& c : clocks) {
                if (c.phase == net::Clock::kRunning) {
                    add(c.at);
                }
            }
        }
        for (const net::Occurrence& o : s.occurrences) {
            add(o.at);
        }
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        return numbers;
    }
    const Wait& wait(std::int64_t number) const {
        return keeper_.waits[static_cast<std::size_t>(number) - 1];
    }

    // -- the instant

    bool somebody_can_fire() const {
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            if (engine_.fireable({t})) {
                return true;
            }
        }
        return false;
    }

    bool hidden(std::uint32_t t) const { return options_.unlogged_fire && logged_.count(t) == 0; }

    // Fires what the log never mentions, as long as nothing else is before it.
    bool fire_hidden() {
        for (int k = 0; k < 10'000; ++k) {
            std::uint32_t best = net::kNoIndex, choices = 0;
            for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
                choices += engine_.fireable({t}) && hidden(t);
                if (engine_.fireable({t}) &&
                    (best == net::kNoIndex ||
                     tables_.transition[t].level < tables_.transition[best].level ||
                     (tables_.transition[t].level == tables_.transition[best].level && hidden(t) &&
                      !hidden(best)))) {
                    best = t;
                }
            }
            if (best == net::kNoIndex || !hidden(best)) {
                return true;
            }
            guessed_ = guessed_ || choices > 1;
            chooser_.wanted = best;
            ++out_.unseen;
            if (engine_.turn() == Engine::Turn::kFault) {
                return fault();
            }
        }
        return deviates(Deviation::Kind::kFault, keeper_.now,
                        {"what the log never mentions fires without end"});
    }

    // Lets the instant end if nothing can fire any more in it: occurrences are offered on the way.
    // False: something can fire.
    bool settle() {
        while (!engine_.settled()) {
            if (options_.unlogged_fire && !fire_hidden()) {
                return false;
            }
            if (somebody_can_fire()) {
                return false;
            }
            if (!engine_.settled() && engine_.turn() == Engine::Turn::kFault) {
                return fault();
            }
        }
        return true;
    }

    bool missed(std::int64_t by) {
        std::vector<std::string> reasons;
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            if (engine_.fireable({t})) {
                reasons.push_back(name(t) + " can fire at " + seconds(by) +
                                  " and nothing lets time pass before it does");
            }
        }
        return deviates(Deviation::Kind::kMissed, by, std::move(reasons));
    }

    // Everything that must be over before `at`, or (inclusive) then.
    bool pass_to(std::int64_t at, bool inclusive) {
        for (;;) {
            std::int64_t next = kNever;
            const std::vector<std::int64_t> numbers = alive();
            for (const std::int64_t n : numbers) {
                next = std::min(next, wait(n).high);
            }
            if (next == kNever || next > at || (next == at && !inclusive)) {
                return true;
            }
            if (!settle()) {
                return !out_.deviation && (in_time(at) || missed(keeper_.now));
            }
            std::vector<std::int64_t> over;
            for (const std::int64_t n : numbers) {
                if (wait(n).high == next) {
                    over.push_back(n);
                }
            }
            keeper_.now = std::max(keeper_.now, next);
            engine_.pass(over);
            if (engine_.faulted()) {
                return fault();
            }
            if (options_.unlogged_fire && !fire_hidden()) {
                return false;
            }
        }
    }

    // -- one line of the log

    bool follow(const Observed& o) {
        const std::uint32_t t = o.transition.value;
        if (o.at.ticks < last_at_ - options_.tolerance.ticks) {
            return deviates(Deviation::Kind::kOutOfOrder, o.at.ticks,
                            {"the line before is of " + seconds(last_at_)});
        }
        const std::int64_t at = std::max(o.at.ticks, keeper_.now);
        if (options_.unlogged_fire && !fire_hidden()) {
            return false;
        }
        if (net_.paced()) {
            return follow_beat(at, t);
        }
        if (at > keeper_.now && !come_to(at)) {
            return false;
        }
        keeper_.now = at;
        last_at_ = at;
        if (!engine_.fireable({t}) && !make_fireable(t, at)) {
            return out_.deviation ? false
                                  : deviates(Deviation::Kind::kCannotFire, at, reasons(t, at));
        }
        return fire(t, at);
    }

    // A firing per beat.
    bool follow_beat(std::int64_t at, std::uint32_t t) {
        const std::int64_t next = engine_.state().next_beat;
        if (at < next - options_.tolerance.ticks || at > next + options_.tolerance.ticks) {
            return deviates(at < next ? Deviation::Kind::kCannotFire : Deviation::Kind::kMissed, at,
                            {"the net fires once per beat: next at " + seconds(next)});
        }
        keeper_.now = at;
        if (!engine_.fireable({t})) {
            return deviates(Deviation::Kind::kCannotFire, at, reasons(t, at));
        }
        if (engine_.state().now < next) {
            chooser_.wanted = t;
            if (engine_.turn() == Engine::Turn::kFault) {  // time passes
                return fault();
            }
        }
        last_at_ = at;
        return fire(t, at);
    }

    // Lets time pass up to `at`; what is still to fire may be late by the tolerance.
    bool come_to(std::int64_t at) {
        if (!settle()) {
            return !out_.deviation && (in_time(at) || missed(keeper_.now));
        }
        if (!pass_to(at, false)) {
            return false;
        }
        if (!settle()) {
            return !out_.deviation && (in_time(at) || missed(keeper_.now));
        }
        keeper_.now = at;
        return pass_to(at, true);
    }
    bool in_time(std::int64_t at) const { return at - keeper_.now <= slack_; }

    bool fire(std::uint32_t t, std::int64_t at) {
        std::vector<std::string> before;
        for (std::uint32_t other = 0; other < net_.transition_count(); ++other) {
            if (engine_.fireable({other}) &&
                tables_.transition[other].level < tables_.transition[t].level) {
                before.push_back(name(other) + " can fire too, and has a higher priority");
            }
        }
        if (!before.empty()) {
            return deviates(Deviation::Kind::kOvertaken, at, std::move(before));
        }
        chooser_.wanted = t;
        const Engine::Turn turn = engine_.turn();
        if (turn == Engine::Turn::kFault) {
            return fault();
        }
        if (turn != Engine::Turn::kFired || engine_.state().last != t) {
            return deviates(Deviation::Kind::kCannotFire, at,
                            {"the net fires another one instead"});
        }
        return true;
    }

    // -- what the log does not tell, chosen so that `t` can fire

    // Ready tokens that a transition wants: plain arcs, and reads and tests of `ready`.
    struct Need {
        std::uint32_t place = 0, count = 0;
    };
    std::vector<Need> needs(std::uint32_t t) const {
        std::vector<Need> out;
        const auto add = [&](std::uint32_t place, std::uint32_t count) {
            for (Need& n : out) {
                if (n.place == place) {
                    n.count = std::max(n.count, count);
                    return;
                }
            }
            out.push_back({place, count});
        };
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            for (const net::Watcher& w : tables_.ready_watchers(p)) {
                if (w.transition() == t && !w.inhibits()) {
                    add(p, w.threshold);
                }
            }
        }
        if (tables_.transition[t].special != net::kNoIndex) {
            for (const net::ArcTable& a : tables_.specials[tables_.transition[t].special].arcs) {
                if (a.kind == ArcKind::kTake || a.kind == ArcKind::kRead) {
                    add(a.place, a.weight);
                }
            }
        }
        return out;
    }

    // Lets these be over. A delay that begins with them may have begun before, as far as they could
    // end before: it is begun so early that it can be over now.
    void let_end(const std::vector<std::int64_t>& numbers, std::uint32_t t, std::int64_t at) {
        const std::uint32_t special = tables_.transition[t].special;
        const bool delayed =
            special != net::kNoIndex && tables_.specials[special].delay != net::kNoIndex;
        if (!delayed) {
            engine_.pass(numbers);
            return;
        }
        const net::State before = engine_.save();
        const std::size_t waits = keeper_.waits.size();
        engine_.pass(numbers);
        std::int64_t too_late = 0;
        for (std::size_t i = waits; i < keeper_.waits.size(); ++i) {
            const Wait& w = keeper_.waits[i];
            if (w.kind == net::Timekeeper::Kind::kDelay && w.element == t && w.low > at) {
                too_late = w.low - at;
            }
        }
        if (too_late == 0 || engine_.faulted()) {
            return;
        }
        std::int64_t when = at - too_late;
        for (const std::int64_t n : numbers) {
            when = std::max(when, std::min(at, wait(n).low));
        }
        engine_.restore(before);
        keeper_.waits.resize(waits);
        keeper_.now = when;
        engine_.pass(numbers);
        keeper_.now = at;
        guessed_ = guessed_ || keeper_.waits.size() > waits + 1;
    }

    bool make_fireable(std::uint32_t t, std::int64_t at) {
        if (!settle()) {
            // Something else is late, within the tolerance
            guessed_ = guessed_ || options_.tolerance.ticks != 0;
            return !out_.deviation && engine_.fireable({t});
        }
        // Tokens that may be ready by now, first those that must be ready first: of tokens that are
        // alike no other choice leaves more open. Of tokens with attributes a pattern may want a
        // certain one.
        std::vector<std::int64_t> alike, single;
        const std::vector<std::int64_t> numbers = alive();
        for (const Need& need : needs(t)) {
            const std::uint32_t ready = engine_.state().counts[need.place].ready;
            std::vector<std::int64_t> may;
            for (const std::int64_t n : numbers) {
                const Wait& w = wait(n);
                if (w.kind == net::Timekeeper::Kind::kToken && w.element == need.place &&
                    w.low <= at) {
                    may.push_back(n);
                }
            }
            std::stable_sort(may.begin(), may.end(), [&](std::int64_t a, std::int64_t b) {
                return wait(a).high < wait(b).high;
            });
            std::size_t missing = need.count > ready ? need.count - ready : 0;
            if (has_attributes(need.place)) {
                if (missing > 1 || (missing == 0 && !may.empty())) {
                    guessed_ = true;
                }
                if (missing <= 1) {
                    single.insert(single.end(), may.begin(), may.end());
                    continue;
                }
            }
            if (missing > may.size()) {
                open_events(need.place);
            }
            alike.insert(alike.end(), may.begin(),
                         may.begin() + static_cast<std::ptrdiff_t>(std::min(missing, may.size())));
        }
        if (single.empty()) {
            return try_with(alike, t, at);
        }
        guessed_ = guessed_ || single.size() > 1;
        const net::State before = engine_.save();
        const std::vector<Wait> waits = keeper_.waits;
        for (std::size_t i = 0; i <= single.size(); ++i) {  // the last: with none of them
            std::vector<std::int64_t> with = alike;
            if (i < single.size()) {
                with.push_back(single[i]);
            }
            if (try_with(with, t, at)) {
                return true;
            }
            engine_.restore(before);
            keeper_.waits = waits;
            keeper_.now = at;
        }
        return false;
    }

    bool has_attributes(std::uint32_t place) const {
        return !tables_.place_rich.empty() && tables_.place_rich[place] != net::kNoIndex &&
               tables_.rich[tables_.place_rich[place]].attributes != 0;
    }

    // An event that makes tokens of an open place ready occurs.
    void open_events(std::uint32_t place) {
        const auto& events = tables_.declarations.events;
        for (std::uint32_t e = 0; e < events.size(); ++e) {
            if (events[e].makes_ready.value == place) {
                engine_.occur({e}, {engine_.state().now});
            }
        }
    }

    bool try_with(const std::vector<std::int64_t>& numbers, std::uint32_t t, std::int64_t at) {
        if (!numbers.empty()) {
            let_end(numbers, t, at);
            if (engine_.faulted()) {
                return false;
            }
        }
        if (reached(t)) {
            return true;
        }
        // Its delay
        std::vector<std::int64_t> delays;
        for (const std::int64_t n : alive()) {
            const Wait& w = wait(n);
            if (w.kind == net::Timekeeper::Kind::kDelay && w.element == t && w.low <= at) {
                delays.push_back(n);
                break;
            }
        }
        if (!delays.empty() && engine_.settled()) {
            engine_.pass(delays);
            if (reached(t)) {
                return true;
            }
        }
        // An event from outside
        const std::uint32_t special = tables_.transition[t].special;
        if (special == net::kNoIndex || !engine_.settled()) {
            return false;
        }
        guessed_ = guessed_ || tables_.specials[special].events.size() > 1;
        for (const std::uint32_t e : tables_.specials[special].events) {
            engine_.occur({e}, {engine_.state().now});
            if (reached(t)) {
                return true;
            }
        }
        return false;
    }

    // In this instant, once what happens by itself has happened.
    bool reached(std::uint32_t t) {
        if (engine_.faulted()) {
            return false;
        }
        return engine_.fireable({t}) || (!settle() && engine_.fireable({t}));
    }

    // -- why not

    std::vector<std::string> reasons(std::uint32_t t, std::int64_t at) {
        std::vector<std::string> out;
        if (engine_.faulted()) {
            out.push_back(engine_.fault().element + ": " + engine_.fault().message);
            return out;
        }
        const auto place_name = [&](std::uint32_t p) {
            return std::string(tables_.places.path(p));
        };
        const auto tokens = [](std::uint32_t n) {
            return std::to_string(n) + (n == 1 ? " token" : " tokens");
        };
        const std::vector<std::int64_t> numbers = alive();
        bool enough = true;
        for (const Need& need : needs(t)) {
            const net::Counts c = engine_.state().counts[need.place];
            if (c.total < need.count) {
                out.push_back("it takes " + tokens(need.count) + " of " + place_name(need.place) +
                              ", where there " + (c.total == 1 ? "is " : "are ") +
                              (c.total == 0 ? "none" : std::to_string(c.total)));
                enough = false;
            } else if (c.ready < need.count) {
                std::int64_t first = kNever;
                for (const std::int64_t n : numbers) {
                    if (wait(n).kind == net::Timekeeper::Kind::kToken &&
                        wait(n).element == need.place) {
                        first = std::min(first, wait(n).low);
                    }
                }
                out.push_back("no token of " + place_name(need.place) + " is ready" +
                              (first == kNever || first <= at
                                   ? ""
                                   : " before " + seconds(first) + ": " + seconds(first - at) +
                                         " too early"));
                enough = false;
            }
        }
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            const net::Counts c = engine_.state().counts[p];
            for (const net::Watcher& w : tables_.total_watchers(p)) {
                watcher_reason(w, t, c.total, place_name(p), out, enough);
            }
            for (const net::Watcher& w : tables_.ready_watchers(p)) {
                if (w.inhibits()) {
                    watcher_reason(w, t, c.ready, place_name(p), out, enough);
                }
            }
        }
        const std::uint32_t number = tables_.transition[t].special;
        if (!enough || number == net::kNoIndex) {
            return out;
        }
        const net::Special& s = tables_.specials[number];
        for (const std::int64_t n : numbers) {
            const Wait& w = wait(n);
            if (w.kind == net::Timekeeper::Kind::kDelay && w.element == t) {
                out.push_back("its delay runs until " + seconds(w.low) +
                              (w.low > at ? ": " + seconds(w.low - at) + " too early" : ""));
                return out;
            }
        }
        if (s.guard.valid()) {
            std::string reads;
            std::set<std::uint32_t> told;
            for (const Slot slot : tables_.code.slots(s.guard)) {
                if (slot.kind == static_cast<std::uint32_t>(net::SlotKind::kDatum) &&
                    told.insert(slot.index).second) {
                    reads += (reads.empty() ? ": " : ", ") +
                             std::string(tables_.data.path(slot.index)) + " is " +
                             value_text(slot.index);
                }
            }
            out.push_back("its guard does not hold" + reads);
        }
        if (s.searches && !s.guard.valid()) {
            out.push_back("no tokens fit its patterns");
        }
        if (!s.events.empty()) {
            std::string names;
            for (const std::uint32_t e : s.events) {
                names += (names.empty() ? "" : " or ") + std::string(tables_.events.path(e));
            }
            out.push_back("it waits for " + names);
        }
        return out;
    }

    void watcher_reason(const net::Watcher& w, std::uint32_t t, std::uint32_t count,
                        const std::string& place, std::vector<std::string>& out,
                        bool& enough) const {
        if (w.transition() != t || (count >= w.threshold) != w.inhibits()) {
            return;
        }
        enough = false;
        const std::string there = place + " has " + std::to_string(count);
        out.push_back(w.inhibits() ? "it fires only while " + place + " has fewer than " +
                                         std::to_string(w.threshold) + ", and " + there
                                   : "it needs " + std::to_string(w.threshold) + " in " + place +
                                         ", and " + there);
    }

    std::string value_text(std::uint32_t datum) const {
        const net::DatumDraft& d = tables_.declarations.data[datum];
        const Value v = engine_.state().data[datum];
        switch (d.type.kind) {
            case ValueKind::kBool:
                return v != 0 ? "yes" : "no";
            case ValueKind::kReal:
                return number_to_text(real_of_value(v));
            case ValueKind::kTime:
                return seconds(v);
            case ValueKind::kEnum:
                return tables_.declarations.enums[d.type.enumeration]
                    .values[static_cast<std::size_t>(v)];
            default:
                return std::to_string(v);
        }
    }

    const net::Net& net_;
    const NetTables& tables_;
    std::span<const Observed> log_;
    const ReplayOptions& options_;
    const std::int64_t slack_;  // of what lasts: both its ends may be wrong
    Keeper keeper_;
    Wanting chooser_;
    Engine engine_;
    std::set<std::uint32_t> logged_;
    std::size_t index_ = 0;
    std::int64_t last_at_ = 0;
    bool guessed_ = false;  // something was chosen that might have been otherwise
    Replayed out_;
};

}  // namespace

Replayed replay(const net::Net& net, std::span<const Observed> log, const ReplayOptions& options) {
    return Replay(net, log, options).run();
}

}  // namespace puppetri::run
