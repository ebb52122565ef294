// SPDX-License-Identifier: MIT
// reduced = full on thousands of random nets, by brute force. Longer: PUP_REDUCTION_ROUNDS=100000.
#include "puppetri/proof/reductions.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <set>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

int rounds(int usual) {
    const char* text = std::getenv("PUP_REDUCTION_ROUNDS");
    return text != nullptr ? std::atoi(text) : usual;
}

// Shapes in which rules apply: long chains beside small conflicts.
PlainNet random_net(Chance& chance, int round) {
    if (round % 2 == 0) {
        return small_net(chance, {.places = 6,
                                  .transitions = 6,
                                  .weights = round % 3 == 0,
                                  .reads = round % 4 == 0,
                                  .inhibitors = round % 8 == 0,
                                  .optional = round % 6 == 0,
                                  .conservative = round % 10 != 0});
    }
    PlainNet net = small_net(chance, {.places = 3,
                                      .transitions = 3,
                                      .weights = round % 3 == 0,
                                      .reads = round % 4 == 1,
                                      .inhibitors = round % 8 == 1,
                                      .optional = round % 6 == 1});
    const std::uint32_t base = net.place_count();
    const std::uint32_t extra = 1 + chance.below(4);
    for (std::uint32_t i = 0; i < extra; ++i) {
        net.initial.push_back(chance.one_in(4) ? 1 : 0);
    }
    for (std::uint32_t i = 0; i < extra + 1; ++i) {  // a chain through the extra places
        std::map<std::uint32_t, std::uint32_t> takes, gives;
        takes[i == 0 ? chance.below(base) : base + i - 1] = 1;
        gives[i == extra ? chance.below(base) : base + i] =
            chance.one_in(5) && round % 3 == 0 ? 2 : 1;
        if (chance.one_in(4)) {
            takes[chance.below(base)] += 1;
        }
        if (chance.one_in(4)) {
            gives[chance.below(base + extra)] += 1;
        }
        add_transition(net, takes, gives, {}, {}, round % 6 == 1 && chance.one_in(8));
    }
    return net;
}

Marking seen(const Marking& m, const std::vector<std::uint32_t>& places) {
    Marking out;
    for (const std::uint32_t p : places) {
        out.push_back(m[p]);
    }
    return out;
}

// A path to each state, by breadth-first search.
std::vector<std::vector<std::uint32_t>> paths(const Space& space) {
    std::vector<std::vector<std::uint32_t>> path(space.markings.size());
    std::vector<std::uint8_t> has(space.markings.size(), 0);
    has[0] = 1;
    std::vector<std::uint32_t> queue = {0};
    for (std::size_t i = 0; i < queue.size(); ++i) {
        for (const auto& [t, target] : space.edges[queue[i]]) {
            if (has[target] == 0) {
                has[target] = 1;
                path[target] = path[queue[i]];
                path[target].push_back(t);
                queue.push_back(target);
            }
        }
    }
    return path;
}

bool replay(const PlainNet& net, const std::vector<std::uint32_t>& sequence, Marking& m) {
    m = net.initial;
    for (const std::uint32_t t : sequence) {
        if (!net.enabled(m, t) || !net.fire(m, t)) {
            return false;
        }
    }
    return true;
}

// The words of a net seen through places, repetitions left out, as a deterministic automaton that
// is made on the way: sets of states that the same word leads to.
class Words {
 public:
    Words(const PlainNet& net, const Space& space, const std::vector<std::uint32_t>& places)
        : space_(space) {
        for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
            letter_.push_back(seen(space.markings[s], places));
        }
        // A word may end here: dead, or an unseen cycle.
        stuck_.assign(letter_.size(), 0);
        std::vector<std::uint8_t> endless(letter_.size(), 1);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t s = 0; s < letter_.size(); ++s) {
                bool goes_on = false;
                for (const auto& [t, target] : space.edges[s]) {
                    goes_on = goes_on || (letter_[target] == letter_[s] && endless[target] != 0);
                }
                if (endless[s] != 0 && !goes_on) {
                    endless[s] = 0;
                    changed = true;
                }
            }
        }
        for (std::uint32_t s = 0; s < letter_.size(); ++s) {
            stuck_[s] = space.dead(net, s) || endless[s] != 0 ? 1 : 0;
        }
    }
    using Set = std::set<std::uint32_t>;
    Set closed(Set set) const {
        std::vector<std::uint32_t> open(set.begin(), set.end());
        while (!open.empty()) {
            const std::uint32_t s = open.back();
            open.pop_back();
            for (const auto& [t, target] : space_.edges[s]) {
                if (letter_[target] == letter_[s] && set.insert(target).second) {
                    open.push_back(target);
                }
            }
        }
        return set;
    }
    bool may_end(const Set& set) const {
        return std::any_of(set.begin(), set.end(), [&](std::uint32_t s) { return stuck_[s] != 0; });
    }
    std::map<Marking, Set> next(const Set& set) const {
        std::map<Marking, Set> out;
        for (const std::uint32_t s : set) {
            for (const auto& [t, target] : space_.edges[s]) {
                if (letter_[target] != letter_[s]) {
                    out[letter_[target]].insert(target);
                }
            }
        }
        for (auto& [letter, target] : out) {
            target = closed(std::move(target));
        }
        return out;
    }

 private:
    const Space& space_;
    std::vector<Marking> letter_;
    std::vector<std::uint8_t> stuck_;
};

bool same_words(const Words& a, const Words& b) {
    std::set<std::pair<Words::Set, Words::Set>> done;
    std::vector<std::pair<Words::Set, Words::Set>> open = {{a.closed({0}), b.closed({0})}};
    while (!open.empty()) {
        const auto pair = open.back();
        open.pop_back();
        if (!done.insert(pair).second) {
            continue;
        }
        if (a.may_end(pair.first) != b.may_end(pair.second)) {
            return false;
        }
        const auto x = a.next(pair.first), y = b.next(pair.second);
        if (x.size() != y.size()) {
            return false;
        }
        for (const auto& [letter, set] : x) {
            const auto it = y.find(letter);
            if (it == y.end()) {
                return false;
            }
            open.emplace_back(set, it->second);
        }
    }
    return true;
}

}  // namespace

TEST_CASE(
    "a dead marking is reachable in the reduced net iff it is in the full one, and its path leads "
    "there [law]") {
    Chance chance(41);
    int dead_ends = 0, reduced_rounds = 0;
    for (int round = 0; round < rounds(4000); ++round) {
        const PlainNet net = random_net(chance, round);
        const Space full = whole_space(net);
        if (!full.complete) {
            continue;
        }
        const Reduction r = reduce(net, {Preserves::kDeadlock, {}}, {});
        reduced_rounds += r.rules_applied > 0 ? 1 : 0;
        CAPTURE(text(net));
        CAPTURE(text(r.net));
        const Space less = whole_space(r.net);
        REQUIRE(less.complete);
        CHECK(less.markings.size() <= full.markings.size());
        bool full_dead = false, less_dead = false;
        for (std::uint32_t s = 0; s < full.markings.size(); ++s) {
            full_dead = full_dead || full.dead(net, s);
        }
        const auto path = paths(less);
        for (std::uint32_t s = 0; s < less.markings.size(); ++s) {
            if (!less.dead(r.net, s)) {
                continue;
            }
            less_dead = true;
            Marking m;
            REQUIRE(replay(net, r.original(net, path[s], true), m));
            REQUIRE(full.number.count(m) == 1);
            CHECK(full.dead(net, full.number.at(m)));
        }
        CHECK(full_dead == less_dead);
        dead_ends += full_dead ? 1 : 0;
    }
    CHECK(dead_ends > 100);
    CHECK(reduced_rounds > 100);
}

TEST_CASE(
    "seen through the kept places, the reduced net reaches the same markings, by sequences that "
    "fire [law]") {
    Chance chance(42);
    for (int round = 0; round < rounds(4000); ++round) {
        const PlainNet net = random_net(chance, round);
        const Space full = whole_space(net);
        if (!full.complete) {
            continue;
        }
        ReductionGoal goal{Preserves::kReachability,
                           std::vector<std::uint8_t>(net.place_count(), 0)};
        std::vector<std::uint32_t> kept, kept_now;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (chance.one_in(3)) {
                goal.keep[p] = 1;
                kept.push_back(p);
            }
        }
        const Reduction r = reduce(net, goal, {});
        for (const std::uint32_t p : kept) {
            REQUIRE(r.now[p] != Reduction::kGone);
            kept_now.push_back(r.now[p]);
        }
        CAPTURE(text(net));
        CAPTURE(text(r.net));
        const Space less = whole_space(r.net);
        REQUIRE(less.complete);
        std::set<Marking> a, b;
        for (const Marking& m : full.markings) {
            a.insert(seen(m, kept));
        }
        const auto path = paths(less);
        for (std::uint32_t s = 0; s < less.markings.size(); ++s) {
            b.insert(seen(less.markings[s], kept_now));
            Marking m;
            REQUIRE(replay(net, r.original(net, path[s], false), m));
            CHECK(seen(m, kept) == seen(less.markings[s], kept_now));
        }
        CHECK(a == b);
    }
}

TEST_CASE(
    "seen through the kept places and up to repetition, the reduced net has the same maximal runs "
    "[law]") {
    Chance chance(43);
    for (int round = 0; round < rounds(4000); ++round) {
        const PlainNet net = random_net(chance, round);
        const Space full = whole_space(net, 600);
        if (!full.complete) {
            continue;
        }
        ReductionGoal goal{Preserves::kStutter, std::vector<std::uint8_t>(net.place_count(), 0)};
        std::vector<std::uint32_t> kept, kept_now;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (chance.one_in(3)) {
                goal.keep[p] = 1;
                kept.push_back(p);
            }
        }
        const Reduction r = reduce(net, goal, {});
        for (const std::uint32_t p : kept) {
            kept_now.push_back(r.now[p]);
        }
        CAPTURE(text(net));
        CAPTURE(text(r.net));
        CAPTURE(kept.empty() ? std::string("none") : std::to_string(kept[0]));
        const Space less = whole_space(r.net);
        REQUIRE(less.complete);
        CHECK(same_words(Words(net, full, kept), Words(r.net, less, kept_now)));
    }
}

TEST_CASE("what a limit of no tokens forbids stays forbidden [unit]") {
    // A place that holds one token never takes the two of `t`: "unless 0 tokens are there".
    PlainNet net;
    net.initial = {1, 0, 0};
    add_transition(net, {{0, 1}}, {{1, 2}}, {}, {{1, 0}});  // t
    add_transition(net, {{1, 1}}, {{2, 1}});
    for (const Preserves preserves : {Preserves::kDeadlock, Preserves::kReachability}) {
        const Reduction r = reduce(net, {preserves, {0, 0, 1}}, {});
        const Space less = whole_space(r.net);
        CHECK(less.markings.size() == 1);
    }
}

TEST_CASE("a net with levels comes back as it is [unit]") {
    Chance chance(1);
    PlainNet net = small_net(chance, {});
    net.has_levels = true;
    const Reduction r = reduce(net, {Preserves::kDeadlock, {}}, {});
    CHECK(r.rules_applied == 0);
    CHECK(r.net.initial == net.initial);
    CHECK(r.net.takes == net.takes);
}

TEST_CASE("a long chain becomes one firing [unit]") {
    PlainNet net;
    net.initial.assign(50, 0);
    net.initial[0] = 3;
    for (std::uint32_t i = 0; i + 1 < 50; ++i) {
        add_transition(net, {{i, 1}}, {{i + 1, 1}});
    }
    ReductionGoal goal{Preserves::kReachability, std::vector<std::uint8_t>(50, 0)};
    goal.keep[49] = 1;
    const Reduction r = reduce(net, goal, {});
    CHECK(r.net.transition_count() <= 1);
    CHECK(whole_space(r.net).markings.size() <= 4);
}
