// SPDX-License-Identifier: MIT
// The product of a graph and an automaton, searched for an accepted path while it is made.
#include "puppetri/proof/ltl.h"

#include <algorithm>
#include <deque>
#include <unordered_map>
#include <utility>

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// A state of the graph, one of the automaton, and whether the path has ended: then it stands here.
struct Node {
    std::uint32_t state = 0, automaton = 0;
    bool ended = false;
    bool operator==(const Node&) const = default;
};

// The order of discovery per node: 0 not seen, kNone left for good. A row of 4 bytes per state is
// made when its automaton state is first met.
class Orders {
 public:
    Orders(std::uint32_t states, std::uint32_t automaton)
        : states_(states), rows_(std::size_t{automaton} * 2) {}
    std::uint32_t& operator[](const Node& n) {
        auto& row = rows_[std::size_t{n.automaton} * 2 + (n.ended ? 1 : 0)];
        if (row.empty()) {
            row.assign(states_, 0);
            bytes_ += std::uint64_t{4} * states_;
        }
        return row[n.state];
    }
    std::uint64_t bytes() const { return bytes_; }

 private:
    std::uint32_t states_;
    std::vector<std::vector<std::uint32_t>> rows_;
    std::uint64_t bytes_ = 0;
};

class Search {
 public:
    // `certain`: atoms and edges count only where they are beyond doubt.
    Search(const Graph& graph, const Buechi& automaton, std::span<const std::uint32_t> atoms,
           bool certain)
        : graph_(graph),
          automaton_(automaton),
          atoms_(atoms),
          certain_(certain),
          all_(automaton.all_sets()),
          orders_(graph.size(), automaton.size()) {
        for (const Buechi::Edge& e : automaton.edges.items) {
            used_ |= e.positive | e.negative;
        }
        for (std::uint32_t q = 0; q < automaton.size(); ++q) {
            anything_.push_back(0);
            for (const Buechi::Edge& e : automaton.edges.row(q)) {
                if (e.target == q && e.positive == 0 && e.negative == 0 && e.accepts == all_) {
                    anything_.back() = 1;  // accepts whatever follows
                }
            }
        }
    }

    // Gives  whether there is an accepted path; kUnknown when the budget ended.
    Truth run(Meter& meter, Ended& ended);
    Lasso lasso();
    bool met_cut() const { return met_cut_; }
    std::uint64_t states() const { return next_; }
    std::uint64_t edges() const { return edges_; }

 private:
    struct Open {                    // a component that is not closed
        std::uint32_t first = 0;     // its oldest node's order
        std::uint64_t marks = 0;     // acceptance inside
        std::uint64_t entrance = 0;  // acceptance of the edge that leads into it
    };
    struct Frame {
        Node node;
        std::uint32_t row = 0;   // next edge of the automaton
        std::uint32_t edge = 0;  // next edge of the graph
    };

    // Atoms that can be relied on: to hold, not to hold.
    std::pair<std::uint64_t, std::uint64_t> letters(std::uint32_t s) const {
        std::uint64_t holds = 0, fails = 0;
        for (std::uint64_t left = used_; left != 0; left &= left - 1) {
            const auto i = static_cast<std::uint32_t>(__builtin_ctzll(left));
            const bool may = graph_.atoms.may_hold(s, atoms_[i]);
            const bool must = graph_.atoms.must_hold(s, atoms_[i]);
            holds |= std::uint64_t{certain_ ? must : may} << i;
            fails |= std::uint64_t{certain_ ? !may : !must} << i;
        }
        return {holds, fails};
    }
    // Calls visit(successor, marks, edge of the graph or kNone) until it gives false.
    template <class Visit>
    void successors(const Node& n, Visit&& visit) const;
    bool stands(std::uint32_t s) const { return may_end(graph_, s); }
    bool cut(std::uint32_t s) const {
        return !graph_.flags.empty() && (graph_.flags[s] & Graph::kCut) != 0;
    }
    std::uint64_t key(const Node& n) const {
        return (std::uint64_t{n.automaton} * 2 + (n.ended ? 1 : 0)) * graph_.size() + n.state;
    }
    void enter(const Node& n, std::uint64_t marks);
    void push(const Node& n);
    // A shortest way in the product from `from` (at least one edge) until visit says so.
    template <class Allowed, class Found>
    std::pair<Node, std::uint64_t> walk(const Node& from, Allowed&& allowed, Found&& found,
                                        Path& path) const;

    const Graph& graph_;
    const Buechi& automaton_;
    std::span<const std::uint32_t> atoms_;
    const bool certain_;
    const std::uint64_t all_;
    std::uint64_t used_ = 0;
    std::vector<std::uint8_t> anything_;
    Orders orders_;
    std::vector<Open> open_;
    std::vector<Frame> frames_;
    std::vector<Node> active_;
    std::uint32_t next_ = 0;
    std::uint64_t edges_ = 0;
    bool met_cut_ = false;
    std::optional<Node> free_;  // from here every path is accepted
};

void Search::push(const Node& n) {
    orders_[n] = ++next_;
    active_.push_back(n);
    frames_.push_back({n, automaton_.edges.starts[n.automaton], 0});
    met_cut_ = met_cut_ || cut(n.state);
}

void Search::enter(const Node& n, std::uint64_t marks) {
    open_.push_back({next_ + 1, 0, marks});
    push(n);
}

Truth Search::run(Meter& meter, Ended& ended) {
    std::uint64_t turns = 0;
    for (const std::uint32_t q : automaton_.initial) {
        const Node first{graph_.initial, q, false};
        if (orders_[first] != 0) {
            continue;
        }
        enter(first, 0);
        while (!frames_.empty()) {
            if ((++turns & 0xFFF) == 0) {
                ended = meter.look(next_, edges_, frames_.size(),
                                   orders_.bytes() + next_ * std::uint64_t{28});
                if (ended != Ended::kDone) {
                    return Truth::kUnknown;
                }
            }
            Frame& frame = frames_.back();
            const Node node = frame.node;
            // The next edge of the product: for each edge of the automaton that is open here, all
            // edges of the graph, then standing still where a path may end.
            const std::uint32_t degree =
                node.ended ? 0 : static_cast<std::uint32_t>(graph_.edges.row(node.state).size());
            const bool still = node.ended || stands(node.state);
            const std::uint32_t ways = degree + (still ? 1 : 0);
            const std::uint32_t last = automaton_.edges.starts[node.automaton + 1];
            if (frame.edge == 0) {
                const auto [holds, fails] = letters(node.state);
                while (frame.row < last) {
                    const Buechi::Edge& e = automaton_.edges.items[frame.row];
                    if ((e.positive & ~holds) == 0 && (e.negative & ~fails) == 0) {
                        break;
                    }
                    ++frame.row;
                }
            }
            if (frame.row < last && frame.edge < ways) {
                const Buechi::Edge& e = automaton_.edges.items[frame.row];
                const std::uint32_t i = frame.edge++;
                if (frame.edge == ways) {
                    frame.edge = 0;
                    ++frame.row;
                }
                ++edges_;
                const Node to =
                    i < degree
                        ? Node{graph_.edges.items[graph_.edges.starts[node.state] + i].target,
                               e.target, false}
                        : Node{node.state, e.target, true};
                const std::uint32_t order = orders_[to];
                if (order == 0) {
                    enter(to, e.accepts);
                    // What accepts anything needs no search, if a path goes on for certain.
                    if (anything_[e.target] != 0) {
                        free_ = to;
                        return Truth::kTrue;
                    }
                } else if (order != kNone) {
                    std::uint64_t marks = e.accepts;
                    while (open_.back().first > order) {
                        marks |= open_.back().marks | open_.back().entrance;
                        open_.pop_back();
                    }
                    open_.back().marks |= marks;
                    if (open_.back().marks == all_) {
                        return Truth::kTrue;
                    }
                }
                continue;
            }
            if (frame.row < last && ways == 0) {  // cut: nothing is known to follow
                frame.row = last;
            }
            frames_.pop_back();
            if (open_.back().first == orders_[node]) {
                open_.pop_back();
                Node n;
                do {
                    n = active_.back();
                    active_.pop_back();
                    orders_[n] = kNone;
                } while (n != node);
            }
        }
    }
    return Truth::kFalse;
}

template <class Visit>
void Search::successors(const Node& n, Visit&& visit) const {
    const auto [holds, fails] = letters(n.state);
    for (const Buechi::Edge& e : automaton_.edges.row(n.automaton)) {
        if ((e.positive & ~holds) != 0 || (e.negative & ~fails) != 0) {
            continue;
        }
        if (!n.ended) {
            for (std::uint32_t i = graph_.edges.starts[n.state];
                 i < graph_.edges.starts[n.state + 1]; ++i) {
                visit(Node{graph_.edges.items[i].target, e.target, false}, e.accepts, i);
            }
        }
        if (n.ended || stands(n.state)) {
            visit(Node{n.state, e.target, true}, e.accepts, kNone);
        }
    }
}

template <class Allowed, class Found>
std::pair<Node, std::uint64_t> Search::walk(const Node& from, Allowed&& allowed, Found&& found,
                                            Path& path) const {
    struct Came {
        Node before;
        std::uint32_t edge = kNone;
    };
    std::unordered_map<std::uint64_t, Came> came;
    std::deque<Node> queue = {from};
    std::optional<std::pair<Node, std::uint64_t>> goal;
    Path way;
    while (!queue.empty() && !goal.has_value()) {
        const Node n = queue.front();
        queue.pop_front();
        successors(n, [&](const Node& to, std::uint64_t marks, std::uint32_t edge) {
            if (goal.has_value() || !allowed(to)) {
                return;
            }
            if (found(to, marks)) {
                goal = {to, marks};
                way.push_back(edge);
                for (Node at = n; !(at == from);) {
                    const Came& c = came[key(at)];
                    way.push_back(c.edge);
                    at = c.before;
                }
            } else if (!(to == from) && came.emplace(key(to), Came{n, edge}).second) {
                queue.push_back(to);
            }
        });
    }
    std::reverse(way.begin(), way.end());
    for (const std::uint32_t edge : way) {
        if (edge != kNone) {
            path.push_back(edge);
        }
    }
    return goal.value_or(std::pair(from, std::uint64_t{0}));
}

Lasso Search::lasso() {
    Lasso result;
    // Shortest from an initial node to the component (or to where everything is accepted), through
    // nodes that were seen.
    const std::uint32_t first = free_.has_value() ? kNone : open_.back().first;
    const auto inside = [&](const Node& n) {
        const std::uint32_t order = orders_[n];
        return free_.has_value() ? n == *free_ : order != kNone && order >= first;
    };
    const auto seen = [&](const Node& n) { return orders_[n] != 0; };
    std::optional<Node> entry;
    for (const std::uint32_t q : automaton_.initial) {
        const Node start{graph_.initial, q, false};
        if (orders_[start] == 0) {
            continue;
        }
        if (inside(start)) {
            result.stem.clear();
            entry = start;
            break;
        }
        Path stem;
        const auto [node, marks] = walk(
            start, seen, [&](const Node& n, std::uint64_t) { return inside(n); }, stem);
        if (inside(node) && (!entry.has_value() || stem.size() < result.stem.size())) {
            entry = node;
            result.stem = std::move(stem);
        }
    }
    if (!entry.has_value() || entry->ended) {
        return result;
    }
    if (free_.has_value()) {
        std::optional<Lasso> rest =
            lasso_within(graph_, entry->state, StateBits(graph_.size(), true));
        if (rest.has_value()) {
            result.stem.insert(result.stem.end(), rest->stem.begin(), rest->stem.end());
            result.loop = std::move(rest->loop);
        }
        return result;
    }
    // Round and round until every acceptance set was met, then back.
    Node at = *entry;
    std::uint64_t missing = all_;
    while (missing != 0) {
        const auto [node, marks] = walk(
            at, inside, [&](const Node&, std::uint64_t m) { return (m & missing) != 0; },
            result.loop);
        missing &= ~marks;
        at = node;
        if (marks == 0) {
            break;  // cannot be: the component has them all
        }
    }
    if (!(at == *entry) || result.loop.empty()) {
        walk(
            at, inside, [&](const Node& n, std::uint64_t) { return n == *entry; }, result.loop);
    }
    return result;
}

}  // namespace

Emptiness check_emptiness(const Graph& graph, const Buechi& automaton,
                          std::span<const std::uint32_t> atoms, const Budget& budget,
                          bool with_lasso) {
    Emptiness result;
    if (automaton.initial.empty()) {
        result.empty = Truth::kTrue;
        return result;
    }
    if (graph.size() == 0) {
        return result;
    }
    Meter meter(budget, "LTL");
    const auto search = [&](bool certain) {
        Search s(graph, automaton, atoms, certain);
        const Truth found = s.run(meter, result.ended);
        if (found == Truth::kTrue && with_lasso) {
            result.lasso = s.lasso();
        }
        result.states += s.states();
        result.edges += s.edges();
        return std::pair(found, s.met_cut());
    };
    const auto [possible, cut] = search(false);
    if (possible == Truth::kUnknown) {
        return result;
    }
    if (possible == Truth::kFalse) {
        if (!cut) {
            result.empty = Truth::kTrue;
        } else {
            result.ended = graph.ended;
        }
        return result;
    }
    if (!graph.exact) {
        return result;
    }
    // What may be is only a path if nothing in it was in doubt.
    bool doubt = cut;
    for (const std::uint32_t atom : atoms) {
        for (std::uint32_t s = 0; s < graph.size() && !doubt; ++s) {
            doubt = graph.atoms.may_hold(s, atom) != graph.atoms.must_hold(s, atom);
        }
    }
    if (!doubt || search(true).first == Truth::kTrue) {
        result.empty = Truth::kFalse;
    }
    return result;
}

LtlAnswer check_ltl(const Graph& graph, const Temporal& formula,
                    std::span<const std::uint32_t> atoms, const Budget& budget, bool with_lasso) {
    LtlAnswer answer;
    const std::optional<Buechi> automaton = automaton_of(formula, true);
    if (!automaton.has_value()) {
        return answer;
    }
    Emptiness result = check_emptiness(graph, *automaton, atoms, budget, with_lasso);
    answer.holds = result.empty;
    answer.ended = result.ended;
    answer.counterexample = std::move(result.lasso);
    answer.states = result.states;
    answer.edges = result.edges;
    return answer;
}

}  // namespace puppetri::proof
