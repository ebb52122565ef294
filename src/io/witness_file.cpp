// SPDX-License-Identifier: MIT
#include "puppetri/io/witness_file.h"

#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "puppetri/io/json_writer.h"

namespace puppetri::io {
namespace {

using Json = nlohmann::json;
using verdict::Witness;

constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = 256u << 20;

std::string hexadecimal(std::uint64_t x) {
    char text[16];
    const auto [end, error] = std::to_chars(text, text + sizeof text, x, 16);
    return std::string(text, end);
}

std::optional<std::uint64_t> from_text(const Json& value, int base) {
    const auto* text = value.get_ptr<const std::string*>();
    if (text == nullptr || text->empty()) {
        return std::nullopt;
    }
    std::uint64_t x = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), x, base);
    if (error != std::errc() || end != text->data() + text->size()) {
        return std::nullopt;
    }
    return x;
}

class Reader {
 public:
    explicit Reader(const std::string& filename) : filename_(filename) {}

    Checked<Witness> read(std::string_view text) {
        if (text.size() > kMostBytes) {
            fail("the file is longer than any witness");
            return Unexpected(std::move(defects_));
        }
        const Json document = Json::parse(text.begin(), text.end(), nullptr, false);
        if (document.is_discarded() || !document.is_object()) {
            fail("this is no JSON object");
            return Unexpected(std::move(defects_));
        }
        Witness w;
        if (integer(document, "version", 0, 1'000'000) != kVersion) {
            fail("its version is not " + std::to_string(kVersion));
        }
        w.rule = string(document, "rule");
        w.says = string(document, "says");
        w.net_hash = number(document, "net_hash", 16);
        w.seed = number(document, "seed", 10);
        for (const Json& choice : array(document, "choices")) {
            if (!choice.is_number_integer() ||
                (choice.is_number_unsigned() &&
                 choice.get<std::uint64_t>() >
                     static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))) {
                fail("a choice is a whole number");
                break;
            }
            w.choices.push_back(choice.get<std::int64_t>());
        }
        for (const Json& event : array(document, "events")) {
            if (bad_element(event)) {
                break;
            }
            w.events.push_back({ticks(event, "tick"), string(event, "event")});
        }
        for (const Json& step : array(document, "steps")) {
            if (bad_element(step)) {
                break;
            }
            w.steps.push_back({ticks(step, "tick"), string(step, "transition")});
        }
        w.violates_after = step_number(document, "violates_after", w);
        w.lasso_from = step_number(document, "lasso_from", w);
        w.until = ticks(document, "until_tick");
        if (!defects_.empty()) {
            return Unexpected(std::move(defects_));
        }
        return w;
    }

 private:
    void fail(std::string message) {
        if (defects_.size() < 8) {
            defects_.push_back({.code = "bad-witness",
                                .where = {.file = filename_},
                                .element = "witness",
                                .message = std::move(message),
                                .remedy = "make it again with `puppetri prove`"});
        }
    }
    bool bad_element(const Json& value) {
        if (!value.is_object()) {
            fail("an event or a step is an object");
        }
        return !defects_.empty();
    }
    const Json* member(const Json& object, const char* name) {
        const auto found = object.find(name);
        if (found == object.end()) {
            fail(std::string("there is no \"") + name + "\"");
            return nullptr;
        }
        return &*found;
    }
    std::string string(const Json& object, const char* name) {
        const Json* value = member(object, name);
        const auto* text = value == nullptr ? nullptr : value->get_ptr<const std::string*>();
        if (text == nullptr) {
            fail(std::string("\"") + name + "\" is a text");
            return {};
        }
        return *text;
    }
    std::uint64_t number(const Json& object, const char* name, int base) {
        const Json* value = member(object, name);
        const auto x = value == nullptr ? std::nullopt : from_text(*value, base);
        if (!x) {
            fail(std::string("\"") + name + "\" is a number in quotes");
        }
        return x.value_or(0);
    }
    std::int64_t integer(const Json& object, const char* name, std::int64_t low,
                         std::int64_t high) {
        const Json* value = member(object, name);
        if (value == nullptr || !value->is_number_integer() ||
            (value->is_number_unsigned() &&
             value->get<std::uint64_t>() > static_cast<std::uint64_t>(high)) ||
            value->get<std::int64_t>() < low || value->get<std::int64_t>() > high) {
            fail(std::string("\"") + name + "\" is a whole number in its range");
            return low;
        }
        return value->get<std::int64_t>();
    }
    SimTime ticks(const Json& object, const char* name) {
        return {integer(object, name, 0, std::numeric_limits<std::int64_t>::max())};
    }
    const Json& array(const Json& object, const char* name) {
        static const Json kEmpty = Json::array();
        const Json* value = member(object, name);
        if (value == nullptr || !value->is_array()) {
            fail(std::string("\"") + name + "\" is a list");
            return kEmpty;
        }
        return *value;
    }
    // A number of firings, or null.
    std::uint32_t step_number(const Json& object, const char* name, const Witness& w) {
        const Json* value = member(object, name);
        if (value != nullptr && value->is_null()) {
            return Witness::kNone;
        }
        return static_cast<std::uint32_t>(
            integer(object, name, 0, static_cast<std::int64_t>(w.steps.size())));
    }

    const std::string& filename_;
    Diagnostics defects_;
};

void step_member(JsonWriter& json, const char* name, std::uint32_t step) {
    if (step == Witness::kNone) {
        json.key(name).number(std::numeric_limits<double>::infinity());  // written as null
    } else {
        json.member(name, static_cast<std::int64_t>(step));
    }
}

}  // namespace

std::string write_witness(const Witness& w) {
    JsonWriter json;
    json.begin_object();
    json.member("version", kVersion);
    json.member("rule", w.rule);
    json.member("says", w.says);
    json.member("net_hash", hexadecimal(w.net_hash));
    json.member("seed", std::to_string(w.seed));
    json.key("choices").begin_array();
    for (const std::int64_t c : w.choices) {
        json.integer(c);
    }
    json.end_array();
    json.key("events").begin_array();
    for (const Witness::Event& e : w.events) {
        json.begin_object().member("tick", e.at.ticks).member("event", e.path).end_object();
    }
    json.end_array();
    json.key("steps").begin_array();
    for (const Witness::Step& s : w.steps) {
        json.begin_object()
            .member("tick", s.at.ticks)
            .member("transition", s.transition)
            .end_object();
    }
    json.end_array();
    step_member(json, "violates_after", w.violates_after);
    step_member(json, "lasso_from", w.lasso_from);
    json.member("until_tick", w.until.ticks);
    json.end_object();
    return json.take() + "\n";
}

Checked<Witness> read_witness(std::string_view text, const std::string& filename) {
    return Reader(filename).read(text);
}

}  // namespace puppetri::io
