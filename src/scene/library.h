// SPDX-License-Identifier: MIT
// All files of a scene: the one that was asked for (number 0) and what it imports, each parsed
// once, and which names of nets and types each can see.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/scene/file_source.h"

namespace puppetri::scene {

// Something that a file declares and others may import. One pointer is set, or none: then it is
// missing, and that has been told.
struct Declaration {
    std::uint32_t file = 0;  // where it is declared
    const lang::Net* net = nullptr;
    const lang::Enumeration* enumeration = nullptr;
    const lang::TokenType* token_type = nullptr;
    const lang::Block* block = nullptr;  // that defines a movement
};

struct Library {
    FileSource* source = nullptr;   // what it was read from: gives characters and clips as well
    std::deque<lang::File> files;   // by number, as in lang::Span::file; addresses stay
    std::deque<lang::Net> lowered;  // what blocks of notations stand for
    std::vector<const lang::Block*> lowered_from;             // these blocks, by the same number
    std::vector<std::map<std::string, Declaration>> visible;  // by file
    std::vector<std::vector<std::uint32_t>>
        casts;  // by file: the files of which it imports the whole cast
    std::vector<std::map<std::string, std::string>>
        texts;  // by file: of its event files, by the path as written
    std::vector<motion::OwnMovementPtr> movements;  // of the embedding program
    Diagnostics diagnostics;                        // of reading and parsing
    bool readable = true;  // all files are there and have been parsed without errors

    // The block of a notation that a net was made from; null for any other.
    const lang::Block* block_of(const lang::Net* net) const;
    // The same, if it is a block `equations`.
    const lang::Block* equations_of(const lang::Net* net) const;

    SourceSpan where(lang::Span span) const {
        return span.file < files.size() ? files[span.file].where(span) : SourceSpan{};
    }
};

// Kinds of block that define movements.
bool is_movement_kind(std::string_view kind);

// Reads and parses everything that `path` needs. Files that import each other are fine; nets that
// contain each other are found where they are instantiated.
Library load_library(FileSource& source, const std::string& path);

}  // namespace puppetri::scene
