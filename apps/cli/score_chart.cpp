// SPDX-License-Identifier: MIT
#include "score_chart.h"

#include <algorithm>
#include <vector>

#include "puppetri/base/text.h"

namespace puppetri::cli {
namespace {

struct Row {
    std::string name;
    std::string cells;
};

class Chart {
   public:
    Chart(SimTime end, int width) : end_s_(end.seconds()), width_(static_cast<std::size_t>(width)) {}

    std::size_t column(SimTime t) const {
        const double c = end_s_ > 0 ? t.seconds() / end_s_ * static_cast<double>(width_) : 0;
        return std::min(width_, static_cast<std::size_t>(c < 0 ? 0 : c));
    }

    void add(const std::string& name, const stage::ScoreEntry& entry) {
        auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.name == name; });
        if (row == rows_.end()) {
            rows_.push_back({name, std::string(width_ + 1, ' ')});
            row = rows_.end() - 1;
        }
        const std::size_t begin = column(entry.start);
        const std::size_t end = std::max(begin + 1, column(std::min(entry.left, entry.end)));
        std::string& cells = row->cells;
        for (std::size_t c = begin; c < end && c < cells.size(); ++c) {
            cells[c] = ' ';
        }
        if (begin < cells.size()) {
            cells[begin] = '|';
        }
        // A name that does not fit says nothing in one or two letters.
        const std::size_t room = end - begin - 1;
        if (room >= std::min<std::size_t>(entry.movement.size(), 3)) {
            for (std::size_t i = 0; i < entry.movement.size() && i < room && begin + 1 + i < width_; ++i) {
                cells[begin + 1 + i] = entry.movement[i];
            }
        }
    }

    std::string text() {
        std::size_t name_width = 0;
        for (const Row& r : rows_) {
            name_width = std::max(name_width, r.name.size());
        }
        std::string out = axis(name_width);
        for (Row& r : rows_) {
            r.cells.erase(r.cells.find_last_not_of(' ') + 1);
            out += "  " + r.name + std::string(name_width - r.name.size() + 2, ' ') + r.cells + "\n";
        }
        return out;
    }

   private:
    std::string axis(std::size_t name_width) const {
        // The smallest round step that leaves room for its labels.
        double step_s = 0.1;
        const double kFactors[] = {2, 2.5, 2};
        for (int i = 0; end_s_ / step_s * 8 > static_cast<double>(width_); ++i) {
            step_s *= kFactors[i % 3];
        }
        std::string line(name_width + 4 + width_ + 10, ' ');
        for (int i = 0; end_s_ > 0 && i * step_s <= end_s_ + 1e-9; ++i) {
            const std::string label = number_to_text(static_cast<double>(static_cast<long>(i * step_s * 10 + 0.5)) / 10) + " s";
            const auto at = name_width + 4 + static_cast<std::size_t>(i * step_s / end_s_ * static_cast<double>(width_));
            line.replace(at, label.size(), label);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        return line + "\n";
    }

    double end_s_;
    std::size_t width_;
    std::vector<Row> rows_;
};

}  // namespace

std::string score_chart(const stage::Performance& performance, SimTime end, int width) {
    Chart chart(end, width);
    for (const stage::ScoreEntry& entry : performance.score()) {
        chart.add(entry.actor.empty() ? entry.prop : entry.actor, entry);
    }
    return performance.score().empty() ? "" : chart.text();
}

}  // namespace puppetri::cli
