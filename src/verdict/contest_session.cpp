// SPDX-License-Identifier: MIT
// The clock and the shared state spaces of a contest session.
#include "contest_session.h"

#include <algorithm>
#include <limits>

#include "puppetri/proof/semiflows.h"

namespace puppetri::verdict {

namespace {

constexpr double kQuickLook_s = 2;

}  // namespace

ContestSession::ContestSession(const net::Net& net, const proof::Budget& budget)
    : net_(net), budget_(budget), plain_(proof::plain(net)), meter_(budget, "contest") {}

std::string ContestSession::why_not() const {
    return plain_.net.left_out.empty() ? "the net is more than places and arcs"
                                       : plain_.net.left_out.front();
}

proof::Budget ContestSession::share(double fraction, double most) const {
    proof::Budget part = budget_;
    const double left = std::max(0.0, budget_.seconds - meter_.seconds());
    part.seconds = std::min(left * fraction, most);
    if (space_ != nullptr) {  // what is kept for later questions is not there for this one
        part.bytes -= std::min(part.bytes / 2, space_->bytes());
    }
    return part;
}

bool ContestSession::out_of_time() const {
    return meter_.seconds() >= budget_.seconds ||
           (budget_.cancelled != nullptr && budget_.cancelled->load());
}

const proof::Marking& ContestSession::bounds() {
    if (!bounds_.has_value()) {
        constexpr std::uint32_t kLarge = std::numeric_limits<std::uint32_t>::max();
        const proof::Flows flows = proof::place_semiflows(plain(), share(0.05, 1));
        bounds_.emplace();
        for (const std::uint64_t bound : proof::bounds_by_semiflows(plain(), flows)) {
            bounds_->push_back(static_cast<std::uint32_t>(std::min<std::uint64_t>(bound, kLarge)));
        }
    }
    return *bounds_;
}

proof::SymbolicSpace* ContestSession::symbolic(double fraction) {
    const proof::Budget part = share(fraction);
    // Not again with what was not enough before.
    if (space_ == nullptr && part.seconds > 1.5 * tried_seconds_) {
        tried_seconds_ = part.seconds;
        auto space = std::make_unique<proof::SymbolicSpace>(plain(), part);
        if (space->supported() && space->ended() == proof::Ended::kDone) {
            space_ = std::move(space);
        }
    }
    return space_.get();
}

proof::SymbolicSpace* ContestSession::quick_symbolic() {
    if (!looked_) {
        looked_ = true;
        const double left = budget_.seconds - meter_.seconds();
        if (left > 0) {
            symbolic(std::min(1.0, kQuickLook_s / left));
        }
    }
    return space_.get();
}

bool ContestSession::too_many_to_visit() {
    proof::SymbolicSpace* space = quick_symbolic();
    if (space == nullptr) {
        return false;
    }
    const std::optional<proof::Natural> states = space->count(space->all());
    return states.has_value() && *states > proof::Natural(kVisited);
}

}  // namespace puppetri::verdict
