// SPDX-License-Identifier: MIT
// Reading a script: a list of calls, `WORD(ARGUMENT, ...)`, with comments as in C. What printed
// scripts get wrong is told and understood where there is one way to understand it.
#include <algorithm>
#include <array>
#include <optional>

#include "puppetri/base/text.h"
#include "puppetri/lang/decimal.h"
#include "tookima.h"

namespace puppetri::notation::tookima {
namespace {

enum class Sort : std::uint8_t { kEnd, kWord, kNumber, kText, kSymbol };

struct Token {
    Sort sort = Sort::kEnd;
    std::string text;  // without quotes
    lang::Span span;
};

constexpr std::array<std::string_view, 16> kStatements = {
    "DEF_ESM",          "DEF_EVENT",      "DEF_CHANNEL", "TIME_INTERVAL", "SAMPLES", "FUNCTION",
    "START_SIMULATION", "END_SIMULATION", "BEGIN_ESM",   "END_ESM",       "CHANNEL", "EVENT",
    "ACTION",           "MATCH",          "TRUE",        "NO_TASK"};
// The last three are no statements.
constexpr std::size_t kStatementCount = 13;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool is_statement(std::string_view word) {
    return std::find(kStatements.begin(), kStatements.begin() + kStatementCount, word) !=
           kStatements.begin() + kStatementCount;
}
bool is_reserved(std::string_view word) {
    return std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
}

class Parser {
 public:
    Parser(lang::Parsed& out, std::uint32_t file) : out_(out), file_(file), text_(out.file.text) {
        scan();
    }

    Script run() {
        while (token().sort != Sort::kEnd && out_.diagnostics.size() < kMaxMessages) {
            statement();
        }
        finish();
        return std::move(script_);
    }

 private:
    // ---- tokens

    lang::Span span(std::size_t begin, std::size_t end) const {
        return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), file_};
    }

    void scan() {
        std::size_t i = 0;
        const auto at = [&](std::size_t k) { return k < text_.size() ? text_[k] : '\0'; };
        while (i < text_.size()) {
            const std::size_t begin = i;
            const char c = text_[i];
            if (is_blank(c)) {
                ++i;
            } else if (c == '/' && at(i + 1) == '*') {
                const std::size_t end = text_.find("*/", i + 2);
                if (end == std::string::npos) {
                    error("unterminated-text", span(begin, begin + 2), "this comment has no end",
                          "write */ where it ends");
                    return;
                }
                i = end + 2;
            } else if (c == '/' && at(i + 1) == '/') {
                i = std::min(text_.find('\n', i), text_.size());
            } else if (is_letter(c)) {
                while (is_letter(at(i)) || is_digit(at(i))) {
                    ++i;
                }
                add(Sort::kWord, begin, i, text_.substr(begin, i - begin));
            } else if (is_digit(c) ||
                       ((c == '.' || c == '-') && (is_digit(at(i + 1)) || at(i + 1) == '.'))) {
                ++i;
                while (is_digit(at(i)) || at(i) == '.') {
                    ++i;
                }
                add(Sort::kNumber, begin, i, text_.substr(begin, i - begin));
            } else if (c == '"') {
                ++i;
                while (i < text_.size() && text_[i] != '"' && text_[i] != '\n') {
                    ++i;
                }
                if (at(i) != '"') {
                    error("unterminated-text", span(begin, i), "this text has no end",
                          "put \" where it ends, on the same line");
                }
                add(Sort::kText, begin, std::min(i + 1, text_.size()),
                    text_.substr(begin + 1, i - begin - 1));
                i += at(i) == '"' ? 1 : 0;
            } else {
                i += 1;
                while (i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xC0) == 0x80) {
                    ++i;  // the rest of a code point
                }
                add(Sort::kSymbol, begin, i, text_.substr(begin, i - begin));
            }
        }
    }

    void add(Sort sort, std::size_t begin, std::size_t end, std::string text) {
        tokens_.push_back({sort, std::move(text), span(begin, end)});
    }

    Token token(std::size_t ahead = 0) const {
        if (at_ + ahead < tokens_.size()) {
            return tokens_[at_ + ahead];
        }
        return {Sort::kEnd, "", span(text_.size(), text_.size())};
    }
    bool symbol(char c) {
        if (token().sort == Sort::kSymbol && token().text[0] == c) {
            ++at_;
            return true;
        }
        return false;
    }

    void error(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(out_, Severity::kError, std::move(code), where, element_, std::move(message),
             std::move(remedy));
    }
    void slip(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(out_, Severity::kWarning, std::move(code), where, element_, std::move(message),
             std::move(remedy));
    }

    // ---- parts of statements; nullopt when told

    bool want(char c, std::string_view form) {
        if (symbol(c)) {
            return true;
        }
        error("syntax", token().span,
              std::string("'") + c + "' is missing" +
                  (token().sort == Sort::kEnd ? " at the end of the file"
                                              : " before '" + token().text + "'"),
              "write " + std::string(form));
        return false;
    }
    std::optional<Word> word(Sort sort, std::string_view form) {
        if (token().sort == sort && !(sort == Sort::kWord && is_reserved(token().text))) {
            const Token t = token();
            ++at_;
            return Word{t.text, t.span};
        }
        if (token().sort == Sort::kWord && sort == Sort::kText && !is_reserved(token().text)) {
            const Token t = token();
            slip("quotes-missing", t.span, t.text + " is a state or a message, and has no quotes",
                 "write \"" + t.text + "\"");
            ++at_;
            return Word{t.text, t.span};
        }
        error("syntax", token().span,
              std::string(sort == Sort::kText ? "a text in quotes" : "a name") + " is wanted here",
              "write " + std::string(form));
        return std::nullopt;
    }
    // NAME in brackets.
    std::optional<Word> named(std::string_view form) {
        if (!want('(', form)) {
            return std::nullopt;
        }
        auto name = word(Sort::kWord, form);
        if (!name || !want(')', form)) {
            return std::nullopt;
        }
        return name;
    }
    std::optional<Rational> number(std::string_view form) {
        const Token t = token();
        if (t.sort == Sort::kNumber) {
            ++at_;
            const bool negative = t.text.starts_with('-');
            if (const auto value = lang::parse_decimal(t.text.substr(negative ? 1 : 0))) {
                return negative ? negate(*value) : *value;
            }
        }
        error("syntax", t.span, "a number of at most 18 digits is wanted here",
              "write " + std::string(form));
        return std::nullopt;
    }

    // To the next statement.
    void skip() {
        while (token().sort != Sort::kEnd &&
               !(token().sort == Sort::kWord && is_statement(token().text))) {
            ++at_;
        }
    }

    // ---- statements

    // "DEF EVENT" for DEF_EVENT, as some printings have it.
    std::string opener() {
        const Token first = token();
        const Token second = token(1);
        if (first.sort == Sort::kWord && second.sort == Sort::kWord) {
            const std::string joined = first.text + "_" + second.text;
            if (is_statement(joined)) {
                slip("written-apart", {first.span.begin, second.span.end, file_},
                     "this is one word", "write " + joined);
                at_ += 2;
                return joined;
            }
        }
        ++at_;
        return first.text;
    }

    void statement() {
        if (symbol(';')) {
            return;
        }
        const Token first = token();
        const std::string what = opener();
        if (first.sort != Sort::kWord || !is_statement(what)) {
            static const std::vector<std::string> known(kStatements.begin(),
                                                        kStatements.begin() + kStatementCount);
            const std::string_view nearest =
                first.sort == Sort::kWord ? nearest_name(what, known) : "";
            error("unknown-keyword", first.span, "no statement of a script begins like this",
                  nearest.empty() ? "write DEF_ESM, BEGIN_ESM, ACTION or another statement"
                                  : "did you mean " + std::string(nearest) + "?");
            skip();
            return;
        }
        if (!read(what, first.span)) {
            skip();
        }
    }

    bool read(const std::string& what, lang::Span where) {
        if (what == "DEF_ESM") {
            return define_machine();
        }
        if (what == "DEF_EVENT" || what == "DEF_CHANNEL" || what == "FUNCTION") {
            const auto name = named(what + "(NAME)");
            if (!name) {
                return false;
            }
            auto& list = what == "DEF_EVENT"     ? script_.events
                         : what == "DEF_CHANNEL" ? script_.channels
                                                 : script_.functions;
            if (index_of(list, name->text) >= 0) {
                slip("name-twice", name->span, name->text + " is declared twice",
                     "remove one of the two");
            } else {
                list.push_back(*name);
            }
            return true;
        }
        if (what == "TIME_INTERVAL") {
            constexpr std::string_view kForm = "TIME_INTERVAL(0., 11.)";
            if (!want('(', kForm)) {
                return false;
            }
            const auto from = number(kForm);
            if (!from || !want(',', kForm)) {
                return false;
            }
            const auto to = number(kForm);
            if (!to || !want(')', kForm)) {
                return false;
            }
            script_.from = *from;
            script_.to = *to;
            script_.interval = where;
            if (from->numerator < 0 || compare(*from, *to) >= 0) {
                error("wrong-interval", where, "the interval begins at 0 or later and takes time",
                      "write TIME_INTERVAL(0., 11.)");
            }
            return true;
        }
        if (what == "SAMPLES") {
            constexpr std::string_view kForm = "SAMPLES(12)";
            if (!want('(', kForm)) {
                return false;
            }
            const auto count = number(kForm);
            if (!count || !want(')', kForm)) {
                return false;
            }
            script_.sampled = where;
            script_.samples = count->numerator;
            if (!count->whole() || count->numerator < 2 ||
                count->numerator > static_cast<std::int64_t>(kMaxSamples)) {
                error("wrong-samples", where,
                      "there are 2 to " + std::to_string(kMaxSamples) +
                          " samples, both ends of the interval included",
                      "write SAMPLES(12)");
                script_.samples = 2;
            }
            return true;
        }
        if (what == "START_SIMULATION" || what == "END_SIMULATION") {
            const bool start = what == "START_SIMULATION";
            if ((start ? started_ : ended_) || (!start && !started_)) {
                slip("misplaced", where, what + " stands where it has no meaning",
                     "write START_SIMULATION before the machines, and END_SIMULATION behind them");
            }
            (start ? started_ : ended_) = true;
            return true;
        }
        if (what == "BEGIN_ESM") {
            return begin_machine();
        }
        if (what == "END_ESM") {
            if (inside_ < 0) {
                slip("misplaced", where, "no machine is open here", "remove it");
            }
            inside_ = -1;
            element_ = "script";
            return true;
        }
        return part_of_machine(what, where);
    }

    Machine& machine(const Word& name) {
        for (Machine& m : script_.machines) {
            if (m.name.text == name.text) {
                return m;
            }
        }
        script_.machines.push_back({.name = name});
        return script_.machines.back();
    }

    bool define_machine() {
        constexpr std::string_view kForm = "DEF_ESM(NAME, \"first state\")";
        if (!want('(', kForm)) {
            return false;
        }
        const auto name = word(Sort::kWord, kForm);
        if (!name || !want(',', kForm)) {
            return false;
        }
        const auto initial = word(Sort::kText, kForm);
        if (!initial || !want(')', kForm)) {
            return false;
        }
        Machine& m = machine(*name);
        if (m.defined) {
            error("name-twice", name->span, "there is already a machine " + name->text,
                  "give one of them another name");
            return true;
        }
        m.defined = true;
        m.initial = *initial;
        return true;
    }

    bool begin_machine() {
        const auto name = named("BEGIN_ESM(NAME)");
        if (!name) {
            return false;
        }
        if (inside_ >= 0) {
            slip("end-missing", name->span, "the machine before has no END_ESM",
                 "write END_ESM before this line");
        }
        const Machine* known = &machine(*name);
        if (!known->defined) {
            std::vector<std::string> names;
            for (const Machine& m : script_.machines) {
                if (m.defined) {
                    names.push_back(m.name.text);
                }
            }
            const std::string_view nearest = nearest_name(name->text, names);
            error("unknown-name", name->span, "the machine " + name->text + " has no first state",
                  nearest.empty() ? "write DEF_ESM(" + name->text + ", \"STATE\") above"
                                  : "did you mean " + std::string(nearest) + "?");
        } else if (known->begun) {
            error("name-twice", name->span, "the machine " + name->text + " is written twice",
                  "give one of them another name");
        }
        inside_ = known - script_.machines.data();
        script_.machines[static_cast<std::size_t>(inside_)].begun = true;
        element_ = "machine " + name->text;
        return true;
    }

    bool part_of_machine(const std::string& what, lang::Span where) {
        if (inside_ < 0) {
            error("misplaced", where, what + " stands outside of every machine",
                  "put it between BEGIN_ESM(NAME) and END_ESM");
            return false;
        }
        if (what == "ACTION") {
            return action(where);
        }
        const auto name = named(what + "(NAME)");
        if (!name) {
            return false;
        }
        Machine& m = script_.machines[static_cast<std::size_t>(inside_)];
        (what == "CHANNEL" ? m.channels : m.events).push_back(*name);
        return true;
    }

    bool action(lang::Span where) {
        constexpr std::string_view kForm =
            "ACTION(MACHINE, \"from\", MATCH(CHANNEL, \"message\"), NO_TASK, \"to\")";
        Action a;
        if (!want('(', kForm)) {
            return false;
        }
        const auto owner = word(Sort::kWord, kForm);
        if (!owner || !want(',', kForm)) {
            return false;
        }
        const auto from = word(Sort::kText, kForm);
        if (!from || !want(',', kForm)) {
            return false;
        }
        a.from = *from;
        if (!condition(a, kForm) || !want(',', kForm) || !task(a, kForm) || !want(',', kForm)) {
            return false;
        }
        const auto to = word(Sort::kText, kForm);
        if (!to || !want(')', kForm)) {
            return false;
        }
        a.to = *to;
        a.span = {where.begin, tokens_[at_ - 1].span.end, file_};
        Machine& m = script_.machines[static_cast<std::size_t>(inside_)];
        if (owner->text != m.name.text) {
            slip("other-machine", owner->span,
                 "this action stands in " + m.name.text + ", and is taken as one of it",
                 "write " + m.name.text + ", or move the line");
        }
        m.actions.push_back(std::move(a));
        return true;
    }

    bool condition(Action& a, std::string_view form) {
        if (token().sort == Sort::kWord && token().text == "TRUE") {
            ++at_;
            return true;
        }
        if (token().sort == Sort::kWord && token().text == "MATCH") {
            ++at_;
            a.when = When::kMatch;
            if (!want('(', form)) {
                return false;
            }
            const auto channel = word(Sort::kWord, form);
            if (!channel || !want(',', form)) {
                return false;
            }
            const auto message = word(Sort::kText, form);
            if (!message || !want(')', form)) {
                return false;
            }
            a.subject = *channel;
            a.message = *message;
            return true;
        }
        a.when = When::kEvent;
        const auto event = word(Sort::kWord, form);
        a.subject = event.value_or(Word{});
        return event.has_value();
    }

    bool task(Action& a, std::string_view form) {
        if (token().sort == Sort::kWord && token().text == "NO_TASK") {
            ++at_;
            return true;
        }
        const auto target = word(Sort::kWord, form);
        if (!target) {
            return false;
        }
        a.target = *target;
        if (symbol('(')) {
            a.task = Task::kCall;
            if (symbol(')')) {
                return true;
            }
            error("too-many-arguments", token().span,
                  "external functions are called without "
                  "arguments",
                  "write " + target->text + "(), and bind " + target->text +
                      " to a movement with its arguments");
            return false;
        }
        if (!symbol('=')) {
            error("syntax", token().span, "neither a call nor a message for a channel",
                  "write " + target->text + "() or " + target->text + "=\"MESSAGE\"");
            return false;
        }
        // A channel gets a text, or the present state of a machine: CL="AL", ML=LEFT_LEG.
        a.task = token().sort == Sort::kWord ? Task::kSendState : Task::kSend;
        const auto sent = word(token().sort == Sort::kWord ? Sort::kWord : Sort::kText, form);
        a.sent = sent.value_or(Word{});
        return sent.has_value();
    }

    // What the whole script must have.
    void finish() {
        element_ = "script";
        const lang::Span end = span(text_.size(), text_.size());
        const lang::Span begin = span(0, std::min<std::size_t>(text_.size(), 1));
        if (inside_ >= 0) {
            slip("end-missing", end, "the last machine has no END_ESM", "write END_ESM");
        }
        if (!started_ && !script_.machines.empty()) {
            slip("end-missing", begin, "there is no START_SIMULATION",
                 "write START_SIMULATION before the machines");
        }
        if (started_ && !ended_) {
            slip("end-missing", end, "there is no END_SIMULATION; is the file whole?",
                 "write END_SIMULATION");
        }
        if (script_.machines.empty()) {
            error("no-machine", begin, "this script defines no machine",
                  "write DEF_ESM(NAME, \"first state\")");
        }
        if (script_.interval.end == 0) {
            error("missing-statement", begin, "the script does not say which time it is about",
                  "write TIME_INTERVAL(0., 11.)");
        }
        if (script_.sampled.end == 0) {
            error("missing-statement", begin, "the script does not say how often it is looked at",
                  "write SAMPLES(12)");
        }
    }

    lang::Parsed& out_;
    std::uint32_t file_;
    const std::string& text_;
    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    Script script_;
    std::ptrdiff_t inside_ = -1;  // the machine that is open
    bool started_ = false, ended_ = false;
    std::string element_ = "script";
};

}  // namespace

void tell(lang::Parsed& out, Severity severity, std::string code, lang::Span where,
          std::string element, std::string message, std::string remedy) {
    if (out.diagnostics.size() < kMaxMessages) {
        out.diagnostics.push_back({severity, std::move(code), out.file.where(where),
                                   std::move(element), std::move(message), std::move(remedy)});
    }
}

Script parse(lang::Parsed& out, std::uint32_t file) { return Parser(out, file).run(); }

}  // namespace puppetri::notation::tookima
