// SPDX-License-Identifier: MIT
// From bytes to tokens: a PEGTL grammar of words, numbers, texts and symbols, then one pass that
// decides which line ends end a statement.
#include <algorithm>
#include <tao/pegtl.hpp>

#include "puppetri/base/text.h"
#include "puppetri/lang/units.h"
#include "token.h"

namespace puppetri::lang {
namespace {

namespace peg = tao::pegtl;

struct Lexer {
    const char* base;
    Tokens& out;
    Report& report;
    bool space = false;
    bool joined = false;  // a backslash before the line end
    std::vector<std::string> units;

    Lexer(const char* text, Tokens& tokens, Report& to) : base(text), out(tokens), report(to) {
        units.assign(unit_names().begin(), unit_names().end());
        std::sort(units.begin(), units.end());
    }
    std::uint32_t offset(const char* p) const { return static_cast<std::uint32_t>(p - base); }
    void add(Kind kind, const char* begin, const char* end) {
        out.list.push_back({offset(begin), offset(end), kind, space, false});
        space = false;
    }
    // Whether an operand may follow: only then is `#name` a count, and otherwise a comment.
    bool wants_operand() const {
        if (out.list.empty()) {
            return false;
        }
        switch (out.list.back().kind) {
            case Kind::kOpenParen:
            case Kind::kOpenList:
            case Kind::kComma:
            case Kind::kColon:
            case Kind::kEqual:
            case Kind::kLess:
            case Kind::kGreater:
            case Kind::kLessEqual:
            case Kind::kGreaterEqual:
            case Kind::kNotEqual:
            case Kind::kPlus:
            case Kind::kMinus:
            case Kind::kTimes:
            case Kind::kOver:
            case Kind::kCaret:
            case Kind::kQuestion:
            case Kind::kAssign:
            case Kind::kDots:
            case Kind::kAnd:
            case Kind::kOr:
            case Kind::kNot:
            case Kind::kImplies:
            case Kind::kMod:
            case Kind::kDiv:
            case Kind::kWhen:
            case Kind::kNever:
            case Kind::kAlways:
            case Kind::kPossible:
            case Kind::kIf:
            case Kind::kTo:
            case Kind::kAfter:
            case Kind::kNo:
            case Kind::kUntil:
            case Kind::kWithin:
            case Kind::kMost:
            case Kind::kLeast:
            case Kind::kPriority:
            case Kind::kOdds:
            case Kind::kTakes:
            case Kind::kFor:
            case Kind::kTokens:
            case Kind::kRelease:
            case Kind::kCtl:
            case Kind::kLtl:
            case Kind::kOpenBlock:
                return true;
            default:
                return false;
        }
    }
};

// clang-format off
// Characters of names: ASCII, and what XML 1.0 (production 4) allows beyond it, so that a name may be in any script while
// dashes, arrows and curly quotes from a word processor are told apart from it.
struct letter : peg::sor<peg::ranges<'a', 'z', 'A', 'Z', '_'>,
                         peg::utf8::ranges<0xC0, 0xD6, 0xD8, 0xF6, 0xF8, 0x2FF, 0x370, 0x37D, 0x37F, 0x1FFF,
                                           0x2070, 0x218F, 0x2C00, 0x2FEF, 0x3001, 0xD7FF, 0xF900, 0xFDCF,
                                           0xFDF0, 0xFEFE, 0x10000, 0xEFFFF>> {};
struct word : peg::seq<letter, peg::star<peg::sor<letter, peg::digit, peg::utf8::ranges<0x300, 0x36F>>>> {};
struct exponent : peg::seq<peg::one<'e', 'E'>, peg::opt<peg::one<'+', '-'>>, peg::plus<peg::digit>,
                           peg::not_at<letter>> {};
struct number : peg::seq<peg::plus<peg::digit>, peg::opt<peg::one<'.'>, peg::plus<peg::digit>>, peg::opt<exponent>> {};
struct text : peg::seq<peg::one<'"'>, peg::star<peg::sor<peg::seq<peg::one<'\\'>, peg::not_one<'\n', '\r'>>,
                                                         peg::not_one<'"', '\n', '\r', '\\'>>>, peg::one<'"'>> {};
struct quoted_name : peg::seq<peg::one<'\''>, peg::plus<peg::not_one<'\'', '\n', '\r'>>, peg::one<'\''>> {};
struct rest_of_line : peg::star<peg::not_one<'\n', '\r'>> {};
struct open_text : peg::seq<peg::one<'"', '\''>, rest_of_line> {};
struct blank : peg::plus<peg::one<' ', '\t'>> {};
struct join : peg::seq<peg::one<'\\'>, peg::star<peg::one<' ', '\t'>>, peg::at<peg::opt<peg::one<'\r'>>, peg::one<'\n'>>> {};
struct line_end : peg::seq<peg::opt<peg::one<'\r'>>, peg::one<'\n'>> {};

// `#P` where an operand may stand.
struct count_here {
    using rule_t = count_here;
    using subs_t = peg::empty_list;
    template <peg::apply_mode, peg::rewind_mode, template <class...> class, template <class...> class, class In>
    static bool match(In&, Lexer& lexer) { return lexer.wants_operand(); }
};
struct count : peg::seq<peg::one<'#'>, peg::at<peg::sor<letter, peg::one<'\''>>>, count_here> {};
struct comment : peg::seq<peg::one<'#'>, rest_of_line> {};

struct arrow : peg::string<'-', '>'> {};
struct assign : peg::string<':', '='> {};
struct dots : peg::string<'.', '.'> {};
struct equal : peg::sor<peg::string<'=', '='>, peg::one<'='>> {};
struct not_equal : peg::string<'!', '='> {};
struct less_equal : peg::string<'<', '='> {};
struct greater_equal : peg::string<'>', '='> {};
struct symbol : peg::one<'(', ')', '[', ']', '{', '}', ',', ':', '<', '>', '+', '-', '*', '/', '^', '?', '.'> {};
struct stray : peg::utf8::any {};
struct token : peg::sor<blank, word, line_end, number, text, quoted_name, count, comment, arrow, assign, dots, equal,
                        not_equal, less_equal, greater_equal, symbol, open_text, join, stray> {};
struct tokens : peg::until<peg::eof, token> {};
// clang-format on

template <class Rule>
struct action : peg::nothing<Rule> {};

template <Kind K>
struct add {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        lexer.add(K, in.begin(), in.end());
    }
};
template <>
struct action<number> : add<Kind::kNumber> {};
template <>
struct action<text> : add<Kind::kString> {};
template <>
struct action<quoted_name> : add<Kind::kQuotedName> {};
template <>
struct action<count> : add<Kind::kCount> {};
template <>
struct action<arrow> : add<Kind::kArrow> {};
template <>
struct action<assign> : add<Kind::kAssign> {};
template <>
struct action<dots> : add<Kind::kDots> {};
template <>
struct action<equal> : add<Kind::kEqual> {};
template <>
struct action<not_equal> : add<Kind::kNotEqual> {};
template <>
struct action<less_equal> : add<Kind::kLessEqual> {};
template <>
struct action<greater_equal> : add<Kind::kGreaterEqual> {};

template <>
struct action<symbol> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        lexer.add(static_cast<Kind>(*in.begin()), in.begin(), in.end());
    }
};
template <>
struct action<word> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        const std::string_view text(in.begin(), in.size());
        lexer.add(keyword_kind(text), in.begin(), in.end());
        lexer.out.list.back().is_unit =
            std::binary_search(lexer.units.begin(), lexer.units.end(), text);
    }
};
template <>
struct action<blank> {
    template <class In>
    static void apply(const In&, Lexer& lexer) {
        lexer.space = true;
    }
};
template <>
struct action<line_end> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        if (!lexer.joined) {
            lexer.add(Kind::kNewline, in.begin(), in.end());
        }
        lexer.joined = false;
        lexer.space = true;
    }
};
template <>
struct action<join> {
    template <class In>
    static void apply(const In&, Lexer& lexer) {
        lexer.joined = true;
    }
};
template <>
struct action<comment> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        const char* end = in.end();
        while (end[-1] == ' ' || end[-1] == '\t') {
            --end;
        }
        lexer.out.comments.push_back({lexer.offset(in.begin()), lexer.offset(end)});
        lexer.space = true;
    }
};
template <>
struct action<open_text> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        const bool name = *in.begin() == '\'';
        lexer.report.error(lexer.offset(in.begin()), lexer.offset(in.end()), "unterminated-text",
                           "", name ? "this quoted name has no end" : "this text has no end",
                           name ? "put ' after the name, on the same line"
                                : "put \" where the text ends, on the same line");
        lexer.add(name ? Kind::kQuotedName : Kind::kString, in.begin(), in.end());
    }
};

// What a word processor makes of plain characters.
struct LookAlike {
    std::string_view character, remedy;
};
constexpr std::array<LookAlike, 12> kLookAlikes = {{{"\xE2\x86\x92", "write ->"},
                                                    {"\xE2\x80\x9C", "write \""},
                                                    {"\xE2\x80\x9D", "write \""},
                                                    {"\xE2\x80\x98", "write '"},
                                                    {"\xE2\x80\x99", "write '"},
                                                    {"\xE2\x88\x92", "write -"},
                                                    {"\xE2\x80\x93", "write -"},
                                                    {"\xC3\x97", "write *"},
                                                    {"\xC2\xB7", "write *"},
                                                    {"\xE2\x89\xA4", "write <="},
                                                    {"\xE2\x89\xA5", "write >="},
                                                    {"\xE2\x80\xA6", "write .."}}};

template <>
struct action<stray> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        const std::string_view text(in.begin(), in.size());
        std::string message = "this character has no meaning here";
        std::string remedy = "remove it, or put it into quotes";
        if (text.size() == 1 && static_cast<unsigned char>(text[0]) < 0x20) {
            constexpr char digits[] = "0123456789abcdef";
            const auto c = static_cast<unsigned char>(text[0]);
            message =
                std::string("a control character (0x") + digits[c >> 4] + digits[c & 15] + ")";
            remedy = "remove it; is this a text file?";
        } else if (text == ";") {
            remedy = "put each statement on a line of its own";
        } else if (text == "&" || text == "|") {
            remedy = text == "&" ? "write and" : "write or";
        } else if (text == "!") {
            remedy = "write not";
        }
        for (const LookAlike& look : kLookAlikes) {
            if (look.character == text) {
                remedy = look.remedy;
            }
        }
        lexer.report.error(lexer.offset(in.begin()), lexer.offset(in.end()), "invalid-character",
                           "", message, remedy);
        lexer.space = true;
    }
};

// After these a line end does not end the statement.
bool continues_after(Kind kind) {
    switch (kind) {
        case Kind::kComma:
        case Kind::kEqual:
        case Kind::kNotEqual:
        case Kind::kLess:
        case Kind::kLessEqual:
        case Kind::kGreater:
        case Kind::kGreaterEqual:
        case Kind::kPlus:
        case Kind::kMinus:
        case Kind::kTimes:
        case Kind::kOver:
        case Kind::kCaret:
        case Kind::kQuestion:
        case Kind::kAssign:
        case Kind::kDots:
        case Kind::kDot:
        case Kind::kAnd:
        case Kind::kOr:
        case Kind::kImplies:
            return true;
        default:
            return false;
    }
}
// Nor does it before these.
bool continues_before(Kind kind) {
    return kind == Kind::kArrow || kind == Kind::kAnd || kind == Kind::kOr ||
           kind == Kind::kImplies || kind == Kind::kOpenBlock;
}
// `place NAME` and the like cannot stand inside brackets: a closing bracket was forgotten.
bool begins_statement(const Token& first, const Token& second) {
    switch (first.kind) {
        case Kind::kPlace:
        case Kind::kRule:
        case Kind::kNet:
        case Kind::kUse:
        case Kind::kEvent:
        case Kind::kState:
        case Kind::kData:
        case Kind::kEnum:
        case Kind::kImport:
        case Kind::kPublic:
        case Kind::kFor:
        case Kind::kScene:
        case Kind::kCast:
        case Kind::kToken:
            return is_word(second.kind) || second.kind == Kind::kString ||
                   second.kind == Kind::kQuotedName || second.kind == Kind::kOpenBlock;
        default:
            return false;
    }
}

void drop_line_ends_that_continue(std::vector<Token>& list) {
    std::size_t kept = 0;
    int open = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Token token = list[i];
        if (token.kind == Kind::kOpenParen || token.kind == Kind::kOpenList) {
            ++open;
        } else if (token.kind == Kind::kCloseParen || token.kind == Kind::kCloseList) {
            open = std::max(0, open - 1);
        } else if (token.kind == Kind::kOpenBlock || token.kind == Kind::kCloseBlock) {
            open = 0;
        } else if (token.kind == Kind::kNewline) {
            if (kept == 0 || list[kept - 1].kind == Kind::kNewline) {
                continue;  // an empty line
            }
            std::size_t next = i + 1;
            while (next < list.size() && list[next].kind == Kind::kNewline) {
                ++next;
            }
            if (next < list.size()) {
                if (open > 0 && next + 1 < list.size() &&
                    begins_statement(list[next], list[next + 1])) {
                    open = 0;
                } else if (open > 0 || continues_after(list[kept - 1].kind) ||
                           continues_before(list[next].kind)) {
                    continue;
                }
            }
        }
        list[kept++] = token;
    }
    list.resize(kept);
}

}  // namespace

Kind keyword_kind(std::string_view word) {
    const auto found = std::lower_bound(kKeywords.begin(), kKeywords.end(), word);
    if (found == kKeywords.end() || *found != word) {
        return Kind::kWord;
    }
    return static_cast<Kind>(kFirstKeyword + (found - kKeywords.begin()));
}

std::string_view describe(Kind kind) {
    switch (kind) {
        case Kind::kEndOfFile:
            return "the end of the file";
        case Kind::kNewline:
        case Kind::kStatementEnd:
            return "the end of the line";
        case Kind::kNumber:
            return "a number";
        case Kind::kString:
            return "a text in quotes";
        case Kind::kQuotedName:
        case Kind::kWord:
            return "a name";
        case Kind::kUnitWord:
            return "a unit";
        case Kind::kAdjacent:
            return "no space";
        case Kind::kArrow:
            return "'->'";
        case Kind::kAssign:
            return "':='";
        case Kind::kDots:
            return "'..'";
        case Kind::kNotEqual:
            return "'!='";
        case Kind::kLessEqual:
            return "'<='";
        case Kind::kGreaterEqual:
            return "'>='";
        case Kind::kOpenParen:
            return "'('";
        case Kind::kCloseParen:
            return "')'";
        case Kind::kOpenList:
            return "'['";
        case Kind::kCloseList:
            return "']'";
        case Kind::kOpenBlock:
            return "'{'";
        case Kind::kCloseBlock:
            return "'}'";
        case Kind::kComma:
            return "','";
        case Kind::kColon:
            return "':'";
        case Kind::kEqual:
            return "'='";
        case Kind::kLess:
            return "'<'";
        case Kind::kGreater:
            return "'>'";
        case Kind::kPlus:
            return "'+'";
        case Kind::kMinus:
            return "'-'";
        case Kind::kTimes:
            return "'*'";
        case Kind::kOver:
            return "'/'";
        case Kind::kCaret:
            return "'^'";
        case Kind::kQuestion:
            return "'?'";
        case Kind::kDot:
            return "'.'";
        case Kind::kCount:
            return "'#'";
        default:
            return is_keyword(kind) ? keyword_text(kind) : "";
    }
}

Tokens tokenize(std::string_view text, Report& report) {
    Tokens out;
    out.list.reserve(text.size() / 4 + 2);
    Lexer lexer(text.data(), out, report);
    peg::memory_input<peg::tracking_mode::lazy, peg::eol::lf, const char*> in(
        text.data(), text.data() + text.size(), "");
    peg::parse<tokens, action>(in, lexer);
    lexer.add(Kind::kNewline, text.data() + text.size(), text.data() + text.size());
    lexer.add(Kind::kEndOfFile, text.data() + text.size(), text.data() + text.size());
    drop_line_ends_that_continue(out.list);
    return out;
}

}  // namespace puppetri::lang
