// SPDX-License-Identifier: MIT
// XML with places: a parsed text that knows the line and column of each of its elements. Names are
// compared without their namespace's prefix.
#pragma once
#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "defects.h"
#include "puppetri/base/diagnostic.h"

namespace puppetri::io {

// "place" of <place> and of <pnml:place>.
std::string_view local_name(pugi::xml_node node);
// The first child element of that local name, or an empty node.
pugi::xml_node child(pugi::xml_node of, std::string_view name);
// All child elements; text and comments between them are left out.
std::vector<pugi::xml_node> elements(pugi::xml_node of);
// All text directly inside, without the space around it.
std::string text_of(pugi::xml_node node);
// The element as it was written, but for space between elements.
std::string raw(pugi::xml_node node);
std::string_view trimmed(std::string_view text);

// The whole text as an integer.
struct ParsedInteger {
    enum Kind { kFine, kNoNumber, kTooLarge } kind = kNoNumber;
    std::int64_t value = 0;
};
ParsedInteger parse_integer(std::string_view text);

class XmlText {
 public:
    // Converts from ISO-8859-1 where the text says so.
    // Gives  false after telling why: "file-too-large", "bad-encoding", "bad-xml".
    bool parse(std::string_view text, const std::string& path, std::uint64_t most_bytes,
               Defects& defects);
    pugi::xml_node root() const { return document_.document_element(); }
    SourceSpan where(pugi::xml_node node) const;
    const std::string& path() const { return path_; }

 private:
    SourceSpan where(std::size_t offset, std::uint32_t length) const;

    pugi::xml_document document_;
    std::string path_, text_;
    std::vector<std::size_t> lines_;  // where each begins
};

}  // namespace puppetri::io
