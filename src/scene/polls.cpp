// SPDX-License-Identifier: MIT
// Polls in no time: a machine that asks a channel, finds nothing new and asks again, without any
// time passing in between, while the other side is always willing to answer. Taken literally, such
// a machine never lets time pass.
//   A transition can be part of one if it waits for nothing: no delay, no event, no state that
// lasts; if it sets variables to constants only (what counts, ends); and if, where it speaks on a
// channel, some partner answers without leaving its state. A ring of such transitions is a poll.
#include <algorithm>

#include "elaboration.h"

namespace puppetri::scene {
namespace {

bool lasts(const lang::Place& state) {
    const lang::Duration& d = state.takes;
    const bool zero = d.kind == lang::DurationKind::kDefault ||
                      (d.kind == lang::DurationKind::kValue &&
                       d.value.kind == lang::ExprKind::kNumber && d.value.number.numerator == 0);
    return !zero || state.does || state.runs;
}

bool waits(const lang::Transition& t) {
    return t.delay || t.holding || t.holding_left || !t.events.empty();
}

// Stays in its state: as the lowering of machines writes it.
bool stays(const lang::Transition& t) { return t.inputs.empty() && t.outputs.empty(); }

}  // namespace

void Elaboration::find_polls() {
    const auto count = static_cast<std::uint32_t>(transitions_.size());
    // By transition that ends a channel: whether some partner answers and stays.
    std::vector<bool> speaks(count, false), answered(count, false);
    for (const net::ChannelDraft& channel : draft().channels) {
        const auto look = [&](const std::vector<net::ChannelEnd>& here,
                              const std::vector<net::ChannelEnd>& there) {
            for (const net::ChannelEnd& end : here) {
                speaks[end.transition.value] = true;
                answered[end.transition.value] =
                    std::any_of(there.begin(), there.end(), [&](const net::ChannelEnd& other) {
                        const lang::Transition& t = *transitions_[other.transition.value].node;
                        return other.owner != end.owner && stays(t) && !waits(t);
                    });
            }
        };
        look(channel.sends, channel.receives);
        look(channel.receives, channel.sends);
    }
    for (std::uint32_t i = 0; i < count; ++i) {  // of channels that are not known yet
        const lang::Transition& node = *transitions_[i].node;
        speaks[i] = speaks[i] || !node.send.empty() || !node.receive.empty();
    }
    struct Step {
        std::uint32_t transition, to;
    };
    std::map<std::uint32_t, std::vector<Step>> steps;  // by place
    for (std::uint32_t i = 0; i < count; ++i) {
        const lang::Transition& node = *transitions_[i].node;
        const net::TransitionDraft& t = draft().transitions[i];
        const lang::Net* machine = instances_[transitions_[i].scope.instance].net;
        if (machine == nullptr || !machine->is_machine || waits(node) ||
            (speaks[i] && !answered[i]) ||
            !std::all_of(t.assignments.begin(), t.assignments.end(),
                         [](const net::AssignmentDraft& a) { return a.value.is_literal(); })) {
            continue;
        }
        if (stays(node)) {
            if (t.inputs.size() == 1 && !(node.guard && !t.assignments.empty())) {
                steps[t.inputs[0].place.value].push_back({i, t.inputs[0].place.value});
            }
        } else if (t.inputs.size() == 1 && t.outputs.size() == 1 &&
                   !lasts(*places_[t.inputs[0].place.value].node) &&
                   !lasts(*places_[t.outputs[0].place.value].node)) {
            steps[t.inputs[0].place.value].push_back({i, t.outputs[0].place.value});
        }
    }
    // The ring through each transition, by the shortest way back; each is told once.
    std::set<std::uint32_t> told;
    for (const auto& [place, list] : steps) {
        for (const Step& step : list) {
            std::map<std::uint32_t, Step> came;  // by place: the step into it
            std::vector<std::uint32_t> open = {step.to};
            for (std::size_t k = 0; k < open.size() && open[k] != place; ++k) {
                const auto next = steps.find(open[k]);
                for (const Step& s : next == steps.end() ? std::vector<Step>{} : next->second) {
                    if (s.to != step.to && came.emplace(s.to, Step{s.transition, open[k]}).second) {
                        open.push_back(s.to);
                    }
                }
            }
            if (step.to != place && came.count(place) == 0) {
                continue;
            }
            std::vector<std::uint32_t> ring = {step.transition};
            for (std::uint32_t at = place; at != step.to; at = came.at(at).to) {
                ring.push_back(came.at(at).transition);
            }
            // The poll belongs behind what looks and goes back, which speaks on no channel.
            std::uint32_t back = ring.front();
            for (const std::uint32_t t : ring) {
                back = speaks[back] && !speaks[t] ? t : back;
            }
            const bool asks =
                std::any_of(ring.begin(), ring.end(), [&](std::uint32_t t) { return speaks[t]; });
            if (std::any_of(ring.begin(), ring.end(),
                            [&](std::uint32_t t) { return told.count(t) != 0; })) {
                continue;
            }
            told.insert(ring.begin(), ring.end());
            const lang::Transition& node = *transitions_[back].node;
            About about(*this, "transition " + transitions_[back].path, node.span);
            std::string round;
            for (auto t = ring.rbegin(); t != ring.rend(); ++t) {
                round += (round.empty() ? "" : ", ") + transitions_[*t].path;
            }
            warn("zero-time-poll", node.span,
                 std::string("this machine can go round for ever in no time") +
                     (asks ? ", as long as it gets the same answer: " : ": ") + round,
                 "write `poll every 40 ms` behind " + node.name.text +
                     ", or wait for a message that comes only when there is news");
        }
    }
}

}  // namespace puppetri::scene
