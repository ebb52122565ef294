// SPDX-License-Identifier: MIT
#include "foreign_log.h"

#include <cstdlib>
#include <map>
#include <set>

#include "puppetri/base/text.h"
#include "puppetri/io/disk_files.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

constexpr const char* kLeftOut = "-";  // --map NAME=-

void replace_all(std::string& text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
}

// The names of the net that a line may mean, likeliest first.
std::vector<std::string> candidates(const io::LogLine& line,
                                    const std::map<std::string, std::string>& map,
                                    const std::string& pattern) {
    std::vector<std::string> keys;
    if (!line.object.empty()) {
        keys = {line.object + " " + line.event, line.object + "." + line.event};
    }
    keys.push_back(line.event);
    for (const std::string& key : keys) {
        if (const auto found = map.find(key); found != map.end()) {
            return {found->second};
        }
    }
    if (!pattern.empty()) {
        std::string name = pattern;
        replace_all(name, "{object}", line.object);
        replace_all(name, "{event}", line.event);
        return {name};
    }
    if (line.object.empty()) {
        return {line.event};
    }
    return {line.event, line.object + "." + line.event, line.event + "." + line.object,
            line.event + "[" + line.object + "]"};
}

}  // namespace

std::vector<Option> with_log_options(std::vector<Option> options) {
    options.push_back({"--map", Value::kTexts, "NAME=TRANSITION",
                       "what a name of the log is called in the net; NAME is EVENT or `OBJECT "
                       "EVENT`; NAME=- leaves it out"});
    options.push_back(
        {"--name", Value::kText, "PATTERN", "how all are called: 'phil[{object}].{event}'"});
    options.push_back({"--rate", Value::kText, "N",
                       "frames per second of logs whose times are frames (the scene's)"});
    return options;
}

Result<std::vector<io::LogLine>, int> load_log(const std::string& path, const Arguments& arguments,
                                               double frames_per_s) {
    io::LogFormat format;
    format.frames_per_s = frames_per_s;
    if (arguments.given("--rate")) {
        const auto rate = parse_number(arguments.text("--rate"));
        if (!rate || !(*rate > 0)) {
            say_error("--rate: write frames per second, as 24");
            return Unexpected<int>(kBadInput);
        }
        format.frames_per_s = *rate;
    }
    const auto text = io::DiskFiles().read(path);
    if (!text) {
        say_error(path + ": " + text.error().message);
        return Unexpected<int>(kBadInput);
    }
    auto lines = io::read_firing_log(*text, path, format);
    if (!lines) {
        say_diagnostics(lines.error());
        return Unexpected<int>(kBadInput);
    }
    return std::move(*lines);
}

Result<NetLog, int> in_names_of(const net::Net& net, const std::vector<io::LogLine>& lines,
                                const std::string& path, const Arguments& arguments) {
    std::map<std::string, std::string> map;
    for (const std::string& text : arguments.texts("--map")) {
        const std::size_t equals = text.rfind('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
            say_error("--map: '" + text + "' names nothing: write NAME=TRANSITION");
            return Unexpected<int>(kBadInput);
        }
        map[text.substr(0, equals)] = text.substr(equals + 1);
    }
    const std::string pattern = arguments.text("--name");
    NetLog out;
    std::set<std::string> unknown;
    Diagnostics defects;
    for (const io::LogLine& line : lines) {
        net::TransitionIndex transition;
        bool left_out = false;
        const std::vector<std::string> names = candidates(line, map, pattern);
        for (const std::string& name : names) {
            left_out = left_out || name == kLeftOut;
            if (!transition.valid()) {
                transition = net.find_transition(name);
            }
        }
        if (left_out) {
            continue;
        }
        if (transition.valid()) {
            out.firings.push_back({line.at, transition});
            out.lines.push_back(line.line);
        } else if (unknown.insert(names.front()).second && unknown.size() <= 10) {
            std::vector<std::string> known;
            for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
                known.emplace_back(net.transition({t}).path);
            }
            const std::string_view near = nearest_name(names.front(), known);
            Diagnostic d;
            d.code = "unknown-name";
            d.where.file = path;
            d.where.line = line.line;
            d.where.column = 1;
            d.message = "the net has no transition " + names.front();
            d.remedy = near.empty()
                           ? "say what it is called: --map '" + names.front() +
                                 "=TRANSITION', or leave it out: --map '" + names.front() + "=-'"
                           : "--map '" + names.front() + "=" + std::string(near) + "'?";
            defects.push_back(std::move(d));
        }
    }
    if (!defects.empty()) {
        say_diagnostics(defects);
        return Unexpected<int>(kBadInput);
    }
    return out;
}

}  // namespace puppetri::cli
