// SPDX-License-Identifier: MIT
// Reading one line of a block, `NAME VALUE VALUE ...`, from left to right. Words with a meaning are
// values like others until a notation asks for them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/lang/syntax.h"
#include "puppetri/notation/notation.h"

namespace puppetri::notation {

// Where a lowering tells its defects.
class Teller {
 public:
    Teller(const lang::Block& block, const lang::File& file, Lowered& out)
        : Teller(block.kind.text + " " + block.name.text, file, out) {}
    Teller(std::string element, const lang::File& file, Lowered& out)
        : element_(std::move(element)), file_(file), out_(out) {}

    void error(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(Severity::kError, std::move(code), where, std::move(message), std::move(remedy));
    }
    void warn(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(Severity::kWarning, std::move(code), where, std::move(message), std::move(remedy));
    }

 private:
    void tell(Severity severity, std::string code, lang::Span where, std::string message,
              std::string remedy);

    std::string element_;
    const lang::File& file_;
    Lowered& out_;
};

// The name of a lone word; empty where the value is anything else.
std::string_view word_of(const lang::Expr& e);

// The names in `A or B`, joined by this operator; false where it is anything else.
bool paths_of(const lang::Expr& e, lang::Op joined_by, std::vector<lang::Path>& out);

// A line `LABEL "caption": WORD VALUES`, or `WORD VALUES` without a label. The word is empty where
// none follows the label.
struct Labelled {
    const lang::Property* property = nullptr;
    std::string word, label;
    lang::Caption caption;
    std::size_t first = 0;  // the value after the word
};
Labelled read_labelled(const lang::Property& property);

// Whether the line is `NAME -> ...`.
bool has_arrow(const lang::Property& property);

class Line {
 public:
    // `first`: the value to begin with, where a label stands before.
    Line(const lang::Property& property, Teller& teller, std::size_t first = 0)
        : property_(property), teller_(teller), at_(first) {}

    // What the line begins with.
    const lang::Path& name() const { return property_.name; }
    lang::Span span() const { return property_.span; }

    bool done() const { return at_ >= property_.values.size(); }
    // Takes the next value if it is this word, or this symbol (`->`, `:`, `=`, `:=`).
    bool word(std::string_view text);
    bool symbol(std::string_view text);
    // The next value, which stays where it is; null at the end.
    const lang::Expr* peek() const { return next(); }
    // Takes a text in quotes; empty when the next value is none.
    lang::Caption caption();
    // Takes a value; tells that `wanted` is missing and gives null where there is none.
    const lang::Expr* value(std::string_view wanted);
    // Takes this word and the value behind it, into `to`; gives whether the word was there.
    bool clause(std::string_view text, std::string_view wanted, lang::Expr& to);
    // The same of `takes TIME`, as places have it: also `takes auto` and `takes open`.
    bool takes(lang::Duration& to);
    // Takes a value that is a name or a path.
    const lang::Path* path(std::string_view wanted);
    // Tells what is left over, with the forms that the line may have.
    void finish(std::string_view forms);

 private:
    const lang::Expr* next() const { return done() ? nullptr : &property_.values[at_]; }
    void missing(std::string_view wanted);

    const lang::Property& property_;
    Teller& teller_;
    std::size_t at_;
};

// Reads the lines of a block that are wanted, in their order: notations read lines of one kind
// after another.
template <class Wanted, class Read>
void each_line(const lang::Block& block, Teller& teller, const Wanted& wanted, const Read& read) {
    for (const lang::Property& p : block.properties) {
        if (wanted(p)) {
            Line line(p, teller);
            read(line);
        }
    }
}

// The rest of a line `data NAME: TYPE = VALUE`.
// Gives   false where it is broken, and has told so.
bool read_data(Line& line, lang::Data& made);

// Tells where a line of the block begins with more than one name, or has lines of its own in
// braces; gives whether none does.
bool has_plain_lines(const lang::Block& block, Teller& teller);

}  // namespace puppetri::notation
