// SPDX-License-Identifier: MIT
// Markings that must never be, case by case, so that an invariant that excludes one of them need
// not be found again for the next.
#pragma once
#include <optional>
#include <vector>

#include "puppetri/proof/predicate.h"
#include "puppetri/proof/state_equation.h"

namespace puppetri::verdict {

// "This place has at least so many tokens" (its factor), of several places.
using TokenCase = std::vector<proof::LinearSum::Term>;

// The predicate as a disjunction of cases. Nothing: it has other inequalities, or more than a few
// hundred cases.
std::optional<std::vector<TokenCase>> token_cases(const proof::Predicate& predicate);

// The invariant says that there is no such marking.
bool excludes(const proof::Invariant& invariant, const TokenCase& tokens);

}  // namespace puppetri::verdict
