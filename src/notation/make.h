// SPDX-License-Identifier: MIT
// Making nodes of the syntax tree: what a lowering writes instead of text. Each node gets the span
// of the line of the source that it stands for.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "puppetri/base/rational.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

lang::Name make_name(std::string text, lang::Span span);
// fork[3]
lang::Name make_name(std::string text, std::int64_t index, lang::Span span);
lang::Path make_path(std::string text, lang::Span span);
lang::Path make_path(std::vector<lang::Name> steps, lang::Span span);

lang::Expr make_number(Rational number, lang::Span span, std::string unit = "");
lang::Expr make_bool(bool value, lang::Span span);
lang::Expr make_reference(lang::Path path);
lang::Expr make_reference(std::string text, lang::Span span);
// #P
lang::Expr make_count(lang::Path place);
lang::Expr make_unary(lang::Op op, lang::Expr a);
lang::Expr make_binary(lang::Op op, lang::Expr a, lang::Expr b);
// `a and b` where one of them may be missing.
lang::Expr make_both(lang::Expr a, lang::Expr b);
// `a or b or ...`: one of these is true; nothing where there are none.
lang::Expr make_any(const std::vector<std::string>& names, lang::Span span);
// condition ? yes : no
lang::Expr make_choice(lang::Expr condition, lang::Expr yes, lang::Expr no);
lang::Expr make_call(lang::Path path, std::vector<lang::Expr> positional, lang::Span span);

lang::Arc make_arc(lang::ArcKind kind, lang::Path place, lang::Expr weight = {});
// A place without clauses, and without tokens.
lang::Place make_place(lang::Name name);
// The place starts with one token.
void give_token(lang::Place& place);
// `takes EXPR`, also `takes auto` and `takes open`, as the value of a property says it.
lang::Duration make_duration(const lang::Expr& value);
lang::Transition make_transition(lang::Name name, std::vector<lang::Path> from,
                                 std::vector<lang::Path> to);
// A place `clock` whose token is ready once every period, in the net; gives the public transition
// `step` that takes and returns it, not yet in the net.
lang::Transition make_clock(lang::Body& body, const lang::Expr& period);
lang::Binding make_assignment(lang::Path datum, lang::Expr value);

}  // namespace puppetri::notation
