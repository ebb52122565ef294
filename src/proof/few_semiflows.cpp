// SPDX-License-Identifier: MIT
// Rows (y, yC) are combined until yC = 0, one transition after another; at every time the rows
// whose yC is already 0 are semiflows, which is what makes cutting off harmless.
#include "few_semiflows.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace puppetri::proof {

namespace {

using Terms = std::vector<std::pair<std::uint32_t, std::int64_t>>;

constexpr std::int64_t kLargest = std::int64_t{1} << 30;  // larger numbers end a row
constexpr std::size_t kPairsPerSide = 96;
constexpr std::size_t kCompared = 1500;  // rows among which minimal supports are looked for

struct Row {
    Terms flow, effect;
};

std::int64_t at(const Terms& terms, std::uint32_t index) {
    const auto it = std::lower_bound(terms.begin(), terms.end(), std::pair{index, INT64_MIN});
    return it != terms.end() && it->first == index ? it->second : 0;
}

// a * x + b * y
Terms combined(std::int64_t a, const Terms& x, std::int64_t b, const Terms& y) {
    Terms out;
    out.reserve(x.size() + y.size());
    std::size_t i = 0, j = 0;
    while (i < x.size() || j < y.size()) {
        if (j == y.size() || (i < x.size() && x[i].first < y[j].first)) {
            out.emplace_back(x[i].first, a * x[i].second);
            ++i;
        } else if (i == x.size() || y[j].first < x[i].first) {
            out.emplace_back(y[j].first, b * y[j].second);
            ++j;
        } else {
            const std::int64_t v = a * x[i].second + b * y[j].second;
            if (v != 0) {
                out.emplace_back(x[i].first, v);
            }
            ++i;
            ++j;
        }
    }
    return out;
}

// Gives  false if a number became too large.
bool reduce(Row& row) {
    std::int64_t divisor = 0;
    for (const Terms* terms : {&row.flow, &row.effect}) {
        for (const auto& [index, value] : *terms) {
            divisor = std::gcd(divisor, value);
        }
    }
    for (Terms* terms : {&row.flow, &row.effect}) {
        for (auto& [index, value] : *terms) {
            value /= divisor;
            if (value > kLargest || value < -kLargest) {
                return false;
            }
        }
    }
    return true;
}

bool supports_within(const Terms& inner, const Terms& outer) {
    return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
}

// Keeps rows whose support contains no other row's.
void keep_minimal(std::vector<Row>& rows, std::uint64_t& steps) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.flow.size() < b.flow.size(); });
    std::vector<Row> kept;
    for (Row& row : rows) {
        const std::size_t compared = std::min(kept.size(), kCompared);
        const bool minimal = std::none_of(
            kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(compared), [&](const Row& k) {
                steps += k.flow.size();
                return supports_within(k.flow, row.flow);
            });
        if (minimal) {
            kept.push_back(std::move(row));
        }
    }
    rows = std::move(kept);
}

std::vector<Row> first_rows(const PlainNet& net) {
    std::vector<Row> rows(net.place_count());
    for (std::uint32_t p = 0; p < rows.size(); ++p) {
        rows[p].flow = {{p, 1}};
    }
    const auto add = [&](std::uint32_t place, std::uint32_t t, std::int64_t change) {
        Terms& effect = rows[place].effect;
        if (effect.empty() || effect.back().first != t) {
            effect.emplace_back(t, 0);
        }
        effect.back().second += change;
    };
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        for (const net::Weighted& w : net.takes.row(t)) {
            add(w.place, t, -std::int64_t{w.weight});
        }
        for (const net::Weighted& w : net.gives.row(t)) {
            add(w.place, t, std::int64_t{w.weight});
        }
    }
    for (Row& row : rows) {
        std::erase_if(row.effect, [](const auto& e) { return e.second == 0; });
    }
    // Weights of more than 2^30 cannot be combined.
    std::erase_if(rows, [](const Row& row) {
        return std::any_of(row.effect.begin(), row.effect.end(), [](const auto& e) {
            return e.second > kLargest || e.second < -kLargest;
        });
    });
    return rows;
}

// The transition whose elimination makes the fewest rows.
std::uint32_t next_column(const std::vector<Row>& rows, std::uint32_t transitions,
                          std::vector<std::uint32_t>& pos, std::vector<std::uint32_t>& neg,
                          std::uint64_t& steps) {
    pos.assign(transitions, 0);
    neg.assign(transitions, 0);
    for (const Row& row : rows) {
        for (const auto& [t, value] : row.effect) {
            ++(value > 0 ? pos : neg)[t];
        }
        steps += row.effect.size() + 1;
    }
    std::uint32_t best = transitions;
    std::int64_t least = 0;
    for (std::uint32_t t = 0; t < transitions; ++t) {
        if (pos[t] + neg[t] == 0) {
            continue;
        }
        const std::int64_t made =
            std::int64_t{pos[t]} * neg[t] - std::int64_t{pos[t]} - std::int64_t{neg[t]};
        if (best == transitions || made < least) {
            best = t;
            least = made;
        }
    }
    steps += transitions;
    return best;
}

}  // namespace

std::vector<Semiflow> few_semiflows(const PlainNet& net, std::uint64_t effort) {
    std::vector<Row> rows = first_rows(net);
    std::vector<std::uint32_t> pos_count, neg_count;
    std::uint64_t steps = 0;
    while (steps < effort) {
        const std::uint32_t t =
            next_column(rows, net.transition_count(), pos_count, neg_count, steps);
        if (t == net.transition_count()) {
            break;
        }
        std::vector<Row> next, pos, neg;
        for (Row& row : rows) {
            const std::int64_t value = at(row.effect, t);
            (value == 0 ? next : value > 0 ? pos : neg).push_back(std::move(row));
        }
        for (std::vector<Row>* side : {&pos, &neg}) {
            std::stable_sort(side->begin(), side->end(), [](const Row& a, const Row& b) {
                return a.flow.size() < b.flow.size();
            });
            if (pos.size() * neg.size() > kPairsPerSide * kPairsPerSide) {
                side->resize(std::min(side->size(), kPairsPerSide));
            }
        }
        for (const Row& a : pos) {
            for (const Row& b : neg) {
                const std::int64_t x = at(a.effect, t), y = -at(b.effect, t);
                const std::int64_t g = std::gcd(x, y);
                Row row{combined(y / g, a.flow, x / g, b.flow),
                        combined(y / g, a.effect, x / g, b.effect)};
                steps += row.flow.size() + row.effect.size() + 20;
                if (reduce(row)) {
                    next.push_back(std::move(row));
                }
            }
            if (steps > effort) {
                break;
            }
        }
        keep_minimal(next, steps);
        rows = std::move(next);
    }
    std::vector<Semiflow> flows;
    for (Row& row : rows) {
        if (!row.effect.empty()) {
            continue;
        }
        Semiflow flow{std::move(row.flow), 0};
        bool fits = true;
        for (const auto& [p, weight] : flow.terms) {
            const std::uint64_t more = static_cast<std::uint64_t>(weight) * net.initial[p];
            fits =
                fits && flow.total <= (std::uint64_t{1} << 62) && more < (std::uint64_t{1} << 62);
            flow.total += fits ? more : 0;
        }
        if (fits) {
            flows.push_back(std::move(flow));
        }
    }
    return flows;
}

}  // namespace puppetri::proof
