// SPDX-License-Identifier: MIT
// The models that are measured, as drafts of nets.
#pragma once
#include <cstdint>
#include <string>

#include "puppetri/net/draft.h"

namespace puppetri::bench {

inline constexpr std::int64_t kMillisecond = kTicksPerMillisecond;

// The eating phases of every philosopher, in ticks.
inline constexpr std::int64_t kPhilosopherPhases[3] = {20 * kMillisecond, 8 * kMillisecond,
                                                       8 * kMillisecond};
inline constexpr double kHoldMean_s = 1;
inline constexpr double kArrivalMean_s = 1;
inline constexpr double kServiceMean_s = 0.8;

// Fishwick and Porr 1991, figures 3 and 4: 5 n places, 4 n transitions; forks and philosophers
// alternate in p0 .. p(2n-1), then three eating phases of n places each, on timed places.
net::NetDraft philosophers(std::uint32_t n);
// n tokens that stay for an exponential time in one place; each firing takes one and gives it back
// (the hold model of J. Vaucher, P. Duval, CACM 18 (1975), for queues of pending events).
net::NetDraft hold(std::uint32_t n);
// One queue, one server, Poisson arrivals: two transitions with exponential delays.
net::NetDraft mm1();
// The same with customers that have a number each, and three measures: the mean number of them, the
// mean and the longest time of their stay.
net::NetDraft mm1_customers();
// A barber shop's day: Poisson arrivals every 10 min, four chairs to wait on (who finds none goes
// away), one barber, haircuts of 5 to 15 min.
net::NetDraft barber_day();

}  // namespace puppetri::bench
