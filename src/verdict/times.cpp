// SPDX-License-Identifier: MIT
// Each question on the graph of exact time, where all durations are single numbers, else on the
// graph of state classes. What either says of all runs is a bound; it is exact where the graph is,
// or where a run attains it. That a state may be avoided for ever, or is never reached, is a rule
// like any other and left to the prover of rules.
#include "puppetri/verdict/times.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "crossings.h"
#include "cutting.h"
#include "part.h"
#include "path_witness.h"
#include "prover.h"
#include "puppetri/base/rational.h"
#include "puppetri/base/text.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/state_classes.h"
#include "puppetri/proof/timed_exact.h"
#include "questions.h"
#include "splitting.h"

namespace puppetri::verdict {
namespace {

using net::TimeQuestionKind;
using Says = TimeEnd::Says;
using EdgeSet = std::vector<std::uint8_t>;  // per edge, in the order of edges.items

constexpr std::uint64_t kMostEdges = 40'000'000;
constexpr std::int64_t kNever = SimTime::never().ticks;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Which steps make the statement true, as far as that is known.
struct Hits {
    EdgeSet may, must;
    bool at_start_may = false, at_start_must = false;
    bool clear = true;  // both are the same
};

Hits hits_of(const proof::Graph& g, const Operand& about) {
    Hits h;
    const Truth start = about.at(Product::row_of(g, g.initial), Operand::kNoFiring);
    h.at_start_may = start.may;
    h.at_start_must = start.must;
    h.clear = start.may == start.must;
    for (const proof::Edge& e : g.edges.items) {
        const Truth t = about.at(Product::row_of(g, e.target), e.label);
        h.may.push_back(t.may ? 1 : 0);
        h.must.push_back(t.must ? 1 : 0);
        h.clear = h.clear && t.may == t.must;
    }
    return h;
}

// Which steps make it true that was not true before. A firing happens anew each time.
Hits visits_of(const proof::Graph& g, const Operand& about) {
    Hits h = hits_of(g, about);
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        const Truth before = about.at(Product::row_of(g, s), Operand::kNoFiring);
        h.clear = h.clear && before.may == before.must;
        for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
            h.may[e] &= before.must ? 0 : 1;
            h.must[e] &= before.may ? 0 : 1;
        }
    }
    return h;
}

// The same graph, its edges under the same numbers, where those of the set lead to one more state.
proof::Graph ending_at(const proof::Graph& g, const EdgeSet& hits) {
    proof::Graph out;
    out.initial = g.initial;
    out.edges = g.edges;
    out.edges.starts.push_back(out.edges.starts.back());
    for (std::size_t e = 0; e < hits.size(); ++e) {
        if (hits[e] != 0) {
            out.edges.items[e].target = g.size();
        }
    }
    out.flags = g.flags;
    out.flags.push_back(0);
    out.low_ticks = g.low_ticks;
    out.high_ticks = g.high_ticks;
    return out;
}
proof::TimeToReach time_to(const proof::Graph& g, const EdgeSet& hits) {
    const proof::Graph ending = ending_at(g, hits);
    proof::StateBits goal(ending.size());
    goal.add(g.size());
    return proof::time_to_reach(ending, goal);
}

class Timer {
 public:
    Timer(const net::NetDraft& draft, Theatre theatre, const stage::Play* play,
          const ProveOptions& options)
        : draft_(draft),
          theatre_(std::move(theatre)),
          net_(*theatre_.net),
          play_(play),
          options_(options),
          started_(now_s()) {
        if (play_ != nullptr) {
            host_ = std::make_unique<FigureLowering>(net_, *play_);
        }
    }

    std::vector<TimeAnswer> run() {
        std::vector<TimeAnswer> out;
        for (const net::TimeQuestion& q : net_.declarations().questions) {
            if (!options_.only.empty() && q.path != options_.only &&
                !q.path.starts_with(options_.only + ".")) {
                continue;
            }
            const double begin = now_s();
            TimeAnswer a{
                .question = q.path, .caption = q.caption, .where = q.where, .kind = q.kind};
            if (q.kind != TimeQuestionKind::kLongest) {
                a.quickest.emplace();
            }
            if (q.kind != TimeQuestionKind::kShortest) {
                a.slowest.emplace();
            }
            answer(q, a);
            if (has_crossings(net_)) {
                mind_crossings(a);
            }
            a.seconds = now_s() - begin;
            out.push_back(std::move(a));
        }
        return out;
    }

 private:
    double left() const { return options_.budget.seconds - (now_s() - started_); }
    proof::Budget budget(double share) const {
        proof::Budget b = options_.budget;
        b.seconds = std::max(0.0, left() * share);
        return b;
    }

    GraphLimits limits(double share) const {
        return {.budget = budget(share), .outside_events = options_.outside_events};
    }

    // The question as a rule: `possible A`, or `A leads to B` from the start.
    static Asked as_rule(const net::TimeQuestion& q, net::RuleKind kind) {
        Asked asked;
        asked.rule.path = q.path;
        asked.rule.caption = q.caption;
        asked.rule.where = q.where;
        asked.rule.kind = kind;
        if (kind == net::RuleKind::kLeadsTo) {
            asked.rule.operands.push_back(net::Formula::constant(true));
        }
        asked.rule.operands.push_back(q.about);
        return asked;
    }
    Verdict proved(const net::TimeQuestion& q, net::RuleKind kind) const {
        ProveOptions options = options_;
        options.only.clear();
        options.tell = nullptr;
        options.samples = 0;
        options.budget = budget(0.5);
        return prove_asked(draft_, theatre_, play_, {as_rule(q, kind)}, options).front();
    }

    // What the question reads, without what only collects and may grow. In a net without time every
    // firing takes a beat, wherever it is.
    std::unique_ptr<Part> part_of(const Asked& asked) {
        const Splitting parts(net_, draft_, play_, {&asked});
        net::NetDraft draft = parts.lowered();
        draft.rules = {asked.rule};
        const std::vector<std::uint32_t> read = parts.read_by(asked);
        const bool split = !net_.paced() && parts.count() > 1 && read.size() == 1;
        if (split) {
            draft = parts.draft_of(read[0], {asked.rule});
        }
        const std::vector<std::uint32_t> collecting = collectors(parts.lowered());
        const bool cut =
            !collecting.empty() && bears_cutting(asked, collecting) && !surely_finite();
        if (cut) {
            draft = without_collectors(std::move(draft));
        }
        if (split || cut) {
            auto part = Part::of(std::move(draft), theatre_, play_);
            if (part != nullptr && part->net().declarations().rules.size() == 1) {
                return part;
            }
        }
        return std::make_unique<Part>(net_, theatre_, host_.get());
    }
    bool surely_finite() {
        if (!finite_) {
            finite_ = surely_bounded(net_, budget(0.02));
        }
        return *finite_;
    }

    // What a movement may take is not what it can be made to take: only a performance attains it.
    bool depends_on_movements(const net::Net& net) const {
        const net::NetTables& tables = net.tables();
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            const std::uint32_t d = tables.place[p].duration;
            const net::ActionIndex action = net.action(net::PlaceIndex{p});
            if (d != net::kNoIndex && tables.durations[d].kind == net::DurationKind::kAuto &&
                (!action.valid() || action.value >= theatre_.actions.size() ||
                 theatre_.actions[action.value].low != theatre_.actions[action.value].high)) {
                return true;
            }
        }
        return false;
    }

    // What is asked, made ready on a graph that has all runs.
    struct Scope {
        std::unique_ptr<Part> part;
        std::uint32_t number = 0;
        Method method = Method::kExact;
        const proof::TimedGraph* timed = nullptr;
        std::string why;  // without a graph

        const Operand& about() const { return part->obligation(number).operands[0]; }
        const proof::Graph& graph() const { return timed->graph; }
    };
    Scope scope_of(const net::TimeQuestion& q) {
        Scope s;
        Asked asked = as_rule(q, net::RuleKind::kPossible);
        s.part = part_of(asked);
        if (&s.part->net() != &net_) {
            asked.rule = s.part->net().declarations().rules.front();
        }
        s.number = s.part->add(std::move(asked));
        if (!surely_finite()) {  // what grows without time is not searched to the end with it
            GraphLimits little = limits(0.1);
            little.budget.seconds = std::min(little.budget.seconds, 2.0);
            std::string why;
            s.part->whole_graph(Method::kReadiness, little, why);
        }
        for (const Method method : {Method::kExact, Method::kClasses}) {
            if (method == Method::kExact && inexact_durations(s.part->net(), theatre_.actions)) {
                continue;
            }
            std::string why;
            const proof::TimedGraph* graph = s.part->whole_graph(method, limits(0.4), why);
            if (graph == nullptr) {
                s.why = std::string(name_of(method)) + ": " + why;
            } else if (!graph->graph.over) {
                s.why = std::string(name_of(method)) + ": " + graph->not_over.front();
            } else if (graph->graph.ended != proof::Ended::kDone) {
                s.why = std::string(name_of(method)) +
                        ": not all states were looked at: " + name_of(graph->graph.ended);
            } else {
                s.method = method;
                s.timed = graph;
                return s;
            }
        }
        return s;
    }
    // What its paths do, runs do.
    bool is_sure(const Scope& s, const Hits& hits) const {
        return hits.clear && s.graph().exact && !depends_on_movements(s.part->net());
    }
    bool whole(const Scope& s) const { return &s.part->net() == &net_; }

    void answer(const net::TimeQuestion& q, TimeAnswer& a) {
        const Scope s = scope_of(q);
        if (s.timed == nullptr) {
            without_times(q, s, a);
            return;
        }
        a.method = name_of(s.method);
        a.assumptions = s.timed->assumptions;
        a.states = s.graph().size();
        a.edges = s.graph().edges.items.size();
        if (q.kind == TimeQuestionKind::kCycle) {
            rounds(s, a);
            return;
        }
        const Hits hits = hits_of(s.graph(), s.about());
        if (!hits.clear) {
            a.notes.push_back("figures decide when it is so: bounds for all times it could be");
        }
        if (q.kind == TimeQuestionKind::kShortest) {
            soonest(q, s, hits, *a.quickest);
        } else {
            latest(q, s, hits, *a.slowest);
        }
    }

    // No graph has all runs and their times: what a rule can say.
    void without_times(const net::TimeQuestion& q, const Scope& s, TimeAnswer& a) const {
        const bool slow = q.kind == TimeQuestionKind::kLongest;
        const Verdict v = proved(q, slow ? net::RuleKind::kLeadsTo : net::RuleKind::kPossible);
        a.states = v.states;
        a.edges = v.edges;
        const auto say = [&](std::optional<TimeEnd>& end) {
            if (!end) {
                return;
            }
            end->reason = s.why;
            if (v.answer == Answer::kRefuted) {
                end->says = slow ? Says::kNoBound : Says::kNever;
                end->reason = v.reason;
                a.method = v.method;
                a.assumptions = v.assumptions;
            }
            if (v.witness && (slow || v.answer == Answer::kProved)) {
                end->witness = v.witness;
                end->shown.ticks = time_shown(*v.witness);
            }
        };
        say(a.quickest);
        say(a.slowest);
    }
    static std::int64_t time_shown(const Witness& w) {
        const std::uint32_t n = w.violates_after;
        return n == 0 || n > w.steps.size() ? 0 : w.steps[n - 1].at.ticks;
    }

    void never(const net::TimeQuestion& q, const Scope& s, TimeEnd& end) const {
        (void)q;
        end.says = Says::kNever;
        end.reason =
            s.timed->graph.exact ? "no run gets there" : "no run gets there, whatever its timing";
    }

    // ---- from the start ----

    void soonest(const net::TimeQuestion& q, const Scope& s, const Hits& hits, TimeEnd& end) {
        if (hits.at_start_may) {
            end.says = Says::kTime;
            end.exact = hits.at_start_must;
            return;
        }
        const proof::TimeToReach may = time_to(s.graph(), hits.may);
        if (!may.reachable) {
            never(q, s, end);
            return;
        }
        end.says = Says::kTime;
        end.time.ticks = may.shortest;
        const bool sure = is_sure(s, hits);
        end.exact = sure && s.method == Method::kExact;
        if (hits.clear) {
            show(q, s, may.shortest_path, proof::TimedGraph::Pace::kSoonest, end);
        }
        if (!end.exact && !(end.witness && end.shown == end.time)) {
            const auto race = extreme(s, true);
            if (race && race->ended == proof::Ended::kDone && race->reached) {
                end.time.ticks = race->ticks;
                end.exact = sure;
                if (whole(s)) {
                    show(q, race->run, end);
                }
            }
        }
        attained(end, hits);
    }

    void latest(const net::TimeQuestion& q, const Scope& s, const Hits& hits, TimeEnd& end) {
        if (hits.at_start_must) {
            end.says = Says::kTime;
            end.exact = true;
            return;
        }
        const proof::TimeToReach must = time_to(s.graph(), hits.must);
        if (!must.reachable && hits.clear) {
            never(q, s, end);
            return;
        }
        if (!must.reachable || must.avoidable) {
            for_ever(q, s, hits, end);
            return;
        }
        end.says = Says::kTime;
        if (must.longest == kNever) {
            end.says = Says::kNoBound;
            end.reason = "what it waits for may take any time";
            return;
        }
        end.time.ticks = must.longest;
        const bool sure = is_sure(s, hits);
        end.exact = sure && s.method == Method::kExact;
        if (hits.clear) {
            show(q, s, must.longest_path, proof::TimedGraph::Pace::kLatest, end);
        }
        if (!end.exact && hits.clear && !(end.witness && end.shown == end.time)) {
            const auto race = extreme(s, false);
            if (race && race->ended == proof::Ended::kDone && race->reached &&
                race->ticks != kNever) {
                end.time.ticks = race->ticks;
                end.exact = sure;
                if (whole(s)) {
                    show(q, race->run, end);
                }
            }
        }
        attained(end, hits);
    }

    // Some path never gets there.
    void for_ever(const net::TimeQuestion& q, const Scope& s, const Hits& hits,
                  TimeEnd& end) const {
        Verdict v = proved(q, net::RuleKind::kLeadsTo);
        const bool refuted = v.answer == Answer::kRefuted;
        const bool unlucky = v.answer == Answer::kProved && v.force == Force::kProbabilityOne;
        if (refuted || unlucky ||
            (v.answer == Answer::kUnknown && hits.clear && s.graph().exact &&
             !has_coincidences(*s.timed))) {
            end.says = Says::kNoBound;
            end.reason = refuted   ? "it can wait for ever: " + v.reason
                         : unlucky ? "it is reached with probability 1, but ties that are lost "
                                     "again and again put it off for ever"
                                   : "it can wait for ever: some run never gets there";
            end.witness = std::move(v.witness);
            return;
        }
        end.reason = v.reason.empty() ? "some path never gets there, but no run was found that "
                                        "goes it"
                                      : v.reason;
    }

    // A run along the path; on the stage one that gets there, as it is performed.
    void show(const net::TimeQuestion& q, const Scope& s, const proof::Path& path,
              proof::TimedGraph::Pace pace, TimeEnd& end) const {
        std::string trouble;
        if (whole(s) && show(q, s.timed->script(path, &trouble, pace), end)) {
            return;
        }
        if (auto w = performed(s)) {
            end.shown.ticks = time_shown(*w);
            tell(q, end, std::move(*w));
        }
    }
    bool show(const net::TimeQuestion& q, const std::optional<proof::Script>& script,
              TimeEnd& end) const {
        std::string trouble;
        auto w = script ? witness_of(theatre_, *script, &trouble) : std::nullopt;
        if (w) {
            w->violates_after = static_cast<std::uint32_t>(w->steps.size());
            w->until = script->until;
            end.shown.ticks = script->until.ticks;
            tell(q, end, std::move(*w));
        }
        return w.has_value();
    }
    static void tell(const net::TimeQuestion& q, TimeEnd& end, Witness w) {
        w.rule = q.path;
        w.says = "reached after " + number_to_text(end.shown.seconds()) + " s";
        end.witness = std::move(w);
    }
    std::optional<Witness> performed(const Scope& s) const {
        const Finding f = check_on_graph(s.part->net(), s.part->obligation(s.number),
                                         s.part->view(s.method), kMostEdges);
        if (f.kind != Finding::Kind::kSuspect) {
            return std::nullopt;
        }
        Atoms atoms;
        Obligation o = make_obligation(net_, rule_of(s), host_.get(), atoms);
        const AtomReader reader(net_, atoms.formulas());
        const Hunt hunt{.obligation = &o,
                        .reader = &reader,
                        .finding = &f,
                        .transitions = s.part->transitions,
                        .events = s.part->events};
        PursueLimits limits;
        limits.seconds = std::clamp(left() * 0.1, 0.0, 3.0);
        limits.cancelled = options_.budget.cancelled;
        return pursue(theatre_, hunt, limits).witness;
    }
    // In the numbers of the whole net.
    net::Rule rule_of(const Scope& s) const {
        const std::string& path = s.part->asked(s.number).rule.path;
        for (const net::TimeQuestion& q : net_.declarations().questions) {
            if (q.path == path) {
                return as_rule(q, net::RuleKind::kPossible).rule;
            }
        }
        return {};
    }

    // A run that takes just so long makes a bound exact.
    static void attained(TimeEnd& end, const Hits& hits) {
        end.exact = end.exact || (hits.clear && end.witness && end.shown == end.time);
    }

    std::optional<proof::ExtremeTime> extreme(const Scope& s, bool quickest) const {
        if (s.method != Method::kClasses) {
            return std::nullopt;
        }
        const proof::Budget b = budget(0.4);
        return proof::extreme_time(s.part->request(b, options_.outside_events), test_of(s),
                                   quickest);
    }
    static proof::MomentTest test_of(const Scope& s) {
        return {.may_hold =
                    [](const void* statement, const std::uint64_t* may, const std::uint64_t* must,
                       std::uint32_t label) {
                        const AtomRow row{.may = may, .must = must};
                        return static_cast<const Operand*>(statement)->at(row, label).may;
                    },
                .statement = &s.about()};
    }

    // ---- rounds ----

    void rounds(const Scope& s, TimeAnswer& a) const {
        const proof::Graph& g = s.graph();
        const Hits visits = visits_of(g, s.about());
        if (!visits.clear) {
            a.notes.push_back("figures decide when it is so: bounds for all times it could be");
        }
        const auto most = proof::cycle_time(g, visits.may);
        if (!most) {
            const bool once =
                std::find(visits.may.begin(), visits.may.end(), 1) != visits.may.end();
            a.quickest->says = a.slowest->says = Says::kNever;
            a.quickest->reason = a.slowest->reason =
                once ? "it does not happen again and again" : "it never happens";
            return;
        }
        a.quickest->says = Says::kTime;
        set_round(s, visits, most->least, *a.quickest);
        const auto least = visits.clear ? most : proof::cycle_time(g, visits.must);
        if (!least) {
            a.slowest->reason = "figures decide whether it happens again and again";
        } else if (!least->greatest) {
            a.slowest->says = Says::kNoBound;
            a.slowest->reason = "it can happen ever more rarely";
        } else {
            a.slowest->says = Says::kTime;
            set_round(s, visits, *least->greatest, *a.slowest);
        }
        const bool sharp = a.quickest->exact && a.slowest->exact;
        const bool ceases = may_cease(g, visits.must);
        if (!sharp && visits.clear && !ceases && s.method == Method::kClasses &&
            a.slowest->says == Says::kTime) {
            by_laps(s, a);
        }
        if (ceases) {
            a.notes.push_back("of runs in which it happens again and again; in others it ceases");
        }
    }
    void set_round(const Scope& s, const Hits& visits, const proof::Round& round,
                   TimeEnd& end) const {
        end.time = {.ticks = round.ticks, .rounds = round.visits};
        const proof::Graph& g = s.graph();
        const bool sharp =
            std::all_of(round.cycle.begin(), round.cycle.end(),
                        [&](std::uint32_t e) { return g.low_ticks[e] == g.high_ticks[e]; });
        end.exact = sharp && is_sure(s, visits);
        if (s.method != Method::kExact || !end.exact || !whole(s)) {
            return;
        }
        // From one time that it happens on.
        proof::Path cycle = round.cycle;
        const auto visit = std::find_if(cycle.begin(), cycle.end(),
                                        [&](std::uint32_t e) { return visits.may[e] != 0; });
        std::rotate(cycle.begin(), visit + 1, cycle.end());
        const std::uint32_t home = g.edges.items[cycle.back()].target;
        proof::Path path = s.timed->path_to(home);
        const std::size_t stem = path.size();
        path.insert(path.end(), cycle.begin(), cycle.end());
        std::string trouble;
        if (const auto script = s.timed->script(path, &trouble)) {
            if (auto w = witness_of(theatre_, *script, &trouble)) {
                w->rule = s.part->asked(s.number).rule.path;
                w->says = "one round takes " + number_to_text(end.time.seconds()) + " s";
                w->lasso_from = firings_along(g, path, stem);
                w->until = script->until;
                end.shown = end.time;
                end.witness = std::move(w);
            }
        }
    }
    // No mean is less than the quickest round of all, nor more than the slowest.
    void by_laps(const Scope& s, TimeAnswer& a) const {
        const proof::Budget b = budget(0.4);
        const auto laps = proof::lap_times(s.part->request(b, options_.outside_events), test_of(s));
        if (!laps || !laps->any) {
            return;
        }
        const Stretch least{.ticks = laps->least}, greatest{.ticks = laps->greatest};
        if (!a.quickest->exact && least.seconds() > a.quickest->time.seconds()) {
            a.quickest->time = least;
        }
        if (!a.slowest->exact && greatest.seconds() < a.slowest->time.seconds()) {
            a.slowest->time = greatest;
        }
        // What every round takes is the mean.
        if (least == greatest && is_sure(s, {})) {
            a.quickest->exact = a.slowest->exact = true;
        }
    }
    // Some run that goes on for ever, or rests, does it only so often.
    static bool may_cease(const proof::Graph& g, const EdgeSet& visits) {
        const proof::Graph ending = ending_at(g, visits);
        proof::StateBits goal(ending.size());
        goal.add(g.size());
        // From every state, not from the start alone.
        proof::StateBits others(ending.size(), true);
        others.remove(g.size());
        const proof::StrongComponents parts = proof::strong_components(ending, &others);
        if (!proof::cyclic_components(ending, parts).empty()) {
            return true;
        }
        for (std::uint32_t n = 0; n < g.size(); ++n) {
            if (proof::may_end(g, n)) {
                return true;
            }
        }
        return false;
    }

    const net::NetDraft& draft_;
    const Theatre theatre_;
    const net::Net& net_;
    const stage::Play* play_;
    const ProveOptions& options_;
    const double started_;
    std::unique_ptr<FigureLowering> host_;
    std::optional<bool> finite_;
};

std::optional<Rational> seconds_of(const Stretch& s) {
    const auto whole = make_rational(s.ticks, kTicksPerSecond);
    return whole ? divide(*whole, Rational{s.rounds}) : std::nullopt;
}

std::string time_text(const Stretch& s, FrameRate rate) {
    std::string out = number_to_text(std::round(s.seconds() * 1e6) / 1e6) + " s";
    const auto seconds = seconds_of(s);
    const auto frames =
        seconds ? multiply(*seconds, Rational{rate.numerator, rate.denominator}) : std::nullopt;
    if (frames && frames->whole() && frames->numerator > 0) {
        out += " (" + std::to_string(frames->numerator) +
               (frames->numerator == 1 ? " frame)" : " frames)");
    }
    return out;
}

}  // namespace

double Stretch::seconds() const { return SimTime{ticks}.seconds() / static_cast<double>(rounds); }
bool Stretch::operator==(const Stretch& other) const {
    const auto a = make_rational(ticks, rounds), b = make_rational(other.ticks, other.rounds);
    return a && b && *a == *b;
}

bool TimeAnswer::known() const {
    const auto unknown = [](const std::optional<TimeEnd>& end) {
        return end && end->says == Says::kUnknown;
    };
    return !unknown(quickest) && !unknown(slowest);
}

int exit_status(const std::vector<Verdict>& verdicts, const std::vector<TimeAnswer>& answers,
                bool accept_sampled) {
    const int status = exit_status(verdicts, accept_sampled);
    const bool known =
        std::all_of(answers.begin(), answers.end(), [](const TimeAnswer& a) { return a.known(); });
    return status == 0 && !known ? 3 : status;
}

std::string exact_seconds(const Stretch& s) {
    const auto seconds = seconds_of(s);
    if (!seconds) {
        return number_to_text(s.seconds());
    }
    return std::to_string(seconds->numerator) +
           (seconds->whole() ? "" : "/" + std::to_string(seconds->denominator));
}

std::string text(const TimeAnswer& a, FrameRate rate) {
    const auto word = [](Says says) {
        return says == Says::kNever ? "never" : says == Says::kNoBound ? "no bound" : "UNKNOWN";
    };
    const auto one = [&](const TimeEnd& end, const char* bound) -> std::string {
        if (end.says != Says::kTime) {
            return word(end.says);
        }
        std::string out = (end.exact ? "" : bound) + time_text(end.time, rate);
        if (!end.exact && end.witness) {
            out += "; a run takes " + time_text(end.shown, rate);
        }
        return out;
    };
    if (!a.slowest) {
        return one(*a.quickest, "at least ");
    }
    if (!a.quickest) {
        return one(*a.slowest, "at most ");
    }
    const TimeEnd &low = *a.quickest, &high = *a.slowest;
    if (low.says != Says::kTime) {
        return word(low.says);
    }
    if (high.says == Says::kTime && high.time == low.time) {
        return time_text(low.time, rate) + " a round";
    }
    std::string out = low.exact ? "" : "at least ";
    out += time_text(low.time, rate) + ", ";
    if (high.says == Says::kTime) {
        out += (high.exact ? "" : "at most ") + time_text(high.time, rate);
    } else {
        out += word(high.says);
    }
    return out + " a round";
}

std::vector<TimeAnswer> answer_times(const scene::Scene& scene, const ProveOptions& options) {
    return Timer(scene.draft, theatre_of(scene), &scene.play, options).run();
}

std::vector<TimeAnswer> answer_times(const net::NetDraft& draft, const net::Net& net,
                                     const ProveOptions& options) {
    return Timer(draft, theatre_of(net), nullptr, options).run();
}

}  // namespace puppetri::verdict
