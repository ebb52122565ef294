// SPDX-License-Identifier: MIT
// A net in the notation of the textbooks: P, T, F, w, M0 and the incidence matrix.
#pragma once
#include <string>

#include "puppetri/net/draft.h"

namespace puppetri::scene {

// A draft that compiles, as text, lines with newlines:
//     P = {P1, P2, P3, P4}
//     T = {t1, t2}
//     F = {(P1, t1), (P2, t2), (P3, t2), (t1, P4), (t2, P4)}
//     w(P1, t1) = 2; w(P2, t2) = w(P3, t2) = w(t1, P4) = w(t2, P4) = 1
//     M0 = [1 1 1 0]^T
// and, rows P and columns T, the incidence matrix C = post - pre. Arcs beyond the plain kind follow
// by name: tests, inhibitors, resets. Holding times and refinements have been lowered, fused places
// are one.
std::string to_mathematics(const net::NetDraft& draft);

}  // namespace puppetri::scene
