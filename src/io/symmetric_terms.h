// SPDX-License-Identifier: MIT
// Terms of symmetric nets: multisets of colours on arcs and in markings, conditions of transitions.
// Read once, evaluated for each binding of variables.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "symmetric_sorts.h"

namespace puppetri::io {

struct ColourTerm {
    enum Op : std::uint8_t {
        // of colours
        kValue,     // index: the value
        kVariable,  // index: the variable
        kSuccessor,
        kPredecessor,
        kTuple,  // of colours or multisets
        // of multisets
        kAll,     // every colour of the sort once
        kScaled,  // number times operand 0
        kAdd,
        kSubtract,
        // of conditions
        kTrue,
        kFalse,
        kNot,
        kAnd,
        kOr,
        kImplies,
        kEqual,
        kNotEqual,
        kLess,
        kLessEqual,
    };
    Op op = kTrue;
    std::uint32_t sort = 0;              // of colours and multisets
    std::uint32_t first = 0, count = 0;  // operands in ColourTerms::operands
    std::uint32_t index = 0;
    std::int64_t number = 1;
    bool single = false;  // a colour: exactly one token
};

// A value and how often; after `normalize` in order, without zeros.
using ColourBag = std::vector<std::pair<std::uint32_t, std::int64_t>>;
void normalize(ColourBag& bag);

class ColourTerms {
 public:
    ColourTerms(const PnmlDocument& document, Colours& colours, const NetLimits& limits,
                Defects& defects)
        : document_(document), colours_(colours), limits_(limits), defects_(defects) {}

    // The term in the <structure> of a label. Tells why there is none, or that its sort is not the
    // place's.
    std::optional<std::uint32_t> bag(pugi::xml_node label, std::uint32_t sort,
                                     const std::string& element);
    std::optional<std::uint32_t> condition(pugi::xml_node label, const std::string& element);

    // Adds the term's bag, `times` as often. Gives  false if it has more than `most` entries.
    bool evaluate(std::uint32_t term, const std::vector<std::uint32_t>& binding, ColourBag& out,
                  std::int64_t times, std::size_t most) const;
    bool holds(std::uint32_t term, const std::vector<std::uint32_t>& binding) const;
    // Marks the variables that a term reads.
    void variables_of(std::uint32_t term, std::vector<bool>& used) const;
    // The operands of nested conjunctions.
    void conjuncts(std::uint32_t term, std::vector<std::uint32_t>& out) const;

 private:
    std::optional<std::uint32_t> read_bag(pugi::xml_node node, std::uint32_t depth,
                                          const std::uint32_t* expected);
    std::optional<std::uint32_t> read_condition(pugi::xml_node node, std::uint32_t depth);
    std::optional<std::vector<pugi::xml_node>> subterms(pugi::xml_node node, std::size_t least,
                                                        std::size_t most);
    std::optional<std::int64_t> number(pugi::xml_node node);
    std::optional<std::uint32_t> constant(std::uint32_t sort, std::uint32_t value);
    std::uint32_t push(ColourTerm term, const std::vector<std::uint32_t>& operands);
    bool too_deep(pugi::xml_node node, std::uint32_t depth);
    std::uint32_t colour(std::uint32_t term, const std::vector<std::uint32_t>& binding) const;
    void error(const char* code, pugi::xml_node at, std::string message, std::string remedy);
    const ColourTerm& operand(const ColourTerm& t, std::uint32_t i) const {
        return terms_[operands_[t.first + i]];
    }

    const PnmlDocument& document_;
    Colours& colours_;
    const NetLimits& limits_;
    Defects& defects_;
    std::string element_;
    std::vector<ColourTerm> terms_;
    std::vector<std::uint32_t> operands_;
};

}  // namespace puppetri::io
