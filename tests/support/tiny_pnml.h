// SPDX-License-Identifier: MIT
// Reads the plain nets of tests and benchmarks without the library's own reader: places, initial
// tokens, transitions, weighted arcs, inhibitor arcs in the dialect `<arc type="inhibitor">`. No
// pages, no reference nodes, no names.
#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "puppetri/proof/plain_net.h"

namespace puppetri::test {

inline std::string text_of_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

// Empty when there is no such file.
inline proof::PlainNet tiny_pnml(const std::string& path) {
    const std::string text = text_of_file(path);
    const auto attribute = [&](const std::string& tag, const std::string& name) -> std::string {
        const std::size_t at = tag.find(" " + name + "=\"");
        if (at == std::string::npos) {
            return {};
        }
        const std::size_t from = at + name.size() + 3;
        return tag.substr(from, tag.find('"', from) - from);
    };
    struct Arc {
        std::string source, target;
        std::uint32_t weight = 1;
        bool inhibits = false;
    };
    std::map<std::string, std::uint32_t> places, transitions;
    std::vector<Arc> arcs;
    proof::PlainNet net;
    enum class In { kOther, kMarking, kInscription } in = In::kOther;
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
        const std::string tag = text.substr(at, text.find('>', at) - at + 1);
        const std::string name = tag.substr(1, tag.find_first_of(" \t\r\n/>", 1) - 1);
        const std::string content = text.substr(at + tag.size(), 24);
        if (name == "place") {
            places.emplace(attribute(tag, "id"), static_cast<std::uint32_t>(places.size()));
            net.initial.push_back(0);
        } else if (name == "transition") {
            transitions.emplace(attribute(tag, "id"),
                                static_cast<std::uint32_t>(transitions.size()));
        } else if (name == "arc") {
            arcs.push_back({attribute(tag, "source"), attribute(tag, "target"), 1,
                            attribute(tag, "type") == "inhibitor"});
        } else if (name == "initialMarking") {
            in = In::kMarking;
        } else if (name == "inscription") {
            in = In::kInscription;
        } else if (name == "text" || name == "value") {
            const auto number =
                static_cast<std::uint32_t>(std::strtoul(content.c_str(), nullptr, 10));
            if (in == In::kMarking) {
                net.initial.back() = number;
            } else if (in == In::kInscription) {
                arcs.back().weight = number;
            }
            in = In::kOther;
        }
    }
    const std::size_t count = transitions.size();
    std::vector<std::map<std::uint32_t, std::uint32_t>> takes(count), gives(count), unless(count);
    for (const Arc& arc : arcs) {
        if (const auto p = places.find(arc.source); p != places.end()) {
            auto& row = (arc.inhibits ? unless : takes)[transitions.at(arc.target)];
            row[p->second] += arc.weight;
        } else {
            gives[transitions.at(arc.source)][places.at(arc.target)] += arc.weight;
        }
    }
    const auto lay_out = [&](net::Rows<net::Weighted>& rows, const auto& lists) {
        for (const auto& list : lists) {
            for (const auto& [place, weight] : list) {
                rows.items.push_back({place, weight});
            }
            rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
        }
    };
    lay_out(net.takes, takes);
    lay_out(net.gives, gives);
    lay_out(net.unless, unless);
    lay_out(net.reads, std::vector<std::map<std::uint32_t, std::uint32_t>>(count));
    net.level.assign(count, 0);
    net.optional.assign(count, 0);
    return net;
}

}  // namespace puppetri::test
