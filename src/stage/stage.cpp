// SPDX-License-Identifier: MIT
// The movement host: what the net calls.
#include "puppetri/stage/stage.h"

#include <algorithm>

#include "puppetri/motion/own_movement.h"
#include "stage_data.h"
#include "take_performance.h"

namespace puppetri::stage {

using motion::SubjectKind;

namespace {

// Attributes of the token in the places where the call names them.
void resolve(motion::BoundCall& call, std::span<const std::int64_t> attributes,
             SubjectKind subject) {
    const motion::MovementSignature& signature = motion::signature_of(call, subject);
    for (motion::Argument& argument : call.arguments) {
        const auto* attribute = std::get_if<motion::TokenAttribute>(&argument.value);
        if (attribute == nullptr) {
            continue;
        }
        PUP_REQUIRE(attribute->index < attributes.size());
        const std::int64_t value = attributes[attribute->index];
        const auto index = static_cast<std::uint32_t>(value);
        for (const motion::Parameter& p : signature.parameters) {
            if (p.name != argument.parameter) {
                continue;
            }
            if (p.types.has(motion::ParameterType::kActor)) {
                argument.value = ActorIndex{index};
            } else if (p.types.has(motion::ParameterType::kProp)) {
                argument.value = PropIndex{index};
            } else if (p.types.has(motion::ParameterType::kSet)) {
                argument.value = SetIndex{index};
            } else if (p.types.has(motion::ParameterType::kBool)) {
                argument.value = value != 0;
            } else {
                argument.value = value;
            }
        }
    }
    for (motion::BoundCall& nested : call.nested) {
        resolve(nested, attributes, SubjectKind::kActor);
    }
}

}  // namespace

std::vector<motion::DurationRange> declared_durations(const Play& play) {
    std::vector<motion::DurationRange> list;
    list.reserve(play.actions.size());
    for (const Action& action : play.actions) {
        list.push_back(motion::declared_duration(action.call));
    }
    return list;
}

Stage::Stage(Play play, std::shared_ptr<const Quantities> quantities)
    : data_(std::make_unique<Data>(std::move(play), std::move(quantities))) {}
Stage::~Stage() = default;
Stage::Stage(Stage&&) noexcept = default;
Stage& Stage::operator=(Stage&&) noexcept = default;

SimTime Stage::begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                     SimTime duration, std::span<const std::int64_t> attributes) {
    Data& d = *data_;
    PUP_REQUIRE(action.value < d.play.actions.size());
    PUP_REQUIRE(activity.value == d.activities.size());
    d.advance(at);
    const Action& a = d.play.actions[action.value];
    motion::BoundCall call = a.call;
    resolve(call, attributes, call.subject.kind);
    Activity made;
    made.action = action;
    made.start = at;
    made.row = d.take.score.size();
    d.activities.push_back(std::move(made));
    ScoreEntry row;
    row.start = row.end = at;
    row.left = SimTime::never();
    row.place = a.place;
    row.movement = call.movement;
    row.instance = a.instance;
    d.take.score.push_back(std::move(row));
    const bool flies = call.subject.kind == SubjectKind::kProp;
    const SimTime lasts = flies ? d.begin_flight(activity.value, call, duration)
                                : d.begin_actor(activity.value, call, duration);
    d.raised.clear();
    d.raised_by = activity.value;
    if (lasts.ticks < 0) {
        return lasts;
    }
    if (duration.ticks < 0 && !motion::declared_duration(a.call).has(lasts)) {
        d.outside_declared(action, lasts);
        return SimTime{-1};
    }
    d.take.score.back().end = at + lasts;
    if (!flies) {
        for (const motion::MovementEvent& event : d.activities[activity.value].movement->events) {
            for (const RaisedName& name : a.raises) {
                if (name.name == event.name) {
                    d.raised.push_back({at + event.after_start, name.event});
                }
            }
        }
    }
    return lasts;
}

std::span<const net::RaisedEvent> Stage::raised(net::ActivityIndex activity) {
    PUP_REQUIRE(activity.value == data_->raised_by);
    return data_->raised;
}

void Stage::cut(net::ActivityIndex activity, SimTime at) {
    Data& d = *data_;
    d.advance(at);
    Activity& a = d.activities[activity.value];
    a.cut = true;
    ScoreEntry& row = d.take.score[a.row];
    row.end = std::min(row.end, at);
    if (a.movement != nullptr) {
        d.cuts.push_back(activity.value);
    }
}

void Stage::left(net::ActivityIndex activity, SimTime at) {
    Data& d = *data_;
    d.advance(at);
    Activity& a = d.activities[activity.value];
    a.left = at;
    d.running.erase(std::remove(d.running.begin(), d.running.end(), activity.value),
                    d.running.end());
    d.take.score[a.row].left = at;
}

std::span<const ScoreEntry> Stage::score() const { return data_->take.score; }
void Stage::pass_to(SimTime at) { data_->advance(at); }
void Stage::pose(ActorIndex actor, SimTime at, figure::Pose& out) const {
    PUP_REQUIRE(actor.value < data_->take.actors.size());
    data_->take.pose(actor, std::max(at, SimTime{0}), out);
}
const figure::Figure& Stage::figure(ActorIndex actor) const {
    PUP_REQUIRE(actor.value < data_->take.actors.size());
    return *data_->take.actors[actor.value].figure;
}
Transform Stage::world_from_prop(PropIndex prop, SimTime at) const {
    PUP_REQUIRE(prop.value < data_->take.props.size());
    return data_->take.world_from_prop(prop, std::max(at, SimTime{0}));
}
const Diagnostics& Stage::diagnostics() const { return data_->diagnostics; }

std::unique_ptr<const Performance> Stage::finish(SimTime end) {
    Data& d = *data_;
    PUP_REQUIRE(end >= d.now);
    d.advance(SimTime{end.ticks + 1});
    Take take = std::move(d.take);
    take.end = end;
    for (const Activity& a : d.activities) {
        if (a.movement == nullptr) {
            continue;
        }
        const SimTime last = std::min(a.cut ? a.left : SimTime::never(), end);
        for (const motion::MovementEvent& event : a.movement->events) {
            const SimTime at = a.start + event.after_start;
            if (at > last) {
                continue;
            }
            const bool of_prop = event.name == "release" || event.name == "catch" ||
                                 event.name == "grasp" || event.name == "hand_over";
            take.events.push_back(
                {at, event.name, take.score[a.row].actor,
                 of_prop ? std::string() : std::string(motion::name_of(event.limb)),
                 of_prop ? take.score[a.row].prop : std::string()});
        }
    }
    std::stable_sort(take.events.begin(), take.events.end(),
                     [](const StageEvent& x, const StageEvent& y) { return x.at < y.at; });
    data_ = std::make_unique<Data>(Play{}, nullptr);
    return make_take_performance(std::move(take));
}

}  // namespace puppetri::stage
