// SPDX-License-Identifier: MIT
// The body, modelled. Lengths are those of a figure 1.75 m tall and are scaled by Landmarks::unit_m; places hang on the
// joints. The proportions follow a slim adult drawn by eye against the usual canon of eight heads; nothing is measured
// from a person.
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
    Modeller(ImplicitShape& shape, double unit_m) : shape_(shape), unit_m_(unit_m) {}

    // A round cone between two points of model space, squashed by `scale` about a.
    void limb(Vec3 a, Vec3 b, double radius_a, double radius_b, Vec3 scale = {1, 1, 1}) {
        RoundCone c;
        c.origin_model = a;
        const Vec3 way = b - a;
        c.b = {way.x / scale.x, way.y / scale.y, way.z / scale.z};
        c.radius_a = radius_a * unit_m_;
        c.radius_b = radius_b * unit_m_;
        c.scale = scale;
        add(c);
    }

    // An ellipsoid; `tilt_rad` turns it about the X axis (positive: its top leans forward).
    void blob(Vec3 centre, Vec3 radii, double tilt_rad = 0) {
        RoundCone c;
        c.origin_model = centre;
        c.radius_a = c.radius_b = radii.y * unit_m_;
        c.scale = {radii.x / radii.y, 1, radii.z / radii.y};
        const double half = tilt_rad / 2;  // small angles: the sine is the angle to 1 %, and no libm
        c.model_from_local = {half, 0, 0, std::sqrt(1 - half * half)};
        add(c);
    }

    void carve(Vec3 centre, double radius) {
        RoundCone c;
        c.origin_model = centre;
        c.radius_a = c.radius_b = radius * unit_m_;
        c.carve = true;
        add(c);
    }

    double blend = 0.03;
    int level = 0;

   private:
    void add(RoundCone& c) {
        c.blend_m = blend * unit_m_;
        c.level = static_cast<std::uint8_t>(level);
        shape_.add(c);
    }

    ImplicitShape& shape_;
    double unit_m_;
};

Vec3 between(Vec3 a, Vec3 b, double t) { return a + (b - a) * t; }

}  // namespace

Landmarks landmarks_of(const Skeleton& skeleton) {
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    to_model_space(skeleton, rest_pose(skeleton), model_from_joint);
    const auto at = [&](const std::string& name) {
        const JointIndex j = skeleton.find(name);
        PUP_REQUIRE(j.valid());
        return model_from_joint[j.value].translation;
    };
    Landmarks m;
    m.unit_m = skeleton.height_m / 1.75;
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
            m.fingers[side][f][3] = model_from_joint[last.value] * skeleton.joints[last.value].end_site_joint;
        }
    }
    return m;
}

ImplicitShape mannequin_shape(const Landmarks& m) {
    ImplicitShape shape;
    Modeller add(shape, m.unit_m);
    const auto off = [&](Vec3 from, double x, double y, double z) { return from + Vec3{x, y, z} * m.unit_m; };
    const double crown = m.unit_m * 1.75;
    const Vec3 shoulders = between(m.shoulder[0], m.shoulder[1], 0.5);

    // Trunk: pelvis, waist, rib cage, shoulder girdle. Flat from front to back.
    add.blend = 0.06;
    add.limb(off(m.hips, 0.045, -0.01, -0.005), off(m.hips, -0.045, -0.01, -0.005), 0.118, 0.118, {1, 1, 0.86});
    add.limb(off(m.hips, 0, 0.05, 0), off(m.hips, 0, 0.24, 0.0), 0.122, 0.125, {1.0, 1, 0.76});
    add.limb(off(m.hips, 0, 0.22, 0.0), off(shoulders, 0, -0.13, 0.0), 0.125, 0.158, {1.0, 1, 0.70});
    add.blend = 0.05;
    add.limb(off(m.shoulder[0], -0.055, -0.025, 0.0), off(m.shoulder[1], 0.055, -0.025, 0.0), 0.062, 0.062,
             {1, 1, 1.12});
    for (int s = 0; s < 2; ++s) {
        const auto side = static_cast<std::size_t>(s);
        add.blob(shoulders + mirrored(Vec3{0.078, -0.105, 0.062} * m.unit_m, s), {0.075, 0.062, 0.045});  // chest
        add.limb(off(m.neck, 0, 0.045, -0.012), between(shoulders, m.shoulder[side], 0.72) + Vec3{0, 0.012, -0.012} * m.unit_m,
                 0.042, 0.040);  // trapezius
    }
    // Legs: both thighs before anything lower, so that the crotch is symmetric.
    add.blend = 0.035;
    for (std::size_t side = 0; side < 2; ++side) {
        add.limb(off(m.hip[side], 0, -0.02, -0.004), off(m.knee[side], 0, 0.02, 0.002), 0.088, 0.054);
    }
    for (std::size_t side = 0; side < 2; ++side) {
        const double out = side == 0 ? 1 : -1;
        const Vec3 hip = m.hip[side], knee = m.knee[side], ankle = m.ankle[side];
        add.blend = 0.05;
        add.blob(off(hip, -0.010 * out, -0.050, -0.048), {0.078, 0.085, 0.070});            // seat
        add.blob(between(hip, knee, 0.42) + Vec3{0.006 * out, 0, 0.022} * m.unit_m, {0.064, 0.15, 0.056});  // front of the thigh
        add.blend = 0.03;
        add.limb(off(knee, 0, 0.03, 0.004), between(knee, ankle, 0.55), 0.053, 0.046);
        add.limb(between(knee, ankle, 0.5), off(ankle, 0, 0.01, -0.004), 0.047, 0.036);
        add.blob(between(knee, ankle, 0.29) + Vec3{0, 0, -0.021} * m.unit_m, {0.050, 0.105, 0.044}, 0.06);  // calf
        add.blob(off(knee, 0, 0.005, 0.020), {0.038, 0.048, 0.036});                         // kneecap
    }
    // Feet: a heel, an instep, a ball, toes as one; the sole is cut flat.
    for (std::size_t side = 0; side < 2; ++side) {
        const double out = side == 0 ? 1 : -1;
        const Vec3 ankle = m.ankle[side], toes = m.toes[side];
        const double floor = -ankle.y / m.unit_m;
        add.level = 1;
        add.blend = 0.02;
        add.limb(off(ankle, 0, floor + 0.036, -0.030), {toes.x, toes.y, toes.z}, 0.040, 0.038, {0.92, 1, 1});
        add.limb(off(ankle, 0, -0.012, 0.014), off(toes, 0, 0.006, -0.02), 0.040, 0.034, {1.0, 0.9, 1});
        add.limb(off(toes, 0.008 * out, 0.003, -0.006), off(toes, 0.000, 0.000, 0.056), 0.042, 0.034, {1.06, 0.72, 1});
    }
    add.blend = 0.012;
    add.carve({0, -200 * m.unit_m, 0}, 200);
    add.level = 0;

    // Head: skull, face, jaw, nose, ears; the neck.
    const Vec3 skull{0, crown - 0.097 * m.unit_m, m.head.z + 0.010 * m.unit_m};
    add.blend = 0.03;
    add.limb(off(m.neck, 0, -0.03, -0.006), off(skull, 0, -0.085, -0.022), 0.056, 0.050);
    add.blend = 0.025;
    add.blob(off(skull, 0, 0.0, -0.006), {0.077, 0.097, 0.097});
    add.limb(off(skull, 0, -0.040, 0.018), off(skull, 0, -0.098, 0.050), 0.066, 0.030, {0.9, 1, 1});  // jaw and chin
    add.level = 1;
    add.blend = 0.014;
    add.limb(off(skull, 0, -0.015, 0.085), off(skull, 0, -0.049, 0.103), 0.008, 0.0125, {0.9, 1, 1});  // nose
    for (int s = 0; s < 2; ++s) {
        add.blend = 0.008;
        add.blob(skull + mirrored(Vec3{0.076, -0.028, -0.012} * m.unit_m, s), {0.010, 0.028, 0.019}, 0.15);  // ears
    }

    // Arms.
    for (std::size_t side = 0; side < 2; ++side) {
        const double out = side == 0 ? 1 : -1;
        const Vec3 shoulder = m.shoulder[side], elbow = m.elbow[side], wrist = m.wrist[side];
        add.level = 1;
        add.blend = 0.04;
        add.limb(off(shoulder, -0.02 * out, -0.006, 0), off(elbow, -0.01 * out, 0, 0), 0.054, 0.038);
        add.blend = 0.03;
        add.blob(off(shoulder, 0.025 * out, 0.004, 0), {0.075, 0.056, 0.056});                              // deltoid
        add.blob(between(shoulder, elbow, 0.56) + Vec3{0, 0, 0.010} * m.unit_m, {0.085, 0.038, 0.038});     // biceps
        add.blob(between(shoulder, elbow, 0.52) + Vec3{0, 0, -0.014} * m.unit_m, {0.090, 0.036, 0.034});    // triceps
        add.limb(off(elbow, 0.01 * out, 0, 0), off(wrist, -0.01 * out, 0, 0), 0.038, 0.025, {1, 0.92, 1.06});
        add.blob(between(elbow, wrist, 0.27) + Vec3{0, 0.002, 0.004} * m.unit_m, {0.085, 0.038, 0.042});   // forearm
        // The hand: a palm of two wedges, then the fingers.
        add.level = 1;
        add.blend = 0.02;
        const auto& fingers = m.fingers[side];
        add.limb(off(wrist, 0.0, 0, 0), between(fingers[2][0], fingers[3][0], 0.3), 0.026, 0.034, {1, 0.62, 1});
        add.level = 2;
        for (std::size_t f = 1; f < 5; ++f) {
            add.blend = 0.012;
            add.limb(between(wrist, fingers[f][0], 0.3), fingers[f][0], 0.013, 0.0125, {1, 0.95, 1});
        }
        static constexpr std::array<double, 5> kThickness{1.18, 1.0, 1.03, 0.97, 0.86};
        for (std::size_t f = 0; f < 5; ++f) {
            const auto& j = fingers[f];
            const double r = 0.0098 * kThickness[f];
            add.blend = f == 0 ? 0.016 : 0.004;
            add.limb(j[0], j[1], f == 0 ? r * 1.55 : r * 1.02, r);
            add.blend = 0.003;
            add.limb(j[1], j[2], r, r * 0.9);
            add.limb(j[2], between(j[2], j[3], 1 - 0.0068 * m.unit_m / std::max(length(j[3] - j[2]), 1e-6)), r * 0.9,
                     r * 0.74);
        }
    }
    return shape;
}

ContourGrid mannequin_grid(const Landmarks& m) {
    ContourGrid grid;
    const double u = m.unit_m;
    // Along X: the arms; one lattice unit is one metre where nothing is stretched.
    const double shoulder = m.shoulder[0].x / u, elbow = m.elbow[0].x / u, wrist = m.wrist[0].x / u;
    const auto axis = [u](std::vector<std::array<double, 2>> stretches) {
        // {model position in units, cells are this much longer up to there}
        AxisMap map;
        double lattice = 0, model = 0;
        map.lattice.push_back(0);
        map.model_m.push_back(0);
        for (const auto& [to, stretch] : stretches) {
            lattice += (to - model) / stretch;
            model = to;
            map.lattice.push_back(lattice);
            map.model_m.push_back(model * u);
        }
        return map;
    };
    const AxisMap right = axis({{shoulder - 0.06, 1.0}, {elbow - 0.05, 1.9}, {elbow + 0.05, 1.1},
                                {wrist - 0.03, 2.0}, {wrist + 0.02, 1.4}, {wrist + 0.3, 1.9}});
    for (std::size_t i = right.lattice.size() - 1; i > 0; --i) {
        grid.x.lattice.push_back(-right.lattice[i]);
        grid.x.model_m.push_back(-right.model_m[i]);
    }
    grid.x.lattice.insert(grid.x.lattice.end(), right.lattice.begin(), right.lattice.end());
    grid.x.model_m.insert(grid.x.model_m.end(), right.model_m.begin(), right.model_m.end());
    const double knee = m.knee[0].y / u, hip = m.hip[0].y / u, arm = m.shoulder[0].y / u;
    grid.y = axis({{0.10, 1.0}, {knee - 0.08, 1.9}, {knee + 0.08, 1.2}, {hip - 0.12, 1.9}, {hip + 0.05, 1.2},
                   {arm - 0.10, 1.6}, {2.0, 1.0}});
    for (double& v : grid.y.lattice) {
        v -= 0.55;
    }
    grid.z = axis({{1.0, 1.0}});
    grid.low = -0.8;
    grid.size = 1.6;
    grid.depth = 6;  // 25 mm
    return grid;
}

double border(const Landmarks& m, int which, Vec3 p) {
    const double u = m.unit_m;
    const double crown = 1.75 * u;
    const double head_z = m.head.z + 0.010 * u;
    switch (which) {
        case 0: {  // hair: above a line that falls from the forehead over the ears to the nape
            const double z = (p.z - head_z) / u, y = (p.y - crown) / u;
            return (-0.075 + 0.55 * std::clamp(z, -0.06, 0.06) - y) * u;
        }
        case 1: {  // the neckline of the shirt: a widening tube about the neck
            const Vec3 from = p - (m.neck + Vec3{0, -0.035, 0.012} * u);
            return length({from.x, from.y * 0.5, from.z}) - 0.078 * u - std::max(0.0, from.y) * 0.6;
        }
        case 2: {  // sleeves: half way to the elbow
            const double cut = m.shoulder[0].x + 0.52 * (m.elbow[0].x - m.shoulder[0].x);
            return cut - std::fabs(p.x);
        }
        case 3:  // shoes
            return p.y - (m.ankle[0].y + 0.012 * u);
        default:  // the hem of the shirt
            return p.y - (m.hips.y + 0.015 * u);
    }
}

Zone zone_inside(int which) {
    static constexpr std::array<Zone, kBorderCount> kZones{Zone::kHair, Zone::kSkin, Zone::kSkin, Zone::kShoes,
                                                           Zone::kTrousers};
    return kZones[static_cast<std::size_t>(which)];
}

bool border_applies(const Landmarks& m, int which, Vec3 p) {
    switch (which) {
        case 0:
            return p.y > m.head.y - 0.1 * m.unit_m && std::fabs(p.x) < 0.15 * m.unit_m;
        case 1:
            return p.y > m.upper_chest.y && std::fabs(p.x) < 0.2 * m.unit_m;
        default:
            return true;
    }
}

}  // namespace puppetri::figure
