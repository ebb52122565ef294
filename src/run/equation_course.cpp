// SPDX-License-Identifier: MIT
#include "equation_course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "puppetri/base/require.h"
#include "puppetri/base/text.h"

namespace puppetri::run {
namespace {

constexpr double kForEver = 1e300;
constexpr std::uint32_t kDegrees = 5;  // a kink that is smoother than the method's order is none

double seconds_of(std::int64_t ticks) { return SimTime{ticks}.seconds(); }

double as_real(ValueKind kind, Value v) {
    switch (kind) {
        case ValueKind::kReal:
            return real_of_value(v);
        case ValueKind::kTime:
            return seconds_of(v);
        default:
            return static_cast<double>(v);
    }
}

}  // namespace

Equations::Course::Course(const EquationSystem& system, const EquationsOptions& options,
                          std::unique_ptr<StepSource> source)
    : system_(system),
      options_(options),
      n_(system.variables.size()),
      solver_([&] {
          OdeOptions o = system.options;
          o.watched_from = static_cast<std::uint32_t>(system.variables.size());
          for (const EquationSystem::Past& p : system.pasts) {
              // What is looked back at has been solved already.
              o.most_s = std::min(o.most_s, p.ago_s);
          }
          return o;
      }()),
      source_(std::move(source)) {
    for (const EquationSystem::Past& p : system.pasts) {
        longest_delay_s_ = std::max(longest_delay_s_, p.ago_s);
    }
    for (std::uint32_t e = 0; e < system.events.size(); ++e) {
        if (!system.events[e].plain) {
            watched_.push_back(e);
        }
    }
    n_ += watched_.size();
    has_rates_ = !watched_.empty();
    for (const EquationSystem::Variable& v : system.variables) {
        has_rates_ = has_rates_ || v.rate.valid();
    }
    sides_.assign(system.events.size(), 0);
    just_crossed_.assign(system.events.size(), 0);
    rates_locals_.resize(system.locals.size());
    ahead_.resize(n_);
}

// ---- programs

Value Equations::Course::Reader::read(std::uint32_t kind, std::uint32_t index) const {
    switch (static_cast<EquationSlot>(kind)) {
        case EquationSlot::kTime:
            return value_of_real(t_s);
        case EquationSlot::kLocal:
            return value_of_real(locals[index]);
        case EquationSlot::kVariable:
            return value_of_real(x[index]);
        case EquationSlot::kPast: {
            const EquationSystem::Past& p = course->system_.pasts[index];
            return value_of_real(course->past(p.variable, t_s - p.ago_s));
        }
        case EquationSlot::kDatum:
            return value_of_real(data[index]);
        case EquationSlot::kInput:
            break;
    }
    return 0;
}

bool Equations::Course::evaluate(const Code& code, ProgramIndex program, const Reader& reader,
                                 double& out) {
    const Evaluated e = code.evaluate(program, reader);
    out = real_of_value(e.value);
    return e.fault == EvalFault::kNone;
}

bool Equations::Course::fill_locals(Reader& reader) const {
    for (std::size_t i = 0; i < system_.locals.size(); ++i) {
        if (!evaluate(system_.code, system_.locals[i], reader, reader.locals[i])) {
            return false;
        }
    }
    return true;
}

bool Equations::Course::rates(double t_s, std::span<const double> x, std::span<double> out) {
    Reader& reader = rates_reader_;
    reader.course = this;
    reader.t_s = t_s;
    reader.x = x.data();
    reader.data = data_.data();
    reader.locals = rates_locals_.data();
    if (!fill_locals(reader)) {
        return false;
    }
    const std::size_t variables = system_.variables.size();
    for (std::size_t i = 0; i < variables; ++i) {
        out[i] = 0;
        const ProgramIndex rate = system_.variables[i].rate;
        if (rate.valid() && !evaluate(system_.code, rate, reader, out[i])) {
            return false;
        }
    }
    if (watched_.empty()) {
        return true;
    }
    // How fast the quantities of events change along the way.
    constexpr double kMoment_s = 1e-7;
    for (std::size_t k = 0; k < watched_.size(); ++k) {
        if (!evaluate(system_.code, system_.events[watched_[k]].value, reader,
                      out[variables + k])) {
            return false;
        }
    }
    for (std::size_t i = 0; i < variables; ++i) {
        ahead_[i] = x[i] + kMoment_s * out[i];
    }
    reader.t_s = t_s + kMoment_s;
    reader.x = ahead_.data();
    if (!fill_locals(reader)) {
        return false;
    }
    for (std::size_t k = 0; k < watched_.size(); ++k) {
        double later = 0;
        if (!evaluate(system_.code, system_.events[watched_[k]].value, reader, later)) {
            return false;
        }
        out[variables + k] = (later - out[variables + k]) / (reader.t_s - t_s);
    }
    return true;
}

// ---- the course so far

const Equations::Course::Piece& Equations::Course::piece_at(double t_s) const {
    PUP_REQUIRE(!pieces_.empty());
    const auto after =
        std::upper_bound(pieces_.begin(), pieces_.end(), t_s,
                         [](double t, const Piece& p) { return t < p.step.begin_s; });
    return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

double Equations::Course::at(const Piece& piece, double t_s, std::uint32_t variable) {
    const double since = std::clamp(t_s, piece.step.begin_s, piece.end_s) - piece.step.begin_s;
    return piece.step.at(since > 0 ? std::min(since / piece.step.length_s, 1.0) : 0, variable);
}

double Equations::Course::past(std::uint32_t variable, double t_s) const {
    if (!pieces_.empty() && t_s >= pieces_.front().step.begin_s) {
        return at(piece_at(t_s), t_s, variable);
    }
    const EquationSystem::Variable& v = system_.variables[variable];
    double out = v.initial;
    if (v.before.valid()) {
        Reader reader;
        reader.course = this;
        reader.t_s = t_s;
        if (!evaluate(system_.code, v.before, reader, out)) {
            out = std::numeric_limits<double>::quiet_NaN();
        }
    }
    return out;
}

double Equations::Course::value(std::uint32_t variable, double t_s) const {
    return past(variable, t_s);
}

double Equations::Course::output(ProgramIndex program, double t_s) const {
    thread_local std::vector<double> x, locals, none;  // scratch: results never depend on it
    x.resize(n_);
    locals.resize(system_.locals.size());
    for (std::uint32_t i = 0; i < system_.variables.size(); ++i) {
        x[i] = past(i, t_s);
    }
    none.assign(system_.data.size(), 0);
    Reader reader;
    reader.course = this;
    reader.t_s = t_s;
    reader.x = x.data();
    reader.data = pieces_.empty() ? none.data() : data_rows_[piece_at(t_s).data].data();
    reader.locals = locals.data();
    double out = 0;
    return fill_locals(reader) && evaluate(system_.code, program, reader, out) ? out : 0;
}

// The quantity of an event at t_s: crosses 0. False: it has no value there.
bool Equations::Course::gap(std::uint32_t event, const Piece& piece, double t_s,
                            double& out) const {
    thread_local std::vector<double> x, locals;
    x.resize(n_);
    locals.resize(system_.locals.size());
    for (std::uint32_t i = 0; i < n_; ++i) {
        x[i] = at(piece, t_s, i);
    }
    Reader reader;
    reader.course = this;
    reader.t_s = t_s;
    reader.x = x.data();
    reader.data = data_rows_[piece.data].data();
    reader.locals = locals.data();
    return fill_locals(reader) && evaluate(system_.code, system_.events[event].value, reader, out);
}

void Equations::Course::forget_before(double t_s) {
    if (options_.record || pieces_.size() < 64) {
        return;
    }
    std::size_t first = 0;
    while (first + 1 < pieces_.size() && pieces_[first + 1].step.begin_s < t_s) {
        ++first;
    }
    first = std::min(first, cursor_);
    if (first > pieces_.size() / 2) {
        cursor_ -= first;
        pieces_.erase(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

// ---- what the net does

void Equations::Course::fired(net::TransitionIndex transition) {
    for (const EquationSystem::Reset& r : system_.resets) {
        if (r.transition == transition) {
            fired_.push_back(transition);
            return;
        }
    }
}

bool Equations::Course::read_data(const net::State& state) {
    std::vector<double> now;
    for (const EquationSystem::Datum& d : system_.data) {
        now.push_back(as_real(d.kind, state.data[d.datum.value]));
    }
    const bool changed = now != data_ || data_rows_.empty();
    data_ = std::move(now);
    return changed;
}

bool Equations::Course::apply_resets(double t_s, std::vector<double>& x, Diagnostic& fault) {
    for (const net::TransitionIndex t : fired_) {
        // All of one firing at once, from the values before it.
        const std::vector<double> before = x;
        Reader reader;
        reader.course = this;
        reader.t_s = t_s;
        reader.x = before.data();
        reader.data = data_.data();
        reader.locals = rates_locals_.data();
        bool good = fill_locals(reader);
        for (const EquationSystem::Reset& r : system_.resets) {
            if (good && r.transition == t) {
                good = evaluate(system_.code, r.value, reader, x[r.variable]);
            }
        }
        if (!good) {
            fault = problem("equations-blow-up", t_s,
                            "what it is reset to has no value, with " + state_text(before),
                            "look at what this divides by");
            return false;
        }
    }
    fired_.clear();
    return true;
}

// Everything begins anew at t_s with what the net says now: the pieces after t_s never were.
bool Equations::Course::restart(double t_s, bool enabled, bool new_data, Diagnostic& fault) {
    std::vector<double> x(n_);
    if (begun_) {
        while (pieces_.size() > 1 && pieces_.back().step.begin_s > t_s) {
            pieces_.pop_back();
        }
        Piece& last = pieces_.back();
        last.end_s = std::clamp(t_s, last.step.begin_s, last.end_s);
        for (std::uint32_t i = 0; i < n_; ++i) {
            x[i] = at(last, t_s, i);
        }
        std::erase_if(kinks_, [&](const Kink& k) { return k.at_s <= t_s; });
    } else {
        for (std::uint32_t i = 0; i < system_.variables.size(); ++i) {
            x[i] = system_.variables[i].initial;
        }
    }
    const bool first = !begun_;
    begun_ = true;
    enabled_ = enabled;
    if (new_data || data_rows_.empty()) {
        data_rows_.push_back(data_);
    }
    if (!apply_resets(t_s, x, fault)) {
        return false;
    }
    push_kinks(t_s, 0);
    found_.clear();
    at_ = SimTime::never();
    // A piece without length holds what it begins with, until the first step.
    const bool goes = enabled && has_rates_;
    Piece piece;
    piece.step = OdeStep::constant(t_s, goes ? 0 : kForEver, x);
    piece.end_s = goes ? t_s : enabled ? next_stop(t_s) : kForEver;
    piece.data = static_cast<std::uint32_t>(data_rows_.size() - 1);
    pieces_.push_back(std::move(piece));
    cursor_ = pieces_.size() - 1;
    searched_s_ = t_s;
    if (goes && (!start_solver(t_s, x, fault) || !extend(fault))) {
        return false;
    }
    return look_after_restart(t_s, first, fault);
}

// ---- steps: of our own, or from elsewhere

bool Equations::Course::told(StepSource::Outcome outcome, double t_s, bool begins,
                             std::span<const double> x, Diagnostic& fault) const {
    if (outcome == StepSource::Outcome::kStepped) {
        return true;
    }
    if (outcome == StepSource::Outcome::kUnknown) {
        StepSource::Why why = source_->why();
        fault = problem(why.code.c_str(), t_s, std::move(why.message), std::move(why.remedy));
        return false;
    }
    fault =
        begins ? problem("equations-blow-up", t_s, "the rates have no value, with " + state_text(x),
                         "look at what they divide by, and what they take roots and logarithms "
                         "of")
               : problem("equations-blow-up", t_s, "the solution ends, with " + state_text(x),
                         "stop it before, by an event that resets it, or look at the signs; "
                         "equations with very fast and slow parts need `solver stiff`");
    return false;
}

bool Equations::Course::start_solver(double t_s, std::span<const double> x, Diagnostic& fault) {
    using Outcome = StepSource::Outcome;
    if (source_ == nullptr) {
        return told(solver_.start(*this, t_s, x) ? Outcome::kStepped : Outcome::kBlewUp, t_s, true,
                    x, fault);
    }
    segment_ = {t_s, next_stop(t_s), 0, {x.begin(), x.end()}, data_, false};
    return begin_segment(fault);
}

// The source begins where segment_ says, and goes on to where it says.
bool Equations::Course::begin_segment(Diagnostic& fault) {
    Segment& s = segment_;
    if (!told(source_->start(*this, s.begin_s, s.until_s, s.x, s.data), s.begin_s, true, s.x,
              fault)) {
        return false;
    }
    OdeStep step;
    for (std::uint64_t k = 0; k < s.steps; ++k) {
        if (!told(source_->step(*this, step), s.begin_s, false, s.x, fault)) {
            return false;
        }
    }
    s.live = true;
    return true;
}

bool Equations::Course::step_solver(double begin_s, std::span<const double> x, OdeStep& out,
                                    double& end_s, Diagnostic& fault) {
    using Outcome = StepSource::Outcome;
    if (source_ == nullptr) {
        const bool stepped =
            solver_.step(*this, next_stop(begin_s), out) == OdeSolver::Outcome::kStepped;
        end_s = solver_.now_s();
        return told(stepped ? Outcome::kStepped : Outcome::kBlewUp, begin_s, false, x, fault);
    }
    if (!segment_.live && !begin_segment(fault)) {
        return false;
    }
    if (!told(source_->step(*this, out), begin_s, false, x, fault)) {
        return false;
    }
    ++segment_.steps;
    end_s = source_->now_s();
    return true;
}

void Equations::Course::push_kinks(double t_s, std::uint32_t degree) {
    if (degree >= kDegrees) {
        return;
    }
    for (const EquationSystem::Past& p : system_.pasts) {
        const Kink kink{t_s + p.ago_s, degree + 1};
        const auto where = std::lower_bound(kinks_.begin(), kinks_.end(), kink.at_s,
                                            [](const Kink& k, double t) { return k.at_s < t; });
        if (where == kinks_.end() || where->at_s > kink.at_s) {
            kinks_.insert(where, kink);
        }
    }
}

// Where a step must end: the next update of a difference equation, or a kink.
double Equations::Course::next_stop(double t_s) const {
    double stop = kForEver;
    for (const EquationSystem::Variable& v : system_.variables) {
        if (v.next.valid()) {
            // The first whole multiple after t_s.
            auto k = static_cast<std::int64_t>(std::floor(t_s / seconds_of(v.every_ticks)));
            while (seconds_of(k * v.every_ticks) <= t_s) {
                ++k;
            }
            stop = std::min(stop, seconds_of(k * v.every_ticks));
        }
    }
    for (const Kink& k : kinks_) {
        if (k.at_s > t_s) {
            return std::min(stop, k.at_s);
        }
    }
    return stop;
}

namespace {

bool is_due(const EquationSystem::Variable& v, double t_s) {
    if (!v.next.valid() || t_s <= 0) {
        return false;
    }
    const auto k = static_cast<std::int64_t>(std::floor(t_s / seconds_of(v.every_ticks) + 0.5));
    return seconds_of(k * v.every_ticks) == t_s;
}

}  // namespace

bool Equations::Course::update_due(double t_s) const {
    return std::any_of(system_.variables.begin(), system_.variables.end(),
                       [&](const EquationSystem::Variable& v) { return is_due(v, t_s); });
}

// The difference equations whose time is t_s, all from the values before.
bool Equations::Course::update(double t_s, std::vector<double>& x, Diagnostic& fault) {
    const std::vector<double> before = x;
    Reader reader;
    reader.course = this;
    reader.t_s = t_s;
    reader.x = before.data();
    reader.data = data_.data();
    reader.locals = rates_locals_.data();
    bool good = fill_locals(reader);
    for (std::size_t i = 0; good && i < system_.variables.size(); ++i) {
        if (is_due(system_.variables[i], t_s)) {
            good = evaluate(system_.code, system_.variables[i].next, reader, x[i]);
        }
    }
    if (!good) {
        fault = problem("equations-blow-up", t_s,
                        "the next value is no number, with " + state_text(before),
                        "look at what it divides by, or keep it within bounds with min and max");
    }
    return good;
}

// One piece more.
bool Equations::Course::extend(Diagnostic& fault) {
    const double begin_s = pieces_.back().end_s;
    std::vector<double> x(n_);
    for (std::uint32_t i = 0; i < n_; ++i) {
        x[i] = at(pieces_.back(), begin_s, i);
    }
    const std::uint32_t data = pieces_.back().data;
    if (pieces_.back().step.begin_s < begin_s && update_due(begin_s)) {
        if (!update(begin_s, x, fault)) {
            return false;
        }
        Piece jump;
        jump.step = OdeStep::constant(begin_s, has_rates_ ? 0 : kForEver, x);
        jump.end_s = has_rates_ ? begin_s : next_stop(begin_s);
        jump.data = data;
        jump.jump = true;
        pieces_.push_back(std::move(jump));
        return !has_rates_ || start_solver(begin_s, x, fault);
    }
    while (!kinks_.empty() && kinks_.front().at_s <= begin_s) {
        const Kink kink = kinks_.front();
        kinks_.erase(kinks_.begin());
        if (kink.at_s == begin_s) {
            push_kinks(kink.at_s, kink.degree);
        }
    }
    Piece piece;
    piece.data = data;
    if (!has_rates_) {
        piece.step = OdeStep::constant(begin_s, kForEver, x);
        piece.end_s = next_stop(begin_s);
    } else {
        if (!step_solver(begin_s, x, piece.step, piece.end_s, fault)) {
            return false;
        }
    }
    pieces_.push_back(std::move(piece));
    return true;
}

bool Equations::Course::carry_to(double t_s, Diagnostic& fault) {
    while (begun_ && pieces_.back().end_s <= t_s) {
        if (!extend(fault)) {
            return false;
        }
    }
    return true;
}

bool Equations::Course::add_given(double t_s, Hash64& hash) const {
    bool any = false;
    for (const Piece& p : pieces_) {
        if (p.step.method == OdeMethod::kGiven && p.step.begin_s < t_s) {
            any = true;
            hash.add_f64(p.step.begin_s).add_f64(p.step.length_s);
            for (const double x : p.step.rows) {
                hash.add_f64(x);
            }
        }
    }
    return any;
}

std::string Equations::Course::state_text(std::span<const double> x) const {
    std::string text;
    const std::size_t n = system_.variables.size();
    for (std::size_t i = 0; i < n; ++i) {
        const EquationSystem::Variable& v = system_.variables[i];
        text += (i > 0 ? ", " : "") + v.name + " = " + number_to_text(x[i]) +
                (v.unit.empty() ? "" : " " + v.unit);
        if (i == 7 && n > 9) {
            return text + ", and " + std::to_string(n - 8) + " more";
        }
    }
    return text;
}

Diagnostic Equations::Course::problem(const char* code, double t_s, std::string message,
                                      std::string remedy) const {
    return {.code = code,
            .where = system_.where,
            .element = "equations " + system_.path,
            .message = "at " + number_to_text(t_s) + " s " + std::move(message),
            .remedy = std::move(remedy)};
}

}  // namespace puppetri::run
