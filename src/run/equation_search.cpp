// SPDX-License-Identifier: MIT
// Crossings: roots of the events' quantities, found in the interpolants. Each event knows on which
// side of 0 it is; a crossing is where it is first on the other. A quantity that only touches 0
// does not cross.
#include <algorithm>
#include <cmath>

#include "equation_course.h"
#include "puppetri/base/text.h"

namespace puppetri::run {
namespace {

constexpr int kParts = 8;             // of a piece, each looked at for itself
constexpr double kTogether_s = 1e-9;  // roots that are so near occur together
constexpr std::uint32_t kPile = 3;    // so many of one event so near each other have no end

}  // namespace

SimTime crossing_time(double root_s) {
    constexpr double kSlack_ms = 1e-3, kMost_ms = 1e12;
    const double ms = std::fmin(std::ceil(root_s * 1000 - kSlack_ms), kMost_ms);
    return {static_cast<std::int64_t>(std::fmax(ms, 0)) * kTicksPerMillisecond};
}

int Equations::Course::side_of(std::uint32_t event, const Piece& piece, double t_s) const {
    double value = 0;
    if (!gap(event, piece, t_s, value)) {
        return 0;
    }
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// On which side it is just after the beginning of a piece: the beginning itself may be a root, as
// exact as roots are.
int Equations::Course::side_after(std::uint32_t event, const Piece& piece) const {
    const double begin_s = piece.step.begin_s;
    double first = 0;
    if (!gap(event, piece, begin_s, first)) {
        return 0;
    }
    if (first != 0 && just_crossed_[event] == 0) {
        return first > 0 ? 1 : -1;
    }
    double value = first;
    for (double after_s = 1e-10; after_s < 1 && begin_s + after_s < piece.end_s; after_s *= 4) {
        if (!gap(event, piece, begin_s + after_s, value)) {
            return 0;
        }
        if (std::fabs(value) > 4 * std::fabs(first) && std::fabs(value) > 1e-15) {
            break;
        }
    }
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

bool Equations::Course::wanted(const EquationSystem::Event& event, int side) const {
    return event.direction == CrossingDirection::kPasses ||
           (event.direction == CrossingDirection::kRises) == (side > 0);
}

void Equations::Course::crosses(std::uint32_t event, int side, double root_s) {
    found_.push_back({event, side, root_s});
}

bool Equations::Course::look_after_restart(double t_s, bool first, Diagnostic&) {
    const Piece& piece = pieces_.back();
    for (std::uint32_t e = 0; e < system_.events.size(); ++e) {
        const EquationSystem::Event& event = system_.events[e];
        const int before = first && event.jumps ? -1 : sides_[e];
        const int after = side_after(e, piece);
        if (event.jumps && after != 0 && before != 0 && after != before) {
            sides_[e] = before;
            crosses(e, after, t_s);
        } else if (after != 0 || !event.jumps) {
            sides_[e] = after;
        }
    }
    std::fill(just_crossed_.begin(), just_crossed_.end(), std::uint8_t{0});
    return true;
}

// Updates of difference equations jump, and what is jumped over is crossed.
bool Equations::Course::look_at_jump(const Piece& piece, Diagnostic&) {
    for (std::uint32_t e = 0; e < system_.events.size(); ++e) {
        const int side = side_of(e, piece, piece.step.begin_s);
        if (side != 0 && sides_[e] != 0 && side != sides_[e]) {
            crosses(e, side, piece.step.begin_s);
        } else if (side != 0) {
            sides_[e] = side;
        }
    }
    return !found_.empty();
}

// The last time on the old side, to the last bit.
double Equations::Course::bisect(const Piece& piece, std::uint32_t event, double old_side,
                                 double new_side, int side) const {
    for (;;) {
        const double middle = old_side + (new_side - old_side) / 2;
        if (!(middle > old_side && middle < new_side)) {
            return old_side;
        }
        (side_of(event, piece, middle) == -side ? new_side : old_side) = middle;
    }
}

// Where side * quantity is least, between from and to. Golden sections.
double Equations::Course::extremum(const Piece& piece, std::uint32_t event, double from, double to,
                                   int side) const {
    constexpr double kGolden = 0.6180339887498949;
    const auto f = [&](double t) {
        double value = 0;
        return gap(event, piece, t, value) ? side * value : 0;
    };
    double a = to - kGolden * (to - from), b = from + kGolden * (to - from);
    double fa = f(a), fb = f(b);
    for (int i = 0; i < 60 && a < b && fa > 0 && fb > 0; ++i) {
        if (fa < fb) {
            to = b;
            b = a;
            fb = fa;
            a = to - kGolden * (to - from);
            fa = f(a);
        } else {
            from = a;
            a = b;
            fa = fb;
            b = from + kGolden * (to - from);
            fb = f(b);
        }
    }
    return fa < fb ? a : b;
}

// The first crossing of the event in (from, to]; its side is that just after `from`.
bool Equations::Course::look_between(const Piece& piece, double from, double to,
                                     std::uint32_t event, double& root, bool& found) {
    found = false;
    double first = 0, last = 0;
    if (!gap(event, piece, from, first) || !gap(event, piece, to, last)) {
        return false;
    }
    int& side = sides_[event];
    const int end = last > 0 ? 1 : last < 0 ? -1 : 0;
    if (side == 0) {
        side = end;
        return true;
    }
    if (end == -side) {
        double begin = from;
        if (side * first < 0) {
            // The last root lies here, as exact as roots are: it has been on this side since.
            begin = extremum(piece, event, from, to, -side);
            if (side_of(event, piece, begin) != side) {
                side = end;
                return true;
            }
        }
        root = bisect(piece, event, begin, to, side);
        found = true;
        return true;
    }
    // It comes nearer at first and goes away at last: it may have crossed twice.
    const double moment = (to - from) * 1e-6;
    double after = 0, before = 0;
    if (!gap(event, piece, from + moment, after) || !gap(event, piece, to - moment, before)) {
        return false;
    }
    if (side * (after - first) < 0 && side * (last - before) > 0) {
        const double nearest = extremum(piece, event, from, to, side);
        if (side_of(event, piece, nearest) == -side) {
            root = bisect(piece, event, from, nearest, side);
            found = true;
        }
    }
    return true;
}

bool Equations::Course::search(double until_s, Diagnostic& fault) {
    while (found_.empty() && !system_.events.empty()) {
        if (cursor_ == pieces_.size()) {
            if (pieces_.back().end_s > until_s) {
                break;
            }
            if (!extend(fault)) {
                return false;
            }
            continue;
        }
        const Piece& piece = pieces_[cursor_];
        const double begin_s = piece.step.begin_s;
        if (piece.jump && searched_s_ <= begin_s && look_at_jump(piece, fault)) {
            break;
        }
        const double from_s = std::max(searched_s_, begin_s);
        const bool moves = enabled_ && has_rates_ && piece.end_s > from_s;
        for (int part = 0; moves && part < kParts && found_.empty(); ++part) {
            const double left = begin_s + (piece.end_s - begin_s) * part / kParts;
            const double right = part + 1 == kParts
                                     ? piece.end_s
                                     : begin_s + (piece.end_s - begin_s) * (part + 1) / kParts;
            if (right <= from_s) {
                continue;
            }
            for (std::uint32_t e = 0; e < system_.events.size(); ++e) {
                double root = 0;
                bool found = false;
                if (!look_between(piece, std::max(left, from_s), right, e, root, found)) {
                    fault =
                        problem("equations-blow-up", left,
                                "what event " + system_.events[e].name + " watches has no value",
                                "look at what it divides by, and what it takes roots of");
                    return false;
                }
                if (found) {
                    crosses(e, -sides_[e], root);
                }
            }
        }
        if (found_.empty()) {
            searched_s_ = piece.end_s;
            ++cursor_;
        }
    }
    // Without events there is nothing to search, and the way goes on as far as is asked for.
    while (system_.events.empty() && pieces_.back().end_s <= until_s) {
        if (!extend(fault)) {
            return false;
        }
    }
    if (!found_.empty() && at_ == SimTime::never()) {
        std::stable_sort(found_.begin(), found_.end(),
                         [](const Found& a, const Found& b) { return a.root_s < b.root_s; });
        root_s_ = found_.front().root_s;
        std::erase_if(found_, [&](const Found& f) { return f.root_s > root_s_ + kTogether_s; });
        std::stable_sort(found_.begin(), found_.end(),
                         [](const Found& a, const Found& b) { return a.event < b.event; });
        at_ = crossing_time(root_s_);
    }
    return true;
}

bool Equations::Course::next(const net::State& state, SimTime until, Diagnostic& fault) {
    if (begun_ && !delivered_ && !found_.empty() && at_.ticks <= state.now) {
        return true;  // what crossed before this instant comes first
    }
    last_now_s_ = SimTime{state.now}.seconds();
    const bool new_data = read_data(state);
    bool enabled = system_.enabled_by.empty();
    for (const net::PlaceIndex p : system_.enabled_by) {
        enabled = enabled || state.counts[p.value].total > 0;
    }
    if (!begun_ || new_data || enabled != enabled_ || !fired_.empty()) {
        const double t_s = delivered_ ? delivered_s_ : last_now_s_;
        if (!restart(t_s, enabled, new_data, fault)) {
            return false;
        }
        forget_before(t_s - longest_delay_s_);
    }
    delivered_ = false;
    std::fill(just_crossed_.begin(), just_crossed_.end(), std::uint8_t{0});
    for (;;) {
        if (!search(until.seconds(), fault)) {
            return false;
        }
        if (found_.empty()) {
            return true;
        }
        const bool heard = std::any_of(found_.begin(), found_.end(), [&](const Found& f) {
            return wanted(system_.events[f.event], f.side);
        });
        if (heard) {
            break;
        }
        pass_roots();
    }
    at_ = std::max(at_, SimTime{state.now});
    const std::int64_t ms = at_.ticks / kTicksPerMillisecond;
    const bool many = ms == crowded_ms_ && crowd_ > options_.crossings_per_ms;
    if (at_ <= until && (many || (near_ >= kPile && root_s_ - delivered_s_ <= kTogether_s))) {
        fault = problem("crossings-accumulate", root_s_,
                        "event " + system_.events[found_.front().event].name +
                            " occurs again and again, ever sooner: its times pile up",
                        "end it in the net before: let a firing reset the variables to rest, or "
                        "take the token from what `while` names");
        return false;
    }
    return true;
}

// The search goes on behind the roots that were found, on the other side.
void Equations::Course::pass_roots() {
    for (const Found& f : found_) {
        sides_[f.event] = f.side;
    }
    searched_s_ = std::max(searched_s_, root_s_);
    // Behind a jump that has been looked at.
    if (cursor_ < pieces_.size() && pieces_[cursor_].jump &&
        searched_s_ <= pieces_[cursor_].step.begin_s) {
        pieces_[cursor_].jump = false;
    }
    found_.clear();
    at_ = SimTime::never();
}

void Equations::Course::crossings(std::vector<net::EventIndex>& out) const {
    for (const Found& f : found_) {
        if (wanted(system_.events[f.event], f.side)) {
            out.push_back(system_.events[f.event].event);
        }
    }
}

void Equations::Course::deliver() {
    const std::int64_t ms = at_.ticks / kTicksPerMillisecond;
    crowd_ = ms == crowded_ms_ ? crowd_ + 1 : 1;
    crowded_ms_ = ms;
    const bool near = !found_.empty() && found_.front().event == last_event_ &&
                      root_s_ - delivered_s_ <= kTogether_s;
    near_ = near ? near_ + 1 : 0;
    last_event_ = found_.empty() ? last_event_ : found_.front().event;
    delivered_ = true;
    delivered_s_ = root_s_;
    for (const Found& f : found_) {
        just_crossed_[f.event] = 1;
    }
    pass_roots();
}

}  // namespace puppetri::run
