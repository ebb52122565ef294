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
    // Whether a channel's name and, before it, this word are what comes last: `send a.c`.
    bool names_channel(Kind word) const {
        std::size_t i = out.list.size();
        const auto kind = [&](std::size_t back) {
            return back <= i ? out.list[i - back].kind : Kind::kEndOfFile;
        };
        while (true) {
            if (kind(1) == Kind::kCloseList) {  // c[k]
                while (i > 0 && kind(1) != Kind::kOpenList && kind(1) != Kind::kNewline) {
                    --i;
                }
                i -= i > 0 ? 1 : 0;
            }
            if (!is_word(kind(1)) && kind(1) != Kind::kQuotedName) {
                return false;
            }
            if (kind(2) != Kind::kDot) {
                return kind(2) == word;
            }
            i -= 2;
        }
    }
    // Whether an operand may follow: only then is `#name` a count, and otherwise a comment.
    bool wants_operand() const {
        if (out.list.empty()) {
            return false;
        }
        const Kind last = out.list.back().kind;
        switch (last) {
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
            case Kind::kOf:
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
                return is_word_operator(last);
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

// `!` behind the channel of a `send`.
struct sends_here {
    using rule_t = sends_here;
    using subs_t = peg::empty_list;
    template <peg::apply_mode, peg::rewind_mode, template <class...> class, template <class...> class, class In>
    static bool match(In&, Lexer& lexer) { return lexer.names_channel(Kind::kSend); }
};
struct tell : peg::seq<peg::one<'!'>, sends_here> {};

struct arrow : peg::string<'-', '>'> {};
struct assign : peg::string<':', '='> {};
struct dots : peg::string<'.', '.'> {};
struct equal : peg::sor<peg::string<'=', '='>, peg::one<'='>> {};
struct not_equal : peg::string<'!', '='> {};
struct less_equal : peg::string<'<', '='> {};
struct greater_equal : peg::string<'>', '='> {};
struct symbol : peg::one<'(', ')', '[', ']', '{', '}', ',', ';', ':', '<', '>', '+', '-', '*', '/', '^', '?', '.'> {};
struct stray : peg::sor<peg::string<'&', '&'>, peg::string<'|', '|'>, peg::utf8::any> {};
struct token : peg::sor<blank, word, line_end, number, text, quoted_name, count, comment, arrow, assign, dots, equal,
                        not_equal, tell, less_equal, greater_equal, symbol, open_text, join, stray> {};
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
        const bool hears = *in.begin() == '?' && lexer.names_channel(Kind::kReceive);
        lexer.add(hears ? Kind::kHear : static_cast<Kind>(*in.begin()), in.begin(), in.end());
    }
};
template <>
struct action<tell> : add<Kind::kTell> {};
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

// What word processors and other languages write for a token of this one. Read as what is meant,
// once it has been told, so that nothing else of the statement is blamed for it.
struct LookAlike {
    std::string_view written;
    Kind meant;  // kEndOfFile: nothing
    std::string_view remedy;
};
constexpr std::array kLookAlikes = {
    LookAlike{"\xE2\x86\x92", Kind::kArrow, "write ->"},
    LookAlike{"\xE2\x88\x92", Kind::kMinus, "write -"},
    LookAlike{"\xE2\x80\x93", Kind::kMinus, "write -"},
    LookAlike{"\xC3\x97", Kind::kTimes, "write *"},
    LookAlike{"\xC2\xB7", Kind::kTimes, "write *"},
    LookAlike{"\xE2\x89\xA4", Kind::kLessEqual, "write <="},
    LookAlike{"\xE2\x89\xA5", Kind::kGreaterEqual, "write >="},
    LookAlike{"\xE2\x89\xA0", Kind::kNotEqual, "write !="},
    LookAlike{"\xE2\x80\xA6", Kind::kDots, "write .."},
    LookAlike{"&&", Kind::kAnd, "write and"},
    LookAlike{"&", Kind::kAnd, "write and"},
    LookAlike{"||", Kind::kOr, "write or"},
    LookAlike{"|", Kind::kOr, "write or"},
    LookAlike{"!", Kind::kNot, "write not"},
    LookAlike{"\xE2\x80\x9C", Kind::kEndOfFile, "write \""},
    LookAlike{"\xE2\x80\x9D", Kind::kEndOfFile, "write \""},
    LookAlike{"\xE2\x80\x98", Kind::kEndOfFile, "write '"},
    LookAlike{"\xE2\x80\x99", Kind::kEndOfFile, "write '"},
};

template <>
struct action<stray> {
    template <class In>
    static void apply(const In& in, Lexer& lexer) {
        const std::string_view text(in.begin(), in.size());
        if (is_control_character(text[0])) {  // has been told for the whole file
            if (text[0] == '\r') {
                lexer.add(Kind::kNewline, in.begin(), in.end());
            }
            lexer.space = true;
            return;
        }
        const auto found =
            std::find_if(kLookAlikes.begin(), kLookAlikes.end(),
                         [&](const LookAlike& look) { return look.written == text; });
        const bool known = found != kLookAlikes.end();
        lexer.report.error(
            lexer.offset(in.begin()), lexer.offset(in.end()), "invalid-character", "",
            text.size() == 2 && text[0] == text[1] ? "this is no operator"
                                                   : "this character has no meaning here",
            known ? std::string(found->remedy) : "remove it, or put it into quotes");
        if (known && found->meant != Kind::kEndOfFile) {
            lexer.add(found->meant, in.begin(), in.end());
        }
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
bool forgets_bracket(const Token& first, const Token& second) {
    switch (first.kind) {
        case Kind::kPlace:
        case Kind::kRule:
        case Kind::kQuestionWord:
        case Kind::kMeasure:
        case Kind::kNet:
        case Kind::kMachine:
        case Kind::kChannel:
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
                    forgets_bracket(list[next], list[next + 1])) {
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

bool begins_statement(Kind kind) {
    switch (kind) {
        case Kind::kPlace:
        case Kind::kState:
        case Kind::kData:
        case Kind::kEnum:
        case Kind::kToken:
        case Kind::kEvent:
        case Kind::kEvents:
        case Kind::kUse:
        case Kind::kRule:
        case Kind::kQuestionWord:
        case Kind::kMeasure:
        case Kind::kFor:
        case Kind::kNet:
        case Kind::kCast:
        case Kind::kEnd:
        case Kind::kLanguage:
        case Kind::kScene:
        case Kind::kFrames:
        case Kind::kUntil:
        case Kind::kSeed:
        case Kind::kPace:
        case Kind::kTime:
        case Kind::kImport:
        case Kind::kPublic:
        case Kind::kStart:
        case Kind::kFinish:
        case Kind::kConsumed:
        case Kind::kChannel:
        case Kind::kMachine:
            return true;
        default:
            return false;
    }
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
        case Kind::kSemicolon:
            return "';'";
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
        case Kind::kTell:
            return "'!'";
        case Kind::kHear:
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
