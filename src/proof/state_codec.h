// SPDX-License-Identifier: MIT
// A state of the engine as a short string of bytes, and back: everything that decides the future
// and nothing else, so that equal futures are equal strings as far as can be seen. Times count from
// now; serial numbers, arrivals and the ready times of what is ready count only as an order. Three
// forms that differ in what is kept of the time that is left: all of it, nothing, or the number of
// a variable.
#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/net/state.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

enum class ClockForm : std::uint8_t { kExact, kReadiness, kClasses };

// Something that waits under a number of a timekeeper.
struct Waiting {
    enum Kind : std::uint32_t { kPlace, kRecord, kDelay, kSuspended, kSchedule, kAttribute };
    Kind kind = kPlace;
    std::uint32_t element = 0;  // place; place; transition; transition; event; -
    std::int64_t number = 0;
    std::uint64_t serial = 0;  // of tokens with records: their order of arrival
    bool ends() const { return kind != kSuspended && kind != kAttribute; }
};

// All that waits in a state, in the order of the string.
void collect_waiting(const net::Net& net, const net::State& state, std::vector<Waiting>& out);

class StateCodec {
 public:
    StateCodec(const net::Net& net, ClockForm form);

    // Of kClasses: `variable` gives for each number the variable's, the same for equal ones.
    void encode(const net::State& state, std::vector<std::uint8_t>& out,
                const std::unordered_map<std::int64_t, std::uint32_t>* variables = nullptr);
    // Numbers of waits: 1, 2, 3, ... in the order of collect_waiting, or 1 + the variable's.
    // `length`: how many bytes the state takes; what follows is its maker's.
    net::State decode(std::span<const std::uint8_t> bytes, std::size_t* length = nullptr) const;

    // Times, each once, and their numbers.
    std::uint32_t intern(std::int64_t time);
    std::int64_t time(std::uint32_t number) const { return times_[number]; }

 private:
    const net::NetTables* tables_;
    ClockForm form_;
    std::vector<std::uint8_t> made_ready_;  // per place with records: an event makes it ready
    std::vector<std::int64_t> times_;
    std::unordered_map<std::int64_t, std::uint32_t> numbers_;
    std::vector<net::Pending> pending_;  // scratch
};

}  // namespace puppetri::proof
