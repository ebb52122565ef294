// SPDX-License-Identifier: MIT
// The reference nets of SCENES.md, as the tests of the kernel and of the timed methods build them:
// the walk with 20 frames a step at 24 frames per second, and the ball game with plain durations.
#pragma once
#include <string>

#include "net/maker.h"

namespace puppetri::net {

inline Net walk_net(int steps) {
    Maker m;
    const double n = 20.0 / 24;
    m.place("P1", 1);
    for (const auto& [name, s] :
         {std::pair{"P2", n / 2}, {"P4", n}, {"P6", n}, {"P7", n / 2}, {"P8", n / 2}}) {
        m.place(name, 0, lasts(s));
    }
    m.t("t1", {"P1"}, {"P2", "P3"});
    m.t("t2", {"P2", "unless P5"}, {"P4", "P3"}).priority = 2;
    m.t("t3", {"P4", "unless P5"}, {"P6", "P3"}).priority = 2;
    m.t("t4", {"P6", "unless P5"}, {"P4", "P3"}).priority = 2;
    m.t("t5", {std::to_string(steps) + "*P3"}, {"P5"});
    m.t("t6", {"P4"}, {"P7"});
    m.t("t7", {"P2"}, {"P8"});
    m.t("t8", {"P6"}, {"P8"});
    m.t("t9", {"P7"}, {"P9"});
    m.t("t10", {"P8"}, {"P9"});
    FinalMarkingDraft end;
    end.condition = Formula::marked(m.p("P9"));
    m.draft.finals.push_back(end);
    return m.net();
}

// Still to be changed: a test may give its places movements.
inline Maker ball_game_maker() {
    Maker m;
    m.place("P1", 1, lasts(1.5));
    m.place("P13", 1, lasts(1));
    for (const char* name : {"P2", "P4", "P6", "P8", "P14", "P16", "P18", "P20", "P10", "P12"}) {
        m.place(name, 0, lasts(0.5));
    }
    for (const char* name : {"P3", "P7", "P15", "P19"}) {
        m.place(name, 0, lasts(0.25));
    }
    m.place("P5", 0, lasts(1));
    m.place("P17", 0, lasts(1.5));
    DurationDraft as = of_kind(DurationKind::kAs);
    as.sibling = m.p("P14");
    m.place("P9", 0, as);
    as.sibling = m.p("P6");
    m.place("P11", 0, as);
    m.t("t1", {"P1"}, {"P2"});
    m.t("t2", {"P2", "P9"}, {"P3"});
    m.t("t3", {"P3"}, {"P4", "P10"});
    m.t("t4", {"P4"}, {"P5"});
    m.t("t5", {"P5"}, {"P6", "P11"});
    m.t("t6", {"P6", "P12"}, {"P7"});
    m.t("t7", {"P7"}, {"P8"});
    m.t("t8", {"P8"}, {"P1"});
    m.t("t9", {"P13"}, {"P14", "P9"});
    m.t("t10", {"P14", "P10"}, {"P15"});
    m.t("t11", {"P15"}, {"P16"});
    m.t("t12", {"P16"}, {"P17"});
    m.t("t13", {"P17"}, {"P18"});
    m.t("t14", {"P18", "P11"}, {"P19"});
    m.t("t15", {"P19"}, {"P20", "P12"});
    m.t("t16", {"P20"}, {"P13"});
    return m;
}

}  // namespace puppetri::net
