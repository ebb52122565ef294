// SPDX-License-Identifier: MIT
// Farkas' algorithm: start with one row per place, its column of the incidence matrix beside its
// unit vector; make the columns zero one after another, by adding rows of opposite sign; drop rows
// whose support contains another's.
#include "puppetri/proof/semiflows.h"

#include <algorithm>

#include "puppetri/net/tables.h"
#include "wide_integer.h"

namespace puppetri::proof {

namespace {

constexpr std::uint64_t kMostRows = 20'000;
using Terms = std::vector<Flow::Term>;

struct FarkasRow {
    Terms left;   // what is still to be made zero
    Terms right;  // the flow
    std::vector<std::uint64_t> support;
};

bool is_subset(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        if ((a[i] & ~b[i]) != 0) {
            return false;
        }
    }
    return true;
}

std::int64_t factor_of(const Terms& terms, std::uint32_t index) {
    const auto it =
        std::lower_bound(terms.begin(), terms.end(), index,
                         [](const Flow::Term& a, std::uint32_t i) { return a.index < i; });
    return it != terms.end() && it->index == index ? it->factor : 0;
}

struct WideTerm {
    std::uint32_t index = 0;
    Wide factor = 0;
};

// a x + b y
void add_wide(const Terms& x, std::int64_t a, const Terms& y, std::int64_t b,
              std::vector<WideTerm>& out, Wide& divisor) {
    out.clear();
    std::size_t i = 0, j = 0;
    while (i < x.size() || j < y.size()) {
        WideTerm term;
        if (j == y.size() || (i < x.size() && x[i].index < y[j].index)) {
            term = {x[i].index, Wide{x[i].factor} * a};
            ++i;
        } else if (i == x.size() || y[j].index < x[i].index) {
            term = {y[j].index, Wide{y[j].factor} * b};
            ++j;
        } else {
            term = {x[i].index, Wide{x[i].factor} * a + Wide{y[j].factor} * b};
            ++i;
            ++j;
        }
        if (term.factor != 0) {
            divisor = common_divisor(divisor, term.factor);
            out.push_back(term);
        }
    }
}

bool narrow(const std::vector<WideTerm>& wide, Wide divisor, Terms& out) {
    out.clear();
    for (const WideTerm& term : wide) {
        std::int64_t f = 0;
        if (!fits(term.factor / divisor, f)) {
            return false;
        }
        out.push_back({term.index, f});
    }
    return true;
}

// a x + b y without a common divisor; false if a number does not fit.
bool combine(const FarkasRow& x, std::int64_t a, const FarkasRow& y, std::int64_t b,
             FarkasRow& out) {
    Wide divisor = 0;
    std::vector<WideTerm> left, right;
    add_wide(x.left, a, y.left, b, left, divisor);
    add_wide(x.right, a, y.right, b, right, divisor);
    return narrow(left, divisor == 0 ? 1 : divisor, out.left) &&
           narrow(right, divisor == 0 ? 1 : divisor, out.right);
}

class Farkas {
 public:
    Farkas(std::vector<Terms> matrix, std::uint32_t columns, std::span<const std::uint8_t> without,
           const Budget& budget)
        : columns_(columns), budget_(budget), meter_(budget, "semiflows") {
        const std::size_t words = (matrix.size() + 63) / 64;
        for (std::uint32_t i = 0; i < matrix.size(); ++i) {
            if (!without.empty() && without[i] != 0) {
                continue;
            }
            FarkasRow row;
            row.left = std::move(matrix[i]);
            row.right = {{i, 1}};
            row.support.assign(words, 0);
            row.support[i / 64] |= std::uint64_t{1} << (i & 63);
            rows_.push_back(std::move(row));
        }
    }

    Flows semiflows() {
        std::vector<std::uint8_t> done(columns_, 0);
        for (std::uint32_t round = 0; round < columns_; ++round) {
            const std::uint32_t column = cheapest(done);
            if (column == columns_) {
                break;
            }
            done[column] = 1;
            if (!annul(column)) {
                // Rows that are zero already are flows all the same.
                std::erase_if(rows_, [](const FarkasRow& r) { return !r.left.empty(); });
                complete_ = false;
                break;
            }
        }
        return result();
    }

    Flows basis() {
        for (std::uint32_t column = 0; column < columns_; ++column) {
            if (meter_.look(column, 0, 0, 0) != Ended::kDone) {
                std::erase_if(rows_, [](const FarkasRow& r) { return !r.left.empty(); });
                complete_ = false;
                break;
            }
            // The shortest row of the column cancels it in the others.
            std::size_t pivot = rows_.size();
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                if (factor_of(rows_[i].left, column) != 0 &&
                    (pivot == rows_.size() || size(rows_[i]) < size(rows_[pivot]))) {
                    pivot = i;
                }
            }
            if (pivot == rows_.size()) {
                continue;
            }
            const FarkasRow with = std::move(rows_[pivot]);
            rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(pivot));
            const std::int64_t a = factor_of(with.left, column);
            std::size_t kept = 0;
            for (FarkasRow& row : rows_) {
                const std::int64_t b = factor_of(row.left, column);
                if (b != 0) {
                    const std::int64_t g = std::gcd(a, b);
                    FarkasRow sum;
                    if (!combine(row, a / g, with, -(b / g), sum)) {
                        complete_ = false;
                        continue;
                    }
                    row = std::move(sum);
                }
                if (&rows_[kept] != &row) {
                    rows_[kept] = std::move(row);
                }
                ++kept;
            }
            rows_.resize(kept);
        }
        for (FarkasRow& row : rows_) {
            const bool negative = std::all_of(row.right.begin(), row.right.end(),
                                              [](const auto& t) { return t.factor < 0; });
            for (Flow::Term& t : row.right) {
                t.factor = negative ? -t.factor : t.factor;
            }
        }
        return result();
    }

 private:
    static std::size_t size(const FarkasRow& r) { return r.left.size() + r.right.size(); }

    // The column that makes the fewest new rows.
    std::uint32_t cheapest(const std::vector<std::uint8_t>& done) const {
        std::vector<std::uint64_t> plus(columns_, 0), minus(columns_, 0);
        for (const FarkasRow& row : rows_) {
            for (const Flow::Term& t : row.left) {
                ++(t.factor > 0 ? plus : minus)[t.index];
            }
        }
        std::uint32_t best = columns_;
        std::uint64_t cost = 0;
        for (std::uint32_t c = 0; c < columns_; ++c) {
            if (done[c] != 0 || plus[c] + minus[c] == 0) {
                continue;
            }
            const std::uint64_t here = plus[c] * minus[c];
            if (best == columns_ || here < cost) {
                best = c;
                cost = here;
            }
        }
        return best;
    }

    bool annul(std::uint32_t column) {
        std::vector<FarkasRow> zero, plus, minus;
        for (FarkasRow& row : rows_) {
            const std::int64_t f = factor_of(row.left, column);
            (f == 0 ? zero : f > 0 ? plus : minus).push_back(std::move(row));
        }
        rows_ = std::move(zero);
        const std::size_t old = rows_.size();
        std::uint64_t steps = 0;
        for (const FarkasRow& p : plus) {
            for (const FarkasRow& m : minus) {
                if ((steps++ & 255) == 0 &&
                    meter_.look(rows_.size(), steps, 0, rows_.size() * 200) != Ended::kDone) {
                    return false;
                }
                FarkasRow sum;
                sum.support = p.support;
                for (std::size_t w = 0; w < sum.support.size(); ++w) {
                    sum.support[w] |= m.support[w];
                }
                // No factor is negative, so nothing cancels and the support is the union.
                if (std::any_of(rows_.begin(), rows_.end(), [&](const FarkasRow& r) {
                        return is_subset(r.support, sum.support);
                    })) {
                    continue;
                }
                const std::int64_t a = -factor_of(m.left, column), b = factor_of(p.left, column);
                const std::int64_t g = std::gcd(a, b);
                if (!combine(p, a / g, m, b / g, sum)) {
                    complete_ = false;
                    continue;
                }
                // New rows may contain it; old ones cannot, they were minimal with fewer columns.
                std::size_t kept = old;
                for (std::size_t i = old; i < rows_.size(); ++i) {
                    if (!is_subset(sum.support, rows_[i].support)) {
                        if (kept != i) {
                            rows_[kept] = std::move(rows_[i]);
                        }
                        ++kept;
                    }
                }
                rows_.resize(kept);
                rows_.push_back(std::move(sum));
                if (rows_.size() > std::min(budget_.states, kMostRows)) {
                    return false;
                }
            }
        }
        return true;
    }

    Flows result() {
        Flows out;
        out.complete = complete_;
        for (FarkasRow& row : rows_) {
            out.flows.push_back({std::move(row.right)});
        }
        std::sort(out.flows.begin(), out.flows.end(), [](const Flow& a, const Flow& b) {
            return std::lexicographical_compare(
                a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(),
                [](const Flow::Term& x, const Flow::Term& y) {
                    return x.index != y.index ? x.index < y.index : x.factor < y.factor;
                });
        });
        return out;
    }

    std::uint32_t columns_;
    const Budget& budget_;
    Meter meter_;
    std::vector<FarkasRow> rows_;
    bool complete_ = true;
};

std::vector<Terms> effects_of_transitions(const PlainNet& net) {
    std::vector<Terms> out(net.transition_count());
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        const auto takes = net.takes.row(t), gives = net.gives.row(t);
        std::size_t i = 0, j = 0;
        while (i < takes.size() || j < gives.size()) {
            Flow::Term term;
            if (j == gives.size() || (i < takes.size() && takes[i].place < gives[j].place)) {
                term = {takes[i].place, -std::int64_t{takes[i].weight}};
                ++i;
            } else if (i == takes.size() || gives[j].place < takes[i].place) {
                term = {gives[j].place, std::int64_t{gives[j].weight}};
                ++j;
            } else {
                term = {takes[i].place, std::int64_t{gives[j].weight} - takes[i].weight};
                ++i;
                ++j;
            }
            if (term.factor != 0) {
                out[t].push_back(term);
            }
        }
    }
    return out;
}

std::vector<Terms> effects_on_places(const PlainNet& net) {
    std::vector<Terms> rows(net.place_count());
    const std::vector<Terms> columns = effects_of_transitions(net);
    for (std::uint32_t t = 0; t < columns.size(); ++t) {
        for (const Flow::Term& term : columns[t]) {
            rows[term.index].push_back({t, term.factor});
        }
    }
    return rows;
}

}  // namespace

Flows place_semiflows(const PlainNet& net, const Budget& budget,
                      std::span<const std::uint8_t> emptied) {
    return Farkas(effects_on_places(net), net.transition_count(), emptied, budget).semiflows();
}

Flows transition_semiflows(const PlainNet& net, const Budget& budget) {
    return Farkas(effects_of_transitions(net), net.place_count(), {}, budget).semiflows();
}

Flows place_flow_basis(const PlainNet& net, const Budget& budget,
                       std::span<const std::uint8_t> emptied) {
    return Farkas(effects_on_places(net), net.transition_count(), emptied, budget).basis();
}

std::vector<std::uint8_t> emptied_places(const net::Net& net) {
    std::vector<std::uint8_t> emptied(net.place_count(), 0);
    for (const net::Special& s : net.tables().specials) {
        for (const net::ArcTable& arc : s.arcs) {
            if (arc.kind == net::ArcKind::kTakeAll || arc.kind == net::ArcKind::kTakeAllNow) {
                emptied[arc.place] = 1;
            }
        }
    }
    return emptied;
}

std::optional<std::int64_t> weighted_tokens(const Flow& flow,
                                            std::span<const std::uint32_t> marking) {
    Wide sum = 0;
    for (const Flow::Term& term : flow.terms) {
        sum += Wide{term.factor} * marking[term.index];
    }
    std::int64_t out = 0;
    return fits(sum, out) ? std::optional(out) : std::nullopt;
}

std::vector<std::uint64_t> bounds_by_semiflows(const PlainNet& net, const Flows& semiflows) {
    std::vector<std::uint64_t> bounds(net.place_count(), kNoBound);
    for (const Flow& flow : semiflows.flows) {
        const auto total = weighted_tokens(flow, net.initial);
        if (!total) {
            continue;
        }
        for (const Flow::Term& term : flow.terms) {
            bounds[term.index] =
                std::min(bounds[term.index], static_cast<std::uint64_t>(*total / term.factor));
        }
    }
    return bounds;
}

std::vector<Flow> effects(const PlainNet& net) {
    std::vector<Flow> out;
    for (Terms& terms : effects_of_transitions(net)) {
        out.push_back({std::move(terms)});
    }
    return out;
}

std::string invariant_text(const Flow& flow, std::int64_t constant,
                           std::span<const std::string_view> place_names) {
    std::string out;
    for (const Flow::Term& term : flow.terms) {
        const bool minus = term.factor < 0;
        out += out.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
        const std::int64_t size = minus ? -term.factor : term.factor;
        out += (size != 1 ? std::to_string(size) + "*" : "") + std::string(place_names[term.index]);
    }
    return out + " = " + std::to_string(constant);
}

}  // namespace puppetri::proof
