// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "place_order.h"
#include "puppetri/base/require.h"
#include "puppetri/proof/symbolic.h"
#include "symbolic_tables.h"

namespace puppetri::proof {

StateSet::StateSet(SymbolicTables* tables, std::uint32_t root) : tables_(tables), root_(root) {
    tables_->store->keep(root_);
}

StateSet::StateSet(const StateSet& other) : tables_(other.tables_), root_(other.root_) {
    if (tables_ != nullptr) {
        tables_->store->keep(root_);
    }
}

StateSet::StateSet(StateSet&& other) noexcept
    : tables_(std::exchange(other.tables_, nullptr)), root_(std::exchange(other.root_, 0)) {}

StateSet& StateSet::operator=(StateSet other) noexcept {
    std::swap(tables_, other.tables_);
    std::swap(root_, other.root_);
    return *this;
}

StateSet::~StateSet() {
    if (tables_ != nullptr) {
        tables_->store->release(root_);
    }
}

// Levels nest as deep as the recursion of every operation.
constexpr std::uint32_t kMostLevels = 8192;
// Work of the first attempt at each order, in nodes looked for; each round gives four times more.
constexpr std::uint64_t kFirstWork = 1u << 14;
constexpr std::size_t kOrdersAtOnce = 12;

// Orders are tried in turn with growing shares of work, so that one bad order costs little.
void SymbolicTables::explore() {
    const Meter clock(budget, "symbolic");
    std::vector<PlaceGroups> orders = place_orders(net, budget);
    if (orders.size() > kOrdersAtOnce) {
        orders.resize(kOrdersAtOnce);
    }
    if (orders[0].size() > kMostLevels) {
        ended = Ended::kMemory;
        return;
    }
    for (std::uint64_t work = kFirstWork; !orders.empty(); work *= 4) {
        for (std::size_t i = 0; i < orders.size();) {
            if (try_order(orders[i], work, budget.seconds - clock.seconds())) {
                return;
            }
            if (ended == Ended::kMemory) {  // more work would need more still
                orders.erase(orders.begin() + static_cast<std::ptrdiff_t>(i));
            } else if (ended == Ended::kStates) {
                ++i;
            } else {
                return;
            }
        }
    }
}

// Gives  whether the space was explored; if not, `ended` says why: kStates when the work was used
//        up.
bool SymbolicTables::try_order(const PlaceGroups& order, std::uint64_t work, double seconds) {
    Budget rest = budget;
    rest.seconds = seconds;
    levels = std::make_unique<SymbolicLevels>(net, order);
    store = std::make_unique<DiagramStore>(rest, "symbolic");
    saturation = std::make_unique<Saturation>(*store, *levels);
    store->limit_work(work);
    all = saturation->reachable();
    peak_bytes = std::max(peak_bytes, store->peak_bytes());
    ended = store->ended();
    if (ended == Ended::kDone) {
        store->end_limit();
        levels->close();
        store->keep(all);
        initial = node_of(net.initial);
        store->keep(initial);
        ended = store->ended();  // there may have been no room for this last set
        explored = ended == Ended::kDone;
    }
    return explored;
}

NodeId SymbolicTables::node_of(std::span<const std::uint32_t> marking) {
    NodeId node = DiagramStore::kTop;
    const std::uint32_t outer = store->frame();
    for (std::uint32_t level = 1; level <= levels->count(); ++level) {
        const std::int32_t value = levels->value_of(level, marking);
        if (value < 0) {
            return DiagramStore::kEmpty;
        }
        const std::uint32_t base = store->frame();
        store->push(static_cast<std::uint32_t>(value), node);
        node = store->make(level, base);
    }
    store->pop_to(outer);
    return node;
}

SymbolicSpace::SymbolicSpace(const PlainNet& net, const Budget& budget)
    : tables_(std::make_unique<SymbolicTables>()) {
    tables_->net = net;
    tables_->budget = budget;
    tables_->supported = !net.has_levels;
    if (tables_->supported) {
        tables_->explore();
    }
}

SymbolicSpace::~SymbolicSpace() = default;

bool SymbolicSpace::supported() const { return tables_->supported; }

Ended SymbolicSpace::ended() const {
    return tables_->explored ? tables_->store->ended() : tables_->ended;
}

void SymbolicSpace::renew(const Budget& budget) {
    tables_->budget = budget;
    if (tables_->explored) {
        tables_->store->renew(budget, "symbolic");
    }
}

const PlainNet& SymbolicSpace::net() const { return tables_->net; }

std::uint64_t SymbolicSpace::bytes() const {
    return tables_->explored ? tables_->store->bytes() : 0;
}

std::uint64_t SymbolicSpace::peak_bytes() const {
    return tables_->explored ? std::max(tables_->peak_bytes, tables_->store->peak_bytes())
                             : tables_->peak_bytes;
}

}  // namespace puppetri::proof
