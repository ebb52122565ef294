// SPDX-License-Identifier: MIT
// Answering the Model Checking Contest: queries of one file under one budget, by a portfolio. Cheap
// methods first (structure, walks), then one exploration that all queries share, explicit or
// symbolic. An answer is right or missing.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"
#include "puppetri/verdict/contest_query.h"

namespace puppetri::verdict {

// Questions about a net that need no file.
enum class Examination : std::uint8_t {
    kStateSpace,
    kReachabilityDeadlock,
    kQuasiLiveness,
    kLiveness,
    kOneSafe,
    kStableMarking,
};
const char* name_of(Examination examination);  // "StateSpace", ...

struct ContestAnswer {
    std::string id;
    // "TRUE", "FALSE", a number; empty: not answered.
    std::string value;
    // "EXPLICIT", "DECISION_DIAGRAMS TOPOLOGICAL", ...
    std::string techniques;
    std::string reason;  // of a missing answer: why
};
// "FORMULA id TRUE TECHNIQUES EXPLICIT"; for a missing answer "CANNOT_COMPUTE"; of a state space
// "STATE_SPACE STATES 42 TECHNIQUES EXPLICIT".
std::string contest_line(const ContestAnswer& answer);

// Called with each answer as soon as it is known.
struct AnswerSink {
    void (*take)(void* context, const ContestAnswer& answer) = nullptr;
    void* context = nullptr;
};

// All queries of one file together, whatever their kinds. In their order.
// Cost  the budget's time; its bytes for each state space: an explicit and a symbolic one may be
//       held together.
std::vector<ContestAnswer> answer_queries(const net::Net& net,
                                          std::span<const ContestQuery> queries,
                                          const proof::Budget& budget, AnswerSink sink = {});

// One answer; of kStateSpace four: STATES, TRANSITIONS, MAX_TOKEN_PER_MARKING, MAX_TOKEN_IN_PLACE.
std::vector<ContestAnswer> answer_examination(const net::Net& net, Examination examination,
                                              const proof::Budget& budget);

}  // namespace puppetri::verdict
