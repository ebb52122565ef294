// SPDX-License-Identifier: MIT
// A partial order is a list of levels exactly if "not comparable" is transitive (a weak order).
// Then the level of a transition may be counted by how many are below it.
#include "tina_priorities.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>

namespace puppetri::io {
namespace {

constexpr std::size_t kMostCompared = 20'000;  // 50 MB of bits
constexpr std::size_t kMostConditions = 20'000;

class Order {
 public:
    explicit Order(std::size_t size) : size_(size), words_((size + 63) / 64) {
        bits_.assign(size_ * words_, 0);
    }
    void set(std::size_t a, std::size_t b) { bits_[a * words_ + b / 64] |= bit(b); }
    bool test(std::size_t a, std::size_t b) const {
        return (bits_[a * words_ + b / 64] & bit(b)) != 0;
    }
    // Everything below `b` is below `a`, and b itself.
    void add(std::size_t a, std::size_t b) {
        for (std::size_t w = 0; w < words_; ++w) {
            bits_[a * words_ + w] |= bits_[b * words_ + w];
        }
        set(a, b);
    }
    std::size_t below(std::size_t a) const {
        std::size_t n = 0;
        for (std::size_t w = 0; w < words_; ++w) {
            n += static_cast<std::size_t>(std::popcount(bits_[a * words_ + w]));
        }
        return n;
    }

 private:
    static std::uint64_t bit(std::size_t b) { return std::uint64_t{1} << (b & 63); }
    std::size_t size_, words_;
    std::vector<std::uint64_t> bits_;
};

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The transitive closure of pairs over `size` elements, the lowest elements first; nothing if they
// go in a circle, or lead to one: `in_circle` is such an element.
std::optional<Order> closure(std::size_t size, const Pairs& pairs, std::size_t& in_circle) {
    std::vector<std::uint32_t> waits(size, 0);  // for how many lower ones
    std::vector<std::vector<std::uint32_t>> above(size);
    for (const auto& [a, b] : pairs) {
        ++waits[a];
        above[b].push_back(a);
    }
    std::vector<std::uint32_t> ready;
    for (std::uint32_t i = 0; i < size; ++i) {
        if (waits[i] == 0) {
            ready.push_back(i);
        }
    }
    Order order(size);
    std::size_t done = 0;
    while (done < ready.size()) {
        const std::uint32_t b = ready[done++];
        for (const std::uint32_t a : above[b]) {
            order.add(a, b);
            if (--waits[a] == 0) {
                ready.push_back(a);
            }
        }
    }
    if (done < size) {
        in_circle = static_cast<std::size_t>(
            std::find_if(waits.begin(), waits.end(), [](std::uint32_t w) { return w != 0; }) -
            waits.begin());
        return std::nullopt;
    }
    return order;
}

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
        return static_cast<std::uint32_t>(std::lower_bound(compared.begin(), compared.end(), t) -
                                          compared.begin());
    };
    Pairs pairs;
    for (const auto& [a, b] : higher) {
        pairs.emplace_back(number(a), number(b));
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::size_t in_circle = 0;
    const std::optional<Order> closed = closure(compared.size(), pairs, in_circle);
    if (!closed) {
        const net::TransitionDraft& t = draft.transitions[compared[in_circle]];
        defects.error("priorities-in-a-circle", t.where, "transition " + t.path,
                      "it has priority over itself, or over one that has, in a circle",
                      "take one of the priorities out");
        return;
    }
    const Order& order = *closed;
    std::vector<std::size_t> below(compared.size());
    std::size_t related = 0;
    for (std::size_t i = 0; i < compared.size(); ++i) {
        below[i] = order.below(i);
        related += below[i];
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
    if (related > kMostConditions) {
        defects.error("net-too-large", draft.transitions[compared[0]].where, "",
                      "priorities that are no levels compare more than " +
                          std::to_string(kMostConditions) + " pairs of transitions",
                      "give every transition its place in one order of levels");
        return;
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
