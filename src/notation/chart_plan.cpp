// SPDX-License-Identifier: MIT
#include "chart_plan.h"

#include <algorithm>

namespace puppetri::notation::chart {
namespace {

// Beyond this a chart is refused: regions that all leave one another by dozens of transitions, or
// histories of histories.
constexpr std::size_t kMaxDiagrams = 20'000, kMaxConflicts = 60'000, kMaxWork = 200'000;
constexpr double kMaxWritten = 20'000;

std::size_t z(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Plan::Plan(const Chart& chart) : chart_(chart) { prepare(); }

bool Plan::orthogonal(int a, int b) const {
    int x = a, y = b;
    while (x != y) {
        (x > y ? x : y) = at(x > y ? x : y).parent;
    }
    return x != a && x != b && at(x).kind == Kind::kParallel;
}

std::vector<int> Plan::stored(const State& h) const {
    Ids out;
    const int parent = h.parent;
    for (int s = 1; s < static_cast<int>(chart_.states.size()); ++s) {
        if (at(s).kind != Kind::kHistory &&
            (h.deep ? at(s).atomic() && chart_.descends(s, parent) : at(s).parent == parent)) {
            out.push_back(s);
        }
    }
    return out;
}

// Where the transition may lead, histories replaced by all that they may hold.
std::vector<int> Plan::effective(const Ids& targets) const {
    Ids out;
    for (const int t : targets) {
        if (at(t).kind == Kind::kHistory) {
            for (const Ids& list : {stored(at(t)), at(t).initial}) {
                out.insert(out.end(), list.begin(), list.end());
            }
        } else {
            out.push_back(t);
        }
    }
    return out;
}

int Plan::domain(const Move& m, const Ids& targets) const {
    const bool inside = std::all_of(targets.begin(), targets.end(),
                                    [&](int t) { return chart_.descends(t, m.source); });
    if (m.written != nullptr && m.written->internal && at(m.source).compound() && inside) {
        return m.source;
    }
    for (int s = at(m.source).parent; s > 0; s = at(s).parent) {
        if (at(s).compound() && std::all_of(targets.begin(), targets.end(),
                                            [&](int t) { return chart_.descends(t, s); })) {
            return s;
        }
    }
    return 0;
}

void Plan::prepare() {
    const int count = static_cast<int>(chart_.states.size());
    for (int s = 1; s < count; ++s) {
        if (at(s).atomic()) {
            atoms.push_back(s);
        }
    }
    Move first;
    first.domain = 0;
    first.targets = at(0).initial;
    moves.push_back(std::move(first));
    for (const Transition& t : chart_.transitions) {
        Move m;
        m.source = t.source;
        m.written = &t;
        m.targets = t.targets;
        m.steps = &t.steps;
        if (!t.targets.empty()) {
            m.domain = domain(m, effective(t.targets));
            // What it leaves must not depend on what a history holds.
            for (const int s : effective(t.targets)) {
                Ids some = {s};
                for (const int other : t.targets) {
                    if (at(other).kind != Kind::kHistory) {
                        some.push_back(other);
                    }
                }
                if (t.targets.size() == 1 && domain(m, some) != m.domain &&
                    (vague.empty() || !(vague.back() == t.span))) {
                    vague.push_back(t.span);
                }
            }
        }
        moves.push_back(std::move(m));
    }
    for (std::size_t a = 0; a < atoms.size(); ++a) {
        candidates.emplace_back();
        for (int s = atoms[a]; s > 0; s = at(s).parent) {
            for (const int t : at(s).transitions) {
                candidates.back().push_back(t + 1);
                moves[z(t) + 1].picked_by.push_back(a);
            }
        }
    }
    for (int t = 1; t < static_cast<int>(moves.size()); ++t) {
        for (int u = 1; u < static_cast<int>(moves.size()); ++u) {
            if (t != u && conflict(t, u)) {
                moves[z(t)].conflicts.push_back(u);
            }
        }
    }
    std::size_t conflicts = 0;
    for (Move& m : moves) {
        if (m.domain >= 0) {
            compute_entry(m);
        }
        conflicts += m.conflicts.size() * m.picked_by.size();
    }
    const std::vector<double> sizes = diagrams.sizes();
    double written = 0;
    for (const Move& m : moves) {
        for (const auto* list : {&m.entry.states, &m.entry.defaults, &m.entry.histories}) {
            for (const Diagrams::Id id : *list) {
                written += id <= 1 ? 0 : sizes[id];
            }
        }
    }
    too_large = too_large || conflicts > kMaxConflicts || written > kMaxWritten;
}

std::vector<bool> Plan::entered() const {
    std::vector<bool> out(chart_.states.size(), false);
    std::vector<bool> done(moves.size(), false);
    for (bool more = true; more;) {
        more = false;
        for (std::size_t m = 0; m < moves.size(); ++m) {
            const bool possible =
                m == 0 || std::any_of(moves[m].picked_by.begin(), moves[m].picked_by.end(),
                                      [&](std::size_t atom) { return out[z(atoms[atom])]; });
            if (done[m] || !possible) {
                continue;
            }
            done[m] = more = true;
            for (std::size_t s = 0; s < moves[m].entry.states.size(); ++s) {
                out[s] = out[s] || moves[m].entry.states[s] != 0;
            }
        }
    }
    return out;
}

// Both may be selected at once, and leave states in common.
bool Plan::conflict(int t, int u) const {
    const Move &a = moves[z(t)], &b = moves[z(u)];
    if (a.domain < 0 || b.domain < 0 ||
        (a.domain != b.domain && !chart_.descends(a.domain, b.domain) &&
         !chart_.descends(b.domain, a.domain))) {
        return false;
    }
    return orthogonal(a, b);
}

bool Plan::orthogonal(const Move& a, const Move& b) const {
    for (const std::size_t x : a.picked_by) {
        for (const std::size_t y : b.picked_by) {
            if (orthogonal(atoms[x], atoms[y])) {
                return true;
            }
        }
    }
    return false;
}

bool Plan::counted(int move) const {
    const Move& m = moves[z(move)];
    return !m.conflicts.empty() || orthogonal(m, m);
}

std::string Plan::was_name(int h, int s) const { return "was " + at(h).name + " " + at(s).name; }
std::string Plan::known_name(int h) const { return "known " + at(h).name; }

// computeEntrySet, carried out on formulas.
void Plan::compute_entry(Move& m) {
    Entry& e = m.entry;
    e.states.resize(chart_.states.size());
    e.defaults.resize(chart_.states.size());
    e.histories.resize(chart_.states.size());
    for (const int t : m.targets) {
        add_inside(e, t, 1);
    }
    for (const int t : m.targets) {
        if (at(t).kind != Kind::kHistory) {
            add_above(e, t, m.domain, 1);
            continue;
        }
        for (const int s : stored(at(t))) {
            add_above(e, s, m.domain, diagrams.both(known(t), was(t, s)));
        }
        for (const int s : at(t).initial) {
            add_above(e, s, m.domain, diagrams.opposite(known(t)));
        }
    }
}

void Plan::add_inside(Entry& e, int s, Diagrams::Id when) {
    if (when == 0 || diagrams.size() > kMaxDiagrams || ++work_ > kMaxWork) {
        too_large = too_large || when != 0;
        return;
    }
    const State& state = at(s);
    if (state.kind == Kind::kHistory) {
        const Ids list = stored(state);
        for (const int x : list) {
            add_inside(e, x, diagrams.both(when, diagrams.both(known(s), was(s, x))));
        }
        for (const int x : list) {
            add_above(e, x, state.parent, diagrams.both(when, diagrams.both(known(s), was(s, x))));
        }
        const Diagrams::Id first = diagrams.both(when, diagrams.opposite(known(s)));
        e.histories[z(s)] = diagrams.either(e.histories[z(s)], first);
        for (const int x : state.initial) {
            add_inside(e, x, first);
        }
        for (const int x : state.initial) {
            add_above(e, x, state.parent, first);
        }
        return;
    }
    e.states[z(s)] = diagrams.either(e.states[z(s)], when);
    if (state.compound()) {
        e.defaults[z(s)] = diagrams.either(e.defaults[z(s)], when);
        for (const int x : state.initial) {
            add_inside(e, x, when);
        }
        for (const int x : state.initial) {
            add_above(e, x, s, when);
        }
    } else if (state.kind == Kind::kParallel) {
        regions(e, s, when);
    }
}

void Plan::regions(Entry& e, int s, Diagrams::Id when) {
    for (const int child : at(s).children) {
        Diagrams::Id entered = 0;
        for (int d = child + 1;
             d < static_cast<int>(chart_.states.size()) && chart_.descends(d, child); ++d) {
            entered = diagrams.either(entered, e.states[z(d)]);
        }
        add_inside(e, child, diagrams.both(when, diagrams.opposite(entered)));
    }
}

void Plan::add_above(Entry& e, int s, int above, Diagrams::Id when) {
    if (when == 0) {
        return;
    }
    for (int a = at(s).parent; a > 0 && a != above; a = at(a).parent) {
        e.states[z(a)] = diagrams.either(e.states[z(a)], when);
        if (at(a).kind == Kind::kParallel) {
            regions(e, a, when);
        }
    }
}

Diagrams::Id Diagrams::variable(std::string name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    const auto number = static_cast<std::uint32_t>(found - names_.begin());
    if (found == names_.end()) {
        names_.push_back(std::move(name));
    }
    return make({number, 0, 1});
}

Diagrams::Id Diagrams::make(const Node& n) {
    if (n.low == n.high) {
        return n.low;
    }
    const auto [at, fresh] = known_.emplace(n, static_cast<Id>(nodes_.size()));
    if (fresh) {
        nodes_.push_back(n);
    }
    return at->second;
}

Diagrams::Id Diagrams::choose(Id a, Id b, Id c) {
    if (a <= 1 || b == c) {
        return a == 0 ? c : b;
    }
    if (const auto found = chosen_.find({a, b, c}); found != chosen_.end()) {
        return found->second;
    }
    const std::uint32_t top =
        std::min({nodes_[a].variable, nodes_[b].variable, nodes_[c].variable});
    const auto half = [&](Id x, bool high) {
        return nodes_[x].variable != top ? x : high ? nodes_[x].high : nodes_[x].low;
    };
    const Id low = choose(half(a, false), half(b, false), half(c, false));
    const Id high = choose(half(a, true), half(b, true), half(c, true));
    const Id out = make({top, low, high});
    chosen_.emplace(std::array<Id, 3>{a, b, c}, out);
    return out;
}

std::vector<double> Diagrams::sizes() const {
    std::vector<double> out(nodes_.size(), 1);
    for (std::size_t i = 2; i < nodes_.size(); ++i) {  // made behind what they are made of
        out[i] = 1 + out[nodes_[i].low] + out[nodes_[i].high];
    }
    return out;
}

Truth Diagrams::truth(Id a, lang::Span where) const {
    if (a <= 1) {
        return a == 1 ? yes() : Truth{};
    }
    const Node n = nodes_[a];
    const Truth is = open(make_reference(names_[n.variable], where));
    return chart::either(chart::both(is, truth(n.high, where)),
                         chart::both(chart::opposite(is), truth(n.low, where)));
}

}  // namespace puppetri::notation::chart
