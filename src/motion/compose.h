// SPDX-License-Identifier: MIT
// Movements made of movements: side by side on different limbs, or one after the other.
#pragma once
#include <vector>

#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// Both from the same start. `main` writes first; `arms` may drive what main drives too and then
// wins. The duration is main's.
MovementPtr side_by_side(MovementPtr main, MovementPtr arms);

// Each begins when its predecessor's duration is over; the last goes on as a living rest. Needs at
// least one.
MovementPtr in_turn(std::vector<MovementPtr> parts);

// Moves the context to the end of a movement that starts from it: the start of the next.
void advance_over(MotionContext& context, const Movement& movement);

}  // namespace puppetri::motion
