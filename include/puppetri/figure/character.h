// SPDX-License-Identifier: MIT
// A character: a figure that came from a file or was put together in the language. It has a
// skeleton of its own, a textured mesh, limits and DOFs; one that is a humanoid also has a
// normalised Figure of its proportions, for which all movements of humanoids are generated, and the
// rig that carries their poses to the skeleton. Others (a fox, a robot arm, a spider) are moved by
// movements that pose joints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "puppetri/figure/dof.h"
#include "puppetri/figure/limits.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/rig.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

struct Humanoid {
    Figure figure;
    Rig rig;
};

struct Character {
    // Raw: names, axes and rest pose of the file, in metres, +Y up, facing +Z; joint 0 is a `root`
    // on the floor that carries travel and heading and is above all that the file has. The rest
    // pose is the one that the mesh is bound in.
    Skeleton skeleton;
    Mesh mesh;                       // bound to it; its model space is the root's at rest
    std::vector<JointLimit> limits;  // one per joint
    DofSet dofs;  // by which movements pose it: of the Figure that moved_figure gives
    std::optional<Humanoid> humanoid;
    // A length of the file times this is metres: for clips from the same file, whose tracks carry
    // the names of the skeleton's joints.
    double metres_per_unit = 1;
    std::string source;  // the file, or empty; for diagnostics

    // The figure on which movements act: the humanoid's, or for a creature one that has only the
    // raw skeleton.
    Figure moved_figure() const;
    // The pose of the raw skeleton from one of moved_figure. `raw` is resized once.
    void carry(const Pose& pose, Pose& raw) const;
};

}  // namespace puppetri::figure
