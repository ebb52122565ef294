// SPDX-License-Identifier: MIT
// Which joints move a point of the skin, and how much. The rest pose is a T-pose, so that the
// body's chains lie along the axes: weights are smooth steps of the place along a chain, as wide as
// the flesh at that joint is thick.
#pragma once
#include <array>
#include <cstdint>

#include "mannequin_shape.h"

namespace puppetri::figure {

struct SkinBinding {
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};  // descending, sum 1
};

class SkinWeights {
 public:
    SkinWeights(const Skeleton& skeleton, const Landmarks& marks);
    SkinBinding at(Vec3 p_model) const;

 private:
    struct Side {
        std::uint16_t clavicle, upper_arm, upper_arm_twist, lower_arm, lower_arm_twist, hand;
        std::uint16_t upper_leg, lower_leg, foot, toes;
        std::array<std::array<std::uint16_t, 3>, 5> fingers;
    };
    class Sum;
    void trunk(Vec3 p, double share, Sum& sum) const;
    void arm(Vec3 p, std::size_t side, double share, Sum& sum) const;
    void leg(Vec3 p, std::size_t side, double share, Sum& sum) const;

    Landmarks marks_;
    std::uint16_t hips_ = 0, spine_ = 0, chest_ = 0, upper_chest_ = 0, neck_ = 0, head_ = 0;
    std::array<Side, 2> sides_{};
};

}  // namespace puppetri::figure
