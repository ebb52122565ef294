// SPDX-License-Identifier: MIT
// Linda's tuple spaces (D. Gelernter, "Generative Communication in Linda", ACM TOPLAS 7(1), 1985):
// what is declared, and what programs do with it. A kind of tuples is a place whose tokens have its
// fields. A process is a token that walks through the places of its program and carries its
// variables. What must be known before the run, such as whom a movement moves, is no variable: of a
// program there is a copy, an *instance*, for each such choice, and for each kind of tuple that its
// processes become.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "line.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

struct LindaField {
    std::string name;
    lang::Expr type;
};

// What may be taken by an `in`, read by an `rd`, put by an `out`: per field a constant, or nothing.
struct LindaPattern {
    std::size_t kind;
    std::vector<std::string> constants;  // empty: any value
    bool removes = false;                // `in` and `inp`
    bool for_ever = false;               // in a loop without end
    lang::Span span;
};

// A kind of tuples, or a program with its parameters.
struct LindaKind {
    std::string name;
    std::vector<LindaField> fields;
    const lang::Property* property = nullptr;
    // Tuples: who is taken first where several fit, and those that are there at the start.
    lang::Discipline discipline = lang::Discipline::kAny;
    lang::Expr key;
    std::vector<lang::InitialTokens> tokens;
    bool used = false;  // such a process is begun somewhere
};

// What a process becomes when it ends: a tuple in which its value is one of the fields.
struct LindaBecomes {
    std::size_t kind, field;
};

struct LindaInstance {
    std::size_t program;
    std::string name;                         // of what is made of it
    std::map<std::string, lang::Expr> fixed;  // parameters that are known before the run
    std::optional<LindaBecomes> becomes;
    std::vector<LindaField> carried;  // variables at the start, fields of its tuple among them
    std::vector<lang::InitialTokens> tokens;
    bool never_ends = false;
};

// An eval: who begins whom, and how often.
struct LindaBirth {
    std::size_t parent, child;  // instances
    bool always = false;        // no way through the program avoids it
    bool at_once = false;       // some way to it takes no time
    bool for_ever = false;      // in a loop without end
    lang::Span span;
};

class Linda {
 public:
    Linda(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower();

 private:
    friend class LindaProgram;

    // -- linda.cpp: declarations, what the whole space comes to
    void declare(const lang::Property& p);
    void initial(const lang::Property& p);
    void make_tuples();
    void check_patterns();
    void check_births();
    void make_ended();
    // Of a space that ends: the ways in and out where a place runs it.
    void make_ways();
    std::optional<std::size_t> find(const std::vector<LindaKind>& list, const lang::Expr& e,
                                    const char* what);
    // The arguments in the order of the fields; empty where a defect was told.
    std::vector<const lang::Expr*> match(const LindaKind& kind, const lang::Expr& call);
    // The instance of this program, made where there is none yet. `values` are of its fixed
    // parameters.
    std::size_t instance(std::size_t program, std::map<std::string, lang::Expr> fixed,
                         std::optional<LindaBecomes> becomes);
    // Tells a value that the field can never have.
    void check_value(const LindaField& field, const lang::Expr& value);
    std::string constant(const lang::Expr& value) const;
    std::string unused(const std::string& wanted);
    // Once for each place of the text: a program may have many instances.
    void error(const char* code, lang::Span where, std::string message, std::string remedy);
    void warn(const char* code, lang::Span where, std::string message, std::string remedy);
    // The token's fields as attributes; nothing where it has none.
    static void attributes(lang::Place& place, const std::vector<LindaField>& fields);

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    std::vector<LindaKind> tuples_, programs_;
    std::set<std::string> names_ = {"ended"};
    bool ends_ = false;  // with its last process
    std::set<std::pair<std::uint32_t, std::string>> told_;
    // What the programs come to.
    struct Made {
        std::vector<LindaInstance> instances;
        std::map<std::string, std::size_t> keys;  // of instances
        std::vector<LindaPattern> puts, takes;
        std::vector<LindaBirth> births;
        std::vector<std::string> places;
    } made_;
};

// Writes the net of one instance.
class LindaProgram {
 public:
    LindaProgram(Linda& space, std::size_t number);
    void write();

 private:
    using Variables = std::vector<LindaField>;  // in scope, outer ones first
    // A transition whose way on is not known yet, and values that it gives to variables.
    struct Open {
        std::size_t transition = 0;
        std::map<std::string, lang::Expr> values;
    };
    // One line, read; with the `else` behind it.
    struct Step {
        const Labelled& head;
        const lang::Property* other;
        Line& line;
        lang::Span span;
    };

    // Each gives whether no way through it takes no time.
    bool lines(const std::vector<lang::Property>& list);
    bool line(const lang::Property& p, const lang::Property* other);
    bool give(const Step& s);
    bool begin(const Step& s);
    bool take(const Step& s);
    bool try_take(const Step& s);
    bool act(const Step& s);
    bool hear(const Step& s);
    bool let(const Step& s);
    bool choose(const Step& s);
    bool again(const Step& s);
    bool come_back(const Step& s);
    void check_round(lang::Span where, std::size_t puts, std::size_t takes);
    bool branches(const Step& s, Open yes, Open no, const Variables& bound);

    // -- values
    lang::Expr value(const lang::Expr& e) const;    // of a transition that left a place of ours
    lang::Expr settled(const lang::Expr& e) const;  // with what is known before the run alone
    bool varies(const lang::Expr& e) const;         // a variable is in it
    const LindaField* variable(std::string_view name) const;
    // Whether this may be the value of such a field; tells it where not.
    bool fits(const LindaField& field, const lang::Expr& e);
    // Puts a tuple: `values` in the order of its fields, null for what is not known yet.
    LindaPattern put(std::size_t kind, const std::vector<const lang::Expr*>& values,
                     lang::Span where) const;
    std::optional<std::size_t> child(const lang::Expr& call, std::optional<LindaBecomes> becomes,
                                     lang::Arc& arc);
    lang::Arc pattern(std::size_t kind, const lang::Expr& e, lang::ArcKind how, Open* open,
                      Variables& bound);
    std::optional<std::size_t> taken_kind(const Step& s, const lang::Expr*& e);
    void bring(const Variables& bound);

    // -- places and transitions
    std::string name_of(const Step& s, const std::string& wanted);
    lang::Place& enter(const std::string& name, const Step& s);
    void go_to(const std::string& name, lang::Span where);
    std::size_t leave(const std::string& name, const std::string& place, lang::Span where);

    Linda& space_;
    const std::size_t number_;
    std::string name_;
    std::map<std::string, lang::Expr> fixed_;
    std::optional<LindaBecomes> becomes_;
    Variables variables_;
    std::vector<Open> open_;
    int branches_ = 0, endless_ = 0, waits_ = 0;  // waits_: lines that last, so far
    bool slow_ = false, returned_ = false;
};

// A tuple that is put like one may be taken like the other.
bool compatible(const LindaPattern& a, const LindaPattern& b);

// A parameter that must be known before the run.
bool is_fixed(const LindaField& parameter);

// The type as far as values of one sort are comparable: "number" for whole numbers of any range.
std::string sort_of(const lang::Expr& type);

// The variable that carries a field of the tuple to come.
std::string kept(const std::string& field);

}  // namespace puppetri::notation
