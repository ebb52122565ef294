// SPDX-License-Identifier: MIT
#include "puppetri/io/net_file.h"

#include <algorithm>

namespace puppetri::io {
namespace {

template <class Table>
void sort_table(Table& table) {
    std::stable_sort(table.begin(), table.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
}

template <class Table>
auto find_in(const Table& table, std::string_view id) -> decltype(&table.front().second) {
    const auto at =
        std::lower_bound(table.begin(), table.end(), id,
                         [](const auto& row, std::string_view key) { return row.first < key; });
    return at == table.end() || at->first != id ? nullptr : &at->second;
}

}  // namespace

const char* name_of(NetFormat format) {
    switch (format) {
        case NetFormat::kPnml:
            return "PNML";
        case NetFormat::kPipe:
            return "PIPE";
        case NetFormat::kTina:
            return "TINA";
        case NetFormat::kLola:
            return "LoLA";
        case NetFormat::kGraphviz:
            return "Graphviz";
        case NetFormat::kScene:
            return "scene";
    }
    return "";
}

void NetIds::add_place(std::string id, std::vector<net::PlaceIndex> places) {
    places_.emplace_back(std::move(id), std::move(places));
}

void NetIds::add_transition(std::string id, std::vector<net::TransitionIndex> transitions) {
    transitions_.emplace_back(std::move(id), std::move(transitions));
}

void NetIds::sort() {
    sort_table(places_);
    sort_table(transitions_);
}

const std::vector<net::PlaceIndex>* NetIds::find_places(std::string_view id) const {
    return find_in(places_, id);
}

const std::vector<net::TransitionIndex>* NetIds::find_transitions(std::string_view id) const {
    return find_in(transitions_, id);
}

}  // namespace puppetri::io
