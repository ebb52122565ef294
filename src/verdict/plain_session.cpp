// SPDX-License-Identifier: MIT
// The clock and the shared state spaces, and the names of methods.
#include "plain_session.h"

#include <algorithm>
#include <limits>

#include "puppetri/proof/semiflows.h"

namespace puppetri::verdict {

namespace {

constexpr double kQuickLook_s = 2;

}  // namespace

const char* techniques_of(How how) {
    switch (how) {
        case How::kNone:
            break;
        case How::kStructure:
            return "TOPOLOGICAL";
        case How::kWalk:
            return "RANDOM_WALK EXPLICIT";
        case How::kEquation:
            return "STATE_EQUATION TOPOLOGICAL";
        case How::kExploration:
            return "EXPLICIT STATE_COMPRESSION";
        case How::kSymmetry:
            return "EXPLICIT STATE_COMPRESSION SYMMETRIES";
        case How::kReduced:
            return "EXPLICIT STRUCTURAL_REDUCTION STATE_COMPRESSION";
        case How::kStubborn:
            return "EXPLICIT STRUCTURAL_REDUCTION STUBBORN_SETS STATE_COMPRESSION";
        case How::kDiagrams:
            return "DECISION_DIAGRAMS";
    }
    return "";
}

const char* method_of(How how) {
    switch (how) {
        case How::kNone:
            break;
        case How::kStructure:
            return "arcs";
        case How::kWalk:
            return "runs";
        case How::kEquation:
            return "state equation";
        case How::kExploration:
            return "all markings";
        case How::kSymmetry:
            return "markings up to symmetry";
        case How::kReduced:
            return "all markings of the reduced net";
        case How::kStubborn:
            return "stubborn sets";
        case How::kDiagrams:
            return "decision diagrams";
    }
    return "";
}

PlainSession::PlainSession(const net::Net& net, const proof::Budget& budget)
    : net_(net), budget_(budget), plain_(proof::plain(net)), meter_(budget, "untimed") {}

std::string PlainSession::why_not() const {
    return plain_.net.left_out.empty() ? "the net is more than places and arcs"
                                       : plain_.net.left_out.front();
}

proof::Budget PlainSession::share(double fraction, double most) const {
    proof::Budget part = budget_;
    const double left = std::max(0.0, budget_.seconds - meter_.seconds());
    part.seconds = std::min(left * fraction, most);
    if (space_ != nullptr) {  // what is kept for later questions is not there for this one
        part.bytes -= std::min(part.bytes / 2, space_->bytes());
    }
    if (markings_ != nullptr) {
        part.bytes -= std::min(part.bytes / 2,
                               markings_->plain.bytes() +
                                   8 * std::uint64_t{markings_->plain.graph.edges.items.size()});
    }
    return part;
}

bool PlainSession::out_of_time() const {
    return meter_.seconds() >= budget_.seconds ||
           (budget_.cancelled != nullptr && budget_.cancelled->load());
}

const proof::Marking& PlainSession::bounds() {
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

const proof::Symmetry& PlainSession::symmetry() {
    if (!symmetry_.has_value()) {
        std::vector<std::string_view> places, transitions;
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            places.push_back(net_.place(net::PlaceIndex{p}).path);
        }
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            transitions.push_back(net_.transition(net::TransitionIndex{t}).path);
        }
        symmetry_ = proof::interchangeable_instances(plain(), places, transitions);
    }
    return *symmetry_;
}

proof::SymbolicSpace* PlainSession::symbolic(double fraction) {
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

proof::SymbolicSpace* PlainSession::quick_symbolic() {
    if (!looked_) {
        looked_ = true;
        const double left = budget_.seconds - meter_.seconds();
        if (left > 0) {
            symbolic(std::min(1.0, kQuickLook_s / left));
        }
    }
    return space_.get();
}

bool PlainSession::too_many_to_visit() {
    proof::SymbolicSpace* space = quick_symbolic();
    if (space == nullptr) {
        return false;
    }
    const std::optional<Natural> states = space->count(space->all());
    return states.has_value() && *states > Natural(kVisited);
}

const PlainSession::Markings* PlainSession::markings(double fraction) {
    if (!listed_ && !too_many_to_visit()) {
        listed_ = true;  // once: it takes what it takes
        proof::Budget part = share(fraction);
        part.states = kVisited;
        auto made = std::make_unique<Markings>();
        made->plain = proof::build_graph(plain(), {}, nullptr, part);
        if (made->plain.graph.ended == proof::Ended::kDone) {
            made->components = proof::strong_components(made->plain.graph);
            made->bottoms = proof::bottom_components(made->plain.graph, made->components);
            markings_ = std::move(made);
        }
    }
    return markings_.get();
}

}  // namespace puppetri::verdict
