// SPDX-License-Identifier: MIT
// Checks a cast that was made by hand or by a scene: everything that is wrong with it at once.
#include "puppetri/stage/cast.h"

#include <cmath>
#include <set>

namespace puppetri::stage {
namespace {

constexpr double kLeast_m = 0.002;  // of a prop

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class Checker {
 public:
    void name(const std::string& what, const std::string& name) {
        if (name.empty()) {
            error("no-name", what, "it has no name", "give every actor, prop and set a name");
        } else if (!names_.insert(name).second) {
            error("name-used-twice", what + " " + name, "another member of the cast has this name",
                  "rename one of them");
        }
    }
    void need(bool good, const char* code, const std::string& element, const char* message,
              const char* remedy) {
        if (!good) {
            error(code, element, message, remedy);
        }
    }
    Diagnostics take() { return std::move(list_); }

 private:
    void error(const char* code, const std::string& element, const char* message,
               const char* remedy) {
        list_.push_back({Severity::kError, code, {}, element, message, remedy});
    }
    std::set<std::string> names_;
    Diagnostics list_;
};

}  // namespace

Diagnostics check(const Cast& cast) {
    Checker c;
    for (const Actor& a : cast.actors) {
        const std::string element = "actor " + a.name;
        c.name("actor", a.name);
        const bool whole = a.body != BodyKind::kCharacter || a.character != nullptr;
        c.need(whole, "no-character", element, "it has no character", "give it one from a file");
        c.need(!whole || !a.humanoid() || (a.height_m >= 0.5 && a.height_m <= 3),
               "height-out-of-range", element, "the height is not between 0.5 m and 3 m",
               "give a height such as 1.75 m");
        c.need(finite(a.position_world) && std::isfinite(a.heading_rad), "not-finite", element,
               "position or heading is no finite number", "give numbers");
        c.need(a.position_world.y == 0, "not-on-floor", element,
               "the actor stands above or below the floor", "give a position with y = 0");
    }
    for (const Prop& p : cast.props) {
        const std::string element = "prop " + p.name;
        c.name("prop", p.name);
        const bool ball = p.shape == PropShape::kSphere;
        c.need(p.size_m.x >= kLeast_m && p.size_m.x <= 10 && p.size_m.y >= kLeast_m &&
                   p.size_m.y <= 10 && p.size_m.z >= kLeast_m && p.size_m.z <= 10,
               "size-out-of-range", element, "the size is not between 2 mm and 10 m",
               "give a size such as 22 cm");
        c.need(p.mass_kg > 0 && p.mass_kg <= 1000, "mass-out-of-range", element,
               "the mass is not above 0 and at most 1000 kg", "give a mass such as 0.4 kg");
        c.need(finite(p.position_world), "not-finite", element, "the position is no finite number",
               "give numbers");
        c.need(!p.held_by.valid() || p.held_by.value < cast.actors.size(), "unknown-holder",
               element, "its holder is not in the cast", "name an actor of the cast");
        c.need(!p.held_by.valid() || p.held_by.value >= cast.actors.size() ||
                   cast.actors[p.held_by.value].humanoid(),
               "no-hands", element, "its holder is a creature, which has no hands",
               "let it lie on the floor, or give it to a humanoid");
        c.need(!p.held_by.valid() || (ball && p.size_m.x <= 0.4), "cannot-hold", element,
               "two hands hold only a sphere of at most 40 cm",
               "make it smaller, or let it lie on the floor");
    }
    for (std::size_t i = 0; i < cast.props.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            c.need(!cast.props[i].held_by.valid() || cast.props[i].held_by != cast.props[j].held_by,
                   "hands-full", "prop " + cast.props[i].name,
                   "its holder has another prop in both hands", "let one of them lie on the floor");
        }
    }
    for (const Set& s : cast.sets) {
        const std::string element = "set " + s.name;
        c.name("set", s.name);
        c.need(s.length_m > 0 && s.width_m > 0 && s.length_m <= 1e4 && s.width_m <= 1e4,
               "size-out-of-range", element, "length or width is not above 0 and at most 10 km",
               "give a size such as 60 m");
        c.need(finite(s.position_world) && std::isfinite(s.direction_rad), "not-finite", element,
               "position or direction is no finite number", "give numbers");
    }
    return c.take();
}

}  // namespace puppetri::stage
