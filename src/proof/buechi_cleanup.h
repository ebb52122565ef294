// SPDX-License-Identifier: MIT
// Making an automaton smaller without changing what it accepts.
#pragma once
#include "puppetri/proof/buechi.h"

namespace puppetri::proof {

// Leaves out states that are not reachable or from which nothing is accepted, acceptance marks that
// cannot count, edges that another one dominates; merges states with equal edges. The number of
// acceptance sets falls to those that matter.
void clean_up(Buechi& automaton);

}  // namespace puppetri::proof
