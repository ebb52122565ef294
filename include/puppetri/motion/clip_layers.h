// SPDX-License-Identifier: MIT
// Layers: clips that play over one another, each on some of the joints, by some weight, as what it
// is or as a difference that is added. The result is a pose, or, flattened, a clip again.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// How much of a layer each target gets, in [0, 1]. Targets that are not named get `others`.
struct LayerMask {
    struct Part {
        std::string target;
        double weight = 1;
    };
    std::vector<Part> parts = {};
    double others = 1;

    double weight_of(std::string_view target) const;
};

// The joints from `top` down, with weight 1; others 0.
LayerMask mask_below(const figure::Skeleton& skeleton, std::string_view top);

enum class LayerMode : std::uint8_t {
    kOverride,  // takes the place of what is below: rotations by slerp, the rest straight
    kAdditive,  // is added: parent_from_joint = below * difference; the clip holds differences
};

struct ClipLayer {
    const Clip* clip = nullptr;  // for one call
    double weight = 1;
    LayerMode mode = LayerMode::kOverride;
    LayerMask mask = {};
    double begin_s = 0;  // when it starts; before, and after the end of one that does not loop, it
                         // has no say
    double speed = 1;
    double fade_in_s = 0, fade_out_s = 0;  // eased by a cubic
};

// The layers, the lowest first, over the pose that is there. `dofs` of the figure: tracks of
// degrees of freedom turn the joints that they are of, on top of what lower layers did to these;
// null: they move nothing.
void apply_layers(std::span<const ClipLayer> layers, const figure::Skeleton& skeleton, double t_s,
                  figure::Pose& pose, const figure::DofSet* dofs = nullptr);

// The stack as one clip of that duration, with keys at that rate, linear. A target that no override
// layer has starts from the skeleton's rest pose, a degree of freedom from 0. A joint for which
// there are tracks of both kinds gets a track of rotation, if `dofs` are given.
Clip flattened(std::span<const ClipLayer> layers, const figure::Skeleton& skeleton,
               double duration_s, double rate_hz, const figure::DofSet* dofs = nullptr);

// The differences of a clip from its own value at reference_s: what an additive layer plays.
Clip to_additive(const Clip& clip, double reference_s);

}  // namespace puppetri::motion
