// SPDX-License-Identifier: MIT
// Data, events with their schedules, attributes of tokens.
#include <algorithm>

#include "elaboration.h"
#include "puppetri/scene/events.h"

namespace puppetri::scene {

void Elaboration::complete_data() {
    for (std::size_t i = 0; i < data_.size(); ++i) {
        if (data_[i].node == nullptr) {
            continue;  // a sensor
        }
        const lang::Data& node = *data_[i].node;
        About about(*this, "data " + data_[i].path, node.span);
        std::optional<Value> low, high;
        const auto type = value_type(node.type, data_[i].scope, &low, &high);
        net::DatumDraft& out = draft().data[i];
        if (!type) {
            continue;
        }
        out.type = *type;
        out.low = low;
        out.high = high;
        if (!node.initial) {
            out.initial = low.value_or(0);
            continue;
        }
        const auto initial = expr_of(node.initial, data_[i].scope, *type);
        if (!initial) {
            continue;
        }
        if (!initial->is_literal()) {
            error("not-constant", node.initial.span,
                  "the initial value must be known before the run",
                  "use numbers and parameters only");
            continue;
        }
        out.initial = initial->literal_value();
    }
}

void Elaboration::complete_events() {
    std::vector<std::string> clocks;
    for (std::size_t i = 0; i < events_.size(); ++i) {
        if (events_[i].node == nullptr) {
            continue;
        }
        const lang::Event& node = *events_[i].node;
        const Scope& scope = events_[i].scope;
        const net::EventIndex event{static_cast<std::uint32_t>(i)};
        About about(*this, "event " + events_[i].path, node.span);
        // The inner clock of a block of a notation: time alone makes it occur.
        const bool is_clock = !node.is_public && (node.every || !node.at.empty()) &&
                              library_.block_of(instances_[scope.instance].net) != nullptr;
        if (is_clock) {
            draft().events[i].outside = false;
            clocks.push_back(events_[i].path);
        }
        for (const lang::Expr& when : node.at) {
            if (const auto t = constant_time(when, scope, "the time of an event")) {
                if (t->ticks < 0) {
                    error("negative-time", when.span, "time begins at 0", "choose a later instant");
                    continue;
                }
                draft().schedule.push_back({*t, event, std::nullopt, at(when.span)});
            }
        }
        if (!node.every) {
            continue;
        }
        const auto every = constant_time(node.every, scope, "the time between events");
        const auto from =
            node.from ? constant_time(node.from, scope, "the first time of an event") : every;
        const auto until = node.until
                               ? constant_time(node.until, scope, "the last time of an event")
                               : std::nullopt;
        if (!every || !from || (node.until && !until)) {
            continue;
        }
        if (every->ticks <= 0 || from->ticks < 0) {
            error("negative-time", node.every.span,
                  "an event that repeats needs a time above 0 between occurrences",
                  "choose a longer one");
            continue;
        }
        if (!node.until) {
            draft().schedule.push_back({*from, event, *every, at(node.every.span)});
            continue;
        }
        const SimTime last = until.value_or(SimTime{});
        constexpr std::int64_t kMost = 1'000'000;
        if ((last.ticks - from->ticks) / every->ticks >= kMost) {
            error("net-too-large", node.every.span,
                  "more than " + std::to_string(kMost) + " scheduled occurrences",
                  "leave `until` out: then it repeats for ever at no cost");
            continue;
        }
        for (SimTime t = *from; t <= last; t = t + *every) {
            draft().schedule.push_back({t, event, std::nullopt, at(node.every.span)});
        }
    }
    for (const auto& [file, scope] : event_files_) {
        About about(*this, "events from " + file->path, file->span);
        const auto& texts = library_.texts[file->span.file];
        const auto text = texts.find(file->path);
        if (text == texts.end()) {
            continue;
        }
        const std::string& up = instances_[scope.instance].path;
        // Names in the file are those of the net that the line stands in.
        std::vector<std::string> names;
        for (const net::EventDraft& e : draft().events) {
            const bool inside = (up.empty() || e.path.compare(0, up.size() + 1, up + ".") == 0) &&
                                std::find(clocks.begin(), clocks.end(), e.path) == clocks.end();
            names.push_back(!inside ? "" : up.empty() ? e.path : e.path.substr(up.size() + 1));
        }
        EventList list = parse_event_list(text->second, file->path, names);
        for (Diagnostic& d : list.diagnostics) {
            diagnostics.push_back(std::move(d));
        }
        for (const run::OutsideEvent& e : list.events) {
            draft().schedule.push_back({e.at, e.event, std::nullopt, at(file->span)});
        }
    }
}

void Elaboration::complete_attributes() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        PlaceElement& place = places_[i];
        const lang::Place& node = *place.node;
        About about(*this, "place " + place.path, node.span);
        place.attributes.kind = net::SlotKind::kAttribute;
        const std::vector<lang::Parameter>* declared = &node.attributes;
        if (!node.of_type.empty() && declared->empty()) {
            const lang::TokenType* type = nullptr;
            for (const lang::TokenType& t : instances_[place.scope.instance].body->token_types) {
                if (node.of_type.steps.size() == 1 && t.name.text == node.of_type.steps[0].text) {
                    type = &t;
                }
            }
            if (type == nullptr) {
                if (const auto d =
                        find_declaration(node.of_type, node.span.file, Wanted::kTokenType)) {
                    type = d->token_type;
                }
            }
            if (type == nullptr) {
                continue;
            }
            declared = &type->attributes;
        }
        place.declared = declared;
        for (const lang::Parameter& attribute : *declared) {
            std::optional<Value> low, high;
            const auto type = value_type(attribute.type, place.scope, &low, &high);
            if (!type) {
                continue;
            }
            draft().places[i].attributes.push_back({attribute.name.text, *type});
            place.attributes.names.push_back({attribute.name.text, *type});
        }
    }
}

std::string attribute_name(const lang::Path& name) {
    return name.steps.size() == 1 && name.steps[0].index.empty() ? name.steps[0].text
                                                                 : lang::to_text(name);
}

std::optional<std::vector<Expr>> Elaboration::bind_attributes(
    const std::vector<lang::Binding>& given, net::PlaceIndex place, const Scope& scope,
    lang::Span where, std::string_view except) {
    const std::vector<net::AttributeDraft>& attributes = draft().places[place.value].attributes;
    const std::string& path = draft().places[place.value].path;
    std::vector<std::optional<Expr>> values(attributes.size());
    std::vector<std::string> known;
    for (const net::AttributeDraft& a : attributes) {
        known.push_back(a.name);
    }
    bool good = true;
    for (const lang::Binding& b : given) {
        const std::string name = attribute_name(b.name);
        if (name == except) {
            continue;
        }
        std::size_t i = 0;
        while (i < attributes.size() && attributes[i].name != name) {
            ++i;
        }
        if (i == attributes.size()) {
            unknown(b.name.span, "attribute of " + path, name, known);
            good = false;
            continue;
        }
        values[i] = expr_of(b.value, scope, attributes[i].type);
        good = good && values[i].has_value();
    }
    std::vector<Expr> result;
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        const std::vector<lang::Parameter>* declared = places_[place.value].declared;
        const bool told = !good;
        if (!values[i] && declared != nullptr && i < declared->size() &&
            (*declared)[i].default_value) {
            values[i] = expr_of((*declared)[i].default_value, places_[place.value].scope,
                                attributes[i].type);
        }
        if (!values[i]) {
            if (!told) {
                error("missing-attribute", where,
                      "a token of " + path + " needs its " + attributes[i].name,
                      "write " + path + "(" + attributes[i].name + " = ...)");
            }
            return std::nullopt;
        }
        result.push_back(std::move(*values[i]));
    }
    return good ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace puppetri::scene
