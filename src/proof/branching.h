// SPDX-License-Identifier: MIT
// All answers to all questions, one sequence after another: the chooser of those who explore. Each
// question of the engine, and each of the explorer itself, is one turn.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "puppetri/net/chooser.h"

namespace puppetri::proof {

class Branching final : public net::Chooser {
 public:
    // The first of n answers, and the others as next() moves on.
    std::uint32_t pick(std::uint32_t n) {
        if (n <= 1) {
            return 0;
        }
        if (depth_ == turns_.size()) {
            turns_.push_back({0, n});
        }
        return turns_[depth_++].taken;
    }
    // A sequence of answers is about to be asked for from its beginning.
    void rewind() {
        depth_ = 0;
        chance_ = 1;
    }
    // The next sequence. False: that was the last.
    bool next() {
        while (!turns_.empty() && turns_.back().taken + 1 >= turns_.back().options) {
            turns_.pop_back();
        }
        depth_ = 0;
        chance_ = 1;
        if (turns_.empty()) {
            return false;
        }
        ++turns_.back().taken;
        return true;
    }
    void clear() {
        turns_.clear();
        depth_ = 0;
    }

    struct Answer {
        net::ChoiceKind kind = net::ChoiceKind::kTie;
        std::uint32_t element = 0;
        std::int64_t answer = 0;
    };
    // From now on the engine's own questions and their answers are kept here.
    void record(std::vector<Answer>* answers) { answers_ = answers; }

    std::int64_t choose(const net::Choice& choice) override {
        const std::int64_t answer = answer_to(choice);
        if (choice.kind == net::ChoiceKind::kTie) {
            double all = 0;
            for (const double odds : choice.odds) {
                all += odds;
            }
            chance_ *= choice.odds[static_cast<std::size_t>(answer)] / all;
        } else if (choice.options != 0) {
            chance_ /= choice.options;
        }
        if (answers_ != nullptr) {
            answers_->push_back({choice.kind, choice.element, answer});
        }
        return answer;
    }
    // The probability of the engine's answers since rewind(): ties by odds, tokens of `any` places
    // evenly.
    double chance() const { return chance_; }
    // Of which durations and delays not all were tried. (Intervals do not say which of the two they
    // are of.)
    const std::vector<std::pair<net::ChoiceKind, std::uint32_t>>& narrowed() const {
        return narrowed_;
    }

 private:
    std::int64_t answer_to(const net::Choice& choice) {
        if (choice.options != 0) {
            return pick(choice.options);
        }
        if (choice.low == choice.high) {
            return choice.low.ticks;
        }
        // The ends of an interval; of a distribution what its stream says.
        const bool interval = choice.kind == net::ChoiceKind::kInterval;
        const std::pair<net::ChoiceKind, std::uint32_t> who{choice.kind, choice.element};
        if (std::find(narrowed_.begin(), narrowed_.end(), who) == narrowed_.end()) {
            narrowed_.push_back(who);
        }
        if (!interval) {
            return choice.drawn.ticks;
        }
        return pick(2) == 0 ? choice.low.ticks : choice.high.ticks;
    }
    struct Turn {
        std::uint32_t taken = 0, options = 0;
    };
    std::vector<Turn> turns_;
    std::size_t depth_ = 0;
    double chance_ = 1;
    std::vector<std::pair<net::ChoiceKind, std::uint32_t>> narrowed_;
    std::vector<Answer>* answers_ = nullptr;
};

}  // namespace puppetri::proof
