// SPDX-License-Identifier: MIT
// Calls against signatures.
#include "puppetri/lang/signature.h"

#include <algorithm>

#include "puppetri/base/text.h"

namespace puppetri::lang {
namespace {

std::string joined(std::span<const std::string> words, std::size_t most) {
    std::string out;
    for (std::size_t i = 0; i < words.size() && i < most; ++i) {
        out += i > 0 ? ", " : "";
        out += words[i];
    }
    return words.size() > most ? out + ", ..." : out;
}

}  // namespace

Diagnostic unknown_name(SourceSpan where, std::string_view kind, std::string_view unknown,
                        std::span<const std::string> known, std::string element) {
    Diagnostic out;
    out.code = "unknown-name";
    out.where = std::move(where);
    out.element = std::move(element);
    out.message = "there is no " + std::string(kind) + " '" + std::string(unknown) + "'";
    const std::string_view nearest = nearest_name(unknown, known);
    if (!nearest.empty()) {
        out.remedy = "did you mean " + std::string(nearest) + "?";
    } else if (!known.empty()) {
        out.remedy = "there are: " + joined(known, 12);
    } else {
        out.remedy = "declare it, or correct the name";
    }
    return out;
}

MatchedArguments match_arguments(const Signature& signature, std::span<const Argument> arguments,
                                 Span call) {
    const std::vector<ParameterSignature>& wanted = signature.parameters;
    MatchedArguments out;
    out.values.assign(wanted.size(), nullptr);
    std::vector<std::string> names;
    for (const ParameterSignature& parameter : wanted) {
        names.push_back(parameter.name);
    }
    std::size_t position = 0;
    bool named = false;
    // The parameter of one argument, or kNone with the reason added to the defects.
    const auto match = [&](const Argument& a) {
        std::size_t i = position;
        if (a.name.text.empty()) {
            ++position;
            if (named) {
                out.defects.push_back({"argument-order", a.value.span,
                                       "an argument by position after one by name",
                                       "name it too: `NAME: value`"});
                return MatchedArguments::kNone;
            }
            if (i >= wanted.size()) {
                out.defects.push_back({"too-many-arguments", a.value.span,
                                       signature.name + " takes " + std::to_string(wanted.size()) +
                                           (wanted.size() == 1 ? " argument" : " arguments"),
                                       wanted.empty()
                                           ? "remove this one"
                                           : "remove this one; there are: " + joined(names, 12)});
                return MatchedArguments::kNone;
            }
        } else {
            named = true;
            i = static_cast<std::size_t>(std::find(names.begin(), names.end(), a.name.text) -
                                         names.begin());
            if (i == wanted.size()) {
                Diagnostic unknown =
                    unknown_name({}, "parameter of " + signature.name, a.name.text, names, {});
                out.defects.push_back({std::move(unknown.code), a.name.span,
                                       std::move(unknown.message), std::move(unknown.remedy)});
                return MatchedArguments::kNone;
            }
        }
        if (out.values[i] != nullptr) {
            out.defects.push_back({"repeated-argument", a.value.span, names[i] + " is given twice",
                                   "remove one of them"});
            return MatchedArguments::kNone;
        }
        out.values[i] = &a.value;
        return static_cast<std::uint32_t>(i);
    };
    for (const Argument& a : arguments) {
        out.parameter_of.push_back(match(a));
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i].required && out.values[i] == nullptr) {
            const std::string what = wanted[i].wanted.empty() ? "" : wanted[i].wanted + ": ";
            out.defects.push_back({"missing-argument", call,
                                   signature.name + " needs " + what + names[i],
                                   "write " + names[i] + ": ..."});
        }
    }
    return out;
}

}  // namespace puppetri::lang
