// SPDX-License-Identifier: MIT
// The generalized stochastic nets that PIPE ships, solved as chains, by a program that knows
// nothing of the kernel (markings, immediate ones as states of no duration), and by long runs of
// the player.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/markov_net.h"
#include "puppetri/run/player.h"
#include "shared_nets.h"

namespace puppetri::io {
namespace {

using testing::shared_nets;
using Marking = std::vector<std::int64_t>;

// All markings, tangible and vanishing alike, as one chain in steps; a share of time is the share
// of visits times the mean stay there.
class Direct {
 public:
    static constexpr std::size_t kMost = 3000;

    explicit Direct(const net::NetDraft& draft) : draft_(draft) {
        Marking first;
        for (const net::PlaceDraft& p : draft.places) {
            std::int64_t n = 0;
            for (const net::InitialToken& t : p.tokens) {
                n += t.count;
            }
            first.push_back(n);
        }
        number(first);
        for (std::size_t i = 0; i < markings_.size() && markings_.size() <= kMost; ++i) {
            expand(i);
        }
    }
    bool whole() const { return markings_.size() <= kMost; }
    const Marking& first() const { return markings_[0]; }

    std::vector<double> mean_tokens() const {
        std::vector<double> now(markings_.size(), 0);
        now[0] = 1;
        for (int round = 0; round < 200'000; ++round) {
            std::vector<double> next(now.size(), 0);
            for (std::size_t i = 0; i < now.size(); ++i) {
                next[i] += now[i] / 2;  // lazily, so that what goes round settles
                for (const auto& [to, p] : jumps_[i]) {
                    next[to] += now[i] / 2 * p;
                }
                next[i] += jumps_[i].empty() ? now[i] / 2 : 0;
            }
            double change = 0;
            for (std::size_t i = 0; i < now.size(); ++i) {
                change = std::max(change, std::abs(next[i] - now[i]));
            }
            now = std::move(next);
            if (change < 1e-13) {
                break;
            }
        }
        double dead = 0, all = 0;
        for (std::size_t i = 0; i < now.size(); ++i) {
            dead += jumps_[i].empty() ? now[i] : 0;
        }
        std::vector<double> mean(draft_.places.size(), 0);
        for (std::size_t i = 0; i < now.size(); ++i) {
            const double weight =
                dead > 1e-6 ? (jumps_[i].empty() ? now[i] : 0) : now[i] * stay_[i];
            all += weight;
            for (std::size_t p = 0; p < mean.size(); ++p) {
                mean[p] += weight * static_cast<double>(markings_[i][p]);
            }
        }
        for (double& m : mean) {
            m /= all;
        }
        return mean;
    }

    // What a firing does to a marking.
    static void fire(const net::TransitionDraft& t, Marking& m) {
        for (const net::ArcDraft& a : t.inputs) {
            m[a.place.value] -= a.kind == net::ArcKind::kTake ? a.weight : 0;
        }
        for (const net::OutputDraft& o : t.outputs) {
            m[o.place.value] += o.weight;
        }
    }

 private:
    // How many times side by side; 0: not at all.
    std::int64_t enabled(const net::TransitionDraft& t, const Marking& m) const {
        std::map<std::uint32_t, std::int64_t> takes;
        std::int64_t times = 1'000'000;
        for (const net::ArcDraft& a : t.inputs) {
            if (a.kind == net::ArcKind::kUnless) {
                times = m[a.place.value] >= a.weight ? 0 : times;
            } else {
                takes[a.place.value] += a.weight;
            }
        }
        for (const auto& [place, n] : takes) {
            times = std::min(times, m[place] / n);
        }
        Marking after = m;
        fire(t, after);
        for (std::size_t p = 0; p < m.size(); ++p) {
            const auto& room = draft_.places[p].capacity;
            times = room && after[p] > m[p] && after[p] > *room ? 0 : times;
        }
        return times;
    }

    std::size_t number(const Marking& m) {
        const auto [found, fresh] = numbers_.emplace(m, markings_.size());
        if (fresh) {
            markings_.push_back(m);
        }
        return found->second;
    }

    void expand(std::size_t i) {
        const Marking m = markings_[i];
        std::int64_t best = -1;
        for (const net::TransitionDraft& t : draft_.transitions) {
            if (!t.delay && enabled(t, m) > 0) {
                best = std::max(best, t.priority);
            }
        }
        std::map<std::size_t, double> weights;
        double all = 0;
        for (const net::TransitionDraft& t : draft_.transitions) {
            const std::int64_t times = enabled(t, m);
            if (times == 0 || (best >= 0 && (t.delay || t.priority < best))) {
                continue;
            }
            double weight = t.odds ? real_of_value(t.odds->literal_value()) : 1;
            if (t.delay) {
                const bool many = t.delay->servers == net::DelayDraft::kInfiniteServers;
                weight = (many ? static_cast<double>(times) : 1.0) /
                         real_of_value(t.delay->duration.parameters[0].literal_value());
            }
            Marking after = m;
            fire(t, after);
            weights[number(after)] += weight;
            all += weight;
        }
        stay_.push_back(best >= 0 || all == 0 ? 0 : 1 / all);
        jumps_.emplace_back();
        for (const auto& [to, w] : weights) {
            jumps_.back().emplace_back(to, w / all);
        }
    }

    const net::NetDraft& draft_;
    std::map<Marking, std::size_t> numbers_;
    std::vector<Marking> markings_;
    std::vector<std::vector<std::pair<std::size_t, double>>> jumps_;
    std::vector<double> stay_;
};

// Mean tokens over many firings, in batches for their error; markings are kept apart from the
// player's, by the arcs of the draft.
struct Watching final : run::LogSink {
    const net::NetDraft* draft = nullptr;
    std::vector<std::size_t> of;  // transitions of the draft, by transition of the net
    Marking marking;
    std::int64_t last = 0;
    std::vector<double> area;
    void fired(SimTime at, net::TransitionIndex t) override {
        for (std::size_t p = 0; p < marking.size(); ++p) {
            area[p] += static_cast<double>(marking[p]) * SimTime{at.ticks - last}.seconds();
        }
        last = at.ticks;
        Direct::fire(draft->transitions[of[t.value]], marking);
    }
};

TEST_CASE("PIPE's stochastic nets: solved, solved by hand and simulated, all agree [oracle]") {
    int compared = 0;
    for (const std::string& path : shared_nets("pipe", "")) {
        CAPTURE(path);
        const Checked<NetFile> file = load_net(path);
        REQUIRE(file.has_value());
        const net::NetDraft& draft = file->draft;
        const auto net = net::compile(draft);
        REQUIRE(net.has_value());
        const Direct direct(draft);
        if (net->paced() || !direct.whole()) {
            MESSAGE("not compared: "
                    << std::filesystem::path(path).filename().string()
                    << std::string(net->paced() ? ", no time" : ", many markings"));
            continue;
        }
        const proof::Budget budget;
        const proof::MarkovNet markov =
            proof::markov_net({*net, {}, {}, 0, kTicksPerSecond, budget});
        REQUIRE(markov.available());
        const proof::ChainSolution solved = proof::long_run(markov.chain);
        CHECK(solved.residual < 1e-8);
        const std::vector<double> wanted = direct.mean_tokens();

        Watching watch;
        watch.draft = &draft;
        watch.of.resize(net->transition_count());
        for (std::size_t t = 0; t < draft.transitions.size(); ++t) {
            watch.of[net->find_transition(draft.transitions[t].path).value] = t;
        }
        watch.marking = direct.first();
        run::Player player(*net, {.seed = 11, .sink = &watch});
        constexpr int kBatches = 30;
        std::vector<double> sum(wanted.size(), 0), squares(wanted.size(), 0);
        bool ended = false;
        for (int b = 0; b <= kBatches && !ended; ++b) {
            const std::int64_t from = watch.last;
            watch.area.assign(wanted.size(), 0);
            ended = player.run({.firings = static_cast<std::uint64_t>(b + 1) * 4000}) ==
                    run::Stop::kDead;
            for (std::size_t p = 0; p < wanted.size() && b > 0; ++p) {  // the first warms up
                const double mean = watch.area[p] / SimTime{watch.last - from}.seconds();
                sum[p] += mean;
                squares[p] += mean * mean;
            }
        }
        for (std::size_t p = 0; p < wanted.size(); ++p) {
            CAPTURE(draft.places[p].path);
            const net::PlaceIndex place = net->find_place(draft.places[p].path);
            CHECK(markov.mean_tokens(solved.values, place) ==
                  doctest::Approx(wanted[p]).epsilon(1e-6));
            if (!ended) {
                const double mean = sum[p] / kBatches;
                const double variance =
                    std::fmax(0, squares[p] / kBatches - mean * mean) / (kBatches - 1);
                CHECK(std::abs(mean - wanted[p]) <= 5 * std::sqrt(variance) + 1e-9);
            }
        }
        ++compared;
    }
    if (!shared_nets("pipe", "").empty()) {
        CHECK(compared >= 5);
    }
}

}  // namespace
}  // namespace puppetri::io
