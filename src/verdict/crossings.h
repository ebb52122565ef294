// SPDX-License-Identifier: MIT
// What may be said of a net that equations and sensors speak to. To the methods of proof crossings
// are free: they come whenever they like, or never. So what holds for all of that holds; what is
// refuted, or found to be possible, counts only if a run with the equations themselves shows it.
#pragma once
#include "puppetri/verdict/obligation.h"
#include "puppetri/verdict/pursue.h"
#include "puppetri/verdict/times.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

bool has_crossings(const net::Net& net);

// Takes back what the method could not know. Needs  has_crossings(*theatre.net).
void mind_crossings(const Theatre& theatre, const net::Rule& rule, Verdict& verdict);
void mind_crossings(TimeAnswer& answer);

}  // namespace puppetri::verdict
