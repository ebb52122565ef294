// SPDX-License-Identifier: MIT
// Symbolic state spaces of random small nets against brute force: every count, bound, set, path,
// CTL operator and automaton, marking by marking, by code that knows nothing of diagrams.
// PUPPETRI_LONG=1 takes twenty times as many nets.
#include <doctest/doctest.h>

#include <cstdlib>
#include <deque>

#include "proof/small_nets.h"
#include "puppetri/proof/symbolic.h"

namespace puppetri::proof {
namespace {

using test::Chance;
using Bits = std::vector<bool>;  // per marking of the explicit space

// Fixpoints by definition, on the graph of all markings.
class Explicit {
 public:
    Explicit(const PlainNet& net, const test::Space& space) : net_(net), space_(space) {}

    std::uint32_t size() const { return static_cast<std::uint32_t>(space_.markings.size()); }
    Bits set(bool value) const { return Bits(size(), value); }
    bool may_end(std::uint32_t s) const { return space_.dead(net_, s); }

    Bits ex(const Bits& a) const {
        Bits out = set(false);
        for (std::uint32_t s = 0; s < size(); ++s) {
            for (const auto& [t, to] : space_.edges[s]) {
                out[s] = out[s] || a[to];
            }
        }
        return out;
    }
    Bits eu(const Bits& hold, const Bits& until) const {
        Bits out = until;
        for (bool more = true; more;) {
            const Bits before = ex(out);
            more = false;
            for (std::uint32_t s = 0; s < size(); ++s) {
                if (!out[s] && hold[s] && before[s]) {
                    out[s] = more = true;
                }
            }
        }
        return out;
    }
    Bits eg(const Bits& a) const {
        Bits out = a;
        for (bool more = true; more;) {
            const Bits before = ex(out);
            more = false;
            for (std::uint32_t s = 0; s < size(); ++s) {
                if (out[s] && !may_end(s) && !before[s]) {
                    out[s] = false;
                    more = true;
                }
            }
        }
        return out;
    }
    // Markings that reach each other, by closures: small is enough.
    std::vector<Bits> closure(const std::vector<Bits>& steps) const {
        std::vector<Bits> reach = steps;
        for (std::uint32_t k = 0; k < reach.size(); ++k) {
            for (std::uint32_t i = 0; i < reach.size(); ++i) {
                for (std::uint32_t j = 0; reach[i][k] && j < reach.size(); ++j) {
                    reach[i][j] = reach[i][j] || reach[k][j];
                }
            }
        }
        return reach;
    }

 private:
    const PlainNet& net_;
    const test::Space& space_;
};

struct Both {  // a set in the two forms
    StateSet symbolic;
    Bits bits;
};

class Trial {
 public:
    Trial(Chance& chance, const PlainNet& net, const test::Space& space)
        : chance_(chance), net_(net), markings_(space), graph_(net, space), symbolic_(net, {}) {}

    void run() {
        REQUIRE(symbolic_.ended() == Ended::kDone);
        facts();
        for (int i = 0; i < 6; ++i) {
            const Both a = formula(4), b = formula(3);
            same(a);
            path(a, b);
            fair(a, b, formula(1));
        }
        for (int i = 0; i < 3; ++i) {
            automaton();
        }
    }

 private:
    void facts() {
        const auto facts = symbolic_.facts();
        REQUIRE(facts.has_value());
        std::uint64_t edges = 0, together = 0;
        std::uint32_t most = 0;
        bool dead = false;
        std::vector<std::uint32_t> per_place(net_.place_count(), 0);
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            const Marking& m = markings_.markings[s];
            edges += markings_.edges[s].size();
            dead = dead || markings_.edges[s].empty();
            std::uint64_t sum = 0;
            for (std::uint32_t p = 0; p < m.size(); ++p) {
                per_place[p] = std::max(per_place[p], m[p]);
                most = std::max(most, m[p]);
                sum += m[p];
            }
            together = std::max(together, sum);
            CHECK(symbolic_.contains(symbolic_.all(), m) == true);
        }
        CHECK(facts->states == Natural(graph_.size()));
        CHECK(facts->edges == Natural(edges));
        CHECK(facts->max_in_place == most);
        CHECK(facts->max_in_marking == together);
        CHECK(facts->dead_reachable == dead);
        CHECK(symbolic_.max_tokens(symbolic_.all()) == per_place);
        Bits ends = graph_.set(false), bottom = graph_.set(true), first = graph_.set(false);
        first[0] = true;
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            ends[s] = graph_.may_end(s);
        }
        same({symbolic_.stuck(), ends});
        same({symbolic_.initial(), first});
        CHECK(symbolic_.reversible() == (graph_.eu(bottom, first) == bottom));
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            Bits on = graph_.set(false);
            for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                on[s] = net_.enabled(markings_.markings[s], t);
            }
            CHECK(symbolic_.live(t) == (graph_.eu(bottom, on) == bottom));
            CHECK(symbolic_.quasi_live(t) == (on != graph_.set(false)));
        }
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            bool stable = true;
            for (const Marking& m : markings_.markings) {
                stable = stable && m[p] == net_.initial[p];
            }
            CHECK(symbolic_.stable(p) == stable);
        }
    }

    void same(const Both& a) {
        REQUIRE(a.symbolic.known());
        std::uint64_t count = 0;
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            count += a.bits[s] ? 1 : 0;
            REQUIRE(symbolic_.contains(a.symbolic, markings_.markings[s]) == a.bits[s]);
        }
        CHECK(symbolic_.count(a.symbolic) == Natural(count));
        const auto member = symbolic_.some_marking(a.symbolic);
        CHECK(member.has_value() == (count > 0));
        CHECK((!member.has_value() || a.bits[markings_.number.at(*member)]));
        LinearSum sum = random_sum();
        std::optional<std::int64_t> least, most;
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            if (a.bits[s]) {
                std::int64_t value = 0;
                for (const LinearSum::Term& term : sum.terms) {
                    value += term.factor * std::int64_t{markings_.markings[s][term.place]};
                }
                least = std::min(least.value_or(value), value);
                most = std::max(most.value_or(value), value);
            }
        }
        CHECK(symbolic_.min_of(sum, a.symbolic) == least);
        CHECK(symbolic_.max_of(sum, a.symbolic) == most);
    }

    LinearSum random_sum() {
        LinearSum sum;
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            const auto factor = static_cast<std::int64_t>(chance_.below(7)) - 3;
            if (factor != 0 && chance_.one_in(2)) {
                sum.terms.push_back({p, factor});
            }
        }
        return sum;
    }

    Both atom() {
        Predicate predicate;
        switch (chance_.below(5)) {
            case 0:
                predicate = Predicate::constant(chance_.one_in(2));
                break;
            case 1:
                predicate = Predicate::at_most(random_sum(),
                                               static_cast<std::int64_t>(chance_.below(9)) - 3);
                break;
            case 2:
                predicate = Predicate::at_least(random_sum(),
                                                static_cast<std::int64_t>(chance_.below(9)) - 3);
                break;
            case 3: {
                std::vector<std::uint32_t> transitions;
                for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
                    if (chance_.one_in(3)) {
                        transitions.push_back(t);
                    }
                }
                predicate = Predicate::enabled(transitions);
                break;
            }
            default:
                predicate = Predicate::no_successor(net_);
        }
        if (chance_.one_in(2)) {
            const Predicate parts[] = {
                predicate, Predicate::at_least({.terms = {{chance_.below(net_.place_count()), 1}}},
                                               chance_.below(3))};
            predicate = chance_.one_in(2) ? Predicate::all_of(parts) : Predicate::any_of(parts);
        }
        if (chance_.one_in(3)) {
            predicate = predicate.negated();
        }
        Bits bits = graph_.set(false);
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            bits[s] = predicate.holds(net_, markings_.markings[s]);
        }
        return {symbolic_.satisfying(predicate), bits};
    }

    Both formula(std::uint32_t depth) {
        if (depth == 0) {
            return atom();
        }
        const Both a = formula(depth - 1);
        const Bits all = graph_.set(true);
        const auto flip = [&](Bits bits) {
            bits.flip();
            return bits;
        };
        switch (chance_.below(12)) {
            case 0:
                return {symbolic_.complement(a.symbolic), flip(a.bits)};
            case 1:
                return {symbolic_.ex(a.symbolic), graph_.ex(a.bits)};
            case 2:
                return {symbolic_.eg(a.symbolic), graph_.eg(a.bits)};
            case 3:
                return {symbolic_.ef(a.symbolic), graph_.eu(all, a.bits)};
            case 4:
                return {symbolic_.ax(a.symbolic), flip(graph_.ex(flip(a.bits)))};
            case 5:
                return {symbolic_.af(a.symbolic), flip(graph_.eg(flip(a.bits)))};
            case 6:
                return {symbolic_.ag(a.symbolic), flip(graph_.eu(all, flip(a.bits)))};
            case 7:
                return a;
            default:
                break;
        }
        const Both b = formula(depth - 1);
        Bits bits = a.bits;
        switch (chance_.below(5)) {
            case 0:
                return {symbolic_.eu(a.symbolic, b.symbolic), graph_.eu(a.bits, b.bits)};
            case 1: {
                // Not some path on which b fails until neither holds, or for ever.
                Bits neither = flip(b.bits);
                for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                    neither[s] = neither[s] && !a.bits[s];
                }
                bits = graph_.eg(flip(b.bits));
                const Bits violated = graph_.eu(flip(b.bits), neither);
                for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                    bits[s] = !bits[s] && !violated[s];
                }
                return {symbolic_.au(a.symbolic, b.symbolic), bits};
            }
            case 2:
                for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                    bits[s] = bits[s] && b.bits[s];
                }
                return {symbolic_.both(a.symbolic, b.symbolic), bits};
            case 3:
                for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                    bits[s] = bits[s] || b.bits[s];
                }
                return {symbolic_.either(a.symbolic, b.symbolic), bits};
            default:
                for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                    bits[s] = bits[s] && !b.bits[s];
                }
                return {symbolic_.without(a.symbolic, b.symbolic), bits};
        }
    }

    void path(const Both& to, const Both& within) {
        const std::uint32_t from = chance_.below(graph_.size());
        // Breadth first: the marking and its distance.
        std::vector<std::int64_t> distance(graph_.size(), -1);
        std::deque<std::uint32_t> queue{from};
        distance[from] = 0;
        std::optional<std::int64_t> nearest;
        while (!queue.empty() && !nearest.has_value()) {
            const std::uint32_t s = queue.front();
            queue.pop_front();
            if (to.bits[s]) {
                nearest = distance[s];
            }
            for (const auto& [t, next] : markings_.edges[s]) {
                if (distance[next] < 0 && (within.bits[next] || to.bits[next])) {
                    distance[next] = distance[s] + 1;
                    queue.push_back(next);
                }
            }
        }
        const auto found = symbolic_.path(markings_.markings[from], to.symbolic, within.symbolic);
        REQUIRE(found.has_value() == nearest.has_value());
        if (found.has_value()) {
            CHECK(static_cast<std::int64_t>(found->size()) == *nearest);
            Marking m = markings_.markings[from];
            for (std::size_t i = 0; i < found->size(); ++i) {
                REQUIRE(net_.enabled(m, (*found)[i]));
                net_.fire(m, (*found)[i]);
                const std::uint32_t s = markings_.number.at(m);
                CHECK((i + 1 == found->size() ? to.bits[s] : within.bits[s]));
            }
        }
        Bits start = graph_.set(false), reached = graph_.set(false);
        start[from] = true;
        reached[from] = true;
        for (bool more = true; more;) {
            more = false;
            for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                for (const auto& [t, next] : markings_.edges[s]) {
                    if (reached[s] && within.bits[next] && !reached[next]) {
                        reached[next] = more = true;
                    }
                }
            }
        }
        const Both one{symbolic_.satisfying(exactly(markings_.markings[from])), start};
        same(one);
        same({symbolic_.reached(one.symbolic, within.symbolic), reached});
    }

    static Predicate exactly(const Marking& m) {
        std::vector<Predicate> parts;
        for (std::uint32_t p = 0; p < m.size(); ++p) {
            parts.push_back(Predicate::at_least({.terms = {{p, 1}}}, m[p]));
            parts.push_back(Predicate::at_most({.terms = {{p, 1}}}, m[p]));
        }
        return Predicate::all_of(parts);
    }

    // Per vertex: where to, and with which marks.
    using Moves = std::vector<std::vector<std::pair<std::uint32_t, std::uint64_t>>>;

    // From which vertices some infinite path takes marks of all kinds again and again.
    Bits recurring(const Moves& moves, std::uint32_t kinds) const {
        const auto size = static_cast<std::uint32_t>(moves.size());
        std::vector<Bits> steps(size, Bits(size, false));
        for (std::uint32_t v = 0; v < size; ++v) {
            for (const auto& [to, marks] : moves[v]) {
                steps[v][to] = true;
            }
        }
        const std::vector<Bits> reach = graph_.closure(steps);
        Bits out(size, false);
        for (std::uint32_t v = 0; v < size; ++v) {
            if (!reach[v][v]) {
                continue;
            }
            std::uint64_t met = 0;
            for (std::uint32_t u = 0; u < size; ++u) {
                for (const auto& [to, marks] : moves[u]) {
                    if ((u == v || reach[v][u]) && (to == v || reach[to][v])) {
                        met |= marks;
                    }
                }
            }
            if (met != (std::uint64_t{1} << kinds) - 1) {
                continue;
            }
            for (std::uint32_t u = 0; u < size; ++u) {
                out[u] = out[u] || u == v || reach[u][v];
            }
        }
        return out;
    }

    void fair(const Both& a, const Both& f, const Both& g) {
        if (graph_.size() > 60) {
            return;
        }
        Moves moves(graph_.size());
        Bits ends = graph_.set(false);
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            const std::uint64_t marks = (f.bits[s] ? 1u : 0u) | (g.bits[s] ? 2u : 0u);
            for (const auto& [t, to] : markings_.edges[s]) {
                if (a.bits[s] && a.bits[to]) {
                    moves[s].push_back({to, marks});
                }
            }
            ends[s] = a.bits[s] && graph_.may_end(s) && marks == 3;
        }
        Bits wanted = recurring(moves, 2);
        ends = graph_.eu(a.bits, ends);
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            wanted[s] = wanted[s] || ends[s];
        }
        const StateSet sets[] = {f.symbolic, g.symbolic};
        same({symbolic_.fair_eg(a.symbolic, sets), wanted});
    }

    void automaton() {
        SymbolicAutomaton automaton;
        automaton.states = 1 + chance_.below(3);
        automaton.acceptance_sets = chance_.below(3);
        automaton.initial = {0};
        const std::uint32_t n = automaton.states;
        if (graph_.size() * n > 120) {
            return;
        }
        Moves fires(graph_.size() * n), stands(graph_.size() * n);
        for (std::uint32_t e = 1 + chance_.below(2 * n + 1); e > 0; --e) {
            const Both guard = formula(1);
            const std::uint32_t from = chance_.below(n), to = chance_.below(n);
            const std::uint64_t accepts = chance_.below(1u << automaton.acceptance_sets);
            automaton.edges.push_back({from, to, guard.symbolic, accepts});
            for (std::uint32_t s = 0; s < graph_.size(); ++s) {
                if (!guard.bits[s]) {
                    continue;
                }
                for (const auto& [t, next] : markings_.edges[s]) {
                    fires[s * n + from].push_back({next * n + to, accepts});
                }
                if (graph_.may_end(s)) {
                    stands[s * n + from].push_back({s * n + to, accepts});
                }
            }
        }
        const std::uint32_t kinds = automaton.acceptance_sets;
        const Bits standing = recurring(stands, kinds);
        std::vector<bool> seen(fires.size(), false);
        std::vector<std::uint32_t> waiting{0};
        bool wanted = recurring(fires, kinds)[0];
        seen[0] = true;
        while (!waiting.empty()) {
            const std::uint32_t v = waiting.back();
            waiting.pop_back();
            wanted = wanted || standing[v];
            for (const auto& [to, marks] : fires[v]) {
                if (!seen[to]) {
                    seen[to] = true;
                    waiting.push_back(to);
                }
            }
        }
        CHECK(symbolic_.accepts(automaton) == wanted);
        const auto lasso = symbolic_.lasso(automaton);
        CHECK(lasso.has_value() == wanted);
        if (lasso.has_value()) {
            replay(*lasso, fires, stands, n, kinds);
        }
    }

    // The word of the lasso alone, as a graph of its positions times the automaton's states.
    void replay(const SymbolicLasso& lasso, const Moves& fires, const Moves& stands,
                std::uint32_t n, std::uint32_t kinds) {
        std::vector<std::uint32_t> word{0};
        Marking m = net_.initial;
        const auto walk = [&](const std::vector<std::uint32_t>& firings) {
            for (const std::uint32_t t : firings) {
                REQUIRE(net_.enabled(m, t));
                net_.fire(m, t);
                word.push_back(markings_.number.at(m));
            }
        };
        walk(lasso.stem);
        const auto back = static_cast<std::uint32_t>(word.size()) - 1;
        walk(lasso.loop);
        CHECK(word.back() == word[back]);
        if (lasso.loop.empty()) {
            CHECK(graph_.may_end(word[back]));
        } else {
            word.pop_back();
        }
        const auto length = static_cast<std::uint32_t>(word.size());
        Moves kept(length * n);
        for (std::uint32_t i = 0; i < length; ++i) {
            const bool last = i + 1 == length;
            const std::uint32_t after = last ? back : i + 1;
            for (std::uint32_t q = 0; q < n; ++q) {
                const Moves& moves = last && lasso.loop.empty() ? stands : fires;
                for (const auto& [to, marks] : moves[word[i] * n + q]) {
                    if (to / n == word[after]) {
                        kept[i * n + q].push_back({after * n + to % n, marks});
                    }
                }
            }
        }
        CHECK(recurring(kept, kinds)[0]);
    }

    Chance& chance_;
    const PlainNet& net_;
    const test::Space& markings_;
    Explicit graph_;
    SymbolicSpace symbolic_;
};

TEST_CASE("sets, CTL, paths and automata agree with brute force on random nets [agree]") {
    const std::uint32_t nets = std::getenv("PUPPETRI_LONG") != nullptr ? 8000 : 400;
    Chance chance(20260722);
    std::uint32_t tried = 0, sizes = 0;
    for (std::uint32_t i = 0; tried < nets; ++i) {
        test::SmallNetShape shape;
        shape.places = 7;
        shape.transitions = 8;
        shape.tokens = 3;
        shape.weights = chance.one_in(2);
        shape.reads = chance.one_in(2);
        shape.inhibitors = chance.one_in(2);
        shape.optional = chance.one_in(2);
        shape.conservative = !chance.one_in(4);
        const PlainNet net = test::small_net(chance, shape);
        const test::Space space = test::whole_space(net, 250);
        if (!space.complete || (space.markings.size() < 12 && !chance.one_in(20))) {
            continue;
        }
        CAPTURE(i);
        ++tried;
        sizes += static_cast<std::uint32_t>(space.markings.size());
        Trial(chance, net, space).run();
    }
    CHECK(sizes / tried > 10);
}

}  // namespace
}  // namespace puppetri::proof
