// SPDX-License-Identifier: MIT
// What an export can do to the skeleton of a character: another rest pose, other names.
#pragma once
#include "puppetri/figure/character.h"

namespace puppetri::io {

// The skeleton of a humanoid character with its T-pose or its A-pose at rest. Needs a humanoid.
figure::Skeleton with_rest(const figure::Character& character, bool a_pose);

// Joints that are bones of the humanoid get the bones' names; others that are called so already, a
// number.
void name_bones(const figure::Character& character, figure::Skeleton& skeleton);

}  // namespace puppetri::io
