// SPDX-License-Identifier: MIT
// Reading XML as notations need it: elements, attributes and where they stand, byte for byte. What
// can grow without bound or reach outside is refused: no document types, hence no entities but the
// five of XML itself and characters by number; a limited depth.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/lang/expression.h"

namespace puppetri::notation::xml {

struct Attribute {
    std::string name, value;  // as written, and with entities replaced
    lang::Span span;          // of the value
};

struct Element {
    std::string name;   // without prefix
    std::string space;  // what the prefix stands for; empty: none
    std::vector<Attribute> attributes;
    std::vector<Element> children;
    std::string text;  // between the children, all together
    lang::Span span;   // of the start tag

    const Attribute* find(std::string_view attribute) const;
};

struct Defect {
    std::string code, message, remedy;
    lang::Span where;
};

inline constexpr int kMaxDepth = 100;

struct Document {
    Element root;
    std::vector<Defect> defects;  // not empty: the root is not whole
};

// Cost    linear in the text. `file` is the number of the spans.
Document parse(std::string_view text, std::uint32_t file);

}  // namespace puppetri::notation::xml
