// SPDX-License-Identifier: MIT
// The clock and the limits of a method. Elapsed time decides only when a method gives up, never
// what it finds: an answer that was found does not depend on the machine.
#include "puppetri/proof/budget.h"

#include <chrono>  // allowed: budgets are in seconds of the world, not of the model

namespace puppetri::proof {

namespace {

constexpr double kTellEvery_s = 0.1;

double now_s() {
    using Clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

const char* name_of(Ended ended) {
    switch (ended) {
        case Ended::kDone:
            return "done";
        case Ended::kTime:
            return "out of time";
        case Ended::kMemory:
            return "out of memory";
        case Ended::kStates:
            return "too many states";
        case Ended::kCancelled:
            return "cancelled";
        case Ended::kUnbounded:
            return "unbounded";
    }
    return "";
}

Meter::Meter(const Budget& budget, const char* method)
    : budget_(budget), method_(method), started_(now_s()), told_(started_) {}

double Meter::seconds() const { return now_s() - started_; }

Ended Meter::look(std::uint64_t states, std::uint64_t edges, std::uint64_t waiting,
                  std::uint64_t bytes) {
    const double now = now_s();
    if (budget_.progress != nullptr && now - told_ >= kTellEvery_s) {
        told_ = now;
        budget_.progress(budget_.context, {method_, states, edges, waiting, bytes, now - started_});
    }
    if (budget_.cancelled != nullptr && budget_.cancelled->load(std::memory_order_relaxed)) {
        return Ended::kCancelled;
    }
    if (states > budget_.states) {
        return Ended::kStates;
    }
    if (bytes > budget_.bytes) {
        return Ended::kMemory;
    }
    return now - started_ >= budget_.seconds ? Ended::kTime : Ended::kDone;
}

}  // namespace puppetri::proof
