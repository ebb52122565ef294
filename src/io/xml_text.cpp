// SPDX-License-Identifier: MIT
#include "xml_text.h"

#include <algorithm>
#include <limits>

#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

// What the XML declaration says, in lower case; "utf-8" if nothing.
std::string declared_encoding(std::string_view text) {
    const std::size_t end = text.substr(0, 200).find("?>");
    if (text.substr(0, 5) != "<?xml" || end == std::string_view::npos) {
        return "utf-8";
    }
    const std::string_view declaration = text.substr(0, end);
    std::size_t at = declaration.find("encoding");
    if (at == std::string_view::npos) {
        return "utf-8";
    }
    at = declaration.find_first_of("\"'", at);
    const std::size_t close =
        at == std::string_view::npos ? at : declaration.find(declaration[at], at + 1);
    if (close == std::string_view::npos) {
        return "utf-8";
    }
    std::string name(declaration.substr(at + 1, close - at - 1));
    for (char& c : name) {
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    }
    return name;
}

std::string from_latin1(std::string_view text) {
    std::string out;
    out.reserve(text.size() + text.size() / 16);
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            out += c;
        } else {
            out += static_cast<char>(0xC0 | (byte >> 6));
            out += static_cast<char>(0x80 | (byte & 0x3F));
        }
    }
    return out;
}

class StringWriter final : public pugi::xml_writer {
 public:
    void write(const void* data, std::size_t size) override {
        text.append(static_cast<const char*>(data), size);
    }
    std::string text;
};

}  // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string_view local_name(pugi::xml_node node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child(pugi::xml_node of, std::string_view name) {
    for (const pugi::xml_node c : of.children()) {
        if (c.type() == pugi::node_element && local_name(c) == name) {
            return c;
        }
    }
    return {};
}

std::vector<pugi::xml_node> elements(pugi::xml_node of) {
    std::vector<pugi::xml_node> out;
    for (const pugi::xml_node c : of.children()) {
        if (c.type() == pugi::node_element) {
            out.push_back(c);
        }
    }
    return out;
}

std::string text_of(pugi::xml_node node) {
    std::string out;
    for (const pugi::xml_node c : node.children()) {
        if (c.type() == pugi::node_pcdata || c.type() == pugi::node_cdata) {
            out += c.value();
        }
    }
    return std::string(trimmed(out));
}

std::string raw(pugi::xml_node node) {
    StringWriter writer;
    node.print(writer, "", pugi::format_raw, pugi::encoding_utf8);
    return std::move(writer.text);
}

ParsedInteger parse_integer(std::string_view text) {
    text = trimmed(text);
    bool negative = false;
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
        negative = text[0] == '-';
        text.remove_prefix(1);
    }
    if (text.empty()) {
        return {};
    }
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    std::int64_t value = 0;
    bool too_large = false;
    for (const char c : text) {
        if (c < '0' || c > '9') {
            return {};
        }
        const int digit = c - '0';
        too_large = too_large || value > (kMost - digit) / 10;
        value = too_large ? kMost : value * 10 + digit;
    }
    return {too_large ? ParsedInteger::kTooLarge : ParsedInteger::kFine, negative ? -value : value};
}

bool XmlText::parse(std::string_view text, const std::string& path, std::uint64_t most_bytes,
                    Defects& defects) {
    path_ = path;
    const SourceSpan file{path, 0, 0, 1};
    if (text.size() > most_bytes) {
        defects.error("file-too-large", file, "",
                      "the file has more than " + std::to_string(most_bytes) + " bytes",
                      "split the model, or ask for more");
        return false;
    }
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        text.remove_prefix(3);
    }
    if (text.substr(0, 2) == "\xFE\xFF" || text.substr(0, 2) == "\xFF\xFE") {
        defects.error("bad-encoding", file, "", "the file is written in UTF-16",
                      "save it as UTF-8");
        return false;
    }
    const std::string encoding = declared_encoding(text);
    if (encoding == "iso-8859-1" || encoding == "latin1" || encoding == "latin-1") {
        text_ = from_latin1(text);
    } else if (encoding == "utf-8" || encoding == "utf8" || encoding == "us-ascii" ||
               encoding == "ascii") {
        text_ = std::string(text);
    } else {
        defects.error("bad-encoding", file, "", "the encoding " + encoding + " is not read",
                      "save the file as UTF-8");
        return false;
    }
    lines_ = {0};
    for (std::size_t i = 0; i < text_.size(); ++i) {
        if (text_[i] == '\n') {
            lines_.push_back(i + 1);
        }
    }
    if (const auto invalid = find_invalid_utf8(text_)) {
        defects.error("bad-encoding", where(*invalid, 1), "", "a byte that is not UTF-8",
                      "save the file as UTF-8, or declare its encoding");
        return false;
    }
    // The parser works on a copy: `text_` stays as it was, for lines and columns.
    const pugi::xml_parse_result result =
        document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) {
        defects.error("bad-xml", where(static_cast<std::size_t>(result.offset), 1), "",
                      std::string("the file is not XML: ") + result.description(),
                      "look at the element that begins or ends here");
        return false;
    }
    return true;
}

SourceSpan XmlText::where(pugi::xml_node node) const {
    const std::ptrdiff_t offset = node.offset_debug();
    if (offset < 0) {
        return {path_, 0, 0, 1};
    }
    return where(static_cast<std::size_t>(offset),
                 static_cast<std::uint32_t>(std::string_view(node.name()).size()));
}

SourceSpan XmlText::where(std::size_t offset, std::uint32_t length) const {
    offset = std::min(offset, text_.size());
    const auto after = std::upper_bound(lines_.begin(), lines_.end(), offset);
    const std::size_t begin = *(after - 1);
    // Files on one line are common: the column is counted over the last bytes only if there are
    // more than anybody looks at.
    const std::string_view line = std::string_view(text_).substr(begin, offset - begin);
    const std::uint32_t column = line.size() > 4096 ? static_cast<std::uint32_t>(line.size() + 1)
                                                    : column_of(line, line.size());
    return {path_, static_cast<std::uint32_t>(after - lines_.begin()), column,
            std::max<std::uint32_t>(length, 1)};
}

}  // namespace puppetri::io
