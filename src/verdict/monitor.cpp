// SPDX-License-Identifier: MIT
// States of the automata, as bits:
//   after-until   bit 0 armed
//   leads to      bit 0 owes, bit 1 A held at the last moment that counted
//   takes         bit 0 A holds
//   alternate     bits 0..15 who was last, plus 1; bits 16.. which operands held at the last moment
#include "puppetri/verdict/monitor.h"

#include <algorithm>

#include "puppetri/base/require.h"

namespace puppetri::verdict {
namespace {

using net::RuleKind;

constexpr std::uint32_t kOwes = 1, kHeld = 2;

bool is_firing(const Operand& operand) { return operand.reads_firings; }

void add(std::vector<std::uint32_t>& out, std::uint32_t state) {
    if (std::find(out.begin(), out.end(), state) == out.end()) {
        out.push_back(state);
    }
}

// Calls f for each value that is possible.
template <class F>
void for_each(Truth t, F&& f) {
    if (t.may) {
        f(true);
    }
    if (!t.must) {
        f(false);
    }
}

}  // namespace

Monitor::Monitor(const Obligation& obligation) : o_(obligation) {
    PUP_REQUIRE(watches(o_.kind));
    stateless_ = o_.kind == RuleKind::kNever || o_.kind == RuleKind::kAlways ||
                 o_.kind == RuleKind::kMutex || o_.kind == RuleKind::kExactlyOne ||
                 o_.kind == RuleKind::kBounded || o_.kind == RuleKind::kOnlyIf ||
                 o_.kind == RuleKind::kPossible;
    PUP_REQUIRE(o_.kind != RuleKind::kAlternate || o_.operands.size() <= 16);
}

bool Monitor::watches(RuleKind kind) {
    switch (kind) {
        case RuleKind::kNever:
        case RuleKind::kAlways:
        case RuleKind::kMutex:
        case RuleKind::kExactlyOne:
        case RuleKind::kBounded:
        case RuleKind::kAlternate:
        case RuleKind::kOnlyIf:
        case RuleKind::kUntil:
        case RuleKind::kLeadsTo:
        case RuleKind::kTakesAtMost:
        case RuleKind::kPossible:
            return true;
        default:
            return false;
    }
}

bool Monitor::may_be_broken(const Moment& m) const {
    switch (o_.kind) {
        case RuleKind::kNever:
        case RuleKind::kPossible:  // "broken" by the moment that is looked for
            return o_.operands[0].at(m.now, m.label).may;
        case RuleKind::kBounded:
            return !o_.operands.empty() && o_.operands[0].at(m.now, m.label).may;
        case RuleKind::kAlways:
            return !o_.operands[0].at(m.now, m.label).must;
        case RuleKind::kOnlyIf: {
            // Of a firing everything is read just before it.
            const bool firing = is_firing(o_.operands[0]);
            if (firing && m.start) {
                return false;
            }
            const AtomRow& row = firing ? m.before : m.now;
            return o_.operands[0].at(row, m.label).may && !o_.operands[1].at(row, m.label).must;
        }
        default: {
            std::uint32_t may = 0, must = 0;
            for (const Operand& operand : o_.operands) {
                const Truth t = operand.at(m.now, m.label);
                may += t.may ? 1 : 0;
                must += t.must ? 1 : 0;
            }
            return may > 1 || (o_.kind == RuleKind::kExactlyOne && must != 1);
        }
    }
}

void Monitor::step(std::uint32_t state, const Moment& m, std::vector<std::uint32_t>& out) const {
    out.clear();
    if (o_.when_settled && !m.settled) {
        out.push_back(state);
        return;
    }
    if (stateless_) {
        // It goes on after a break that may be: what comes later may break it as well.
        out.push_back(0);
        if (may_be_broken(m)) {
            out.push_back(kBad);
        }
        return;
    }
    switch (o_.kind) {
        case RuleKind::kUntil: {
            const Truth a = o_.operands[0].at(m.now, m.label),
                        b = o_.operands[1].at(m.now, m.label),
                        c = o_.operands[2].at(m.now, m.label);
            for_each(c, [&](bool c_now) {
                const bool armed = (state & kOwes) != 0 && !c_now;
                for_each(b, [&](bool b_now) {
                    if (armed && b_now) {
                        add(out, kBad);
                        return;
                    }
                    for_each(a, [&](bool a_now) { add(out, armed || a_now ? kOwes : 0); });
                });
            });
            break;
        }
        case RuleKind::kLeadsTo: {
            const bool firing = is_firing(o_.operands[0]);
            const Truth a = o_.operands[0].at(m.now, m.label),
                        b = o_.operands[1].at(m.now, m.label);
            for_each(a, [&](bool a_now) {
                const bool rises = a_now && (firing || (state & kHeld) == 0);
                for_each(b, [&](bool b_now) {
                    const bool owes = ((state & kOwes) != 0 || rises) && !b_now;
                    add(out, (owes ? kOwes : 0) | (a_now && !firing ? kHeld : 0));
                });
            });
            break;
        }
        case RuleKind::kTakesAtMost:
            for_each(o_.operands[0].at(m.now, m.label),
                     [&](bool a_now) { add(out, a_now ? kOwes : 0); });
            break;
        default: {  // alternate
            const auto count = static_cast<std::uint32_t>(o_.operands.size());
            std::vector<std::uint32_t> options = {state & 0xffffu};  // bits 16..: held now
            std::vector<std::uint32_t> next;
            for (std::uint32_t i = 0; i < count; ++i) {
                const bool firing = is_firing(o_.operands[i]);
                const bool held = !firing && ((state >> (16 + i)) & 1) != 0;
                const Truth t = o_.operands[i].at(m.now, m.label);
                next.clear();
                for (const std::uint32_t option : options) {
                    for_each(t, [&](bool now) {
                        if (option == kBad) {
                            add(next, kBad);
                            return;
                        }
                        std::uint32_t s = option;
                        if (now && !held) {
                            const std::uint32_t last = s & 0xffffu;
                            if (last != 0 && last % count != i) {
                                add(next, kBad);
                                return;
                            }
                            s = (s & ~0xffffu) | (i + 1);
                        }
                        if (now && !firing) {
                            s |= 1u << (16 + i);
                        }
                        add(next, s);
                    });
                }
                options.swap(next);
            }
            out = options;
            break;
        }
    }
}

bool Monitor::when_settled() const { return o_.when_settled; }

bool Monitor::owes(std::uint32_t state) const {
    return (o_.kind == RuleKind::kLeadsTo || o_.kind == RuleKind::kTakesAtMost) && state != kBad &&
           (state & kOwes) != 0;
}

}  // namespace puppetri::verdict
