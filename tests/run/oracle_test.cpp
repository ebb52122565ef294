// SPDX-License-Identifier: MIT
// The engine against the oracle on random small nets: the same set of runs under all choices, and
// laws that hold for every net. PUPPETRI_ORACLE_NETS sets how many nets are tried (default: a few
// seconds' worth), PUPPETRI_ORACLE_SEED where the series begins.
#include <doctest/doctest.h>

#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/net/chooser.h"
#include "puppetri/net/net.h"
#include "puppetri/run/player.h"
#include "support/oracle_net.h"
#include "support/random_net.h"

using namespace puppetri;
using namespace puppetri::test;

namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}
std::uint64_t nets_to_try(std::uint64_t usual) {
    return usual * from_environment("PUPPETRI_ORACLE_TIMES", 1);
}
RandomStream series(std::uint64_t purpose, std::uint64_t i) {
    return {
        .key =
            Hash64(from_environment("PUPPETRI_ORACLE_SEED", 1)).add_u64(purpose).add_u64(i).value(),
        .count = 0};
}

class Recorder final : public run::LogSink {
 public:
    void fired(SimTime at, net::TransitionIndex transition) override {
        firings.push_back({.tick = at.ticks, .transition = transition.value});
    }
    std::vector<OracleFiring> firings;
};

struct Played {
    OracleRun notation;
    std::vector<OracleFiring> firings;
    std::uint64_t hash = 0;
    run::Stop stop = run::Stop::kNone;
};

const char* word_of(run::Stop stop) {
    switch (stop) {
        case run::Stop::kLimit:
            return "limit";
        case run::Stop::kDead:
            return "dead";
        case run::Stop::kFinal:
            return "final";
        case run::Stop::kFault:
            return "fault";
        case run::Stop::kNone:
            break;
    }
    return "none";
}

Played play(const net::NetDraft& draft, const net::Net& net, const OracleBounds& bounds,
            net::Chooser* chooser, std::uint64_t seed = 1) {
    Recorder recorder;
    run::Player player(
        net, {.seed = seed, .chooser = chooser, .sink = &recorder, .beat = {bounds.beat}});
    const run::Stop stop = player.run({.until = {bounds.until}, .firings = bounds.firings});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;
    for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
        counts.emplace_back(player.tokens(net::PlaceIndex{p}),
                            player.ready_tokens(net::PlaceIndex{p}));
    }
    std::vector<Value> data;
    for (std::uint32_t d = 0; d < draft.data.size(); ++d) {
        data.push_back(player.datum(net::DatumIndex{d}));
    }
    std::string end = word_of(stop);
    if (stop == run::Stop::kFault) {
        end += "(" + player.fault().code + ")";
    }
    return {.notation = oracle_notation(draft, recorder.firings, end, counts, data),
            .firings = recorder.firings,
            .hash = player.log_hash(),
            .stop = stop};
}

std::string differences(const std::set<OracleRun>& engine, const std::set<OracleRun>& oracle) {
    std::string text;
    int shown = 0;
    for (const OracleRun& r : engine) {
        if (oracle.count(r) == 0 && ++shown <= 3) {
            text += "only the engine: " + r + "\n";
        }
    }
    shown = 0;
    for (const OracleRun& r : oracle) {
        if (engine.count(r) == 0 && ++shown <= 3) {
            text += "only the oracle: " + r + "\n";
        }
    }
    return text;
}

}  // namespace

TEST_CASE("under all choices the engine has exactly the oracle's runs [oracle]") {
    const std::uint64_t nets = nets_to_try(700);
    std::uint64_t compared = 0;
    std::uint64_t refused = 0;
    std::uint64_t failures = 0;
    std::uint64_t firings = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(1, i);
        const net::NetDraft source = random_net(stream);
        const net::NetDraft draft = without_holdings(source);
        const Checked<net::Net> net = net::compile(source);
        if (!net.has_value()) {
            ++refused;
            if (refused <= 2) {
                MESSAGE("refused: " << net.error()[0].element << ": " << net.error()[0].message
                                    << "\n"
                                    << show(draft));
            }
            continue;
        }
        OracleBounds bounds{.until = 8 * kRandomNetUnit, .firings = 7, .runs = 400};
        std::optional<std::set<OracleRun>> wanted = oracle_runs(draft, bounds);
        while (!wanted && bounds.firings > 2) {
            --bounds.firings;
            wanted = oracle_runs(draft, bounds);
        }
        if (!wanted) {
            continue;
        }
        std::set<OracleRun> got;
        net::ExhaustiveChooser all;
        std::size_t tries = 0;
        do {
            const Played played = play(draft, *net, bounds, &all);
            firings += played.firings.size();
            got.insert(played.notation);
        } while (all.next() && ++tries < 20 * bounds.runs);
        ++compared;
        if (got != *wanted) {
            ++failures;
            FAIL_CHECK("net " << i << "\n" << show(draft) << differences(got, *wanted));
        }
    }
    MESSAGE(compared << " nets compared, " << firings << " firings, " << refused << " refused");
    CHECK(compared * 2 > nets);
    CHECK(refused * 20 < nets);
}

TEST_CASE("under the random chooser every run is one of the oracle's [oracle]") {
    const std::uint64_t nets = nets_to_try(1500);
    std::uint64_t failures = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(2, i);
        Features features;
        features.intervals = false;
        const net::NetDraft source = random_net(stream, features);
        const net::NetDraft draft = without_holdings(source);
        const Checked<net::Net> net = net::compile(source);
        if (!net.has_value()) {
            continue;
        }
        const OracleBounds bounds{.until = 12 * kRandomNetUnit, .firings = 12, .runs = 5000};
        for (const std::uint64_t seed : {1u, 2u, 3u}) {
            const Played played = play(draft, *net, bounds, nullptr, seed);
            if (oracle_accepts(draft, played.firings, bounds) == false) {
                ++failures;
                FAIL_CHECK("net " << i << " seed " << seed << "\n"
                                  << show(draft) << played.notation);
                break;
            }
        }
    }
}

TEST_CASE(
    "a snapshot at any step, restored in another player, continues to the same log and state "
    "[law]") {
    const std::uint64_t nets = nets_to_try(400);
    for (std::uint64_t i = 0; i < nets; ++i) {
        RandomStream stream = series(3, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        const run::Limits limits{.until = {20 * kRandomNetUnit}, .firings = 25};
        run::Player whole(*net, {.seed = i, .beat = {kRandomNetUnit}});
        whole.run(limits);
        const std::vector<std::uint8_t> end = whole.snapshot();
        run::Player stepping(*net, {.seed = i, .beat = {kRandomNetUnit}});
        for (int step = 0; step < 25; ++step) {
            const std::vector<std::uint8_t> bytes = stepping.snapshot();
            run::Player other(*net, {.seed = i, .beat = {kRandomNetUnit}});
            other.step(limits);  // whatever it was before
            REQUIRE(other.restore(bytes).has_value());
            CHECK(other.snapshot() == bytes);
            other.run(limits);
            CAPTURE(i);
            CAPTURE(step);
            INFO(show(draft));
            REQUIRE(other.log_hash() == whole.log_hash());
            REQUIRE(other.firings() == whole.firings());
            REQUIRE(other.snapshot() == end);
            if (stepping.step(limits) != run::Stop::kNone) {
                break;
            }
        }
    }
}

TEST_CASE("a damaged snapshot is refused, and the player stays as it was [hostile]") {
    const std::uint64_t nets = nets_to_try(60);
    for (std::uint64_t i = 0; i < nets; ++i) {
        RandomStream stream = series(4, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        run::Player player(*net, {.seed = i, .beat = {kRandomNetUnit}});
        player.run({.until = {10 * kRandomNetUnit}, .firings = 10});
        const std::vector<std::uint8_t> bytes = player.snapshot();
        run::Player other(*net);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            CHECK(!other.restore({bytes.data(), length}).has_value());
        }
        for (std::size_t at = 0; at < bytes.size(); ++at) {
            std::vector<std::uint8_t> flipped = bytes;
            flipped[at] ^= static_cast<std::uint8_t>(1 + stream.below(255));
            CHECK(!other.restore(flipped).has_value());
        }
        CHECK(other.firings() == 0);
        CHECK(other.snapshot() == run::Player(*net).snapshot());
    }
}

TEST_CASE(
    "a forged snapshot with a right checksum is refused or is a state, never a crash [hostile]") {
    const std::uint64_t nets = nets_to_try(60);
    for (std::uint64_t i = 0; i < nets; ++i) {
        RandomStream stream = series(7, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        run::Player player(*net, {.seed = i, .beat = {kRandomNetUnit}});
        player.run({.until = {10 * kRandomNetUnit}, .firings = 10});
        const std::vector<std::uint8_t> bytes = player.snapshot();
        for (std::size_t at = 0; at + 8 < bytes.size(); ++at) {
            std::vector<std::uint8_t> forged = bytes;
            forged[at] ^= static_cast<std::uint8_t>(1 + stream.below(255));
            const std::string content(forged.begin(), forged.end() - 8);
            const std::uint64_t sum = Hash64().add_text(content).value();
            for (std::size_t k = 0; k < 8; ++k) {
                forged[bytes.size() - 8 + k] = static_cast<std::uint8_t>(sum >> (8 * k));
            }
            run::Player other(*net);
            if (other.restore(forged).has_value()) {
                other.snapshot();
            }
        }
    }
}

TEST_CASE("the log does not depend on the order of declarations [law]") {
    const std::uint64_t nets = nets_to_try(1500);
    std::uint64_t failures = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(5, i);
        const net::NetDraft draft = without_holdings(random_net(stream));
        const net::NetDraft other = reordered(draft, stream);
        const Checked<net::Net> a = net::compile(draft);
        const Checked<net::Net> b = net::compile(other);
        REQUIRE(a.has_value() == b.has_value());
        if (!a.has_value()) {
            continue;
        }
        const OracleBounds bounds{.until = 30 * kRandomNetUnit, .firings = 40};
        const Played first = play(draft, *a, bounds, nullptr, i);
        const Played second = play(other, *b, bounds, nullptr, i);
        if (first.hash != second.hash) {
            ++failures;
            FAIL_CHECK("net " << i << "\n"
                              << show(draft) << first.notation << "\n"
                              << show(other) << second.notation);
        }
    }
}

TEST_CASE(
    "what a place invariant of the incidence matrix counts stays constant in every run [law]") {
    const std::uint64_t nets = nets_to_try(1000);
    std::uint64_t invariants = 0;
    for (std::uint64_t i = 0; i < nets; ++i) {
        RandomStream stream = series(6, i);
        Features features;
        features.cuts = false;  // `all` takes an unknown number
        const net::NetDraft draft = without_holdings(random_net(stream, features));
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        // All weightings of the places with 0, 1, 2 that no transition changes.
        const std::size_t places = draft.places.size();
        std::vector<std::vector<int>> kept;
        std::vector<int> y(places, 0);
        for (;;) {
            std::size_t k = 0;
            while (k < places && ++y[k] == 3) {
                y[k++] = 0;
            }
            if (k == places) {
                break;
            }
            bool invariant = true;
            for (const net::TransitionDraft& t : draft.transitions) {
                std::int64_t change = 0;
                for (const net::ArcDraft& arc : t.inputs) {
                    change -= arc.kind == net::ArcKind::kTake ? y[arc.place.value] * arc.weight : 0;
                }
                for (const net::OutputDraft& out : t.outputs) {
                    change += y[out.place.value] * out.weight;
                }
                invariant = invariant && change == 0;
            }
            if (invariant) {
                kept.push_back(y);
            }
        }
        invariants += kept.size();
        run::Player player(*net, {.seed = i, .beat = {kRandomNetUnit}});
        const auto count = [&](const std::vector<int>& weights) {
            std::int64_t sum = 0;
            for (std::uint32_t p = 0; p < places; ++p) {
                sum += weights[p] * static_cast<std::int64_t>(player.tokens(net::PlaceIndex{p}));
            }
            return sum;
        };
        std::vector<std::int64_t> first;
        for (const std::vector<int>& weights : kept) {
            first.push_back(count(weights));
        }
        for (int step = 0;
             step < 40 && player.step({.until = {40 * kRandomNetUnit}}) == run::Stop::kNone;
             ++step) {
            for (std::size_t k = 0; k < kept.size(); ++k) {
                REQUIRE(count(kept[k]) == first[k]);
            }
        }
    }
    CHECK(invariants > nets / 2);
}
