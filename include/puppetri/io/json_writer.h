// SPDX-License-Identifier: MIT
// Writes JSON straight into a string: members in the order of the calls, numbers so that reading
// them back gives the same bits, no tree in between. It closes what it opened and puts the commas;
// the rest is the caller's.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace puppetri::io {

class JsonWriter {
 public:
    JsonWriter& begin_object();
    JsonWriter& end_object();
    JsonWriter& begin_array();
    JsonWriter& end_array();
    // The name of the next value. Needs an open object.
    JsonWriter& key(std::string_view name);

    JsonWriter& string(std::string_view text);  // invalid UTF-8 becomes U+FFFD
    JsonWriter& integer(std::int64_t value);
    JsonWriter& number(
        double value);  // shortest that reads back the same; infinities and NaN become null
    JsonWriter& number(float value);
    JsonWriter& boolean(bool value);

    JsonWriter& member(std::string_view name, std::string_view text) {
        return key(name).string(text);
    }
    JsonWriter& member(std::string_view name, const char* text) { return key(name).string(text); }
    JsonWriter& member(std::string_view name, double value) { return key(name).number(value); }
    JsonWriter& member(std::string_view name, int value) { return key(name).integer(value); }
    JsonWriter& member(std::string_view name, std::int64_t value) {
        return key(name).integer(value);
    }
    JsonWriter& member(std::string_view name, bool value) { return key(name).boolean(value); }

    const std::string& text() const { return text_; }
    std::string take() { return std::move(text_); }

 private:
    void separate();

    std::string text_;
    bool first_ = true;       // nothing yet in the innermost object or array
    bool after_key_ = false;  // the next value belongs to a name
};

}  // namespace puppetri::io
