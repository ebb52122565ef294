// SPDX-License-Identifier: MIT
// Control of the length of steps, and the explicit method.
#include "puppetri/math/ode.h"

#include <algorithm>
#include <cmath>

#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"

namespace puppetri {
namespace {

constexpr double kShortest = 1e-14;  // of a step, against the time
constexpr double kSafety = 0.9, kGrows = 5, kShrinks = 0.2;

bool finite(std::span<const double> x) {
    return std::all_of(x.begin(), x.end(), [](double v) { return v - v == 0; });
}

// error^(-1/order), as the next length over this one.
double factor_of(double error, OdeMethod method) {
    if (!(error > 1e-12)) {
        return kGrows;
    }
    const double order = method == OdeMethod::kDormandPrince ? 5 : 4;
    return std::clamp(kSafety * exp(-log(error) / order), kShrinks, kGrows);
}

}  // namespace

void OdeStep::at(double ratio, std::span<double> x) const {
    PUP_REQUIRE(x.size() >= size);
    for (std::uint32_t i = 0; i < size; ++i) {
        x[i] = at(ratio, i);
    }
}

double OdeStep::at(double ratio, std::uint32_t variable) const {
    const double* r = rows.data() + variable;
    const double s = ratio, s1 = 1 - ratio;
    if (rows.size() == size) {
        return r[0];
    }
    if (method == OdeMethod::kDormandPrince) {
        return r[0] + s * (r[size] + s1 * (r[2 * size] + s * (r[3 * size] + s1 * r[4 * size])));
    }
    std::size_t row = rows.size() / size - 1;
    double inner = row < 2 ? 0 : r[row * size];
    while (row > 2) {
        inner = r[--row * size] + s * inner;
    }
    return r[0] * s1 + s * (r[size] + s1 * inner);
}

OdeStep OdeStep::constant(double begin_s, double length_s, std::span<const double> x) {
    OdeStep step;
    step.begin_s = begin_s;
    step.length_s = length_s;
    step.size = static_cast<std::uint32_t>(x.size());
    step.rows.assign(x.begin(), x.end());
    return step;
}

double OdeSolver::norm(std::span<const double> error) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < n_; ++i) {
        const double size = std::max(std::fabs(x_[i]), std::fabs(new_x_[i]));
        const double scale = i < options_.watched_from
                                 ? options_.absolute + options_.relative * size
                                 : options_.watched * (1e-6 + size);
        const double e = error[i] / scale;
        sum += e * e;
    }
    return n_ == 0 ? 0 : std::sqrt(sum / n_);
}

bool OdeSolver::start(OdeSystem& system, double t_s, std::span<const double> x) {
    resume(system, t_s, x, 0);
    if (!finite(x_) || !system.rates(t_s_, x_, rate_) || !finite(rate_)) {
        return false;
    }
    next_s_ = first_length(system);
    return true;
}

void OdeSolver::resume(OdeSystem& system, double t_s, std::span<const double> x, double next_s) {
    n_ = system.size();
    PUP_REQUIRE(x.size() == n_);
    t_s_ = t_s;
    next_s_ = next_s;
    rejected_ = linear_ = false;
    x_.assign(x.begin(), x.end());
    for (auto* v : {&rate_, &new_x_, &new_rate_, &scratch_}) {
        v->assign(n_, 0);
    }
    k_.assign(std::size_t{8} * n_, 0);
    if (next_s > 0) {
        system.rates(t_s_, x_, rate_);
    }
}

// Hairer, Norsett, Wanner I, II.4: a step of Euler's method tells how fast the rates change.
double OdeSolver::first_length(OdeSystem& system) {
    new_x_ = x_;
    const double d0 = norm(x_), d1 = norm(rate_);
    double h = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1;
    h = std::min(h, options_.most_s);
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = x_[i] + h * rate_[i];
    }
    if (!system.rates(t_s_ + h, scratch_, new_rate_) || !finite(new_rate_)) {
        return h;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = new_rate_[i] - rate_[i];
    }
    const double most = std::max(d1, norm(scratch_) / h);
    const double wanted = most <= 1e-15 ? std::max(1e-6, h * 1e-3) : exp(log(0.01 / most) / 5);
    return std::min({100 * h, wanted, options_.most_s});
}

OdeSolver::Outcome OdeSolver::step(OdeSystem& system, double until_s, OdeStep& out) {
    PUP_REQUIRE(until_s > t_s_);
    const bool explicit_one = options_.method == OdeMethod::kDormandPrince;
    for (;;) {
        const double least = kShortest * std::max(1.0, std::fabs(t_s_));
        const double rest = until_s - t_s_;
        // No crumb is left over at the end.
        const bool last = next_s_ * 1.01 >= rest;
        const double h = last ? rest : next_s_;
        end_s_ = last ? until_s : t_s_ + h;
        double error = 0;
        const bool good =
            explicit_one ? try_dormand_prince(system, h, error) : try_rodas(system, h, error);
        if (!good || !(error <= 1)) {
            next_s_ = h * (good && error - error == 0 ? factor_of(error, options_.method) : 0.1);
            rejected_ = true;
            if (next_s_ < least) {
                return Outcome::kBlewUp;
            }
            continue;
        }
        out.begin_s = t_s_;
        out.length_s = h;
        out.method = options_.method;
        out.size = n_;
        const std::uint32_t rows = explicit_one ? 5 : 4;
        out.rows.resize(std::size_t{rows} * n_);
        std::copy(row(7).begin(), row(7).end(), out.rows.end() - n_);  // the last one, see below
        if (explicit_one) {
            for (std::uint32_t i = 0; i < n_; ++i) {
                const double difference = new_x_[i] - x_[i];
                const double bend = h * rate_[i] - difference;
                out.rows[i] = x_[i];
                out.rows[n_ + i] = difference;
                out.rows[2 * n_ + i] = bend;
                out.rows[3 * n_ + i] = difference - h * new_rate_[i] - bend;
            }
        } else {
            for (std::uint32_t i = 0; i < n_; ++i) {
                out.rows[i] = x_[i];
                out.rows[n_ + i] = new_x_[i];
                out.rows[2 * n_ + i] = row(6)[i];
            }
        }
        double factor = factor_of(error, options_.method);
        if (rejected_) {
            factor = std::min(factor, 1.0);
        }
        rejected_ = linear_ = false;
        // A step that was cut short says little about the next.
        const double next = std::min(h * factor, options_.most_s);
        next_s_ = last && h < next_s_ ? std::max(next, next_s_) : next;
        next_s_ = std::min(next_s_, options_.most_s);
        t_s_ = end_s_;
        x_.swap(new_x_);
        rate_.swap(new_rate_);
        return Outcome::kStepped;
    }
}

// The stages of Dormand and Prince, the error, and in row 7 the last row of the interpolant.
bool OdeSolver::try_dormand_prince(OdeSystem& system, double h, double& error) {
    const auto stage = [&](std::uint32_t k, double c) {
        return finite(scratch_) && system.rates(t_s_ + c * h, scratch_, row(k)) && finite(row(k));
    };
    const double *k1 = rate_.data(), *k2 = row(1).data(), *k3 = row(2).data(), *k4 = row(3).data(),
                 *k5 = row(4).data(), *k6 = row(5).data();
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = x_[i] + h * (k1[i] / 5);
    }
    if (!stage(1, 1.0 / 5)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = x_[i] + h * (3.0 / 40 * k1[i] + 9.0 / 40 * k2[i]);
    }
    if (!stage(2, 3.0 / 10)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = x_[i] + h * (44.0 / 45 * k1[i] - 56.0 / 15 * k2[i] + 32.0 / 9 * k3[i]);
    }
    if (!stage(3, 4.0 / 5)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] = x_[i] + h * (19372.0 / 6561 * k1[i] - 25360.0 / 2187 * k2[i] +
                                   64448.0 / 6561 * k3[i] - 212.0 / 729 * k4[i]);
    }
    if (!stage(4, 8.0 / 9)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        scratch_[i] =
            x_[i] + h * (9017.0 / 3168 * k1[i] - 355.0 / 33 * k2[i] + 46732.0 / 5247 * k3[i] +
                         49.0 / 176 * k4[i] - 5103.0 / 18656 * k5[i]);
    }
    if (!stage(5, 1)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        new_x_[i] = x_[i] + h * (35.0 / 384 * k1[i] + 500.0 / 1113 * k3[i] + 125.0 / 192 * k4[i] -
                                 2187.0 / 6784 * k5[i] + 11.0 / 84 * k6[i]);
    }
    if (!finite(new_x_) || !system.rates(end_s_, new_x_, new_rate_) || !finite(new_rate_)) {
        return false;
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        const double k7 = new_rate_[i];
        scratch_[i] = h * (71.0 / 57600 * k1[i] - 71.0 / 16695 * k3[i] + 71.0 / 1920 * k4[i] -
                           17253.0 / 339200 * k5[i] + 22.0 / 525 * k6[i] - 1.0 / 40 * k7);
        row(7)[i] =
            h * (-12715105075.0 / 11282082432 * k1[i] + 87487479700.0 / 32700410799 * k3[i] -
                 10690763975.0 / 1880347072 * k4[i] + 701980252875.0 / 199316789632 * k5[i] -
                 1453857185.0 / 822651844 * k6[i] + 69997945.0 / 29380423 * k7);
    }
    error = norm(scratch_);
    return true;
}

}  // namespace puppetri
