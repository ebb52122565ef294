// SPDX-License-Identifier: MIT
// The table of movements keeps the promises of its header.
#include "puppetri/motion/library.h"

#include "doctest/doctest.h"

using namespace puppetri::motion;
using puppetri::SimTime;

TEST_CASE("the library is ordered by name, then subject, without a name twice [law]") {
    const auto all = movement_library();
    for (std::size_t i = 1; i < all.size(); ++i) {
        const bool ordered = all[i - 1].name < all[i].name || (all[i - 1].name == all[i].name &&
                                                               all[i - 1].subject < all[i].subject);
        CHECK_MESSAGE(ordered, all[i].name);
    }
}

TEST_CASE("every row is complete and can be found again [law]") {
    for (const MovementSignature& m : movement_library()) {
        CAPTURE(m.name);
        CHECK(find_movement(m.name, m.subject) == &m);
        CHECK(!m.doc.empty());
        CHECK(m.shortest > SimTime{0});
        CHECK(m.shortest <= m.longest);
        CHECK((m.subject == SubjectKind::kLimb) == (m.on_limbs.bits != 0));
        CHECK((m.subject == SubjectKind::kActor) >= (m.arms_parameter != ""));
        bool arms_found = m.arms_parameter.empty();
        for (const Parameter& p : m.parameters) {
            CAPTURE(p.name);
            CHECK(p.types.bits != 0);
            CHECK(!p.doc.empty());
            arms_found =
                arms_found || (p.name == m.arms_parameter && p.types.has(ParameterType::kMovement));
            int numbers = 0;
            for (ParameterType t :
                 {ParameterType::kInt, ParameterType::kReal, ParameterType::kLength,
                  ParameterType::kTime, ParameterType::kAngle}) {
                numbers += p.types.has(t);
            }
            CHECK(numbers <= 1);
        }
        CHECK(arms_found);
    }
}

TEST_CASE("what may stand as an argument drives arms alone [unit]") {
    for (const MovementSignature& m : movement_library()) {
        if (m.as_argument) {
            CHECK_MESSAGE(m.limbs == LimbSet{}.with(Limb::kLeftArm).with(Limb::kRightArm), m.name);
        }
    }
}

TEST_CASE("all movements that the ball game and the walk name are there [unit]") {
    for (const char* name : {"step", "half_step", "walk", "stand", "idle", "face", "turn", "ready",
                             "reach", "carry", "hold", "throw", "catch"}) {
        CHECK_MESSAGE(find_movement(name, SubjectKind::kActor) != nullptr, name);
    }
    for (const char* name : {"support", "transfer", "swing_forward", "swing_backward"}) {
        CHECK_MESSAGE(find_movement(name, SubjectKind::kLimb) != nullptr, name);
    }
    CHECK(find_movement("fly", SubjectKind::kProp) != nullptr);
    CHECK(find_movement("fly", SubjectKind::kActor) == nullptr);
    CHECK(find_movement("juggle", SubjectKind::kActor) == nullptr);
}

TEST_CASE("limbs have the names of the language, both ways [unit]") {
    for (int i = 0; i < kLimbCount; ++i) {
        const Limb limb = static_cast<Limb>(i);
        CHECK(limb_named(name_of(limb)) == limb);
    }
    CHECK(!limb_named("tail").has_value());
}
