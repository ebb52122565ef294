// SPDX-License-Identifier: MIT
// Order, cheapest first. Successions: a single token that goes round through all movements of a
// figure (an invariant) says who can follow whom without any state space; else a graph does. Joins:
// one run of the part on the stage shows most successions; runs with other luck some more; what is
// left is looked for along the graph by the player (pursue.h), as the breaking of "after A began,
// nothing begins by T until something else has begun". A bad join counts when a run of the whole
// net shows it twice.
#include "join_rule.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "join_key.h"
#include "puppetri/base/text.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/semiflows.h"
#include "puppetri/proof/state_equation.h"
#include "seeded_chooser.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;
using proof::Succession;

constexpr std::uint32_t kRuns = 4;             // with different luck
constexpr std::uint32_t kMostPursued = 24;     // successions looked for one by one
constexpr std::uint64_t kMostFirings = 5'000;  // of one run

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// One token goes round through all places of the lane.
struct Round {
    std::vector<std::uint32_t> places;
    std::vector<proof::Invariant> used;
};

bool acyclic(const proof::Graph& graph) {
    std::vector<std::uint32_t> before(graph.size(), 0), open;
    for (const proof::Edge& e : graph.edges.items) {
        ++before[e.target];
    }
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        if (before[s] == 0) {
            open.push_back(s);
        }
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
        for (const proof::Edge& e : graph.edges.row(open[i])) {
            if (--before[e.target] == 0) {
                open.push_back(e.target);
            }
        }
    }
    return open.size() == graph.size();
}

}  // namespace

struct JoinRule::Data {
    Part& part;
    const Theatre& theatre;
    const stage::Play& play;
    JoinBook& book;
    const net::Net& net;
    MovementLanes lanes;
    proof::Plain plain;
    std::vector<std::uint8_t> emptied;

    // Per figure.
    struct State {
        bool known = false;             // `open` has every succession that can be
        std::vector<Succession> open;   // not measured yet
        std::set<Succession> measured;  // or impossible
        std::uint32_t pursued = 0;
        std::uint32_t joins = 0;  // measured
        std::string source;       // where the successions are from
    };
    std::map<std::uint32_t, State> states;

    // Runs of the part, kept going; one per luck.
    struct Running {
        SeededChooser chooser;
        JoinRun run;
        std::set<Succession> successions;
        std::uint64_t fruitful = 0;  // the last firing that showed something new
        std::size_t looked = 0;
        explicit Running(const Data& d, std::uint64_t number)
            : chooser(number), run(d.net, d.theatre, d.lanes, chooser, d.theatre.seed, {}) {}
    };
    std::vector<std::unique_ptr<Running>> runs;
    double until = 0;
    const std::atomic<bool>* cancelled = nullptr;

    Data(Part& p, const Theatre& t, JoinBook& b)
        : part(p),
          theatre(t),
          play(t.scene->play),
          book(b),
          net(p.net()),
          lanes(movement_lanes(net, play)),
          plain(proof::plain(net)),
          emptied(proof::emptied_places(net)) {}

    bool out_of_time() const {
        return now_s() > until || (cancelled != nullptr && cancelled->load());
    }

    // ---- words ----

    std::string path(std::uint32_t place) const {
        return std::string(net.place(net::PlaceIndex{place}).path);
    }
    std::string name_of_item(std::uint32_t lane, std::uint32_t item) const {
        const auto& places = lanes.lanes[lane].places;
        return item < places.size()    ? path(places[item])
               : item == places.size() ? "its rest after a cut"
                                       : "the start";
    }
    std::string words(const Succession& s) const {
        return name_of_item(s.lane, s.after) + " after " + name_of_item(s.lane, s.before) +
               " (by " + std::string(net.transition(net::TransitionIndex{s.by}).path) + ")";
    }
    std::string key(const Succession& s) const {
        const MovementLanes::Lane& lane = lanes.lanes[s.lane];
        const auto of = [&](std::uint32_t item) -> std::string {
            if (item >= lane.places.size()) {
                return item == lane.places.size() ? "rest" : "start";
            }
            std::string& known = keys_[lane.places[item]];
            if (known.empty()) {
                known = join_key(net, play, net::PlaceIndex{lane.places[item]});
            }
            return known;
        };
        std::string& body = bodies_[lane.actor];
        if (body.empty()) {
            body = body_key(play.cast, lane.actor);
        }
        return body + "|" + of(s.before) + "|" + of(s.after);
    }
    mutable std::map<std::uint32_t, std::string> keys_, bodies_;  // once made
    // A join that is out of the limits.
    struct Bad {
        Succession succession;
        SimTime at;
        motion::JoinFault fault;
        std::string joint;
    };
    std::string fault_words(const Bad& bad) const {
        const motion::JoinFault& f = bad.fault;
        const bool is_ratio = f.unit[0] == '\0';
        return "when " + words(bad.succession) + " begins at " +
               number_to_text_fixed(bad.at.seconds(), 3) + " s, the " + f.quantity + " of " +
               bad.joint + (is_ratio ? " is " : " jumps by ") + number_to_text_fixed(f.value, 3) +
               (is_ratio ? " times either side" : std::string(" ") + f.unit) + " (at most " +
               number_to_text(f.limit) + ")";
    }

    // ---- successions ----

    // From an invariant; nothing if there is none that says it.
    std::optional<std::vector<Succession>> by_invariant(std::uint32_t l) const {
        if (plain.unsound) {
            return std::nullopt;
        }
        const MovementLanes::Lane& lane = lanes.lanes[l];
        proof::LinearSum sum;
        for (const std::uint32_t p : lane.places) {
            sum.terms.push_back({p, 1});
        }
        proof::Budget budget;
        budget.seconds = std::max(0.0, std::min(until - now_s(), 1.0));
        const auto used = proof::prove_by_invariants(
            plain.net, proof::Predicate::at_least(std::move(sum), 2), budget, emptied);
        if (!used || used->size() != 1) {
            return std::nullopt;
        }
        const proof::Invariant& i = used->front();
        if (i.kind != proof::Invariant::kEqual || i.limit != 1) {
            return std::nullopt;
        }
        std::vector<std::uint8_t> on(net.place_count(), 0);
        for (const auto& term : i.sum.terms) {
            if (term.factor != 1) {
                return std::nullopt;
            }
            on[term.place] = 1;
        }
        if (std::any_of(lane.places.begin(), lane.places.end(),
                        [&](std::uint32_t p) { return on[p] == 0; })) {
            return std::nullopt;
        }
        // The places of the token are the states.
        proof::Graph graph;
        std::vector<std::uint32_t> state(net.place_count(), 0);
        for (std::uint32_t k = 0; k < i.sum.terms.size(); ++k) {
            const std::uint32_t p = i.sum.terms[k].place;
            state[p] = k;
            if (plain.net.initial[p] > 0) {
                graph.initial = k;
            }
        }
        std::vector<std::vector<proof::Edge>> rows(i.sum.terms.size());
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            std::uint32_t from = ~0u, to = ~0u, taken = 0;
            for (const net::Weighted& w : plain.net.takes.row(t)) {
                if (on[w.place] != 0) {
                    from = state[w.place];
                    taken += w.weight;
                }
            }
            for (const net::Weighted& w : plain.net.gives.row(t)) {
                if (on[w.place] != 0) {
                    to = state[w.place];
                }
            }
            if (taken == 1 && to != ~0u) {
                rows[from].push_back({t, to});
            } else if (taken == 0 && to == ~0u && !plain.net.reads.row(t).empty()) {
                for (const net::Weighted& w : plain.net.reads.row(t)) {
                    if (on[w.place] != 0) {
                        rows[state[w.place]].push_back({t, state[w.place]});
                    }
                }
            }
        }
        for (const auto& row : rows) {
            graph.edges.items.insert(graph.edges.items.end(), row.begin(), row.end());
            graph.edges.starts.push_back(static_cast<std::uint32_t>(graph.edges.items.size()));
        }
        return only(l, proof::successions({.graph = graph,
                                           .begins = lanes.begins,
                                           .items = lanes.items,
                                           .initially = lanes.initially}));
    }
    std::vector<Succession> only(std::uint32_t lane, std::vector<Succession> list) const {
        std::erase_if(list, [&](const Succession& s) { return s.lane != lane; });
        return list;
    }
    std::vector<std::uint32_t> lanes_of(std::uint32_t actor) const {
        std::vector<std::uint32_t> out;
        for (std::uint32_t l = 0; l < lanes.lanes.size(); ++l) {
            if (lanes.lanes[l].actor == actor) {
                out.push_back(l);
            }
        }
        return out;
    }
    void start(State& state, std::vector<Succession> list, const char* source) const {
        state.known = true;
        state.source = source;
        state.open = std::move(list);
    }
    void by_invariants(std::uint32_t actor, State& state) const {
        std::vector<Succession> all;
        for (const std::uint32_t l : lanes_of(actor)) {
            auto some = by_invariant(l);
            if (!some) {
                return;
            }
            all.insert(all.end(), some->begin(), some->end());
        }
        start(state, std::move(all), "invariants");
    }
    void by_graph(std::uint32_t actor, State& state, const proof::Graph& graph) {
        if (graphs_.graph != &graph) {
            graphs_.graph = &graph;
            graphs_.all = proof::successions({.graph = graph,
                                              .begins = lanes.begins,
                                              .items = lanes.items,
                                              .initially = lanes.initially});
        }
        std::vector<Succession> own;
        for (const Succession& s : graphs_.all) {
            if (lanes.lanes[s.lane].actor == actor) {
                own.push_back(s);
            }
        }
        if (!state.known) {
            start(state, std::move(own), "graph");
            return;
        }
        std::erase_if(state.open, [&](const Succession& s) {
            return !std::binary_search(own.begin(), own.end(), s);
        });
    }
    struct {
        const proof::Graph* graph = nullptr;
        std::vector<Succession> all;
    } graphs_;

    // ---- runs ----

    Running& run_of_luck(std::uint32_t number) {
        while (runs.size() <= number) {
            runs.push_back(std::make_unique<Running>(*this, runs.size()));
        }
        return *runs[number];
    }

    // Plays on until it has shown all that is open, or shows nothing new for long.
    void play_on(Running& r, const State& state) const {
        const std::uint64_t patience = 2 * net.transition_count() + 20;
        std::size_t missing = 0;
        for (const Succession& s : state.open) {
            missing += r.successions.count(s) == 0 ? 1 : 0;
        }
        while (missing > 0 && !out_of_time() && r.run.player().firings() < kMostFirings &&
               r.run.player().firings() < r.fruitful + patience && r.run.step()) {
            note(r, [&](const Succession& s) {
                missing -= std::binary_search(state.open.begin(), state.open.end(), s) ? 1 : 0;
            });
        }
    }
    template <class New>
    void note(Running& r, New&& is_new) const {
        for (; r.looked < r.run.seen().size(); ++r.looked) {
            const JoinRun::Seen& seen = r.run.seen()[r.looked];
            if (r.successions.insert(seen.succession).second) {
                r.fruitful = seen.firing;
                is_new(seen.succession);
            }
        }
    }

    // Measures what is open and has been seen; a bad one is given.
    std::optional<Bad> measure(Running& r, State& state) const {
        std::vector<Succession> left;
        std::optional<Bad> bad;
        std::map<Succession, const JoinRun::Seen*> first;
        std::vector<JoinRun::Seen> seen = r.run.seen();  // looking beyond adds to them
        for (const JoinRun::Seen& s : seen) {
            first.try_emplace(s.succession, &s);
        }
        for (const Succession& s : state.open) {
            if (bad) {
                left.push_back(s);
                continue;
            }
            const std::string k = key(s);
            if (book.entries.count(k) != 0) {  // by another transition
                ++state.joins;
                continue;
            }
            const auto at = first.find(s);
            if (at == first.end()) {
                left.push_back(s);
                continue;
            }
            r.run.look_beyond(at->second->at);
            const motion::JoinMeasures m = r.run.measure(*at->second, book.limits);
            ++state.joins;
            const motion::JoinFault fault = motion::fault_of(m, book.limits);
            if (fault.quantity != nullptr) {
                bad = Bad{s, at->second->at, fault, r.run.joint_of(s, fault)};
                left.push_back(s);
            } else {
                book.entries[k] = {m};
            }
        }
        state.open = std::move(left);
        return bad;
    }

    // The one run of the net, wholly measured: nothing is taken for granted then.
    // Gives  nothing if it is not the only one, or does not end.
    struct Whole {
        std::optional<Bad> bad;
        std::uint32_t joins = 0;
    };
    std::optional<Whole> only_run(std::uint32_t actor, Running& r) const {
        constexpr std::uint64_t kFew = 500;
        while (r.chooser.answers().empty() && r.run.player().firings() < kFew && !out_of_time() &&
               r.run.step()) {
        }
        note(r, [](const Succession&) {});
        if (!r.run.at_rest() || !r.chooser.answers().empty()) {
            return std::nullopt;
        }
        Whole out;
        SimTime last{-1};
        const std::vector<JoinRun::Seen> seen = r.run.seen();
        for (const JoinRun::Seen& s : seen) {
            if (lanes.lanes[s.succession.lane].actor != actor || s.at == last) {
                continue;
            }
            last = s.at;
            r.run.look_beyond(s.at);
            const motion::JoinFault fault =
                motion::fault_of(r.run.measure(s, book.limits), book.limits);
            ++out.joins;
            if (fault.quantity != nullptr) {
                out.bad = Bad{s.succession, s.at, fault, r.run.joint_of(s.succession, fault)};
                return out;
            }
        }
        return out;
    }
    // Nothing comes from outside.
    bool closed() const {
        const net::NetDraft& d = net.declarations();
        std::vector<std::uint8_t> set(d.data.size(), 0);
        for (std::uint32_t e = 0; e < d.events.size(); ++e) {
            const net::EventDraft& event = d.events[e];
            if (event.sets.valid()) {
                set[event.sets.value] = 1;
            }
            const bool matters = !net.tables().event_listeners.row(e).empty() ||
                                 event.sets.valid() || event.makes_ready.valid();
            if ((event.outside || event.crossing) && matters) {
                return false;
            }
        }
        for (std::uint32_t i = 0; i < d.data.size(); ++i) {
            if (d.data[i].sensor && set[i] == 0) {
                return false;
            }
        }
        return true;
    }

    // ---- witnesses ----

    // The same join in a run of the whole net, played twice.
    std::optional<Witness> witness_of(const Bad& bad, std::uint64_t number,
                                      const std::string& rule) const {
        const net::Net& whole = *theatre.net;
        const MovementLanes all = movement_lanes(whole, play);
        const std::string by(net.transition(net::TransitionIndex{bad.succession.by}).path);
        SeededChooser chooser(number);
        JoinRun run(whole, theatre, all, chooser, theatre.seed, {});
        std::size_t looked = 0;
        std::vector<std::int64_t> answers;
        while (!out_of_time() && run.player().firings() < kMostFirings && run.step()) {
            for (; looked < run.seen().size(); ++looked) {
                const JoinRun::Seen seen = run.seen()[looked];
                if (whole.transition(net::TransitionIndex{seen.succession.by}).path != by ||
                    all.lanes[seen.succession.lane].actor !=
                        lanes.lanes[bad.succession.lane].actor ||
                    seen.at < bad.at) {
                    continue;
                }
                Witness w;
                w.rule = rule;
                w.net_hash = whole.hash();
                w.seed = theatre.seed;
                w.choices = chooser.answers();
                w.steps = run.steps();
                w.violates_after = static_cast<std::uint32_t>(seen.firing);
                w.until = seen.at + SimTime{kTicksPerSecond / 2};
                return is_bad(w, all, seen.succession.lane) ? std::optional(std::move(w))
                                                            : std::nullopt;
            }
        }
        return std::nullopt;
    }
    // Plays the script: the same firings, and the join after the last one is bad.
    bool is_bad(const Witness& w, const MovementLanes& all, std::uint32_t lane) const {
        return fault_in(w, all, all.lanes[lane].actor).fault.quantity != nullptr;
    }
    Bad fault_in(const Witness& w, const MovementLanes& all, std::uint32_t actor) const {
        net::ScriptedChooser chooser(w.choices);
        JoinRun run(*theatre.net, theatre, all, chooser, w.seed, w.events);
        while (run.player().firings() < w.steps.size() && run.step()) {
        }
        if (run.steps() != w.steps || chooser.misfit()) {
            return {};
        }
        const std::vector<JoinRun::Seen> seen = run.seen();
        for (const JoinRun::Seen& s : seen) {
            if (s.firing == w.steps.size() && all.lanes[s.succession.lane].actor == actor) {
                run.look_beyond(s.at);
                const motion::JoinFault fault =
                    motion::fault_of(run.measure(s, book.limits), book.limits);
                return {s.succession, s.at, fault, run.joint_of(s.succession, fault)};
            }
        }
        return {};
    }

    bool refute(const Bad& bad, std::uint64_t number, Verdict& v) const {
        auto witness = witness_of(bad, number, v.rule);
        if (!witness) {
            v.reason =
                "a run of a part of the net has a bad join, but none of the whole net was "
                "found: " +
                words(bad.succession);
            return false;
        }
        refuted(bad, std::move(*witness), v);
        return true;
    }
    void refuted(const Bad& bad, Witness witness, Verdict& v) const {
        v.answer = Answer::kRefuted;
        v.method = "a run on the stage";
        v.reason = fault_words(bad);
        witness.says = v.reason;
        v.witness = std::move(witness);
        const std::uint32_t item = bad.succession.after;
        const auto& places = lanes.lanes[bad.succession.lane].places;
        if (item < places.size()) {
            const SourceSpan& where =
                play.actions[net.action(net::PlaceIndex{places[item]}).value].where;
            if (where.line > 0) {
                v.notes.push_back("its movement: " + where.file + ":" + std::to_string(where.line));
            }
        }
    }

    // ---- one by one ----

    Formula any_begin(std::uint32_t lane, const Succession& s, bool of_before,
                      const net::Net& in) const {
        Formula any = Formula::constant(false);
        bool first = true;
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            bool counts = false;
            for (const proof::Begin& b : lanes.begins.row(t)) {
                counts = counts || (b.lane == lane && (!of_before || b.item == s.before));
            }
            if (!counts || (!of_before && t == s.by)) {
                continue;
            }
            Formula fires = Formula::fires(index_in(in, t));
            any = first ? std::move(fires)
                        : Formula::binary(FormulaOp::kOr, std::move(any), std::move(fires));
            first = false;
        }
        return any;
    }
    net::TransitionIndex index_in(const net::Net& in, std::uint32_t t) const {
        return &in == &net ? net::TransitionIndex{t}
                           : in.find_transition(net.transition(net::TransitionIndex{t}).path);
    }
    // Is broken by the succession.
    net::Rule rule_of(const Succession& s, const net::Net& in, const std::string& path) const {
        net::Rule rule;
        rule.path = path;
        rule.kind = net::RuleKind::kUntil;
        rule.operands.push_back(any_begin(s.lane, s, true, in));
        rule.operands.push_back(Formula::fires(index_in(in, s.by)));
        rule.operands.push_back(any_begin(s.lane, s, false, in));
        return rule;
    }

    enum class Found : std::uint8_t { kNot, kImpossible, kGood, kBad };
    Found look_for(const Succession& s, std::uint32_t actor, const GraphView& view,
                   Verdict& v) const {
        constexpr std::uint64_t kMostEdges = 4'000'000;
        Atoms none;
        const Obligation inside = make_obligation(net, rule_of(s, net, v.rule), nullptr, none);
        const Finding finding = check_on_graph(net, inside, view, kMostEdges);
        if (finding.kind == Finding::Kind::kHolds) {
            return Found::kImpossible;
        }
        if (finding.kind != Finding::Kind::kSuspect) {
            return Found::kNot;
        }
        Atoms atoms;
        const net::Net& whole = *theatre.net;
        const Obligation obligation =
            make_obligation(whole, rule_of(s, whole, v.rule), nullptr, atoms);
        const AtomReader reader(whole, atoms.formulas());
        const Hunt hunt{.obligation = &obligation,
                        .reader = &reader,
                        .finding = &finding,
                        .transitions = part.transitions,
                        .events = part.events};
        PursueLimits limits;
        limits.seconds = std::max(0.0, std::min(until - now_s(), 0.5));
        limits.cancelled = cancelled;
        Caught caught = pursue(theatre, hunt, limits);
        if (!caught.witness) {
            return Found::kNot;
        }
        const MovementLanes all = movement_lanes(whole, play);
        Bad bad = fault_in(*caught.witness, all, actor);
        if (bad.fault.quantity == nullptr) {
            return Found::kGood;
        }
        bad.succession = s;
        refuted(bad, std::move(*caught.witness), v);
        return Found::kBad;
    }

    // ---- in all ----

    bool judge(std::uint32_t actor, const GraphView* view, const Limits& limits, Verdict& v) {
        until = now_s() + limits.seconds;
        cancelled = limits.cancelled;
        State& state = states[actor];
        const proof::Graph* graph = view != nullptr ? &view->timed->graph : nullptr;
        constexpr std::uint64_t kMostBytes = std::uint64_t{512} << 20;
        const bool complete =
            graph != nullptr && graph->over && graph->ended == proof::Ended::kDone &&
            proof::bytes_for_successions({.graph = *graph,
                                          .begins = lanes.begins,
                                          .items = lanes.items,
                                          .initially = lanes.initially}) <= kMostBytes;
        if (complete) {
            v.states = graph->size();
            v.edges = graph->edges.items.size();
            by_graph(actor, state, *graph);
        } else if (!state.known) {
            by_invariants(actor, state);
        }
        if (!state.known) {
            v.reason = "which movements follow each other is not known" +
                       std::string(graph == nullptr ? "" : ": not all states were looked at");
            return false;
        }
        if (complete && acyclic(*graph) && closed()) {
            if (const auto whole = only_run(actor, run_of_luck(0))) {
                if (whole->bad) {
                    return refute(*whole->bad, 0, v);
                }
                v.answer = Answer::kProved;
                v.method = "its only run";
                v.reason.clear();
                v.notes.push_back(std::to_string(whole->joins) + (whole->joins == 1
                                                                      ? " join on the stage"
                                                                      : " joins on the stage"));
                return true;
            }
        }
        // Figures that do the same have been measured.
        std::erase_if(state.open, [&](const Succession& s) {
            const bool known = book.entries.count(key(s)) != 0;
            state.joins += known ? 1 : 0;
            return known;
        });
        const std::uint32_t luck = complete ? kRuns : 1;
        for (std::uint32_t i = 0; i < luck && !state.open.empty() && !out_of_time(); ++i) {
            if (i > 0 && runs[0]->chooser.answers().empty()) {
                break;  // there is nothing to be lucky in
            }
            Running& run = run_of_luck(i);
            play_on(run, state);
            if (const auto bad = measure(run, state)) {
                return refute(*bad, i, v);
            }
        }
        if (complete) {
            for (std::size_t k = 0;
                 k < state.open.size() && !out_of_time() && state.pursued < kMostPursued;) {
                ++state.pursued;
                const Found found = look_for(state.open[k], actor, *view, v);
                if (found == Found::kBad) {
                    return true;
                }
                if (found == Found::kNot) {
                    ++k;
                    continue;
                }
                state.joins += found == Found::kGood ? 1 : 0;
                state.open.erase(state.open.begin() + static_cast<std::ptrdiff_t>(k));
            }
        }
        if (!state.open.empty() && out_of_time()) {
            v.reason = "the time for looking at joins was used up";
            return false;
        }
        if (!state.open.empty()) {
            v.reason = "no run was found that shows " + words(state.open.front()) +
                       (state.open.size() == 1
                            ? std::string()
                            : ", nor " + std::to_string(state.open.size() - 1) + " other such") +
                       "; how they join is not known";
            return false;
        }
        v.answer = Answer::kProved;
        v.method = complete ? "graph and runs" : "invariants and runs";
        v.reason.clear();
        v.notes.push_back(std::to_string(state.joins) +
                          (state.joins == 1 ? " succession, measured on the stage"
                                            : " successions, each measured on the stage"));
        v.assumptions.push_back(
            "movements join after any history as in the runs that were measured");
        return true;
    }
};

JoinRule::JoinRule(Part& part, const Theatre& theatre, JoinBook& book)
    : data_(std::make_unique<Data>(part, theatre, book)) {}
JoinRule::~JoinRule() = default;

bool JoinRule::judge(std::uint32_t actor, const GraphView* graph, const Limits& limits,
                     Verdict& verdict) {
    return data_->judge(actor, graph, limits, verdict);
}

}  // namespace puppetri::verdict
