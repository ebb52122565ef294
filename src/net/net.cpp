// SPDX-License-Identifier: MIT
// The compiled net as others see it; its tables are made in compile.cpp.
#include "puppetri/net/net.h"

#include "puppetri/base/require.h"
#include "puppetri/net/tables.h"

namespace puppetri::net {

Net::Net() : tables_(std::make_unique<NetTables>()) {}
Net::~Net() = default;
Net::Net(const Net& other) : tables_(std::make_unique<NetTables>(*other.tables_)) {}
Net::Net(Net&&) noexcept = default;
Net& Net::operator=(const Net& other) {
    tables_ = std::make_unique<NetTables>(*other.tables_);
    return *this;
}
Net& Net::operator=(Net&&) noexcept = default;

std::uint32_t Net::place_count() const { return tables_->places.size(); }
std::uint32_t Net::transition_count() const { return tables_->transitions.size(); }
std::uint32_t Net::datum_count() const { return tables_->data.size(); }
std::uint32_t Net::event_count() const { return tables_->events.size(); }

namespace {
ElementView element(const Names& names, std::uint32_t i) {
    PUP_REQUIRE(i < names.size());
    return names[i];
}
}  // namespace

ElementView Net::place(PlaceIndex p) const { return element(tables_->places, p.value); }
ElementView Net::transition(TransitionIndex t) const {
    return element(tables_->transitions, t.value);
}
ElementView Net::datum(DatumIndex d) const { return element(tables_->data, d.value); }
ElementView Net::event(EventIndex e) const { return element(tables_->events, e.value); }

PlaceIndex Net::find_place(std::string_view path) const { return {tables_->places.find(path)}; }
TransitionIndex Net::find_transition(std::string_view path) const {
    return {tables_->transitions.find(path)};
}
DatumIndex Net::find_datum(std::string_view path) const { return {tables_->data.find(path)}; }
EventIndex Net::find_event(std::string_view path) const { return {tables_->events.find(path)}; }

PlaceIndex Net::place_of_draft(PlaceIndex p) const {
    PUP_REQUIRE(p.value < tables_->place_map.size());
    return {tables_->place_map[p.value]};
}
TransitionIndex Net::transition_of_draft(TransitionIndex t) const {
    PUP_REQUIRE(t.value < tables_->transition_map.size());
    return {tables_->transition_map[t.value]};
}

ActionIndex Net::action(PlaceIndex p) const {
    PUP_REQUIRE(p.value < place_count());
    const std::uint32_t rich =
        tables_->place_rich.empty() ? kNoIndex : tables_->place_rich[p.value];
    return rich == kNoIndex ? ActionIndex{} : tables_->rich[rich].action;
}

bool Net::paced() const { return tables_->paced; }
const NetDraft& Net::declarations() const { return tables_->declarations; }
std::uint64_t Net::hash() const { return tables_->hash; }
const Diagnostics& Net::notes() const { return tables_->notes; }

std::size_t Net::hot_bytes() const {
    const NetTables& t = *tables_;
    return t.place.size() * sizeof(PlaceRow) + t.transition.size() * sizeof(TransitionRow) +
           t.watchers.size() * sizeof(Watcher) + t.arcs.size() * sizeof(Weighted) +
           4 * (t.place_rich.size() + t.place_dependents.starts.size() +
                t.place_dependents.items.size());
}

}  // namespace puppetri::net
