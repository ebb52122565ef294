// SPDX-License-Identifier: MIT
#include "puppetri/io/events_json.h"

#include "markers.h"

namespace puppetri::io {

void write_events(JsonWriter& json, const Take& take, bool with_clip) {
    for (const TakeEvent& event : take.events) {
        json.begin_object().member("t", event.at.seconds()).member("frame", event.frame);
        json.member("name", event.name).member("actor", event.actor);
        json.member("limb", event.limb).member("prop", event.prop);
        if (with_clip) {
            json.member("clip", take.name);
        }
        json.end_object();
    }
}

void write_holders(JsonWriter& json, const Take& take, bool with_clip) {
    for (const TakeProp& prop : take.props) {
        for (const HolderChange& change : prop.holders) {
            json.begin_object().member("t", change.at.seconds());
            json.member("frame", take.rate.nearest_frame(change.at));
            json.member("prop", prop.name).member("holder", change.holder);
            if (with_clip) {
                json.member("clip", take.name);
            }
            json.end_object();
        }
    }
}

std::string make_events_json(std::span<const Take> takes, std::string_view title) {
    PUP_REQUIRE(!takes.empty());
    const bool clips = takes.size() > 1 || !takes.front().name.empty();
    JsonWriter json;
    json.begin_object().member("version", kEventsVersion).member("scene", title);
    json.member("frames_per_second", to_string(takes.front().rate));
    if (!clips) {
        json.member("first_frame", takes.front().first_frame)
            .member("frames", takes.front().frame_count);
    }
    json.key("events").begin_array();
    for (const Take& take : takes) {
        write_events(json, take, clips);
    }
    json.end_array().key("holders").begin_array();
    for (const Take& take : takes) {
        write_holders(json, take, clips);
    }
    json.end_array().end_object();
    return json.take() + "\n";
}

}  // namespace puppetri::io
