// SPDX-License-Identifier: MIT
// From linear time to automata: negation normal form, very weak alternating automaton (its states
// are subformulas), generalized Büchi automaton (its states are sets of them).
#include "puppetri/proof/buechi.h"

#include <algorithm>
#include <map>
#include <utility>

#include "buechi_cleanup.h"

namespace puppetri::proof {

namespace {

using Op = Temporal::Op;

// Sets of elementary formulas, a bit each.
using Set = std::uint64_t;

constexpr std::uint32_t kMaxElements = 64;
constexpr std::size_t kMaxEdgesOfState = 1024;
constexpr std::uint64_t kWorkPerState = 5000;  // pairs of steps looked at, per state allowed

struct Step {  // of the alternating automaton: when the literals hold, go on with all of `next`
    std::uint64_t positive = 0, negative = 0;
    Set next = 0;
    bool operator==(const Step&) const = default;
    auto operator<=>(const Step&) const = default;
    bool possible() const { return (positive & negative) == 0; }
    // Asks for no more, and leaves no more to do.
    bool dominates(const Step& other) const {
        return (positive & ~other.positive) == 0 && (negative & ~other.negative) == 0 &&
               (next & ~other.next) == 0;
    }
};
using Steps = std::vector<Step>;

// Keeps the steps that no other dominates.
// Gives  the pairs looked at.
std::uint64_t minimize(Steps& steps) {
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    Steps kept;
    for (const Step& s : steps) {
        const bool dominated = std::any_of(steps.begin(), steps.end(), [&](const Step& other) {
            return other != s && other.dominates(s);
        });
        if (!dominated) {
            kept.push_back(s);
        }
    }
    const std::uint64_t pairs = std::uint64_t{steps.size()} * steps.size();
    steps = std::move(kept);
    return pairs;
}

class Translator {
 public:
    Translator(const Temporal& formula, bool negated) : formula_(formula) {
        add(Op::kFalse, 0, 0, 0, false);
        add(Op::kTrue, 0, 0, 0, false);
        root_ = normal_form(negated);
    }

    std::optional<Buechi> run(std::uint32_t max_states) {
        max_work_ = max_states * kWorkPerState;
        if (formula_.atoms.size() > 64 || !make_steps()) {
            return std::nullopt;
        }
        Buechi result;
        for (const Step& s : covers_[root_]) {
            if (!numbers_.emplace(s.next, static_cast<std::uint32_t>(sets_.size())).second) {
                continue;
            }
            result.initial.push_back(static_cast<std::uint32_t>(sets_.size()));
            sets_.push_back(s.next);
        }
        result.acceptance_sets = static_cast<std::uint32_t>(untils_.size());
        for (std::uint32_t i = 0; i < sets_.size(); ++i) {
            if (sets_.size() > max_states || failed_) {
                return std::nullopt;
            }
            edges_of(sets_[i], result);
        }
        clean_up(result);
        return failed_ ? std::nullopt : std::optional(std::move(result));
    }

 private:
    static constexpr std::uint32_t kFalse = 0, kTrue = 1;
    struct Node {
        Op op = Op::kTrue;  // kFalse kTrue kAtom kAnd kOr kNext kUntil kRelease
        std::uint32_t a = 0, b = 0, atom = 0;
        bool negative = false;  // of atoms
        bool operator==(const Node&) const = default;
    };

    std::uint32_t add(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t atom, bool negative) {
        const Node node{op, a, b, atom, negative};
        const auto found = std::find(nodes_.begin(), nodes_.end(), node);
        if (found != nodes_.end()) {
            return static_cast<std::uint32_t>(found - nodes_.begin());
        }
        nodes_.push_back(node);
        return static_cast<std::uint32_t>(nodes_.size()) - 1;
    }
    std::uint32_t both(std::uint32_t a, std::uint32_t b) {
        if (a == kFalse || b == kFalse) {
            return kFalse;
        }
        return a == kTrue || a == b ? b : b == kTrue ? a : add(Op::kAnd, a, b, 0, false);
    }
    std::uint32_t either(std::uint32_t a, std::uint32_t b) {
        if (a == kTrue || b == kTrue) {
            return kTrue;
        }
        return a == kFalse || a == b ? b : b == kFalse ? a : add(Op::kOr, a, b, 0, false);
    }
    std::uint32_t next(std::uint32_t a) { return a <= kTrue ? a : add(Op::kNext, a, 0, 0, false); }
    bool is_finally(std::uint32_t n) const {
        return nodes_[n].op == Op::kUntil && nodes_[n].a == kTrue;
    }
    bool is_globally(std::uint32_t n) const {
        return nodes_[n].op == Op::kRelease && nodes_[n].a == kFalse;
    }
    // Laws that make sets of subformulas smaller: F(a or b) = F a or F b, F F a = F a,
    // F X a = X F a, F G F a = G F a, a U F b = F b; and their duals.
    std::uint32_t until(std::uint32_t a, std::uint32_t b) {
        if (b <= kTrue || a == kFalse || a == b || is_finally(b) ||
            (is_globally(b) && is_finally(nodes_[b].b))) {
            return b;
        }
        const Node node = nodes_[b];
        if (a == kTrue && node.op == Op::kOr) {
            const std::uint32_t left = until(kTrue, node.a);
            return either(left, until(kTrue, node.b));
        }
        if (a == kTrue && node.op == Op::kNext) {
            return next(until(kTrue, node.a));
        }
        return add(Op::kUntil, a, b, 0, false);
    }
    std::uint32_t release(std::uint32_t a, std::uint32_t b) {
        if (b <= kTrue || a == kTrue || a == b || is_globally(b) ||
            (is_finally(b) && is_globally(nodes_[b].b))) {
            return b;
        }
        const Node node = nodes_[b];
        if (a == kFalse && node.op == Op::kAnd) {
            const std::uint32_t left = release(kFalse, node.a);
            return both(left, release(kFalse, node.b));
        }
        if (a == kFalse && node.op == Op::kNext) {
            return next(release(kFalse, node.a));
        }
        return add(Op::kRelease, a, b, 0, false);
    }

    // Both polarities of every node, from the inside out.
    std::uint32_t normal_form(bool negated) {
        std::vector<std::uint32_t> plus, minus;
        for (const Temporal::Node& n : formula_.nodes) {
            std::uint32_t p = kTrue, m = kFalse;
            switch (n.op) {
                case Op::kFalse:
                    std::swap(p, m);
                    break;
                case Op::kTrue:
                    break;
                case Op::kAtom:
                    p = add(Op::kAtom, 0, 0, n.index, false);
                    m = add(Op::kAtom, 0, 0, n.index, true);
                    break;
                case Op::kNot:
                    p = minus[n.a];
                    m = plus[n.a];
                    break;
                case Op::kAnd:
                    p = both(plus[n.a], plus[n.b]);
                    m = either(minus[n.a], minus[n.b]);
                    break;
                case Op::kOr:
                    p = either(plus[n.a], plus[n.b]);
                    m = both(minus[n.a], minus[n.b]);
                    break;
                case Op::kNext:
                    p = next(plus[n.a]);
                    m = next(minus[n.a]);
                    break;
                case Op::kUntil:
                    p = until(plus[n.a], plus[n.b]);
                    m = release(minus[n.a], minus[n.b]);
                    break;
                case Op::kRelease:
                    p = release(plus[n.a], plus[n.b]);
                    m = until(minus[n.a], minus[n.b]);
                    break;
                case Op::kSomeNext:
                case Op::kSomeGlobally:
                case Op::kSomeUntil:
                    failed_ = true;  // not linear time
                    break;
            }
            plus.push_back(p);
            minus.push_back(m);
        }
        return negated ? minus.back() : plus.back();
    }

    // All pairs. Steps of the alternating automaton may be minimized at once; those of sets only
    // when it is known what they accept.
    Steps joined(const Steps& a, const Steps& b, bool minimized = true) {
        Steps result;
        work_ += std::uint64_t{a.size()} * b.size();
        failed_ = failed_ || work_ > max_work_;
        if (failed_) {
            return {};
        }
        for (const Step& x : a) {
            for (const Step& y : b) {
                const Step s{x.positive | y.positive, x.negative | y.negative, x.next | y.next};
                if (s.possible()) {
                    result.push_back(s);
                }
            }
            if (result.size() > kMaxEdgesOfState) {
                tidy(result, minimized);
                if (result.size() > kMaxEdgesOfState) {
                    failed_ = true;
                    return {};
                }
            }
        }
        tidy(result, minimized);
        return result;
    }
    void tidy(Steps& steps, bool minimized) {
        if (minimized) {
            work_ += minimize(steps);
        } else {
            std::sort(steps.begin(), steps.end());
            steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
        }
    }
    Steps united(Steps a, const Steps& b) {
        a.insert(a.end(), b.begin(), b.end());
        work_ += minimize(a);
        return a;
    }

    // steps_[n]: what reading one letter asks for so that n holds. covers_[n]: the ways to write n
    // as a disjunction of conjunctions of elementary formulas (literals, next, until, release).
    bool make_steps() {
        // Only what the root needs: rewriting leaves nodes behind.
        std::vector<std::uint8_t> needed(nodes_.size(), 0);
        needed[root_] = 1;
        for (std::size_t i = nodes_.size(); i-- > 2;) {
            if (needed[i] != 0 && nodes_[i].op != Op::kAtom) {
                needed[nodes_[i].a] = 1;
                needed[nodes_[i].b] = 1;
            }
        }
        elements_.assign(nodes_.size(), 0);
        steps_.resize(nodes_.size());
        covers_.resize(nodes_.size());
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < nodes_.size() && !failed_; ++i) {
            const Node& n = nodes_[i];
            if (i > kTrue && needed[i] == 0) {
                continue;
            }
            Set mine = 0;
            const bool elementary = n.op == Op::kAtom || n.op == Op::kNext || n.op == Op::kUntil ||
                                    n.op == Op::kRelease;
            if (elementary) {
                if (count == kMaxElements) {
                    return false;
                }
                mine = Set{1} << count++;
                element_nodes_.push_back(i);
                elements_[i] = mine;
                covers_[i] = {{0, 0, mine}};
            }
            switch (n.op) {
                case Op::kFalse:
                    break;
                case Op::kTrue:
                    steps_[i] = covers_[i] = {{0, 0, 0}};
                    break;
                case Op::kAtom: {
                    const std::uint64_t bit = std::uint64_t{1} << n.atom;
                    steps_[i] = {{n.negative ? 0 : bit, n.negative ? bit : 0, 0}};
                    break;
                }
                case Op::kAnd:
                    steps_[i] = joined(steps_[n.a], steps_[n.b]);
                    covers_[i] = joined(covers_[n.a], covers_[n.b]);
                    break;
                case Op::kOr:
                    steps_[i] = united(steps_[n.a], steps_[n.b]);
                    covers_[i] = united(covers_[n.a], covers_[n.b]);
                    break;
                case Op::kNext:
                    steps_[i] = covers_[n.a];
                    break;
                case Op::kUntil:
                    steps_[i] = united(joined(steps_[n.a], {{0, 0, mine}}), steps_[n.b]);
                    untils_.push_back(i);
                    break;
                default:  // release
                    steps_[i] = joined(steps_[n.b], united(steps_[n.a], {{0, 0, mine}}));
                    break;
            }
        }
        return !failed_;
    }

    // The until is fulfilled, or not asked for: see Gastin and Oddoux, theorem 2.
    bool accepts(std::uint32_t until, const Step& step) const {
        const Set mine = elements_[until];
        return (step.next & mine) == 0 ||
               std::any_of(steps_[until].begin(), steps_[until].end(), [&](const Step& s) {
                   return (s.next & mine) == 0 && s.dominates(step);
               });
    }

    void edges_of(Set set, Buechi& result) {
        Steps steps = {{0, 0, 0}};
        for (std::uint32_t e = 0; e < element_nodes_.size() && !failed_; ++e) {
            if ((set >> e & 1) != 0) {
                steps = joined(steps, steps_[element_nodes_[e]], false);
            }
        }
        std::vector<std::uint64_t> accepting(steps.size(), 0);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            for (std::size_t u = 0; u < untils_.size(); ++u) {
                accepting[i] |= accepts(untils_[u], steps[i]) ? std::uint64_t{1} << u : 0;
            }
        }
        work_ += std::uint64_t{steps.size()} * steps.size();
        for (std::size_t i = 0; i < steps.size(); ++i) {
            bool dominated = false;
            for (std::size_t k = 0; k < steps.size() && !dominated; ++k) {
                dominated =
                    k != i && steps[k].dominates(steps[i]) && (accepting[i] & ~accepting[k]) == 0;
            }
            if (dominated) {
                continue;
            }
            const auto [it, added] =
                numbers_.emplace(steps[i].next, static_cast<std::uint32_t>(sets_.size()));
            if (added) {
                sets_.push_back(steps[i].next);
            }
            result.edges.items.push_back(
                {it->second, steps[i].positive, steps[i].negative, accepting[i]});
        }
        result.edges.starts.push_back(static_cast<std::uint32_t>(result.edges.items.size()));
    }

    const Temporal& formula_;
    std::vector<Node> nodes_;
    std::uint32_t root_ = 0;
    std::vector<Set> elements_;                 // per node its bit, 0: not elementary
    std::vector<std::uint32_t> element_nodes_;  // per bit its node
    std::vector<Steps> steps_, covers_;
    std::vector<std::uint32_t> untils_;
    std::map<Set, std::uint32_t> numbers_;  // of the states of the automaton
    std::vector<Set> sets_;
    std::uint64_t work_ = 0, max_work_ = 0;
    bool failed_ = false;
};

}  // namespace

std::optional<Buechi> automaton_of(const Temporal& formula, bool negated,
                                   std::uint32_t max_states) {
    if (formula.nodes.size() > 10000) {
        return std::nullopt;
    }
    return Translator(formula, negated).run(max_states);
}

bool accepts(const Buechi& automaton, std::span<const std::uint64_t> stem,
             std::span<const std::uint64_t> loop) {
    // Runs over positions; an accepted one ends in a component that has every set on its edges.
    const auto positions = static_cast<std::uint32_t>(stem.size() + loop.size());
    const auto letter = [&](std::uint32_t i) {
        return i < stem.size() ? stem[i] : loop[i - stem.size()];
    };
    const auto after = [&](std::uint32_t i) {
        return i + 1 < positions ? i + 1 : static_cast<std::uint32_t>(stem.size());
    };
    Buechi product;  // state q * positions + i, guards left behind
    product.acceptance_sets = automaton.acceptance_sets;
    for (std::uint32_t q = 0; q < automaton.size(); ++q) {
        for (std::uint32_t i = 0; i < positions; ++i) {
            for (const Buechi::Edge& e : automaton.edges.row(q)) {
                if (e.open(letter(i))) {
                    product.edges.items.push_back(
                        {e.target * positions + after(i), 0, 0, e.accepts});
                }
            }
            product.edges.starts.push_back(static_cast<std::uint32_t>(product.edges.items.size()));
        }
    }
    for (const std::uint32_t q : automaton.initial) {
        product.initial.push_back(q * positions);
    }
    clean_up(product);
    return !product.initial.empty();
}

}  // namespace puppetri::proof
