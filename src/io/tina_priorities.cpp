// SPDX-License-Identifier: MIT
// A partial order is a list of levels exactly if "not comparable" is transitive (a weak order).
// Then the level of a transition may be counted by how many are below it.
#include "tina_priorities.h"

#include <algorithm>
#include <optional>
#include <string>

namespace puppetri::io {
namespace {

constexpr std::size_t kMostCompared = 20'000;  // 50 MB of bits

class Order {
 public:
    explicit Order(std::size_t size) : size_(size), words_((size + 63) / 64) {
        bits_.assign(size_ * words_, 0);
    }
    void set(std::size_t a, std::size_t b) { bits_[a * words_ + b / 64] |= bit(b); }
    bool test(std::size_t a, std::size_t b) const {
        return (bits_[a * words_ + b / 64] & bit(b)) != 0;
    }
    // Warshall's algorithm on rows of bits.
    void close() {
        for (std::size_t k = 0; k < size_; ++k) {
            for (std::size_t a = 0; a < size_; ++a) {
                if (a != k && test(a, k)) {
                    for (std::size_t w = 0; w < words_; ++w) {
                        bits_[a * words_ + w] |= bits_[k * words_ + w];
                    }
                }
            }
        }
    }
    std::size_t below(std::size_t a) const {
        std::size_t n = 0;
        for (std::size_t b = 0; b < size_; ++b) {
            n += test(a, b) ? 1 : 0;
        }
        return n;
    }

 private:
    static std::uint64_t bit(std::size_t b) { return std::uint64_t{1} << (b & 63); }
    std::size_t size_, words_;
    std::vector<std::uint64_t> bits_;
};

// "t is not enabled", as an inhibitor where one arc decides, else as a part of the guard.
void forbid_while_enabled(const net::TransitionDraft& t, net::TransitionDraft& u) {
    if (t.inputs.size() == 1 && t.inputs[0].kind != net::ArcKind::kUnless) {
        const net::ArcDraft& only = t.inputs[0];
        for (net::ArcDraft& a : u.inputs) {
            if (a.kind == net::ArcKind::kUnless && a.place == only.place) {
                a.weight = std::min(a.weight, only.weight);
                return;
            }
        }
        u.inputs.push_back({.kind = net::ArcKind::kUnless,
                            .place = only.place,
                            .weight = only.weight,
                            .where = u.where});
        return;
    }
    // Each arc alone, as the kernel tests them; what is taken twice is added.
    std::vector<std::pair<std::uint32_t, std::int64_t>> takes;
    Expr any = Expr::boolean(false);
    const auto compare = [&](ExprOp op, std::uint32_t place, std::int64_t weight) {
        Expr count = Expr::slot(net::slot(net::SlotKind::kCount, place), {ValueKind::kInt, 0});
        Expr one = Expr::binary(op, std::move(count), Expr::integer(weight)).value();
        any = any.is_literal() ? std::move(one)
                               : Expr::binary(ExprOp::kOr, std::move(any), std::move(one)).value();
    };
    for (const net::ArcDraft& a : t.inputs) {
        if (a.kind != net::ArcKind::kTake) {
            compare(a.kind == net::ArcKind::kUnless ? ExprOp::kGreaterEqual : ExprOp::kLess,
                    a.place.value, a.weight);
            continue;
        }
        const auto at = std::find_if(takes.begin(), takes.end(),
                                     [&](const auto& x) { return x.first == a.place.value; });
        if (at == takes.end()) {
            takes.emplace_back(a.place.value, a.weight);
        } else {
            at->second += a.weight;
        }
    }
    for (const auto& [place, weight] : takes) {
        compare(ExprOp::kLess, place, weight);
    }
    u.guard = u.guard ? Expr::binary(ExprOp::kAnd, std::move(*u.guard), std::move(any)).value()
                      : std::move(any);
}

}  // namespace

void settle_priorities(net::NetDraft& draft,
                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& higher,
                       Defects& defects) {
    if (higher.empty()) {
        return;
    }
    // Only those that are compared with something; all others are one more class, if there are any.
    std::vector<std::uint32_t> compared;
    for (const auto& [a, b] : higher) {
        compared.push_back(a);
        compared.push_back(b);
    }
    std::sort(compared.begin(), compared.end());
    compared.erase(std::unique(compared.begin(), compared.end()), compared.end());
    if (compared.size() > kMostCompared) {
        defects.error(
            "net-too-large", draft.transitions[compared[0]].where, "",
            "priorities compare more than " + std::to_string(kMostCompared) + " transitions",
            "compare fewer");
        return;
    }
    const auto number = [&](std::uint32_t t) {
        return static_cast<std::size_t>(std::lower_bound(compared.begin(), compared.end(), t) -
                                        compared.begin());
    };
    Order order(compared.size());
    for (const auto& [a, b] : higher) {
        order.set(number(a), number(b));
    }
    order.close();
    std::vector<std::size_t> below(compared.size());
    for (std::size_t i = 0; i < compared.size(); ++i) {
        if (order.test(i, i)) {
            const net::TransitionDraft& t = draft.transitions[compared[i]];
            defects.error("priorities-in-a-circle", t.where, "transition " + t.path,
                          "it has priority over itself, in a circle of priorities",
                          "take one of them out");
            return;
        }
        below[i] = order.below(i);
    }
    // A weak order: who has more below is above, who has as many is beside. A transition without
    // any priority is comparable with nobody, so it must not be there.
    bool levels = compared.size() == draft.transitions.size();
    for (std::size_t i = 0; levels && i < compared.size(); ++i) {
        for (std::size_t k = 0; levels && k < compared.size(); ++k) {
            levels = order.test(i, k) == (below[i] > below[k]);
        }
    }
    if (levels) {
        std::vector<std::size_t> ranks = below;
        std::sort(ranks.begin(), ranks.end());
        ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
        for (std::size_t i = 0; i < compared.size(); ++i) {
            draft.transitions[compared[i]].priority =
                1 + (std::lower_bound(ranks.begin(), ranks.end(), below[i]) - ranks.begin());
        }
        return;
    }
    for (const net::TransitionDraft& t : draft.transitions) {
        if (t.delay) {
            defects.error("priorities-not-levels", draft.transitions[compared[0]].where, "",
                          "some transitions are comparable and others are not, in a net with time",
                          "give every transition its place in one order of levels");
            return;
        }
    }
    // From copies: a condition speaks of the arcs of the file, not of conditions added before.
    const std::vector<net::TransitionDraft> as_written = draft.transitions;
    for (std::size_t i = 0; i < compared.size(); ++i) {
        for (std::size_t k = 0; k < compared.size(); ++k) {
            if (order.test(i, k)) {
                forbid_while_enabled(as_written[compared[i]], draft.transitions[compared[k]]);
            }
        }
    }
}

}  // namespace puppetri::io
