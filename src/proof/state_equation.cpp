// SPDX-License-Identifier: MIT
// Variables are the firings x(t) >= 0; the change of each place is a row sum C(p,t) x(t) >= -m0(p).
// Atoms of the predicate are bounds on changes. The search goes depth first through disjunctions,
// then through fractional firings, with one tableau for all cases.
//
// From a contradiction to an invariant. The program reports bounds with signed factors s that
// cancel identically: sum over places s(p) (C x)(p) + sum over transitions s(t) x(t) = 0, where
// factors above zero use lower bounds, those below upper ones, and the bounds alone sum up above
// zero. If of the firings only x(t) >= 0 is used, then s C = -s(t) <= 0, so s m <= s m0 in every
// reachable marking, and the case asks for more than that.
#include "puppetri/proof/state_equation.h"

#include <algorithm>

#include "case_tree.h"
#include "puppetri/proof/linear_program.h"
#include "puppetri/proof/siphons.h"
#include "puppetri/proof/slice.h"
#include "wide_integer.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::uint64_t kPivotsPerLook = 40;
constexpr std::uint32_t kDeepest = 1000;
constexpr std::uint32_t kMostTraps = 2000;

// The linear program of a net: places as changes from the initial marking.
class NetProgram {
 public:
    NetProgram(const PlainNet& net, std::span<const std::uint8_t> emptied)
        : net_(net), effects_(effects(net)) {
        std::vector<std::vector<LinearProgram::Term>> rows(net.place_count());
        firing_.assign(net.transition_count(), kNone);
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            if (effects_[t].terms.empty()) {
                continue;  // changes nothing, however often
            }
            firing_[t] = program.variable();
            meaning_.push_back({Meaning::kFiring, t});
            program.at_least(firing_[t], 0);
            for (const Flow::Term& term : effects_[t].terms) {
                rows[term.index].push_back({firing_[t], term.factor});
            }
        }
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (!emptied.empty() && emptied[p] != 0) {
                rows[p] = {{program.variable(), 1}};
                meaning_.push_back({Meaning::kNothing, p});
            }
            change_.push_back(program.sum(rows[p]));
            meaning_.push_back({Meaning::kPlace, p});
            program.at_least(change_[p], -std::int64_t{net.initial[p]});
        }
    }

    const PlainNet& net() const { return net_; }
    std::uint32_t firing(std::uint32_t t) const { return firing_[t]; }
    std::uint32_t change(std::uint32_t p) const { return change_[p]; }

    // A variable for the change of a sum.
    std::uint32_t add(const LinearSum& sum, bool trap = false) {
        if (sum.terms.size() == 1 && sum.terms[0].factor == 1 && !trap) {
            return change_[sum.terms[0].place];
        }
        std::vector<LinearProgram::Term> terms;
        for (const LinearSum::Term& term : sum.terms) {
            terms.push_back({change_[term.place], term.factor});
        }
        const std::uint32_t v = program.sum(terms);
        meaning_.push_back(
            {trap ? Meaning::kTrap : Meaning::kSum, static_cast<std::uint32_t>(sums_.size())});
        sums_.push_back(sum);
        return v;
    }

    // Initially; nothing on overflow.
    std::optional<std::int64_t> initially(const LinearSum& sum) const {
        Wide total = 0;
        for (const LinearSum::Term& term : sum.terms) {
            total += Wide{term.factor} * net_.initial[term.place];
        }
        std::int64_t out = 0;
        return fits(total, out) ? std::optional(out) : std::nullopt;
    }

    // What the last contradiction rests on. False: on a split of firings.
    bool invariants(std::vector<Invariant>& out) const {
        std::vector<Wide> factor(net_.place_count(), 0);
        std::vector<Invariant> found;
        bool constant = true;
        const auto count = [&](std::uint32_t p, Wide f) {
            factor[p] += f;
            return factor[p] <= kHuge && factor[p] >= -kHuge;
        };
        for (const LinearProgram::Reason& r : program.reasons()) {
            const Meaning& m = meaning_[r.variable];
            const std::int64_t f = r.upper ? -r.factor : r.factor;
            switch (m.kind) {
                case Meaning::kFiring:
                    if (r.upper || split_[m.index] != 0) {
                        return false;
                    }
                    constant = false;
                    break;
                case Meaning::kPlace:
                    if (!count(m.index, f)) {
                        return false;
                    }
                    break;
                case Meaning::kTrap:
                    found.push_back({sums_[m.index], Invariant::kAtLeast, 1, true});
                    [[fallthrough]];
                case Meaning::kSum:
                    for (const LinearSum::Term& term : sums_[m.index].terms) {
                        if (!count(term.place, Wide{term.factor} * f)) {
                            return false;
                        }
                    }
                    break;
                case Meaning::kNothing:
                    break;  // has no bounds
            }
        }
        Invariant flow;
        Wide divisor = 0;
        bool negative = true;
        for (const Wide f : factor) {
            divisor = common_divisor(divisor, f);
            negative = negative && f <= 0;
        }
        for (std::uint32_t p = 0; p < factor.size(); ++p) {
            if (factor[p] != 0) {
                std::int64_t f = 0;
                if (!fits(factor[p] / (negative ? -divisor : divisor), f)) {
                    return false;
                }
                flow.sum.terms.push_back({p, f});
            }
        }
        if (!flow.sum.terms.empty()) {
            flow.kind = constant   ? Invariant::kEqual
                        : negative ? Invariant::kAtLeast
                                   : Invariant::kAtMost;
            const auto limit = initially(flow.sum);
            if (!limit) {
                return false;
            }
            flow.limit = *limit;
            found.push_back(std::move(flow));
        }
        for (Invariant& i : found) {
            if (std::find(out.begin(), out.end(), i) == out.end()) {
                out.push_back(std::move(i));
            }
        }
        return true;
    }

    void split(std::uint32_t t, int by) {
        split_.resize(net_.transition_count(), 0);
        split_[t] += by;
    }
    void prepare() { split_.resize(net_.transition_count(), 0); }

    LinearProgram program;

 private:
    static constexpr Wide kHuge = Wide{1} << 100;
    struct Meaning {
        enum Kind : std::uint8_t { kFiring, kPlace, kSum, kTrap, kNothing };
        Kind kind = kFiring;
        std::uint32_t index = 0;
    };
    const PlainNet& net_;
    std::vector<Flow> effects_;
    std::vector<std::uint32_t> firing_, change_;
    std::vector<Meaning> meaning_;  // per variable
    std::vector<LinearSum> sums_;
    std::vector<int> split_;  // per transition: how many splits of its firings are under way
};

class Search {
 public:
    Search(const PlainNet& net, CaseTree tree, const Budget& budget,
           const StateEquationOptions& options)
        : options_(options),
          tree_(std::move(tree)),
          program_(net, options.emptied),
          meter_(budget, "state equation"),
          cut_seconds_(std::min(1.0, 0.3 * budget.seconds)) {
        program_.prepare();
    }

    StateEquationAnswer run() {
        for (const LinearSum& sum : tree_.sums) {
            const auto initially = program_.initially(sum);
            if (!initially) {
                return {};
            }
            initially_.push_back(*initially);
            variable_.push_back(program_.add(sum));
        }
        std::vector<std::uint32_t> open;
        StateEquationAnswer::Kind kind = StateEquationAnswer::kImpossible;
        if (require(tree_.root, open)) {
            add_cuts(open);
            kind = explore(std::move(open), 0);
        }
        answer_.kind = kind;
        if (kind != StateEquationAnswer::kImpossible) {
            answer_.used.clear();
        }
        return std::move(answer_);
    }

 private:
    using Kind = StateEquationAnswer::Kind;

    // Asserts a node; disjunctions go to `open`. False: it is the constant false.
    bool require(std::uint32_t n, std::vector<std::uint32_t>& open) {
        const CaseTree::Node& node = tree_.nodes[n];
        switch (node.kind) {
            case CaseTree::Kind::kBound: {
                std::int64_t limit = 0;
                if (!fits(Wide{node.limit} - initially_[node.sum], limit)) {
                    return true;  // too large to be stated: allowing more is sound
                }
                if (node.upper) {
                    program_.program.at_most(variable_[node.sum], limit);
                } else {
                    program_.program.at_least(variable_[node.sum], limit);
                }
                return true;
            }
            case CaseTree::Kind::kAll:
                return std::all_of(node.children.begin(), node.children.end(),
                                   [&](std::uint32_t c) { return require(c, open); });
            case CaseTree::Kind::kAny:
                if (node.children.size() == 1) {
                    return require(node.children[0], open);
                }
                if (node.children.empty()) {
                    return false;
                }
                open.push_back(n);
                return true;
        }
        return false;
    }

    // A disjunction of  m(p_i) <= w_i - 1  over places with at most b_i tokens is stated as one
    // row too, which makes most splits unnecessary: sum m(p_i) <= sum b_i - min (b_i - w_i + 1).
    // For safe places that is all of it.
    void add_cuts(const std::vector<std::uint32_t>& open) {
        std::vector<std::int64_t> most(program_.net().place_count(), -2);  // -1: no bound
        for (const std::uint32_t n : open) {
            LinearSum sum;
            std::int64_t total = 0, least_gap = -1;
            bool fit = true;
            for (const std::uint32_t c : tree_.nodes[n].children) {
                const CaseTree::Node& child = tree_.nodes[c];
                fit = fit && child.kind == CaseTree::Kind::kBound && child.upper &&
                      tree_.sums[child.sum].terms.size() == 1 &&
                      tree_.sums[child.sum].terms[0].factor == 1;
                if (!fit) {
                    break;
                }
                const std::uint32_t p = tree_.sums[child.sum].terms[0].place;
                if (most[p] == -2) {
                    most[p] = meter_.seconds() > cut_seconds_ ? -1 : bound_of(p);
                }
                fit = most[p] >= 0;
                const std::int64_t gap = most[p] - child.limit;
                if (gap <= 0) {  // the child always holds
                    fit = false;
                    break;
                }
                sum.terms.push_back({p, 1});
                total += most[p];
                least_gap = least_gap < 0 ? gap : std::min(least_gap, gap);
            }
            if (!fit || sum.terms.empty()) {
                continue;
            }
            std::sort(sum.terms.begin(), sum.terms.end(),
                      [](const auto& a, const auto& b) { return a.place < b.place; });
            if (std::adjacent_find(sum.terms.begin(), sum.terms.end(),
                                   [](const auto& a, const auto& b) {
                                       return a.place == b.place;
                                   }) != sum.terms.end()) {
                continue;
            }
            const auto initially = program_.initially(sum);
            std::int64_t limit = 0;
            if (initially && fits(Wide{total} - least_gap - *initially, limit)) {
                program_.program.at_most(program_.add(sum), limit);
            }
        }
    }

    std::int64_t bound_of(std::uint32_t p) {
        LinearProgram::Value best;
        ++answer_.programs;
        const auto answer =
            program_.program.maximize(program_.change(p), 10 * kPivotsPerLook, best);
        if (answer != LinearProgram::Answer::kFeasible || best.numerator < -(1ll << 40) ||
            best.numerator > 1ll << 40) {
            return -1;
        }
        return best.floor() + program_.net().initial[p];
    }

    bool out_of_budget() {
        return answer_.programs > options_.cases ||
               meter_.look(answer_.programs, 0, 0, 0) != Ended::kDone;
    }

    // Kind of the last program: kImpossible, kCandidate (feasible), kUnknown.
    Kind solve() {
        ++answer_.programs;
        for (;;) {
            const LinearProgram::Answer answer = program_.program.solve(kPivotsPerLook);
            if (answer == LinearProgram::Answer::kInfeasible) {
                if (!program_.invariants(answer_.used)) {
                    answer_.split_firings = true;
                }
                return Kind::kImpossible;
            }
            if (answer == LinearProgram::Answer::kFeasible) {
                return Kind::kCandidate;
            }
            if (program_.program.overflowed() || out_of_budget()) {
                return Kind::kUnknown;
            }
        }
    }

    // The disjunction is satisfied by the values found.
    bool satisfied(std::uint32_t n) const {
        const CaseTree::Node& node = tree_.nodes[n];
        const auto child = [&](std::uint32_t c) { return satisfied(c); };
        switch (node.kind) {
            case CaseTree::Kind::kAll:
                return std::all_of(node.children.begin(), node.children.end(), child);
            case CaseTree::Kind::kAny:
                return std::any_of(node.children.begin(), node.children.end(), child);
            case CaseTree::Kind::kBound:
                break;
        }
        const LinearProgram::Value v = program_.program.value(variable_[node.sum]);
        const Wide limit = (Wide{node.limit} - initially_[node.sum]);
        std::int64_t stated = 0;
        if (!fits(limit, stated)) {
            return true;  // as in require()
        }
        const Wide right = limit * v.denominator;
        return node.upper ? v.numerator <= right : v.numerator >= right;
    }

    // All cases of the open disjunctions under the bounds in force. Who calls pops them.
    Kind explore(std::vector<std::uint32_t> open, std::uint32_t depth) {
        for (;;) {
            if (out_of_budget() || depth > kDeepest) {
                return Kind::kUnknown;
            }
            const Kind kind = solve();
            if (kind != Kind::kCandidate) {
                return kind;
            }
            std::uint32_t split = kNone;
            for (const std::uint32_t n : open) {
                if (!satisfied(n) && (split == kNone || tree_.nodes[n].children.size() <
                                                            tree_.nodes[split].children.size())) {
                    split = n;
                }
            }
            if (split != kNone) {
                return each_case(open, split, depth);
            }
            const std::uint32_t t = options_.integers ? fractional() : kNone;
            if (t != kNone) {
                return each_side(open, t, depth);
            }
            if (!whole() || !add_trap()) {
                return keep_candidate();
            }
        }
    }

    Kind each_case(const std::vector<std::uint32_t>& open, std::uint32_t split,
                   std::uint32_t depth) {
        std::vector<std::uint32_t> rest = open;
        std::erase(rest, split);
        const std::vector<std::uint32_t> children = tree_.nodes[split].children;
        Kind result = Kind::kImpossible;
        for (const std::uint32_t c : children) {
            program_.program.push();
            std::vector<std::uint32_t> next = rest;
            const Kind kind =
                require(c, next) ? explore(std::move(next), depth + 1) : Kind::kImpossible;
            program_.program.pop();
            if (kind != Kind::kImpossible) {
                result = kind;
                break;
            }
        }
        return result;
    }

    // A firing with a fraction, the one with the least denominator.
    std::uint32_t fractional() const {
        std::uint32_t best = kNone;
        std::int64_t denominator = 0;
        for (std::uint32_t t = 0; t < program_.net().transition_count(); ++t) {
            if (program_.firing(t) == kNone) {
                continue;
            }
            const std::int64_t d = program_.program.value(program_.firing(t)).denominator;
            if (d > 1 && (best == kNone || d < denominator)) {
                best = t;
                denominator = d;
            }
        }
        return best;
    }

    Kind each_side(const std::vector<std::uint32_t>& open, std::uint32_t t, std::uint32_t depth) {
        const LinearProgram::Value v = program_.program.value(program_.firing(t));
        const std::int64_t floor = v.numerator / v.denominator;  // firings are not negative
        Kind result = Kind::kImpossible;
        program_.split(t, 1);
        for (const bool down : {true, false}) {
            program_.program.push();
            if (down) {
                program_.program.at_most(program_.firing(t), floor);
            } else {
                program_.program.at_least(program_.firing(t), floor + 1);
            }
            const Kind kind = explore(open, depth + 1);
            program_.program.pop();
            if (kind != Kind::kImpossible) {
                result = kind;
                break;
            }
        }
        program_.split(t, -1);
        return result;
    }

    // All changes are whole numbers that fit in a marking.
    bool whole() const {
        for (std::uint32_t p = 0; p < program_.net().place_count(); ++p) {
            const LinearProgram::Value v = program_.program.value(program_.change(p));
            if (v.denominator != 1 || v.numerator > std::int64_t{1} << 31) {
                return false;
            }
        }
        return true;
    }

    std::uint32_t tokens(std::uint32_t p) const {
        return static_cast<std::uint32_t>(program_.program.value(program_.change(p)).numerator +
                                          program_.net().initial[p]);
    }

    // The candidate leaves an initially marked trap empty: require it to be marked from now on.
    bool add_trap() {
        if (!options_.traps || traps_ >= kMostTraps) {
            return false;
        }
        const PlainNet& net = program_.net();
        PlaceSet empty;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (tokens(p) == 0 && (options_.emptied.empty() || options_.emptied[p] == 0)) {
                empty.push_back(p);
            }
        }
        PlaceSet trap = greatest_trap_within(net, empty);
        const auto marked = [&](const PlaceSet& set) {
            return std::any_of(set.begin(), set.end(),
                               [&](std::uint32_t p) { return net.initial[p] > 0; });
        };
        if (!marked(trap)) {
            return false;
        }
        // A smaller trap says more.
        for (std::size_t i = 0; i < trap.size();) {
            PlaceSet less = trap;
            less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
            less = greatest_trap_within(net, less);
            if (marked(less)) {
                trap = std::move(less);
            } else {
                ++i;
            }
        }
        LinearSum sum;
        for (const std::uint32_t p : trap) {
            sum.terms.push_back({p, 1});
        }
        const auto initially = program_.initially(sum);
        if (!initially) {
            return false;
        }
        const std::uint32_t v = program_.add(sum, true);
        program_.program.at_least_always(v, 1 - *initially);
        ++traps_;
        return true;
    }

    Kind keep_candidate() {
        if (whole()) {
            for (std::uint32_t p = 0; p < program_.net().place_count(); ++p) {
                answer_.marking.push_back(tokens(p));
            }
            for (std::uint32_t t = 0; t < program_.net().transition_count(); ++t) {
                const std::uint32_t v = program_.firing(t);
                answer_.firings.push_back(
                    v == kNone ? 0
                               : static_cast<std::uint64_t>(program_.program.value(v).numerator /
                                                            program_.program.value(v).denominator));
            }
        }
        return Kind::kCandidate;
    }

    StateEquationOptions options_;
    CaseTree tree_;
    NetProgram program_;
    Meter meter_;
    double cut_seconds_;
    std::vector<std::int64_t> initially_;
    std::vector<std::uint32_t> variable_;
    StateEquationAnswer answer_;
    std::uint32_t traps_ = 0;
};

// The part of a net that can influence some places, and the way back.
struct Part {
    SubNet sub;
    std::vector<std::uint32_t> place;  // of the whole -> of the part
    std::vector<std::uint8_t> emptied;

    Part(const PlainNet& net, std::span<const LinearSum> sums, std::span<const std::uint8_t> all) {
        std::vector<std::uint32_t> roots;
        for (const LinearSum& sum : sums) {
            for (const LinearSum::Term& term : sum.terms) {
                roots.push_back(term.place);
            }
        }
        sub = slice(net, roots);
        place.assign(net.place_count(), kNone);
        for (std::uint32_t p = 0; p < sub.places.size(); ++p) {
            place[sub.places[p]] = p;
            if (!all.empty()) {
                emptied.push_back(all[sub.places[p]]);
            }
        }
    }
    LinearSum inward(LinearSum sum) const {
        for (LinearSum::Term& term : sum.terms) {
            term.place = place[term.place];
        }
        return sum;  // still in order: slices keep it
    }
    LinearSum outward(LinearSum sum) const {
        for (LinearSum::Term& term : sum.terms) {
            term.place = sub.places[term.place];
        }
        return sum;
    }
};

}  // namespace

StateEquationAnswer solve_state_equation(const PlainNet& net, const Predicate& predicate,
                                         const Budget& budget,
                                         const StateEquationOptions& options) {
    CaseTree tree(net, predicate);
    const Part part(net, tree.sums, options.emptied);
    for (LinearSum& sum : tree.sums) {
        sum = part.inward(std::move(sum));
    }
    StateEquationOptions inner = options;
    inner.emptied = part.emptied;
    StateEquationAnswer answer = Search(part.sub.net, std::move(tree), budget, inner).run();
    for (Invariant& i : answer.used) {
        i.sum = part.outward(std::move(i.sum));
    }
    if (answer.kind == StateEquationAnswer::kCandidate &&
        answer.marking.size() == part.sub.places.size()) {
        Marking marking = net.initial;
        std::vector<std::uint64_t> firings(net.transition_count(), 0);
        for (std::uint32_t p = 0; p < part.sub.places.size(); ++p) {
            marking[part.sub.places[p]] = answer.marking[p];
        }
        for (std::uint32_t t = 0; t < part.sub.transitions.size(); ++t) {
            firings[part.sub.transitions[t]] = answer.firings[t];
        }
        answer.marking = std::move(marking);
        answer.firings = std::move(firings);
    }
    return answer;
}

std::optional<std::vector<Invariant>> prove_by_invariants(const PlainNet& net,
                                                          const Predicate& must_never_hold,
                                                          const Budget& budget,
                                                          std::span<const std::uint8_t> emptied) {
    StateEquationOptions options;
    options.integers = false;
    options.emptied = emptied;
    StateEquationAnswer answer = solve_state_equation(net, must_never_hold, budget, options);
    if (answer.kind != StateEquationAnswer::kImpossible || answer.split_firings) {
        return std::nullopt;
    }
    return std::move(answer.used);
}

std::optional<std::int64_t> upper_bound(const PlainNet& net, const LinearSum& sum,
                                        const Budget& budget,
                                        std::span<const std::uint8_t> emptied) {
    const Part part(net, {&sum, 1}, emptied);
    const LinearSum inner = part.inward(sum);
    NetProgram program(part.sub.net, part.emptied);
    const auto initially = program.initially(inner);
    if (!initially) {
        return std::nullopt;
    }
    const std::uint32_t goal = program.add(inner);
    Meter meter(budget, "state equation");
    for (std::uint64_t rounds = 0;; ++rounds) {
        LinearProgram::Value best;
        const LinearProgram::Answer answer = program.program.maximize(goal, kPivotsPerLook, best);
        if (answer == LinearProgram::Answer::kFeasible) {
            std::int64_t bound = 0;
            return fits(Wide{best.floor()} + *initially, bound) ? std::optional(bound)
                                                                : std::nullopt;
        }
        if (answer != LinearProgram::Answer::kGaveUp || program.program.overflowed() ||
            meter.look(rounds, 0, 0, 0) != Ended::kDone) {
            return std::nullopt;
        }
    }
}

std::string text(const Invariant& invariant, std::span<const std::string_view> place_names) {
    std::string out;
    for (const LinearSum::Term& term : invariant.sum.terms) {
        const bool minus = term.factor < 0;
        out += out.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
        const std::int64_t size = minus ? -term.factor : term.factor;
        if (size != 1) {
            out += std::to_string(size) + "*";
        }
        out += place_names[term.place];
    }
    out += invariant.kind == Invariant::kEqual    ? " = "
           : invariant.kind == Invariant::kAtMost ? " <= "
                                                  : " >= ";
    out += std::to_string(invariant.limit);
    return invariant.trap ? out + " (trap)" : out;
}

}  // namespace puppetri::proof
