// SPDX-License-Identifier: MIT
// One property of the Model Checking Contest: plain data, read from files by io/contest_queries.h,
// answered by verdict/contest.h.
#pragma once
#include <cstdint>
#include <string>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/net/formula.h"

namespace puppetri::verdict {

// What a property asks for.
enum class QueryKind : std::uint8_t {
    kReachability,  // one outermost EF or AG over a formula without temporal operators
    kCtl,           // path quantifiers, each with one temporal operator
    kLtl,           // one outermost A (or E) over a formula with linear temporal operators
    kUpperBound,    // the largest value of `bound` over all reachable markings
};

// Counts stand in expressions as slots kCount (net/draft.h); a comparison of int expressions is one
// atom kExpr, so boolean operators are never inside expressions. The enabledness of any of several
// transitions is an Or of kFireable; `deadlock` is the negation of the Or of all of them. Operands
// may be shared: formulas are graphs without cycles. Indices are those of the draft, to be mapped
// by Net::place_of_draft where a net was fused.
struct ContestQuery {
    std::string id;
    std::string description;
    QueryKind kind = QueryKind::kCtl;
    // kReachability: the root is kSomeFinally or kAllGlobally. kCtl: kAll... and kSome... only.
    // kLtl: kNext, kGlobally, kFinally and kUntil only; the outermost quantifier is `exists`.
    net::Formula formula;
    bool exists = false;  // of kLtl: asks for some path, not for all
    Expr bound;           // of kUpperBound: an int over kCount slots
    SourceSpan where;
};

}  // namespace puppetri::verdict
