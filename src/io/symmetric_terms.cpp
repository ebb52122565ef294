// SPDX-License-Identifier: MIT
#include "symmetric_terms.h"

#include <algorithm>

namespace puppetri::io {
namespace {

constexpr std::int64_t kMostTokens = 0x3FFF'FFFF;

}  // namespace

void normalize(ColourBag& bag) {
    std::sort(bag.begin(), bag.end());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < bag.size();) {
        std::pair<std::uint32_t, std::int64_t> sum = bag[i];
        for (++i; i < bag.size() && bag[i].first == sum.first; ++i) {
            sum.second += bag[i].second;
        }
        if (sum.second != 0) {
            bag[kept++] = sum;
        }
    }
    bag.resize(kept);
}

void ColourTerms::error(const char* code, pugi::xml_node at, std::string message,
                        std::string remedy) {
    defects_.error(code, document_.text.where(at), element_, std::move(message), std::move(remedy));
}

bool ColourTerms::too_deep(pugi::xml_node node, std::uint32_t depth) {
    if (depth > limits_.nesting) {
        error("nested-too-deep", node,
              "the term is nested deeper than " + std::to_string(limits_.nesting) + " levels",
              "sums may have many operands");
        return true;
    }
    return false;
}

std::uint32_t ColourTerms::push(ColourTerm term, const std::vector<std::uint32_t>& operands) {
    term.first = static_cast<std::uint32_t>(operands_.size());
    term.count = static_cast<std::uint32_t>(operands.size());
    operands_.insert(operands_.end(), operands.begin(), operands.end());
    terms_.push_back(term);
    return static_cast<std::uint32_t>(terms_.size()) - 1;
}

std::optional<std::vector<pugi::xml_node>> ColourTerms::subterms(pugi::xml_node node,
                                                                 std::size_t least,
                                                                 std::size_t most) {
    std::vector<pugi::xml_node> out;
    bool fine = true;
    for (const pugi::xml_node c : elements(node)) {
        const std::vector<pugi::xml_node> inside = elements(c);
        if (local_name(c) != "subterm" || inside.size() != 1) {
            fine = false;
            break;
        }
        out.push_back(inside[0]);
    }
    if (!fine || out.size() < least || out.size() > most) {
        error("wrong-operands", node,
              "<" + std::string(local_name(node)) + "> does not have its operands in <subterm>s",
              least == most ? "it takes " + std::to_string(least)
                            : "it takes at least " + std::to_string(least));
        return std::nullopt;
    }
    return out;
}

std::optional<std::int64_t> ColourTerms::number(pugi::xml_node node) {
    const ParsedInteger value = parse_integer(node.attribute("value").value());
    if (local_name(node) != "numberconstant" || value.kind != ParsedInteger::kFine ||
        value.value < 0 || value.value > kMostTokens) {
        error("not-a-number", node, "expected a <numberconstant> with a value from 0 on",
              "write how many tokens");
        return std::nullopt;
    }
    return value.value;
}

std::optional<std::uint32_t> ColourTerms::constant(std::uint32_t sort, std::uint32_t value) {
    return push({.op = ColourTerm::kValue, .sort = sort, .index = value, .single = true}, {});
}

std::optional<std::uint32_t> ColourTerms::bag(pugi::xml_node label, std::uint32_t sort,
                                              const std::string& element) {
    element_ = element;
    const std::vector<pugi::xml_node> inside = elements(child(label, "structure"));
    if (inside.size() != 1) {
        error("wrong-operands", label,
              "<" + std::string(local_name(label)) + "> has no term in its <structure>",
              "write one term; its text alone is not read");
        return std::nullopt;
    }
    const std::optional<std::uint32_t> term = read_bag(inside[0], 0, &sort);
    if (term && terms_[*term].sort != sort) {
        error("wrong-sort", inside[0], "the term is of another sort than the place",
              "write a term of the place's sort");
        return std::nullopt;
    }
    return term;
}

std::optional<std::uint32_t> ColourTerms::condition(pugi::xml_node label,
                                                    const std::string& element) {
    element_ = element;
    const std::vector<pugi::xml_node> inside = elements(child(label, "structure"));
    if (inside.size() != 1) {
        error("wrong-operands", label, "<condition> has no term in its <structure>",
              "write one condition; its text alone is not read");
        return std::nullopt;
    }
    return read_condition(inside[0], 0);
}

std::optional<std::uint32_t> ColourTerms::read_bag(pugi::xml_node node, std::uint32_t depth,
                                                   const std::uint32_t* expected) {
    if (too_deep(node, depth)) {
        return std::nullopt;
    }
    const std::string_view name = local_name(node);
    if (name == "dotconstant") {
        return constant(Colours::kDotSort, 0);
    }
    if (name == "booleanconstant") {
        const std::string_view value = node.attribute("value").value();
        return constant(Colours::kBoolSort, value == "true" ? 1 : 0);
    }
    if (name == "useroperator") {
        const std::string id = node.attribute("declaration").value();
        const ColourConstant* found = colours_.find_constant(id);
        if (found == nullptr) {
            error("unknown-id", node, "there is no constant " + id,
                  "declare it in an enumeration; operators of one's own are not read");
            return std::nullopt;
        }
        return constant(found->sort, found->value);
    }
    if (name == "finiteintrangeconstant") {
        const ParsedInteger value = parse_integer(node.attribute("value").value());
        const pugi::xml_node range = child(node, "finiteintrange");
        const std::optional<std::uint32_t> sort =
            range ? colours_.sort_of(range, element_) : std::nullopt;
        if (!sort || value.kind != ParsedInteger::kFine || value.value < colours_.sort(*sort).low ||
            value.value - colours_.sort(*sort).low >= colours_.sort(*sort).size) {
            error("not-a-number", node, "a constant that does not lie in its range",
                  "write a value of <finiteintrange>");
            return std::nullopt;
        }
        return constant(*sort, static_cast<std::uint32_t>(value.value - colours_.sort(*sort).low));
    }
    if (name == "variable") {
        const std::string id = node.attribute("refvariable").value();
        const std::uint32_t* found = colours_.find_variable(id);
        if (found == nullptr) {
            error("unknown-id", node, "there is no variable " + id, "declare it");
            return std::nullopt;
        }
        return push({.op = ColourTerm::kVariable,
                     .sort = colours_.variables()[*found].sort,
                     .index = *found,
                     .single = true},
                    {});
    }
    if (name == "all") {
        const std::vector<pugi::xml_node> inside = elements(node);
        if (inside.size() != 1) {
            error("wrong-operands", node, "<all> wants one sort", "name the sort");
            return std::nullopt;
        }
        if (const auto sort = colours_.sort_of(inside[0], element_)) {
            return push(
                {.op = ColourTerm::kAll, .sort = *sort, .single = colours_.sort(*sort).size == 1},
                {});
        }
        return std::nullopt;
    }
    if (name == "successor" || name == "predecessor") {
        const auto parts = subterms(node, 1, 1);
        const std::optional<std::uint32_t> term =
            parts ? read_bag((*parts)[0], depth + 1, nullptr) : std::nullopt;
        if (!term) {
            return std::nullopt;
        }
        const ColourTerm of = terms_[*term];
        if (colours_.sort(of.sort).kind != ColourSort::kCyclic) {
            error("wrong-sort", node,
                  "<" + std::string(name) + "> of something that is not of a cyclic enumeration",
                  "declare the sort with <cyclicenumeration>");
            return std::nullopt;
        }
        return push({.op = name == "successor" ? ColourTerm::kSuccessor : ColourTerm::kPredecessor,
                     .sort = of.sort,
                     .single = of.single},
                    {*term});
    }
    if (name == "tuple") {
        const auto parts = subterms(node, 1, 64);
        if (!parts) {
            return std::nullopt;
        }
        // The sort of the tuple: the one expected if the parts fit, which they must.
        std::vector<std::uint32_t> operands;
        bool single = true;
        for (std::size_t i = 0; i < parts->size(); ++i) {
            const ColourSort* product =
                expected != nullptr && colours_.sort(*expected).kind == ColourSort::kProduct &&
                        colours_.sort(*expected).parts.size() == parts->size()
                    ? &colours_.sort(*expected)
                    : nullptr;
            const std::uint32_t part = product != nullptr ? product->parts[i] : 0;
            const std::optional<std::uint32_t> term =
                read_bag((*parts)[i], depth + 1, product != nullptr ? &part : nullptr);
            if (!term) {
                return std::nullopt;
            }
            operands.push_back(*term);
            single = single && terms_[*term].single;
        }
        bool fits = expected != nullptr && colours_.sort(*expected).kind == ColourSort::kProduct &&
                    colours_.sort(*expected).parts.size() == operands.size();
        for (std::size_t i = 0; fits && i < operands.size(); ++i) {
            fits = terms_[operands[i]].sort == colours_.sort(*expected).parts[i];
        }
        if (!fits) {
            error("wrong-sort", node, "the tuple is of no known product of sorts",
                  "write a tuple of the place's sort");
            return std::nullopt;
        }
        return push({.op = ColourTerm::kTuple, .sort = *expected, .single = single}, operands);
    }
    if (name == "numberof" || name == "scalarproduct") {
        // <numberof> may leave the number out.
        const auto parts = subterms(node, 1, 2);
        if (!parts) {
            return std::nullopt;
        }
        const std::optional<std::int64_t> times =
            parts->size() == 2 ? number((*parts)[0]) : std::optional<std::int64_t>(1);
        const std::optional<std::uint32_t> term = read_bag(parts->back(), depth + 1, expected);
        if (!times || !term) {
            return std::nullopt;
        }
        return push({.op = ColourTerm::kScaled, .sort = terms_[*term].sort, .number = *times},
                    {*term});
    }
    if (name == "add" || name == "subtract") {
        const auto parts = subterms(node, name == "add" ? 1 : 2, name == "add" ? 1'000'000 : 2);
        if (!parts) {
            return std::nullopt;
        }
        std::vector<std::uint32_t> operands;
        for (const pugi::xml_node part : *parts) {
            const std::optional<std::uint32_t> term = read_bag(part, depth + 1, expected);
            if (!term) {
                return std::nullopt;
            }
            if (!operands.empty() && terms_[*term].sort != terms_[operands[0]].sort) {
                error("wrong-sort", part, "the operands are of different sorts",
                      "add what is of one sort");
                return std::nullopt;
            }
            operands.push_back(*term);
        }
        return push({.op = name == "add" ? ColourTerm::kAdd : ColourTerm::kSubtract,
                     .sort = terms_[operands[0]].sort},
                    operands);
    }
    if (name == "empty") {
        return push({.op = ColourTerm::kScaled,
                     .sort = expected != nullptr ? *expected : Colours::kDotSort,
                     .number = 0},
                    {push({.op = ColourTerm::kAll,
                           .sort = expected != nullptr ? *expected : Colours::kDotSort},
                          {})});
    }
    error("not-supported", node, "the term <" + std::string(name) + "> is not read",
          "docs/formats/pnml.md lists those that are");
    return std::nullopt;
}

std::optional<std::uint32_t> ColourTerms::read_condition(pugi::xml_node node, std::uint32_t depth) {
    if (too_deep(node, depth)) {
        return std::nullopt;
    }
    const std::string_view name = local_name(node);
    if (name == "booleanconstant") {
        const std::string_view value = node.attribute("value").value();
        return push({.op = value == "true" ? ColourTerm::kTrue : ColourTerm::kFalse}, {});
    }
    const auto logical = [&](ColourTerm::Op op, std::size_t least,
                             std::size_t most) -> std::optional<std::uint32_t> {
        const auto parts = subterms(node, least, most);
        if (!parts) {
            return std::nullopt;
        }
        std::vector<std::uint32_t> operands;
        for (const pugi::xml_node part : *parts) {
            const std::optional<std::uint32_t> term = read_condition(part, depth + 1);
            if (!term) {
                return std::nullopt;
            }
            operands.push_back(*term);
        }
        return push({.op = op}, operands);
    };
    if (name == "and") {
        return logical(ColourTerm::kAnd, 1, 1'000'000);
    }
    if (name == "or") {
        return logical(ColourTerm::kOr, 1, 1'000'000);
    }
    if (name == "not") {
        return logical(ColourTerm::kNot, 1, 1);
    }
    if (name == "imply") {
        return logical(ColourTerm::kImplies, 2, 2);
    }
    struct Comparison {
        std::string_view name;
        ColourTerm::Op op;
        bool swapped;
    };
    static constexpr Comparison kComparisons[] = {
        {"equality", ColourTerm::kEqual, false},
        {"inequality", ColourTerm::kNotEqual, false},
        {"lessthan", ColourTerm::kLess, false},
        {"lessthanorequal", ColourTerm::kLessEqual, false},
        {"greaterthan", ColourTerm::kLess, true},
        {"greaterthanorequal", ColourTerm::kLessEqual, true},
    };
    for (const Comparison& c : kComparisons) {
        if (name != c.name) {
            continue;
        }
        const auto parts = subterms(node, 2, 2);
        if (!parts) {
            return std::nullopt;
        }
        const std::optional<std::uint32_t> left = read_bag((*parts)[0], depth + 1, nullptr);
        const std::optional<std::uint32_t> right = read_bag((*parts)[1], depth + 1, nullptr);
        if (!left || !right) {
            return std::nullopt;
        }
        const ColourTerm &a = terms_[*left], &b = terms_[*right];
        const bool both_ranges = colours_.sort(a.sort).kind == ColourSort::kRange &&
                                 colours_.sort(b.sort).kind == ColourSort::kRange;
        const bool ordered = c.op == ColourTerm::kEqual || c.op == ColourTerm::kNotEqual ||
                             colours_.sort(a.sort).kind != ColourSort::kProduct;
        if (!a.single || !b.single || (a.sort != b.sort && !both_ranges) || !ordered) {
            error("wrong-sort", node, "it does not compare two colours of one sort",
                  "compare values, not multisets, of one sort");
            return std::nullopt;
        }
        return c.swapped ? push({.op = c.op}, {*right, *left})
                         : push({.op = c.op}, {*left, *right});
    }
    error("not-supported", node, "the condition <" + std::string(name) + "> is not read",
          "docs/formats/pnml.md lists those that are");
    return std::nullopt;
}

std::uint32_t ColourTerms::colour(std::uint32_t term,
                                  const std::vector<std::uint32_t>& binding) const {
    const ColourTerm& t = terms_[term];
    switch (t.op) {
        case ColourTerm::kVariable:
            return binding[t.index];
        case ColourTerm::kSuccessor:
        case ColourTerm::kPredecessor: {
            const std::uint32_t size = colours_.sort(t.sort).size;
            const std::uint32_t of = colour(operands_[t.first], binding);
            return (of + (t.op == ColourTerm::kSuccessor ? 1 : size - 1)) % size;
        }
        case ColourTerm::kTuple: {
            std::uint32_t value = 0;
            for (std::uint32_t i = 0; i < t.count; ++i) {
                value = value * colours_.sort(operand(t, i).sort).size +
                        colour(operands_[t.first + i], binding);
            }
            return value;
        }
        default:
            return t.index;  // kValue; kAll of a sort with one value
    }
}

bool ColourTerms::evaluate(std::uint32_t term, const std::vector<std::uint32_t>& binding,
                           ColourBag& out, std::int64_t times, std::size_t most) const {
    const ColourTerm& t = terms_[term];
    if (out.size() > most) {
        return false;
    }
    if (t.single && t.op != ColourTerm::kAll) {
        out.emplace_back(colour(term, binding), times);
        return true;
    }
    switch (t.op) {
        case ColourTerm::kAll: {
            const std::uint32_t size = colours_.sort(t.sort).size;
            if (out.size() + size > most) {
                return false;
            }
            for (std::uint32_t i = 0; i < size; ++i) {
                out.emplace_back(i, times);
            }
            return true;
        }
        case ColourTerm::kScaled:
            // Both are at most 2^30, and so must their product be.
            if (times * t.number > kMostTokens || times * t.number < -kMostTokens) {
                return false;
            }
            return t.number == 0 ||
                   evaluate(operands_[t.first], binding, out, times * t.number, most);
        case ColourTerm::kAdd:
        case ColourTerm::kSubtract:
            for (std::uint32_t i = 0; i < t.count; ++i) {
                const bool minus = t.op == ColourTerm::kSubtract && i > 0;
                if (!evaluate(operands_[t.first + i], binding, out, minus ? -times : times, most)) {
                    return false;
                }
            }
            return true;
        case ColourTerm::kSuccessor:
        case ColourTerm::kPredecessor: {
            const std::uint32_t size = colours_.sort(t.sort).size;
            const std::uint32_t step = t.op == ColourTerm::kSuccessor ? 1 : size - 1;
            ColourBag inner;
            if (!evaluate(operands_[t.first], binding, inner, times, most)) {
                return false;
            }
            for (const auto& [value, count] : inner) {
                out.emplace_back((value + step) % size, count);
            }
            return true;
        }
        case ColourTerm::kTuple: {
            // The product of bags: counts multiply.
            ColourBag product = {{0, times}};
            for (std::uint32_t i = 0; i < t.count; ++i) {
                ColourBag part, next;
                if (!evaluate(operands_[t.first + i], binding, part, 1, most)) {
                    return false;
                }
                if (product.size() * part.size() > most) {
                    return false;
                }
                const std::uint32_t size = colours_.sort(operand(t, i).sort).size;
                for (const auto& [value, count] : product) {
                    for (const auto& [last, many] : part) {
                        const std::int64_t both = count * many;
                        if (both > kMostTokens || both < -kMostTokens) {
                            return false;
                        }
                        next.emplace_back(value * size + last, both);
                    }
                }
                product = std::move(next);
            }
            out.insert(out.end(), product.begin(), product.end());
            return out.size() <= most;
        }
        default:
            return true;
    }
}

bool ColourTerms::holds(std::uint32_t term, const std::vector<std::uint32_t>& binding) const {
    const ColourTerm& t = terms_[term];
    const auto part = [&](std::uint32_t i) { return holds(operands_[t.first + i], binding); };
    // Ranges are compared by their numbers: two of them may begin at different ones.
    const auto value = [&](std::uint32_t i) {
        return colours_.sort(operand(t, i).sort).low +
               std::int64_t{colour(operands_[t.first + i], binding)};
    };
    switch (t.op) {
        case ColourTerm::kTrue:
            return true;
        case ColourTerm::kNot:
            return !part(0);
        case ColourTerm::kAnd:
            for (std::uint32_t i = 0; i < t.count; ++i) {
                if (!part(i)) {
                    return false;
                }
            }
            return true;
        case ColourTerm::kOr:
            for (std::uint32_t i = 0; i < t.count; ++i) {
                if (part(i)) {
                    return true;
                }
            }
            return false;
        case ColourTerm::kImplies:
            return !part(0) || part(1);
        case ColourTerm::kEqual:
            return value(0) == value(1);
        case ColourTerm::kNotEqual:
            return value(0) != value(1);
        case ColourTerm::kLess:
            return value(0) < value(1);
        case ColourTerm::kLessEqual:
            return value(0) <= value(1);
        default:
            return false;
    }
}

void ColourTerms::variables_of(std::uint32_t term, std::vector<bool>& used) const {
    const ColourTerm& t = terms_[term];
    if (t.op == ColourTerm::kVariable) {
        used[t.index] = true;
    }
    for (std::uint32_t i = 0; i < t.count; ++i) {
        variables_of(operands_[t.first + i], used);
    }
}

void ColourTerms::conjuncts(std::uint32_t term, std::vector<std::uint32_t>& out) const {
    const ColourTerm& t = terms_[term];
    if (t.op != ColourTerm::kAnd) {
        out.push_back(term);
        return;
    }
    for (std::uint32_t i = 0; i < t.count; ++i) {
        conjuncts(operands_[t.first + i], out);
    }
}

}  // namespace puppetri::io
