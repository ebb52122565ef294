// SPDX-License-Identifier: MIT
// The choosers that are not the engine's own.
#include "puppetri/net/chooser.h"

#include <algorithm>

namespace puppetri::net {

namespace {

// What a chooser without an opinion says.
std::int64_t usual(const Choice& choice) { return choice.options != 0 ? 0 : choice.drawn.ticks; }

bool in_bounds(const Choice& choice, std::int64_t answer) {
    return choice.options != 0 ? answer >= 0 && answer < static_cast<std::int64_t>(choice.options)
                               : answer >= choice.low.ticks && answer <= choice.high.ticks;
}

}  // namespace

std::int64_t RandomChooser::choose(const Choice& choice) { return usual(choice); }

std::int64_t ScriptedChooser::choose(const Choice& choice) {
    if (exhausted()) {
        return usual(choice);
    }
    const std::int64_t answer = answers_[next_++];
    if (in_bounds(choice, answer)) {
        return answer;
    }
    misfit_ = true;
    return choice.options != 0
               ? std::clamp<std::int64_t>(answer, 0, static_cast<std::int64_t>(choice.options) - 1)
               : std::clamp(answer, choice.low.ticks, choice.high.ticks);
}

std::int64_t RecordingChooser::choose(const Choice& choice) {
    const std::int64_t answer = inner_->choose(choice);
    answers_.push_back(answer);
    return answer;
}

std::int64_t ExhaustiveChooser::choose(const Choice& choice) {
    std::uint32_t options = choice.options;
    const bool timed = options == 0;
    if (timed) {
        // Of an interval some points, at most all of them; of a distribution what its stream says.
        const std::int64_t span = choice.high.ticks - choice.low.ticks;
        options = choice.kind != ChoiceKind::kInterval ? 1
                  : span < interval_points_            ? static_cast<std::uint32_t>(span) + 1
                                                       : interval_points_;
    }
    if (depth_ == turns_.size()) {
        turns_.push_back({0, options});
    }
    const std::uint32_t taken = turns_[depth_++].taken;
    if (!timed) {
        return taken;
    }
    if (choice.kind != ChoiceKind::kInterval) {
        return choice.drawn.ticks;
    }
    if (options <= 1) {
        return choice.low.ticks;
    }
    const std::int64_t span = choice.high.ticks - choice.low.ticks;
    // Without overflow: span / (options - 1) * taken, the rest spread.
    const std::int64_t whole = span / (options - 1);
    const std::int64_t rest = span % (options - 1);
    return choice.low.ticks + whole * taken + rest * taken / (options - 1);
}

bool ExhaustiveChooser::next() {
    while (!turns_.empty() && turns_.back().taken + 1 >= turns_.back().options) {
        turns_.pop_back();
    }
    depth_ = 0;
    if (turns_.empty()) {
        return false;
    }
    ++turns_.back().taken;
    return true;
}

}  // namespace puppetri::net
