// SPDX-License-Identifier: MIT
// What all readers of motion do at the end: names that are unique, tracks without idle keys, and a
// word about figures of an odd size.
#pragma once
#include <string>
#include <string_view>

#include "defects.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::io {

// What a reader says of a file with more bytes than it takes.
Diagnostics too_large(const std::string& path, std::uint64_t bytes);

// The file's name without folders and ending: "walk" of "a/walk.bvh".
std::string clip_name_of(std::string_view path);

// Joints of one name get numbers ("hand", "hand_2"), with a warning.
void make_names_unique(figure::Skeleton& skeleton, Defects& defects, const std::string& path);

// A track whose value never changes keeps its first key alone.
void drop_still_keys(motion::Clip& clip);

// From the lowest joint or tip of the rest pose to the highest, metres.
double rest_height_m(const figure::Skeleton& skeleton);

// A warning where a figure with more than ten joints is less than 0.4 or more than 4 m tall, with
// the scale that makes it 1.75 m, or CMU's where that fits.
void tell_odd_scale(const ClipFile& file, double scale, Defects& defects, const std::string& path);

}  // namespace puppetri::io
