// SPDX-License-Identifier: MIT
// The order in which a question is tried: what is cheap and often enough first. Stubborn sets cost
// a hundred times as much per state as firing everything; they come first only while that does not
// matter, and last when there is too much to fire.
#include <algorithm>
#include <bit>

#include "puppetri/base/random.h"
#include "puppetri/proof/explorer.h"
#include "search.h"
#include "stubborn.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kWalks = 24, kSteps = 2000;
constexpr double kWalks_s = 0.05;
constexpr std::uint64_t kSmall = 4'000;            // states of the first reduced search
constexpr double kFullShare = 0.5;                 // of the time, for the search of everything
constexpr std::uint64_t kFullBytesPerStates = 16;  // to see beforehand what memory allows

// Walks that prefer successors with the fewest enabled transitions: dead ends attract them. Fixed
// seed: the same walks on every system.
class Walker {
 public:
    explicit Walker(Search& search)
        : s_(search),
          sight_(search.form.scanner->make_sight()),
          state_(search.form.packing.words),
          next_(state_.size()),
          best_(state_.size()) {}

    // Gives  true, and the firings, if a walk ended in a dead marking.
    bool walk(std::vector<std::uint32_t>& firings, Marking& marking) {
        RandomStream stream{.key = 0x5EE4};
        for (std::uint32_t w = 0; w < kWalks && s_.meter.seconds() < kWalks_s; ++w) {
            firings.clear();
            s_.form.packing.encode(s_.net.initial, state_);
            for (std::uint32_t step = 0; step < kSteps; ++step) {
                std::vector<std::uint32_t> enabled = look(state_);
                if (enabled.empty()) {
                    if (is_dead()) {
                        marking.resize(s_.net.place_count());
                        s_.form.packing.decode(state_, marking);
                        return true;
                    }
                    break;
                }
                if (grown_) {
                    break;
                }
                std::uint32_t least = ~std::uint32_t{0}, chosen = 0, ties = 0;
                for (const std::uint32_t t : enabled) {
                    for (std::size_t i = 0; i < next_.size(); ++i) {
                        next_[i] = state_[i] + s_.form.changes[t * next_.size() + i];
                    }
                    const auto count = static_cast<std::uint32_t>(look(next_).size());
                    ties = count < least ? 0 : ties;
                    if (count < least || (count == least && stream.below(++ties + 1) == 0)) {
                        least = count;
                        chosen = t;
                        best_ = next_;
                    }
                }
                firings.push_back(chosen);
                state_ = best_;
            }
        }
        return false;
    }

 private:
    // What may fire, priorities counted; notes whether it may not fit.
    std::vector<std::uint32_t> look(const std::vector<std::uint64_t>& state) {
        s_.form.scanner->scan(state.data(), sight_);
        const std::uint32_t words = s_.form.scanner->words();
        std::vector<std::uint32_t> list;
        for (std::uint32_t w = 0; w < words; ++w) {
            for (std::uint64_t left = sight_.enabled[w]; left != 0; left &= left - 1) {
                list.push_back(w * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
            }
        }
        if (s_.net.has_levels && !list.empty()) {
            std::uint32_t highest = 0;
            for (const std::uint32_t t : list) {
                highest = std::max(highest, s_.net.level[t]);
            }
            std::erase_if(list, [&](std::uint32_t t) { return s_.net.level[t] < highest; });
        }
        grown_ = false;
        for (const std::uint32_t t : list) {
            grown_ = grown_ || (s_.form.scanner->may_grow() &&
                                ((sight_.enabled[words + t / 64] >> (t & 63)) & 1) == 0);
        }
        return list;
    }
    // Of the state looked at last.
    bool is_dead() const {
        return s_.options.final == nullptr || !s_.final.holds_by([&](std::uint32_t place) {
            return s_.form.scanner->tokens(state_.data(), sight_, place);
        });
    }

    Search& s_;
    Scanner::Sight sight_;
    std::vector<std::uint64_t> state_, next_, best_;
    bool grown_ = false;
};

bool all_found(const Exploration& e, bool dead) {
    return (!dead || e.dead.found) &&
           std::all_of(e.goals.begin(), e.goals.end(), [](const Finding& f) { return f.found; });
}

// What was found before stays found.
void join(Exploration& into, Exploration later) {
    if (into.dead.found) {
        later.dead = std::move(into.dead);
    }
    for (std::size_t g = 0; g < into.goals.size() && g < later.goals.size(); ++g) {
        if (into.goals[g].found) {
            later.goals[g] = std::move(into.goals[g]);
        }
    }
    later.seconds += into.seconds;
    into = std::move(later);
}

}  // namespace

Exploration seek(const PlainNet& net, const ExploreOptions& options, const Budget& budget) {
    Exploration out;
    out.goals.resize(options.goals.size());
    ExploreOptions o = options;
    o.stop_when_found = true;
    o.reduce = !net.has_levels;
    if (options.find_dead) {
        Search search(net, o, budget);
        Finding dead;
        if (!search.stop && Walker(search).walk(dead.firings, dead.marking)) {
            dead.found = true;
            if (!options.witnesses) {
                dead.firings.clear();
            }
            out.dead = std::move(dead);
            if (all_found(out, true)) {
                return out;
            }
        }
        out.seconds = search.meter.seconds();
    }
    const auto left = [&](double share) {
        Budget b = budget;
        b.seconds = std::max(0.0, (budget.seconds - out.seconds) * share);
        return b;
    };
    const auto done = [&] {
        return out.complete || all_found(out, options.find_dead) || out.ended == Ended::kCancelled;
    };
    if (o.reduce) {
        Budget b = left(1);
        b.states = std::min(b.states, kSmall);
        join(out, explore(net, o, b));
        if (done()) {
            return out;
        }
    }
    o.reduce = false;
    Budget b = left(net.has_levels ? 1 : kFullShare);
    b.states = std::min(b.states, std::max(kSmall, b.bytes / kFullBytesPerStates));
    join(out, explore(net, o, b));
    if (done() || net.has_levels) {
        return out;
    }
    o.reduce = true;
    join(out, explore(net, o, left(1)));
    return out;
}

}  // namespace puppetri::proof
