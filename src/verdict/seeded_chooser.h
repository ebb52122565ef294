// SPDX-License-Identifier: MIT
// Chances of a run whose answers are kept, so that it can be played again from them.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/net/chooser.h"

namespace puppetri::verdict {

// Number 0 takes the first option and what the streams say; the others draw: options evenly, of
// intervals the ends as often as what lies between.
class SeededChooser final : public net::Chooser {
 public:
    explicit SeededChooser(std::uint64_t number) : number_(number) {}

    std::int64_t choose(const net::Choice& choice) override {
        const std::uint64_t luck =
            number_ == 0 ? 0 : mix64(number_ * 0x9e3779b97f4a7c15u + answers_.size());
        std::int64_t answer = 0;
        if (choice.options != 0) {
            answer = number_ == 0 ? 0 : static_cast<std::int64_t>(luck % choice.options);
        } else {
            answer = choice.drawn.ticks;
            if (choice.kind == net::ChoiceKind::kInterval && luck % 3 != 0) {
                answer = luck % 3 == 1 ? choice.low.ticks : choice.high.ticks;
            }
            answer = std::clamp(answer, choice.low.ticks, choice.high.ticks);
        }
        answers_.push_back(answer);
        return answer;
    }
    const std::vector<std::int64_t>& answers() const { return answers_; }

 private:
    std::uint64_t number_;
    std::vector<std::int64_t> answers_;
};

}  // namespace puppetri::verdict
