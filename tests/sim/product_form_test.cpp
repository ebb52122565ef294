// SPDX-License-Identifier: MIT
// Queueing networks against closed forms and against convolution.
#include "puppetri/sim/product_form.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace puppetri::sim {
namespace {

// All ways to put customers into stations, weighted by the product form: the definition itself.
// Source  W. J. Gordon, G. F. Newell, "Closed queuing systems with exponential servers",
//         Operations Research 15 (1967).
std::vector<double> by_definition(const std::vector<Station>& stations,
                                  const std::vector<double>& visits, std::uint32_t customers) {
    std::vector<double> mean(stations.size(), 0);
    std::vector<std::uint32_t> at(stations.size(), 0);
    double all = 0;
    const std::function<void(std::size_t, std::uint32_t, double)> place =
        [&](std::size_t i, std::uint32_t left, double weight) {
            if (i == stations.size()) {
                if (left == 0) {
                    all += weight;
                    for (std::size_t k = 0; k < at.size(); ++k) {
                        mean[k] += weight * at[k];
                    }
                }
                return;
            }
            double w = weight;
            for (std::uint32_t k = 0; k <= left; ++k) {
                at[i] = k;
                place(i + 1, left - k, w);
                const std::uint32_t busy = stations[i].servers == Station::kDelay
                                               ? k + 1
                                               : std::min(k + 1, stations[i].servers);
                w *= visits[i] * stations[i].service_mean_s / busy;
            }
        };
    place(0, customers, 1);
    for (double& m : mean) {
        m /= all;
    }
    return mean;
}

}  // namespace

TEST_CASE("two queues in a row are each M/M/1") {
    const std::vector<Station> stations{{1, 1}, {0.5, 1}};
    const std::vector<double> arrivals{0.8, 0}, routing{0, 1, 0, 0};
    const auto loads = open_network(stations, arrivals, routing);
    REQUIRE(loads.has_value());
    CHECK((*loads)[0].customers == doctest::Approx(0.8 / 0.2));
    CHECK((*loads)[1].customers == doctest::Approx(0.4 / 0.6));
    CHECK((*loads)[1].throughput == doctest::Approx(0.8));
    CHECK((*loads)[0].stay_s == doctest::Approx(1 / (1 - 0.8)));
}

TEST_CASE("feedback multiplies the visits") {
    // With probability 0.25 again: 4/3 visits
    const std::vector<Station> stations{{1, 2}};
    const auto loads = open_network(stations, std::vector<double>{0.9}, std::vector<double>{0.25});
    REQUIRE(loads.has_value());
    CHECK((*loads)[0].throughput == doctest::Approx(1.2));
    CHECK((*loads)[0].utilisation == doctest::Approx(0.6));
    // M/M/2: L = 2 rho / (1 - rho^2)
    CHECK((*loads)[0].customers == doctest::Approx(1.2 / (1 - 0.36)));
}

TEST_CASE("open networks that cannot be are told by their station") {
    const std::vector<Station> stations{{1, 1}, {1, 1}};
    const auto code = [&](std::vector<double> arrivals, std::vector<double> routing) {
        const auto loads = open_network(stations, arrivals, routing);
        REQUIRE_FALSE(loads.has_value());
        return loads.error()[0].code + " " + loads.error()[0].element;
    };
    CHECK(code({1.5, 0}, {0, 0, 0, 0}) == "grows-without-bound station 1");
    CHECK(code({0.5, 0}, {0, 1, 1, 0}) == "never-leaves station 1");
    CHECK(code({0.5, 0}, {0, 1.5, 0, 0}) == "wrong-routing station 1");
    CHECK(code({0.5, 0}, {0, 0.5, -0.5, 0}) == "wrong-routing station 2");
}

TEST_CASE("closed networks are what the product form says") {
    const std::vector<double> routing{0.1, 0.6, 0.3, 0.5, 0, 0.5, 1, 0, 0};
    // v = v R with v1 = 1: v2 = 0.6, v3 = 0.3 + 0.3 = 0.6
    const std::vector<double> visits{1, 0.6, 0.6};
    for (const std::vector<Station>& stations :
         {std::vector<Station>{{1, 1}, {2, 1}, {0.5, 1}},
          std::vector<Station>{{1, 1}, {2, 2}, {0.5, 1}},
          std::vector<Station>{{1, Station::kDelay}, {2, 3}, {3, 2}}}) {
        for (const std::uint32_t customers : {1u, 2u, 5u, 9u}) {
            const auto loads = closed_network(stations, customers, routing);
            REQUIRE(loads.has_value());
            const std::vector<double> mean = by_definition(stations, visits, customers);
            double sum = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK((*loads)[i].customers == doctest::Approx(mean[i]).epsilon(1e-9));
                CHECK((*loads)[i].throughput / (*loads)[0].throughput ==
                      doctest::Approx(visits[i]));
                sum += (*loads)[i].customers;
            }
            CHECK(sum == doctest::Approx(customers));
        }
    }
}

TEST_CASE("closed networks that fall apart are refused") {
    const std::vector<Station> stations{{1, 1}, {1, 1}};
    const auto loads = closed_network(stations, 3, std::vector<double>{1, 0, 0, 1});
    REQUIRE_FALSE(loads.has_value());
    CHECK(loads.error()[0].code == "falls-apart");
}

}  // namespace puppetri::sim
