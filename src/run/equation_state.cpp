// SPDX-License-Identifier: MIT
// A course as bytes: what decides its future, and the past as far as delays look.
#include <algorithm>

#include "bytes.h"
#include "equation_course.h"

namespace puppetri::run {
namespace {

constexpr std::uint64_t kMostSteps = 1u << 24;  // of one segment, to be made again

// How many rows interpolants have; one row is a step in which nothing changes.
bool fits(OdeMethod method, std::size_t rows) {
    return rows == 1 || (method == OdeMethod::kDormandPrince ? rows == 5
                         : method == OdeMethod::kRodas       ? rows == 4
                                                             : rows >= 2 && rows <= 8);
}

}  // namespace

void Equations::Course::save(std::vector<std::uint8_t>& out) const {
    BytesWriter w(out);
    w.number(n_);
    w.number((begun_ ? 1u : 0u) + (enabled_ ? 2u : 0u) + (delivered_ ? 4u : 0u));
    const double from_s =
        (delivered_ ? std::min(last_now_s_, delivered_s_) : last_now_s_) - longest_delay_s_;
    std::size_t first = 0;
    while (first + 1 < pieces_.size() && first < cursor_ &&
           pieces_[first + 1].step.begin_s < from_s) {
        ++first;
    }
    w.number(pieces_.size() - first);
    for (std::size_t i = first; i < pieces_.size(); ++i) {
        const Piece& p = pieces_[i];
        w.real(p.end_s);
        w.real(p.step.begin_s);
        w.real(p.step.length_s);
        w.number(static_cast<std::uint64_t>(p.step.method) * 4 + (p.jump ? 2u : 0u));
        w.reals(p.step.rows);
        w.reals(data_rows_[p.data]);
    }
    w.number(cursor_ - first);
    w.reals(data_);
    w.real(solver_.now_s());
    w.real(solver_.next_s());
    w.reals(solver_.x());
    if (system_.options.method == OdeMethod::kGiven) {
        w.real(segment_.begin_s);
        w.real(segment_.until_s);
        w.number(segment_.steps);
        w.reals(segment_.x);
        w.reals(segment_.data);
    }
    w.number(kinks_.size());
    for (const Kink& k : kinks_) {
        w.real(k.at_s);
        w.number(k.degree);
    }
    for (std::size_t e = 0; e < sides_.size(); ++e) {
        w.number(static_cast<std::uint64_t>(sides_[e] + 1) + 4u * just_crossed_[e]);
    }
    for (const double x : {searched_s_, root_s_, delivered_s_, last_now_s_}) {
        w.real(x);
    }
    w.number(static_cast<std::uint64_t>(at_.ticks));
    w.number(found_.size());
    for (const Found& f : found_) {
        w.number(f.event);
        w.number(static_cast<std::uint64_t>(f.side + 1));
        w.real(f.root_s);
    }
    w.number(fired_.size());
    for (const net::TransitionIndex t : fired_) {
        w.number(t.value);
    }
    w.number(static_cast<std::uint64_t>(crowded_ms_));
    w.number(crowd_);
    w.number(last_event_);
    w.number(near_);
}

bool Equations::Course::restore(std::span<const std::uint8_t> bytes) {
    BytesReader r(bytes);
    if (r.number() != n_) {
        return false;
    }
    const std::uint64_t flags = r.number();
    Course made(system_, options_, nullptr);
    made.begun_ = (flags & 1) != 0;
    made.enabled_ = (flags & 2) != 0;
    made.delivered_ = (flags & 4) != 0;
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        Piece p;
        p.end_s = r.real();
        p.step.begin_s = r.real();
        p.step.length_s = r.real();
        const std::uint64_t kind = r.number();
        r.good = r.good && kind / 4 <= static_cast<std::uint64_t>(OdeMethod::kGiven);
        p.step.method = static_cast<OdeMethod>(kind / 4 % 3);
        p.jump = (kind & 2) != 0;
        p.step.size = static_cast<std::uint32_t>(n_);
        p.step.rows = r.reals();
        const std::vector<double> data = r.reals();
        const std::size_t rows = n_ == 0 ? 1 : p.step.rows.size() / n_;
        r.good = r.good && data.size() == system_.data.size() && p.end_s >= p.step.begin_s &&
                 p.step.rows.size() == rows * n_ && p.step.length_s >= 0 &&
                 fits(p.step.method, rows) &&
                 (made.pieces_.empty() || made.pieces_.back().step.begin_s <= p.step.begin_s);
        if (made.data_rows_.empty() || made.data_rows_.back() != data) {
            made.data_rows_.push_back(data);
        }
        p.data = static_cast<std::uint32_t>(made.data_rows_.size() - 1);
        made.pieces_.push_back(std::move(p));
    }
    made.cursor_ = static_cast<std::size_t>(r.number());
    made.data_ = r.reals();
    const double now_s = r.real(), next_s = r.real();
    const std::vector<double> x = r.reals();
    if (system_.options.method == OdeMethod::kGiven) {
        Segment& s = made.segment_;
        s.begin_s = r.real();
        s.until_s = r.real();
        s.steps = r.number();
        s.x = r.reals();
        s.data = r.reals();
        r.good = r.good && s.until_s >= s.begin_s && s.steps < kMostSteps &&
                 (s.x.size() == n_ || (s.x.empty() && s.steps == 0)) &&
                 (s.x.empty() || s.data.size() == system_.data.size());
    }
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        const double at_s = r.real();
        made.kinks_.push_back({at_s, static_cast<std::uint32_t>(r.number())});
    }
    for (std::size_t e = 0; e < sides_.size(); ++e) {
        const std::uint64_t side = r.number();
        r.good = r.good && (side & 3) <= 2 && side < 8;
        made.sides_[e] = static_cast<int>(side & 3) - 1;
        made.just_crossed_[e] = static_cast<std::uint8_t>(side >> 2);
    }
    made.searched_s_ = r.real();
    made.root_s_ = r.real();
    made.delivered_s_ = r.real();
    made.last_now_s_ = r.real();
    made.at_.ticks = static_cast<std::int64_t>(r.number());
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        Found f;
        const std::uint64_t event = r.number(), side = r.number();
        f.root_s = r.real();
        r.good = r.good && event < system_.events.size() && side <= 2;
        f.event = static_cast<std::uint32_t>(event);
        f.side = static_cast<int>(side) - 1;
        made.found_.push_back(f);
    }
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        made.fired_.push_back({static_cast<std::uint32_t>(r.number())});
    }
    made.crowded_ms_ = static_cast<std::int64_t>(r.number());
    made.crowd_ = static_cast<std::uint32_t>(r.number());
    made.last_event_ = static_cast<std::uint32_t>(r.number());
    made.near_ = static_cast<std::uint32_t>(r.number());
    if (!r.good || !r.at_end() || made.cursor_ > made.pieces_.size() ||
        made.begun_ == made.pieces_.empty() ||
        (made.begun_ && made.data_.size() != system_.data.size()) ||
        (x.size() != n_ && !x.empty())) {
        return false;
    }
    // What was recorded before stays to be looked at.
    if (options_.record && !pieces_.empty() && !made.pieces_.empty()) {
        std::vector<Piece> earlier;
        const double from_s = made.pieces_.front().step.begin_s;
        for (const Piece& p : pieces_) {
            if (p.step.begin_s < from_s) {
                earlier.push_back(p);
                earlier.back().end_s = std::min(p.end_s, from_s);
            }
        }
        const auto shift = static_cast<std::uint32_t>(data_rows_.size());
        for (Piece& p : made.pieces_) {
            p.data += shift;
        }
        made.cursor_ += earlier.size();
        earlier.insert(earlier.end(), made.pieces_.begin(), made.pieces_.end());
        made.pieces_ = std::move(earlier);
        std::vector<std::vector<double>> rows = data_rows_;
        rows.insert(rows.end(), made.data_rows_.begin(), made.data_rows_.end());
        made.data_rows_ = std::move(rows);
    }
    begun_ = made.begun_;
    enabled_ = made.enabled_;
    delivered_ = made.delivered_;
    pieces_ = std::move(made.pieces_);
    data_rows_ = std::move(made.data_rows_);
    data_ = std::move(made.data_);
    kinks_ = std::move(made.kinks_);
    sides_ = std::move(made.sides_);
    just_crossed_ = std::move(made.just_crossed_);
    searched_s_ = made.searched_s_;
    cursor_ = made.cursor_;
    root_s_ = made.root_s_;
    delivered_s_ = made.delivered_s_;
    last_now_s_ = made.last_now_s_;
    at_ = made.at_;
    found_ = std::move(made.found_);
    fired_ = std::move(made.fired_);
    crowded_ms_ = made.crowded_ms_;
    crowd_ = made.crowd_;
    last_event_ = made.last_event_;
    near_ = made.near_;
    segment_ = std::move(made.segment_);
    if (x.size() == n_ && has_rates_ && system_.options.method != OdeMethod::kGiven) {
        solver_.resume(*this, now_s, x, next_s);
    }
    return true;
}

void Equations::save(std::vector<std::uint8_t>& out) const {
    for (const auto& c : courses_) {
        std::vector<std::uint8_t> bytes;
        c->save(bytes);
        BytesWriter(out).number(bytes.size());
        out.insert(out.end(), bytes.begin(), bytes.end());
    }
}

bool Equations::restore(std::span<const std::uint8_t> bytes) {
    // All or nothing: tried on copies first.
    std::vector<std::span<const std::uint8_t>> parts;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
        BytesReader r(bytes);
        const std::uint64_t size = r.number();
        if (!r.good || size > bytes.size() - 8) {
            return false;
        }
        parts.push_back(bytes.subspan(8, static_cast<std::size_t>(size)));
        Course trial(systems_[i], options_, nullptr);
        if (!trial.restore(parts.back())) {
            return false;
        }
        bytes = bytes.subspan(8 + static_cast<std::size_t>(size));
    }
    if (!bytes.empty()) {
        return false;
    }
    for (std::size_t i = 0; i < courses_.size(); ++i) {
        courses_[i]->restore(parts[i]);
    }
    return true;
}

}  // namespace puppetri::run
