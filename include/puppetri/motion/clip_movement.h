// SPDX-License-Identifier: MIT
// Clips as movements. A clip whose tracks are of the normalised humanoid (joints of figure::Figure,
// degrees of freedom) is performed by any humanoid: what it travels begins where the figure stands;
// feet that its marks hold to the floor stay there by inverse kinematics, whatever the proportions.
// A clip in the form that its file has is performed by any other figure whose joints have its
// names.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/clip.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {

// One clip in the forms in which it can be performed; at least one is there.
struct PlayableClip {
    std::shared_ptr<const Clip> humanoid;  // tracks of the normalised humanoid; may be null
    // Of the joint hips above the soles in the clip's own rest pose; 0: as the performing figure's.
    // Travel is scaled by the ratio.
    double hips_height_m = 0;
    std::shared_ptr<const Clip> raw;  // tracks of the joints of its file; may be null
    figure::Skeleton skeleton;        // of the file; may be empty
    double advances_m_s = 0;          // goes ahead so fast besides what it travels itself
};

class ClipMaker final : public MovementMaker {
 public:
    // Needs checked clips of one duration, speed > 0 (2: twice as fast). Tracks of joints or DOFs
    // that a figure does not have have no effect on it.
    ClipMaker(std::string name, PlayableClip clip, double speed);

    // Needs plays_on(call.context.figure).
    MovementPtr make(const OwnCall& call) const override;
    DurationRange declared(const Arguments& arguments) const override;

    // What it drives of a humanoid; nothing when no track is of one.
    const PosedSpec& spec() const { return spec_; }
    // Whether it moves anything of this figure.
    bool plays_on(const figure::Figure& figure) const;

 private:
    const Clip& any() const { return clip_.humanoid != nullptr ? *clip_.humanoid : *clip_.raw; }

    std::string name_;
    PlayableClip clip_;
    double speed_ = 1, advances_ = 0;
    PosedSpec spec_;
    std::vector<std::size_t> rotations_, numbers_;  // tracks behind spec_.joints and spec_.dofs
};

}  // namespace puppetri::motion
