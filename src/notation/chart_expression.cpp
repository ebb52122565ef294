// SPDX-License-Identifier: MIT
// Expressions of SCXML's ECMAScript data model, as far as they are of whole numbers and truth
// values: translated to expressions of the language, operator by operator with ECMAScript's
// meaning.
#include "chart.h"
#include "make.h"

namespace puppetri::notation::chart {
namespace {

using lang::Expr;
using lang::Op;

struct Typed {
    Expr e;
    bool is_bool = false;
};

}  // namespace

class Parser {
 public:
    Parser(Chart& chart, std::string_view text, lang::Span where)
        : chart_(chart), text_(text), where_(where) {}

    Translated run() {
        Typed t = conditional();
        space();
        if (problem_.empty() && at_ < text_.size()) {
            fail("`" + std::string(text_.substr(at_, 12)) + "` is outside of what is read here");
        }
        return {std::move(t.e), t.is_bool, problem_};
    }

 private:
    static constexpr int kDepth = 60;

    void fail(std::string why) {
        if (problem_.empty()) {
            problem_ = std::move(why);
        }
    }
    void space() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' ||
                                      text_[at_] == '\n' || text_[at_] == '\r')) {
            ++at_;
        }
    }
    bool take(std::string_view what) {
        space();
        if (text_.substr(at_, what.size()) != what) {
            return false;
        }
        at_ += what.size();
        return true;
    }
    static bool letter(char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '$';
    }

    Expr number(std::int64_t n) { return make_number(Rational{n}, where_); }
    Expr boolean(Typed t) {
        return t.is_bool ? std::move(t.e) : make_binary(Op::kNotEqual, std::move(t.e), number(0));
    }
    // A truth value as a number.
    Expr numeric(Typed t) {
        if (!t.is_bool) {
            return std::move(t.e);
        }
        return choose(std::move(t.e), number(1), number(0));
    }
    Expr choose(Expr c, Expr a, Expr b) {
        Expr e = make_unary(Op::kNone, std::move(c));
        e.kind = lang::ExprKind::kConditional;
        e.args.push_back({{}, std::move(a)});
        e.args.push_back({{}, std::move(b)});
        return e;
    }

    Typed conditional() {
        if (++depth_ > kDepth) {
            fail("it nests too deep");
            at_ = text_.size();
        }
        Typed c = disjunction();
        if (problem_.empty() && take("?")) {
            Typed a = conditional();
            if (!take(":")) {
                fail("`:` is wanted behind `?`");
            }
            Typed b = conditional();
            const bool is_bool = a.is_bool && b.is_bool;
            if (a.is_bool != b.is_bool) {
                fail("one branch is a truth value, the other a number");
            }
            c = {choose(boolean(std::move(c)), std::move(a.e), std::move(b.e)), is_bool};
        }
        --depth_;
        return c;
    }
    Typed disjunction() {
        Typed a = conjunction();
        while (problem_.empty() && take("||")) {
            Typed b = conjunction();
            a = {make_binary(Op::kOr, boolean(std::move(a)), boolean(std::move(b))), true};
        }
        return a;
    }
    Typed conjunction() {
        Typed a = equality();
        while (problem_.empty() && take("&&")) {
            Typed b = equality();
            a = {make_binary(Op::kAnd, boolean(std::move(a)), boolean(std::move(b))), true};
        }
        return a;
    }
    Typed equality() {
        if (Typed t; event_name(t)) {
            return t;
        }
        Typed a = relation();
        for (;;) {
            Op op = Op::kEqual;
            if (take("===") || take("==")) {
            } else if (take("!==") || take("!=")) {
                op = Op::kNotEqual;
            } else {
                return a;
            }
            Typed b = relation();
            if (a.is_bool != b.is_bool) {
                fail("a truth value is compared with a number");
            }
            a = {make_binary(op, std::move(a.e), std::move(b.e)), true};
            if (!problem_.empty()) {
                return a;
            }
        }
    }
    // _event.name == 'x', _event.name != 'x'
    bool event_name(Typed& out) {
        const std::size_t before = at_;
        if (!take("_event.name")) {
            return false;
        }
        const bool equal = take("===") || take("==");
        const bool not_equal = !equal && (take("!==") || take("!="));
        std::string name;
        if ((!equal && !not_equal) || !text(name)) {
            at_ = before;
            fail("_event.name can be compared with a name: _event.name == 'door.open'");
            return true;
        }
        chart_.reads_event = true;
        out = {make_binary(equal ? Op::kEqual : Op::kNotEqual, make_reference(kLastEvent, where_),
                           number(chart_.number_of(name))),
               true};
        return true;
    }
    Typed relation() {
        Typed a = sum();
        static constexpr std::pair<std::string_view, Op> kOps[] = {{"<=", Op::kLessEqual},
                                                                   {">=", Op::kGreaterEqual},
                                                                   {"<", Op::kLess},
                                                                   {">", Op::kGreater}};
        for (const auto& [sign, op] : kOps) {
            if (problem_.empty() && take(sign)) {
                Typed b = sum();
                return {make_binary(op, numeric(std::move(a)), numeric(std::move(b))), true};
            }
        }
        return a;
    }
    Typed sum() {
        Typed a = product();
        for (;;) {
            const bool plus = problem_.empty() && take("+");
            if (!plus && !(problem_.empty() && take("-"))) {
                return a;
            }
            if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) {
                fail("++ and -- change data: use <assign>");
            }
            Typed b = product();
            a = {make_binary(plus ? Op::kAdd : Op::kSubtract, numeric(std::move(a)),
                             numeric(std::move(b))),
                 false};
        }
    }
    Typed product() {
        Typed a = prefix();
        for (;;) {
            if (problem_.empty() && take("*")) {
                Typed b = prefix();
                a = {make_binary(Op::kMultiply, numeric(std::move(a)), numeric(std::move(b))),
                     false};
            } else if (problem_.empty() && take("%")) {
                // The sign is that of the dividend.
                const Expr x = numeric(std::move(a)), y = numeric(prefix());
                const Expr size = make_call(make_path("abs", where_), {y}, where_);
                a = {choose(make_binary(Op::kGreaterEqual, x, number(0)),
                            make_binary(Op::kMod, x, size),
                            make_unary(Op::kNegate,
                                       make_binary(Op::kMod, make_unary(Op::kNegate, x), size))),
                     false};
            } else if (problem_.empty() && take("/")) {
                fail("division makes fractions, and data are whole numbers here");
                return a;
            } else {
                return a;
            }
        }
    }
    Typed prefix() {
        if (++depth_ > kDepth) {
            fail("it nests too deep");
            at_ = text_.size();
        }
        Typed out;
        space();
        if (text_.substr(at_, 2) != "!=" && take("!")) {
            out = {make_unary(Op::kNot, boolean(prefix())), true};
        } else if (text_.substr(at_, 2) == "++" || text_.substr(at_, 2) == "--") {
            fail("++ and -- change data: use <assign>");
        } else if (take("-")) {
            out = {make_unary(Op::kNegate, numeric(prefix())), false};
        } else if (take("+")) {
            out = {numeric(prefix()), false};
        } else {
            out = operand();
        }
        --depth_;
        return out;
    }
    bool text(std::string& out) {
        space();
        if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) {
            return false;
        }
        const char quote = text_[at_];
        const std::size_t end = text_.find(quote, at_ + 1);
        if (end == text_.npos) {
            return false;
        }
        out = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        return true;
    }
    Typed operand() {
        if (take("(")) {
            Typed t = conditional();
            if (!take(")")) {
                fail("a bracket is not closed");
            }
            return t;
        }
        space();
        const std::size_t begin = at_;
        while (at_ < text_.size() && letter(text_[at_])) {
            ++at_;
        }
        const std::string word(text_.substr(begin, at_ - begin));
        if (word.empty()) {
            fail(begin < text_.size()
                     ? "`" + std::string(text_.substr(begin, 12)) +
                           "` is outside of what is read here: whole numbers, true, false, data, "
                           "In('STATE')"
                     : "something is missing at its end");
            return {number(0), false};
        }
        if (word[0] >= '0' && word[0] <= '9') {
            std::int64_t value = 0;
            for (const char c : word) {
                if (c < '0' || c > '9' || value > 1'000'000'000'000'000) {
                    fail("only whole numbers are read here, not " + word);
                    break;
                }
                value = value * 10 + (c - '0');
            }
            if (at_ < text_.size() && text_[at_] == '.') {
                fail("only whole numbers are read here");
            }
            return {number(value), false};
        }
        if (word == "true" || word == "false") {
            return {make_bool(word == "true", where_), true};
        }
        if (word == "In") {
            std::string id;
            if (!take("(") || !text(id) || !take(")")) {
                fail("write In('STATE')");
                return {make_bool(false, where_), true};
            }
            for (const State& s : chart_.states) {
                if (!s.id.empty() && s.id == id && s.kind != Kind::kHistory) {
                    return {make_reference(inside_name(s), where_), true};
                }
            }
            fail("there is no state " + id);
            return {make_bool(false, where_), true};
        }
        for (const Datum& d : chart_.data) {
            if (d.id == word) {
                if (at_ < text_.size() && (text_[at_] == '.' || text_[at_] == '[')) {
                    fail(word + " is no structure");
                }
                return {make_reference(d.name, where_), d.is_bool};
            }
        }
        fail("there is no datum " + word);
        return {number(0), false};
    }

    Chart& chart_;
    std::string_view text_;
    lang::Span where_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::string problem_;
};

Translated translate(Chart& chart, std::string_view text, lang::Span where) {
    return Parser(chart, text, where).run();
}

lang::Expr as_condition(Translated t) {
    if (t.is_bool) {
        return std::move(t.expr);
    }
    const lang::Span where = t.expr.span;
    return make_binary(Op::kNotEqual, std::move(t.expr), make_number(Rational{0}, where));
}

std::string inside_name(const State& s) { return "in " + s.name; }

}  // namespace puppetri::notation::chart
