// SPDX-License-Identifier: MIT
// Predicates as jumping code: children are laid out from the last to the first, each knowing where
// to go when it holds and when it does not.
#include <algorithm>
#include <limits>
#include <utility>

#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

namespace {

using Op = Predicate::Op;

constexpr std::size_t kLatest = 64;

// Where control goes next is known before a node is laid out, so nodes wait on a stack with the
// targets to be filled in.
struct Job {
    std::uint32_t node = 0, yes = 0, no = 0;
    std::uint32_t next_child = 0;  // children above are laid out; `entry` is the way into them
    std::uint32_t entry = 0;
};

}  // namespace

CompiledPredicate::CompiledPredicate(const PlainNet& net, const Predicate& predicate) {
    // Cheap children first: a rough number of tests per node.
    std::vector<std::uint64_t> cost(predicate.nodes.size(), 1);
    std::vector<std::uint32_t> order = predicate.list;
    for (std::size_t i = 0; i < predicate.nodes.size(); ++i) {
        const Predicate::Node& node = predicate.nodes[i];
        const auto row = order.begin() + node.first;
        if (node.op == Op::kAtMost || node.op == Op::kAtLeast) {
            const std::size_t terms = predicate.sums[node.index].terms.size();
            cost[i] = terms == 1 ? 1 : 2 + terms;
        } else if (node.op == Op::kEnabled || node.op == Op::kNoneEnabled) {
            cost[i] = 2 * std::uint64_t{node.count};
        } else if (node.op == Op::kAnd || node.op == Op::kOr) {
            std::stable_sort(row, row + node.count,
                             [&](std::uint32_t a, std::uint32_t b) { return cost[a] < cost[b]; });
            for (auto c = row; c != row + node.count; ++c) {
                cost[i] = std::min(cost[i] + cost[*c], std::uint64_t{1} << 40);
            }
        }
    }

    const auto test = [&](std::uint32_t place, std::uint32_t threshold, std::uint32_t yes,
                          std::uint32_t no) {
        if (yes == no) {
            return yes;
        }
        tests_.push_back({place, threshold, yes, no});
        return static_cast<std::uint32_t>(tests_.size()) - 1;
    };
    const auto at_least = [&](const LinearSum& sum, std::int64_t limit, std::uint32_t yes,
                              std::uint32_t no) {
        if (sum.terms.size() == 1 && sum.terms[0].factor == 1) {
            if (limit <= 0) {
                return yes;
            }
            return limit > std::int64_t{std::numeric_limits<std::uint32_t>::max()}
                       ? no
                       : test(sum.terms[0].place, static_cast<std::uint32_t>(limit), yes, no);
        }
        // Equal sums are looked for among the latest only: laying out stays linear.
        auto index = static_cast<std::uint32_t>(sums_.size() - std::min(sums_.size(), kLatest));
        for (; index < sums_.size(); ++index) {
            const Sum& s = sums_[index];
            if (s.limit == limit &&
                std::equal(terms_.begin() + s.first, terms_.begin() + s.first + s.count,
                           sum.terms.begin(), sum.terms.end())) {
                break;
            }
        }
        if (index == sums_.size()) {
            sums_.push_back({static_cast<std::uint32_t>(terms_.size()),
                             static_cast<std::uint32_t>(sum.terms.size()), limit});
            terms_.insert(terms_.end(), sum.terms.begin(), sum.terms.end());
        }
        return test(kSum | index, 0, yes, no);
    };
    const auto enabled = [&](std::uint32_t t, std::uint32_t yes, std::uint32_t no) {
        std::uint32_t entry = yes;
        for (const net::Weighted& w : net.unless.row(t)) {
            entry = test(w.place, w.weight, no, entry);
        }
        for (const net::Weighted& w : net.reads.row(t)) {
            entry = w.weight == 0 ? entry : test(w.place, w.weight, entry, no);
        }
        for (const net::Weighted& w : net.takes.row(t)) {
            entry = w.weight == 0 ? entry : test(w.place, w.weight, entry, no);
        }
        return entry;
    };

    std::vector<Job> stack = {
        {static_cast<std::uint32_t>(predicate.nodes.size()) - 1, kTrue, kFalse, ~0u, 0}};
    std::uint32_t entry = kFalse;  // of what was laid out last
    while (!stack.empty()) {
        Job& job = stack.back();
        const Predicate::Node& node = predicate.nodes[job.node];
        switch (node.op) {
            case Op::kFalse:
            case Op::kTrue:
                entry = node.op == Op::kTrue ? job.yes : job.no;
                break;
            case Op::kAtLeast:
                entry = at_least(predicate.sums[node.index], node.limit, job.yes, job.no);
                break;
            case Op::kAtMost:
                entry = at_least(predicate.sums[node.index], node.limit + 1, job.no, job.yes);
                break;
            case Op::kEnabled:
            case Op::kNoneEnabled: {
                const bool positive = node.op == Op::kEnabled;
                const std::uint32_t yes = positive ? job.yes : job.no;
                entry = positive ? job.no : job.yes;
                for (std::uint32_t k = node.count; k-- > 0;) {
                    entry = enabled(predicate.list[node.first + k], yes, entry);
                }
                break;
            }
            case Op::kAnd:
            case Op::kOr: {
                const bool all = node.op == Op::kAnd;
                if (job.next_child == ~0u) {
                    job.next_child = node.count;
                    job.entry = all ? job.yes : job.no;
                } else {
                    job.entry = entry;
                }
                entry = job.entry;
                if (job.next_child == 0) {
                    break;
                }
                const std::uint32_t child = order[node.first + --job.next_child];
                const Job next = all ? Job{child, job.entry, job.no, ~0u, 0}
                                     : Job{child, job.yes, job.entry, ~0u, 0};
                stack.push_back(next);
                continue;
            }
        }
        stack.pop_back();
    }
    entry_ = entry;
    // Tests run forwards through memory.
    std::reverse(tests_.begin(), tests_.end());
    const auto last = static_cast<std::uint32_t>(tests_.size()) - 1;
    const auto turn = [&](std::uint32_t& target) {
        target = target < kFalse ? last - target : target;
    };
    turn(entry_);
    for (Test& t : tests_) {
        turn(t.yes);
        turn(t.no);
    }
}

std::vector<std::uint32_t> CompiledPredicate::places() const {
    std::vector<std::uint32_t> list;
    for (const Test& t : tests_) {
        if ((t.place & kSum) == 0) {
            list.push_back(t.place);
        }
    }
    for (const LinearSum::Term& term : terms_) {
        list.push_back(term.place);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

}  // namespace puppetri::proof
