// SPDX-License-Identifier: MIT
// Traffic equations by Eigen; then station by station.
#include "puppetri/sim/product_form.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "puppetri/base/require.h"

namespace puppetri::sim {
namespace {

constexpr double kRounding = 1e-9;  // of sums of probabilities

Diagnostics wrong(const char* code, std::string element, std::string message, std::string remedy) {
    Diagnostic d;
    d.code = code;
    d.element = std::move(element);
    d.message = std::move(message);
    d.remedy = std::move(remedy);
    return {std::move(d)};
}

std::string station(std::size_t i) { return "station " + std::to_string(i + 1); }

std::optional<Diagnostics> check_rows(std::size_t n, std::span<const double> routing, bool closed) {
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        bool negative = false;
        for (std::size_t j = 0; j < n; ++j) {
            sum += routing[i * n + j];
            negative = negative || !(routing[i * n + j] >= 0);
        }
        if (negative || !(sum <= 1 + kRounding) || (closed && sum < 1 - kRounding)) {
            return wrong("wrong-routing", station(i),
                         "its probabilities sum to " + std::to_string(sum) +
                             (negative ? ", and one is negative" : ""),
                         closed ? "make them sum to 1" : "make them sum to at most 1");
        }
    }
    return std::nullopt;
}

// Which stations are reached from where `from` says yes, along positive probabilities.
std::vector<bool> spread(std::size_t n, std::span<const double> routing, std::vector<bool> from,
                         bool backwards) {
    for (bool more = true; more;) {
        more = false;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                const std::size_t a = backwards ? j : i, b = backwards ? i : j;
                if (from[a] && !from[b] && routing[i * n + j] > 0) {
                    from[b] = more = true;
                }
            }
        }
    }
    return from;
}

// M/M/c with this offered load below c: mean number, waiting or in service. Erlang's C by the
// stable recursion of B.
double mean_in_queue(double load, std::uint32_t servers) {
    double b = 1;
    for (std::uint32_t k = 1; k <= servers; ++k) {
        b = load * b / (k + load * b);
    }
    const double rho = load / servers;
    const double waits = b / (1 - rho * (1 - b));
    return load + waits * rho / (1 - rho);
}

}  // namespace

Checked<std::vector<StationLoad>> open_network(std::span<const Station> stations,
                                               std::span<const double> arrivals_per_s,
                                               std::span<const double> routing) {
    const std::size_t n = stations.size();
    PUP_REQUIRE(arrivals_per_s.size() == n && routing.size() == n * n);
    if (auto bad = check_rows(n, routing, false)) {
        return Unexpected(std::move(*bad));
    }
    std::vector<bool> out(n), in(n);
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            sum += routing[i * n + j];
        }
        out[i] = sum < 1 - kRounding;
        in[i] = arrivals_per_s[i] > 0;
    }
    const std::vector<bool> leaves = spread(n, routing, out, true),
                            visited = spread(n, routing, in, false);
    for (std::size_t i = 0; i < n; ++i) {
        if (visited[i] && !leaves[i]) {
            return Unexpected(wrong("never-leaves", station(i),
                                    "who comes here never leaves the network",
                                    "let some of its customers leave"));
        }
    }
    // arrivals at i = from outside + from all j; of stations that nobody visits nothing is asked
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd traffic = Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd outside = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < n; ++i) {
        outside(static_cast<Eigen::Index>(i)) = arrivals_per_s[i];
        for (std::size_t j = 0; visited[i] && j < n; ++j) {
            traffic(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) -=
                routing[i * n + j];
        }
    }
    const Eigen::VectorXd rates = traffic.partialPivLu().solve(outside);
    std::vector<StationLoad> loads(n);
    for (std::size_t i = 0; i < n; ++i) {
        StationLoad& l = loads[i];
        l.throughput = rates(static_cast<Eigen::Index>(i));
        const double load = l.throughput * stations[i].service_mean_s;
        if (stations[i].servers == Station::kDelay) {
            l.utilisation = l.customers = load;
        } else {
            l.utilisation = load / stations[i].servers;
            if (!(l.utilisation < 1)) {
                return Unexpected(wrong("grows-without-bound", station(i),
                                        "more customers come than it can serve: its load is " +
                                            std::to_string(l.utilisation),
                                        "give it more servers or a shorter service; with a horizon "
                                        "a simulation still says how fast it grows"));
            }
            l.customers = mean_in_queue(load, stations[i].servers);
        }
        l.stay_s = l.throughput > 0 ? l.customers / l.throughput : 0;
    }
    return loads;
}

Checked<std::vector<StationLoad>> closed_network(std::span<const Station> stations,
                                                 std::uint32_t customers,
                                                 std::span<const double> routing) {
    const std::size_t n = stations.size();
    PUP_REQUIRE(routing.size() == n * n && n != 0);
    if (auto bad = check_rows(n, routing, true)) {
        return Unexpected(std::move(*bad));
    }
    std::vector<bool> first(n, false);
    first[0] = true;
    const std::vector<bool> there = spread(n, routing, first, false),
                            back = spread(n, routing, first, true);
    for (std::size_t i = 0; i < n; ++i) {
        if (!there[i] || !back[i]) {
            return Unexpected(wrong("falls-apart", station(i),
                                    "customers do not go from the first station to it and back",
                                    "connect it, or solve the parts one by one"));
        }
    }
    // Visits per visit of the first station
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd balance = Eigen::MatrixXd::Identity(size, size);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            balance(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) -=
                routing[i * n + j];
        }
    }
    balance.row(0).setZero();
    balance(0, 0) = 1;
    Eigen::VectorXd one = Eigen::VectorXd::Zero(size);
    one(0) = 1;
    const Eigen::VectorXd visits = balance.partialPivLu().solve(one);

    // marginal[i][k]: probability of k customers at i, with the customers so far
    std::vector<StationLoad> loads(n);
    std::vector<std::vector<double>> marginal(n, std::vector<double>(customers + 1, 0));
    for (std::vector<double>& m : marginal) {
        m[0] = 1;
    }
    const auto speed = [&](std::size_t i, std::uint32_t k) {
        return static_cast<double>(
            stations[i].servers == Station::kDelay ? k : std::min(k, stations[i].servers));
    };
    for (std::uint32_t c = 1; c <= customers; ++c) {
        double round = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double s = stations[i].service_mean_s;
            if (stations[i].servers == Station::kDelay) {
                loads[i].stay_s = s;
            } else if (stations[i].servers == 1) {  // who comes sees who is there without him
                loads[i].stay_s = s * (1 + loads[i].customers);
            } else {
                loads[i].stay_s = 0;
                for (std::uint32_t k = 1; k <= c; ++k) {
                    loads[i].stay_s += k * s / speed(i, k) * marginal[i][k - 1];
                }
            }
            round += visits(static_cast<Eigen::Index>(i)) * loads[i].stay_s;
        }
        for (std::size_t i = 0; i < n; ++i) {
            StationLoad& l = loads[i];
            const double s = stations[i].service_mean_s;
            l.throughput = c * visits(static_cast<Eigen::Index>(i)) / round;
            l.customers = l.throughput * l.stay_s;
            l.utilisation = l.throughput * s /
                            (stations[i].servers == Station::kDelay ? 1 : stations[i].servers);
            if (stations[i].servers > 1) {
                std::vector<double>& m = marginal[i];
                double sum = 0;
                for (std::uint32_t k = c; k >= 1; --k) {
                    m[k] = l.throughput * s / speed(i, k) * m[k - 1];
                    sum += m[k];
                }
                m[0] = std::max(0.0, 1 - sum);
            }
        }
    }
    return loads;
}

}  // namespace puppetri::sim
