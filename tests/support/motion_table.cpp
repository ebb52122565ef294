// SPDX-License-Identifier: MIT
#include "support/motion_table.h"

#include <doctest/doctest.h>

namespace puppetri::test {
namespace {

// A quantity of one scene (of all its actors, or one) that may be more than the table says.
struct Allowed {
    const char* scene;
    const char* actor;  // "": all
    const char* quantity;
    double most;
};

constexpr Allowed kAllowed[] = {
    // A jump leaves the floor: the column of running, and to be thrown up takes twice gravity.
    {"16_units/class.pup", "", "pelvis m/s2", 20},
    {"16_units/class.pup", "", "ankle rad/s", 14},
    {"16_units/class.pup", "", "knee rad/s2", 1200},
    // Keyframes of a file as they are.
    {"09_philosophers/absolute.pup", "man1", "arm rad/s2", 1700},
};

std::vector<TableRow> always(const Measures& m) {
    return {{"sink mm", m.sink_mm, 2},
            {"hover mm", m.hover_mm, 2},
            {"swing sink mm", m.swing_sink_mm, 2},
            {"pelvis m/s2", m.pelvis_acceleration, 4},
            {"knee rad/s", m.knee.speed_rad_s, 10},
            {"hip rad/s", m.hip.speed_rad_s, 6},
            {"ankle rad/s", m.ankle.speed_rad_s, 8},
            {"spine rad/s", m.spine.speed_rad_s, 3},
            {"neck rad/s", m.neck.speed_rad_s, 6},
            {"arm rad/s", m.arm.speed_rad_s, 20},
            {"knee rad/s2", m.knee.acceleration_rad_s2, 400},
            {"hip rad/s2", m.hip.acceleration_rad_s2, 400},
            {"ankle rad/s2", m.ankle.acceleration_rad_s2, 400},
            {"spine rad/s2", m.spine.acceleration_rad_s2, 400},
            {"neck rad/s2", m.neck.acceleration_rad_s2, 400},
            {"arm rad/s2", m.arm.acceleration_rad_s2, 1500}};
}

}  // namespace

std::vector<TableRow> table_of_stage(const Measures& m) {
    std::vector<TableRow> rows = always(m);
    rows.push_back({"slip mm", m.slip_mm, 1});
    rows.push_back({"limit deg", m.limit_excess_deg, 1e-4});
    rows.push_back({"join m", m.join_position_m, 1e-6});
    rows.push_back({"join pelvis m/s", m.join_pelvis_m_s, 0.05});
    rows.push_back({"join hand m/s", m.join_hand_m_s, 0.2});
    rows.push_back({"join foot m/s", m.join_foot_m_s, 0.2});
    rows.push_back({"join ratio", m.join_acceleration_ratio, 1.5});
    return rows;
}

std::vector<TableRow> table_of_file(const Measures& m) {
    std::vector<TableRow> rows = always(m);
    rows.push_back({"slip mm", m.slip_mm, 2});
    // Keys are single precision in glTF and have five digits in BVH.
    rows.push_back({"limit deg", m.limit_excess_deg, 0.01});
    return rows;
}

void check_rows(const std::string& scene, const std::string& actor,
                const std::vector<TableRow>& rows) {
    for (const TableRow& row : rows) {
        double most = row.most;
        for (const Allowed& a : kAllowed) {
            const bool meant = scene == a.scene && (*a.actor == '\0' || actor == a.actor) &&
                               std::string(row.quantity) == a.quantity;
            most = meant ? a.most : most;
        }
        CHECK_MESSAGE(row.seen.value <= most, scene << ": " << actor << ": "
                                                    << std::string(row.quantity) << " "
                                                    << row.seen.value << " at " << row.seen.at_s
                                                    << " s, " << row.seen.where);
    }
}

}  // namespace puppetri::test
