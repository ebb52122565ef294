// SPDX-License-Identifier: MIT
// The body, modelled at the canonical height; places hang on the joints. The proportions follow a
// slim adult drawn by eye against the usual canon of eight heads; nothing is measured from a
// person.
#include "mannequin_shape.h"

#include <algorithm>
#include <string>

#include "puppetri/base/require.h"

namespace puppetri::figure {
namespace {

constexpr std::array<const char*, 5> kFingerNames{"Thumb", "Index", "Middle", "Ring", "Little"};

Vec3 mirrored(Vec3 p, int side) { return {side == 0 ? p.x : -p.x, p.y, p.z}; }

// Adds cones with lengths in units, so that the tables below read like a drawing.
class Modeller {
 public:
    explicit Modeller(ImplicitShape& shape) : shape_(shape) {}

    // A round cone between two points of model space, squashed by `scale` about a.
    void limb(Vec3 a, Vec3 b, double radius_a, double radius_b, Vec3 scale = {1, 1, 1}) {
        RoundCone c;
        c.origin_model = a;
        const Vec3 way = b - a;
        c.b = {way.x / scale.x, way.y / scale.y, way.z / scale.z};
        c.radius_a = radius_a;
        c.radius_b = radius_b;
        c.scale = scale;
        add(c);
    }

    // An ellipsoid; `tilt_rad` turns it about the X axis (positive: its top leans forward).
    void blob(Vec3 centre, Vec3 radii, double tilt_rad = 0) {
        RoundCone c;
        c.origin_model = centre;
        c.radius_a = c.radius_b = radii.y;
        c.scale = {radii.x / radii.y, 1, radii.z / radii.y};
        const double half =
            tilt_rad / 2;  // small angles: the sine is the angle to 1 %, and no libm
        c.model_from_local = {half, 0, 0, std::sqrt(1 - half * half)};
        add(c);
    }

    void carve(Vec3 centre, double radius) {
        RoundCone c;
        c.origin_model = centre;
        c.radius_a = c.radius_b = radius;
        c.carve = true;
        add(c);
    }

    double blend = 0.03;
    int level = 0;
    bool paired = false;

 private:
    void add(RoundCone& c) {
        c.blend_m = blend;
        c.level = static_cast<std::uint8_t>(level);
        c.paired = paired;
        shape_.add(c);
    }

    ImplicitShape& shape_;
};

Vec3 between(Vec3 a, Vec3 b, double t) { return a + (b - a) * t; }

}  // namespace

Landmarks landmarks_of(const Skeleton& skeleton) {
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    to_model_space(skeleton, rest_pose(skeleton), model_from_joint);
    Landmarks m;
    m.scale = skeleton.height_m / kCanonicalHeight_m;
    const auto at = [&](const std::string& name) {
        const JointIndex j = skeleton.find(name);
        PUP_REQUIRE(j.valid());
        return model_from_joint[j.value].translation * (1 / m.scale);
    };
    m.hips = at("hips");
    m.spine = at("spine");
    m.chest = at("chest");
    m.upper_chest = at("upperChest");
    m.neck = at("neck");
    m.head = at("head");
    for (std::size_t side = 0; side < 2; ++side) {
        const std::string lr = side == 0 ? "left" : "right";
        m.shoulder[side] = at(lr + "UpperArm");
        m.elbow[side] = at(lr + "LowerArm");
        m.wrist[side] = at(lr + "Hand");
        m.hip[side] = at(lr + "UpperLeg");
        m.knee[side] = at(lr + "LowerLeg");
        m.ankle[side] = at(lr + "Foot");
        m.toes[side] = at(lr + "Toes");
        for (std::size_t f = 0; f < 5; ++f) {
            const std::array<const char*, 3> parts =
                f == 0 ? std::array<const char*, 3>{"Metacarpal", "Proximal", "Distal"}
                       : std::array<const char*, 3>{"Proximal", "Intermediate", "Distal"};
            for (std::size_t k = 0; k < 3; ++k) {
                m.fingers[side][f][k] = at(lr + kFingerNames[f] + parts[k]);
            }
            const JointIndex last = skeleton.find(lr + kFingerNames[f] + "Distal");
            m.fingers[side][f][3] =
                (model_from_joint[last.value] * skeleton.joints[last.value].end_site_joint) *
                (1 / m.scale);
        }
    }
    return m;
}

ImplicitShape mannequin_shape(const Landmarks& m) {
    ImplicitShape shape;
    Modeller add(shape);
    const auto off = [&](Vec3 from, double x, double y, double z) { return from + Vec3{x, y, z}; };
    const double crown = kCanonicalHeight_m;
    const Vec3 shoulders = between(m.shoulder[0], m.shoulder[1], 0.5);

    // Trunk: pelvis, waist, rib cage, shoulder girdle. Flat from front to back.
    add.blend = 0.06;
    add.limb(off(m.hips, 0.045, -0.015, -0.005), off(m.hips, -0.045, -0.015, -0.005), 0.116, 0.116,
             {1, 1, 0.88});
    add.limb(off(m.hips, 0, 0.05, 0), off(m.hips, 0, 0.24, 0.0), 0.122, 0.125, {1.0, 1, 0.78});
    add.limb(off(m.hips, 0, 0.22, 0.0), off(shoulders, 0, -0.13, 0.0), 0.125, 0.155,
             {1.0, 1, 0.72});
    add.blend = 0.05;
    add.limb(off(m.shoulder[0], -0.055, -0.025, 0.0), off(m.shoulder[1], 0.055, -0.025, 0.0), 0.062,
             0.062, {1, 1, 1.12});
    // What meets its mirror image in the middle is joined with it first.
    add.paired = true;
    add.blob(shoulders + Vec3{0.072, -0.105, 0.058}, {0.082, 0.066, 0.046});  // chest
    add.limb(off(m.neck, 0, 0.040, -0.014),
             between(shoulders, m.shoulder[0], 0.75) + Vec3{0, 0.012, -0.012}, 0.042, 0.038);
    add.blend = 0.022;
    add.limb(off(m.hip[0], 0.010, -0.02, -0.004), off(m.knee[0], 0, 0.02, 0.004), 0.082,
             0.058);  // thigh
    add.blend = 0.05;
    add.blob(off(m.hip[0], -0.004, -0.040, -0.046), {0.080, 0.080, 0.070});  // seat
    add.blob(between(m.hip[0], m.knee[0], 0.40) + Vec3{0.014, 0, 0.014}, {0.058, 0.16, 0.058});
    add.paired = false;
    // Trousers below the knee.
    for (std::size_t side = 0; side < 2; ++side) {
        const Vec3 knee = m.knee[side], ankle = m.ankle[side];
        add.blend = 0.014;
        add.limb(off(knee, 0, 0.02, 0.004), off(ankle, 0, 0.035, -0.008), 0.0575, 0.047);
        add.blob(between(knee, ankle, 0.30) + Vec3{0, 0, -0.016}, {0.046, 0.12, 0.044});
        add.limb(off(ankle, 0, 0.05, -0.006), off(ankle, 0, -0.005, -0.004), 0.036,
                 0.036);  // what the hem hides
    }
    // Shoes: a heel, an instep, a ball and toes as one; the sole is cut flat.
    for (std::size_t side = 0; side < 2; ++side) {
        const double out = side == 0 ? 1 : -1;
        const Vec3 ankle = m.ankle[side], toes = m.toes[side];
        const double floor = -ankle.y;
        add.level = 1;
        add.blend = 0.022;
        add.limb(off(ankle, 0, floor + 0.036, -0.026), toes, 0.041, 0.040, {0.94, 1, 1});
        add.limb(off(ankle, 0, -0.006, 0.012), off(toes, 0, 0.008, -0.02), 0.043, 0.035,
                 {1.0, 0.95, 1});
        add.limb(off(toes, 0.007 * out, 0.004, -0.006), off(toes, 0.000, 0.002, 0.050), 0.044,
                 0.037, {1.06, 0.78, 1});
    }
    add.blend = 0.010;
    add.carve({0, -200, 0}, 200);
    add.level = 0;

    // Head: neck, skull, jaw, cheeks, brow, nose, ears.
    const Vec3 skull{0, crown - 0.100, m.head.z + 0.012};
    add.blend = 0.03;
    add.limb(off(m.neck, 0, -0.03, -0.004), off(skull, 0, -0.080, -0.020), 0.055, 0.050);
    add.blend = 0.03;
    add.blob(off(skull, 0, 0.0, -0.008), {0.080, 0.094, 0.096});
    add.limb(off(skull, 0, -0.030, 0.022), off(skull, 0, -0.092, 0.040), 0.068, 0.040,
             {0.94, 1, 1});  // jaw and chin
    add.level = 1;
    add.blend = 0.02;
    add.limb(off(skull, 0.020, 0.012, 0.074), off(skull, -0.020, 0.012, 0.074), 0.015, 0.015,
             {1, 1, 1});  // brow
    add.blend = 0.016;
    add.limb(off(skull, 0, -0.008, 0.086), off(skull, 0, -0.040, 0.101), 0.008, 0.0125);  // nose
    add.limb(off(skull, 0.013, -0.072, 0.074), off(skull, -0.013, -0.072, 0.074), 0.010,
             0.010);  // mouth
    for (int s = 0; s < 2; ++s) {
        add.level = 2;
        add.blend = 0.006;
        add.blob(skull + mirrored(Vec3{0.029, -0.014, 0.074}, s), {0.013, 0.011, 0.012});  // lids
        add.level = 1;
        add.blend = 0.013;
        add.blob(skull + mirrored(Vec3{0.079, -0.031, -0.010}, s), {0.012, 0.026, 0.019},
                 0.15);  // ears
    }

    // Arms.
    for (std::size_t side = 0; side < 2; ++side) {
        const double out = side == 0 ? 1 : -1;
        const Vec3 shoulder = m.shoulder[side], elbow = m.elbow[side], wrist = m.wrist[side];
        add.level = 0;
        add.blend = 0.04;
        add.limb(off(shoulder, -0.02 * out, -0.006, 0), off(elbow, -0.01 * out, 0, 0), 0.054,
                 0.038);
        add.blend = 0.03;
        add.blob(off(shoulder, 0.025 * out, 0.002, 0), {0.078, 0.055, 0.055});  // deltoid
        add.blob(between(shoulder, elbow, 0.56) + Vec3{0, 0, 0.010},
                 {0.085, 0.039, 0.039});  // biceps
        add.blob(between(shoulder, elbow, 0.52) + Vec3{0, 0, -0.013},
                 {0.090, 0.037, 0.035});  // triceps
        add.limb(off(elbow, 0.01 * out, 0, 0), off(wrist, -0.01 * out, 0, 0), 0.038, 0.025,
                 {1, 0.92, 1.06});
        add.blob(between(elbow, wrist, 0.27) + Vec3{0, 0.002, 0.004},
                 {0.085, 0.038, 0.042});  // forearm
        // The hand: a palm, then the fingers. The palm's skin is 0.11 of the hand's length below
        // the wrist.
        add.level = 1;
        add.blend = 0.02;
        const auto& fingers = m.fingers[side];
        add.limb(off(wrist, -0.005 * out, -0.001, 0),
                 between(fingers[2][0], fingers[3][0], 0.3) + Vec3{0, -0.003, 0}, 0.025, 0.033,
                 {1, 0.56, 1});
        add.blob(off(wrist, 0.045 * out, -0.010, 0.018),
                 {0.030, 0.012, 0.016});  // ball of the thumb
        add.blob(off(wrist, 0.050 * out, -0.010, -0.018),
                 {0.034, 0.011, 0.014});  // and its neighbour
        add.level = 2;
        for (std::size_t f = 1; f < 5; ++f) {
            add.blend = 0.012;
            add.limb(between(wrist, fingers[f][0], 0.35), fingers[f][0], 0.012, 0.0105);
        }
        static constexpr std::array<double, 5> kThickness{1.25, 1.0, 1.03, 0.98, 0.9};
        for (std::size_t f = 0; f < 5; ++f) {
            const auto& j = fingers[f];
            const double r = 0.0080 * kThickness[f];
            add.blend = f == 0 ? 0.016 : 0.005;
            add.limb(j[0], j[1], f == 0 ? r * 1.6 : r * 1.04, r);
            add.blend = 0.003;
            add.limb(j[1], j[2], r, r * 0.92);
            const double tip = 1 - 0.0060 / std::max(length(j[3] - j[2]), 1e-6);
            add.limb(j[2], between(j[2], j[3], tip), r * 0.92, r * 0.76);
        }
    }
    return shape;
}

ContourGrid mannequin_grid(const Landmarks& m) {
    ContourGrid grid;
    // Along X: the arms; one lattice unit is one metre where nothing is stretched.
    const double shoulder = m.shoulder[0].x, elbow = m.elbow[0].x, wrist = m.wrist[0].x;
    const auto axis = [](std::vector<std::array<double, 2>> stretches) {
        // {model position in units, cells are this much longer up to there}
        AxisMap map;
        double lattice = 0, model = 0;
        map.lattice.push_back(0);
        map.model_m.push_back(0);
        for (const auto& [to, stretch] : stretches) {
            lattice += (to - model) / stretch;
            model = to;
            map.lattice.push_back(lattice);
            map.model_m.push_back(model);
        }
        return map;
    };
    grid.x = axis({{shoulder - 0.06, 1.0},
                   {elbow - 0.05, 1.9},
                   {elbow + 0.05, 1.1},
                   {wrist - 0.03, 1.9},
                   {wrist + 0.02, 1.4},
                   {wrist + 0.3, 2.5}});
    grid.x.odd = true;
    const double knee = m.knee[0].y, hip = m.hip[0].y, arm = m.shoulder[0].y;
    grid.y = axis({{0.10, 1.35},
                   {knee - 0.08, 1.9},
                   {knee + 0.08, 1.2},
                   {hip - 0.12, 1.9},
                   {hip + 0.05, 1.2},
                   {arm - 0.10, 1.6},
                   {2.0, 1.0}});
    for (double& v : grid.y.lattice) {
        v -= 0.66;
    }
    grid.z = axis({{1.0, 1.0}});
    grid.low = -0.75;  // cells of 1.5 / 64 = 23 mm, exact in binary, so that left and right are
                       // alike to the last bit
    grid.size = 1.5;
    grid.depth = 6;
    return grid;
}

double border(const Landmarks& m, int which, Vec3 p) {
    const Vec3 skull{0, 1.65, m.head.z + 0.012};
    switch (which) {
        case 0: {  // hair: above a line that falls from the forehead over the ears to the nape
            const double z = (p.z - skull.z), y = (p.y - skull.y);
            const double front = std::clamp((z - 0.030) / 0.05, 0.0, 1.0),
                         back = std::clamp((-0.030 - z) / 0.050, 0.0, 1.0);
            return (0.013 + 0.039 * front * front * (3 - 2 * front) -
                    0.080 * back * back * (3 - 2 * back) - y);
        }
        case 1: {  // eyes: two upright ovals
            const double x = (std::fabs(p.x) - 0.029) / 0.0068,
                         y = (p.y - skull.y + 0.014) / 0.0088;
            return (std::sqrt(x * x + y * y) - 1) * 0.0078;
        }
        case 2: {  // the neckline of the shirt: a widening tube about the neck
            const Vec3 from = p - (m.neck + Vec3{0, -0.030, 0.010});
            return length({from.x, from.y * 0.5, from.z < 0 ? 1.4 * from.z : from.z}) - 0.074 -
                   std::max(0.0, from.y) * 0.6;
        }
        case 3: {  // sleeves: half way to the elbow
            const double cut =
                std::fabs(m.shoulder[0].x) + 0.52 * std::fabs(m.elbow[0].x - m.shoulder[0].x);
            return cut - std::fabs(p.x);
        }
        case 4:  // shoes
            return p.y - (m.ankle[0].y + 0.004);
        default:  // the hem of the shirt
            return p.y - (m.hips.y - 0.005);
    }
}

Zone zone_inside(int which) {
    static constexpr std::array<Zone, kBorderCount> kZones{
        Zone::kHair, Zone::kHair, Zone::kSkin, Zone::kSkin, Zone::kShoes, Zone::kTrousers};
    return kZones[static_cast<std::size_t>(which)];
}

bool border_applies(const Landmarks& m, int which, Vec3 p) {
    switch (which) {
        case 0:
            return p.y > 1.55 && std::fabs(p.x) < 0.15;
        case 1:
            return p.y > 1.55 && p.z > m.head.z + 0.05 && std::fabs(p.x) < 0.15;
        case 2:
            return p.y > m.upper_chest.y && std::fabs(p.x) < 0.2;
        default:
            return true;
    }
}

double relief(const Landmarks& m, Vec3 p) {
    // How far inside of a garment, as a step over the last few millimetres before its border.
    const auto edge = [&](int which, double sign) {
        const double t = std::clamp(1 + sign * border(m, which, p) / (kHem), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    if (p.y > 1.55) {
        return std::fabs(p.x) < 0.15 ? 0.005 * edge(0, -1) : 0;
    }
    double shirt = edge(3, 1) * edge(5, 1);
    if (std::fabs(p.x) < 0.2 && p.y > m.upper_chest.y) {
        shirt *= edge(2, 1);
    }
    const double trousers = p.y < m.spine.y ? edge(4, 1) : 0;
    return std::max(0.006 * shirt, 0.002 * trousers);
}

}  // namespace puppetri::figure
