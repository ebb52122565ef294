// SPDX-License-Identifier: MIT
// How long a token or a delay lasts, and what expressions read. Drawn from the element's own
// stream; a chooser that is not random hears what the stream says and may answer otherwise.
#include <algorithm>
#include <cmath>

#include "puppetri/base/distribution.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/rational.h"
#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

namespace {
constexpr std::int64_t kOpen = -1;
constexpr std::size_t kMostInline = 16;

// -1: beyond the end of time.
std::int64_t exponential_ticks(double mean_s, std::uint64_t bits) {
    const double seconds = -mean_s * puppetri::log(uniform_from_bits(bits));
    const double exact = seconds * static_cast<double>(kTicksPerSecond);
    // Adding and taking away rounds to a whole number, ties to even
    constexpr double kRound = 0x1.8p52;
    if (exact < 0x1p51) {
        return static_cast<std::int64_t>((exact + kRound) - kRound);
    }
    return exact < 9.2e18 ? static_cast<std::int64_t>(std::nearbyint(exact)) : -1;
}

// The value of a discrete distribution that is nearest to an answer: nothing between can be drawn.
std::int64_t nearest_value(std::span<const double> parameters, std::int64_t answer,
                           std::int64_t otherwise) {
    std::int64_t best = otherwise;
    for (std::size_t i = 0; i + 1 < parameters.size(); i += 2) {
        const double exact = parameters[i] * static_cast<double>(kTicksPerSecond);
        if (!(parameters[i + 1] > 0) || !(exact >= -0.5) || !(exact < 9.2e18)) {
            continue;
        }
        const auto ticks = static_cast<std::int64_t>(std::nearbyint(exact));
        const auto distance = [answer](std::int64_t t) {
            return t < answer ? answer - t : t - answer;
        };
        if (distance(ticks) < distance(best)) {
            best = ticks;
        }
    }
    return best;
}
}  // namespace

Value Engine::read(std::uint32_t kind, std::uint32_t index) const {
    switch (static_cast<SlotKind>(kind)) {
        case SlotKind::kDatum:
            return state_.data[index];
        case SlotKind::kVariable:
            return variables_[index];
        case SlotKind::kCount:
            return state_.counts[index].total;
        case SlotKind::kReady:
            return state_.counts[index].ready;
        case SlotKind::kAttribute:
            return attributes_[index];
    }
    return 0;
}

bool Engine::evaluate(ProgramIndex program, Value& out) {
    const Evaluated e = tables_->code.evaluate(program, *this);
    out = e.value;
    return e.fault == EvalFault::kNone;
}

bool Engine::draw_exponential(double mean_s, std::uint64_t key, std::uint64_t& count, Ahead& ahead,
                              std::int64_t& ticks) {
    if (ahead.at == ahead.size || ahead.count != count) {
        // Few at first: many streams are asked only once or twice.
        const std::uint32_t more = ahead.size == 0 ? 1 : 2 * ahead.size;
        ahead.size = ahead.count != count ? 1 : std::min(more, Ahead::kMost);
        ahead.at = 0;
        for (std::uint32_t i = 0; i < ahead.size; ++i) {
            ahead.ticks[i] = exponential_ticks(mean_s, random_bits(key, count + i) ^ flip_);
        }
    }
    ticks = ahead.ticks[ahead.at++];
    ahead.count = ++count;
    return ticks >= 0;
}

bool Engine::draw_place(std::uint32_t p, std::int64_t& ticks) {
    const std::uint32_t number = tables_->place[p].duration;
    if (number == kNoIndex) {
        ticks = 0;
        return true;
    }
    const DurationTable& d = tables_->durations[number];
    switch (d.kind) {
        case DurationKind::kConstant:
            ticks = options_.timekeeper == nullptr
                        ? d.ticks
                        : wait(Timekeeper::Kind::kToken, p, d.ticks, d.ticks);
            return true;
        case DurationKind::kOpen:
            ticks = kOpen;
            return true;
        case DurationKind::kAuto:
            if (options_.timekeeper != nullptr) {
                ticks = wait(Timekeeper::Kind::kToken, p, 0, SimTime::never().ticks);
                return true;
            }
            if (options_.host == nullptr) {
                fail_place(p, "action-needs-host",
                           "its duration is asked from a movement, and nobody performs movements",
                           "run it as a scene, or give it a duration");
                return false;
            }
            ticks = kOpen;  // add_token asks
            return true;
        case DurationKind::kAs:
            ticks = sibling_ticks_[d.sibling];
            return true;
        default:
            break;
    }
    std::uint64_t none = 0;
    const bool streams = d.stream != kNoIndex;
    return draw(d, streams ? duration_keys_[d.stream] : 0,
                streams ? state_.duration_draws[d.stream] : none,
                streams ? duration_ahead_[d.stream] : kNoIndex, ChoiceKind::kDuration, p, ticks);
}

bool Engine::draw(const DurationTable& d, std::uint64_t key, std::uint64_t& count,
                  std::uint32_t ahead, ChoiceKind kind, std::uint32_t element,
                  std::int64_t& ticks) {
    const auto wrong = [&](const char* what) {
        const bool place = kind == ChoiceKind::kDuration;
        if (place) {
            fail_place(element, "negative-duration", what, "give 0 or more");
        } else {
            fail_transition(element, "negative-duration", what, "give 0 or more");
        }
        return false;
    };
    const auto wait_for = [&](std::int64_t low, std::int64_t high) {
        ticks = wait(
            kind == ChoiceKind::kDuration ? Timekeeper::Kind::kToken : Timekeeper::Kind::kDelay,
            element, low, high);
        return true;
    };
    if (d.kind == DurationKind::kConstant) {
        ticks = d.ticks;
        return options_.timekeeper == nullptr || wait_for(ticks, ticks);
    }
    if (random_ && ahead != kNoIndex) {
        return draw_exponential(d.constants[0], key, count, ahead_[ahead], ticks) ||
               wrong("a drawn duration goes beyond the end of time");
    }
    if (d.kind == DurationKind::kExpression) {
        if (!evaluate(d.a, ticks) || ticks < 0) {
            return wrong("a duration is negative or no number");
        }
        return options_.timekeeper == nullptr || wait_for(ticks, ticks);
    }
    Choice choice;
    choice.kind = kind;
    choice.element = element;
    choice.of_delay = kind == ChoiceKind::kDelay;
    if (d.kind == DurationKind::kInterval) {
        Value low = 0, high = 0;
        if (!evaluate(d.a, low) || !evaluate(d.b, high) || low < 0) {
            return wrong("a duration is negative or no number");
        }
        if (high < low) {
            return wrong("the interval ends before it begins");
        }
        if (options_.timekeeper != nullptr) {
            return wait_for(low, high);
        }
        RandomStream stream{key, count, flip_};
        ticks = stream.between(low, high);
        count = stream.count;
        choice.kind = ChoiceKind::kInterval;
        choice.low = {low};
        choice.high = {high};
    } else {
        double room[kMostInline];
        std::span<const double> parameters = d.constants;
        std::vector<double> many;
        if (d.constants.size() != d.parameters.size()) {
            double* to = room;
            if (d.parameters.size() > kMostInline) {
                many.resize(d.parameters.size());
                to = many.data();
            }
            for (std::size_t i = 0; i < d.parameters.size(); ++i) {
                Value v = 0;
                if (!evaluate(d.parameters[i].program, v)) {
                    return wrong("a parameter of its distribution cannot be computed");
                }
                to[i] = d.parameters[i].kind == ValueKind::kReal   ? real_of_value(v)
                        : d.parameters[i].kind == ValueKind::kTime ? SimTime{v}.seconds()
                                                                   : static_cast<double>(v);
            }
            parameters = {to, d.parameters.size()};
            if (!check(d.distribution, parameters)) {
                return wrong("the parameters do not fit its distribution");
            }
        }
        if (!random_) {
            const Support s = support(d.distribution, parameters);
            const auto bound = [](double x) {
                const auto t = to_ticks(x);
                return t ? t->time : SimTime::never();
            };
            choice.low = s.low > 0 ? bound(s.low) : SimTime{0};
            choice.high = bound(s.high);
            if (options_.timekeeper != nullptr) {
                return wait_for(choice.low.ticks, choice.high.ticks);
            }
        }
        RandomStream stream{key, count, flip_};
        const double seconds = sample(d.distribution, parameters, stream);
        count = stream.count;
        const double exact = seconds * static_cast<double>(kTicksPerSecond);
        if (!(exact >= -0.5)) {
            return wrong("a drawn duration is negative or no number");
        }
        if (!(exact < 9.2e18)) {
            return wrong("a drawn duration goes beyond the end of time");
        }
        ticks = static_cast<std::int64_t>(std::nearbyint(exact));
        if (!random_ && d.distribution == DistributionKind::kDiscrete) {
            choice.drawn = {ticks};
            ticks = nearest_value(parameters, chooser_->choose(choice), ticks);
            return true;
        }
    }
    if (!random_) {
        choice.drawn = {ticks};
        ticks = chooser_->choose(choice);
        PUP_REQUIRE(ticks >= choice.low.ticks && ticks <= choice.high.ticks);
    }
    return true;
}

}  // namespace puppetri::net
