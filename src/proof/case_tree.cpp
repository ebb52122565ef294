// SPDX-License-Identifier: MIT
// From predicates to trees of bounds.
#include "case_tree.h"

#include <algorithm>

namespace puppetri::proof {

namespace {
constexpr std::uint32_t kNone = ~std::uint32_t{0};
}

std::uint32_t CaseTree::add(Node node) {
    nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(nodes.size()) - 1;
}

std::uint32_t CaseTree::bound(const LinearSum& sum, bool upper, std::int64_t limit) {
    if (sum.terms.size() == 1 && sum.terms[0].factor == 1) {
        return place_bound(sum.terms[0].place, upper, limit);
    }
    const auto found = std::find(sums.begin(), sums.end(), sum);
    Node node{Kind::kBound, {}, static_cast<std::uint32_t>(found - sums.begin()), upper, limit};
    if (found == sums.end()) {
        sums.push_back(sum);
    }
    return add(std::move(node));
}

std::uint32_t CaseTree::place_bound(std::uint32_t place, bool upper, std::int64_t limit) {
    if (place_sum_[place] == kNone) {
        place_sum_[place] = static_cast<std::uint32_t>(sums.size());
        sums.push_back({{{place, 1}}});
    }
    return add({Kind::kBound, {}, place_sum_[place], upper, limit});
}

std::uint32_t CaseTree::enabled(const PlainNet& net, std::uint32_t t) {
    Node all{Kind::kAll, {}, 0, false, 0};
    for (const net::Weighted& w : net.takes.row(t)) {
        all.children.push_back(place_bound(w.place, false, w.weight));
    }
    for (const net::Weighted& w : net.reads.row(t)) {
        all.children.push_back(place_bound(w.place, false, w.weight));
    }
    for (const net::Weighted& w : net.unless.row(t)) {
        all.children.push_back(place_bound(w.place, true, std::int64_t{w.weight} - 1));
    }
    return add(std::move(all));
}

std::uint32_t CaseTree::disabled(const PlainNet& net, std::uint32_t t) {
    Node any{Kind::kAny, {}, 0, false, 0};
    for (const net::Weighted& w : net.takes.row(t)) {
        any.children.push_back(place_bound(w.place, true, std::int64_t{w.weight} - 1));
    }
    for (const net::Weighted& w : net.reads.row(t)) {
        any.children.push_back(place_bound(w.place, true, std::int64_t{w.weight} - 1));
    }
    for (const net::Weighted& w : net.unless.row(t)) {
        any.children.push_back(place_bound(w.place, false, w.weight));
    }
    return add(std::move(any));
}

CaseTree::CaseTree(const PlainNet& net, const Predicate& predicate) {
    place_sum_.assign(net.place_count(), kNone);
    std::vector<std::uint32_t> made(predicate.nodes.size());
    for (std::size_t i = 0; i < predicate.nodes.size(); ++i) {
        const Predicate::Node& node = predicate.nodes[i];
        const auto transitions = [&](auto visit) {
            for (std::uint32_t k = 0; k < node.count; ++k) {
                visit(predicate.list[node.first + k]);
            }
        };
        Node out;
        switch (node.op) {
            case Predicate::Op::kTrue:
                made[i] = add(std::move(out));
                break;
            case Predicate::Op::kFalse:
                out.kind = Kind::kAny;
                made[i] = add(std::move(out));
                break;
            case Predicate::Op::kAtMost:
            case Predicate::Op::kAtLeast:
                made[i] = bound(predicate.sums[node.index], node.op == Predicate::Op::kAtMost,
                                node.limit);
                break;
            case Predicate::Op::kEnabled:
                out.kind = Kind::kAny;
                transitions([&](std::uint32_t t) { out.children.push_back(enabled(net, t)); });
                made[i] = add(std::move(out));
                break;
            case Predicate::Op::kNoneEnabled:
                transitions([&](std::uint32_t t) { out.children.push_back(disabled(net, t)); });
                made[i] = add(std::move(out));
                break;
            case Predicate::Op::kAnd:
            case Predicate::Op::kOr:
                out.kind = node.op == Predicate::Op::kAnd ? Kind::kAll : Kind::kAny;
                for (std::uint32_t k = 0; k < node.count; ++k) {
                    out.children.push_back(made[predicate.list[node.first + k]]);
                }
                made[i] = add(std::move(out));
                break;
        }
    }
    root = made.empty() ? add({}) : made.back();
}

}  // namespace puppetri::proof
