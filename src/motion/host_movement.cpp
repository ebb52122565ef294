// SPDX-License-Identifier: MIT
#include "puppetri/motion/host_movement.h"

#include "puppetri/base/require.h"
#include "puppetri/base/text.h"
#include "times.h"

namespace puppetri::motion {
namespace {

class HostSource final : public PoseSource {
 public:
    HostSource(std::shared_ptr<const HostMovement> host, HostArguments arguments)
        : host_(std::move(host)), arguments_(std::move(arguments)) {}
    void sample(double t_s, PoseFrame& frame) const override {
        host_->pose(t_s, arguments_, frame);
    }

 private:
    std::shared_ptr<const HostMovement> host_;
    HostArguments arguments_;
};

class HostMaker final : public MovementMaker {
 public:
    explicit HostMaker(HostMovement host)
        : host_(std::make_shared<const HostMovement>(std::move(host))) {}

    MovementPtr make(const OwnCall& call) const override {
        HostArguments arguments;
        for (const OwnParameter& p : host_->signature.parameters) {
            read(p, call, arguments);
        }
        return make_posed(call.context, host_->spec,
                          std::make_shared<HostSource>(host_, std::move(arguments)));
    }
    DurationRange declared(const Arguments&) const override {
        const SimTime duration = whole_milliseconds(host_->spec.duration_s);
        return {duration, duration};
    }

 private:
    static void read(const OwnParameter& p, const OwnCall& call, HostArguments& out) {
        const Arguments& with = call.arguments;
        if (const auto* prop = with.get<PropIndex>(p.name)) {
            out.places[p.name] = call.around.props[prop->value].position_world;
        } else if (const auto* actor = with.get<ActorIndex>(p.name)) {
            Vec3 at = call.around.actors[actor->value].controls.pelvis.position_world;
            at.y = 0;
            out.places[p.name] = at;
        } else if (const auto* point = with.get<Vec3>(p.name)) {
            out.places[p.name] = *point;
        } else if (const auto* side = with.get<Side>(p.name)) {
            out.numbers[p.name] = index_of(*side);
        } else if (const auto* flag = with.get<bool>(p.name)) {
            out.numbers[p.name] = *flag ? 1 : 0;
        } else {
            out.numbers[p.name] = with.number(p.name);
        }
    }

    std::shared_ptr<const HostMovement> host_;
};

OwnParameter parameter(std::string name, ParameterType type, double value, const char* unit) {
    return {.name = std::move(name),
            .types = TypeSet{}.with(type),
            .default_text = number_to_text(value) + unit,
            .default_value = value,
            .doc = "given by the program"};
}

}  // namespace

double HostArguments::number(std::string_view name) const {
    const auto found = numbers.find(name);
    return found == numbers.end() ? 0 : found->second;
}
Vec3 HostArguments::place(std::string_view name) const {
    const auto found = places.find(name);
    return found == places.end() ? Vec3{} : found->second;
}

OwnMovementPtr make_host_movement(HostMovement movement) {
    PUP_REQUIRE(movement.pose != nullptr && movement.spec.duration_s >= 0.001 &&
                movement.spec.duration_s <= 86'400);
    static const figure::Figure figure = figure::make_mannequin(1.75);
    movement.spec.name = movement.signature.name;
    movement.signature.limbs = limbs_of(figure, movement.spec);
    movement.signature.as_argument = movement.signature.limbs.bits != 0 &&
                                     without(movement.signature.limbs, kBothArms).bits == 0;
    OwnSignature signature = movement.signature;
    return std::make_shared<const OwnMovement>(std::move(signature),
                                               std::make_shared<HostMaker>(std::move(movement)));
}

OwnParameter angle_parameter(std::string name, double default_rad) {
    return parameter(std::move(name), ParameterType::kAngle, default_rad, " rad");
}
OwnParameter length_parameter(std::string name, double default_m) {
    return parameter(std::move(name), ParameterType::kLength, default_m, " m");
}
OwnParameter number_parameter(std::string name, double default_value) {
    return parameter(std::move(name), ParameterType::kReal, default_value, "");
}
OwnParameter prop_parameter(std::string name) {
    return {
        .name = std::move(name), .types = TypeSet{}.with(ParameterType::kProp), .doc = "a prop"};
}
OwnParameter actor_parameter(std::string name) {
    return {
        .name = std::move(name), .types = TypeSet{}.with(ParameterType::kActor), .doc = "an actor"};
}

}  // namespace puppetri::motion
