// SPDX-License-Identifier: MIT
// Clips as movements: a clip whose tracks are of the normalised humanoid (joints of figure::Figure,
// degrees of freedom) performed by any figure. What it travels begins where the figure stands; feet
// that its marks hold to the floor stay there by inverse kinematics, whatever the proportions.
#pragma once
#include <memory>
#include <string>

#include "puppetri/motion/clip.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {

struct ClipPlay {
    double speed = 1;          // 2: twice as fast
    LimbSet only = kAllLimbs;  // the limbs that it drives; others go on
    double hips_height_m = 0;  // of the joint hips above the soles in the clip's own rest pose;
                               // 0: as the performing figure's. Travel is scaled by the ratio
};

class ClipMaker final : public MovementMaker {
 public:
    // Needs a checked clip. Tracks of joints or DOFs that a humanoid does not have have no effect.
    ClipMaker(std::string name, std::shared_ptr<const Clip> clip, ClipPlay play);

    MovementPtr make(const OwnCall& call) const override;
    DurationRange declared(const Arguments& arguments) const override;

    // What it drives; nothing when no track is of a humanoid.
    const PosedSpec& spec() const { return spec_; }

 private:
    std::shared_ptr<const Clip> clip_;
    ClipPlay play_;
    PosedSpec spec_;
    std::vector<std::size_t> rotations_, numbers_;  // tracks behind spec_.joints and spec_.dofs
};

}  // namespace puppetri::motion
