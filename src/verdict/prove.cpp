// SPDX-License-Identifier: MIT
// The order of methods. For each rule: arcs and theorems; the readiness graph of its part, which
// holds for every timing; then what knows times: exact ones, classes of them. A suspect is pursued
// by the player at once; if no run shows it, the next method may clear it or show it better.
#include "puppetri/verdict/prove.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "asked_rules.h"
#include "builtin_rules.h"
#include "by_structure.h"
#include "crossings.h"
#include "cutting.h"
#include "growth.h"
#include "join_rule.h"
#include "linear_rule.h"
#include "part.h"
#include "path_witness.h"
#include "plain_witness.h"
#include "prover.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/verdict/sample.h"
#include "questions.h"
#include "splitting.h"
#include "temporal_rule.h"

namespace puppetri::verdict {
namespace {

using Kind = Finding::Kind;
using Target = Finding::Target;

const std::string kByCoincidence =
    "only by an exact coincidence of drawn times, which has probability 0: ";

// Of a graph watched by a monitor: 24 bytes each.
std::uint64_t most_edges(const proof::Budget& budget) {
    return std::min<std::uint64_t>(40'000'000, budget.bytes / 24);
}

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

struct Work {
    Asked asked;  // in the numbers of the whole net
    Verdict verdict;
    bool done = false;
    bool wants_times = false;  // known to be refuted, by a path that only exact times can play
    double seconds = 0;
};

class Prover {
 public:
    Prover(const net::NetDraft& draft, Theatre theatre, const stage::Play* play,
           const ProveOptions& options)
        : draft_(draft),
          theatre_(std::move(theatre)),
          net_(*theatre_.net),
          play_(play),
          options_(options),
          started_(now_s()),
          structure_(net_) {
        if (play_ != nullptr) {
            host_ = std::make_unique<FigureLowering>(net_, *play_);
        }
    }

    std::vector<Verdict> run(std::vector<Asked> rules) {
        for (Asked& asked : rules) {
            Work w;
            w.asked = std::move(asked);
            const net::Rule& rule = w.asked.rule;
            w.verdict.rule = rule.path;
            w.verdict.caption = rule.caption;
            w.verdict.where = rule.where;
            w.verdict.built_in = w.asked.built_in;
            works_.push_back(std::move(w));
        }
        for (Work& w : works_) {
            by_structure(w);
        }
        for (const Splitting::Group& group : groups()) {
            by_graphs(group);
        }
        if (!left_over_.empty()) {
            Part all(net_, theatre_, host_.get());
            examine(all, std::exchange(left_over_, {}));
        }
        std::vector<Verdict> out;
        for (Work& w : works_) {
            if (!w.done) {
                finish(w);
            }
            out.push_back(std::move(w.verdict));
        }
        return out;
    }

 private:
    // ---- budgets ----

    double left() const { return options_.budget.seconds - (now_s() - started_); }
    bool cancelled() const {
        return options_.budget.cancelled != nullptr && options_.budget.cancelled->load();
    }
    proof::Budget budget(double share) const {
        proof::Budget b = options_.budget;
        b.seconds = std::max(0.0, left() * share);
        return b;
    }

    void finish(Work& w) {
        w.done = true;
        if (has_crossings(net_)) {
            mind_crossings(theatre_, w.asked.rule, w.verdict);
        }
        if (host_ && w.verdict.answer != Answer::kUnknown) {
            const std::vector<std::string> more = host_->assumptions(w.asked.rule);
            w.verdict.assumptions.insert(w.verdict.assumptions.end(), more.begin(), more.end());
        }
        w.verdict.seconds = w.seconds;
        if (w.verdict.answer == Answer::kUnknown && w.verdict.reason.empty()) {
            w.verdict.reason = cancelled()   ? "stopped before an answer"
                               : left() <= 0 ? "out of time"
                                             : "no method can say";
        }
        if (options_.tell != nullptr) {
            options_.tell(options_.context, w.verdict);
        }
    }

    // ---- structure ----

    void by_structure(Work& w) {
        const double begin = now_s();
        proof::Budget b = budget(0.1);
        b.seconds = std::min(b.seconds, 5.0);
        if (const auto proof = structure_.prove(w.asked, host_.get(), b)) {
            w.verdict.answer = Answer::kProved;
            w.verdict.method = proof->method;
            w.verdict.notes = proof->notes;
            w.seconds += now_s() - begin;
            finish(w);
            return;
        }
        w.seconds += now_s() - begin;
        if (w.asked.question == Question::kRule && !structure_.grows.empty() &&
            w.asked.rule.kind == net::RuleKind::kBounded) {
            w.verdict.notes.push_back(structure_.grows);
        }
        if (w.asked.question == Question::kOneOfEach) {
            w.verdict.reason = "an arc may lose, copy or make up an identity";
            finish(w);
        }
    }

    // ---- parts ----

    std::vector<Splitting::Group> groups() {
        std::vector<std::uint32_t> open;
        std::vector<const Asked*> rules;
        for (std::uint32_t i = 0; i < works_.size(); ++i) {
            if (!works_[i].done) {
                open.push_back(i);
                rules.push_back(&works_[i].asked);
            }
        }
        if (open.empty()) {
            return {};
        }
        parts_ = Splitting(net_, draft_, play_, rules);
        std::vector<Splitting::Group> out = parts_.groups(rules);
        for (Splitting::Group& group : out) {
            for (std::uint32_t& i : group.rules) {
                i = open[i];
            }
        }
        return out;
    }

    // ---- graphs ----

    // What bears it, without the places that only collect, if these may grow.
    void by_graphs(const Splitting::Group& group) {
        const std::vector<std::uint32_t> collecting = growing_collectors();
        std::vector<std::uint32_t> without, with;
        for (const std::uint32_t i : group.rules) {
            const bool bears = !collecting.empty() && bears_cutting(works_[i].asked, collecting);
            (bears ? without : with).push_back(i);
        }
        by_graphs(group.part, without, true);
        by_graphs(group.part, with, false);
    }
    std::vector<std::uint32_t> growing_collectors() {
        if (!collectors_) {
            collectors_ = collectors(parts_.lowered());
            if (!collectors_->empty() && surely_bounded(net_, budget(0.02))) {
                collectors_->clear();
            }
        }
        return *collectors_;
    }

    void by_graphs(std::uint32_t which, const std::vector<std::uint32_t>& group, bool cut) {
        const bool whole = which == kWhole;
        if (group.empty() || (whole && parts_.count() > 1 && by_parts(group, cut))) {
            return;
        }
        auto part = whole && !cut ? nullptr : make_part(which, group, cut);
        if (part == nullptr) {
            part = std::make_unique<Part>(net_, theatre_, host_.get());
        }
        examine(*part, group);
    }

    std::unique_ptr<Part> make_part(std::uint32_t which, const std::vector<std::uint32_t>& group,
                                    bool cut) {
        std::vector<net::Rule> rules;
        for (const std::uint32_t i : group) {
            rules.push_back(works_[i].asked.rule);
        }
        net::NetDraft draft;
        if (which == kWhole) {
            draft = parts_.lowered();
            draft.rules = std::move(rules);
        } else {
            draft = parts_.draft_of(which, rules);
        }
        return Part::of(cut ? without_collectors(std::move(draft)) : std::move(draft), theatre_,
                        play_);
    }

    // Rules about the whole net, asked of each part: all parts keep them, or (for rest) one does.
    bool by_parts(const std::vector<std::uint32_t>& group, bool cut) {
        std::vector<std::uint32_t> rest;
        std::vector<Verdict> sums(group.size());
        std::vector<std::uint8_t> good(group.size(), 1), once(group.size(), 0);
        for (std::uint32_t p = 0; p < parts_.count(); ++p) {
            auto part = make_part(p, {}, cut);
            if (part == nullptr) {
                return false;
            }
            // All rules first: the graph is made for their atoms.
            std::vector<std::uint32_t> numbers(group.size(), kWhole);
            for (std::size_t k = 0; k < group.size(); ++k) {
                const Work& w = works_[group[k]];
                if (!Splitting::splits(w.asked)) {
                    good[k] = 0;
                    continue;
                }
                Asked own = w.asked;  // reads nothing by number
                own.rule.operands.clear();
                own.rule.transitions.clear();
                numbers[k] = part->add(std::move(own));
            }
            // What is too large for a graph is decided on the markings of the whole.
            std::string why;
            if (net_.paced() && few_of(*part, Method::kReadiness, why) != nullptr &&
                part->view(Method::kReadiness).timed->graph.ended == proof::Ended::kStates) {
                return false;
            }
            for (std::size_t k = 0; k < group.size(); ++k) {
                const Work& w = works_[group[k]];
                const std::uint32_t number = numbers[k];
                if (number == kWhole) {
                    continue;
                }
                Verdict v;
                std::optional<Finding> f = check(*part, number, Method::kReadiness, v);
                const bool holds = f && f->kind == Kind::kHolds;
                once[k] |= holds ? 1 : 0;
                good[k] &= holds || Splitting::one_is_enough(w.asked) ? 1 : 0;
                sums[k].states += v.states;
                sums[k].edges += v.edges;
                if (f && (f->force == Force::kProbabilityOne ||
                          sums[k].force != Force::kProbabilityOne)) {
                    sums[k].force = f->force;  // the weakest of all
                }
            }
        }
        bool all = true;
        for (std::size_t k = 0; k < group.size(); ++k) {
            Work& w = works_[group[k]];
            if (good[k] != 0 && (!Splitting::one_is_enough(w.asked) || once[k] != 0)) {
                w.verdict.answer = Answer::kProved;
                w.verdict.force = sums[k].force;
                w.verdict.method =
                    std::string("readiness graphs of ") + std::to_string(parts_.count()) + " parts";
                w.verdict.states = sums[k].states;
                w.verdict.edges = sums[k].edges;
                finish(w);
            } else {
                all = false;
            }
        }
        return all;
    }
    void examine(Part& part, const std::vector<std::uint32_t>& group) {
        joins_.reset();
        std::vector<std::uint32_t> open, numbers;
        for (const std::uint32_t i : group) {
            if (works_[i].done) {
                continue;
            }
            Asked own = works_[i].asked;
            if (&part.net() != &net_) {
                const std::vector<net::Rule>& rules = part.net().declarations().rules;
                const auto found =
                    std::find_if(rules.begin(), rules.end(),
                                 [&](const net::Rule& r) { return r.path == own.rule.path; });
                if (found == rules.end()) {
                    left_over_.push_back(i);  // it speaks of what parts do not have
                    continue;
                }
                own.rule = *found;
            }
            open.push_back(i);
            numbers.push_back(part.add(std::move(own)));
        }
        by_markings(part, open, numbers);
        for (const Method method : {Method::kReadiness, Method::kExact, Method::kClasses}) {
            for (std::size_t k = 0; k < open.size(); ++k) {
                Work& w = works_[open[k]];
                if (w.done || left() <= 0 || cancelled()) {
                    continue;
                }
                const bool plays = method == Method::kExact && w.wants_times;
                if (method != Method::kReadiness && !plays && !worth(part, method)) {
                    continue;
                }
                const double begin = now_s();
                judge(part, numbers[k], method, w);
                w.seconds += now_s() - begin;
                if (w.verdict.answer != Answer::kUnknown) {
                    finish(w);
                }
            }
        }
        for (const std::uint32_t i : open) {
            if (!works_[i].done) {
                by_growth(works_[i]);
                by_sampling(works_[i]);
                finish(works_[i]);
            }
        }
    }

    // ---- markings ----

    // Where the graph is large, what markings alone decide comes before it.
    void by_markings(Part& part, const std::vector<std::uint32_t>& open,
                     const std::vector<std::uint32_t>& numbers) {
        std::string why;
        const proof::TimedGraph* few = few_of(part, Method::kReadiness, why);
        if (few == nullptr || cancelled() ||
            (few->graph.ended == proof::Ended::kDone &&
             few->graph.size() <= options_.first_look_states)) {
            return;
        }
        // Of a net with times it sees too much to spend much on it, and what grows has no end.
        const bool may_end = part.net().paced() && structure_.grows.empty();
        PlainRules rules(part.net(), part.host(), budget(may_end ? 0.6 : 0.1));
        if (!rules.available()) {
            return;
        }
        for (std::size_t k = 0; k < open.size(); ++k) {
            Work& w = works_[open[k]];
            if (w.asked.question != Question::kRule || left() <= 0 || cancelled()) {
                continue;
            }
            const double begin = now_s();
            settle(part, numbers[k], rules.decide(part.asked(numbers[k]).rule), w);
            w.seconds += now_s() - begin;
            if (w.verdict.answer != Answer::kUnknown) {
                finish(w);
            }
        }
    }

    void settle(const Part& part, std::uint32_t number, const PlainFinding& f, Work& w) {
        std::string trouble = "none was found within the budget";
        std::optional<Witness> witness;
        if (f.run) {
            const Watched watch = watched(w.asked);
            witness = witness_of_firings(theatre_, watch.obligation, *watch.reader, f,
                                         part.in_whole(*f.run), trouble);
        }
        conclude(f, part.asked(number).rule.kind, std::move(witness), trouble, w.verdict);
    }

    void by_growth(Work& w) {
        const net::Rule& rule = w.asked.rule;
        if (w.asked.question != Question::kRule || rule.kind != net::RuleKind::kBounded ||
            rule.count != kNoCount || parts_.lowered().places.empty() || cancelled()) {
            return;
        }
        const double begin = now_s();
        proof::Budget b = budget(0.1);
        b.seconds = std::min(b.seconds, 5.0);
        refute_bounded(theatre_, parts_.lowered(), play_, rule, structure_.pump,
                       options_.outside_events, b, w.verdict);
        w.seconds += now_s() - begin;
    }

    void by_sampling(Work& w) {
        if (w.verdict.answer != Answer::kUnknown || options_.samples == 0 ||
            w.asked.question != Question::kRule || cancelled()) {
            return;
        }
        const Watched watch = watched(w.asked);
        SampleOptions o;
        o.runs = options_.samples;
        o.seconds = std::max(1.0, left());
        Sampled result = sample(theatre_, watch.obligation, *watch.reader, o);
        if (result.witness) {
            w.verdict.answer = Answer::kRefuted;
            w.verdict.method = "sampling";
            w.verdict.reason = "a sampled run breaks it";
            result.witness->says = w.verdict.reason;
            w.verdict.witness = std::move(result.witness);
        } else if (result.sample) {
            w.verdict.answer = Answer::kSampled;
            w.verdict.method = "sampling";
            w.verdict.sample = result.sample;
        }
    }

    // Whether time may tell more: not where there is none, and exact times only where they are.
    bool worth(Part& part, Method method) {
        std::string why;
        const proof::TimedGraph* readiness = graph_of(part, Method::kReadiness, why);
        if (readiness != nullptr && readiness->graph.exact &&
            readiness->graph.ended == proof::Ended::kDone) {
            return false;
        }
        if (method == Method::kExact) {
            return !inexact_durations(part.net(), theatre_.actions);
        }
        return true;
    }
    GraphLimits limits_of(Method method) const {
        return {.budget = budget(method == Method::kReadiness ? 0.4 : 0.6),
                .first_look_states = options_.first_look_states,
                .outside_events = options_.outside_events};
    }
    const proof::TimedGraph* few_of(Part& part, Method method, std::string& why) const {
        return part.first_look(method, limits_of(method), why);
    }
    const proof::TimedGraph* graph_of(Part& part, Method method, std::string& why) const {
        return part.whole_graph(method, limits_of(method), why);
    }

    // The finding of one method, and what it cost.
    std::optional<Finding> check(Part& part, std::uint32_t number, Method method, Verdict& v) {
        std::string why;
        const proof::TimedGraph* graph = graph_of(part, method, why);
        if (graph == nullptr) {
            if (v.reason.empty()) {
                v.reason = std::string(name_of(method)) + ": " + why;
            }
            return std::nullopt;
        }
        v.states = graph->graph.size();
        v.edges = graph->graph.edges.items.size();
        const Asked& asked = part.asked(number);
        const GraphView view = part.view(method);
        if (asked.question != Question::kRule) {
            return check_question(asked.question, view, most_edges(options_.budget));
        }
        if (part.obligation(number).temporal) {
            return check_temporal(part.net(), part.obligation(number), view, budget(0.5));
        }
        return check_on_graph(part.net(), part.obligation(number), view,
                              most_edges(options_.budget));
    }

    // First without a graph, if none is there yet: invariants may say who follows whom.
    void judge_joins(Part& part, Method method, Work& w) {
        if (play_ == nullptr) {
            return;
        }
        if (joins_ == nullptr) {
            joins_ = std::make_unique<JoinRule>(part, theatre_, join_book_);
        }
        std::uint32_t actor = 0;
        while (play_->cast.actors[actor].name != w.asked.rule.subjects.front()) {
            ++actor;
        }
        const JoinRule::Limits limits{.seconds = std::clamp(left() * 0.1, 0.0, 5.0),
                                      .cancelled = options_.budget.cancelled};
        if (method == Method::kReadiness && !part.has(method) &&
            joins_->judge(actor, nullptr, limits, w.verdict)) {
            return;
        }
        std::string why;
        if (graph_of(part, method, why) == nullptr) {
            if (w.verdict.reason.empty()) {
                w.verdict.reason = std::string(name_of(method)) + ": " + why;
            }
            return;
        }
        const GraphView view = part.view(method);
        joins_->judge(actor, &view, limits, w.verdict);
    }

    void judge(Part& part, std::uint32_t number, Method method, Work& w) {
        if (w.asked.question == Question::kJoins) {
            judge_joins(part, method, w);
            return;
        }
        std::optional<Finding> f = check(part, number, method, w.verdict);
        if (!f) {
            return;
        }
        const proof::TimedGraph& graph = *part.view(method).timed;
        const bool possible =
            w.asked.question == Question::kRule && (w.asked.rule.kind == net::RuleKind::kPossible ||
                                                    w.asked.rule.kind == net::RuleKind::kQuasiLive);
        switch (f->kind) {
            case Kind::kHolds:
                w.verdict.answer = Answer::kProved;
                w.verdict.force = f->force;
                w.verdict.method = name_of(method);
                w.verdict.assumptions = graph.assumptions;
                w.verdict.reason.clear();
                w.verdict.notes.insert(w.verdict.notes.end(), f->notes.begin(), f->notes.end());
                if (f->force == Force::kProbabilityOne) {
                    w.verdict.notes.push_back("REFUTED " + f->reason);
                    chase(part, *f, w, false);
                }
                return;
            case Kind::kImpossible:
                w.verdict.answer = Answer::kRefuted;
                w.verdict.method = name_of(method);
                w.verdict.assumptions = graph.assumptions;
                w.verdict.reason = f->reason;
                return;
            case Kind::kRefuted:
                refuted(part, graph, *f, w, method);
                by_game(part, number, method, w);
                return;
            case Kind::kSuspect:
                if (f->target == Target::kFires) {
                    all_fire(part, *f, w, method);
                    return;
                }
                // Whether ties or fate goes round for ever is told by exact states, and what is too
                // late by those that know times.
                if (method == Method::kReadiness &&
                    ((f->target == Target::kEndless && worth(part, Method::kExact)) ||
                     (f->target == Target::kTooLong &&
                      (worth(part, Method::kExact) || worth(part, Method::kClasses))))) {
                    w.verdict.reason = f->reason;
                    return;
                }
                chase(part, *f, w, true);
                if (w.verdict.answer == Answer::kUnknown && f->sure) {
                    w.verdict.answer = Answer::kRefuted;
                    w.verdict.assumptions = graph.assumptions;
                    w.verdict.reason = "the formula does not hold at the start";
                    w.verdict.notes.push_back("no single run shows it: it is about all of them");
                }
                if (w.verdict.answer != Answer::kUnknown) {
                    w.verdict.method = name_of(method);
                } else if (possible && graph.graph.exact && !has_coincidences(graph)) {
                    w.verdict.answer = Answer::kProved;
                    w.verdict.method = name_of(method);
                    w.verdict.assumptions = graph.assumptions;
                    w.verdict.reason.clear();
                }
                return;
            case Kind::kUnknown:
                w.verdict.reason = std::string(name_of(method)) + ": " + f->reason;
                if (part.grows && f->reason.find("may grow") == std::string::npos) {
                    w.verdict.reason += "; times left aside, tokens pile up in place " +
                                        part.grows_where + " without end: give it a bound";
                }
                return;
        }
    }

    // A formula of linear time whose path the player did not go.
    void by_game(Part& part, std::uint32_t number, Method method, Work& w) {
        const Obligation& o = part.obligation(number);
        if (w.verdict.answer != Answer::kUnknown || !o.temporal ||
            o.temporal->logic != proof::Temporal::Logic::kLtl) {
            return;
        }
        const GraphView view = part.view(method);
        const Finding f =
            check_linear(part.net(), o, view, budget(0.3), most_edges(options_.budget));
        if (f.kind == Kind::kHolds) {
            w.verdict.answer = Answer::kProved;
            w.verdict.force = f.force;
            w.verdict.reason.clear();
        } else if (f.kind == Kind::kSuspect) {
            chase(part, f, w, true);
        }
        if (w.verdict.answer != Answer::kUnknown) {
            w.verdict.method = name_of(method);
            w.verdict.assumptions = view.timed->assumptions;
        }
    }

    // By a path of an exact graph of the whole net: it counts if the player goes it.
    void refuted(const Part& part, const proof::TimedGraph& graph, const Finding& f, Work& w,
                 Method method) {
        w.verdict.reason = f.reason;
        if (by_coincidence(graph, f)) {
            w.verdict.reason = kByCoincidence + f.reason;
            return;
        }
        if (!f.shown) {
            w.verdict.notes.push_back("no single run shows it: it is about choices");
        } else {
            std::string trouble = "it lies in a part of the net";
            auto witness =
                &part.net() == &net_ ? witness_of_path(theatre_, graph, f, trouble) : std::nullopt;
            if (!witness) {
                w.wants_times = method == Method::kReadiness;
                w.verdict.reason = f.reason + ", but the player does not go that way: " + trouble;
                return;
            }
            witness->rule = w.verdict.rule;
            w.verdict.witness = std::move(witness);
        }
        w.verdict.answer = Answer::kRefuted;
        w.verdict.method = name_of(method);
        w.verdict.assumptions = graph.assumptions;
    }

    // The rule in the numbers of the whole net, as runs are watched.
    struct Watched {
        Atoms atoms;
        Obligation obligation;
        std::unique_ptr<AtomReader> reader;
    };
    Watched watched(const Asked& asked) const {
        Watched w;
        w.obligation = make_obligation(net_, asked.rule, host_.get(), w.atoms);
        if (asked.rule.path.starts_with("builtin.one_movement")) {
            w.obligation.about_figures = true;
        }
        w.reader = std::make_unique<AtomReader>(net_, w.atoms.formulas());
        return w;
    }
    PursueLimits limits(const Finding& f) const {
        PursueLimits l;
        // Half a graph is a poor guide.
        l.seconds = std::clamp(left() * 0.1, 0.0, f.product.complete ? 5.0 : 2.0);
        l.cancelled = options_.budget.cancelled;
        return l;
    }

    // A suspect becomes REFUTED (of `possible`: PROVED) by a run. `decides` false: the run is only
    // kept as a picture.
    void chase(Part& part, const Finding& f, Work& w, bool decides) {
        const Watched watch = watched(w.asked);
        const Hunt hunt{.obligation = &watch.obligation,
                        .reader = watch.reader.get(),
                        .finding = &f,
                        .transitions = part.transitions,
                        .events = part.events,
                        .fault_counts = fault_of(w.asked.question)};
        // A thousand firings in one instant show what a hundred thousand would.
        Theatre theatre = theatre_;
        if (w.asked.question == Question::kTimeGoesOn) {
            theatre.firings_per_instant = 1000;
        }
        Caught caught = pursue(theatre, hunt, limits(f));
        if (!caught.witness) {
            if (!decides) {
                return;
            }
            w.verdict.reason =
                f.reason + ", but no run was found that does it (" + caught.reason + ")";
            if (draws_times(net_)) {
                PursueLimits any = limits(f);
                any.coincide = true;
                if (pursue(theatre, hunt, any).witness) {
                    w.verdict.reason = kByCoincidence + f.reason;
                }
            }
            return;
        }
        caught.witness->says = caught.reason;
        if (f.target == Target::kHopeless) {  // long enough to see that nothing comes any more
            constexpr SimTime kWaiting{8 * kTicksPerSecond};
            caught.witness->until = caught.witness->until + kWaiting;
        }
        w.verdict.witness = std::move(caught.witness);
        if (!decides) {
            return;
        }
        const bool possible = f.proves || (w.asked.question == Question::kRule &&
                                           w.asked.rule.kind == net::RuleKind::kPossible);
        w.verdict.answer = possible ? Answer::kProved : Answer::kRefuted;
        w.verdict.reason = possible ? "" : caught.reason;
    }

    // A run for each transition.
    void all_fire(Part& part, Finding& f, Work& w, Method method) {
        const Watched watch = watched(w.asked);
        for (const std::uint32_t t : watch.obligation.transitions) {
            f.transition = t;
            const Hunt hunt{.obligation = &watch.obligation,
                            .reader = watch.reader.get(),
                            .finding = &f,
                            .transitions = part.transitions,
                            .events = part.events};
            const Caught caught = pursue(theatre_, hunt, limits(f));
            if (!caught.witness) {
                w.verdict.reason = "no run was found in which " +
                                   std::string(net_.transition(net::TransitionIndex{t}).path) +
                                   " fires";
                return;
            }
        }
        w.verdict.answer = Answer::kProved;
        w.verdict.method = std::string(name_of(method)) + " and runs";
        w.verdict.reason.clear();
    }

    static constexpr std::uint32_t kWhole = Splitting::kWhole;

    const net::NetDraft& draft_;
    const Theatre theatre_;
    const net::Net& net_;
    const stage::Play* play_;
    const ProveOptions& options_;
    const double started_;
    Structure structure_;
    std::unique_ptr<FigureLowering> host_;
    std::vector<Work> works_;
    Splitting parts_;
    std::optional<std::vector<std::uint32_t>> collectors_;
    std::vector<std::uint32_t> left_over_;
    JoinBook join_book_;
    std::unique_ptr<JoinRule> joins_;  // of the part that is being looked at
};

}  // namespace

std::vector<Verdict> prove_asked(const net::NetDraft& draft, const Theatre& theatre,
                                 const stage::Play* play, std::vector<Asked> asked,
                                 const ProveOptions& options) {
    Prover prover(draft, theatre, play, options);
    return prover.run(std::move(asked));
}

std::vector<Verdict> prove(const scene::Scene& scene, const ProveOptions& options) {
    return prove_asked(scene.draft, theatre_of(scene), &scene.play,
                       chosen(all_rules(scene), options), options);
}

std::vector<Verdict> prove(const net::NetDraft& draft, const net::Net& net,
                           const ProveOptions& options) {
    return prove_asked(draft, theatre_of(net), nullptr, chosen(all_rules(draft, net), options),
                       options);
}

}  // namespace puppetri::verdict
