// SPDX-License-Identifier: MIT
// What the algorithm of SCXML can know of a chart beforehand: which transitions an atomic state may
// ask for, what each leaves and enters, and which of them exclude each other. What depends on
// histories is a formula over their data.
#pragma once
#include <array>
#include <compare>
#include <map>
#include <string>
#include <vector>

#include "chart.h"
#include "make.h"

namespace puppetri::notation::chart {

// A formula that is often true or false for good.
struct Truth {
    enum Known : std::uint8_t { kNo, kYes, kOpen } known = kNo;
    lang::Expr expr;
};

inline Truth yes() { return {Truth::kYes, {}}; }
inline Truth open(lang::Expr e) { return {Truth::kOpen, std::move(e)}; }

inline Truth either(const Truth& a, const Truth& b) {
    if (a.known == Truth::kYes || b.known == Truth::kYes) {
        return yes();
    }
    if (a.known == Truth::kNo || b.known == Truth::kNo) {
        return a.known == Truth::kNo ? b : a;
    }
    return open(make_binary(lang::Op::kOr, a.expr, b.expr));
}

inline Truth both(const Truth& a, const Truth& b) {
    if (a.known == Truth::kNo || b.known == Truth::kNo) {
        return {};
    }
    if (a.known == Truth::kYes || b.known == Truth::kYes) {
        return a.known == Truth::kYes ? b : a;
    }
    return open(make_binary(lang::Op::kAnd, a.expr, b.expr));
}

inline Truth opposite(const Truth& a) {
    return a.known == Truth::kNo    ? yes()
           : a.known == Truth::kYes ? Truth{}
                                    : open(make_unary(lang::Op::kNot, a.expr));
}

// Formulas over histories as decision diagrams (R. E. Bryant, "Graph-Based Algorithms for Boolean
// Function Manipulation", 1986): equal ones are one, however they came about. 0 is false, 1 true.
class Diagrams {
 public:
    using Id = std::uint32_t;
    Id variable(std::string name);
    Id either(Id a, Id b) { return choose(a, 1, b); }
    Id both(Id a, Id b) { return choose(a, b, 0); }
    Id opposite(Id a) { return choose(a, 0, 1); }
    Truth truth(Id a, lang::Span where) const;
    std::size_t size() const { return nodes_.size(); }
    // How large each becomes as a formula, in which nothing is shared.
    std::vector<double> sizes() const;

 private:
    struct Node {
        std::uint32_t variable;
        Id low, high;
        auto operator<=>(const Node&) const = default;
    };
    static constexpr std::uint32_t kLeaf = ~std::uint32_t{0};
    Id make(const Node& n);
    Id choose(Id a, Id b, Id c);  // a ? b : c

    std::vector<std::string> names_;
    std::vector<Node> nodes_ = {{kLeaf, 0, 0}, {kLeaf, 1, 1}};
    std::map<Node, Id> known_;
    std::map<std::array<Id, 3>, Id> chosen_;
};

// What a transition enters, state by state.
struct Entry {
    std::vector<Diagrams::Id> states, defaults, histories;
};

// Number 0 is the transition to where the chart begins.
struct Move {
    int source = 0, domain = -1;  // -1: no targets
    bool domain_known = true;
    std::vector<int> targets;
    const Steps* steps = nullptr;
    const Transition* written = nullptr;
    std::vector<std::size_t> picked_by;  // atomic states, as positions in atoms_
    std::vector<int> conflicts;
    Entry entry;
};

class Plan {
 public:
    explicit Plan(const Chart& chart);

    std::vector<int> atoms;  // atomic states, in document order
    std::vector<Move> moves;
    std::vector<std::vector<int>> candidates;  // by atomic state, in the order of preference
    std::vector<lang::Span> vague;             // see make_net
    Diagrams diagrams;                         // of the entries
    bool too_large = false;

    // States that a history may hold.
    std::vector<int> stored(const State& history) const;
    // By state: some run may enter it, as far as transitions lead there, whatever their conditions.
    std::vector<bool> entered() const;
    // More than one atomic state may ask for it at once, or for another that excludes it: then it
    // must be remembered which did.
    bool counted(int move) const;

    // Data of a history: whether it holds state s, and whether it holds anything.
    std::string was_name(int history, int s) const;
    std::string known_name(int history) const;

 private:
    using Ids = std::vector<int>;
    const State& at(int s) const { return chart_.at(s); }
    bool orthogonal(int a, int b) const;
    bool orthogonal(const Move& a, const Move& b) const;
    Ids effective(const Ids& targets) const;
    int domain(const Move& m, const Ids& targets) const;
    void prepare();
    bool conflict(int t, int u) const;
    Diagrams::Id known(int history) { return diagrams.variable(known_name(history)); }
    Diagrams::Id was(int history, int s) { return diagrams.variable(was_name(history, s)); }
    void compute_entry(Move& m);
    void add_inside(Entry& e, int s, Diagrams::Id when);
    void regions(Entry& e, int s, Diagrams::Id when);
    void add_above(Entry& e, int s, int above, Diagrams::Id when);

    const Chart& chart_;
    std::size_t work_ = 0;
};

}  // namespace puppetri::notation::chart
