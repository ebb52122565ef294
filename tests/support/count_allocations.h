// SPDX-License-Identifier: MIT
// Counts what the program asks of the heap. A program that links count_allocations.cpp has its
// operator new replaced.
#pragma once
#include <cstdint>

namespace puppetri::test {

// Calls of operator new so far, in all threads.
std::uint64_t allocations();
// Bytes that are allocated now, as the allocator rounds them.
std::int64_t allocated_bytes();

}  // namespace puppetri::test
