// SPDX-License-Identifier: MIT
#include "skin_weights.h"

#include <algorithm>
#include <string>

#include "finger_names.h"
#include "puppetri/base/require.h"

namespace puppetri::figure {
namespace {

// 0 below centre - half, 1 above centre + half, a cubic between.
double ramp(double x, double centre, double half) {
    const double t = std::clamp((x - centre) / (2 * half) + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

// Collects shares per joint; few joints share a point, so a short list is enough.
class SkinWeights::Sum {
 public:
    void add(std::uint16_t joint, double weight) {
        if (weight <= 0) {
            return;
        }
        for (int i = 0; i < count_; ++i) {
            if (items_[static_cast<std::size_t>(i)].joint == joint) {
                items_[static_cast<std::size_t>(i)].weight += weight;
                return;
            }
        }
        if (count_ < static_cast<int>(items_.size())) {
            items_[static_cast<std::size_t>(count_++)] = {joint, weight};
        }
    }

    SkinBinding strongest() {
        std::sort(items_.begin(), items_.begin() + count_, [](const Item& a, const Item& b) {
            return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
        });
        SkinBinding out;
        double total = 0;
        const int kept = std::min(count_, 4);
        for (int i = 0; i < kept; ++i) {
            total += items_[static_cast<std::size_t>(i)].weight;
        }
        for (int i = 0; i < kept; ++i) {
            const auto k = static_cast<std::size_t>(i);
            out.joints[k] = items_[k].joint;
            out.weights[k] = static_cast<float>(items_[k].weight / total);
        }
        return out;
    }

 private:
    struct Item {
        std::uint16_t joint = 0;
        double weight = 0;
    };
    std::array<Item, 24> items_{};
    int count_ = 0;
};

SkinWeights::SkinWeights(const Skeleton& skeleton, const Landmarks& marks) : marks_(marks) {
    const auto index = [&](const std::string& name) {
        const JointIndex j = skeleton.find(name);
        PUP_REQUIRE(j.valid());
        return static_cast<std::uint16_t>(j.value);
    };
    hips_ = index("hips");
    spine_ = index("spine");
    chest_ = index("chest");
    upper_chest_ = index("upperChest");
    neck_ = index("neck");
    head_ = index("head");
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string lr = s == 0 ? "left" : "right";
        Side& side = sides_[s];
        side.clavicle = index(lr + "Shoulder");
        side.upper_arm = index(lr + "UpperArm");
        side.upper_arm_twist = index(lr + "UpperArmTwist");
        side.lower_arm = index(lr + "LowerArm");
        side.lower_arm_twist = index(lr + "LowerArmTwist");
        side.hand = index(lr + "Hand");
        side.upper_leg = index(lr + "UpperLeg");
        side.lower_leg = index(lr + "LowerLeg");
        side.foot = index(lr + "Foot");
        side.toes = index(lr + "Toes");
        for (std::size_t f = 0; f < 5; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                side.fingers[f][k] = index(lr + kFingerNames[f * 3 + k]);
            }
        }
    }
}

SkinBinding SkinWeights::at(Vec3 p) const {
    const std::size_t s = p.x >= 0 ? 0 : 1;
    const double out = std::fabs(p.x);
    // The arm begins at an oblique plane: further in on top of the shoulder than in the armpit, and
    // not below it.
    const Vec3 shoulder = marks_.shoulder[s];
    const double below = (shoulder.y - p.y);
    const double arm_share = ramp(out - std::fabs(shoulder.x), (0.012 + 0.25 * below), 0.065) *
                             (1 - ramp(below, 0.13, 0.04));
    // The leg begins at the line from the crotch up to the hip bone.
    const Vec3 hip = marks_.hip[s];
    const double rise = 0.55 * std::clamp(out - std::fabs(hip.x), -0.09, 0.09);
    const double leg_share = ramp(hip.y + rise - p.y, 0.012, 0.085);
    Sum sum;
    trunk(p, (1 - arm_share) * (1 - leg_share), sum);
    arm(p, s, arm_share, sum);
    // Between the legs both pull alike.
    const double left = ramp(p.x, 0, 0.022);
    leg(p, 0, leg_share * (1 - arm_share) * left, sum);
    leg(p, 1, leg_share * (1 - arm_share) * (1 - left), sum);
    return sum.strongest();
}

void SkinWeights::trunk(Vec3 p, double share, Sum& sum) const {
    if (share <= 0) {
        return;
    }
    const double spine = ramp(p.y, marks_.spine.y, 0.07), chest = ramp(p.y, marks_.chest.y, 0.075);
    const double upper = ramp(p.y, marks_.upper_chest.y, 0.08);
    // Neck and head bend along a slope: higher at the back than under the chin.
    const double slope = 0.35 * (p.z - marks_.neck.z);
    const double neck = ramp(p.y - 0.0 * slope, marks_.neck.y + 0.005, 0.045) *
                        (1 - ramp(std::fabs(p.x), 0.10, 0.035));
    const double head = ramp(p.y + slope, marks_.head.y + 0.012, 0.032);
    // The collar bone carries the top of the shoulder.
    const std::size_t s = p.x >= 0 ? 0 : 1;
    const double shoulder_x = std::fabs(marks_.shoulder[s].x);
    const double clavicle = ramp(std::fabs(p.x), 0.6 * shoulder_x, 0.45 * shoulder_x) *
                            ramp(p.y, marks_.shoulder[s].y - 0.09, 0.07) * (1 - neck);
    sum.add(hips_, share * (1 - spine));
    sum.add(spine_, share * spine * (1 - chest));
    sum.add(chest_, share * chest * (1 - upper));
    const double top = share * upper;
    sum.add(head_, top * head);
    sum.add(neck_, top * (1 - head) * neck);
    sum.add(sides_[s].clavicle, top * (1 - head) * (1 - neck) * clavicle);
    sum.add(upper_chest_, top * (1 - head) * (1 - neck) * (1 - clavicle));
}

void SkinWeights::arm(Vec3 p, std::size_t s, double share, Sum& sum) const {
    if (share <= 0) {
        return;
    }
    const Side& side = sides_[s];
    const double x = std::fabs(p.x), shoulder = std::fabs(marks_.shoulder[s].x);
    const double elbow_x = std::fabs(marks_.elbow[s].x), wrist_x = std::fabs(marks_.wrist[s].x);
    const double upper_m = elbow_x - shoulder, fore_m = wrist_x - elbow_x;
    const double twist = ramp(x, shoulder + 0.5 * upper_m, 0.38 * upper_m);
    const double elbow = ramp(x, elbow_x, 0.042);
    const double fore_twist = ramp(x, elbow_x + 0.5 * fore_m, 0.40 * fore_m);
    const double wrist = ramp(x, wrist_x, 0.028);
    sum.add(side.upper_arm, share * (1 - twist) * (1 - elbow));
    sum.add(side.upper_arm_twist, share * twist * (1 - elbow));
    sum.add(side.lower_arm, share * elbow * (1 - fore_twist) * (1 - wrist));
    sum.add(side.lower_arm_twist, share * elbow * fore_twist * (1 - wrist));
    if (wrist <= 0) {
        return;
    }
    // Fingers: which one (a soft contest of distances), then how far along it.
    std::array<double, 5> near{}, along{};
    double best = 1e9;
    for (std::size_t f = 0; f < 5; ++f) {
        const auto& j = marks_.fingers[s][f];
        const Vec3 way = j[3] - j[0];
        const double length_m = length(way);
        along[f] = dot(p - j[0], way) / length_m;
        const Vec3 foot = j[0] + way * (std::clamp(along[f], 0.0, length_m) / length_m);
        near[f] = length(p - foot) - (f == 0 ? 0.003 : 0);
        best = std::min(best, near[f]);
    }
    double total = 0;
    std::array<double, 5> part{};
    for (std::size_t f = 0; f < 5; ++f) {
        const double d = std::max(0.0, 1 - (near[f] - best) / (0.008));
        part[f] = d * d;
        total += part[f];
    }
    double left = 1;
    for (std::size_t f = 0; f < 5; ++f) {
        const auto& j = marks_.fingers[s][f];
        const double first = length(j[1] - j[0]), second = first + length(j[2] - j[1]);
        const double mine = part[f] / total * ramp(along[f], 0.002, (f == 0 ? 0.016 : 0.011));
        const double k1 = ramp(along[f], first, 0.009), k2 = ramp(along[f], second, 0.008);
        left -= mine;
        sum.add(side.fingers[f][0], share * wrist * mine * (1 - k1));
        sum.add(side.fingers[f][1], share * wrist * mine * k1 * (1 - k2));
        sum.add(side.fingers[f][2], share * wrist * mine * k1 * k2);
    }
    sum.add(side.hand, share * wrist * left);
}

void SkinWeights::leg(Vec3 p, std::size_t s, double share, Sum& sum) const {
    if (share <= 0) {
        return;
    }
    const Side& side = sides_[s];
    const double knee = ramp(-p.y, -marks_.knee[s].y, 0.055);
    // The ankle bends along a slope: higher in front.
    const double ankle = ramp(marks_.ankle[s].y - p.y + 0.3 * (p.z - marks_.ankle[s].z), 0, 0.032);
    const double toes = ramp(p.z, marks_.toes[s].z, 0.022);
    sum.add(side.upper_leg, share * (1 - knee));
    sum.add(side.lower_leg, share * knee * (1 - ankle));
    sum.add(side.foot, share * knee * ankle * (1 - toes));
    sum.add(side.toes, share * knee * ankle * toes);
}

}  // namespace puppetri::figure
