// SPDX-License-Identifier: MIT
// Quintic Hermite pieces and minimum-jerk interpolation.
#include "puppetri/math/quintic.h"

#include "puppetri/base/require.h"

namespace puppetri {

// With d = duration, the cubic remainder after removing p0, v0, a0 has to meet position, velocity
// and acceleration at d:
//   r0 = p1 - p0 - v0 d - a0 d^2/2,  r1 = v1 - v0 - a0 d,  r2 = a1 - a0
//   c3 = (10 r0 - 4 r1 d + r2 d^2/2) / d^3,  c4 = (-15 r0 + 7 r1 d - r2 d^2) / d^4,
//   c5 = (6 r0 - 3 r1 d + r2 d^2/2) / d^5.
Quintic Quintic::between(Motion1 from, Motion1 to, double duration_s) {
    PUP_REQUIRE(duration_s > 0);
    const double d = duration_s;
    const double r0 =
        to.position - from.position - from.velocity * d - from.acceleration * d * d / 2;
    const double r1 = (to.velocity - from.velocity - from.acceleration * d) * d;
    const double r2 = (to.acceleration - from.acceleration) * d * d;
    const double d3 = d * d * d;
    return {{from.position, from.velocity, from.acceleration / 2, (10 * r0 - 4 * r1 + r2 / 2) / d3,
             (-15 * r0 + 7 * r1 - r2) / (d3 * d), (6 * r0 - 3 * r1 + r2 / 2) / (d3 * d * d)}};
}

Motion1 Quintic::at(double t) const {
    const auto& c = coefficient;
    return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
            c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))),
            2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]))};
}

Curve1::Curve1(std::vector<Key1> keys) : keys_(std::move(keys)) {
    for (std::size_t i = 1; i < keys_.size(); ++i) {
        pieces_.push_back(Quintic::between(keys_[i - 1].motion, keys_[i].motion,
                                           keys_[i].t_s - keys_[i - 1].t_s));
    }
}

Motion1 Curve1::at(double t_s) const {
    if (keys_.empty()) {
        return {};
    }
    if (t_s <= keys_.front().t_s) {
        return t_s < keys_.front().t_s ? Motion1{keys_.front().motion.position, 0, 0}
                                       : keys_.front().motion;
    }
    if (t_s >= keys_.back().t_s) {
        return t_s > keys_.back().t_s ? Motion1{keys_.back().motion.position, 0, 0}
                                      : keys_.back().motion;
    }
    std::size_t i = 1;
    while (keys_[i].t_s < t_s) {
        ++i;
    }
    return pieces_[i - 1].at(t_s - keys_[i - 1].t_s);
}

// The unknowns are velocity v_i and acceleration a_i at the inner points. The interpolant of least
// squared jerk has a continuous third and fourth derivative there. For a piece of length h from (p,
// v, a) to (q, w, b), with r0 = q - p - v h - a h^2/2, r1 = (w - v - a h) h, r2 = (b - a) h^2:
//   third derivative at its start   6 c3            = ( 60 r0 - 24 r1 + 3 r2) / h^3
//   third derivative at its end     6 c3 + 24 c4 h + 60 c5 h^2 = ( 60 r0 - 36 r1 + 9 r2) / h^3
//   fourth at its start            24 c4            = (-360 r0 + 168 r1 - 24 r2) / h^4
//   fourth at its end              24 c4 + 120 c5 h = ( 360 r0 - 192 r1 + 36 r2) / h^4
// Two linear equations per inner point; the system is small and dense enough for plain elimination
// with pivoting.
Curve1 minimum_jerk(Key1 from, const std::vector<Waypoint1>& inner, Key1 to) {
    const int n = static_cast<int>(inner.size());
    std::vector<Key1> keys;
    keys.push_back(from);
    for (const Waypoint1& w : inner) {
        keys.push_back({w.t_s, {w.position, 0, 0}});
    }
    keys.push_back(to);
    if (n == 0) {
        return Curve1(std::move(keys));
    }
    const int m = 2 * n;
    std::vector<double> rows(static_cast<std::size_t>(m) * (m + 1), 0.0);
    auto cell = [&](int r, int c) -> double& {
        return rows[static_cast<std::size_t>(r) * (m + 1) + c];
    };
    // Adds scale * (k0 r0 + k1 r1 + k2 r2) of piece i (from key i to key i + 1) to row r.
    auto add = [&](int r, int i, double scale, double k0, double k1, double k2) {
        const double h = keys[i + 1].t_s - keys[i].t_s;
        PUP_REQUIRE(h > 0);
        const double q_p = keys[i + 1].motion.position - keys[i].motion.position;
        cell(r, m) -= scale * k0 * q_p;
        const double of_v = scale * (-k0 * h - k1 * h),
                     of_a = scale * (-k0 * h * h / 2 - k1 * h * h - k2 * h * h);
        const double of_w = scale * k1 * h, of_b = scale * k2 * h * h;
        if (i == 0) {
            cell(r, m) -= of_v * from.motion.velocity + of_a * from.motion.acceleration;
        } else {
            cell(r, 2 * (i - 1)) += of_v;
            cell(r, 2 * (i - 1) + 1) += of_a;
        }
        if (i + 1 == n + 1) {
            cell(r, m) -= of_w * to.motion.velocity + of_b * to.motion.acceleration;
        } else {
            cell(r, 2 * i) += of_w;
            cell(r, 2 * i + 1) += of_b;
        }
    };
    for (int i = 1; i <= n; ++i) {
        const double h0 = keys[i].t_s - keys[i - 1].t_s, h1 = keys[i + 1].t_s - keys[i].t_s;
        const int r = 2 * (i - 1);
        add(r, i - 1, 1 / (h0 * h0 * h0), 60, -36, 9);
        add(r, i, -1 / (h1 * h1 * h1), 60, -24, 3);
        add(r + 1, i - 1, 1 / (h0 * h0 * h0 * h0), 360, -192, 36);
        add(r + 1, i, -1 / (h1 * h1 * h1 * h1), -360, 168, -24);
    }
    for (int c = 0; c < m; ++c) {
        int pivot = c;
        for (int r = c + 1; r < m; ++r) {
            pivot = std::fabs(cell(r, c)) > std::fabs(cell(pivot, c)) ? r : pivot;
        }
        for (int k = 0; k <= m; ++k) {
            std::swap(cell(c, k), cell(pivot, k));
        }
        for (int r = 0; r < m; ++r) {
            if (r != c && cell(r, c) != 0) {
                const double f = cell(r, c) / cell(c, c);
                for (int k = c; k <= m; ++k) {
                    cell(r, k) -= f * cell(c, k);
                }
            }
        }
    }
    for (int i = 1; i <= n; ++i) {
        keys[i].motion.velocity = cell(2 * (i - 1), m) / cell(2 * (i - 1), 2 * (i - 1));
        keys[i].motion.acceleration =
            cell(2 * (i - 1) + 1, m) / cell(2 * (i - 1) + 1, 2 * (i - 1) + 1);
    }
    return Curve1(std::move(keys));
}

// The third derivative at the start is linear in the acceleration there: two probes give its root.
Curve1 minimum_jerk_free_start(Key1 from, const std::vector<Waypoint1>& inner, Key1 to) {
    const double h = (inner.empty() ? to.t_s : inner.front().t_s) - from.t_s;
    auto jerk = [&](double acceleration) {
        Key1 start = from;
        start.motion.acceleration = acceleration;
        const Curve1 c = minimum_jerk(start, inner, to);
        const Quintic piece = Quintic::between(c.keys()[0].motion, c.keys()[1].motion, h);
        return 6 * piece.coefficient[3];
    };
    const double at_0 = jerk(0), at_1 = jerk(1);
    from.motion.acceleration = at_0 / (at_0 - at_1);
    return minimum_jerk(from, inner, to);
}

Motion3 Curve3::at(double t_s) const {
    const Motion1 a = x.at(t_s), b = y.at(t_s), c = z.at(t_s);
    return {{a.position, b.position, c.position},
            {a.velocity, b.velocity, c.velocity},
            {a.acceleration, b.acceleration, c.acceleration}};
}

}  // namespace puppetri
