// SPDX-License-Identifier: MIT
// The papers' stick figure: a tapered rod per bone and a ball per joint, each bound rigidly to one
// joint.
#pragma once
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/palette.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

// Works for any skeleton: every bone from a joint to each of its children (and to a leaf's end
// site) becomes a rod, every joint a ball, as thick as the bone is long allows. Zero-length bones,
// the root and twist joints are left out. Gives   closed components with outward unit normals; each
// vertex has one weight of 1.
Mesh make_stick_mesh(const Skeleton& skeleton, const Palette& palette);

}  // namespace puppetri::figure
