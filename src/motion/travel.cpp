// SPDX-License-Identifier: MIT
#include "travel.h"

#include <array>

#include "living.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

// Solves the n x n system rows * x = right by elimination with pivoting, in place. A singular
// column gives 0.
template <std::size_t N>
std::array<double, N> solve(std::array<std::array<double, N>, N> rows,
                            std::array<double, N> right) {
    for (std::size_t c = 0; c < N; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < N; ++r) {
            pivot = std::fabs(rows[r][c]) > std::fabs(rows[pivot][c]) ? r : pivot;
        }
        std::swap(rows[c], rows[pivot]);
        std::swap(right[c], right[pivot]);
        if (std::fabs(rows[c][c]) < 1e-300) {
            continue;
        }
        for (std::size_t r = 0; r < N; ++r) {
            if (r != c) {
                const double f = rows[r][c] / rows[c][c];
                for (std::size_t k = c; k < N; ++k) {
                    rows[r][k] -= f * rows[c][k];
                }
                right[r] -= f * right[c];
            }
        }
    }
    for (std::size_t c = 0; c < N; ++c) {
        right[c] = std::fabs(rows[c][c]) < 1e-300 ? 0 : right[c] / rows[c][c];
    }
    return right;
}

}  // namespace

// Unknown: the accelerations a_0 .. a_M at the knots. Velocity and position at the end are linear
// in them:
//   v1 - v0 = sum of h (a_k + a_k+1) / 2,   p1 - p0 - v0 T = sum over pieces of h^2 (2 a_k + a_k+1)
//   / 6 + what the velocity gained so far does in the remaining time.
// Weighted least squares under these two conditions, a = W^-1 C' mu, with W = diag(w) + smoothing;
// the weights |a|^4 are renewed eight times (iteratively reweighted least squares), which tends to
// the least sum of a^6.
Curve1 plan_travel(Motion1 from, Motion1 to, double duration_s) {
    constexpr std::size_t kKnots = 11;
    PUP_REQUIRE(duration_s > 0);
    const double h = duration_s / (kKnots - 1);
    std::array<double, kKnots> gain_v{}, gain_p{};
    for (std::size_t k = 0; k + 1 < kKnots; ++k) {
        const double rest = duration_s - h * static_cast<double>(k + 1);
        gain_v[k] += h / 2;
        gain_v[k + 1] += h / 2;
        gain_p[k] += h * h / 3 + h / 2 * rest;
        gain_p[k + 1] += h * h / 6 + h / 2 * rest;
    }
    const double want_v = to.velocity - from.velocity;
    const double want_p = to.position - from.position - from.velocity * duration_s;
    std::array<double, kKnots> a{}, weight;
    weight.fill(1);
    for (int round = 0; round < 8; ++round) {
        std::array<std::array<double, kKnots + 2>, kKnots + 2> rows{};
        std::array<double, kKnots + 2> right{};
        for (std::size_t k = 0; k < kKnots; ++k) {
            rows[k][k] += weight[k];
            if (k + 1 < kKnots) {
                constexpr double kSmooth = 0.03;
                rows[k][k] += kSmooth;
                rows[k + 1][k + 1] += kSmooth;
                rows[k][k + 1] -= kSmooth;
                rows[k + 1][k] -= kSmooth;
            }
            rows[k][kKnots] = rows[kKnots][k] = gain_v[k];
            rows[k][kKnots + 1] = rows[kKnots + 1][k] = gain_p[k];
        }
        right[kKnots] = want_v;
        right[kKnots + 1] = want_p;
        const auto solution = solve(rows, right);
        double largest = 1e-9;
        for (std::size_t k = 0; k < kKnots; ++k) {
            a[k] = solution[k];
            largest = std::fmax(largest, std::fabs(a[k]));
        }
        for (std::size_t k = 0; k < kKnots; ++k) {
            const double r = a[k] / largest;
            weight[k] = (weight[k] + 0.02 + r * r * r * r) / 2;
        }
    }
    std::vector<Key1> keys(kKnots);
    keys[0] = {0, {from.position, from.velocity, a[0]}};
    for (std::size_t k = 1; k < kKnots; ++k) {
        const Motion1& m = keys[k - 1].motion;
        keys[k] = {h * static_cast<double>(k),
                   {m.position + h * m.velocity + h * h * (2 * a[k - 1] + a[k]) / 6,
                    m.velocity + h * (a[k - 1] + a[k]) / 2, a[k]}};
    }
    return Curve1(std::move(keys));
}

// It speeds up, then brakes.
double longest_way_to_rest(double speed, double a, double T) {
    const double brakes_s = (T + speed / a) / 2, before_s = std::fmax(T - brakes_s, 0);
    return speed * before_s + a * before_s * before_s / 2 + a * brakes_s * brakes_s / 2;
}

// Unknown: the heights at a quarter, a half, three quarters and the end, and the velocity there;
// the curve is linear in them. Repeated least squares over the bands that are left, each weighted
// by its kind, plus a little of the acceleration.
void rise_slowly(HeightPlan& plan, double lowest_now) {
    constexpr double kNothing_m = 0.005;
    const double low = std::fmax(0, lowest_now - plan.from.position - kNothing_m),
                 part = std::fmin(1, low / kNothing_m);
    for (HeightBand& band : plan.bands) {
        const double above = lerp(band.lowest, band.highest, band.wanted) - plan.from.position;
        const double lower =
            std::fmax(low, part * above) * (1 - smooth_rise(band.t_s, 0.8 * plan.duration_s));
        band.lowest -= lower;
        band.highest -= lower;
    }
}

Curve1 plan_height(const HeightPlan& plan) {
    constexpr std::size_t kUnknown = 5;
    const double T = plan.duration_s;
    auto curve = [&](const std::array<double, kUnknown>& y, Motion1 from, Motion1 to) {
        return minimum_jerk({0, from}, {{T / 4, y[0]}, {T / 2, y[1]}, {3 * T / 4, y[2]}},
                            {T, {y[3], to.velocity + y[4], to.acceleration}});
    };
    const double base = plan.from.position;  // heights are solved for relative to the start
    std::array<double, kUnknown> y{};
    const Motion1 start{0, plan.from.velocity, plan.from.acceleration};
    const std::size_t samples = plan.bands.size();
    std::array<Curve1, kUnknown> basis;
    for (std::size_t i = 0; i < kUnknown; ++i) {
        std::array<double, kUnknown> unit{};
        unit[i] = 1;
        basis[i] = curve(unit, {}, {});
    }
    const Curve1 fixed = curve({}, start, plan.to);
    // Past the end the curve goes on as the polynomial of degree two.
    auto at = [T](const Curve1& c, double t) {
        const Motion1 m = c.at(std::fmin(t, T));
        const double late = std::fmax(t - T, 0);
        return Motion1{m.position + late * (m.velocity + late * m.acceleration / 2), 0,
                       m.acceleration};
    };
    std::vector<std::array<double, kUnknown>> value(samples), bend(samples);
    std::vector<double> value0(samples), bend0(samples);
    for (std::size_t s = 0; s < samples; ++s) {
        const Motion1 m = at(fixed, plan.bands[s].t_s);
        value0[s] = m.position;
        bend0[s] = m.acceleration;
        for (std::size_t i = 0; i < kUnknown; ++i) {
            const Motion1 b = at(basis[i], plan.bands[s].t_s);
            value[s][i] = b.position;
            bend[s][i] = b.acceleration;
        }
    }
    const double pinned = plan.end_is_free ? 0 : 1e6;
    for (int round = 0; round < 14; ++round) {
        std::array<std::array<double, kUnknown>, kUnknown> rows{};
        std::array<double, kUnknown> right{};
        auto add = [&](const std::array<double, kUnknown>& row, double target, double weight) {
            for (std::size_t i = 0; i < kUnknown; ++i) {
                for (std::size_t k = 0; k < kUnknown; ++k) {
                    rows[i][k] += weight * row[i] * row[k];
                }
                right[i] += weight * row[i] * target;
            }
        };
        for (std::size_t s = 0; s < samples; ++s) {
            double now = value0[s];
            for (std::size_t i = 0; i < kUnknown; ++i) {
                now += value[s][i] * y[i];
            }
            const double lo = plan.bands[s].lowest - base, hi = plan.bands[s].highest - base;
            if (plan.bands[s].t_s <= T) {
                // What is wanted pulls a little everywhere, so that the curve is determined.
                add(value[s], lerp(lo, hi, plan.bands[s].wanted) - value0[s], 0.2);
                add(bend[s], -bend0[s], 4e-5 * T * T);
            }
            if (round > 0 && (now > hi || now < lo)) {
                add(value[s], (now > hi ? hi : lo) - value0[s], 40);
            }
            // In the later rounds a leg that would be too short counts most.
            const double limit = plan.bands[s].limit - base;
            if (round > 5 && now > limit) {
                add(value[s], limit - value0[s], 3000);
            }
        }
        add({0, 0, 0, 1, 0}, plan.to.position - base, pinned);
        add({0, 0, 0, 0, 1}, 0, plan.end_is_free ? 1e-2 : 1e6);
        const auto next = solve(rows, right);
        for (std::size_t i = 0; i < kUnknown; ++i) {
            y[i] += (next[i] - y[i]) * (round == 0 ? 1 : 0.6);
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        y[i] += base;
    }
    if (!plan.end_is_free) {
        y[3] = plan.to.position;
        y[4] = 0;
    }
    return curve(y, plan.from, plan.to);
}

}  // namespace puppetri::motion
