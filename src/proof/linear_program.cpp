// SPDX-License-Identifier: MIT
// The general simplex of Dutertre and de Moura (A fast linear-arithmetic solver for DPLL(T), CAV
// 2006, LNCS 4144): rows  sum a_j x_j = 0  with one basic variable each; variables outside the
// basis are always within their bounds; basic ones are brought within theirs one by one. What we
// changed: rows are integers without a common divisor, not rationals with a unit for the basic
// variable, so that most arithmetic is one multiplication of 64-bit numbers and none ever needs a
// denominator; and the leaving variable is the one that is farthest off, until that has taken long,
// then the least (Bland's rule, which ends).
#include "puppetri/proof/linear_program.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "puppetri/proof/budget.h"
#include "wide_integer.h"

namespace puppetri::proof {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::int64_t kNoLow = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kNoHigh = std::numeric_limits<std::int64_t>::max();

struct Fraction {
    std::int64_t n = 0, d = 1;  // lowest terms, d > 0
};

double approximately(const Fraction& f) {
    return static_cast<double>(f.n) / static_cast<double>(f.d);
}

bool below(const Fraction& f, std::int64_t limit) { return Wide{f.n} < Wide{limit} * f.d; }
bool above(const Fraction& f, std::int64_t limit) { return Wide{f.n} > Wide{limit} * f.d; }

bool make(Wide n, Wide d, Fraction& out) {
    if (d < 0) {
        n = -n;
        d = -d;
    }
    const Wide g = common_divisor(n, d);
    if (g > 1) {
        n /= g;
        d /= g;
    }
    return fits(n, out.n) && fits(d, out.d);
}

// a + b
bool plus(const Fraction& a, const Fraction& b, Fraction& out) {
    if (a.d == 1 && b.d == 1) {
        out.d = 1;
        return fits(Wide{a.n} + b.n, out.n);
    }
    return make(Wide{a.n} * b.d + Wide{b.n} * a.d, Wide{a.d} * b.d, out);
}

// a * n / d
bool times(const Fraction& a, std::int64_t n, std::int64_t d, Fraction& out) {
    const std::int64_t g = std::gcd(n, d);
    n /= g;
    d /= g;
    const std::int64_t g1 = std::gcd(a.n, d), g2 = std::gcd(n, a.d);
    return make(Wide{a.n / g1} * (n / g2), Wide{a.d / g2} * (d / g1), out);
}

struct Entry {
    std::uint32_t variable = 0;
    std::int64_t factor = 0;
};

}  // namespace

struct LinearProgram::Tableau {
    struct Row {
        std::vector<Entry> entries;  // in order of variables, the basic one among them
        std::uint32_t basic = 0;
        std::int64_t factor = 1;  // of the basic variable
    };
    struct Trail {
        std::uint32_t variable = 0;
        bool upper = false;
        std::int64_t before = 0;
    };

    std::vector<Row> rows;
    std::vector<std::uint32_t> row_of;               // per variable: of basic ones
    std::vector<std::vector<std::uint32_t>> column;  // per variable: its rows, perhaps stale ones
    std::vector<Fraction> at;                        // per variable
    std::vector<std::int64_t> low, high;
    std::vector<Trail> trail;
    std::vector<std::uint32_t> levels;
    std::vector<std::uint32_t> stamp;  // per row
    std::uint32_t clock = 0;
    std::vector<Reason> reasons;
    std::uint32_t crossed = kNone;  // a variable whose bounds exclude each other
    bool broken = false;            // a number did not fit
    std::uint64_t effort = 0;       // pivots since the bounds last changed
    std::vector<Entry> scratch;

    std::uint32_t add() {
        row_of.push_back(kNone);
        column.emplace_back();
        at.push_back({});
        low.push_back(kNoLow);
        high.push_back(kNoHigh);
        return static_cast<std::uint32_t>(row_of.size()) - 1;
    }

    static std::int64_t factor_in(const Row& row, std::uint32_t variable) {
        const auto it =
            std::lower_bound(row.entries.begin(), row.entries.end(), variable,
                             [](const Entry& e, std::uint32_t v) { return e.variable < v; });
        return it != row.entries.end() && it->variable == variable ? it->factor : 0;
    }

    // Calls with each row that has the variable and its factor there; tidies the column.
    template <class Visit>
    void each_row(std::uint32_t variable, Visit visit) {
        ++clock;
        stamp.resize(rows.size(), 0);
        std::vector<std::uint32_t>& list = column[variable];
        std::size_t kept = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::uint32_t r = list[i];
            if (stamp[r] == clock) {
                continue;
            }
            stamp[r] = clock;
            const std::int64_t f = factor_in(rows[r], variable);
            if (f != 0) {
                list[kept++] = r;
                visit(r, f);
            }
        }
        list.resize(kept);
    }

    // target = target * a - other * b, without a common divisor. New entries enter the columns.
    void combine(std::uint32_t target, std::int64_t a, const Row& other, std::int64_t b) {
        Row& row = rows[target];
        scratch.clear();
        Wide divisor = 0;
        std::vector<WideEntry>& sum = wide;
        sum.clear();
        std::size_t i = 0, j = 0;
        while (i < row.entries.size() || j < other.entries.size()) {
            Wide value = 0;
            std::uint32_t v = 0;
            if (j == other.entries.size() ||
                (i < row.entries.size() && row.entries[i].variable < other.entries[j].variable)) {
                v = row.entries[i].variable;
                value = Wide{row.entries[i++].factor} * a;
            } else if (i == row.entries.size() ||
                       other.entries[j].variable < row.entries[i].variable) {
                v = other.entries[j].variable;
                value = -Wide{other.entries[j++].factor} * b;
                column[v].push_back(target);
            } else {
                v = row.entries[i].variable;
                value = Wide{row.entries[i++].factor} * a - Wide{other.entries[j++].factor} * b;
            }
            if (value != 0) {
                if (divisor != 1) {
                    divisor = common_divisor(divisor, value);
                }
                sum.push_back({v, value});
            }
        }
        for (const WideEntry& e : sum) {
            Entry entry{e.variable, 0};
            if (!fits(divisor > 1 ? e.factor / divisor : e.factor, entry.factor)) {
                broken = true;
            }
            scratch.push_back(entry);
        }
        row.entries.swap(scratch);
        row.factor = factor_in(row, row.basic);
    }
    struct WideEntry {
        std::uint32_t variable = 0;
        Wide factor = 0;
    };
    std::vector<WideEntry> wide;

    // A variable outside the basis moves; the basic ones follow.
    void move(std::uint32_t variable, const Fraction& by) {
        each_row(variable, [&](std::uint32_t r, std::int64_t f) {
            Fraction change;
            const std::uint32_t b = rows[r].basic;
            broken |= f == kNoLow || rows[r].factor == kNoLow || by.n == kNoLow;
            if (broken || !times(by, -f, rows[r].factor, change) || !plus(at[b], change, at[b])) {
                broken = true;
            }
        });
        broken |= !plus(at[variable], by, at[variable]);
    }

    void move_to(std::uint32_t variable, const Fraction& target) {
        Fraction by;
        if (!plus(target, {-at[variable].n, at[variable].d}, by)) {
            broken = true;
            return;
        }
        move(variable, by);
    }

    // `in` enters the basis for the basic variable of row r.
    void exchange(std::uint32_t r, std::uint32_t in) {
        const std::uint32_t out = rows[r].basic;
        const std::int64_t a = factor_in(rows[r], in);
        row_of[out] = kNone;
        row_of[in] = r;
        rows[r].basic = in;
        rows[r].factor = a;
        std::vector<std::pair<std::uint32_t, std::int64_t>> others;
        each_row(in, [&](std::uint32_t k, std::int64_t f) {
            if (k != r) {
                others.emplace_back(k, f);
            }
        });
        const Row pivot = rows[r];
        for (const auto& [k, f] : others) {
            const std::int64_t g = std::gcd(a, f);
            combine(k, a / g, pivot, f / g);
            if (broken) {
                return;
            }
        }
    }

    bool can_rise(std::uint32_t v) const { return high[v] == kNoHigh || below(at[v], high[v]); }
    bool can_fall(std::uint32_t v) const { return low[v] == kNoLow || above(at[v], low[v]); }

    // The row shows that its basic variable cannot come within its bound: the contradiction.
    void explain(const Row& row, bool must_rise) {
        reasons.clear();
        const bool positive = row.factor > 0;
        for (const Entry& e : row.entries) {
            Reason reason{e.variable, false, e.factor < 0 ? -e.factor : e.factor};
            if (e.variable == row.basic) {
                reason.upper = !must_rise;
            } else {
                // To rise, the basic variable needs the others with factors of its sign to fall:
                // they stand at their lower bounds.
                const bool same = (e.factor > 0) == positive;
                reason.upper = same != must_rise;
            }
            reasons.push_back(reason);
        }
    }

    Answer solve(std::uint64_t pivots) {
        reasons.clear();
        if (broken) {
            return Answer::kGaveUp;
        }
        if (crossed != kNone) {
            if (low[crossed] <= high[crossed]) {
                crossed = kNone;
            } else {
                reasons = {{crossed, false, 1}, {crossed, true, 1}};
                return Answer::kInfeasible;
            }
        }
        const std::uint64_t patience = 100 + 2 * rows.size();
        for (std::uint64_t count = 0;; ++count, ++effort) {
            const bool bland = effort > patience;
            std::uint32_t leaving = kNone;
            double farthest = -1;
            for (std::uint32_t r = 0; r < rows.size(); ++r) {
                const std::uint32_t b = rows[r].basic;
                const bool low_broken = low[b] != kNoLow && below(at[b], low[b]);
                const bool high_broken = high[b] != kNoHigh && above(at[b], high[b]);
                if (!low_broken && !high_broken) {
                    continue;
                }
                if (bland) {
                    if (leaving == kNone || b < rows[leaving].basic) {
                        leaving = r;
                    }
                } else {
                    const double limit = static_cast<double>(low_broken ? low[b] : high[b]);
                    const double off = std::abs(approximately(at[b]) - limit);
                    if (off > farthest) {
                        farthest = off;
                        leaving = r;
                    }
                }
            }
            if (leaving == kNone) {
                return Answer::kFeasible;
            }
            if (count >= pivots) {
                return Answer::kGaveUp;
            }
            const Row& row = rows[leaving];
            const std::uint32_t b = row.basic;
            const bool must_rise = low[b] != kNoLow && below(at[b], low[b]);
            std::uint32_t entering = kNone;
            std::size_t shortest = 0;
            for (const Entry& e : row.entries) {
                if (e.variable == b) {
                    continue;
                }
                const bool same = (e.factor > 0) == (row.factor > 0);
                if (!(same == must_rise ? can_fall(e.variable) : can_rise(e.variable))) {
                    continue;
                }
                const std::size_t length = column[e.variable].size();
                if (entering == kNone || (!bland && length < shortest)) {
                    entering = e.variable;
                    shortest = length;
                    if (bland) {
                        break;  // entries are in order: the least
                    }
                }
            }
            if (entering == kNone) {
                explain(row, must_rise);
                return Answer::kInfeasible;
            }
            const Fraction target{must_rise ? low[b] : high[b], 1};
            Fraction by, step;
            const std::int64_t f = factor_in(row, entering);
            if (row.factor == kNoLow || f == kNoLow || !plus(target, {-at[b].n, at[b].d}, by) ||
                !times(by, -row.factor, f, step)) {
                broken = true;
                return Answer::kGaveUp;
            }
            move(entering, step);
            if (!broken) {
                at[b] = target;
                exchange(leaving, entering);
            }
            if (broken) {
                return Answer::kGaveUp;
            }
        }
    }

    // How far a variable outside the basis can move until a basic one stops it. Gives the row, or
    // kNone if its own bound (or nothing) is what stops it; `limited` false: nothing does.
    std::uint32_t step_of(std::uint32_t variable, bool rise, Fraction& step, bool& limited) {
        limited = false;
        std::uint32_t stopper = kNone;
        const std::int64_t own = rise ? high[variable] : low[variable];
        if (own != (rise ? kNoHigh : kNoLow)) {
            limited = true;
            broken |= !plus({own, 1}, {-at[variable].n, at[variable].d}, step);
        }
        each_row(variable, [&](std::uint32_t r, std::int64_t f) {
            const std::uint32_t b = rows[r].basic;
            const bool same = (f > 0) == (rows[r].factor > 0);
            const bool b_rises = same != rise;
            const std::int64_t bound = b_rises ? high[b] : low[b];
            if (bound == (b_rises ? kNoHigh : kNoLow)) {
                return;
            }
            Fraction room, s;
            if (f == kNoLow || rows[r].factor == kNoLow ||
                !plus({bound, 1}, {-at[b].n, at[b].d}, room) ||
                !times(room, -rows[r].factor, f, s)) {
                broken = true;
                return;
            }
            const Wide left = Wide{s.n} * step.d, right = Wide{step.n} * s.d;
            const bool shorter = rise ? left < right : left > right;
            if (!limited || shorter ||
                (left == right && stopper != kNone && b < rows[stopper].basic)) {
                limited = true;
                step = s;
                stopper = r;
            }
        });
        return stopper;
    }

    Answer maximize(std::uint32_t goal, std::uint64_t pivots, Value& best) {
        const Answer first = solve(pivots);
        if (first != Answer::kFeasible) {
            return first;
        }
        for (std::uint64_t count = 0;; ++count) {
            if (count > pivots) {
                return Answer::kGaveUp;
            }
            std::uint32_t entering = kNone;
            bool rise = true;
            if (row_of[goal] == kNone) {
                if (can_rise(goal)) {
                    entering = goal;
                }
            } else {
                const Row& row = rows[row_of[goal]];
                for (const Entry& e : row.entries) {  // the least: Bland's rule
                    if (e.variable == goal) {
                        continue;
                    }
                    const bool up = (e.factor > 0) != (row.factor > 0);
                    if (up ? can_rise(e.variable) : can_fall(e.variable)) {
                        entering = e.variable;
                        rise = up;
                        break;
                    }
                }
                if (high[goal] != kNoHigh && !below(at[goal], high[goal])) {
                    entering = kNone;
                }
            }
            if (entering == kNone) {
                best = {at[goal].n, at[goal].d};
                return Answer::kFeasible;
            }
            Fraction step;
            bool limited = false;
            const std::uint32_t stopper = step_of(entering, rise, step, limited);
            if (broken) {
                return Answer::kGaveUp;
            }
            if (!limited) {
                return Answer::kUnbounded;
            }
            move(entering, step);
            if (!broken && stopper != kNone) {
                exchange(stopper, entering);
            }
            if (broken) {
                return Answer::kGaveUp;
            }
        }
    }

    void bound(std::uint32_t variable, bool upper, std::int64_t limit, bool always = false) {
        effort = 0;
        std::int64_t& now = upper ? high[variable] : low[variable];
        if (upper ? limit >= now : limit <= now) {
            return;
        }
        if (!levels.empty() && !always) {
            trail.push_back({variable, upper, now});
        }
        now = limit;
        if (low[variable] > high[variable]) {
            if (crossed == kNone || low[crossed] <= high[crossed]) {
                crossed = variable;  // the outermost stays
            }
            return;
        }
        if (row_of[variable] == kNone && !broken &&
            (upper ? above(at[variable], limit) : below(at[variable], limit))) {
            move_to(variable, {limit, 1});
        }
    }
};

LinearProgram::LinearProgram() : tableau_(std::make_unique<Tableau>()) {}
LinearProgram::~LinearProgram() = default;
LinearProgram::LinearProgram(LinearProgram&&) noexcept = default;
LinearProgram& LinearProgram::operator=(LinearProgram&&) noexcept = default;

std::uint32_t LinearProgram::variable() { return tableau_->add(); }

std::uint32_t LinearProgram::sum(std::span<const Term> terms) {
    Tableau& t = *tableau_;
    const std::uint32_t v = t.add();
    const auto r = static_cast<std::uint32_t>(t.rows.size());
    t.rows.emplace_back();
    Tableau::Row& row = t.rows.back();
    row.basic = v;
    std::vector<Term> sorted(terms.begin(), terms.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Term& a, const Term& b) { return a.variable < b.variable; });
    Fraction value;
    for (const Term& term : sorted) {
        if (term.factor == 0) {
            continue;
        }
        if (!row.entries.empty() && row.entries.back().variable == term.variable) {
            t.broken |= __builtin_sub_overflow(row.entries.back().factor, term.factor,
                                               &row.entries.back().factor);
        } else {
            t.broken |= term.factor == kNoLow;
            row.entries.push_back({term.variable, -term.factor});
        }
        Fraction part;
        if (t.broken || !times(t.at[term.variable], term.factor, 1, part) ||
            !plus(value, part, value)) {
            t.broken = true;
        }
    }
    std::erase_if(row.entries, [](const Entry& e) { return e.factor == 0; });
    row.entries.push_back({v, 1});
    t.at[v] = value;
    t.row_of[v] = r;
    for (const Entry& e : row.entries) {
        t.column[e.variable].push_back(r);
    }
    // Basic variables are replaced by their rows.
    for (const Term& term : sorted) {
        const std::uint32_t k = t.row_of[term.variable];
        if (t.broken || k == kNone) {
            continue;
        }
        const std::int64_t f = Tableau::factor_in(t.rows[r], term.variable);
        if (f != 0) {
            const std::int64_t a = t.rows[k].factor, g = std::gcd(a, f);
            t.combine(r, a / g, t.rows[k], f / g);
        }
    }
    return v;
}

void LinearProgram::at_least(std::uint32_t variable, std::int64_t limit) {
    tableau_->bound(variable, false, limit);
}
void LinearProgram::at_most(std::uint32_t variable, std::int64_t limit) {
    tableau_->bound(variable, true, limit);
}
void LinearProgram::at_least_always(std::uint32_t variable, std::int64_t limit) {
    tableau_->bound(variable, false, limit, true);
}

void LinearProgram::push() {
    tableau_->levels.push_back(static_cast<std::uint32_t>(tableau_->trail.size()));
}

void LinearProgram::pop() {
    Tableau& t = *tableau_;
    t.effort = 0;
    while (t.trail.size() > t.levels.back()) {
        const Tableau::Trail& change = t.trail.back();
        (change.upper ? t.high : t.low)[change.variable] = change.before;
        t.trail.pop_back();
    }
    t.levels.pop_back();
}

LinearProgram::Answer LinearProgram::solve(std::uint64_t pivots) { return tableau_->solve(pivots); }
bool LinearProgram::overflowed() const { return tableau_->broken; }
const std::vector<LinearProgram::Reason>& LinearProgram::reasons() const {
    return tableau_->reasons;
}
LinearProgram::Value LinearProgram::value(std::uint32_t variable) const {
    return {tableau_->at[variable].n, tableau_->at[variable].d};
}
LinearProgram::Answer LinearProgram::maximize(std::uint32_t variable, std::uint64_t pivots,
                                              Value& best) {
    return tableau_->maximize(variable, pivots, best);
}

bool is_feasible(LinearProgram& program, Meter& meter) {
    constexpr std::uint64_t kPivotsPerLook = 40;
    for (std::uint64_t round = 0;; ++round) {
        const LinearProgram::Answer answer = program.solve(kPivotsPerLook);
        if (answer != LinearProgram::Answer::kGaveUp) {
            return answer == LinearProgram::Answer::kFeasible;
        }
        if (program.overflowed() || meter.look(round, 0, 0, 0) != Ended::kDone) {
            return false;
        }
    }
}

}  // namespace puppetri::proof
