// SPDX-License-Identifier: MIT
// Depth first, until a marking has at least as many tokens everywhere as an ancestor, and somewhere
// more: what lies between is a pump, if it can be repeated. Only markings with more tokens in all
// than any ancestor are compared, and only with such: on an endless path there are endlessly many
// of them, and (Dickson's lemma) two of them cover each other. So without inhibitors each unbounded
// net is found out, in some finite time.
#include "puppetri/proof/coverability.h"

#include <algorithm>
#include <vector>

#include "marking_set.h"
#include "puppetri/proof/linear_program.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {

namespace {

constexpr double kStructuralShare = 0.2;  // of the budget's seconds

// Some y >= 1 with y C <= 0: then y m <= y m0 for ever. With sums that only fall the net is bounded
// whatever its initial marking.
bool has_falling_sum(const PlainNet& net, const Budget& budget) {
    LinearProgram program;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        program.at_least(program.variable(), 1);
    }
    for (const Flow& column : effects(net)) {
        std::vector<LinearProgram::Term> terms;
        for (const Flow::Term& term : column.terms) {
            terms.push_back({term.index, term.factor});
        }
        program.at_most(program.sum(terms), 0);
    }
    Budget share = budget;
    share.seconds = budget.seconds * kStructuralShare;
    Meter meter(share, "sub-invariant");
    return is_feasible(program, meter);
}

class PumpSearch {
 public:
    PumpSearch(const PlainNet& net, const Budget& budget)
        : net_(net), meter_(budget, "search"), seen_(net.place_count()) {}

    BoundednessAnswer run() {
        BoundednessAnswer answer;
        answer.method = "search";
        enter(net_.initial);
        seen_.insert(net_.initial);
        for (std::uint64_t steps = 0; !path_.empty(); ++steps) {
            if ((steps & 255) == 0 &&
                meter_.look(seen_.size(), steps, path_.size(), bytes()) != Ended::kDone) {
                return answer;
            }
            Step& top = path_.back();
            std::uint32_t t = top.next;
            while (t < net_.transition_count() && !net_.enabled(top.marking, t)) {
                ++t;
            }
            top.next = t + 1;
            if (t >= net_.transition_count()) {
                if (records_.back() + 1 == path_.size()) {
                    records_.pop_back();
                }
                path_.pop_back();
                continue;
            }
            Marking next = top.marking;
            if (!net_.fire(next, t)) {
                return answer;  // counts as great as these are found by budgets only
            }
            if (!seen_.insert(next)) {
                continue;
            }
            if (enter(std::move(next)) && grew(answer)) {
                return answer;
            }
        }
        // All markings were visited: there are finitely many.
        answer.kind = BoundednessAnswer::kBounded;
        return answer;
    }

 private:
    struct Step {
        Marking marking;
        std::uint64_t tokens = 0;
        std::uint32_t next = 0;  // transition to try
    };

    std::uint64_t bytes() const {
        return seen_.bytes() +
               path_.size() * (sizeof(Step) + 4 * std::uint64_t{net_.place_count()});
    }

    // True: it has more tokens than all ancestors.
    bool enter(Marking marking) {
        std::uint64_t tokens = 0;
        for (const std::uint32_t n : marking) {
            tokens += n;
        }
        const bool record = records_.empty() || tokens > path_[records_.back()].tokens;
        path_.push_back({std::move(marking), tokens, 0});
        if (record) {
            records_.push_back(path_.size() - 1);
        }
        return record;
    }

    // The last marking covers one on the path strictly, by firings that can be repeated: with more
    // tokens all of them stay enabled unless an inhibitor tests a place that grows; with the
    // inhibited places unchanged after each round, they stay enabled for ever.
    bool grew(BoundednessAnswer& answer) const {
        const Marking& now = path_.back().marking;
        for (const std::size_t i : records_) {
            if (i + 1 == path_.size()) {
                break;
            }
            const Marking& before = path_[i].marking;
            std::uint32_t place = net_.place_count();
            bool covers = true;
            for (std::uint32_t p = 0; p < net_.place_count() && covers; ++p) {
                covers = now[p] >= before[p];
                if (now[p] > before[p] && place == net_.place_count()) {
                    place = p;
                }
            }
            if (!covers || place == net_.place_count()) {
                continue;
            }
            std::vector<std::uint32_t> prefix, pump;
            for (std::size_t k = 0; k + 1 < path_.size(); ++k) {
                (k < i ? prefix : pump).push_back(path_[k].next - 1);
            }
            const bool repeats = std::all_of(pump.begin(), pump.end(), [&](std::uint32_t t) {
                const auto row = net_.unless.row(t);
                return std::all_of(row.begin(), row.end(), [&](const net::Weighted& w) {
                    return now[w.place] == before[w.place];
                });
            });
            if (repeats) {
                answer.kind = BoundednessAnswer::kUnbounded;
                answer.place = place;
                answer.prefix = std::move(prefix);
                answer.pump = std::move(pump);
                return true;
            }
        }
        return false;
    }

    const PlainNet& net_;
    Meter meter_;
    MarkingSet seen_;
    std::vector<Step> path_;
    std::vector<std::size_t> records_;  // positions on the path
};

}  // namespace

BoundednessAnswer boundedness(const PlainNet& net, const Budget& budget) {
    if (has_falling_sum(net, budget)) {
        BoundednessAnswer answer;
        answer.kind = BoundednessAnswer::kBounded;
        answer.method = "sub-invariant";
        return answer;
    }
    BoundednessAnswer answer = PumpSearch(net, budget).run();
    if (answer.kind == BoundednessAnswer::kUnbounded && net.has_levels) {
        // Some firing of the pump may be blocked by a higher level.
        answer = {};
        answer.method = "search";
    }
    return answer;
}

}  // namespace puppetri::proof
