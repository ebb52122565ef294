// SPDX-License-Identifier: MIT
// Names, numbers, units and expressions: precedence climbing over the flat list of operands and
// operators that the grammar hands over.
#include <algorithm>
#include <array>

#include "build.h"
#include "puppetri/lang/decimal.h"
#include "puppetri/lang/parse.h"
#include "puppetri/lang/units.h"

namespace puppetri::lang {

namespace {

constexpr std::uint32_t kMaxTreeDepth = 256;

struct Operator {
    Kind kind;
    Op op;
    int precedence;
    bool right = false;  // associates to the right
};
constexpr int kNotPrecedence = 5, kComparison = 6, kRangePrecedence = 7, kSignPrecedence = 10;
constexpr std::array kOperators = {
    Operator{Kind::kImplies, Op::kImplies, 1, true},
    Operator{Kind::kOr, Op::kOr, 2},
    Operator{Kind::kUntil, Op::kUntil, 3, true},
    Operator{Kind::kWeak, Op::kWeakUntil, 3, true},
    Operator{Kind::kRelease, Op::kRelease, 3, true},
    Operator{Kind::kAnd, Op::kAnd, 4},
    Operator{Kind::kEqual, Op::kEqual, kComparison},
    Operator{Kind::kNotEqual, Op::kNotEqual, kComparison},
    Operator{Kind::kLess, Op::kLess, kComparison},
    Operator{Kind::kLessEqual, Op::kLessEqual, kComparison},
    Operator{Kind::kGreater, Op::kGreater, kComparison},
    Operator{Kind::kGreaterEqual, Op::kGreaterEqual, kComparison},
    Operator{Kind::kDots, Op::kNone, kRangePrecedence},
    Operator{Kind::kPlus, Op::kAdd, 8},
    Operator{Kind::kMinus, Op::kSubtract, 8},
    Operator{Kind::kTimes, Op::kMultiply, 9},
    Operator{Kind::kOver, Op::kDivide, 9},
    Operator{Kind::kDiv, Op::kDiv, 9},
    Operator{Kind::kMod, Op::kMod, 9},
    Operator{Kind::kCaret, Op::kPower, 11, true},
};

const Operator& operator_of(Kind kind) {
    const auto found = std::find_if(kOperators.begin(), kOperators.end(),
                                    [kind](const Operator& o) { return o.kind == kind; });
    PUP_REQUIRE(found != kOperators.end());
    return *found;
}

bool is_sign(Kind kind) { return kind == Kind::kMinus || kind == Kind::kPlus; }
// a + b + c is one sum of three.
bool merges(Op op) {
    return op == Op::kAdd || op == Op::kMultiply || op == Op::kAnd || op == Op::kOr;
}

// The number of `5` and `-5`, to give a range one unit.
Expr* plain_number(Expr& e) {
    if (e.kind == ExprKind::kUnary && e.op != Op::kNot) {
        return plain_number(e.args[0].value);
    }
    return e.kind == ExprKind::kNumber ? &e : nullptr;
}

}  // namespace

Span Builder::span(std::uint32_t node) const {
    const Node& n = nodes_[node];
    if (n.begin == n.end) {
        return {tokens_[n.begin].begin, tokens_[n.begin].begin, report_.number()};
    }
    return {tokens_[n.begin].begin, tokens_[n.end - 1].end, report_.number()};
}

bool Builder::has_token(std::uint32_t node, Kind wanted) const {
    std::uint32_t at = nodes_[node].begin;
    const auto found_before = [&](std::uint32_t stop) {
        for (; at < stop; ++at) {
            if (tokens_[at].kind == wanted) {
                return true;
            }
        }
        return false;
    };
    for (const std::uint32_t c : children(node)) {
        if (found_before(nodes_[c].begin)) {
            return true;
        }
        at = nodes_[c].end;
    }
    return found_before(nodes_[node].end);
}

std::uint32_t Builder::child(std::uint32_t node, NodeKind wanted) const {
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == wanted) {
            return c;
        }
    }
    return 0;
}

std::string_view Builder::text(const Token& token) const {
    return report_.text().substr(token.begin, token.end - token.begin);
}

std::string Builder::quoted(const Token& token) {
    std::string_view inside = text(token);
    if (inside.size() < 2 || inside.back() != inside.front()) {
        return {};  // without an end, which the lexer has reported
    }
    inside.remove_prefix(1);
    inside.remove_suffix(1);
    std::string out;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (inside[i] != '\\' || token.kind == Kind::kQuotedName || i + 1 == inside.size()) {
            out += inside[i];
            continue;
        }
        ++i;
        switch (inside[i]) {
            case 'n':
                out += '\n';
                break;
            case 't':
                out += '\t';
                break;
            case '"':
            case '\\':
                out += inside[i];
                break;
            default:
                report_.error(token.begin + static_cast<std::uint32_t>(i),
                              token.begin + static_cast<std::uint32_t>(i) + 2, "unknown-escape",
                              element, "this backslash means nothing",
                              "write \\\\ for a backslash, \\\" for a quotation mark");
        }
    }
    return out;
}

Caption Builder::caption(std::uint32_t parent) {
    const std::uint32_t node = child(parent, NodeKind::kCaption);
    if (node == 0) {
        return {};
    }
    return {quoted(first(node)), span(node)};
}

Name Builder::name(std::uint32_t node) {
    Name out;
    if (node == 0) {
        return out;
    }
    const Token& token = first(node);
    out.text = token.kind == Kind::kQuotedName ? quoted(token) : std::string(text(token));
    for (const std::uint32_t c : children(node)) {
        out.index.push_back(expr(c));
    }
    out.span = span(node);
    return out;
}

Path Builder::path(std::uint32_t node) {
    Path out;
    if (node == 0) {
        return out;
    }
    for (const std::uint32_t c : children(node)) {
        out.steps.push_back(name(c));
    }
    out.span = span(node);
    return out;
}

void Builder::number(std::uint32_t node, Expr& out) {
    const Token& token = first(node);
    const std::optional<Rational> value = parse_decimal(text(token));
    if (!value) {
        report_.error(span(token), "number-out-of-range", element,
                      "this number has too many digits to be kept exactly",
                      "use at most 18 digits");
        return;
    }
    out.number = *value;
}

void Builder::unit(std::uint32_t parent, Expr& out) {
    const std::uint32_t node = child(parent, NodeKind::kUnit);
    if (node == 0) {
        return;
    }
    out.unit_span = span(node);
    for (std::uint32_t i = nodes_[node].begin; i < nodes_[node].end; ++i) {
        out.unit += text(tokens_[i]);
    }
    if (!find_unit(out.unit)) {
        report_.error(out.unit_span, "unknown-unit", element, "'" + out.unit + "' is no unit",
                      "powers of units are whole numbers from -9 to 9");
        out.unit.clear();
    }
}

std::vector<Argument> Builder::arguments(std::uint32_t node, std::uint32_t& depth) {
    std::vector<Argument> out;
    for (const std::uint32_t c : children(node)) {
        Argument argument;
        if (const std::uint32_t label = child(c, NodeKind::kLabel); label != 0) {
            argument.name = name(label + 1);
        }
        Deep value = deep_expr(child(c, NodeKind::kExpr));
        depth = std::max(depth, value.depth + 1);
        argument.value = std::move(value.expr);
        out.push_back(std::move(argument));
    }
    return out;
}

Builder::Deep Builder::several(std::uint32_t node, ExprKind kind_of_list) {
    Deep out;
    std::vector<Argument> values;
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == NodeKind::kExpr) {
            Deep value = deep_expr(c);
            out.depth = std::max(out.depth, value.depth + 1);
            values.push_back({{}, std::move(value.expr)});
        }
    }
    const bool grouping = kind_of_list == ExprKind::kTuple && values.size() == 1;
    if (grouping && child(node, NodeKind::kUnit) == 0) {
        out.expr = std::move(values[0].value);
        out.expr.span = span(node);
        return out;
    }
    if (grouping) {
        report_.error(span(child(node, NodeKind::kUnit)), "misplaced-unit", element,
                      "a unit stands after a number or after a list of numbers",
                      "give the unit to the number inside the parentheses");
    }
    out.expr.kind = kind_of_list;
    out.expr.args = std::move(values);
    unit(node, out.expr);
    return out;
}

Builder::Deep Builder::operand(std::uint32_t node) {
    Deep out;
    Expr& e = out.expr;
    switch (kind(node)) {
        case NodeKind::kNumber:
            e.kind = ExprKind::kNumber;
            number(node, e);
            unit(node, e);
            break;
        case NodeKind::kString:
            e.kind = ExprKind::kString;
            e.text = quoted(first(node));
            break;
        case NodeKind::kCount:
            e.kind = nodes_[node + 1].begin == nodes_[node].begin + 2 ? ExprKind::kCountReady
                                                                      : ExprKind::kCount;
            e.path = child_path(node);
            break;
        case NodeKind::kParen:
            out = several(node, ExprKind::kTuple);
            break;
        case NodeKind::kList:
            out = several(node, ExprKind::kList);
            break;
        case NodeKind::kSymbol:
            e.kind = ExprKind::kSymbol;
            e.text = std::string(text(first(node)));
            break;
        default: {
            e.path = path(node);
            e.kind = ExprKind::kPath;
            const std::uint32_t next = nodes_[node].next;
            if (next < nodes_.size() && kind(next) == NodeKind::kArguments) {
                e.kind = ExprKind::kCall;
                e.args = arguments(next, out.depth);
                e.span = {e.path.span.begin, span(next).end, report_.number()};
                return out;
            }
            const Kind word = first(node).kind;
            if (e.path.steps.size() == 1 && e.path.steps[0].index.empty() &&
                (word == Kind::kYes || word == Kind::kTrue || word == Kind::kNo ||
                 word == Kind::kFalse)) {
                e.kind = ExprKind::kBool;
                e.number = Rational{word == Kind::kYes || word == Kind::kTrue ? 1 : 0};
                e.path = {};
            }
        }
    }
    e.span = span(node);
    return out;
}

// Walks the flat children of a kExpr.
class Builder::Climber {
 public:
    Climber(Builder& builder, std::uint32_t node) : b_(builder) {
        for (const std::uint32_t c : b_.children(node)) {
            if (b_.kind(c) == NodeKind::kExpr) {
                branches_.push_back(c);
            } else if (b_.kind(c) != NodeKind::kArguments) {
                items_.push_back(c);
            }
        }
        whole_ = b_.span(node);
    }

    Deep run() {
        Deep out = climb(0, 0);
        if (!branches_.empty()) {
            Deep conditional;
            conditional.expr.kind = ExprKind::kConditional;
            std::array<Deep, 3> parts = {std::move(out), b_.deep_expr(branches_[0]),
                                         b_.deep_expr(branches_[1])};
            for (Deep& part : parts) {
                conditional.depth = std::max(conditional.depth, part.depth + 1);
                conditional.expr.args.push_back({{}, std::move(part.expr)});
            }
            conditional.expr.span = whole_;
            out = std::move(conditional);
        }
        if (out.depth > kMaxTreeDepth) {
            deep();
        }
        if (too_deep_) {
            out = {};
            out.expr.kind = ExprKind::kNumber;
            out.expr.span = whole_;
        }
        return out;
    }

 private:
    void deep() {
        if (!too_deep_) {
            b_.report_.error(whole_, "too-deep", b_.element, "this expression is nested too deeply",
                             "name parts of it as states, and use the names");
        }
        too_deep_ = true;
    }
    bool at_operator() const {
        return at_ < items_.size() && b_.kind(items_[at_]) == NodeKind::kOp;
    }
    Kind operator_kind() const { return b_.first(items_[at_]).kind; }

    static void join(Deep& parent, Deep child) {
        parent.depth = std::max(parent.depth, child.depth + 1);
        parent.expr.args.push_back({{}, std::move(child.expr)});
    }

    Deep prefix(std::uint32_t nesting) {
        if (!at_operator()) {
            return b_.operand(items_[at_++]);
        }
        const std::uint32_t sign = items_[at_++];
        const Kind which = b_.first(sign).kind;
        Deep out;
        out.expr.kind = ExprKind::kUnary;
        out.expr.op =
            which == Kind::kNot ? Op::kNot : (which == Kind::kMinus ? Op::kNegate : Op::kPlus);
        join(out, climb(is_sign(which) ? kSignPrecedence : kNotPrecedence, nesting + 1));
        out.expr.span = {b_.span(sign).begin, out.expr.args[0].value.span.end, b_.report_.number()};
        return out;
    }

    Deep climb(int lowest, std::uint32_t nesting) {
        if (nesting > kMaxNesting || too_deep_) {
            deep();
            at_ = items_.size();
            return {};
        }
        Deep left = prefix(nesting);
        while (at_operator() && !too_deep_) {
            const Operator& o = operator_of(operator_kind());
            if (o.precedence < lowest) {
                break;
            }
            ++at_;
            Deep right = climb(o.right ? o.precedence : o.precedence + 1, nesting + 1);
            left = combine(o, std::move(left), std::move(right));
        }
        return left;
    }

    Deep combine(const Operator& o, Deep left, Deep right) {
        const Span both = {left.expr.span.begin, right.expr.span.end, b_.report_.number()};
        const bool parenthesised = left.expr.span.begin != first_operand_begin(left.expr);
        if (merges(o.op) && left.expr.kind == ExprKind::kBinary && left.expr.op == o.op &&
            !parenthesised) {
            join(left, std::move(right));
            left.expr.span = both;
            return left;
        }
        Deep out;
        out.expr.op = o.op;
        out.expr.kind = o.kind == Kind::kDots ? ExprKind::kRange : ExprKind::kBinary;
        out.expr.span = both;
        const bool same = !parenthesised &&
                          (o.precedence == kComparison || o.precedence == kRangePrecedence) &&
                          left.expr.kind == out.expr.kind && precedence(left.expr) == o.precedence;
        if (same) {
            b_.report_.error(both, "chained-comparison", b_.element,
                             "comparisons and ranges cannot be chained", "write a < b and b < c");
        }
        join(out, std::move(left));
        join(out, std::move(right));
        if (out.expr.kind == ExprKind::kRange) {
            share_unit(out.expr);
        }
        if (out.depth > kMaxTreeDepth) {
            deep();
        }
        return out;
    }

    static int precedence(const Expr& e) {
        if (e.kind == ExprKind::kRange) {
            return kRangePrecedence;
        }
        for (const Operator& o : kOperators) {
            if (e.kind == ExprKind::kBinary && o.op == e.op) {
                return o.precedence;
            }
        }
        return 0;
    }
    // Differs from the span's begin where there are parentheses around.
    static std::uint32_t first_operand_begin(const Expr& e) {
        return e.kind == ExprKind::kBinary || e.kind == ExprKind::kRange
                   ? e.args[0].value.span.begin
                   : e.span.begin;
    }
    static void share_unit(Expr& range) {
        Expr* low = plain_number(range.args[0].value);
        Expr* high = plain_number(range.args[1].value);
        if (low != nullptr && high != nullptr && low->unit.empty()) {
            low->unit = high->unit;
            low->unit_span = high->unit_span;
        }
    }

    Builder& b_;
    std::vector<std::uint32_t> items_, branches_;
    std::size_t at_ = 0;
    Span whole_;
    bool too_deep_ = false;
};

Builder::Deep Builder::deep_expr(std::uint32_t node) { return Climber(*this, node).run(); }

Expr Builder::expr(std::uint32_t node) {
    if (node == 0) {
        return {};
    }
    return deep_expr(node).expr;
}

}  // namespace puppetri::lang
