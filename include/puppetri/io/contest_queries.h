// SPDX-License-Identifier: MIT
// The query files of the Model Checking Contest, and TAPAAL's of the same schema: formulas over a
// net's ids. Which elements are read: docs/formats/contest_queries.md.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/net_file.h"
#include "puppetri/verdict/contest_query.h"

namespace puppetri::io {

struct ContestQueries {
    std::vector<verdict::ContestQuery> queries;  // in the order of the file
    // Per query its place in the lexicographic order of ids: the order of the contest's answers.
    std::vector<std::uint32_t> rank;
};

// Fails  with all defects: ids that the net does not have, unknown elements, wrong operands,
//        linear operators where neither CTL nor LTL allows them.
// Cost   linear in the text, but for `deadlock`: O(transitions) per formula that has it.
Checked<ContestQueries> read_contest_queries(std::string_view text, const std::string& path,
                                             const NetFile& net, const NetLimits& limits = {});

}  // namespace puppetri::io
