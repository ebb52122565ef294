// SPDX-License-Identifier: MIT
// Each hip must be within a ball around its ankle; moved by the hip's offset, both are balls for
// the pelvis, centres c_i. With r = easy and w = longest - easy a leg of length r + e pulls by
//
//   f(e) = e^2 / (w - e) for 0 < e, nothing for e <= 0,
//
// which begins without a corner (f' = 0 at 0, so the place is C1) and has no end before w. The
// pelvis q rests where the pulls balance the way from the wanted place p:
//
//   q - p + sum f(|q - c_i| - r_i) n_i = 0,  n_i from c_i to q,
//
// the only minimum of |q - p|^2 / 2 + sum F(|q - c_i| - r_i), F' = f: a proximal map, so q never
// moves farther than p does (Moreau, "Proximité et dualité dans un espace hilbertien", 1965).
// From e = 0.998 w on f goes on as its tangent: feet that no pelvis reaches have an answer too.
#include "puppetri/motion/pelvis_placement.h"

#include <cmath>

#include "puppetri/base/require.h"
#include "puppetri/figure/mannequin.h"

namespace puppetri::motion {
namespace {

constexpr double kEasy = 0.9991, kLongest = 0.9999;
constexpr double kSteep = 0.998;  // of w, where the tangent begins
constexpr int kHalvings = 60;

struct Leg {
    Vec3 centre;
    double easy = 0, way = 0;

    double steep() const { return kSteep * way; }
    double steep_pull() const { return kSteep * kSteep / (1 - kSteep) * way; }
    static double slope() { return 1 / ((1 - kSteep) * (1 - kSteep)) - 1; }

    double excess(Vec3 p) const { return length(p - centre) - easy; }
    double pull(double e) const {
        return e <= 0        ? 0
               : e < steep() ? e * e / (way - e)
                             : steep_pull() + slope() * (e - steep());
    }
    // Where what pulls towards p by `weight` of the distance balances this leg:
    //   weight (E - e) = f(e), E the excess of p; on the curve a quadratic, written so that its
    // smaller root loses nothing.
    Vec3 balance(Vec3 p, double weight) const {
        const double wanted = excess(p);
        if (wanted <= 0) {
            return p;
        }
        const double a = weight - 1, b = weight * (wanted + way), c = weight * wanted * way;
        double e = 2 * c / (b + std::sqrt(std::fmax(0, b * b - 4 * a * c)));
        if (e >= steep()) {
            e = (weight * wanted - steep_pull() + slope() * steep()) / (weight + slope());
        }
        return centre + normalized(p - centre) * (easy + e);
    }
};

// Both pull. The first one's share of the way to its centre, m = f(e_1) / |q - c_1|, is what is
// looked for: with it q balances the other leg against p and c_1 together, and the larger it is the
// nearer q gets to c_1, so that what the first leg then would pull falls.
Vec3 balance_both(const Leg& first, const Leg& second, Vec3 p) {
    const auto place = [&](double m) {
        return second.balance((p + first.centre * m) * (1 / (1 + m)), 1 + m);
    };
    const auto pulls = [&](Vec3 q) {
        const double d = length(q - first.centre);
        return first.pull(d - first.easy) / std::fmax(d, first.easy);
    };
    double low = 0, high = pulls(place(0));
    for (int i = 0; i < kHalvings && low < high; ++i) {
        const double m = (low + high) / 2;
        (pulls(place(m)) > m ? low : high) = m;
    }
    return place((low + high) / 2);
}

}  // namespace

PlacedPelvis place_pelvis(const PelvisPlacement& placement) {
    const Vec3 wanted = placement.wanted_world.translation;
    std::array<Leg, 2> legs;
    for (int i = 0; i < 2; ++i) {
        const LegReach& leg = placement.legs[i];
        PUP_REQUIRE(leg.easy_m > 0 && leg.longest_m > leg.easy_m);
        legs[i] = {leg.ankle_world - rotate(placement.wanted_world.rotation, leg.hip_pelvis),
                   leg.easy_m, leg.longest_m - leg.easy_m};
    }
    PlacedPelvis placed{wanted, {}};
    const double first = legs[0].excess(wanted), second = legs[1].excess(wanted);
    if (first > 0 || second > 0) {
        // The one that pulls harder, alone; where that suits the other, this is all.
        const int hard = first >= second ? 0 : 1;
        placed.position_world = legs[hard].balance(wanted, 1);
        if (legs[1 - hard].excess(placed.position_world) > 0) {
            placed.position_world = balance_both(legs[0], legs[1], wanted);
        }
    }
    for (int i = 0; i < 2; ++i) {
        placed.residual_m[i] = std::fmax(0, legs[i].excess(placed.position_world) - legs[i].way);
    }
    return placed;
}

Vec3 pelvis_in_reach(const figure::Figure& figure, const Controls& controls) {
    if (!figure.humanoid()) {
        return controls.pelvis.position_world;
    }
    PelvisPlacement placement{
        .wanted_world = {controls.pelvis.rotation_world, controls.pelvis.position_world},
        .legs = {}};
    for (std::size_t i = 0; i < 2; ++i) {
        const figure::Leg& leg = figure.legs[i];
        const double full = leg.thigh_m + leg.shank_m;
        placement.legs[i] = {leg.hip_pelvis, controls.legs[i].ankle_world, kEasy * full,
                             kLongest * full};
    }
    return place_pelvis(placement).position_world;
}

}  // namespace puppetri::motion
