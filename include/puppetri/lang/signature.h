// SPDX-License-Identifier: MIT
// What everything that is called by name with arguments wants: movements, distributions, nets. Who
// knows them hands their signatures in as data; matching arguments with parameters, and the
// remedies, come from here, so that every wrong call of the language is told in the same words.
// Whether a value fits its parameter is for whoever evaluates it.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::lang {

struct ParameterSignature {
    std::string name;
    bool required = false;
    std::string wanted;  // "a time", for the message when it is missing; may be empty
};

struct Signature {
    std::string name;  // "throw", "net walk": as messages call it
    std::vector<ParameterSignature> parameters;
};

// A diagnostic that does not know its file yet.
struct CallDefect {
    std::string code;
    Span where;
    std::string message, remedy;
};

struct MatchedArguments {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    std::vector<std::uint32_t> parameter_of;  // by argument; kNone where that argument is defective
    std::vector<const Expr*> values;          // by parameter; null: not given
    std::vector<CallDefect> defects;
};

// Arguments by position come first, then those by name, in any order.
// Fails   with all of: unknown-name (nearest parameter), repeated-argument, argument-order,
// too-many-arguments,
//         missing-argument (at `call`).
MatchedArguments match_arguments(const Signature& signature, std::span<const Argument> arguments,
                                 Span call);

// `unknown` with the remedy "did you mean X?", or the list of what there is when nothing is near.
// `kind` is what was wanted: "place", "parameter of throw".
Diagnostic unknown_name(SourceSpan where, std::string_view kind, std::string_view unknown,
                        std::span<const std::string> known, std::string element);

}  // namespace puppetri::lang
