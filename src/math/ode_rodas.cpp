// SPDX-License-Identifier: MIT
// The linearly implicit method for stiff equations: six stages with one matrix, I/(h gamma) - J.
#include <cmath>
#include <utility>

#include "puppetri/math/ode.h"

namespace puppetri {
namespace {

// Coefficients of RODAS (Hairer, Wanner II, table 7.2 and the program that goes with the book),
// for the unknowns U in which no product with the Jacobian is left.
constexpr double kGamma = 0.25;
constexpr double kA[4][4] = {
    {1.544000000000000},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
};
constexpr double kC[5][5] = {
    {-5.668800000000000},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136,
     -6.058818238834054},
};
constexpr double kTime[6] = {0, 0.386, 0.21, 0.63, 1, 1};                          // of the stages
constexpr double kSlope[6] = {0.25, -0.1043, 0.1035, -0.03620000000000023, 0, 0};  // of df/dt
constexpr double kDense2[5] = {10.12623508344586, -7.487995877610167, -34.80091861555747,
                               -7.992771707568823, 1.025137723295662};
constexpr double kDense3[5] = {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
                               24.76722511418386, -6.594389125716872};

}  // namespace

// Jacobian and df/dt by differences (a step of half the digits).
bool OdeSolver::linearize(OdeSystem& system) {
    jacobian_.resize(std::size_t{n_} * n_);
    time_rate_.resize(n_);
    constexpr double kHalf = 1.4901161193847656e-8;  // 2^-26
    const auto fill = [&](double t, double delta, double* to, std::uint32_t stride) {
        if (!system.rates(t, scratch_, new_rate_)) {
            return false;
        }
        for (std::uint32_t i = 0; i < n_; ++i) {
            to[std::size_t{i} * stride] = (new_rate_[i] - rate_[i]) / delta;
        }
        return true;
    };
    for (std::uint32_t j = 0; j < n_; ++j) {
        scratch_ = x_;
        scratch_[j] += kHalf * std::fmax(1e-5, std::fabs(x_[j]));
        if (!fill(t_s_, scratch_[j] - x_[j], jacobian_.data() + j, n_)) {
            return false;
        }
    }
    scratch_ = x_;
    const double later = t_s_ + kHalf * std::fmax(1e-5, std::fabs(t_s_));
    return fill(later, later - t_s_, time_rate_.data(), 1);
}

// diagonal * I - J = L U with row pivots. False: singular.
bool OdeSolver::factorize(double diagonal) {
    matrix_.resize(jacobian_.size());
    pivots_.resize(n_);
    for (std::size_t i = 0; i < matrix_.size(); ++i) {
        matrix_[i] = -jacobian_[i];
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) -> double& {
        return matrix_[std::size_t{i} * n_ + j];
    };
    for (std::uint32_t i = 0; i < n_; ++i) {
        at(i, i) += diagonal;
    }
    for (std::uint32_t k = 0; k < n_; ++k) {
        std::uint32_t best = k;
        for (std::uint32_t i = k + 1; i < n_; ++i) {
            best = std::fabs(at(i, k)) > std::fabs(at(best, k)) ? i : best;
        }
        pivots_[k] = best;
        if (!(std::fabs(at(best, k)) > 0)) {
            return false;
        }
        for (std::uint32_t j = 0; j < n_ && best != k; ++j) {
            std::swap(at(best, j), at(k, j));
        }
        for (std::uint32_t i = k + 1; i < n_; ++i) {
            at(i, k) /= at(k, k);
            for (std::uint32_t j = k + 1; j < n_; ++j) {
                at(i, j) -= at(i, k) * at(k, j);
            }
        }
    }
    return true;
}

void OdeSolver::solve(std::span<double> b) const {
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return matrix_[std::size_t{i} * n_ + j];
    };
    for (std::uint32_t k = 0; k < n_; ++k) {
        std::swap(b[k], b[pivots_[k]]);
    }
    for (std::uint32_t i = 1; i < n_; ++i) {
        for (std::uint32_t j = 0; j < i; ++j) {
            b[i] -= at(i, j) * b[j];
        }
    }
    for (std::uint32_t i = n_; i-- > 0;) {
        for (std::uint32_t j = i + 1; j < n_; ++j) {
            b[i] -= at(i, j) * b[j];
        }
        b[i] /= at(i, i);
    }
}

// Rows 0 to 5 are the stages; afterwards rows 6 and 7 are the last two of the interpolant.
bool OdeSolver::try_rodas(OdeSystem& system, double h, double& error) {
    if (!linear_ && !linearize(system)) {
        return false;
    }
    linear_ = true;
    if (!factorize(1 / (h * kGamma))) {
        return false;
    }
    new_x_ = x_;
    for (std::uint32_t s = 0; s < 6; ++s) {
        if (s > 0 && s < 5) {
            for (std::uint32_t i = 0; i < n_; ++i) {
                new_x_[i] = x_[i];
                for (std::uint32_t j = 0; j < s; ++j) {
                    new_x_[i] += kA[s - 1][j] * row(j)[i];
                }
            }
        }
        // The last stages add what was found to the stage's own point.
        if (s == 5) {
            for (std::uint32_t i = 0; i < n_; ++i) {
                new_x_[i] += row(4)[i];
            }
        }
        const std::span<double> u = row(s);
        if (!system.rates(t_s_ + kTime[s] * h, new_x_, u)) {
            return false;
        }
        for (std::uint32_t i = 0; i < n_; ++i) {
            u[i] += h * kSlope[s] * time_rate_[i];
            for (std::uint32_t j = 0; j < s; ++j) {
                u[i] += kC[s - 1][j] * row(j)[i] / h;
            }
        }
        solve(u);
    }
    for (std::uint32_t i = 0; i < n_; ++i) {
        new_x_[i] += row(5)[i];
        scratch_[i] = row(5)[i];
        double second = 0, third = 0;
        for (std::uint32_t j = 0; j < 5; ++j) {
            second += kDense2[j] * row(j)[i];
            third += kDense3[j] * row(j)[i];
        }
        row(6)[i] = second;
        row(7)[i] = third;
    }
    error = norm(scratch_);
    return error - error == 0 && system.rates(end_s_, new_x_, new_rate_);
}

}  // namespace puppetri
