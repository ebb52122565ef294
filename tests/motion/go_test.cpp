// SPDX-License-Identifier: MIT
// Going to a place, from standing to standing: turns and steps as they are strung together.
#include "puppetri/motion/go.h"

#include <doctest/doctest.h>

#include "chain.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::motion;
using namespace puppetri::test;

TEST_CASE("whoever goes anywhere keeps the table, long strokes of the tall included [law]") {
    struct Goes {
        double height_m, to_deg, far_m;
        bool faces;
    };
    std::vector<Goes> list;
    for (const double height : {1.5, 1.75, 1.82, 1.95}) {
        // Ways of which one or several of the longest strokes make the whole.
        for (const double far : {0.6, 0.66, 1.2, 1.3, 2.0, 2.6, 3.0}) {
            list.push_back({height, 0, far, false});
            list.push_back({height, far < 1.25 ? 40.0 : -150.0, far, far > 1});
        }
    }
    for (const Goes& g : list) {
        const figure::Figure f = figure::make_mannequin(g.height_m);
        const double heading = radians(g.to_deg);
        const Vec3 to{g.far_m * std::sin(heading), 0, g.far_m * std::cos(heading)};
        Chain chain(f, standing(f, {}, 0));
        chain.run({make_idle(chain.context(), {})}, 1.3);
        GoSpec spec{.to_world = to};
        if (g.faces) {
            spec.heading_rad = 1;
        }
        const MovementPtr go = make_go(chain.context(), spec);
        chain.run({go}, go->duration.seconds());
        const Controls there = chain.at(chain.now_s());
        chain.run({make_idle(chain.context(), {})}, 1);
        const Measures m = chain.measured();
        CAPTURE(g.height_m);
        CAPTURE(g.to_deg);
        CAPTURE(g.far_m);
        INFO(report(m));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.hover_mm.value < 2);
        CHECK(m.limit_excess_deg.value < 1e-4);
        // At rest the weight goes to and fro, which may add a little to a start.
        CHECK(m.pelvis_acceleration.value <= 4.2);
        CHECK(m.knee.speed_rad_s.value <= 10);
        CHECK(m.hip.speed_rad_s.value <= 6);
        CHECK(m.ankle.speed_rad_s.value <= 8);
        CHECK(m.spine.speed_rad_s.value <= 3);
        for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
            CHECK(j->acceleration_rad_s2.value <= 400);
        }
        CHECK(m.join_position_m.value <= 1e-6);
        CHECK(m.join_pelvis_m_s.value <= 0.05);
        CHECK(m.join_foot_m_s.value <= 0.2);
        const Vec3 feet = (there.legs[0].ankle_world + there.legs[1].ankle_world) * 0.5;
        CHECK(length(Vec3{feet.x - to.x, 0, feet.z - to.z}) < 0.006);
    }
}
