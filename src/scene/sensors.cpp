// SPDX-License-Identifier: MIT
// Sensors in expressions: `distance(ana.right_hand, ball) < 0.3 m` becomes a datum of the net, the
// same for every place that asks the same, and two crossings that set it (stage/sensors.h).
#include <algorithm>

#include "elaboration.h"

namespace puppetri::scene {
namespace {

struct NamedPoint {
    const char* name;
    const char* joint;  // of humanoids
};
constexpr NamedPoint kPoints[] = {
    {"head", "head"},
    {"chest", "upperChest"},
    {"pelvis", "hips"},
    {"left_hand", "leftHand"},
    {"right_hand", "rightHand"},
    {"left_foot", "leftFoot"},
    {"right_foot", "rightFoot"},
};

}  // namespace

bool Elaboration::is_sensor_function(std::string_view name) {
    return name == "distance" || name == "height" || name == "speed" || name == "angle" ||
           name == "inside";
}

// ana.right_hand, arm.reach (a joint of a linkage or a creature), ana (between its feet), ball,
// (x, y, z) m
std::optional<stage::SensorPoint> Elaboration::sensor_point(const lang::Expr& e,
                                                            const Scope& scope) {
    if (e.kind == lang::ExprKind::kTuple) {
        const auto at = point_of(e, scope);
        return at ? std::optional(stage::SensorPoint{.at_world = *at}) : std::nullopt;
    }
    if (e.kind != lang::ExprKind::kPath) {
        error("wrong-type", e.span, "this is no point",
              "write a part of an actor, a prop, or (x, y, z) m");
        return std::nullopt;
    }
    lang::Path who = e.path;
    std::string part;
    Term term = Nothing{};
    // The last step may be a part of an actor.
    if (who.steps.size() > 1) {
        part = who.steps.back().text;
        who.steps.pop_back();
        who.span = who.steps.front().span;
        term = resolve(who, scope);
        if (!std::holds_alternative<ActorTerm>(term)) {
            part.clear();
            term = resolve(e.path, scope);
        }
    } else {
        term = resolve(who, scope);
    }
    if (const auto* prop = std::get_if<PropTerm>(&term)) {
        return stage::SensorPoint{.prop = prop->prop};
    }
    if (const auto* at = std::get_if<PointTerm>(&term);
        at != nullptr && at->dimension == lang::dimension::kLength) {
        return stage::SensorPoint{.at_world = {at->at[0], at->at[1], at->at[2]}};
    }
    const auto* actor = std::get_if<ActorTerm>(&term);
    if (actor == nullptr) {
        if (!is_nothing(term)) {
            wrong(e.span, "a part of an actor such as ana.right_hand, a prop, or a point", term);
        }
        return std::nullopt;
    }
    const stage::Actor& a = scene.play.cast.actors[actor->actor.value];
    std::vector<std::string> known;
    for (const NamedPoint& p : kPoints) {
        if (a.humanoid() && (part == p.name || part.empty())) {
            return stage::SensorPoint{.actor = actor->actor,
                                      .joint = part.empty() ? "root" : p.joint};
        }
        known.emplace_back(p.name);
    }
    if (!a.humanoid()) {
        known.clear();
        for (const figure::Joint& j : a.character->skeleton.joints) {
            if (part == j.name || part.empty()) {
                return stage::SensorPoint{.actor = actor->actor, .joint = j.name};
            }
            known.push_back(j.name);
        }
    }
    unknown(e.path.steps.back().span, "part of " + a.name, part, known);
    return std::nullopt;
}

Term Elaboration::sensor_quantity(const lang::Expr& e, const Scope& scope) {
    const std::string& name = e.path.steps[0].text;
    QuantityTerm out;
    out.text = lang::to_text(e);
    out.sensor.where = at(e.span);
    const std::size_t wanted = name == "distance" ? 2 : name == "inside" ? 3 : 1;
    if (e.args.size() != wanted) {
        error(
            e.args.size() < wanted ? "missing-argument" : "too-many-arguments", e.span,
            name + " takes " + std::to_string(wanted) + (wanted == 1 ? " argument" : " arguments"),
            name == "distance" ? "write distance(ana.right_hand, ball) < 0.3 m"
            : name == "inside" ? "write inside(ana.pelvis, (0, 0, 0) m, (1, 2, 1) m): a point and "
                                 "two corners of a box"
            : name == "angle"  ? "write angle(ana.left_elbow.flex) > 90 deg"
                               : "write " + name + "(ana.right_hand) > 1 m");
        return Nothing{};
    }
    const lang::Expr& first = e.args[0].value;
    if (name == "angle") {
        out.sensor.kind = stage::SensorKind::kAngle;
        lang::Path who;
        std::string dof;
        if (first.kind == lang::ExprKind::kPath && first.path.steps.size() >= 3) {
            const auto& steps = first.path.steps;
            who.steps.assign(steps.begin(), steps.end() - 2);
            who.span = first.path.span;
            dof = steps[steps.size() - 2].text + "." + steps.back().text;
        }
        const Term term = who.empty() ? Term{Nothing{}} : resolve(who, scope);
        const auto* actor = std::get_if<ActorTerm>(&term);
        if (actor == nullptr) {
            if (who.empty() || !is_nothing(term)) {
                error("wrong-type", first.span, "this is no degree of freedom of an actor",
                      "write angle(ana.left_elbow.flex) > 90 deg");
            }
            return Nothing{};
        }
        const stage::Actor& a = scene.play.cast.actors[actor->actor.value];
        static const figure::DofSet mannequin = figure::humanoid_dofs(figure::make_mannequin(1.75));
        const figure::DofSet& dofs = a.humanoid() ? mannequin : a.character->dofs;
        const figure::DofIndex index = dofs.find(dof);
        if (!index.valid()) {
            std::vector<std::string> known;
            for (const figure::Dof& d : dofs.dofs) {
                known.push_back(d.name);
            }
            unknown(first.span, "degree of freedom of " + a.name, dof, known);
            return Nothing{};
        }
        out.sensor.a.actor = actor->actor;
        out.sensor.dof = dof;
        out.dimension = dofs.dofs[index.value].kind == figure::DofKind::kSlide
                            ? lang::dimension::kLength
                            : lang::dimension::kAngle;
        return out;
    }
    const auto a = sensor_point(first, scope);
    if (!a) {
        return Nothing{};
    }
    out.sensor.a = *a;
    out.dimension = name == "speed" ? lang::dimension::kSpeed : lang::dimension::kLength;
    out.sensor.kind = name == "distance" ? stage::SensorKind::kDistance
                      : name == "height" ? stage::SensorKind::kHeight
                                         : stage::SensorKind::kSpeed;
    if (name == "distance") {
        const auto b = sensor_point(e.args[1].value, scope);
        if (!b) {
            return Nothing{};
        }
        out.sensor.b = *b;
    } else if (name == "inside") {
        const auto low = point_of(e.args[1].value, scope), high = point_of(e.args[2].value, scope);
        if (!low || !high) {
            return Nothing{};
        }
        out.sensor.kind = stage::SensorKind::kInside;
        out.sensor.low_world = {std::min(low->x, high->x), std::min(low->y, high->y),
                                std::min(low->z, high->z)};
        out.sensor.high_world = {std::max(low->x, high->x), std::max(low->y, high->y),
                                 std::max(low->z, high->z)};
        out.sensor.above = true;
        out.sensor.name = out.text;
        return sensor_datum(std::move(out.sensor), e.span);
    }
    return out;
}

Term Elaboration::sensor_comparison(const lang::Expr& e, lang::Op op, const Term& a,
                                    const Term& b) {
    const auto* left = std::get_if<QuantityTerm>(&a);
    const auto* right = std::get_if<QuantityTerm>(&b);
    const Number* value = std::get_if<Number>(left != nullptr ? &b : &a);
    const bool greater = op == lang::Op::kGreater || op == lang::Op::kGreaterEqual;
    const bool less = op == lang::Op::kLess || op == lang::Op::kLessEqual;
    if ((left != nullptr && right != nullptr) || value == nullptr || (!greater && !less)) {
        error("wrong-type", e.span, "a sensor compares what figures are asked with one value",
              "write one such as `distance(ana.right_hand, ball) < 0.3 m`");
        return Nothing{};
    }
    const QuantityTerm& quantity = left != nullptr ? *left : *right;
    if (value->dimension != quantity.dimension) {
        error("wrong-unit", e.span,
              quantity.text + " is " + lang::to_text(quantity.dimension) + ", and this is " +
                  lang::to_text(value->dimension),
              "write it in " + std::string(lang::example_unit(quantity.dimension)));
        return Nothing{};
    }
    stage::Sensor sensor = quantity.sensor;
    sensor.threshold = value->value;
    sensor.above = greater == (left != nullptr);
    sensor.name = lang::to_text(e);
    return sensor_datum(std::move(sensor), e.span);
}

// One datum for one question, whoever asks.
Term Elaboration::sensor_datum(stage::Sensor sensor, lang::Span where) {
    const auto same = [](const stage::SensorPoint& x, const stage::SensorPoint& y) {
        return x.actor == y.actor && x.joint == y.joint && x.prop == y.prop &&
               x.at_world.x == y.at_world.x && x.at_world.y == y.at_world.y &&
               x.at_world.z == y.at_world.z;
    };
    const auto same_place = [](Vec3 x, Vec3 y) { return x.x == y.x && x.y == y.y && x.z == y.z; };
    for (const stage::Sensor& s : scene.sensors) {
        if (s.kind == sensor.kind && same(s.a, sensor.a) && same(s.b, sensor.b) &&
            s.dof == sensor.dof && s.threshold == sensor.threshold && s.above == sensor.above &&
            same_place(s.low_world, sensor.low_world) &&
            same_place(s.high_world, sensor.high_world)) {
            return DatumTerm{draft().events[s.begins.value].sets};
        }
    }
    const net::DatumIndex datum{static_cast<std::uint32_t>(draft().data.size())};
    // Its name is what was asked, in the words of the first who did; no two are alike.
    std::string path = sensor.name;
    for (int again = 2; std::any_of(draft().data.begin(), draft().data.end(),
                                    [&](const net::DatumDraft& d) { return d.path == path; });
         ++again) {
        path = sensor.name + " (" + std::to_string(again) + ")";
    }
    draft().data.push_back(
        {.path = path, .where = at(where), .type = {ValueKind::kBool}, .sensor = true});
    data_.push_back({nullptr, {}, path});
    for (const bool begins : {true, false}) {
        (begins ? sensor.begins
                : sensor.ends) = {static_cast<std::uint32_t>(draft().events.size())};
        draft().events.push_back({.path = path + (begins ? " begins" : " ends"),
                                  .where = at(where),
                                  .outside = false,
                                  .crossing = true,
                                  .sets = datum,
                                  .sets_to = begins});
        events_.push_back({nullptr, {}, draft().events.back().path});
    }
    scene.sensors.push_back(std::move(sensor));
    return DatumTerm{datum};
}

}  // namespace puppetri::scene
