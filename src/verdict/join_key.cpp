// SPDX-License-Identifier: MIT
#include "join_key.h"

#include <cmath>
#include <cstdio>
#include <variant>

#include "puppetri/base/elementary.h"
#include "puppetri/base/text.h"
#include "puppetri/net/tables.h"

namespace puppetri::verdict {
namespace {

std::string number(double x) { return number_to_text(x) + " "; }
std::string number(std::int64_t x) { return std::to_string(x) + " "; }

// A point as the figure sees it from where it stands at first, to a micrometre.
std::string seen_from(const stage::Actor& me, Vec3 point) {
    const Vec3 way = point - me.position_world;
    const double c = cos(me.heading_rad), s = sin(me.heading_rad);
    const auto rounded = [](double x) {
        return number(static_cast<std::int64_t>(std::nearbyint(x * 1e6)));
    };
    return rounded(c * way.x - s * way.z) + rounded(way.y) + rounded(s * way.x + c * way.z);
}

struct Words {
    const stage::Cast& cast;
    const stage::Actor& me;
    const motion::BoundCall& call;

    std::string of(const motion::ArgumentValue& value) const {
        return std::visit([this](const auto& v) { return text(v); }, value);
    }
    std::string text(motion::ActorIndex v) const {
        const stage::Actor& other = cast.actors[v.value];
        return "actor " + number(other.height_m) + seen_from(me, other.position_world) +
               number(other.heading_rad - me.heading_rad);
    }
    std::string text(motion::PropIndex v) const {
        const stage::Prop& p = cast.props[v.value];
        return "prop " + number(static_cast<std::int64_t>(p.shape)) + number(p.size_m.x) +
               number(p.size_m.y) + number(p.size_m.z) + number(p.mass_kg) + number(p.heading_rad) +
               (p.held_by.valid() ? text(p.held_by) : seen_from(me, p.position_world));
    }
    std::string text(motion::SetIndex v) const {
        const stage::Set& s = cast.sets[v.value];
        return "set " + number(s.direction_rad - me.heading_rad) + seen_from(me, s.position_world);
    }
    std::string text(Vec3 v) const { return "point " + seen_from(me, v); }
    // Angles of calls are headings in the world.
    std::string text(double v) const { return number(v) + "from " + number(me.heading_rad); }
    std::string text(std::int64_t v) const { return number(v); }
    std::string text(SimTime v) const { return number(v.ticks); }
    std::string text(bool v) const { return v ? "yes " : "no "; }
    std::string text(motion::Side v) const { return number(static_cast<std::int64_t>(v)); }
    std::string text(motion::TokenAttribute v) const {
        return "attribute " + number(std::int64_t{v.index});
    }
    std::string text(motion::NestedCall v) const {
        return Words{cast, me, call.nested[v.index]}.whole();
    }
    template <class Other>
    std::string text(const Other&) const {
        return "? ";
    }
    std::string whole() const {
        std::string out = call.movement + "(";
        if (call.own != nullptr) {
            char text[32];
            std::snprintf(text, sizeof text, "%p ", static_cast<const void*>(call.own.get()));
            out += text;  // calls of one definition; within one proof it stays where it is
        }
        for (const motion::Argument& a : call.arguments) {
            out += a.parameter + ": " + of(a.value);
        }
        return out + ")";
    }
};

}  // namespace

std::string body_key(const stage::Cast& cast, std::uint32_t actor) {
    const stage::Actor& me = cast.actors[actor];
    std::string out = number(me.height_m) + number(static_cast<std::int64_t>(me.body));
    if (me.character != nullptr) {
        out += me.name;
    }
    for (const stage::Prop& p : cast.props) {
        if (p.held_by.value == actor) {
            out += "holds " + number(static_cast<std::int64_t>(p.shape)) + number(p.size_m.x);
        }
    }
    return out;
}

std::string join_key(const net::Net& net, const stage::Play& play, net::PlaceIndex place) {
    const motion::BoundCall& call = play.actions[net.action(place).value].call;
    const stage::Actor& me = play.cast.actors[call.subject.actor.value];
    std::string out = number(static_cast<std::int64_t>(call.subject.kind)) +
                      number(static_cast<std::int64_t>(call.subject.limb)) +
                      Words{play.cast, me, call}.whole();
    const net::NetTables& tables = net.tables();
    const std::uint32_t duration = tables.place[place.value].duration;
    if (duration != net::kNoIndex) {
        const net::DurationTable& d = tables.durations[duration];
        const bool plain =
            d.kind == net::DurationKind::kConstant || d.kind == net::DurationKind::kAuto;
        out += number(static_cast<std::int64_t>(d.kind)) + number(d.ticks);
        if (!plain) {
            out += net.place(place).path;
        }
    }
    return out;
}

}  // namespace puppetri::verdict
