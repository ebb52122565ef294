// SPDX-License-Identifier: MIT
#include "sweep_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "csv.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/sim/tally.h"

namespace puppetri::cli {
namespace {

std::string exact(double x) {
    if (!std::isfinite(x)) {
        return "";
    }
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    for (int digits = 1; digits < 17; ++digits) {
        char shorter[40];
        std::snprintf(shorter, sizeof shorter, "%.*g", digits, x);
        if (std::strtod(shorter, nullptr) == x) {
            return shorter;
        }
    }
    return text;
}

bool all_zero(const SweepResult& result, std::size_t column) {
    return std::all_of(result.points.begin(), result.points.end(), [&](const SweepPoint& p) {
        const sim::Tally& t = p.outcome.tallies[column];
        return t.count() == 0 || (t.low() == 0 && t.high() == 0);
    });
}

std::string padded(const std::string& text, std::size_t width, bool right) {
    std::size_t points = 0;  // code points
    for (const char c : text) {
        points += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }
    const std::string space(width > points ? width - points : 0, ' ');
    return right ? space + text : text + space;
}

}  // namespace

std::string with_precision(double x, double half_width) {
    if (!std::isfinite(x)) {
        return "-";
    }
    char text[40];
    // Two digits of the interval, and as many of the mean: 1740 and 220, 0.119 and 0.026
    if (half_width >= 1e-4 && half_width < 1e7 && std::abs(x) < 1e9) {
        const int last = static_cast<int>(std::floor(std::log10(half_width))) - 1;
        const double unit = std::pow(10.0, last);
        const double rounded = last > 0 ? std::round(x / unit) * unit : x;
        std::snprintf(text, sizeof text, "%.*f", std::max(-last, 0), rounded);
        return text;
    }
    int digits = 6;
    if (std::isfinite(half_width) && half_width > 0) {
        digits = std::clamp(
            2 + static_cast<int>(std::floor(std::log10(std::max(std::abs(x), half_width)) -
                                            std::floor(std::log10(half_width)))),
            2, 12);
    }
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return text;
}

std::string sweep_csv(const SweepResult& result) {
    std::string out;
    if (!result.points.empty()) {
        for (const scene::Setting& s : result.points[0].settings) {
            out += csv_field(s.path) + ",";
        }
    }
    out += "measure,unit,replications,failed,mean,half_width,deviation,least,most\n";
    for (const SweepPoint& point : result.points) {
        std::string parameters;
        for (const scene::Setting& s : point.settings) {
            parameters += csv_field(s.value) + ",";
        }
        for (std::size_t m = 0; m < result.measures.size(); ++m) {
            const sim::Tally& t = point.outcome.tallies[m];
            out += parameters + csv_field(result.measures[m].name) + "," + result.measures[m].unit +
                   "," + std::to_string(t.count()) + "," +
                   std::to_string(point.outcome.failures.size()) + "," +
                   exact(point.outcome.means[m].mean) + "," +
                   exact(point.outcome.means[m].half_width) + "," + exact(t.deviation()) + "," +
                   exact(t.low()) + "," + exact(t.high()) + "\n";
        }
    }
    return out;
}

std::string sweep_json(const SweepResult& result) {
    io::JsonWriter json;
    json.begin_object();
    json.member("scene", result.scene);
    json.member("seed", static_cast<std::int64_t>(result.seed));
    json.member("level", result.level);
    if (result.horizon_s > 0) {
        json.member("horizon_s", result.horizon_s);
    }
    json.member("warm_up_s", result.warm_up_s);
    if (result.batch_s > 0) {
        json.member("batch_s", result.batch_s);
    }
    json.key("points").begin_array();
    for (const SweepPoint& point : result.points) {
        const sim::Outcome& o = point.outcome;
        json.begin_object();
        json.key("parameters").begin_object();
        for (const scene::Setting& s : point.settings) {
            json.member(s.path, s.value);
        }
        json.end_object();
        json.member("replications", static_cast<std::int64_t>(o.numbers.size()));
        json.member("interrupted", o.interrupted);
        json.member("precise_enough", o.precise_enough);
        json.key("measures").begin_object();
        for (std::size_t m = 0; m < result.measures.size(); ++m) {
            const sim::Tally& t = o.tallies[m];
            json.key(result.measures[m].name).begin_object();
            json.member("unit", result.measures[m].unit);
            if (!result.measures[m].caption.empty()) {
                json.member("caption", result.measures[m].caption);
            }
            json.member("replications", static_cast<std::int64_t>(t.count()));
            json.member("mean", o.means[m].mean);
            json.member("half_width", o.means[m].half_width);
            json.member("deviation", t.deviation());
            json.member("least", t.low());
            json.member("most", t.high());
            json.end_object();
        }
        json.end_object();
        json.key("failures").begin_array();
        for (const sim::Failure& f : o.failures) {
            json.begin_object();
            json.member("replication", static_cast<std::int64_t>(f.replication.number));
            // As a text: most readers of JSON keep 53 bits
            json.member("seed", std::to_string(f.replication.seed));
            json.member("code", f.why.code);
            json.member("message", f.why.message);
            json.end_object();
        }
        json.end_array();
        json.end_object();
    }
    json.end_array();
    json.end_object();
    return json.take();
}

std::string sweep_table(const SweepResult& result, bool all) {
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> head;
    const bool varied = !result.points.empty() && !result.points[0].settings.empty();
    if (varied) {
        for (const scene::Setting& s : result.points[0].settings) {
            head.push_back(s.path);
        }
    }
    for (const char* h : {"measure", "mean", "+-", "least", "most", "unit"}) {
        head.emplace_back(h);
    }
    rows.push_back(head);
    for (std::size_t m = 0; m < result.measures.size(); ++m) {
        if (!all && all_zero(result, m)) {
            continue;
        }
        for (const SweepPoint& point : result.points) {
            std::vector<std::string> row;
            for (const scene::Setting& s : point.settings) {
                row.push_back(s.value);
            }
            const sim::Confidence& c = point.outcome.means[m];
            const sim::Tally& t = point.outcome.tallies[m];
            row.push_back(result.measures[m].name);
            row.push_back(with_precision(c.mean, c.half_width));
            row.push_back(std::isfinite(c.half_width) ? with_precision(c.half_width, c.half_width)
                                                      : "?");
            row.push_back(with_precision(t.low(), 0));
            row.push_back(with_precision(t.high(), 0));
            row.push_back(result.measures[m].unit);
            rows.push_back(std::move(row));
        }
    }
    std::vector<std::size_t> widths(head.size(), 0);
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    std::string out;
    const std::size_t text_columns = head.size() - 5;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const bool right = i >= text_columns && i + 1 < row.size();
            line += padded(row[i], widths[i], right) + (i + 1 < row.size() ? "  " : "");
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

}  // namespace puppetri::cli
