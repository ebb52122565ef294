// SPDX-License-Identifier: MIT
// Tokens: what the lexer makes of the bytes and what grammar, formatter and edits read. A token's
// kind is one byte, so that the token sequence of a file is itself a string, and the grammar of
// statements a PEG over that string. Keywords are contextual: a keyword is a word with a kind of
// its own, and the grammar takes any word where a name may stand.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "report.h"

namespace puppetri::lang {

enum class Kind : std::uint8_t {
    kEndOfFile = 0,
    kNewline = '\n',  // of a statement: line ends that continue a statement are no tokens
    kNumber = '0',
    kString = '"',
    kQuotedName = '\'',
    kWord = 'w',
    kArrow = 'a',         // ->
    kAssign = 's',        // :=
    kDots = 'd',          // ..
    kNotEqual = 'n',      // !=
    kLessEqual = 'l',     // <=
    kGreaterEqual = 'g',  // >=
    kOpenParen = '(',
    kCloseParen = ')',
    kOpenList = '[',
    kCloseList = ']',
    kOpenBlock = '{',
    kCloseBlock = '}',
    kComma = ',',
    kSemicolon = ';',  // between properties, like a comma
    kColon = ':',
    kEqual = '=',  // = and ==
    kLess = '<',
    kGreater = '>',
    kPlus = '+',
    kMinus = '-',
    kTimes = '*',
    kOver = '/',
    kCaret = '^',
    kQuestion = '?',
    kDot = '.',
    kCount = '#',  // of #P; other # begin comments
    kTell = '!',   // of send c!m
    kHear = 'h',   // ? of receive c?r; other ? are of conditionals
    // What the grammar can expect without it being a kind of its own, for messages.
    kUnitWord = 1,
    kAdjacent = 2,
    kStatementEnd = 3,
    // Keywords, in the order of kKeywords.
    kAfter = 128,
    kAge,
    kAll,
    kAlternate,
    kAlways,
    kAnd,
    kAny,
    kAs,
    kAt,
    kAuto,
    kBounded,
    kCast,
    kChannel,
    kConsumed,
    kCtl,
    kCycle,
    kData,
    kDeadlockFree,
    kDiscipline,
    kDiv,
    kDoes,
    kEnabling,
    kEnd,
    kEnds,
    kEnum,
    kEvent,
    kEvents,
    kEvery,
    kExactlyOne,
    kFalse,
    kFinal,
    kFinish,
    kFirings,
    kFirst,
    kFor,
    kFrame,
    kFrames,
    kFrom,
    kHolds,
    kIf,
    kImplies,
    kImport,
    kIn,
    kInfinite,
    kIs,
    kKeeps,
    kLanguage,
    kLast,
    kLeads,
    kLeast,
    kLeft,
    kLive,
    kLongest,
    kLtl,
    kMachine,
    kMeasure,
    kMemory,
    kMod,
    kMost,
    kMutex,
    kNet,
    kNever,
    kNewest,
    kNext,
    kNo,
    kNobodyFreezes,
    kNot,
    kNow,
    kOdds,
    kOf,
    kOldest,
    kOn,
    kOnly,
    kOpen,
    kOr,
    kOrder,
    kPace,
    kPer,
    kPlace,
    kPoll,
    kPossible,
    kPriority,
    kPublic,
    kQuasiLive,
    kQuestionWord,
    kRaises,
    kReady,
    kReceive,
    kRelease,
    kResample,
    kReversible,
    kRule,
    kRuns,
    kScene,
    kSecond,
    kSeed,
    kSend,
    kServers,
    kSet,
    kSettled,
    kShortest,
    kSingle,
    kStart,
    kStarts,
    kState,
    kTakes,
    kTime,
    kTo,
    kTogether,
    kToken,
    kTokens,
    kTrue,
    kUnit,
    kUnless,
    kUntil,
    kUse,
    kWeak,
    kWhen,
    kWhile,
    kWith,
    kWithin,
    kYes,
};

inline constexpr std::uint8_t kFirstKeyword = 128;
inline constexpr std::array<std::string_view, 122> kKeywords = {
    "after",      "age",      "all",      "alternate", "always",      "and",
    "any",        "as",       "at",       "auto",      "bounded",     "cast",
    "channel",    "consumed", "ctl",      "cycle",     "data",        "deadlock_free",
    "discipline", "div",      "does",     "enabling",  "end",         "ends",
    "enum",       "event",    "events",   "every",     "exactly_one", "false",
    "final",      "finish",   "firings",  "first",     "for",         "frame",
    "frames",     "from",     "holds",    "if",        "implies",     "import",
    "in",         "infinite", "is",       "keeps",     "language",    "last",
    "leads",      "least",    "left",     "live",      "longest",     "ltl",
    "machine",    "measure",  "memory",   "mod",       "most",        "mutex",
    "net",        "never",    "newest",   "next",      "no",          "nobody_freezes",
    "not",        "now",      "odds",     "of",        "oldest",      "on",
    "only",       "open",     "or",       "order",     "pace",        "per",
    "place",      "poll",     "possible", "priority",  "public",      "quasi_live",
    "question",   "raises",   "ready",    "receive",   "release",     "resample",
    "reversible", "rule",     "runs",     "scene",     "second",      "seed",
    "send",       "servers",  "set",      "settled",   "shortest",    "single",
    "start",      "starts",   "state",    "takes",     "time",        "to",
    "together",   "token",    "tokens",   "true",      "unit",        "unless",
    "until",      "use",      "weak",     "when",      "while",       "with",
    "within",     "yes"};
static_assert(static_cast<std::size_t>(Kind::kYes) == kFirstKeyword + kKeywords.size() - 1);

constexpr bool is_keyword(Kind kind) { return static_cast<std::uint8_t>(kind) >= kFirstKeyword; }
constexpr bool is_word(Kind kind) { return is_keyword(kind) || kind == Kind::kWord; }
// `and`, `or`, `not`, `implies`, `mod`, `div`.
constexpr bool is_word_operator(Kind kind) {
    switch (kind) {
        case Kind::kAnd:
        case Kind::kOr:
        case Kind::kNot:
        case Kind::kImplies:
        case Kind::kMod:
        case Kind::kDiv:
            return true;
        default:
            return false;
    }
}
constexpr std::string_view keyword_text(Kind kind) {
    return kKeywords[static_cast<std::size_t>(kind) - kFirstKeyword];
}
// kWord for words that are no keywords.
Kind keyword_kind(std::string_view word);

struct Token {
    std::uint32_t begin = 0, end = 0;  // bytes; an end of statement has the line end's
    Kind kind = Kind::kEndOfFile;
    bool space_before = false;  // blank, line end or comment since the token before
    bool is_unit = false;       // the name of a simple unit
};

struct Comment {
    std::uint32_t begin = 0,
                  end = 0;  // bytes, from # to before the line end, without trailing blanks
};

struct Tokens {
    std::vector<Token> list;  // ends with a kNewline and a kEndOfFile
    std::vector<Comment> comments;
};

// Gives   the tokens of a text that is valid UTF-8 and short enough. Reports characters that have
// no place outside of
//         quotes and texts without an end; these are left out.
Tokens tokenize(std::string_view text, Report& report);

// The words that begin statements, but for the names of transitions and the kinds of blocks.
bool begins_statement(Kind kind);

// Characters that no text has, but for tabs and line ends.
constexpr bool is_control_character(char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7F;
}

// "'->'", "a name", "'takes'": for messages.
std::string_view describe(Kind kind);

}  // namespace puppetri::lang
