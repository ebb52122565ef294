// SPDX-License-Identifier: MIT
// placeholder
#include "stubborn.h"
namespace puppetri::proof {
struct Stubborn::Tables {};
Stubborn::Stubborn(const PlainNet&, std::span<const Predicate>, bool) {}
Stubborn::~Stubborn() = default;
void Stubborn::reduce(std::span<const std::uint32_t>, std::span<std::uint64_t>, Scratch&) const {}
}  // namespace puppetri::proof
