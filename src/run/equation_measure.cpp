// SPDX-License-Identifier: MIT
// How a variable, or a part with a name, went for some time: integral, extremes, and the value at
// the end, piece by piece.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "equation_course.h"
#include "puppetri/base/require.h"

namespace puppetri::run {
namespace {

// Gauss and Kronrod on [-1, 1]: 7 of the 15 nodes are Gauss's.
constexpr std::array<double, 8> kNodes = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144645693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
constexpr std::array<double, 8> kKronrod = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> kGauss = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

constexpr double kExact = 1e-10;  // of an integral, against the size of what is integrated
constexpr int kDeep = 24;         // halvings at most, where something jumps
constexpr double kLong_s = 1;     // a part that reads the time is looked at this often

}  // namespace

class Equations::Course::Measuring {
 public:
    Measuring(const Course& course, const net::CourseQuantity& quantity, CourseSum& out)
        : course_(course), quantity_(quantity), out_(out) {
        x_.resize(course.n_);
        locals_.resize(course.system_.locals.size());
        reader_.course = &course;
        reader_.x = x_.data();
        reader_.locals = locals_.data();
        for (std::uint32_t i = 0; quantity.part && i <= quantity.index; ++i) {
            for (const Slot s : course.system_.code.slots(course.system_.locals[i])) {
                const auto kind = static_cast<EquationSlot>(s.kind);
                reads_time_ |= kind == EquationSlot::kTime || kind == EquationSlot::kPast;
            }
        }
    }

    bool ok() const { return ok_; }
    double failed_at() const { return failed_at_; }

    void go(const Piece& piece, double from_s, double to_s) {
        piece_ = &piece;
        reader_.data = course_.data_rows_[piece.data].data();
        double pieces = 1;
        if (reads_time_) {
            pieces = std::ceil((to_s - from_s) / kLong_s);
        }
        const double length = (to_s - from_s) / pieces;
        for (double k = 0; k < pieces && ok_; ++k) {
            stretch(from_s + k * length, k + 1 == pieces ? to_s : from_s + (k + 1) * length, 0);
        }
    }
    // The value at one time of the piece counts among the extremes, and is the last so far.
    void look(const Piece& piece, double t_s) {
        piece_ = &piece;
        reader_.data = course_.data_rows_[piece.data].data();
        out_.last = at(t_s);
        out_.most = std::max(out_.most, out_.last);
        out_.least = std::min(out_.least, out_.last);
    }

 private:
    double at(double t_s) {
        if (!quantity_.part) {
            return Course::at(*piece_, t_s, quantity_.index);
        }
        for (std::uint32_t i = 0; i < x_.size(); ++i) {
            x_[i] = Course::at(*piece_, t_s, i);
        }
        reader_.t_s = t_s;
        if (!course_.fill_locals(reader_) || !std::isfinite(locals_[quantity_.index])) {
            failed_at_ = ok_ ? t_s : failed_at_;
            ok_ = false;
            return 0;
        }
        return locals_[quantity_.index];
    }

    void stretch(double a, double b, int depth) {
        const double middle = a + (b - a) / 2, half = (b - a) / 2;
        std::array<double, 17> t, y;  // in order of time
        t[0] = a;
        t[16] = b;
        for (std::size_t i = 0; i < 8; ++i) {
            t[1 + i] = middle - half * kNodes[i];
            t[15 - i] = middle + half * kNodes[i];
        }
        double size = 0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            y[i] = at(t[i]);
            size = std::max(size, std::abs(y[i]));
        }
        if (!ok_) {
            return;
        }
        double kronrod = kKronrod[7] * y[8], gauss = kGauss[3] * y[8];
        for (std::size_t i = 0; i < 7; ++i) {
            kronrod += kKronrod[i] * (y[1 + i] + y[15 - i]);
            gauss += i % 2 == 1 ? kGauss[i / 2] * (y[1 + i] + y[15 - i]) : 0;
        }
        if (std::abs(kronrod - gauss) > kExact * size && depth < kDeep && middle > a &&
            middle < b) {
            stretch(a, middle, depth + 1);
            stretch(middle, b, depth + 1);
            return;
        }
        out_.integral += half * kronrod;
        extreme(t, y, 1);
        extreme(t, y, -1);
    }

    // The largest of sign * value. Where a node is above its neighbours the top may lie beside it.
    void extreme(const std::array<double, 17>& t, const std::array<double, 17>& y, double sign) {
        double& record = sign > 0 ? out_.most : out_.least;
        const auto note = [&](double value) {
            record = sign * value > sign * record ? value : record;
        };
        for (const double value : y) {
            note(value);
        }
        for (std::size_t i = 1; i + 1 < y.size(); ++i) {
            const double left = sign * (y[i] - y[i - 1]), right = sign * (y[i] - y[i + 1]);
            if (left < 0 || right < 0 || left + right == 0 ||
                sign * y[i] + std::max(left, right) < sign * record) {
                continue;
            }
            // Golden section
            constexpr double kPart = 0.38196601125010515;
            double lo = t[i - 1], hi = t[i + 1];
            double p = lo + kPart * (hi - lo), q = hi - kPart * (hi - lo), at_p = at(p),
                   at_q = at(q);
            for (int k = 0; k < 60 && lo < p && p < q && q < hi && ok_; ++k) {
                note(at_p);
                note(at_q);
                if (sign * at_p >= sign * at_q) {
                    hi = q;
                    q = p;
                    at_q = at_p;
                    p = lo + kPart * (hi - lo);
                    at_p = at(p);
                } else {
                    lo = p;
                    p = q;
                    at_p = at_q;
                    q = hi - kPart * (hi - lo);
                    at_q = at(q);
                }
            }
        }
    }

    const Course& course_;
    const net::CourseQuantity& quantity_;
    CourseSum& out_;
    const Piece* piece_ = nullptr;
    Reader reader_;
    std::vector<double> x_, locals_;
    bool reads_time_ = false, ok_ = true;
    double failed_at_ = 0;
};

bool Equations::Course::measure(const net::CourseQuantity& quantity, double from_s, double to_s,
                                CourseSum& out, Diagnostic& fault) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    out = {0, -kInfinity, kInfinity, 0};
    PUP_REQUIRE(options_.record);
    if (pieces_.empty()) {  // nothing has been played
        constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
        out = {0, kNothing, kNothing, kNothing};
        return true;
    }
    PUP_REQUIRE(quantity.index <
                (quantity.part ? system_.locals.size() : system_.variables.size()));
    Measuring measuring(*this, quantity, out);
    const auto first = &piece_at(from_s) - pieces_.data();
    for (auto i = static_cast<std::size_t>(first); i < pieces_.size(); ++i) {
        const Piece& piece = pieces_[i];
        const double from = std::max(from_s, piece.step.begin_s), to = std::min(to_s, piece.end_s);
        if (piece.step.begin_s > to_s) {
            break;
        }
        if (from < to) {
            measuring.go(piece, from, to);
        }
        const bool last = i + 1 == pieces_.size() || pieces_[i + 1].step.begin_s > to_s;
        if (last) {
            measuring.look(piece, to_s);
        }
        if (!measuring.ok()) {
            fault = problem("evaluation-fault", measuring.failed_at(),
                            "what is measured has no value there",
                            "look at what it divides by, and what it takes roots and logarithms "
                            "of");
            return false;
        }
    }
    return true;
}

bool Equations::measure(const net::CourseQuantity& quantity, SimTime from, SimTime to,
                        CourseSum& out, Diagnostic& fault) {
    PUP_REQUIRE(quantity.system < courses_.size());
    Course& course = *courses_[quantity.system];
    return course.carry_to(to.seconds(), fault) &&
           course.measure(quantity, from.seconds(), to.seconds(), out, fault);
}

}  // namespace puppetri::run
