// SPDX-License-Identifier: MIT
// Files in other notations than the language, known by their endings. Each is read into a syntax
// tree, as if somebody had written a .pup file that means the same: `import NAME from "x.ending"`
// takes its nets, and a program plays it as the main file if it is a scene.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "puppetri/lang/parse.h"

namespace puppetri::notation {

struct ForeignFormat {
    std::string_view ending;   // with the dot, in lower case: ".tuples"
    std::string_view summary;  // one line for lists of formats
    // `out` has name, text and lines of the file; `file` is the number of its spans. Adds the body,
    // perhaps a header, and the diagnostics; with an error the tree is not elaborated.
    void (*read)(lang::Parsed& out, std::uint32_t file);
    // What the lines of `use "x.ending" as NAME { NAME: VALUE }` come to beside it: adds to the
    // body that has the use, and takes the arguments that are no parameters of the file's net.
    // Null: all of them are.
    void (*bind)(lang::Body& body, lang::Use& use, const lang::Net& net, const lang::File& file,
                 Diagnostics& diagnostics) = nullptr;
};

// All of them, in alphabetical order of their endings.
std::span<const ForeignFormat> foreign_formats();

// Null where the path has another ending: then the file is in the language.
const ForeignFormat* find_foreign_format(std::string_view path);

// By its ending: a file that parse() reads, in the language or in another notation.
bool is_scene_file(std::string_view path);

// By the ending of `path`: lang::parse or the reader of the format.
lang::Parsed parse(std::string_view text, std::string_view path, std::uint32_t file);

}  // namespace puppetri::notation
