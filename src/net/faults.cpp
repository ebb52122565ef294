// SPDX-License-Identifier: MIT
// How a run stops that cannot go on: which element, when, why, and what to do; and what deserves a
// word.
#include <algorithm>
#include <string>

#include "puppetri/base/text.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

namespace {
constexpr std::size_t kMostNotes = 200;
}

void Engine::fail(const char* code, std::string element, const SourceSpan& where,
                  std::string message, std::string remedy) {
    if (faulted_) {
        return;
    }
    faulted_ = true;
    fault_ = {Severity::kError,
              code,
              where,
              std::move(element),
              std::move(message) + ", at " +
                  number_to_text_fixed(SimTime{state_.now}.seconds(), 6) + " s (tick " +
                  std::to_string(state_.now) + ")",
              std::move(remedy)};
}

void Engine::fail_place(std::uint32_t p, const char* code, std::string message,
                        std::string remedy) {
    const ElementView e = tables_->places[p];
    fail(code, "place " + std::string(e.path), e.where, std::move(message), std::move(remedy));
}

void Engine::fail_transition(std::uint32_t t, const char* code, std::string message,
                             std::string remedy) {
    const ElementView e = tables_->transitions[t];
    fail(code, "transition " + std::string(e.path), e.where, std::move(message), std::move(remedy));
}

void Engine::note(const char* code, std::string element, std::string message) {
    if (notes_.size() < kMostNotes) {
        notes_.push_back({Severity::kNote,
                          code,
                          {},
                          std::move(element),
                          std::move(message) + ", at " +
                              number_to_text_fixed(SimTime{state_.now}.seconds(), 6) + " s",
                          ""});
    }
}

// The last firings before the bound of an instant: what repeats, or grows, is named when it is
// reached.
void Engine::watch_instant(std::uint32_t t) {
    if (instant_log_.empty()) {
        instant_counts_ = state_.counts;
    }
    instant_log_.push_back(t);
    if (state_.instant_firings < options_.firings_per_instant) {
        return;
    }
    const std::string many = std::to_string(state_.instant_firings) + " firings in one instant";
    std::uint32_t growing = kNoIndex;
    std::uint32_t most = 0;
    for (std::uint32_t p = 0; p < state_.counts.size(); ++p) {
        const std::uint32_t now = state_.counts[p].total;
        const std::uint32_t was = instant_counts_[p].total;
        // A cycle of some tokens moves them by few; what grows grows with every round.
        if (now > was && now - was > most && now - was >= instant_log_.size() / 64 + 1) {
            growing = p;
            most = now - was;
        }
    }
    if (growing != kNoIndex) {
        fail_place(growing, "endless-instant", many + ", and its tokens grow without end",
                   "give what makes them a delay or a duration, or bound the place");
        return;
    }
    std::vector<std::uint32_t> cycle = instant_log_;
    std::sort(cycle.begin(), cycle.end());
    cycle.erase(std::unique(cycle.begin(), cycle.end()), cycle.end());
    std::string names;
    for (std::size_t i = 0; i < cycle.size() && i < 8; ++i) {
        names += (i == 0 ? "" : ", ") + std::string(tables_->transitions.path(cycle[i]));
    }
    if (cycle.size() > 8) {
        names += ", ...";
    }
    fail_transition(cycle.front(), "endless-instant", many + ": " + names + " repeat for ever",
                    "give one of them a delay, or one of their places a duration");
}

}  // namespace puppetri::net
