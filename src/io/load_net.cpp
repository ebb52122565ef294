// SPDX-License-Identifier: MIT
#include "puppetri/io/load_net.h"

#include "puppetri/io/disk_files.h"
#include "puppetri/io/pipe.h"
#include "puppetri/io/pnml.h"
#include "puppetri/io/tina.h"
#include "puppetri/notation/foreign_file.h"
#include "puppetri/scene/scene.h"

namespace puppetri::io {
namespace {

Unexpected<Diagnostics> refuse(const char* code, const std::string& path, std::string message,
                               std::string remedy) {
    return Unexpected(Diagnostics{
        {Severity::kError, code, {path, 0, 0, 1}, "", std::move(message), std::move(remedy)}});
}

std::string ending_of(std::string_view path) {
    const std::size_t slash = path.find_last_of('/');
    const std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
    const std::size_t dot = name.rfind('.');
    std::string out(dot == std::string_view::npos ? std::string_view() : name.substr(dot));
    for (char& c : out) {
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    }
    return out;
}

// PIPE names its type "P/T net" and writes <value> where PNML has <text>, but in drawn labels.
bool looks_like_pipe(std::string_view text) {
    const std::string_view head = text.substr(0, 4096);
    return head.find("\"P/T net\"") != std::string_view::npos ||
           (text.find("<value>") != std::string_view::npos &&
            text.find("<text>") == std::string_view::npos);
}

}  // namespace

std::optional<NetFormat> net_format_of(std::string_view path, std::string_view text) {
    const std::string ending = ending_of(path);
    if (notation::is_scene_file(path)) {
        return NetFormat::kScene;
    }
    if (ending == ".net") {
        return NetFormat::kTina;
    }
    const std::string_view head = text.substr(0, 4096);
    if (ending == ".pnml" || ending == ".xml" || head.find("<pnml") != std::string_view::npos) {
        return looks_like_pipe(text) ? NetFormat::kPipe : NetFormat::kPnml;
    }
    return std::nullopt;
}

Checked<NetFile> read_net(std::string_view text, const std::string& path, const NetLimits& limits) {
    const std::optional<NetFormat> format = net_format_of(path, text);
    if (format == NetFormat::kPnml) {
        return read_pnml(text, path, limits);
    }
    if (format == NetFormat::kPipe) {
        return read_pipe(text, path, limits);
    }
    if (format == NetFormat::kTina) {
        return read_tina(text, path, limits);
    }
    return refuse("not-a-net-file", path, "the format of the file is not known",
                  "nets are read from .pnml, .xml, .net, .scxml and .pup");
}

Checked<NetFile> load_net(const std::string& path, const NetLimits& limits) {
    DiskFiles files;
    if (net_format_of(path, "") == NetFormat::kScene) {
        Checked<scene::Scene> loaded = scene::load(files, path);
        if (!loaded) {
            return Unexpected(std::move(loaded).error());
        }
        NetFile out;
        out.format = NetFormat::kScene;
        out.draft = std::move(loaded->draft);
        out.notes = std::move(loaded->notes);
        for (std::uint32_t i = 0; i < out.draft.places.size(); ++i) {
            out.ids.add_place(out.draft.places[i].path, {net::PlaceIndex{i}});
        }
        for (std::uint32_t i = 0; i < out.draft.transitions.size(); ++i) {
            out.ids.add_transition(out.draft.transitions[i].path, {net::TransitionIndex{i}});
        }
        out.ids.sort();
        return out;
    }
    Result<std::string, scene::FileProblem> text = files.read(path);
    if (!text) {
        return refuse("cannot-read", path, text.error().message, "look at the path");
    }
    return read_net(*text, path, limits);
}

}  // namespace puppetri::io
