// SPDX-License-Identifier: MIT
// Changing a file as an author would: some text here replaced, a statement there added, every
// comment and every other byte as it was. Editors, the studio and repairs propose edits; they are
// applied together or not at all.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::lang {

// Replaces `where` by `text`. An empty stretch inserts.
struct Edit {
    Span where;
    std::string text;
    bool operator==(const Edit&) const = default;
};

// Replaces a node by new source text, comments inside it included; those beside it stay.
Edit replace(Span node, std::string text);

// Puts a statement on a line of its own after the given one (whose end of line comment stays with
// it), indented alike.
Edit insert_after(const File& file, Span statement, std::string_view new_statement);

// Puts a statement before the closing brace of a net, a cast or another block in braces. `block` is
// the node's span. Needs   a block that ends with `}`.
Edit append_to_block(const File& file, Span block, std::string_view new_statement);

// Adds a clause to the end of a statement, before its comment: ` priority 2`.
Edit add_clause(const File& file, Span statement, std::string_view clause);

// Removes a statement with its line and the comments on it; the lines above stay.
Edit remove_statement(const File& file, Span statement);

// Gives   the new text, formatted no further.
// Fails   when edits overlap or lie outside the file, or when the result does not parse.
Checked<std::string> apply(const File& file, std::span<const Edit> edits);

}  // namespace puppetri::lang
