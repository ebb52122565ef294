// SPDX-License-Identifier: MIT
// What a proof may cost, and how it tells how far it is. Every method takes a Budget, looks at it
// every few thousand states, and ends with what it knows when it is used up: never in a crash.
#pragma once
#include <atomic>
#include <cstdint>

namespace puppetri::proof {

// How far a method has come; asked for about ten times a second.
struct Progress {
    const char* method = "";
    std::uint64_t states = 0, edges = 0;
    std::uint64_t waiting = 0;  // states found but not expanded yet
    std::uint64_t bytes = 0;    // held now
    double seconds = 0;         // since the method began
};

// Why a method ended before it was done.
enum class Ended : std::uint8_t { kDone, kTime, kMemory, kStates, kCancelled, kUnbounded };
const char* name_of(Ended ended);  // "done", "out of time", ...

struct Budget {
    double seconds = 60;
    std::uint64_t bytes = std::uint64_t{4} << 30;
    std::uint64_t states = ~std::uint64_t{0};
    const std::atomic<bool>* cancelled = nullptr;  // set by Ctrl-C
    void (*progress)(void* context, const Progress&) = nullptr;
    void* context = nullptr;
    unsigned threads = 1;
};

// Counts a method's cost against its budget. A look reads the clock (about 30 ns): look every few
// thousand states.
class Meter {
 public:
    Meter(const Budget& budget, const char* method);
    // Gives  kDone while the budget lasts, else why it does not.
    Ended look(std::uint64_t states, std::uint64_t edges, std::uint64_t waiting,
               std::uint64_t bytes);
    double seconds() const;

 private:
    const Budget& budget_;
    const char* method_;
    double started_ = 0, told_ = 0;
};

}  // namespace puppetri::proof
