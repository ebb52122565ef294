// SPDX-License-Identifier: MIT
// Linkages: figures put together link by link, as chains after Denavit and Hartenberg (four
// parameters and a degree of freedom per link, as in XKEY) or as trees of joints at any place. Both
// become one type: a skeleton with DOFs.
//
// A link of Denavit and Hartenberg moves about (or along) the z axis of the frame that the link
// before it ends in; its own frame ends in
//   Rz(theta) Tz(d) Tx(a) Rx(alpha)
// of that. The DOF is theta, or of a link that slides d. Its joint stands where it moves, so that
// what hangs rigidly on the link (Tx(a) Rx(alpha)) is part of the next joint's rest: for joints a
// DOF acts last. The first link's z axis points up (+Y), its x axis ahead (+Z).
// Source  Denavit and Hartenberg, "A Kinematic Notation for Lower Pair Mechanisms Based on
//         Matrices", Journal of Applied Mechanics 22 (1955) 215-221.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/character.h"
#include "puppetri/figure/palette.h"

namespace puppetri::figure {

struct DhParameters {
    double a_m = 0, alpha_rad = 0, d_m = 0, theta_rad = 0;
};

// What a link looks like, in the space of its joint.
struct LinkShape {
    enum class Kind : std::uint8_t { kBox, kBall, kBar } kind = Kind::kBox;
    Vec3 size_m;          // of a box; diameter in x of a ball or bar
    Vec3 at_joint;        // the middle of a box or ball; where a bar begins
    Vec3 to_joint;        // where a bar ends
    bool accent = false;  // in the accent colour of the palette instead of the main one
};

struct LinkDof {
    std::string name;  // "turn": the DOF is LINK.turn
    DofKind kind = DofKind::kTurn;
    Vec3 axis_joint{0, 0, 1};
    double lo = 0, hi = 0;
};

struct Link {
    static constexpr std::uint32_t kBase = ~std::uint32_t{0};

    std::string name;
    std::uint32_t parent = kBase;  // an earlier link
    std::optional<DhParameters> dh;
    Transform parent_from_joint;  // without dh: at rest
    std::vector<LinkDof> dofs;    // of a dh link at most one: about or along z
    std::vector<LinkShape> shapes;
};

// Gives   a creature in metres whose joints are a root on the floor and the links in their order.
//         Rest pose: theta and d as given, other DOFs zero. Links without a shape get bars to their
//         children and to where a dh link ends.
// Fails   with every defect, the element is the link: "no-links", "name-used-twice",
// "wrong-parent",
//         "min-above-max", "rest-outside-range", "bad-axis" (zero or not finite), "not-finite",
//         "zero-length" (a shape without size).
Checked<Character> make_linkage(std::span<const Link> links, const Palette& palette);

}  // namespace puppetri::figure
