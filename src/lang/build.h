// SPDX-License-Identifier: MIT
// From the flat nodes of one statement to the syntax tree. What a PEG cannot say (a clause given
// twice, a number that fits in no integer, `memory` without `after`) is found here.
#pragma once
#include <string>

#include "grammar.h"
#include "report.h"

namespace puppetri::lang {

class Builder {
 public:
    Builder(std::span<const Token> tokens, const Reading& reading, Report& report)
        : tokens_(tokens), nodes_(reading.nodes), report_(report) {}

    // What the enclosing block is, for messages: "net player".
    std::string element;

    Place place(std::uint32_t node);
    Transition transition(std::uint32_t node);
    State state(std::uint32_t node);
    Channel channel(std::uint32_t node);
    Data data(std::uint32_t node);
    Enumeration enumeration(std::uint32_t node);  // without its values
    TokenType token_type(std::uint32_t node);
    Event event(std::uint32_t node);
    EventFile event_file(std::uint32_t node);
    Use use(std::uint32_t node);
    Rule rule(std::uint32_t node);
    Question question(std::uint32_t node);
    Measure measure(std::uint32_t node);
    For loop(std::uint32_t node);  // this and the following without their bodies
    Net net(std::uint32_t node);
    Block block(std::uint32_t node);
    Import import(std::uint32_t node);
    void header(std::uint32_t node, Header& out);
    Property property(std::uint32_t node);
    CastMember member(std::uint32_t node);
    Expr formula(std::uint32_t node);
    Name enum_value(std::uint32_t node);

    Span span(std::uint32_t node) const;

 private:
    // The children of a node, in order.
    struct Children {
        const std::vector<Node>& nodes;
        std::uint32_t first, last;
        struct Iterator {
            const std::vector<Node>& nodes;
            std::uint32_t at;
            std::uint32_t operator*() const { return at; }
            Iterator& operator++() {
                at = nodes[at].next;
                return *this;
            }
            bool operator!=(const Iterator& other) const { return at != other.at; }
        };
        Iterator begin() const { return {nodes, first}; }
        Iterator end() const { return {nodes, last}; }
    };
    Children children(std::uint32_t node) const { return {nodes_, node + 1, nodes_[node].next}; }
    NodeKind kind(std::uint32_t node) const { return nodes_[node].kind; }
    const Token& first(std::uint32_t node) const { return tokens_[nodes_[node].begin]; }
    const Token& token(std::uint32_t node, std::uint32_t index) const {
        return tokens_[nodes_[node].begin + index];
    }
    // Whether the node has, outside of its children, a token of this kind.
    bool has_token(std::uint32_t node, Kind kind) const;
    std::uint32_t child(std::uint32_t node, NodeKind kind) const;  // the first of its kind, or 0
    std::string_view text(const Token& token) const;
    Span span(const Token& token) const { return {token.begin, token.end, report_.number()}; }

    std::string quoted(const Token& token);
    Caption caption(std::uint32_t parent);
    Name name(std::uint32_t node);
    Path path(std::uint32_t node);
    Path child_path(std::uint32_t parent) { return path(child(parent, NodeKind::kPath)); }
    Expr child_expr(std::uint32_t parent) { return expr(child(parent, NodeKind::kExpr)); }

    // An expression and how deep its tree is.
    struct Deep {
        Expr expr;
        std::uint32_t depth = 1;
    };
    class Climber;
    Expr expr(std::uint32_t node);
    Deep deep_expr(std::uint32_t node);
    Deep operand(std::uint32_t node);
    Deep several(std::uint32_t node, ExprKind kind);
    void number(std::uint32_t node, Expr& out);
    void unit(std::uint32_t parent, Expr& out);
    // Raises depth to that of the deepest argument and one more.
    std::vector<Argument> arguments(std::uint32_t node, std::uint32_t& depth);

    Parameter parameter(std::uint32_t node);
    std::vector<Parameter> parameters(std::uint32_t parent);
    Binding binding(std::uint32_t node);
    std::vector<Moment> moments(std::uint32_t node);
    Arc arc(std::uint32_t node, ArcKind kind);
    void place_clause(std::uint32_t node, Place& out);
    void transition_clause(std::uint32_t node, Transition& out);
    Duration duration(std::uint32_t node);
    std::vector<InitialTokens> initial_tokens(std::uint32_t node);
    void header_clause(std::uint32_t node, Header& out);

    // True when this clause comes for the first time; reports it otherwise.
    bool once(bool& given, std::uint32_t node);

    std::span<const Token> tokens_;
    const std::vector<Node>& nodes_;
    Report& report_;
};

}  // namespace puppetri::lang
