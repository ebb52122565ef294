// SPDX-License-Identifier: MIT
// From XML to terms (vectors, operands first), from terms to the formulas of each kind. What a
// property is (reachability, CTL, LTL) is decided by its shape, not by the name of its file.
#include "puppetri/io/contest_queries.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "defects.h"
#include "puppetri/base/text.h"
#include "xml_text.h"

namespace puppetri::io {
namespace {

using net::Formula;
using net::FormulaOp;
using verdict::ContestQuery;
using verdict::QueryKind;

constexpr std::uint32_t kMostNesting = 1000;  // of elements of one formula

enum class TermOp : std::uint8_t {
    kTrue,
    kFalse,
    kCompare,   // expressions[index]
    kFireable,  // one of the transitions in list[first .. first + count)
    kDeadlock,
    kNot,
    kAnd,
    kOr,
    kXor,
    kImplies,
    kIff,
    kExists,
    kAll,
    kFinally,
    kGlobally,
    kNext,
    kUntil,
};

// What a term may be part of.
struct Shape {
    bool state = true;      // no temporal operator, no quantifier
    bool ctl = true;        // a state formula of CTL
    bool ctl_path = false;  // one temporal operator over state formulas of CTL
    bool linear = true;     // no quantifier
};

struct Term {
    TermOp op = TermOp::kTrue;
    std::uint32_t first = 0, count = 0;  // operands in `operands`, or transitions in `list`
    std::uint32_t index = 0;
    Shape shape;
};

struct Terms {
    std::vector<Term> terms;              // operands before operators
    std::vector<std::uint32_t> operands;  // indices of terms
    std::vector<std::uint32_t> list;      // of transitions
    std::vector<Expr> expressions;
};

struct Operator {
    std::string_view name;
    TermOp op;
    std::uint32_t least, most;  // operands
};
constexpr std::uint32_t kMany = ~std::uint32_t{0};
constexpr std::array<Operator, 15> kOperators = {{
    {"true", TermOp::kTrue, 0, 0},
    {"false", TermOp::kFalse, 0, 0},
    {"deadlock", TermOp::kDeadlock, 0, 0},
    {"negation", TermOp::kNot, 1, 1},
    {"conjunction", TermOp::kAnd, 1, kMany},
    {"disjunction", TermOp::kOr, 1, kMany},
    {"exclusive-disjunction", TermOp::kXor, 2, 2},
    {"implication", TermOp::kImplies, 2, 2},
    {"equivalence", TermOp::kIff, 2, 2},
    {"exists-path", TermOp::kExists, 1, 1},
    {"all-paths", TermOp::kAll, 1, 1},
    {"finally", TermOp::kFinally, 1, 1},
    {"globally", TermOp::kGlobally, 1, 1},
    {"next", TermOp::kNext, 1, 1},
    {"until", TermOp::kUntil, 2, 2},
}};
constexpr std::array<std::pair<std::string_view, ExprOp>, 6> kComparisons = {{
    {"integer-le", ExprOp::kLessEqual},
    {"integer-lt", ExprOp::kLess},
    {"integer-ge", ExprOp::kGreaterEqual},
    {"integer-gt", ExprOp::kGreater},
    {"integer-eq", ExprOp::kEqual},
    {"integer-ne", ExprOp::kNotEqual},
}};
constexpr std::array<std::pair<std::string_view, ExprOp>, 3> kArithmetic = {{
    {"integer-sum", ExprOp::kAdd},
    {"integer-difference", ExprOp::kSubtract},
    {"integer-product", ExprOp::kMultiply},
}};

bool is_temporal(TermOp op) {
    return op == TermOp::kFinally || op == TermOp::kGlobally || op == TermOp::kNext ||
           op == TermOp::kUntil;
}

class Reader {
 public:
    Reader(const XmlText& text, const NetFile& net, Defects& defects)
        : text_(text), net_(net), defects_(defects) {}

    void run(ContestQueries& out) {
        const pugi::xml_node root = text_.root();
        if (local_name(root) != "property-set") {
            defects_.error("not-a-query-file", text_.where(root), "",
                           "the file is XML, but not a query file",
                           "a query file begins with <property-set>");
            return;
        }
        for (const pugi::xml_node property : elements(root)) {
            if (local_name(property) != "property") {
                unknown(property, "");
                continue;
            }
            read_property(property, out);
        }
        rank(out);
    }

 private:
    void error(const char* code, pugi::xml_node at, std::string message, std::string remedy) {
        defects_.error(code, text_.where(at), element_, std::move(message), std::move(remedy));
    }

    void unknown(pugi::xml_node node, const char* remedy) {
        error("unknown-element", node, "<" + std::string(local_name(node)) + "> is not known here",
              *remedy != '\0' ? remedy : "take it out");
    }

    void read_property(pugi::xml_node property, ContestQueries& out) {
        ContestQuery query;
        query.where = text_.where(property);
        query.id = text_of(child(property, "id"));
        query.description = text_of(child(property, "description"));
        element_ = "property " + query.id;
        if (query.id.empty()) {
            error("missing-id", property, "the property has no id", "give it one");
        }
        pugi::xml_node formula;
        for (const pugi::xml_node c : elements(property)) {
            const std::string_view name = local_name(c);
            if (name == "formula" && !formula) {
                formula = c;
            } else if (name != "id" && name != "description" && name != "tags") {
                unknown(c, "a property has an id, a description and one formula");
            }
        }
        const std::vector<pugi::xml_node> inside =
            formula ? elements(formula) : std::vector<pugi::xml_node>();
        if (inside.size() != 1) {
            error("wrong-operands", formula ? formula : property,
                  "the property has no formula, or more than one", "write one formula");
            return;
        }
        terms_ = {};
        if (local_name(inside[0]) == "place-bound") {
            query.kind = QueryKind::kUpperBound;
            if (std::optional<Expr> sum = count_of(inside[0])) {
                query.bound = std::move(*sum);
                out.queries.push_back(std::move(query));
            }
            return;
        }
        const std::optional<std::uint32_t> term = read_term(inside[0], 0);
        if (term && make_query(inside[0], *term, query)) {
            out.queries.push_back(std::move(query));
        }
    }

    void no_text(pugi::xml_node node) {
        for (const pugi::xml_node c : node.children()) {
            if (c.type() != pugi::node_element && !trimmed(c.value()).empty()) {
                error("unknown-element", node,
                      "text stands inside <" + std::string(local_name(node)) + ">", "take it out");
                return;
            }
        }
        if (node.first_attribute()) {
            error("unknown-attribute", node,
                  std::string("the attribute ") + node.first_attribute().name() +
                      " is not known here",
                  "take it out");
        }
    }

    std::optional<std::uint32_t> read_term(pugi::xml_node node, std::uint32_t depth) {
        if (depth > kMostNesting) {
            error("nested-too-deep", node,
                  "the formula is nested deeper than " + std::to_string(kMostNesting) + " levels",
                  "conjunctions and disjunctions may have many operands");
            return std::nullopt;
        }
        const std::string_view name = local_name(node);
        no_text(node);
        if (name == "is-fireable") {
            return fireable(node);
        }
        for (const auto& [word, op] : kComparisons) {
            if (name == word) {
                return comparison(node, op, depth);
            }
        }
        for (const Operator& o : kOperators) {
            if (name == o.name) {
                return operation(node, o, depth);
            }
        }
        unknown(node, "expected a formula: a comparison, is-fireable, deadlock, or an operator");
        return std::nullopt;
    }

    std::uint32_t push(Term term) {
        terms_.terms.push_back(term);
        return static_cast<std::uint32_t>(terms_.terms.size()) - 1;
    }

    bool arity(pugi::xml_node node, std::size_t found, std::uint32_t least, std::uint32_t most) {
        if (found >= least && found <= most) {
            return true;
        }
        error("wrong-operands", node,
              "<" + std::string(local_name(node)) + "> has " + std::to_string(found) + " operands",
              least == most ? "it takes " + std::to_string(least)
                            : "it takes at least " + std::to_string(least));
        return false;
    }

    std::optional<std::uint32_t> operation(pugi::xml_node node, const Operator& o,
                                           std::uint32_t depth) {
        std::vector<pugi::xml_node> parts = elements(node);
        if (!arity(node, parts.size(), o.least, o.most)) {
            return std::nullopt;
        }
        if (o.op == TermOp::kUntil) {
            for (std::size_t i = 0; i < 2; ++i) {
                const char* wanted = i == 0 ? "before" : "reach";
                const std::vector<pugi::xml_node> inner = elements(parts[i]);
                if (local_name(parts[i]) != wanted || inner.size() != 1) {
                    error("wrong-operands", parts[i],
                          std::string("<until> wants <") + wanted + "> with one formula here",
                          "write <before> and then <reach>");
                    return std::nullopt;
                }
                no_text(parts[i]);
                parts[i] = inner[0];
            }
        }
        std::vector<std::uint32_t> operands;
        bool fine = true;
        for (const pugi::xml_node part : parts) {
            const std::optional<std::uint32_t> term = read_term(part, depth + 1);
            fine = fine && term.has_value();
            if (term) {
                operands.push_back(*term);
            }
        }
        if (!fine) {
            return std::nullopt;
        }
        Term term;
        term.op = o.op;
        term.first = static_cast<std::uint32_t>(terms_.operands.size());
        term.count = static_cast<std::uint32_t>(operands.size());
        term.shape = shape_of(o.op, operands);
        terms_.operands.insert(terms_.operands.end(), operands.begin(), operands.end());
        return push(term);
    }

    Shape shape_of(TermOp op, const std::vector<std::uint32_t>& operands) const {
        Shape all;
        for (const std::uint32_t o : operands) {
            const Shape& s = terms_.terms[o].shape;
            all.state = all.state && s.state;
            all.ctl = all.ctl && s.ctl;
            all.linear = all.linear && s.linear;
        }
        if (is_temporal(op)) {
            return {.state = false, .ctl = false, .ctl_path = all.ctl, .linear = all.linear};
        }
        if (op == TermOp::kExists || op == TermOp::kAll) {
            const Shape& s = terms_.terms[operands[0]].shape;
            return {.state = false, .ctl = s.ctl_path || s.ctl, .ctl_path = false, .linear = false};
        }
        return all;
    }

    std::optional<std::uint32_t> fireable(pugi::xml_node node) {
        Term term;
        term.op = TermOp::kFireable;
        term.first = static_cast<std::uint32_t>(terms_.list.size());
        const std::vector<pugi::xml_node> parts = elements(node);
        bool fine = arity(node, parts.size(), 1, kMany);
        for (const pugi::xml_node part : parts) {
            if (local_name(part) != "transition") {
                unknown(part, "<is-fireable> holds transitions");
                fine = false;
                continue;
            }
            const std::string id = text_of(part);
            const std::vector<net::TransitionIndex>* found = net_.ids.find_transitions(id);
            if (found == nullptr) {
                unknown_id(part, "transition", id, net_.draft.transitions);
                fine = false;
                continue;
            }
            for (const net::TransitionIndex t : *found) {
                terms_.list.push_back(t.value);
            }
        }
        term.count = static_cast<std::uint32_t>(terms_.list.size()) - term.first;
        return fine ? std::optional(push(term)) : std::nullopt;
    }

    template <class List>
    void unknown_id(pugi::xml_node node, const char* what, const std::string& id,
                    const List& known) {
        std::string near;
        if (known.size() <= 2000) {
            std::vector<std::string> names;
            for (const auto& element : known) {
                names.push_back(element.path);
            }
            near = std::string(nearest_name(id, names));
        }
        error("unknown-id", node, std::string("the net has no ") + what + " " + id,
              near.empty() ? "is it the query file of this net?" : "did you mean " + near + "?");
    }

    // The number of tokens in all places inside.
    std::optional<Expr> count_of(pugi::xml_node node) {
        const std::vector<pugi::xml_node> parts = elements(node);
        bool fine = arity(node, parts.size(), 1, kMany);
        no_text(node);
        std::optional<Expr> sum;
        for (const pugi::xml_node part : parts) {
            if (local_name(part) != "place") {
                unknown(part, "tokens are counted in places");
                fine = false;
                continue;
            }
            const std::string id = text_of(part);
            const std::vector<net::PlaceIndex>* found = net_.ids.find_places(id);
            if (found == nullptr) {
                unknown_id(part, "place", id, net_.draft.places);
                fine = false;
                continue;
            }
            for (const net::PlaceIndex p : *found) {
                Expr count =
                    Expr::slot(net::slot(net::SlotKind::kCount, p.value), {ValueKind::kInt, 0});
                sum = sum ? Expr::binary(ExprOp::kAdd, std::move(*sum), std::move(count)).value()
                          : std::move(count);
            }
        }
        if (!fine) {
            return std::nullopt;
        }
        return sum ? std::move(sum) : std::optional(Expr::integer(0));
    }

    std::optional<Expr> read_number(pugi::xml_node node, std::uint32_t depth) {
        if (depth > kMostNesting) {
            error("nested-too-deep", node, "the sum is nested too deep", "flatten it");
            return std::nullopt;
        }
        const std::string_view name = local_name(node);
        if (name == "tokens-count") {
            return count_of(node);
        }
        if (name == "integer-constant") {
            const ParsedInteger number = parse_integer(text_of(node));
            if (number.kind != ParsedInteger::kFine) {
                error(number.kind == ParsedInteger::kNoNumber ? "not-a-number" : "number-too-large",
                      node, "\"" + text_of(node).substr(0, 40) + "\" is no whole number of 64 bits",
                      "write a whole number");
                return std::nullopt;
            }
            return Expr::integer(number.value);
        }
        for (const auto& [word, op] : kArithmetic) {
            if (name != word) {
                continue;
            }
            no_text(node);
            const std::vector<pugi::xml_node> parts = elements(node);
            if (!arity(node, parts.size(), op == ExprOp::kSubtract ? 2 : 1, kMany)) {
                return std::nullopt;
            }
            std::optional<Expr> out;
            bool fine = true;
            for (const pugi::xml_node part : parts) {
                std::optional<Expr> operand = read_number(part, depth + 1);
                if (!operand) {
                    fine = false;
                } else if (!out) {
                    out = std::move(operand);
                } else {
                    out = Expr::binary(op, std::move(*out), std::move(*operand)).value();
                }
            }
            return fine ? std::move(out) : std::nullopt;
        }
        unknown(node, "expected tokens-count, integer-constant or arithmetic of these");
        return std::nullopt;
    }

    std::optional<std::uint32_t> comparison(pugi::xml_node node, ExprOp op, std::uint32_t depth) {
        const std::vector<pugi::xml_node> parts = elements(node);
        if (!arity(node, parts.size(), 2, 2)) {
            return std::nullopt;
        }
        std::optional<Expr> left = read_number(parts[0], depth + 1);
        std::optional<Expr> right = read_number(parts[1], depth + 1);
        if (!left || !right) {
            return std::nullopt;
        }
        Term term;
        if (left->is_literal() && right->is_literal()) {
            term.op = compare(op, left->literal_value(), right->literal_value()) ? TermOp::kTrue
                                                                                 : TermOp::kFalse;
            return push(term);
        }
        term.op = TermOp::kCompare;
        term.index = static_cast<std::uint32_t>(terms_.expressions.size());
        terms_.expressions.push_back(Expr::binary(op, std::move(*left), std::move(*right)).value());
        return push(term);
    }

    static bool compare(ExprOp op, std::int64_t a, std::int64_t b) {
        switch (op) {
            case ExprOp::kLessEqual:
                return a <= b;
            case ExprOp::kLess:
                return a < b;
            case ExprOp::kGreaterEqual:
                return a >= b;
            case ExprOp::kGreater:
                return a > b;
            case ExprOp::kEqual:
                return a == b;
            default:
                return a != b;
        }
    }

    // -------------------------------------------------------------------------------------------
    // From terms to formulas.

    const Term& operand(const Term& t, std::uint32_t i) const {
        return terms_.terms[terms_.operands[t.first + i]];
    }

    bool make_query(pugi::xml_node at, std::uint32_t root, ContestQuery& query) {
        const Term& t = terms_.terms[root];
        query.formula = {};
        if (t.shape.ctl) {
            const bool quantified = t.op == TermOp::kExists || t.op == TermOp::kAll;
            const bool reaches =
                quantified &&
                operand(t, 0).op ==
                    (t.op == TermOp::kExists ? TermOp::kFinally : TermOp::kGlobally) &&
                operand(operand(t, 0), 0).shape.state;
            query.kind = reaches ? QueryKind::kReachability : QueryKind::kCtl;
            emit(root, query.formula);
            return true;
        }
        // Negations before the quantifier of a linear formula go through it.
        bool negated = false;
        std::uint32_t at_term = root;
        while (terms_.terms[at_term].op == TermOp::kNot) {
            negated = !negated;
            at_term = terms_.operands[terms_.terms[at_term].first];
        }
        const Term& quantifier = terms_.terms[at_term];
        if ((quantifier.op == TermOp::kExists || quantifier.op == TermOp::kAll) &&
            operand(quantifier, 0).shape.linear) {
            query.kind = QueryKind::kLtl;
            query.exists = (quantifier.op == TermOp::kExists) != negated;
            emit(terms_.operands[quantifier.first], query.formula);
            if (negated) {
                query.formula.nodes.push_back(
                    {.op = FormulaOp::kNot, .a = last(query.formula), .b = 0});
            }
            return true;
        }
        error("not-ctl-not-ltl", at,
              "the formula is neither of CTL (each path quantifier with one temporal operator) nor "
              "of LTL (one path quantifier, outermost)",
              "split it into formulas that are");
        return false;
    }

    static std::uint32_t last(const Formula& f) {
        return static_cast<std::uint32_t>(f.nodes.size()) - 1;
    }

    static std::uint32_t node(Formula& f, FormulaOp op, std::uint32_t a, std::uint32_t b = 0) {
        f.nodes.push_back({.op = op, .a = a, .b = b});
        return last(f);
    }

    static std::uint32_t constant(Formula& f, bool value) {
        f.nodes.push_back({.op = FormulaOp::kConstant, .count = value ? 1 : 0});
        return last(f);
    }

    template <class Transitions>
    static std::uint32_t any_fireable(Formula& f, const Transitions& transitions) {
        std::optional<std::uint32_t> any;
        for (const std::uint32_t t : transitions) {
            f.nodes.push_back({.op = FormulaOp::kFireable, .index = t});
            any = any ? node(f, FormulaOp::kOr, *any, last(f)) : last(f);
        }
        return any ? *any : constant(f, false);
    }

    // Appends the terms up to `root` in their order; operands of a quantifier become part of it.
    // The terms of one property are one tree, and the root comes last.
    void emit(std::uint32_t root, Formula& f) {
        std::vector<std::uint32_t> made(root + 1, 0);
        std::optional<std::uint32_t> dead;
        for (std::uint32_t i = 0; i <= root; ++i) {
            made[i] = emit_one(terms_.terms[i], made, dead, f);
        }
        // Where the root is an earlier node's twin (a quantifier over a state formula), it comes
        // last all the same.
        if (made[root] != last(f)) {
            f.nodes.push_back(net::Formula::Node(f.nodes[made[root]]));
        }
    }

    std::uint32_t emit_one(const Term& t, const std::vector<std::uint32_t>& made,
                           std::optional<std::uint32_t>& dead, Formula& f) {
        const auto a = [&](std::uint32_t i) { return made[terms_.operands[t.first + i]]; };
        switch (t.op) {
            case TermOp::kTrue:
            case TermOp::kFalse:
                return constant(f, t.op == TermOp::kTrue);
            case TermOp::kCompare:
                f.nodes.push_back({.op = FormulaOp::kExpr,
                                   .index = static_cast<std::uint32_t>(f.expressions.size())});
                f.expressions.push_back(std::move(terms_.expressions[t.index]));
                return last(f);
            case TermOp::kFireable:
                return any_fireable(f, std::span(terms_.list).subspan(t.first, t.count));
            case TermOp::kDeadlock:
                if (!dead) {
                    std::vector<std::uint32_t> all(net_.draft.transitions.size());
                    for (std::uint32_t i = 0; i < all.size(); ++i) {
                        all[i] = i;
                    }
                    dead = node(f, FormulaOp::kNot, any_fireable(f, all));
                }
                return *dead;
            case TermOp::kNot:
                return node(f, FormulaOp::kNot, a(0));
            case TermOp::kAnd:
            case TermOp::kOr: {
                std::uint32_t all = a(0);
                for (std::uint32_t i = 1; i < t.count; ++i) {
                    all =
                        node(f, t.op == TermOp::kAnd ? FormulaOp::kAnd : FormulaOp::kOr, all, a(i));
                }
                return all;
            }
            case TermOp::kXor:
                return node(f, FormulaOp::kNot, node(f, FormulaOp::kIff, a(0), a(1)));
            case TermOp::kImplies:
                return node(f, FormulaOp::kImplies, a(0), a(1));
            case TermOp::kIff:
                return node(f, FormulaOp::kIff, a(0), a(1));
            case TermOp::kExists:
            case TermOp::kAll: {
                const Term& inner = operand(t, 0);
                if (is_temporal(inner.op)) {
                    // The linear node has just been made, or is an earlier one: made anew with its
                    // quantifier. The linear one stays without use only in CTL formulas, so it is
                    // turned into the quantified one where it stands.
                    net::Formula::Node& linear = f.nodes[a(0)];
                    linear.op = quantified(inner.op, t.op == TermOp::kExists);
                }
                return a(0);
            }
            case TermOp::kFinally:
                return node(f, FormulaOp::kFinally, a(0));
            case TermOp::kGlobally:
                return node(f, FormulaOp::kGlobally, a(0));
            case TermOp::kNext:
                return node(f, FormulaOp::kNext, a(0));
            case TermOp::kUntil:
                return node(f, FormulaOp::kUntil, a(0), a(1));
        }
        return constant(f, false);
    }

    static FormulaOp quantified(TermOp op, bool exists) {
        switch (op) {
            case TermOp::kFinally:
                return exists ? FormulaOp::kSomeFinally : FormulaOp::kAllFinally;
            case TermOp::kGlobally:
                return exists ? FormulaOp::kSomeGlobally : FormulaOp::kAllGlobally;
            case TermOp::kNext:
                return exists ? FormulaOp::kSomeNext : FormulaOp::kAllNext;
            default:
                return exists ? FormulaOp::kSomeUntil : FormulaOp::kAllUntil;
        }
    }

    void rank(ContestQueries& out) {
        std::vector<std::uint32_t> order(out.queries.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            const int c = out.queries[a].id.compare(out.queries[b].id);
            return c != 0 ? c < 0 : a < b;
        });
        out.rank.resize(order.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            out.rank[order[i]] = i;
            if (i > 0 && out.queries[order[i]].id == out.queries[order[i - 1]].id) {
                defects_.error("duplicate-id", out.queries[order[i]].where,
                               "property " + out.queries[order[i]].id,
                               "another property has the same id", "give one of them another id");
            }
        }
    }

    const XmlText& text_;
    const NetFile& net_;
    Defects& defects_;
    std::string element_;
    Terms terms_;
};

}  // namespace

Checked<ContestQueries> read_contest_queries(std::string_view text, const std::string& path,
                                             const NetFile& net, const NetLimits& limits) {
    Defects defects;
    XmlText xml;
    ContestQueries out;
    if (xml.parse(text, path, limits.bytes, defects)) {
        Reader(xml, net, defects).run(out);
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    return out;
}

}  // namespace puppetri::io
