// SPDX-License-Identifier: MIT
#include "puppetri/notation/foreign_file.h"

#include <algorithm>
#include <array>

#include "foreign_formats.h"
#include "puppetri/base/text.h"

namespace puppetri::notation {
namespace {

// In alphabetical order.
constexpr std::array kFormats = {
    ForeignFormat{".scxml", "a statechart as other programs export it", read_scxml, bind_scxml},
    ForeignFormat{".tookima", "extended state machines, sampled", read_tookima},
    ForeignFormat{".tuples", "which keyframe an object reaches when", read_tuple_file},
};

// In capitals or not; something must stand before it.
bool ends_in(std::string_view path, std::string_view ending) {
    return path.size() > ending.size() &&
           std::equal(ending.begin(), ending.end(),
                      path.end() - static_cast<std::ptrdiff_t>(ending.size()), [](char a, char b) {
                          return a == (b >= 'A' && b <= 'Z' ? b + ('a' - 'A') : b);
                      });
}

}  // namespace

std::span<const ForeignFormat> foreign_formats() { return kFormats; }

const ForeignFormat* find_foreign_format(std::string_view path) {
    const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const ForeignFormat& f) {
        return ends_in(path, f.ending);
    });
    return found == kFormats.end() ? nullptr : &*found;
}

bool is_scene_file(std::string_view path) {
    return ends_in(path, ".pup") || find_foreign_format(path) != nullptr;
}

lang::Parsed parse(std::string_view text, std::string_view path, std::uint32_t file) {
    const ForeignFormat* format = find_foreign_format(path);
    if (format == nullptr) {
        return lang::parse(text, path, file);
    }
    lang::Parsed out = lang::open_text(text, path, file);
    if (!has_errors(out.diagnostics)) {
        format->read(out, file);
    }
    return out;
}

}  // namespace puppetri::notation
