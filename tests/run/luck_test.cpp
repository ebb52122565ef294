// SPDX-License-Identifier: MIT
// The law of ties and of queues: frequencies against exact probabilities, a mean against its closed
// form, and that unrelated parts of a net change nobody's luck. Seeds are fixed; the bounds are
// those of the named tests.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/run/player.h"

using namespace puppetri;
using namespace puppetri::net;

namespace {

class Names final : public run::LogSink {
 public:
    explicit Names(const Net& net) : net_(&net) {}
    void fired(SimTime at, TransitionIndex t) override {
        names.emplace_back(net_->transition(t).path);
        times.push_back(at);
    }
    std::vector<std::string> names;
    std::vector<SimTime> times;

 private:
    const Net* net_;
};

PlaceIndex add_place(NetDraft& net, std::string path, std::uint32_t tokens = 0) {
    PlaceDraft p;
    p.path = std::move(path);
    if (tokens != 0) {
        p.tokens.push_back({.count = tokens, .ready = false, .attributes = {}});
    }
    net.places.push_back(std::move(p));
    return PlaceIndex{static_cast<std::uint32_t>(net.places.size()) - 1};
}

TransitionDraft& add_transition(NetDraft& net, std::string path, std::vector<PlaceIndex> from,
                                std::vector<PlaceIndex> to) {
    TransitionDraft t;
    t.path = std::move(path);
    for (const PlaceIndex p : from) {
        ArcDraft arc;
        arc.place = p;
        t.inputs.push_back(std::move(arc));
    }
    for (const PlaceIndex p : to) {
        OutputDraft out;
        out.place = p;
        t.outputs.push_back(std::move(out));
    }
    net.transitions.push_back(std::move(t));
    return net.transitions.back();
}

Net compiled(const NetDraft& draft) {
    Checked<Net> net = compile(draft);
    REQUIRE(net.has_value());
    return std::move(net).value();
}

// A draw each second: `prize` is won by one of the transitions.
NetDraft lottery(const std::vector<double>& odds) {
    NetDraft net;
    const PlaceIndex prize = add_place(net, "prize", 1);
    net.places[prize.value].duration = DurationDraft::constant({kTicksPerSecond});
    for (std::size_t i = 0; i < odds.size(); ++i) {
        add_transition(net, "t" + std::to_string(i), {prize}, {prize}).odds = Expr::real(odds[i]);
    }
    return net;
}

// Pearson's statistic as a normal deviate (Wilson and Hilferty 1931).
double deviate(const std::vector<double>& counts, const std::vector<double>& expected) {
    double chi2 = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    }
    const double k = static_cast<double>(counts.size()) - 1;
    return (std::cbrt(chi2 / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

}  // namespace

TEST_CASE("who wins a tie has probability odds over the sum of odds [law]") {
    const std::vector<double> odds = {1, 2, 3, 0.5};
    const Net net = compiled(lottery(odds));
    Names names(net);
    run::Player player(net, {.seed = 4, .sink = &names});
    constexpr int kDraws = 40000;
    player.run({.firings = kDraws});
    std::vector<double> counts(odds.size());
    std::vector<double> expected;
    for (const std::string& name : names.names) {
        ++counts[static_cast<std::size_t>(name[1] - '0')];
    }
    for (const double w : odds) {
        expected.push_back(kDraws * w / 6.5);
    }
    CHECK(std::fabs(deviate(counts, expected)) < 4);
}

TEST_CASE(
    "the order in which n rivals win is drawn without replacement, also by the tickets they keep "
    "[law]") {
    // All four fire in every round, one after another in one instant. The law of the order is that
    // of fresh draws: the probability of a, b, c, d is a/S * b/(S-a) * ...
    const std::vector<double> odds = {1, 2, 3, 4};
    NetDraft draft;
    const PlaceIndex start = add_place(draft, "start", 1);
    draft.places[start.value].duration = DurationDraft::constant({kTicksPerSecond});
    std::vector<PlaceIndex> places;
    for (int i = 0; i < 4; ++i) {
        places.push_back(add_place(draft, "p" + std::to_string(i)));
    }
    std::vector<PlaceIndex> done;
    for (int i = 0; i < 4; ++i) {
        done.push_back(add_place(draft, "q" + std::to_string(i)));
    }
    add_transition(draft, "begin", {start}, places);
    for (int i = 0; i < 4; ++i) {
        add_transition(draft, "t" + std::to_string(i), {places[static_cast<std::size_t>(i)]},
                       {done[static_cast<std::size_t>(i)]})
            .odds = Expr::real(odds[static_cast<std::size_t>(i)]);
    }
    add_transition(draft, "again", done, {start});
    const Net net = compiled(draft);
    Names names(net);
    run::Player player(net, {.seed = 9, .sink = &names});
    constexpr int kRounds = 20000;
    player.run({.firings = kRounds * 6});
    std::map<std::string, double> counts;
    std::string order;
    for (const std::string& name : names.names) {
        if (name == "again") {
            ++counts[order];
            order.clear();
        } else if (name != "begin") {
            order += name[1];
        }
    }
    CHECK(counts.size() == 24);
    std::vector<double> got;
    std::vector<double> expected;
    for (const auto& [key, count] : counts) {
        double probability = 1;
        double left = 10;
        for (const char c : key) {
            const double w = odds[static_cast<std::size_t>(c - '0')];
            probability *= w / left;
            left -= w;
        }
        got.push_back(count);
        expected.push_back(kRounds * probability);
    }
    CHECK(std::fabs(deviate(got, expected)) < 4);
}

TEST_CASE("one who loses many ties is as likely to win the next as a newcomer [law]") {
    // `old` waits from the start of the instant; the chain a1, a2, a3 lets newcomers appear one
    // after another. By the exponential law the waiting one has no advantage: it wins against each
    // with probability 1/2.
    NetDraft draft;
    const PlaceIndex start = add_place(draft, "start", 1);
    draft.places[start.value].duration = DurationDraft::constant({kTicksPerSecond});
    const PlaceIndex waits = add_place(draft, "waits");
    const PlaceIndex c0 = add_place(draft, "c0");
    const PlaceIndex c1 = add_place(draft, "c1");
    const PlaceIndex c2 = add_place(draft, "c2");
    const PlaceIndex c3 = add_place(draft, "c3");
    const PlaceIndex old_done = add_place(draft, "old_done");
    add_transition(draft, "begin", {start}, {waits, c0});
    add_transition(draft, "old", {waits}, {old_done});
    add_transition(draft, "n1", {c0}, {c1});
    add_transition(draft, "n2", {c1}, {c2});
    add_transition(draft, "n3", {c2}, {c3});
    add_transition(draft, "again", {c3, old_done}, {start});
    const Net net = compiled(draft);
    Names names(net);
    run::Player player(net, {.seed = 21, .sink = &names});
    constexpr int kRounds = 20000;
    player.run({.firings = kRounds * 6});
    std::vector<double> position(4);
    int before = 0;
    for (const std::string& name : names.names) {
        if (name == "begin") {
            before = 0;
        } else if (name == "old") {
            ++position[static_cast<std::size_t>(before)];
        } else {
            ++before;
        }
    }
    CHECK(std::fabs(
              deviate(position, {kRounds / 2.0, kRounds / 4.0, kRounds / 8.0, kRounds / 8.0})) < 4);
}

TEST_CASE("an unrelated net beside it changes nobody's luck [law]") {
    const NetDraft alone = lottery({1, 2, 3});
    NetDraft together = alone;
    const PlaceIndex other = add_place(together, "elsewhere", 3);
    together.places[other.value].duration = DurationDraft::constant({kTicksPerSecond / 2});
    add_transition(together, "u", {other}, {other});
    add_transition(together, "v", {other}, {other}).odds = Expr::real(5);
    const Net first = compiled(alone);
    const Net second = compiled(together);
    Names a(first);
    Names b(second);
    run::Player player_a(first, {.seed = 3, .sink = &a});
    run::Player player_b(second, {.seed = 3, .sink = &b});
    player_a.run({.until = {300 * kTicksPerSecond}});
    player_b.run({.until = {300 * kTicksPerSecond}});
    std::vector<std::string> rest;
    for (const std::string& name : b.names) {
        if (name[0] == 't') {
            rest.push_back(name);
        }
    }
    CHECK(a.names.size() == 300);
    CHECK(rest == a.names);
}

TEST_CASE("runs of one seed are equal, runs of two seeds are not [law]") {
    const Net net = compiled(lottery({1, 1}));
    const auto hash = [&](std::uint64_t seed) {
        run::Player player(net, {.seed = seed});
        player.run({.firings = 100});
        return player.log_hash();
    };
    CHECK(hash(1) == hash(1));
    CHECK(hash(1) != hash(2));
}

TEST_CASE("the mean number in an M/M/1 queue is rho / (1 - rho) [oracle]") {
    // Arrivals every 1 s, service 0.6 s on the mean: rho = 0.6, L = 1.5. Thirty batches of 2000 s
    // after a warm-up; the 99.9 % interval of Student's t with 29 degrees of freedom: 3.66 standard
    // errors.
    NetDraft draft;
    const PlaceIndex queue = add_place(draft, "queue");
    const auto exponential = [](double mean_s) {
        DurationDraft d;
        d.kind = DurationKind::kDistribution;
        d.distribution = DistributionKind::kExponential;
        d.parameters.push_back(Expr::real(mean_s));
        return d;
    };
    add_transition(draft, "arrive", {}, {queue}).delay = DelayDraft{.duration = exponential(1)};
    add_transition(draft, "serve", {queue}, {}).delay = DelayDraft{.duration = exponential(0.6)};
    const Net net = compiled(draft);
    Names names(net);
    run::Player player(net, {.seed = 12, .sink = &names});
    constexpr int kBatches = 30;
    constexpr double kBatch_s = 2000;
    player.run({.until = {static_cast<std::int64_t>(kBatch_s * (kBatches + 1)) * kTicksPerSecond}});
    std::vector<double> area(kBatches + 1);
    double since = 0;
    int length = 0;
    const auto add_stretch =
        [&](double until) {  // the queue was `length` long from `since` to `until`
            while (since < until) {
                const auto batch = static_cast<std::size_t>(since / kBatch_s);
                const double end = std::min(until, (static_cast<double>(batch) + 1) * kBatch_s);
                if (batch < area.size()) {
                    area[batch] += length * (end - since);
                }
                since = end;
            }
        };
    for (std::size_t i = 0; i < names.names.size(); ++i) {
        add_stretch(names.times[i].seconds());
        length += names.names[i] == "arrive" ? 1 : -1;
    }
    add_stretch(kBatch_s * (kBatches + 1));
    double mean = 0;
    for (int i = 1; i <= kBatches; ++i) {
        mean += area[static_cast<std::size_t>(i)] / kBatch_s / kBatches;
    }
    double variance = 0;
    for (int i = 1; i <= kBatches; ++i) {
        const double d = area[static_cast<std::size_t>(i)] / kBatch_s - mean;
        variance += d * d / (kBatches - 1);
    }
    const double half_width = 3.66 * std::sqrt(variance / kBatches);
    CHECK(half_width < 0.5);
    CHECK(std::fabs(mean - 1.5) < half_width);
}
