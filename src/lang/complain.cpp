// SPDX-License-Identifier: MIT
// The likeliest slip behind a statement that the grammar refuses, most telling first.
#include "complain.h"

#include <algorithm>
#include <array>

#include "puppetri/base/text.h"
#include "puppetri/lang/units.h"

namespace puppetri::lang {
namespace {

// How each statement is written, for the remedy.
struct Form {
    Kind word;
    std::string_view form;
};
constexpr std::array kForms = {
    Form{Kind::kPlace, "place NAME \"caption\" does WHO.MOVEMENT(...) takes 2 s tokens 1"},
    Form{Kind::kStart, "start place NAME"},
    Form{Kind::kFinish, "finish place NAME"},
    Form{Kind::kState, "state NAME = A and B"},
    Form{Kind::kData, "data NAME: 0 .. 5 = 0"},
    Form{Kind::kEnum, "enum NAME { a, b, c }"},
    Form{Kind::kToken, "token NAME(attribute: TYPE)"},
    Form{Kind::kEvent, "event NAME at 2 s, 3.5 s, or event NAME every 2 s"},
    Form{Kind::kConsumed, "consumed event NAME"},
    Form{Kind::kEvents, "events from \"FILE\""},
    Form{Kind::kUse, "use NET(ARGUMENTS) as NAME"},
    Form{Kind::kRule, "rule NAME \"caption\" never A and B, or A leads to B within 2 s, ..."},
    Form{Kind::kQuestionWord,
         "question NAME \"caption\" shortest time to A, or longest time to A, or cycle time of A"},
    Form{Kind::kMeasure,
         "measure NAME \"caption\" mean of #PLACE, or mean of time in PLACE, or count of "
         "TRANSITION, ..."},
    Form{Kind::kFor, "for NAME in (a, b) { ... }, or for NAME in 1 .. 5 { ... }"},
    Form{Kind::kNet, "net NAME(PARAMETER: TYPE, ...) { ... }"},
    Form{Kind::kMachine, "machine NAME(PARAMETER: TYPE, ...) { ... }"},
    Form{Kind::kChannel, "channel NAME of TYPE"},
    Form{Kind::kCast, "cast { NAME: mannequin { height 1.75 m } }"},
    Form{Kind::kEnd, "end { A and B }"},
    Form{Kind::kLanguage, "language 1"},
    Form{Kind::kScene, "scene \"TITLE\""},
    Form{Kind::kFrames, "frames 24 per second"},
    Form{Kind::kUntil, "until 40 s, or until frame 960"},
    Form{Kind::kSeed, "seed 7"},
    Form{Kind::kPace, "pace 1 s"},
    Form{Kind::kTime, "time unit 1 min"},
    Form{Kind::kImport, "import NAME from \"FILE\""},
};

class Complaint {
 public:
    Complaint(Entry entry, std::span<const Token> tokens, std::uint32_t begin, std::uint32_t end,
              const Reading& reading, const std::string& element, Report& report)
        : entry_(entry),
          tokens_(tokens),
          begin_(begin),
          end_(end),
          at_(std::min(reading.furthest, end)),
          reading_(reading),
          element_(element),
          report_(report) {}

    void run() {
        if (reading_.too_deep) {
            error(at_, "too-deep", "this is nested too deeply",
                  "name parts of it as states, and use the names");
        } else if (!unclosed_bracket() && !unknown_statement() && !space_before_arguments() &&
                   !double_arrow() && !runs_on() && !unknown_form() && !unknown_word()) {
            expected();
        }
    }

 private:
    const Token& token(std::uint32_t i) const { return tokens_[i]; }
    std::string text(std::uint32_t i) const {
        return std::string(report_.text().substr(token(i).begin, token(i).end - token(i).begin));
    }
    bool ended() const { return at_ >= end_; }
    bool could_be(Kind kind) const {
        return reading_.expected.test(static_cast<std::size_t>(kind));
    }
    void error(std::uint32_t at, std::string code, std::string message, std::string remedy) {
        report_.error(token(at).begin, std::max(token(at).end, token(at).begin + 1),
                      std::move(code), element_, std::move(message), std::move(remedy));
    }

    // A bracket that is open where the statement ends.
    bool unclosed_bracket() {
        std::vector<std::uint32_t> open;
        for (std::uint32_t i = begin_; i < end_; ++i) {
            const Kind kind = token(i).kind;
            if (kind == Kind::kOpenParen || kind == Kind::kOpenList) {
                open.push_back(i);
            } else if (kind == Kind::kCloseParen || kind == Kind::kCloseList) {
                const Kind wanted = kind == Kind::kCloseParen ? Kind::kOpenParen : Kind::kOpenList;
                if (open.empty() || token(open.back()).kind != wanted) {
                    error(i, "unmatched-bracket", "this bracket closes nothing",
                          "remove it, or open one before");
                    return true;
                }
                open.pop_back();
            }
        }
        if (open.empty()) {
            return false;
        }
        const bool round = token(open.back()).kind == Kind::kOpenParen;
        error(open.back(), "unclosed-bracket", "this bracket is not closed",
              round ? "put ) where it ends" : "put ] where it ends");
        return true;
    }

    bool unknown_statement() {
        if (entry_ != Entry::kStatement) {
            return false;
        }
        std::uint32_t first = begin_;
        if (token(first).kind == Kind::kPublic && first + 1 < end_) {
            ++first;
        }
        const Kind kind = token(first).kind;
        const bool has_arrow = std::any_of(tokens_.begin() + begin_, tokens_.begin() + end_,
                                           [](const Token& t) { return t.kind == Kind::kArrow; });
        const bool has_colon =
            first + 1 < end_ && (token(first + 1).kind == Kind::kColon ||
                                 (token(first + 1).kind == Kind::kString && first + 2 < end_ &&
                                  token(first + 2).kind == Kind::kColon));
        if (has_colon || begins_statement(kind)) {
            return false;
        }
        if (has_arrow && text(first) == "transition") {
            error(first, "unknown-keyword", "a transition begins with its name",
                  "leave the word transition out");
            return true;
        }
        if (has_arrow) {
            error(first, "missing-name", "a transition needs a name and a colon",
                  "write NAME: P1 -> P2");
            return true;
        }
        if (!is_word(kind)) {
            error(first, "syntax", "no statement begins with " + std::string(describe(kind)),
                  "statements begin with a word: place, rule, use ..., or NAME: of a transition");
            return true;
        }
        std::vector<std::string> known;
        for (const Form& form : kForms) {
            known.emplace_back(keyword_text(form.word));
        }
        known.emplace_back("public");
        const std::string_view nearest = nearest_name(text(first), known);
        error(first, "unknown-keyword", "no statement begins with '" + text(first) + "'",
              nearest.empty() ? "write place, rule, use ..., or NAME: P1 -> P2 for a transition"
                              : "did you mean " + std::string(nearest) + "?");
        return true;
    }

    // f (x): a call has no space; two values side by side have no meaning.
    bool space_before_arguments() {
        if (ended() || token(at_).kind != Kind::kOpenParen || at_ == begin_ ||
            !is_word(token(at_ - 1).kind) || !token(at_).space_before) {
            return false;
        }
        error(at_, "space-before-arguments",
              "there is a space between '" + text(at_ - 1) + "' and its arguments",
              "write " + text(at_ - 1) + "(...)");
        return true;
    }

    // a => b
    bool double_arrow() {
        if (ended() || !could_be(Kind::kArrow) || token(at_).kind != Kind::kEqual ||
            at_ + 1 >= end_ || token(at_ + 1).kind != Kind::kGreater) {
            return false;
        }
        report_.error(token(at_).begin, token(at_ + 1).end, "syntax", element_, "'=>' is no arrow",
                      "write ->");
        return true;
    }

    // rule NAME nevr P: what stands there could begin a formula, and was meant as a form.
    bool unknown_form() {
        if (entry_ != Entry::kStatement || token(begin_).kind != Kind::kRule) {
            return false;
        }
        std::uint32_t form = begin_ + 2;
        form += form < end_ && token(form).kind == Kind::kString ? 1 : 0;
        if (form >= end_ || token(form).kind != Kind::kWord || at_ == form) {
            return false;
        }
        static const std::vector<std::string> known = {
            "never",          "always",        "possible",   "mutex", "exactly_one", "alternate",
            "bounded",        "deadlock_free", "reversible", "ends",  "live",        "quasi_live",
            "nobody_freezes", "ctl",           "ltl",        "after"};
        const std::string_view nearest = nearest_name(text(form), known);
        if (nearest.empty()) {
            return false;
        }
        error(form, "unknown-keyword", "no rule has the form '" + text(form) + "'",
              "did you mean " + std::string(nearest) + "?");
        return true;
    }

    // What people write for a unit.
    static std::string_view unit_for(std::string_view word) {
        struct Alias {
            std::string_view word, unit;
        };
        static constexpr std::array<Alias, 21> kAliases = {
            {{"sec", "s"},      {"secs", "s"},      {"second", "s"},       {"seconds", "s"},
             {"minute", "min"}, {"minutes", "min"}, {"mins", "min"},       {"hour", "h"},
             {"hours", "h"},    {"msec", "ms"},     {"millisecond", "ms"}, {"milliseconds", "ms"},
             {"meter", "m"},    {"meters", "m"},    {"metre", "m"},        {"metres", "m"},
             {"degree", "deg"}, {"degrees", "deg"}, {"radians", "rad"},    {"kilogram", "kg"},
             {"newton", "N"}}};
        for (const Alias& alias : kAliases) {
            if (alias.word == word) {
                return alias.unit;
            }
        }
        return "";
    }

    // t: a -> b when x and
    // u: b -> a
    bool runs_on() {
        if (ended() || at_ < begin_ + 2 || token(at_).kind != Kind::kColon) {
            return false;
        }
        const std::uint32_t last = at_ - 2;
        const std::string_view between =
            report_.text().substr(token(last).end, token(at_ - 1).begin - token(last).end);
        if (between.find('\n') == std::string_view::npos) {
            return false;
        }
        error(last, "syntax",
              "the line ends with '" + text(last) +
                  "', so that the statement goes on with the next line",
              "complete it on this line, or remove '" + text(last) + "'");
        return true;
    }

    bool unknown_word() {
        if (token(begin_).kind == Kind::kFrames || ended() || !is_word(token(at_).kind) ||
            could_be(Kind::kWord)) {
            return false;
        }
        const bool after_number =
            at_ > begin_ && token(at_ - 1).kind == Kind::kNumber && could_be(Kind::kUnitWord);
        std::vector<std::string> known;
        for (std::size_t i = 0; i < kKeywords.size(); ++i) {
            const auto word = static_cast<Kind>(kFirstKeyword + i);
            const bool path_operator = word == Kind::kUntil && could_be(Kind::kRelease);
            if (could_be(word) && !is_operator(word) && !path_operator) {
                known.emplace_back(kKeywords[i]);
            }
        }
        const std::vector<std::string> keywords = known;
        if (after_number) {
            known.insert(known.end(), unit_names().begin(), unit_names().end());
        }
        const std::string_view alias = after_number ? unit_for(text(at_)) : "";
        const std::string_view nearest = alias.empty() ? nearest_name(text(at_), known) : alias;
        if (nearest.empty() && keywords.empty() && !after_number) {
            return false;
        }
        const bool unit = after_number &&
                          (nearest.empty() ||
                           std::find(keywords.begin(), keywords.end(), nearest) == keywords.end());
        std::string remedy = nearest.empty() ? "" : "did you mean " + std::string(nearest) + "?";
        if (remedy.empty() && unit) {
            remedy = "units are " +
                     sample(std::vector<std::string>(unit_names().begin(), unit_names().end()));
        } else if (remedy.empty()) {
            remedy = "here may stand " + sample(keywords);
        }
        error(at_, unit ? "unknown-unit" : "unknown-keyword",
              unit ? "'" + text(at_) + "' is no unit" : "'" + text(at_) + "' has no meaning here",
              remedy);
        return true;
    }

    static bool is_operator(Kind kind) {
        return is_word_operator(kind) || kind == Kind::kWeak || kind == Kind::kRelease;
    }

    static std::string sample(const std::vector<std::string>& words) {
        std::string out;
        for (std::size_t i = 0; i < words.size() && i < 12; ++i) {
            out += i > 0 ? ", " : "";
            out += words[i];
        }
        return words.size() > 12 ? out + ", ..." : out;
    }

    // The plain form: expected A or B, found C.
    void expected() {
        const bool value =
            could_be(Kind::kNumber) && could_be(Kind::kOpenParen) && could_be(Kind::kWord);
        const bool more = could_be(Kind::kPlus) && could_be(Kind::kAnd);  // after a whole value
        std::vector<std::string> wanted;
        if (value) {
            wanted.emplace_back("a value");
        }
        for (std::size_t i = 0; i < 256; ++i) {
            const auto kind = static_cast<Kind>(i);
            const bool path_operator = kind == Kind::kUntil && could_be(Kind::kRelease);
            if (!reading_.expected.test(i) || describe(kind).empty() || is_operator(kind) ||
                path_operator) {
                continue;
            }
            const bool of_value = kind == Kind::kNumber || kind == Kind::kOpenParen ||
                                  kind == Kind::kOpenList || kind == Kind::kString ||
                                  kind == Kind::kWord || kind == Kind::kCount ||
                                  kind == Kind::kMinus || kind == Kind::kPlus;
            const bool joins =
                kind == Kind::kPlus || kind == Kind::kMinus || kind == Kind::kTimes ||
                kind == Kind::kOver || kind == Kind::kCaret || kind == Kind::kDots ||
                kind == Kind::kEqual || kind == Kind::kNotEqual || kind == Kind::kLess ||
                kind == Kind::kLessEqual || kind == Kind::kGreater || kind == Kind::kGreaterEqual ||
                kind == Kind::kQuestion || kind == Kind::kDot || kind == Kind::kUnitWord ||
                kind == Kind::kOpenList || kind == Kind::kOpenParen;
            if ((value && of_value) || (more && joins)) {
                continue;
            }
            wanted.emplace_back(describe(kind));
        }
        std::string list;
        for (std::size_t i = 0; i < wanted.size() && i < 8; ++i) {
            list += i == 0 ? "" : (i + 1 == wanted.size() ? " or " : ", ");
            list += wanted[i];
        }
        std::string found =
            ended() ? std::string("the end of the statement") : "'" + text(at_) + "'";
        if (ended() && end_ < tokens_.size() && token(end_).kind == Kind::kOpenBlock) {
            found = "'{'";
        }
        error(at_, "syntax",
              list.empty() ? found + " cannot stand here" : "expected " + list + ", found " + found,
              remedy());
    }

    std::string remedy() const {
        const bool after_number = at_ > begin_ && token(at_ - 1).kind == Kind::kNumber;
        if (!ended() && after_number && token(at_).kind == Kind::kComma && at_ + 1 < end_ &&
            token(at_ + 1).kind == Kind::kNumber && !token(at_ + 1).space_before) {
            return "write " + text(at_ - 1) + "." + text(at_ + 1);
        }
        if (!ended() && after_number && is_word(token(at_).kind) && could_be(Kind::kTimes) &&
            !could_be(Kind::kPer)) {
            return "write " + text(at_ - 1) + "*" + text(at_);
        }
        switch (entry_) {
            case Entry::kProperty:
                return "write PROPERTY VALUE, with commas or line ends between";
            case Entry::kMember:
                return "write NAME: KIND { PROPERTY VALUE, ... }";
            case Entry::kFormula:
                return "write one formula on each line";
            case Entry::kEnumValue:
                return "write names, with commas between";
            case Entry::kStatement:
                break;
        }
        const std::uint32_t first =
            begin_ + (token(begin_).kind == Kind::kPublic && begin_ + 1 < end_ ? 1 : 0);
        const auto is_colon = [&](std::uint32_t i) {
            return i < end_ && token(i).kind == Kind::kColon;
        };
        const bool captioned = first + 1 < end_ && token(first + 1).kind == Kind::kString;
        if (is_colon(first + 1) || (captioned && is_colon(first + 2))) {
            return "write NAME: P1 + 2*P2 -> P3 priority 2 when ...";
        }
        for (const Form& form : kForms) {
            if (form.word == token(first).kind) {
                return "write " + std::string(form.form);
            }
        }
        return "complete the statement on this line";
    }

    Entry entry_;
    std::span<const Token> tokens_;
    std::uint32_t begin_, end_, at_;
    const Reading& reading_;
    const std::string& element_;
    Report& report_;
};

}  // namespace

void complain(Entry entry, std::span<const Token> tokens, std::uint32_t begin, std::uint32_t end,
              const Reading& reading, const std::string& element, Report& report) {
    Complaint(entry, tokens, begin, end, reading, element, report).run();
}

}  // namespace puppetri::lang
