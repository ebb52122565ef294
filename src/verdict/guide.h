// SPDX-License-Identifier: MIT
// Guidance for a player that looks for a run: where the run may be in the graph, and at every
// choice the answer that leads nearest to what is looked for.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "puppetri/net/chooser.h"
#include "puppetri/verdict/pursue.h"

namespace puppetri::verdict {

// Where the run may be in the graph.
class Track {
 public:
    // distance: outlives it.
    Track(const Hunt& hunt, const std::vector<std::uint32_t>& distance)
        : hunt_(hunt), p_(hunt.finding->product), distance_(&distance), nodes_(p_.first) {
        close();
    }

    bool lost() const { return nodes_.empty(); }
    std::uint32_t distance() const { return nearest(nodes_); }
    // Of all nodes that it may be in, none leads to what is awaited.
    bool hopeless() const {
        const std::vector<std::uint32_t> now = here();
        return std::all_of(now.begin(), now.end(),
                           [&](std::uint32_t n) { return hunt_.finding->certain[n] != 0; });
    }
    // Those that it may be in right after the last moment, without waiting.
    std::vector<std::uint32_t> here() const {
        return {nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(direct_)};
    }

    // From now on another way is looked for.
    void follow(const std::vector<std::uint32_t>& distance) { distance_ = &distance; }
    // Leaves the nodes in which it may be right after the last moment, if `keep` says so.
    template <class Keep>
    void narrow(Keep&& keep) {
        nodes_.resize(direct_);
        std::erase_if(nodes_, [&](std::uint32_t n) { return !keep(n); });
        close();
    }
    void fired(std::uint32_t transition) {
        const std::uint32_t label = mapped(hunt_.transitions, transition);
        if (label != kNoLabel) {
            nodes_ = after(label);
            close();
        }
    }
    void occurred(std::uint32_t event) {
        const std::uint32_t e = mapped(hunt_.events, event);
        if (e != kNoLabel) {
            std::vector<std::uint32_t> next = after(proof::Edge::kEvent | e);
            // Occurrences that change nothing need not be edges.
            if (!next.empty()) {
                nodes_ = std::move(next);
                close();
            }
        }
    }
    // How near the target is after this firing.
    std::uint32_t score(std::uint32_t transition) const {
        const std::uint32_t label = mapped(hunt_.transitions, transition);
        return label == kNoLabel ? distance() : nearest(after(label));
    }
    // The event of the outside that the nearest way begins with, or none. Only if no firing begins
    // a way as near; `here`: without waiting for anything.
    std::optional<std::uint32_t> wanted_event(bool here) const {
        const std::uint32_t best = distance();
        if (best == kFar || best == 0) {
            return std::nullopt;
        }
        std::optional<std::uint32_t> found;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const std::uint32_t n = nodes_[i];
            if ((*distance_)[n] != best || (here && i >= direct_)) {
                continue;
            }
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                if ((*distance_)[p_.targets[e]] != best - 1) {
                    continue;
                }
                const std::uint32_t label = p_.label(e);
                if (label == proof::Edge::kPass || (label & proof::Edge::kEvent) == 0) {
                    return std::nullopt;
                }
                found = label & ~proof::Edge::kEvent;
            }
        }
        if (!found || hunt_.events.empty()) {
            return found;
        }
        const auto at = std::find(hunt_.events.begin(), hunt_.events.end(), *found);
        return at == hunt_.events.end()
                   ? std::nullopt
                   : std::optional(static_cast<std::uint32_t>(at - hunt_.events.begin()));
    }

 private:
    static constexpr std::uint32_t kNoLabel = ~std::uint32_t{0};

    static std::uint32_t mapped(const std::vector<std::uint32_t>& map, std::uint32_t index) {
        return map.empty() ? index : index < map.size() ? map[index] : kNoLabel;
    }
    std::uint32_t nearest(const std::vector<std::uint32_t>& nodes) const {
        std::uint32_t best = kFar;
        for (const std::uint32_t n : nodes) {
            best = std::min(best, (*distance_)[n]);
        }
        return best;
    }
    std::vector<std::uint32_t> after(std::uint32_t label) const {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t n : nodes_) {
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                if (p_.label(e) == label) {
                    next.push_back(p_.targets[e]);
                }
            }
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        return next;
    }
    // Time may pass unseen.
    void close() {
        direct_ = nodes_.size();
        std::vector<std::uint32_t> seen = nodes_;
        std::sort(seen.begin(), seen.end());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const std::uint32_t n = nodes_[i];
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
                const std::uint32_t to = p_.targets[e];
                if (p_.label(e) != proof::Edge::kPass) {
                    continue;
                }
                const auto at = std::lower_bound(seen.begin(), seen.end(), to);
                if (at == seen.end() || *at != to) {
                    seen.insert(at, to);
                    nodes_.push_back(to);
                }
            }
        }
    }

    const Hunt& hunt_;
    const Product& p_;
    const std::vector<std::uint32_t>* distance_;
    std::vector<std::uint32_t> nodes_;
    std::size_t direct_ = 0;  // so many of them without time passing
};

// One choice of an attempt: the answers in the order in which they are tried.
struct Decision {
    std::vector<std::int64_t> answers;
    std::size_t taken = 0;
};

// Takes what leads nearest, or, on a later attempt, what was decided to be tried instead.
class GuidedChooser final : public net::Chooser {
 public:
    GuidedChooser(std::vector<Decision>& decisions, bool longest, bool coincide)
        : decisions_(decisions), longest_(longest), coincide_(coincide) {}
    const Track* track = nullptr;
    std::vector<std::int64_t> answers;

    std::int64_t choose(const net::Choice& choice) override {
        if (at_ == decisions_.size()) {
            decisions_.push_back(options_of(choice));
        }
        const Decision& d = decisions_[at_++];
        std::int64_t answer = d.answers[d.taken];
        // The same choice is asked again in the same order, but a host may have changed its mind.
        if (choice.options != 0) {
            answer = std::clamp<std::int64_t>(answer, 0, choice.options - 1);
        } else {
            answer = std::clamp(answer, choice.low.ticks, choice.high.ticks);
        }
        answers.push_back(answer);
        return answer;
    }
    std::size_t used() const { return at_; }

 private:
    Decision options_of(const net::Choice& choice) const {
        Decision d;
        if (choice.options == 0) {
            const std::int64_t drawn =
                std::clamp(choice.drawn.ticks, choice.low.ticks, choice.high.ticks);
            d.answers = {choice.low.ticks, choice.high.ticks, drawn};
            const bool continuous =
                choice.kind == net::ChoiceKind::kDuration || choice.kind == net::ChoiceKind::kDelay;
            if (continuous && !coincide_ && choice.low != choice.high) {
                // Never the same twice, nor an end of the support.
                const auto aside = static_cast<std::int64_t>(7919 * (at_ + 1));
                const std::int64_t high = choice.high.ticks;
                d.answers = {drawn};
                if (high - choice.low.ticks > 2 * aside) {
                    d.answers.push_back(choice.low.ticks + aside);
                    const std::int64_t late = std::min(high, drawn < high / 4 ? drawn * 4 : high);
                    d.answers.push_back(late - aside);
                }
                for (std::int64_t& a : d.answers) {
                    a = std::clamp(a, choice.low.ticks, high);
                }
            } else if (choice.high == SimTime::never()) {
                d.answers = {drawn, choice.low.ticks};
            } else if (longest_) {
                std::swap(d.answers[0], d.answers[1]);
            }
            std::vector<std::int64_t> once;
            for (const std::int64_t a : d.answers) {
                if (std::find(once.begin(), once.end(), a) == once.end()) {
                    once.push_back(a);
                }
            }
            d.answers = std::move(once);
            return d;
        }
        std::vector<std::pair<std::uint32_t, std::int64_t>> ranked;
        for (std::uint32_t i = 0; i < choice.options; ++i) {
            const bool tie = choice.kind == net::ChoiceKind::kTie && track != nullptr &&
                             i < choice.transitions.size();
            ranked.push_back({tie ? track->score(choice.transitions[i]) : 0, i});
        }
        std::stable_sort(ranked.begin(), ranked.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [score, option] : ranked) {
            d.answers.push_back(option);
        }
        return d;
    }

    std::vector<Decision>& decisions_;
    const bool longest_, coincide_;
    std::size_t at_ = 0;
};

}  // namespace puppetri::verdict
