// SPDX-License-Identifier: MIT
// Class by class, from those where the chain begins to those that it does not leave.
#include "puppetri/proof/markov_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "puppetri/base/rational.h"
#include "puppetri/base/require.h"

namespace puppetri::proof {
namespace {

constexpr std::size_t kMostEliminated = 500;
constexpr int kMostSweeps = 20'000;
constexpr double kAtRest = 1e-15;

std::vector<double> exit_rates(const MarkovChain& chain) {
    std::vector<double> rates(chain.size(), 0);
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        for (const Jump& j : chain.jumps.row(s)) {
            rates[s] += j.target != s ? j.rate : 0;
        }
    }
    return rates;
}

// Row t: the jumps into t from elsewhere, with their sources as targets.
net::Rows<Jump> jumps_into(const MarkovChain& chain) {
    net::Rows<Jump> into;
    into.starts.assign(chain.size() + 1, 0);
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        for (const Jump& j : chain.jumps.row(s)) {
            into.starts[j.target + 1] += j.target != s;
        }
    }
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        into.starts[s + 1] += into.starts[s];
    }
    into.items.resize(into.starts.back());
    std::vector<std::uint32_t> next(into.starts.begin(), into.starts.end() - 1);
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        for (const Jump& j : chain.jumps.row(s)) {
            if (j.target != s) {
                into.items[next[j.target]++] = {s, j.rate};
            }
        }
    }
    return into;
}

struct Classes {
    StrongComponents components;
    StateBits bottoms;
    net::Rows<std::uint32_t> members;
};

Classes classes_of(const MarkovChain& chain) {
    Graph graph;
    graph.edges.starts.assign(1, 0);
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        for (const Jump& j : chain.jumps.row(s)) {
            graph.edges.items.push_back({.label = 0, .target = j.target});
        }
        graph.edges.starts.push_back(static_cast<std::uint32_t>(graph.edges.items.size()));
    }
    graph.flags.assign(chain.size(), 0);
    Classes c{strong_components(graph), {}, {}};
    c.bottoms = bottom_components(graph, c.components);
    c.members.starts.assign(c.components.count + 1, 0);
    for (const std::uint32_t k : c.components.of) {
        ++c.members.starts[k + 1];
    }
    for (std::uint32_t k = 0; k < c.components.count; ++k) {
        c.members.starts[k + 1] += c.members.starts[k];
    }
    c.members.items.resize(chain.size());
    std::vector<std::uint32_t> next(c.members.starts.begin(), c.members.starts.end() - 1);
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        c.members.items[next[c.components.of[s]]++] = s;
    }
    return c;
}

// One chain on its way to a solution.
class Solver {
 public:
    explicit Solver(const MarkovChain& chain)
        : chain_(chain),
          exits_(exit_rates(chain)),
          into_(jumps_into(chain)),
          classes_(classes_of(chain)),
          local_(chain.size(), 0) {}

    const Classes& classes() const { return classes_; }

    // The mean time that is spent in each state of the classes that are left, in seconds; and what
    // arrives in each bottom class, put on its members where it arrives.
    ChainSolution stays() {
        ChainSolution s;
        s.values = chain_.initial;  // first what comes in: probabilities
        for (std::uint32_t k = classes_.components.count; k-- > 0;) {
            const auto members = classes_.members.row(k);
            for (const std::uint32_t t : members) {
                for (const Jump& j : into_.row(t)) {
                    if (classes_.components.of[j.target] != k) {
                        s.values[t] += s.values[j.target] * j.rate;
                    }
                }
            }
            if (!classes_.bottoms[k]) {
                s.residual = std::max(s.residual, solve_transient(members, s.values));
            }
        }
        return s;
    }

    // Of a class that is never left: the share of time of each of its members, times `mass`.
    double solve_bottom(std::span<const std::uint32_t> members, double mass,
                        std::vector<double>& values) {
        if (members.size() == 1) {
            values[members[0]] = mass;
            return 0;
        }
        if (members.size() <= kMostEliminated) {
            eliminate(members, values);
        } else {
            for (const std::uint32_t t : members) {
                values[t] = 1.0 / static_cast<double>(members.size());
            }
            sweep(members, {}, values, true);
        }
        double sum = 0;
        for (const std::uint32_t t : members) {
            sum += values[t];
        }
        for (const std::uint32_t t : members) {
            values[t] *= mass / sum;
        }
        return error(members, {}, values);
    }

 private:
    // values: in what comes in, out how long the members are stayed in.
    double solve_transient(std::span<const std::uint32_t> members, std::vector<double>& values) {
        std::vector<double> source;
        double all = 0;
        for (const std::uint32_t t : members) {
            source.push_back(values[t]);
            all += values[t];
        }
        if (all == 0) {
            return 0;
        }
        if (members.size() == 1) {
            values[members[0]] /= exits_[members[0]];
            return 0;
        }
        if (members.size() <= kMostEliminated) {
            eliminate_transient(members, source, values);
        } else {
            sweep(members, source, values, false);
        }
        return error(members, source, values);
    }

    // Rates among the members as a dense matrix, row by row.
    std::vector<double> dense(std::span<const std::uint32_t> members) {
        const std::size_t n = members.size();
        for (std::size_t i = 0; i < n; ++i) {
            local_[members[i]] = static_cast<std::uint32_t>(i);
        }
        std::vector<double> a(n * n, 0);
        const std::uint32_t k = classes_.components.of[members[0]];
        for (std::size_t i = 0; i < n; ++i) {
            for (const Jump& j : chain_.jumps.row(members[i])) {
                if (j.target != members[i] && classes_.components.of[j.target] == k) {
                    a[i * n + local_[j.target]] += j.rate;
                }
            }
        }
        return a;
    }

    // State by state from the last is taken out of the chain; its jumps become those of the others.
    void eliminate(std::span<const std::uint32_t> members, std::vector<double>& values) {
        const std::size_t n = members.size();
        std::vector<double> a = dense(members);
        for (std::size_t m = n; m-- > 1;) {
            double out = 0;
            for (std::size_t j = 0; j < m; ++j) {
                out += a[m * n + j];
            }
            for (std::size_t i = 0; i < m; ++i) {
                const double share = a[i * n + m] /= out;
                for (std::size_t j = 0; share != 0 && j < m; ++j) {
                    a[i * n + j] += share * a[m * n + j];
                }
            }
        }
        values[members[0]] = 1;
        for (std::size_t m = 1; m < n; ++m) {
            double sum = 0;
            for (std::size_t i = 0; i < m; ++i) {
                sum += values[members[i]] * a[i * n + m];
            }
            values[members[m]] = sum;
        }
    }

    // The same with what comes in from elsewhere and what leaves to elsewhere; no subtraction
    // either, since the exits to elsewhere are kept apart.
    void eliminate_transient(std::span<const std::uint32_t> members, std::vector<double> source,
                             std::vector<double>& values) {
        const std::size_t n = members.size();
        std::vector<double> a = dense(members);
        std::vector<double> away(n), out(n);
        const std::uint32_t k = classes_.components.of[members[0]];
        for (std::size_t i = 0; i < n; ++i) {
            for (const Jump& j : chain_.jumps.row(members[i])) {
                away[i] += classes_.components.of[j.target] != k ? j.rate : 0;
            }
        }
        for (std::size_t m = n; m-- > 0;) {
            out[m] = away[m];
            for (std::size_t j = 0; j < m; ++j) {
                out[m] += a[m * n + j];
            }
            for (std::size_t i = 0; i < m; ++i) {
                const double share = a[i * n + m] / out[m];
                a[i * n + m] = share;
                for (std::size_t j = 0; share != 0 && j < m; ++j) {
                    a[i * n + j] += j != i ? share * a[m * n + j] : 0;
                }
                away[i] += share * away[m];
            }
            for (std::size_t j = 0; j < m; ++j) {  // who comes in at m goes on to j
                source[j] += source[m] * a[m * n + j] / out[m];
            }
        }
        for (std::size_t m = 0; m < n; ++m) {
            double stay = source[m] / out[m];
            for (std::size_t i = 0; i < m; ++i) {
                stay += values[members[i]] * a[i * n + m];
            }
            values[members[m]] = stay;
        }
    }

    // x[t] = (source[t] + sum of x[s] * rate(s to t)) / exit(t), over and over.
    void sweep(std::span<const std::uint32_t> members, std::span<const double> source,
               std::vector<double>& values, bool normalise) {
        const std::uint32_t k = classes_.components.of[members[0]];
        for (int n = 0; n < kMostSweeps; ++n) {
            double change = 0, largest = 0, sum = 0;
            for (std::size_t i = 0; i < members.size(); ++i) {
                const std::uint32_t t = members[i];
                double flow = source.empty() ? 0 : source[i];
                for (const Jump& j : into_.row(t)) {
                    if (classes_.components.of[j.target] == k) {
                        flow += values[j.target] * j.rate;
                    }
                }
                const double x = flow / exits_[t];
                change = std::max(change, std::abs(x - values[t]));
                largest = std::max(largest, x);
                values[t] = x;
                sum += x;
            }
            if (change <= kAtRest * largest) {
                return;
            }
            for (const std::uint32_t t : members) {
                values[t] /= normalise ? sum : 1;
            }
        }
    }

    double error(std::span<const std::uint32_t> members, std::span<const double> source,
                 const std::vector<double>& values) const {
        const std::uint32_t k = classes_.components.of[members[0]];
        double worst = 0, fastest = 0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            const std::uint32_t t = members[i];
            double flow = source.empty() ? 0 : source[i];
            for (const Jump& j : into_.row(t)) {
                if (classes_.components.of[j.target] == k) {
                    flow += values[j.target] * j.rate;
                }
            }
            worst = std::max(worst, std::abs(flow - values[t] * exits_[t]));
            fastest = std::max(fastest, exits_[t]);
        }
        return worst / std::max(fastest, std::numeric_limits<double>::min());
    }

    const MarkovChain& chain_;
    const std::vector<double> exits_;
    const net::Rows<Jump> into_;
    const Classes classes_;
    std::vector<std::uint32_t> local_;
};

// The goal is never left.
MarkovChain stopped_at(const MarkovChain& chain, const StateBits& goal) {
    MarkovChain stopped;
    stopped.initial = chain.initial;
    stopped.lasts = chain.lasts;
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        for (const Jump& j : chain.jumps.row(s)) {
            if (!goal[s]) {
                stopped.jumps.items.push_back(j);
            }
        }
        stopped.jumps.starts.push_back(static_cast<std::uint32_t>(stopped.jumps.items.size()));
    }
    return stopped;
}

// Of a chain in steps: who is where when, instant by instant.
ChainSolution at_tick(const MarkovChain& chain, std::int64_t until) {
    constexpr std::uint64_t kMostJumps = 100'000'000;
    ChainSolution solution{std::vector<double>(chain.size(), 0), 0};
    std::map<std::int64_t, std::map<std::uint32_t, double>> coming;
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        if (chain.initial[s] != 0) {
            coming[0][s] = chain.initial[s];
        }
    }
    std::uint64_t followed = 0;
    while (!coming.empty()) {
        const std::int64_t now = coming.begin()->first;
        const std::map<std::uint32_t, double> here = std::move(coming.begin()->second);
        coming.erase(coming.begin());
        for (const auto& [s, p] : here) {
            const auto jumps = chain.jumps.row(s);
            double all = 0;
            for (const Jump& j : jumps) {
                all += j.rate;
            }
            if (jumps.empty() || chain.lasts[s] > until - now) {
                solution.values[s] += p;
                continue;
            }
            for (const Jump& j : jumps) {
                coming[now + chain.lasts[s]][j.target] += p * (j.rate / all);
            }
            followed += jumps.size();
        }
        if (followed > kMostJumps) {
            solution.residual = 2;
            return solution;
        }
    }
    double sum = 0;
    for (const double x : solution.values) {
        sum += x;
    }
    solution.residual = std::abs(1 - sum);
    return solution;
}

// The probabilities of first .. first + size - 1 events of a Poisson process with this mean; what
// lies outside has less than 1e-13 of it.
struct Poisson {
    std::uint64_t first = 0;
    std::vector<double> weights;
};

Poisson poisson(double mean) {
    constexpr double kSmall = 1e-17;  // of the largest; summed over the width still below 1e-13
    const auto mode = static_cast<std::uint64_t>(mean);
    std::vector<double> down, up{1};
    double w = 1;
    for (std::uint64_t k = mode; k > 0 && w > kSmall; --k) {
        w *= static_cast<double>(k) / mean;
        down.push_back(w);
    }
    w = 1;
    for (std::uint64_t k = mode + 1; w > kSmall; ++k) {
        w *= mean / static_cast<double>(k);
        up.push_back(w);
    }
    Poisson p;
    p.first = mode - down.size();
    p.weights.assign(down.rbegin(), down.rend());
    p.weights.insert(p.weights.end(), up.begin(), up.end());
    double sum = 0;
    for (const double x : p.weights) {
        sum += x;
    }
    for (double& x : p.weights) {
        x /= sum;
    }
    return p;
}

}  // namespace

ChainSolution long_run(const MarkovChain& chain) {
    PUP_REQUIRE(chain.initial.size() == chain.size());
    Solver solver(chain);
    ChainSolution solution = solver.stays();
    const Classes& classes = solver.classes();
    for (std::uint32_t k = 0; k < classes.components.count; ++k) {
        const auto members = classes.members.row(k);
        double mass = 0;
        for (const std::uint32_t s : members) {
            mass += solution.values[s];
        }
        if (!classes.bottoms[k]) {
            for (const std::uint32_t s : members) {
                solution.values[s] = 0;
            }
        } else {
            solution.residual =
                std::max(solution.residual, solver.solve_bottom(members, mass, solution.values));
        }
    }
    return solution;
}

ChainSolution at_time(const MarkovChain& chain, double time_s) {
    PUP_REQUIRE(chain.initial.size() == chain.size());
    PUP_REQUIRE(time_s >= 0 && std::isfinite(time_s));
    if (!chain.lasts.empty()) {
        PUP_REQUIRE(chain.lasts.size() == chain.size());
        return at_tick(chain, nearest_tick(time_s).ticks);
    }
    const std::vector<double> exits = exit_rates(chain);
    const double fastest = exits.empty() ? 0 : *std::max_element(exits.begin(), exits.end());
    ChainSolution solution{chain.initial, 0};
    if (fastest == 0 || time_s == 0) {
        return solution;
    }
    const Poisson steps = poisson(fastest * time_s);
    std::vector<double> now = chain.initial, next(chain.size());
    std::fill(solution.values.begin(), solution.values.end(), 0);
    double left = 1;
    for (std::uint64_t k = 0; k < steps.first + steps.weights.size(); ++k) {
        if (k >= steps.first) {
            const double w = steps.weights[k - steps.first];
            left -= w;
            for (std::uint32_t s = 0; s < chain.size(); ++s) {
                solution.values[s] += w * now[s];
            }
        }
        std::fill(next.begin(), next.end(), 0);
        double change = 0;
        for (std::uint32_t s = 0; s < chain.size(); ++s) {
            if (now[s] == 0) {
                continue;
            }
            next[s] += now[s] * (1 - exits[s] / fastest);
            for (const Jump& j : chain.jumps.row(s)) {
                if (j.target != s) {
                    next[j.target] += now[s] * (j.rate / fastest);
                }
            }
        }
        for (std::uint32_t s = 0; s < chain.size(); ++s) {
            change = std::max(change, std::abs(next[s] - now[s]));
        }
        now.swap(next);
        const std::uint64_t last = steps.first + steps.weights.size();
        if (change * static_cast<double>(last - k) <= 1e-14) {  // the further steps are alike
            for (std::uint32_t s = 0; s < chain.size(); ++s) {
                solution.values[s] += left * now[s];
            }
            break;
        }
    }
    double sum = 0;
    for (const double x : solution.values) {
        sum += x;
    }
    solution.residual = std::abs(1 - sum);
    return solution;
}

ChainSolution reached_by(const MarkovChain& chain, const StateBits& goal, double time_s) {
    PUP_REQUIRE(goal.size() == chain.size());
    const ChainSolution there = at_time(stopped_at(chain, goal), time_s);
    ChainSolution solution{{0}, there.residual};
    goal.for_each([&](std::uint32_t s) { solution.values[0] += there.values[s]; });
    return solution;
}

ChainSolution ever_reached(const MarkovChain& chain, const StateBits& goal) {
    PUP_REQUIRE(goal.size() == chain.size());
    const ChainSolution there = long_run(stopped_at(chain, goal));
    ChainSolution solution{{0}, there.residual};
    goal.for_each([&](std::uint32_t s) { solution.values[0] += there.values[s]; });
    return solution;
}

ChainSolution mean_time_to(const MarkovChain& chain, const StateBits& goal) {
    PUP_REQUIRE(goal.size() == chain.size());
    const MarkovChain stopped = stopped_at(chain, goal);
    Solver solver(stopped);
    const ChainSolution stays = solver.stays();
    ChainSolution solution{{0}, stays.residual};
    const Classes& classes = solver.classes();
    for (std::uint32_t s = 0; s < chain.size(); ++s) {
        if (!classes.bottoms[classes.components.of[s]]) {
            solution.values[0] += stays.values[s];
        } else if (!goal[s] && stays.values[s] > 0) {
            solution.values[0] = std::numeric_limits<double>::infinity();
            break;
        }
    }
    return solution;
}

}  // namespace puppetri::proof
