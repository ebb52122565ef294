// SPDX-License-Identifier: MIT
// The members "events" and "holders", alike in glTF's extras and in the events file.
#pragma once
#include "puppetri/io/json_writer.h"
#include "puppetri/io/take.h"

namespace puppetri::io {

// {t, frame, name, actor, limb, prop} one by one into the open array; with_clip adds the take's
// name.
void write_events(JsonWriter& json, const Take& take, bool with_clip);
// {t, frame, prop, holder}: from then on the holder has the prop.
void write_holders(JsonWriter& json, const Take& take, bool with_clip);

}  // namespace puppetri::io
