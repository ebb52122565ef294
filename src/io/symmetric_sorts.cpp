// SPDX-License-Identifier: MIT
#include "symmetric_sorts.h"

#include <set>
#include <utility>

namespace puppetri::io {
namespace {

constexpr std::uint64_t kMostColours = 10'000'000;  // of one sort

}  // namespace

void Colours::error(const char* code, pugi::xml_node at, const std::string& element,
                    std::string message, std::string remedy) {
    defects_->error(code, document_->text.where(at), element, std::move(message),
                    std::move(remedy));
}

void Colours::read(const PnmlDocument& document, const NetLimits& limits, Defects& defects) {
    document_ = &document;
    limits_ = &limits;
    defects_ = &defects;
    sorts_ = {ColourSort{.kind = ColourSort::kDot, .size = 1},
              ColourSort{.kind = ColourSort::kBool, .size = 2}};
    std::vector<pugi::xml_node> variables;
    for (const pugi::xml_node declaration : document.declarations) {
        const pugi::xml_node list = child(child(declaration, "structure"), "declarations");
        if (!list) {
            error("unknown-label", declaration, "declaration", "it has no <declarations>",
                  "write the declarations in <structure><declarations>");
            continue;
        }
        for (const pugi::xml_node node : list.children()) {
            if (node.type() != pugi::node_element) {
                continue;
            }
            const std::string_view kind = local_name(node);
            const std::string id = node.attribute("id").value();
            if (kind == "namedsort") {
                if (!declared_.emplace(id, Declared{.xml = node}).second) {
                    error("duplicate-id", node, "sort " + id, "the id is taken by another sort",
                          "give one of them another id");
                }
            } else if (kind == "variabledecl") {
                variables.push_back(node);
            } else {
                error("not-supported", node, "declaration " + id,
                      "<" + std::string(kind) + "> is not read",
                      "sorts and variables of symmetric nets are; write partitions out");
            }
        }
    }
    for (const auto& [id, declared] : declared_) {
        named(id, declared.xml, "sort " + id);
    }
    for (const pugi::xml_node node : variables) {
        const std::string id = node.attribute("id").value();
        pugi::xml_node sort;
        for (const pugi::xml_node c : node.children()) {
            sort = c.type() == pugi::node_element && !sort ? c : sort;
        }
        const std::optional<std::uint32_t> found =
            sort ? sort_of(sort, "variable " + id) : std::nullopt;
        if (!sort) {
            error("unknown-label", node, "variable " + id, "it has no sort", "name its sort");
        }
        if (!variable_ids_.emplace(id, static_cast<std::uint32_t>(variables_.size())).second) {
            error("duplicate-id", node, "variable " + id, "the id is taken by another variable",
                  "give one of them another id");
        }
        const std::string name = node.attribute("name").value();
        variables_.push_back({id, name.empty() ? id : name, found.value_or(kDotSort)});
    }
}

std::optional<std::uint32_t> Colours::named(const std::string& id, pugi::xml_node at,
                                            const std::string& element) {
    const auto found = declared_.find(id);
    if (found == declared_.end()) {
        error("unknown-id", at, element, "there is no sort " + id, "declare it in <declarations>");
        return std::nullopt;
    }
    Declared& declared = found->second;
    if (declared.state == 1) {
        error("wrong-reference", declared.xml, "sort " + id, "the sort is made of itself",
              "let it be made of others");
        return std::nullopt;
    }
    if (declared.state == 0) {
        declared.state = 1;
        pugi::xml_node sort;
        for (const pugi::xml_node c : declared.xml.children()) {
            sort = c.type() == pugi::node_element && !sort ? c : sort;
        }
        if (sort) {
            declared.sort = sort_of(sort, "sort " + id);
        } else {
            error("unknown-label", declared.xml, "sort " + id, "it says not what it is",
                  "put a sort into it");
        }
        declared.state = 2;
    }
    return declared.sort;
}

std::optional<std::uint32_t> Colours::sort_of(pugi::xml_node node, const std::string& element) {
    if (depth_ > limits_->nesting) {
        error("nested-too-deep", node, element, "sorts are nested too deep", "flatten them");
        return std::nullopt;
    }
    ++depth_;
    const std::string_view kind = local_name(node);
    std::optional<std::uint32_t> out;
    if (kind == "usersort") {
        out = named(node.attribute("declaration").value(), node, element);
    } else if (kind == "dot") {
        out = kDotSort;
    } else if (kind == "bool" || kind == "boolean") {
        out = kBoolSort;
    } else if (kind == "finiteenumeration" || kind == "cyclicenumeration") {
        out = enumeration(node, kind == "cyclicenumeration", element);
    } else if (kind == "finiteintrange") {
        out = range(node, element);
    } else if (kind == "productsort") {
        out = product(node, element);
    } else {
        error("not-supported", node, element, "the sort <" + std::string(kind) + "> is not read",
              "symmetric nets have dot, bool, enumerations, ranges and products");
    }
    --depth_;
    return out;
}

std::optional<std::uint32_t> Colours::enumeration(pugi::xml_node node, bool cyclic,
                                                  const std::string& element) {
    ColourSort sort{.kind = cyclic ? ColourSort::kCyclic : ColourSort::kEnumeration};
    const auto index = static_cast<std::uint32_t>(sorts_.size());
    std::set<std::string> names;
    bool unique = true;
    std::vector<std::string> ids;
    for (const pugi::xml_node c : node.children()) {
        if (c.type() != pugi::node_element) {
            continue;
        }
        const std::string id = c.attribute("id").value();
        if (local_name(c) != "feconstant") {
            error("unknown-label", c, element,
                  "<" + std::string(local_name(c)) + "> is not known in an enumeration",
                  "an enumeration has <feconstant>s");
            continue;
        }
        const auto value = static_cast<std::uint32_t>(ids.size());
        if (!constants_.emplace(id, ColourConstant{index, value}).second) {
            error("duplicate-id", c, element, "the constant " + id + " is there already",
                  "give one of them another id");
        }
        const std::string name = c.attribute("name").value();
        sort.names.push_back(name.empty() ? id : name);
        unique = names.insert(sort.names.back()).second && unique;
        ids.push_back(id);
    }
    if (ids.empty()) {
        error("unknown-label", node, element, "the enumeration is empty", "give it a constant");
        return std::nullopt;
    }
    if (!unique) {
        sort.names = ids;
    }
    sort.size = static_cast<std::uint32_t>(ids.size());
    sorts_.push_back(std::move(sort));
    return index;
}

std::optional<std::uint32_t> Colours::range(pugi::xml_node node, const std::string& element) {
    const ParsedInteger start = parse_integer(node.attribute("start").value());
    const ParsedInteger end = parse_integer(node.attribute("end").value());
    constexpr std::int64_t kFar = std::int64_t{1} << 40;
    if (start.kind != ParsedInteger::kFine || end.kind != ParsedInteger::kFine ||
        start.value > end.value || start.value < -kFar || end.value > kFar) {
        error("not-a-number", node, element, "the range has no start and end with start <= end",
              "write start and end as whole numbers");
        return std::nullopt;
    }
    if (static_cast<std::uint64_t>(end.value - start.value) >= kMostColours) {
        error("net-too-large", node, element,
              "the range has more than " + std::to_string(kMostColours) + " values",
              "make it smaller");
        return std::nullopt;
    }
    return intern("range " + std::to_string(start.value) + " " + std::to_string(end.value),
                  {.kind = ColourSort::kRange,
                   .size = static_cast<std::uint32_t>(end.value - start.value + 1),
                   .low = start.value});
}

std::optional<std::uint32_t> Colours::product(pugi::xml_node node, const std::string& element) {
    ColourSort sort{.kind = ColourSort::kProduct};
    std::string key = "product";
    std::uint64_t size = 1;
    for (const pugi::xml_node c : node.children()) {
        if (c.type() != pugi::node_element) {
            continue;
        }
        const std::optional<std::uint32_t> part = sort_of(c, element);
        if (!part) {
            return std::nullopt;
        }
        sort.parts.push_back(*part);
        key += " " + std::to_string(*part);
        size *= sorts_[*part].size;
        if (size > kMostColours) {
            error("net-too-large", node, element,
                  "the product has more than " + std::to_string(kMostColours) + " values",
                  "make its parts smaller");
            return std::nullopt;
        }
    }
    if (sort.parts.empty()) {
        error("unknown-label", node, element, "the product has no parts", "name its sorts");
        return std::nullopt;
    }
    sort.size = static_cast<std::uint32_t>(size);
    return intern(key, std::move(sort));
}

std::uint32_t Colours::intern(const std::string& key, ColourSort sort) {
    const auto [at, is_new] = by_key_.emplace(key, static_cast<std::uint32_t>(sorts_.size()));
    if (is_new) {
        sorts_.push_back(std::move(sort));
    }
    return at->second;
}

const ColourConstant* Colours::find_constant(const std::string& id) const {
    const auto at = constants_.find(id);
    return at == constants_.end() ? nullptr : &at->second;
}

const std::uint32_t* Colours::find_variable(const std::string& id) const {
    const auto at = variable_ids_.find(id);
    return at == variable_ids_.end() ? nullptr : &at->second;
}

std::string Colours::name(std::uint32_t sort, std::uint32_t value) const {
    const ColourSort& s = sorts_[sort];
    switch (s.kind) {
        case ColourSort::kDot:
            return "dot";
        case ColourSort::kBool:
            return value != 0 ? "true" : "false";
        case ColourSort::kEnumeration:
        case ColourSort::kCyclic:
            return s.names[value];
        case ColourSort::kRange:
            return std::to_string(s.low + value);
        case ColourSort::kProduct:
            break;
    }
    std::string out;
    for (std::size_t i = s.parts.size(); i-- > 0;) {
        const std::uint32_t size = sorts_[s.parts[i]].size;
        const std::string part = name(s.parts[i], value % size);
        const bool nested = sorts_[s.parts[i]].kind == ColourSort::kProduct;
        out = (nested ? "(" + part + ")" : part) + (out.empty() ? "" : "," + out);
        value /= size;
    }
    return out;
}

}  // namespace puppetri::io
