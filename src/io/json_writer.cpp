// SPDX-License-Identifier: MIT
#include "puppetri/io/json_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

void append_escaped(std::string& out, std::string_view text) {
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (static_cast<unsigned char>(c) < 0x20) {
            fmt::format_to(std::back_inserter(out), "\\u{:04x}", static_cast<int>(c));
        } else {
            out += c;
        }
    }
}

template <class T>
void append_number(std::string& text, T value) {
    if (!std::isfinite(value)) {
        text += "null";
    } else if (value == std::trunc(value) && std::fabs(value) < 1e15) {
        fmt::format_to(std::back_inserter(text), "{}", static_cast<std::int64_t>(value));
    } else {
        fmt::format_to(std::back_inserter(text), "{}", value);
    }
}

}  // namespace

void JsonWriter::separate() {
    if (after_key_) {
        after_key_ = false;
    } else if (!first_) {
        text_ += ',';
    }
    first_ = false;
}

JsonWriter& JsonWriter::begin_object() {
    separate();
    text_ += '{';
    first_ = true;
    return *this;
}

JsonWriter& JsonWriter::end_object() {
    text_ += '}';
    first_ = false;
    return *this;
}

JsonWriter& JsonWriter::begin_array() {
    separate();
    text_ += '[';
    first_ = true;
    return *this;
}

JsonWriter& JsonWriter::end_array() {
    text_ += ']';
    first_ = false;
    return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
    string(name);
    text_ += ':';
    after_key_ = true;
    return *this;
}

JsonWriter& JsonWriter::string(std::string_view text) {
    separate();
    text_ += '"';
    while (const auto bad = find_invalid_utf8(text)) {
        append_escaped(text_, text.substr(0, *bad));
        text_ += "\xEF\xBF\xBD";
        text.remove_prefix(*bad + 1);
    }
    append_escaped(text_, text);
    text_ += '"';
    return *this;
}

JsonWriter& JsonWriter::integer(std::int64_t value) {
    separate();
    fmt::format_to(std::back_inserter(text_), "{}", value);
    return *this;
}

JsonWriter& JsonWriter::number(double value) {
    separate();
    append_number(text_, value);
    return *this;
}

JsonWriter& JsonWriter::number(float value) {
    separate();
    append_number(text_, value);
    return *this;
}

JsonWriter& JsonWriter::boolean(bool value) {
    separate();
    text_ += value ? "true" : "false";
    return *this;
}

}  // namespace puppetri::io
