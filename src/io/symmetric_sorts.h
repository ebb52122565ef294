// SPDX-License-Identifier: MIT
// The colours of a symmetric net: sorts, their values, the variables over them. A value is its
// number in its sort; of a product, the mixed-radix number of its parts, the first most
// significant.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "defects.h"
#include "pnml_document.h"

namespace puppetri::io {

struct ColourSort {
    enum Kind : std::uint8_t { kDot, kBool, kEnumeration, kCyclic, kRange, kProduct };
    Kind kind = kDot;
    std::uint32_t size = 1;
    std::int64_t low = 0;              // of ranges: the number of value 0
    std::vector<std::uint32_t> parts;  // of products: sorts
    std::vector<std::string> names;    // of enumerations
};

struct ColourVariable {
    std::string id, name;
    std::uint32_t sort = 0;
};

struct ColourConstant {
    std::uint32_t sort = 0, value = 0;
};

class Colours {
 public:
    static constexpr std::uint32_t kDotSort = 0, kBoolSort = 1;

    // Reads all declarations of the document, telling what it does not understand.
    void read(const PnmlDocument& document, const NetLimits& limits, Defects& defects);

    // The sort that an element names (<usersort>) or describes. Equal ranges and products are one
    // sort, enumerations are told apart by their declarations. Tells why there is none.
    std::optional<std::uint32_t> sort_of(pugi::xml_node node, const std::string& element);

    const ColourSort& sort(std::uint32_t index) const { return sorts_[index]; }
    const std::vector<ColourVariable>& variables() const { return variables_; }
    const ColourConstant* find_constant(const std::string& id) const;
    const std::uint32_t* find_variable(const std::string& id) const;
    // "Eat", "3", "a,2"; products inside products in brackets.
    std::string name(std::uint32_t sort, std::uint32_t value) const;

 private:
    std::optional<std::uint32_t> named(const std::string& id, pugi::xml_node at,
                                       const std::string& element);
    std::optional<std::uint32_t> enumeration(pugi::xml_node node, bool cyclic,
                                             const std::string& element);
    std::optional<std::uint32_t> range(pugi::xml_node node, const std::string& element);
    std::optional<std::uint32_t> product(pugi::xml_node node, const std::string& element);
    std::uint32_t intern(const std::string& key, ColourSort sort);
    void error(const char* code, pugi::xml_node at, const std::string& element, std::string message,
               std::string remedy);

    const PnmlDocument* document_ = nullptr;
    const NetLimits* limits_ = nullptr;
    Defects* defects_ = nullptr;
    std::vector<ColourSort> sorts_;
    std::map<std::string, std::uint32_t> by_key_;
    struct Declared {
        pugi::xml_node xml;
        std::optional<std::uint32_t> sort;
        std::uint8_t state = 0;  // 1: being read, 2: done
    };
    std::map<std::string, Declared> declared_;
    std::map<std::string, ColourConstant> constants_;
    std::vector<ColourVariable> variables_;
    std::map<std::string, std::uint32_t> variable_ids_;
    std::uint32_t depth_ = 0;
};

}  // namespace puppetri::io
