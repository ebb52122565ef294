// SPDX-License-Identifier: MIT
// The table of good motion as rows: what holds for whatever a net strings together; and where a
// scene is allowed to differ, by how much and why.
#pragma once
#include <string>
#include <vector>

#include "support/measure.h"

namespace puppetri::test {

struct TableRow {
    const char* quantity;
    Worst seen;
    double most;
};

// Of a performance at 480 Hz, joins included; or of an exported file in its own frames.
std::vector<TableRow> table_of_stage(const Measures& measures);
std::vector<TableRow> table_of_file(const Measures& measures);

// Checks all rows against the table or, where there is one, against the exception: kAllowed of
// motion_table.cpp.
void check_rows(const std::string& scene, const std::string& actor,
                const std::vector<TableRow>& rows);

}  // namespace puppetri::test
