// SPDX-License-Identifier: MIT
#include "puppetri/io/write_net.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "defects.h"
#include "net_features.h"
#include "net_writers.h"

namespace puppetri::io {
namespace {

constexpr std::size_t kFeatures = static_cast<std::size_t>(NetFeature::kStatements) + 1;
constexpr std::uint32_t kMostTold = 3;  // elements of each kind

std::string lower_case(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    }
    return out;
}

}  // namespace

std::optional<NetFormat> written_format_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, NetFormat>, 10> kNames = {{
        {"pnml", NetFormat::kPnml},
        {"pipe", NetFormat::kPipe},
        {"xml", NetFormat::kPipe},
        {"tina", NetFormat::kTina},
        {"net", NetFormat::kTina},
        {"lola", NetFormat::kLola},
        {"dot", NetFormat::kGraphviz},
        {"gv", NetFormat::kGraphviz},
        {"graphviz", NetFormat::kGraphviz},
        {"pup", NetFormat::kScene},
    }};
    const std::string wanted = lower_case(name);
    for (const auto& [known, format] : kNames) {
        if (wanted == known) {
            return format;
        }
    }
    return std::nullopt;
}

std::optional<NetFormat> written_format_of(std::string_view path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string_view::npos || path[dot] != '.') {
        return std::nullopt;
    }
    return written_format_named(path.substr(dot + 1));
}

Checked<WrittenNet> write_net(const NetFile& file, NetFormat to, const WriteNetOptions& options) {
    Defects defects;
    std::array<std::uint32_t, kFeatures> dropped{}, refused{};
    for (const FeatureUse& use : features_of(file.draft)) {
        const auto kind = static_cast<std::size_t>(use.feature);
        if (can_say(to, use.feature)) {
            continue;
        }
        // Holdings and the like cannot be dropped: what they stand for is not in the draft yet.
        if ((options.lossy && use.feature != NetFeature::kComposition) ||
            use.feature == NetFeature::kStatements) {
            ++dropped[kind];
        } else if (++refused[kind] <= kMostTold) {
            defects.error("not-in-format", use.where, use.element,
                          std::string(name_of(to)) + " has no " + name_of(use.feature),
                          "choose another format, or drop them with --lossy");
        }
    }
    for (std::size_t i = 0; i < kFeatures; ++i) {
        if (refused[i] > kMostTold) {
            defects.error("not-in-format", {}, "net " + file.draft.name,
                          std::string(name_of(to)) + " has no " +
                              name_of(static_cast<NetFeature>(i)) + ": " +
                              std::to_string(refused[i] - kMostTold) + " more have them",
                          "choose another format, or drop them with --lossy");
        }
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    WrittenNet out;
    for (std::size_t i = 0; i < dropped.size(); ++i) {
        if (dropped[i] > 0) {
            out.notes.push_back({Severity::kWarning,
                                 "dropped",
                                 {},
                                 "net " + file.draft.name,
                                 std::string(name_of(static_cast<NetFeature>(i))) +
                                     " were dropped, of " + std::to_string(dropped[i]) +
                                     (dropped[i] == 1 ? " element" : " elements"),
                                 "choose a format that has them"});
        }
    }
    switch (to) {
        case NetFormat::kPnml:
            out.text = pnml_text(file, out.notes);
            break;
        case NetFormat::kPipe:
            out.text = pipe_text(file, out.notes);
            break;
        case NetFormat::kTina:
            out.text = tina_text(file, out.notes);
            break;
        case NetFormat::kLola:
            out.text = lola_text(file, out.notes);
            break;
        case NetFormat::kGraphviz:
            out.text = graphviz_text(file, out.notes);
            break;
        case NetFormat::kScene:
            out.text = scene_text(file, out.notes);
            break;
    }
    return out;
}

}  // namespace puppetri::io
