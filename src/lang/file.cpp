// SPDX-License-Identifier: MIT
// Positions in a file for people, and expressions as text.
#include <algorithm>

#include "puppetri/base/text.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::lang {

namespace {

std::string_view line_of(const File& file, std::uint32_t line) {
    if (line == 0 || line > file.line_starts.size()) {
        return {};
    }
    const std::size_t begin = file.line_starts[line - 1];
    std::size_t end = line < file.line_starts.size() ? file.line_starts[line] : file.text.size();
    while (end > begin && (file.text[end - 1] == '\n' || file.text[end - 1] == '\r')) {
        --end;
    }
    return std::string_view(file.text).substr(begin, end - begin);
}

}  // namespace

SourceSpan File::where(Span span) const {
    SourceSpan out;
    out.file = filename;
    if (line_starts.empty()) {
        return out;
    }
    const std::uint32_t begin = std::min(span.begin, static_cast<std::uint32_t>(text.size()));
    const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), begin);
    out.line = static_cast<std::uint32_t>(after - line_starts.begin());
    const std::uint32_t start = line_starts[out.line - 1];
    const std::uint32_t end = std::max(
        begin, std::min<std::uint32_t>(
                   span.end, start + static_cast<std::uint32_t>(line_of(*this, out.line).size())));
    const std::string_view all = text;
    out.column = 1 + count_code_points(all.substr(start, begin - start));
    out.length = std::max<std::uint32_t>(1, count_code_points(all.substr(begin, end - begin)));
    return out;
}

std::string File::line_text(std::uint32_t line) const {
    std::string out(line_of(*this, line));
    std::size_t from = 0;
    while (const std::optional<std::size_t> bad =
               find_invalid_utf8(std::string_view(out).substr(from))) {
        out[from + *bad] = '?';
        from += *bad + 1;
    }
    return out;
}

namespace {

bool plain_name(std::string_view name) {
    const auto letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
               static_cast<unsigned char>(c) >= 0x80;
    };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    return !name.empty() && letter(name[0]) &&
           std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || digit(c); });
}

// As a decimal where that is exact, which it is for all numbers that were written as one.
std::string to_text(Rational number) {
    std::int64_t denominator = number.denominator;
    unsigned twos = 0, fives = 0;
    for (; denominator % 2 == 0; denominator /= 2) {
        ++twos;
    }
    for (; denominator % 5 == 0; denominator /= 5) {
        ++fives;
    }
    const unsigned decimals = std::max(twos, fives);
    if (denominator == 1 && decimals <= 18) {
        const std::optional<Rational> scale = power(Rational{10}, static_cast<int>(decimals));
        const std::optional<Rational> whole = scale ? multiply(number, *scale) : std::nullopt;
        if (whole) {
            return decimal_to_text(whole->numerator, decimals);
        }
    }
    return std::to_string(number.numerator) + "/" + std::to_string(number.denominator);
}

std::string_view symbol(Op op) {
    switch (op) {
        case Op::kNone:
            return "";
        case Op::kNegate:
            return "-";
        case Op::kPlus:
            return "+";
        case Op::kNot:
            return "not ";
        case Op::kAdd:
            return " + ";
        case Op::kSubtract:
            return " - ";
        case Op::kMultiply:
            return "*";
        case Op::kDivide:
            return "/";
        case Op::kDiv:
            return " div ";
        case Op::kMod:
            return " mod ";
        case Op::kPower:
            return "^";
        case Op::kEqual:
            return " = ";
        case Op::kNotEqual:
            return " != ";
        case Op::kLess:
            return " < ";
        case Op::kLessEqual:
            return " <= ";
        case Op::kGreater:
            return " > ";
        case Op::kGreaterEqual:
            return " >= ";
        case Op::kAnd:
            return " and ";
        case Op::kOr:
            return " or ";
        case Op::kImplies:
            return " implies ";
        case Op::kUntil:
            return " until ";
        case Op::kWeakUntil:
            return " weak until ";
        case Op::kRelease:
            return " release ";
    }
    return "";
}

// How tightly an expression holds together, as the grammar has it.
int precedence(const Expr& e) {
    switch (e.kind) {
        case ExprKind::kConditional:
            return 0;
        case ExprKind::kRange:
            return 7;
        case ExprKind::kUnary:
            return e.op == Op::kNot ? 5 : 10;
        case ExprKind::kBinary:
            break;
        default:
            return 12;
    }
    switch (e.op) {
        case Op::kImplies:
            return 1;
        case Op::kOr:
            return 2;
        case Op::kUntil:
        case Op::kWeakUntil:
        case Op::kRelease:
            return 3;
        case Op::kAnd:
            return 4;
        case Op::kAdd:
        case Op::kSubtract:
            return 8;
        case Op::kMultiply:
        case Op::kDivide:
        case Op::kDiv:
        case Op::kMod:
            return 9;
        case Op::kPower:
            return 11;
        default:
            return 6;
    }
}
// A part of an expression, in parentheses unless it binds more tightly than what is around it.
std::string part(const Expr& e, int around) {
    return precedence(e) > around ? to_text(e) : "(" + to_text(e) + ")";
}
// Whether (a o b) o c needs no parentheses, or a o (b o c) needs none. Sums of many are one node:
// (a + b) + c is not a + b + c.
bool left_associative(Op op) {
    return op == Op::kSubtract || op == Op::kDivide || op == Op::kDiv || op == Op::kMod;
}
bool right_associative(Op op) {
    return op == Op::kImplies || op == Op::kUntil || op == Op::kWeakUntil || op == Op::kRelease ||
           op == Op::kPower;
}

std::string joined(const std::vector<Argument>& args, std::string_view between) {
    std::string out;
    for (std::size_t i = 0; i < args.size(); ++i) {
        out += i > 0 ? between : "";
        if (!args[i].name.text.empty()) {
            out += args[i].name.text + ": ";
        }
        out += to_text(args[i].value);
    }
    return out;
}

}  // namespace

std::string to_text(const Path& path) {
    std::string out;
    for (const Name& step : path.steps) {
        out += out.empty() ? "" : ".";
        out += plain_name(step.text) ? step.text : "'" + step.text + "'";
        for (const Expr& index : step.index) {
            out += "[" + to_text(index) + "]";
        }
    }
    return out;
}

std::string to_text(const Expr& e) {
    std::string out;
    switch (e.kind) {
        case ExprKind::kNone:
            return "";
        case ExprKind::kNumber:
            out = to_text(e.number);
            break;
        case ExprKind::kBool:
            return e.number == Rational{1} ? "yes" : "no";
        case ExprKind::kString:
            return "\"" + e.text + "\"";
        case ExprKind::kSymbol:
            return e.text;
        case ExprKind::kPath:
            return to_text(e.path);
        case ExprKind::kCount:
            return "#" + to_text(e.path);
        case ExprKind::kCountReady:
            return "#ready " + to_text(e.path);
        case ExprKind::kCall:
            return to_text(e.path) + "(" + joined(e.args, ", ") + ")";
        case ExprKind::kList:
            out = "[" + joined(e.args, ", ") + "]";
            break;
        case ExprKind::kTuple:
            out = "(" + joined(e.args, ", ") + ")";
            break;
        case ExprKind::kUnary:
            return std::string(symbol(e.op)) + part(e.args[0].value, precedence(e) - 1);
        case ExprKind::kConditional:
            return part(e.args[0].value, 0) + " ? " + part(e.args[1].value, -1) + " : " +
                   part(e.args[2].value, -1);
        case ExprKind::kRange:
            return part(e.args[0].value, 7) + " .. " + part(e.args[1].value, 7);
        case ExprKind::kBinary:
            for (std::size_t i = 0; i < e.args.size(); ++i) {
                const bool free =
                    (i == 0 && left_associative(e.op)) || (i == 1 && right_associative(e.op));
                out += i > 0 ? symbol(e.op) : "";
                out += part(e.args[i].value, precedence(e) - (free ? 1 : 0));
            }
            return out;
    }
    return e.unit.empty() ? out : out + " " + e.unit;
}

}  // namespace puppetri::lang
