// SPDX-License-Identifier: MIT
// The examples, loaded and performed once per test program, and what the instrument (measure.h)
// needs to know about them: when feet are meant to stand, where movements join.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "puppetri/figure/character.h"
#include "puppetri/scene/perform.h"
#include "support/measure.h"

namespace puppetri::test {

struct Example {
    std::string name;  // "02_walk/figure.pup"
    std::unique_ptr<scene::Scene> scene;
    scene::Performed performed;

    const stage::Performance& performance() const { return *performed.performance; }
    double end_s() const { return performance().duration().seconds(); }
    std::uint32_t actors() const {
        return static_cast<std::uint32_t>(performance().actors().size());
    }
    const std::string& actor(std::uint32_t i) const { return performance().actors()[i].name; }
    figure::Figure figure(std::uint32_t actor) const;
    bool is_humanoid(std::uint32_t actor) const;
    // Of what came from a file or is no mannequin; else null.
    const figure::Character* character(std::uint32_t actor) const {
        return scene->play.cast.actors[actor].character.get();
    }
};

// Ends the program when the example cannot be performed.
const Example& example(const std::string& name);

// All scenes of the examples that somebody performs, in the order of their names; those whose
// characters are not there are left out, which is said.
const std::vector<std::string>& example_scenes();

// Whether the files are there with which example 06 is performed; says that it is skipped
// otherwise.
bool has_character_files();

// What the instrument wants to see, of joints of a character's own skeleton in the world: the bones
// of its humanoid, each where its joint is and turned as it is turned against the T-pose. Bones
// without a joint stay with their parents.
void bones_of_character(const figure::Character& character,
                        std::span<const Transform> world_from_joint,
                        std::span<Transform> world_from_bone);

// When the feet of an actor stand, as the performance says, to 1/480 s.
std::vector<Planted> planted_of(const Example& example, std::uint32_t actor, double end_s);
// Where one of its movements follows another.
std::vector<double> joins_of(const Example& example, std::uint32_t actor, double end_s);

// The performance at 480 Hz during [begin, end].
Measures measured_on_stage(const Example& example, std::uint32_t actor, double begin_s,
                           double end_s);

// A stretch during which an actor does one kind of thing.
struct Stretch {
    std::string movement;  // "half_step"
    std::string place;     // "a.with_ball.P2"
    double begin_s = 0, end_s = 0;
};
// The rows of the score of this actor that drive its pelvis, until the next such row begins.
std::vector<Stretch> stretches_of(const Example& example, std::uint32_t actor, double end_s);

}  // namespace puppetri::test
