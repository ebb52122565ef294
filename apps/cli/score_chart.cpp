// SPDX-License-Identifier: MIT
#include "score_chart.h"

#include <algorithm>
#include <vector>

#include "puppetri/base/text.h"

namespace puppetri::cli {
namespace {

constexpr int kMostBands = 4;
constexpr int kRoomForName = 6;  // columns that a movement should have on average

// A stretch of time drawn as one block of rows, like a system of a music score.
class Band {
 public:
    Band(double begin_s, double length_s, std::size_t width)
        : begin_s_(begin_s), length_s_(length_s), width_(width) {}

    // A movement of row `row`; what was drawn there before ends.
    void add(std::string& row, const stage::ScoreEntry& entry) const {
        const double from = (entry.start.seconds() - begin_s_) / length_s_;
        const double to =
            entry.left == SimTime::never() ? 1 : (entry.left.seconds() - begin_s_) / length_s_;
        if (from >= 1 || to <= 0) {
            return;
        }
        const bool goes_on = from < 0;
        const auto begin =
            goes_on ? 0 : static_cast<std::size_t>(from * static_cast<double>(width_));
        const auto end = std::min(
            width_,
            std::max(begin + 1, static_cast<std::size_t>(to * static_cast<double>(width_))));
        std::fill(row.begin() + static_cast<std::ptrdiff_t>(begin),
                  row.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        row[begin] = goes_on ? '.' : '|';
        const std::size_t room = end - begin - 1;
        // One or two letters say nothing.
        if (room >= std::min<std::size_t>(entry.movement.size(), 3)) {
            std::copy_n(entry.movement.begin(), std::min(room, entry.movement.size()),
                        row.begin() + static_cast<std::ptrdiff_t>(begin + 1));
        }
    }

    std::string axis(std::size_t indent) const {
        // The smallest round step that leaves room for its labels.
        double step_s = 0.1;
        const double kFactors[] = {2, 2.5, 2};
        for (int i = 0; length_s_ / step_s * 10 > static_cast<double>(width_); ++i) {
            step_s *= kFactors[i % 3];
        }
        std::string line(indent + width_ + 12, ' ');
        for (int i = 0; i * step_s <= length_s_ + 1e-9; ++i) {
            const double at_s = begin_s_ + i * step_s;
            const std::string label =
                number_to_text(static_cast<double>(static_cast<long>(at_s * 10 + 0.5)) / 10) + " s";
            line.replace(indent + static_cast<std::size_t>(i * step_s / length_s_ *
                                                           static_cast<double>(width_)),
                         label.size(), label);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        return line + "\n";
    }

 private:
    double begin_s_, length_s_;
    std::size_t width_;
};

// Movements one after the other.
struct Line {
    std::string name;  // of the actor; empty for its further lines
    std::vector<const stage::ScoreEntry*> entries;
    SimTime free_at{0};

    void add(const stage::ScoreEntry& entry) {
        entries.push_back(&entry);
        free_at = entry.left;
    }
};

// The first line of this actor (from number `first` on) that is free at this instant; a new one if
// need be.
Line& line_for(std::vector<Line>& lines, std::size_t first, const std::string& name, SimTime at) {
    for (std::size_t i = first; i < lines.size(); ++i) {
        if (lines[i].free_at <= at) {
            return lines[i];
        }
    }
    lines.push_back({lines.size() == first ? name : "", {}, {}});
    return lines.back();
}

// The longest round length that gives movements room on average.
double band_length_s(const stage::Performance& performance, double end_s, std::size_t rows,
                     std::size_t width) {
    const double mean_s =
        end_s * static_cast<double>(rows) / static_cast<double>(performance.score().size());
    const double wanted_s = mean_s * static_cast<double>(width) / kRoomForName;
    double length_s = 1;
    const double kFactors[] = {2, 2.5, 2};
    for (int i = 0; length_s * kFactors[i % 3] <= wanted_s; ++i) {
        length_s *= kFactors[i % 3];
    }
    return std::min(length_s, end_s);
}

}  // namespace

std::string score_chart(const stage::Performance& performance, SimTime end, int columns) {
    const auto width = static_cast<std::size_t>(columns);
    const double end_s = end.seconds();
    if (performance.score().empty() || end_s <= 0) {
        return "";
    }
    const auto row_of = [](const stage::ScoreEntry& entry) -> const std::string& {
        return entry.actor.empty() ? entry.prop : entry.actor;
    };
    // In the order of the cast; movements of one actor that run side by side get lines of their
    // own.
    std::vector<std::string> names;
    for (const stage::ActorView& a : performance.actors()) {
        names.push_back(a.name);
    }
    for (const stage::PropView& p : performance.props()) {
        names.push_back(p.name);
    }
    std::vector<Line> lines;
    std::size_t name_width = 0;
    for (const std::string& name : names) {
        const std::size_t first = lines.size();
        for (const stage::ScoreEntry& entry : performance.score()) {
            if (row_of(entry) == name) {
                line_for(lines, first, name, entry.start).add(entry);
                name_width = std::max(name_width, name.size());
            }
        }
    }
    const double length_s = band_length_s(performance, end_s, lines.size(), width);
    std::string text;
    for (int i = 0; i < kMostBands && i * length_s < end_s - 1e-9; ++i) {
        const Band band(i * length_s, length_s, width);
        text += (i > 0 ? "\n" : "") + band.axis(name_width + 4);
        for (const Line& line : lines) {
            std::string row(width, ' ');
            for (const stage::ScoreEntry* entry : line.entries) {
                band.add(row, *entry);
            }
            row.erase(row.find_last_not_of(' ') + 1);
            text +=
                "  " + line.name + std::string(name_width - line.name.size() + 2, ' ') + row + "\n";
        }
    }
    if (kMostBands * length_s < end_s - 1e-9) {
        text += "  ... (the first " + number_to_text(kMostBands * length_s) +
                " s; --score FILE has all)\n";
    }
    return text;
}

}  // namespace puppetri::cli
