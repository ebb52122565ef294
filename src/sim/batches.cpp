// SPDX-License-Identifier: MIT
#include "puppetri/sim/batches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "puppetri/base/require.h"
#include "puppetri/sim/meter.h"
#include "puppetri/sim/tally.h"

namespace puppetri::sim {
namespace {

// A run that can be asked for one stretch after the other.
class Stretches {
 public:
    Stretches(const net::Net& net, std::span<const Metric> metrics,
              const NetExperiment::Options& options, std::uint64_t seed, SimTime from)
        : meter_(net, metrics, {.from = from}), options_(options) {
        run::Options o;
        o.seed = replication(seed, 0, false).seed;
        o.beat = options.beat;
        o.observer = &meter_;
        if (options.host != nullptr) {
            host_ = options.host(options.context);
            o.host = host_.get();
            if (options.coupled != nullptr) {
                o.coupled = options.coupled(*host_);
            }
        }
        player_.emplace(net, o);
    }

    bool to(SimTime end, std::span<double> values, Diagnostic& fault) {
        const run::Stop stop = player_->run({.until = end});
        if (stop == run::Stop::kFault) {
            fault = player_->fault();
            return false;
        }
        if (meter_.fault()) {
            fault = *meter_.fault();
            return false;
        }
        meter_.finish(end, values);
        if (meter_.fault()) {  // of what goes on beside the net
            fault = *meter_.fault();
            return false;
        }
        return true;
    }

 private:
    Meter meter_;
    const NetExperiment::Options& options_;
    std::unique_ptr<net::MovementHost> host_;
    std::optional<run::Player> player_;
};

class BatchRunner final : public Runner {
 public:
    BatchRunner(const net::Net& net, std::span<const Metric> metrics,
                const NetExperiment::Options& options, SimTime length, std::uint64_t seed)
        : net_(net), metrics_(metrics), options_(options), length_(length), seed_(seed) {}

    bool run(const Replication& replication, std::span<double> values, Diagnostic& fault) override {
        if (!stretches_ || replication.number < next_) {
            stretches_ =
                std::make_unique<Stretches>(net_, metrics_, options_, seed_, options_.warm_up);
            next_ = 0;
        }
        // Those that a journal has already are played once more, up to where it goes on
        while (next_ <= replication.number) {
            std::int64_t ticks = 0;
            if (__builtin_mul_overflow(length_.ticks, static_cast<std::int64_t>(next_ + 1),
                                       &ticks) ||
                __builtin_add_overflow(ticks, options_.warm_up.ticks, &ticks)) {
                fault.code = "time-overflow";
                fault.message = "the batches go beyond the end of time";
                fault.remedy = "take shorter batches";
                return false;
            }
            if (!stretches_->to({ticks}, values, fault)) {
                return false;
            }
            ++next_;
        }
        return true;
    }

 private:
    const net::Net& net_;
    std::span<const Metric> metrics_;
    const NetExperiment::Options& options_;
    SimTime length_;
    std::uint64_t seed_;
    std::uint64_t next_ = 0;
    std::unique_ptr<Stretches> stretches_;
};

bool whole(const Series& series, std::size_t column) {
    for (std::size_t i = 0; i < series.count; ++i) {
        if (std::isnan(series.at(i, column))) {
            return false;
        }
    }
    return true;
}

// Means of neighbours, two by two.
Series halved(const Series& series) {
    Series out{series.width, series.count / 2, {}};
    for (std::size_t i = 0; i < out.count; ++i) {
        for (std::size_t c = 0; c < series.width; ++c) {
            out.values.push_back((series.at(2 * i, c) + series.at(2 * i + 1, c)) / 2);
        }
    }
    return out;
}

}  // namespace

std::unique_ptr<Runner> BatchExperiment::runner() const {
    return std::make_unique<BatchRunner>(*net_, metrics_, options_, length_, seed_);
}

double lag_one(const Series& series, std::size_t column) {
    Tally tally;
    for (std::size_t i = 0; i < series.count; ++i) {
        tally.add(series.at(i, column));
    }
    const double squares = tally.variance() * static_cast<double>(series.count - 1);
    double products = 0;
    for (std::size_t i = 0; i + 1 < series.count; ++i) {
        products +=
            (series.at(i, column) - tally.mean()) * (series.at(i + 1, column) - tally.mean());
    }
    return squares > 0 ? products / squares : 0;
}

std::uint32_t batches_apart(const Series& series) {
    constexpr std::size_t kFewest = 16, kTogether = 8;
    constexpr double kBound = 1.645;
    Series s = series;
    for (; s.count >= kFewest * kTogether; s = halved(s)) {
        bool apart = true;
        for (std::size_t c = 0; c < s.width; ++c) {
            apart = apart && (!whole(s, c) ||
                              lag_one(s, c) < kBound / std::sqrt(static_cast<double>(s.count)));
        }
        if (apart) {
            return static_cast<std::uint32_t>(s.count / kTogether);
        }
    }
    return 0;
}

std::optional<std::size_t> settled_after(const Series& series) {
    std::size_t after = 0;
    for (std::size_t c = 0; c < series.width; ++c) {
        if (!whole(series, c)) {
            continue;
        }
        // Sums from the end, so that each d costs a step
        double best = std::numeric_limits<double>::infinity();
        std::size_t best_d = 0;
        Tally tail;
        for (std::size_t d = series.count; d-- > 0;) {
            tail.add(series.at(d, c));
            const auto n = static_cast<double>(tail.count());
            const double error = tail.variance() * (n - 1) / (n * n);
            // The last few are alike by chance
            if (tail.count() >= 5 && error <= best) {
                best = error;
                best_d = d;
            }
        }
        if (best_d > series.count / 2) {
            return std::nullopt;
        }
        after = std::max(after, best_d);
    }
    return after;
}

bool play_series(const net::Net& net, std::span<const Metric> metrics,
                 const NetExperiment::Options& options, std::uint64_t seed, SimTime from,
                 SimTime until, std::size_t rows, Series& out, Diagnostic& fault) {
    PUP_REQUIRE(rows != 0 && until > from);
    Stretches stretches(net, metrics, options, seed, from);
    out = {metrics.size(), rows, std::vector<double>(rows * metrics.size())};
    const double length = static_cast<double>(until.ticks - from.ticks) / static_cast<double>(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const SimTime end =
            i + 1 == rows ? until
                          : SimTime{from.ticks +
                                    static_cast<std::int64_t>(length * static_cast<double>(i + 1))};
        if (!stretches.to(end, std::span(out.values).subspan(i * out.width, out.width), fault)) {
            return false;
        }
    }
    return true;
}

Series mean_of(std::span<const Series> series) {
    PUP_REQUIRE(!series.empty());
    Series out = series[0];
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        for (std::size_t k = 1; k < series.size(); ++k) {
            out.values[i] += series[k].values[i];
        }
        out.values[i] /= static_cast<double>(series.size());
    }
    return out;
}

}  // namespace puppetri::sim
