// SPDX-License-Identifier: MIT
// The one way in which a transition fires: arcs bind in source order, each takes the first match of
// its discipline, and steps back until the guard holds. Only a place of discipline `any` leaves a
// choice: among those of its tokens with which the rest can still be bound.
#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

namespace {

bool takes_token(ArcKind kind) { return kind <= ArcKind::kTakeAllNow; }
bool wants_ready(ArcKind kind) {
    return kind == ArcKind::kTake || kind == ArcKind::kRead || kind == ArcKind::kTakeAll ||
           kind == ArcKind::kUnlessReady;
}

}  // namespace

bool Engine::bind(const Special& s, bool firing) {
    chosen_.clear();
    std::fill(bound_.begin(), bound_.begin() + s.variables, 0);
    return bind_from(s, 0, 0, 0, firing);
}

std::int64_t Engine::time_left(const Token& token) const {
    if (token.ready_at == SimTime::never().ticks) {
        return token.ready_at;
    }
    if (waits(token.ready_at)) {
        return token.ready_at;
    }
    return token.ready ? 0 : std::max<std::int64_t>(0, token.ready_at - state_.now);
}

// Does the token have the attributes that the arc asks for? Binds the arc's variables, marked with
// `mark`; on a no the caller unbinds.
bool Engine::matches(const ArcTable& arc, std::uint32_t slot, std::uint32_t mark) {
    const RichTokens& place = state_.rich[arc.rich];
    const std::uint32_t width = tables_->rich[arc.rich].attributes;
    for (const PatternTable& pattern : arc.pattern) {
        const Value v = place.values[std::size_t{slot} * width + pattern.attribute];
        if (pattern.binds == kNoIndex) {
            Value wanted = 0;
            const Evaluated e = tables_->code.evaluate(pattern.equals, *this);
            wanted = e.value;
            if (e.fault != EvalFault::kNone) {
                if (!quiet_) {
                    fail_place(arc.place, "evaluation-fault",
                               std::string("a pattern fails: ") + name_of(e.fault),
                               "mend the expression");
                }
                return false;
            }
            if (wanted != v) {
                return false;
            }
        } else if (bound_[pattern.binds] != 0) {
            if (variables_[pattern.binds] != v) {
                return false;
            }
        } else {
            variables_[pattern.binds] = v;
            bound_[pattern.binds] = mark;
        }
    }
    if (arc.time_left != kNoIndex && bound_[arc.time_left] == 0) {
        variables_[arc.time_left] = time_left(place.pool[slot]);
        bound_[arc.time_left] = mark;
    }
    return true;
}

void Engine::unbind(const ArcTable& arc, std::uint32_t mark) {
    for (const PatternTable& pattern : arc.pattern) {
        if (pattern.binds != kNoIndex && bound_[pattern.binds] == mark) {
            bound_[pattern.binds] = 0;
        }
    }
    if (arc.time_left != kNoIndex && bound_[arc.time_left] == mark) {
        bound_[arc.time_left] = 0;
    }
}

// Arcs that take share no token; of those that read, parallel ones of one kind add.
bool Engine::chosen_before(const ArcTable& arc, std::uint32_t slot) const {
    for (const Chosen& c : chosen_) {
        if (c.rich == arc.rich && c.slot == slot &&
            (takes_token(c.kind) ? takes_token(arc.kind) : c.kind == arc.kind)) {
            return true;
        }
    }
    return false;
}

bool Engine::try_token(const Special& s, std::size_t number, std::uint32_t copy,
                       std::uint32_t position, bool firing) {
    const ArcTable& arc = s.arcs[number];
    const std::uint32_t slot = state_.rich[arc.rich].order[position];
    const auto mark = static_cast<std::uint32_t>(chosen_.size()) + 1;
    if (matches(arc, slot, mark)) {
        chosen_.push_back({arc.rich, slot, arc.kind});
        const bool more = copy + 1 < arc.weight;
        if (bind_from(s, more ? number : number + 1, more ? copy + 1 : 0, more ? position + 1 : 0,
                      firing)) {
            return true;
        }
        chosen_.resize(mark - 1);
    }
    unbind(arc, mark);
    return false;
}

// The arc's `copy`-th token at position `from` or later of the discipline's order.
bool Engine::bind_from(const Special& s, std::size_t number, std::uint32_t copy, std::uint32_t from,
                       bool firing) {
    if (number == s.arcs.size()) {
        return guard_holds(s);
    }
    const ArcTable& arc = s.arcs[number];
    if (arc.rich == kNoIndex) {
        return bind_from(s, number + 1, 0, 0, firing);  // `all` of a place without records
    }
    const RichTokens& place = state_.rich[arc.rich];
    const auto end = static_cast<std::uint32_t>(place.order.size());
    from = std::max(from, place.head);
    if (arc.kind == ArcKind::kUnless || arc.kind == ArcKind::kUnlessReady ||
        arc.kind == ArcKind::kTakeAll || arc.kind == ArcKind::kTakeAllNow) {
        const std::size_t before = chosen_.size();
        std::uint32_t found = 0;
        for (std::uint32_t i = from; i < end; ++i) {
            const std::uint32_t slot = place.order[i];
            if ((wants_ready(arc.kind) && !place.pool[slot].ready) ||
                (takes_token(arc.kind) && chosen_before(arc, slot)) ||
                !matches(arc, slot, kNoIndex)) {
                continue;
            }
            ++found;
            if (takes_token(arc.kind)) {
                chosen_.push_back({arc.rich, slot, arc.kind});
            }
        }
        if (!takes_token(arc.kind) && found >= arc.weight) {
            return false;
        }
        if (bind_from(s, number + 1, 0, 0, firing)) {
            return true;
        }
        chosen_.resize(before);
        return false;
    }
    if (firing && tables_->rich[arc.rich].discipline == Discipline::kAny) {
        return bind_any(s, number, copy, place.head, end);
    }
    for (std::uint32_t i = from; i < end; ++i) {
        const std::uint32_t slot = place.order[i];
        if ((wants_ready(arc.kind) && !place.pool[slot].ready) || chosen_before(arc, slot)) {
            continue;
        }
        const std::uint32_t alike = firing ? unordered_from(arc.rich, i) : 1;
        if (alike > 1 ? bind_any(s, number, copy, i, i + alike)
                      : try_token(s, number, copy, i, firing)) {
            return true;
        }
        if (faulted_) {
            return false;
        }
        i += alike - 1;
    }
    return false;
}

// Draws one of the tokens at these positions with which the rest can be bound.
bool Engine::bind_any(const Special& s, std::size_t number, std::uint32_t copy, std::uint32_t from,
                      std::uint32_t end) {
    const ArcTable& arc = s.arcs[number];
    const RichTokens& place = state_.rich[arc.rich];
    options_list_.clear();
    const std::size_t before = chosen_.size();
    const auto mark = static_cast<std::uint32_t>(before) + 1;
    for (std::uint32_t i = from; i < end; ++i) {
        const std::uint32_t slot = place.order[i];
        if ((wants_ready(arc.kind) && !place.pool[slot].ready) || chosen_before(arc, slot)) {
            continue;
        }
        // Looking ahead, later copies may come before this one in the order: the choice is of sets.
        bool fits = false;
        if (matches(arc, slot, mark)) {
            chosen_.push_back({arc.rich, slot, arc.kind});
            const bool more = copy + 1 < arc.weight;
            fits = bind_from(s, more ? number : number + 1, more ? copy + 1 : 0, 0, false);
            // A success leaves bindings behind: all that were made after this token.
            chosen_.resize(before);
            for (std::uint32_t& b : bound_) {
                b = b >= mark ? 0 : b;
            }
        } else {
            unbind(arc, mark);
        }
        if (fits) {
            options_list_.push_back(slot);
        }
    }
    if (options_list_.empty()) {
        return false;
    }
    const auto count = static_cast<std::uint32_t>(options_list_.size());
    std::int64_t answer = 0;
    if (count > 1) {
        const std::uint32_t number_of_stream = tables_->rich[arc.rich].token_stream;
        if (number_of_stream != kNoIndex) {  // else an order that the timekeeper leaves open
            RandomStream stream{token_keys_[number_of_stream],
                                state_.token_draws[number_of_stream]};
            answer = static_cast<std::int64_t>(stream.below(count));
            state_.token_draws[number_of_stream] = stream.count;
        }
        if (!random_) {
            Choice choice;
            choice.kind = ChoiceKind::kToken;
            choice.element = arc.place;
            choice.options = count;
            answer = chooser_->choose(choice);
            PUP_REQUIRE(answer >= 0 && answer < count);
        }
    }
    const std::uint32_t slot = options_list_[static_cast<std::size_t>(answer)];
    matches(arc, slot, mark);
    chosen_.push_back({arc.rich, slot, arc.kind});
    const bool more = copy + 1 < arc.weight;
    return bind_from(s, more ? number : number + 1, more ? copy + 1 : 0, 0, true);
}

}  // namespace puppetri::net
