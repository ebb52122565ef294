// SPDX-License-Identifier: MIT
// The page: plain HTML with drawings in SVG, nothing loaded from anywhere.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "puppetri/io/xml_escaped.h"
#include "sweep_report.h"

namespace puppetri::cli {
namespace {

constexpr double kWidth = 420, kHeight = 240, kLeft = 58, kRight = 14, kTop = 14, kBottom = 40;

std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", x);
    return text;
}

std::string label(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", std::abs(x) < 1e-12 ? 0 : x);
    return text;
}

// An axis with round steps that covers low .. high.
struct Axis {
    double low = 0, high = 1, step = 1;
    Axis(double from, double to) {
        if (!(to > from)) {
            const double room = from == 0 ? 1 : std::abs(from) * 0.1;
            from -= room;
            to += room;
        }
        const double rough = (to - from) / 5;
        const double power = std::pow(10, std::floor(std::log10(rough)));
        const double ratio = rough / power;
        step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
        low = std::floor(from / step) * step;
        high = std::ceil(to / step) * step;
    }
    double share(double x) const { return (x - low) / (high - low); }
};

double x_of(double share) { return kLeft + share * (kWidth - kLeft - kRight); }
double y_of(double share) { return kHeight - kBottom - share * (kHeight - kTop - kBottom); }

std::string line(double x1, double y1, double x2, double y2, const char* style) {
    return "<line x1='" + number(x1) + "' y1='" + number(y1) + "' x2='" + number(x2) + "' y2='" +
           number(y2) + "' class='" + style + "'/>";
}

std::string text_at(double x, double y, const std::string& text, const char* anchor) {
    return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor + "'>" +
           io::xml_escaped(text) + "</text>";
}

std::string frame(const Axis& y) {
    std::string svg;
    for (double v = y.low; v <= y.high + y.step / 2; v += y.step) {
        const double at = y_of(y.share(v));
        svg += line(kLeft, at, kWidth - kRight, at, "grid");
        svg += text_at(kLeft - 6, at + 4, label(v), "end");
    }
    return svg;
}

std::string figure(const MeasureName& measure, const std::string& inside) {
    const std::string unit = measure.unit.empty() ? "" : " [" + measure.unit + "]";
    return "<figure><figcaption>" + io::xml_escaped(measure.name + unit) +
           "</figcaption><svg viewBox='0 0 " + number(kWidth) + " " + number(kHeight) + "'>" +
           inside + "</svg></figure>\n";
}

std::string point_name(const SweepPoint& point) {
    std::string name;
    for (const scene::Setting& s : point.settings) {
        name += (name.empty() ? "" : ", ") + s.value;
    }
    return name;
}

// Means and intervals by point; along a true axis where one parameter varies and all are numbers.
std::string means_plot(const SweepResult& result, std::size_t m) {
    const std::size_t n = result.points.size();
    std::vector<double> at(n);
    bool numeric = result.points[0].settings.size() == 1;
    for (std::size_t i = 0; i < n; ++i) {
        char* end = nullptr;
        const std::string value = numeric ? result.points[i].settings[0].value : "";
        at[i] = std::strtod(value.c_str(), &end);
        numeric = numeric && end != value.c_str();
    }
    double low = INFINITY, high = -INFINITY;
    for (const SweepPoint& p : result.points) {
        const sim::Confidence& c = p.outcome.means[m];
        if (std::isnan(c.mean)) {
            continue;
        }
        const double half = std::isfinite(c.half_width) ? c.half_width : 0;
        low = std::min(low, c.mean - half);
        high = std::max(high, c.mean + half);
    }
    const Axis y(low, high);
    const Axis x(numeric ? *std::min_element(at.begin(), at.end()) : 0,
                 numeric ? *std::max_element(at.begin(), at.end()) : static_cast<double>(n));
    const auto place = [&](std::size_t i) {
        return x_of(numeric ? x.share(at[i])
                            : (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    };
    std::string svg = frame(y), path;
    if (numeric) {
        for (double v = x.low; v <= x.high + x.step / 2; v += x.step) {
            svg += text_at(x_of(x.share(v)), kHeight - kBottom + 16, label(v), "middle");
        }
    }
    const std::size_t every = std::max<std::size_t>(1, n / 8);
    for (std::size_t i = 0; i < n; ++i) {
        const sim::Confidence& c = result.points[i].outcome.means[m];
        if (std::isnan(c.mean)) {
            continue;
        }
        const double px = place(i), py = y_of(y.share(c.mean));
        if (std::isfinite(c.half_width)) {
            svg += line(px, y_of(y.share(c.mean - c.half_width)), px,
                        y_of(y.share(c.mean + c.half_width)), "bar");
        }
        svg += "<circle cx='" + number(px) + "' cy='" + number(py) + "' r='3'><title>" +
               io::xml_escaped(point_name(result.points[i])) + ": " +
               with_precision(c.mean, c.half_width) + " &#177; " +
               with_precision(c.half_width, c.half_width) + "</title></circle>";
        path += (path.empty() ? "M" : "L") + number(px) + " " + number(py);
        if (!numeric && i % every == 0) {
            svg += text_at(px, kHeight - kBottom + 16, point_name(result.points[i]), "middle");
        }
    }
    if (numeric) {
        svg += "<path d='" + path + "'/>";
    }
    std::string axis;
    for (const scene::Setting& s : result.points[0].settings) {
        axis += (axis.empty() ? "" : ", ") + s.path;
    }
    return svg + text_at((kLeft + kWidth - kRight) / 2, kHeight - 6, axis, "middle");
}

// How the replications of the only point spread.
std::string histogram(const sim::Outcome& outcome, std::size_t m) {
    std::vector<double> values;
    for (std::size_t i = 0; i < outcome.numbers.size(); ++i) {
        if (const double x = outcome.row(i)[m]; !std::isnan(x)) {
            values.push_back(x);
        }
    }
    if (values.empty()) {
        return "";
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const Axis x(*least, *most);
    // Sturges' rule, on the axis
    const auto bins =
        static_cast<std::size_t>(std::ceil(std::log2(static_cast<double>(values.size())) + 1) * 2);
    std::vector<double> counts(bins, 0);
    for (const double v : values) {
        const auto bin = static_cast<std::size_t>(x.share(v) * static_cast<double>(bins));
        ++counts[std::min(bin, bins - 1)];
    }
    const Axis y(0, *std::max_element(counts.begin(), counts.end()));
    std::string svg = frame(y);
    for (std::size_t i = 0; i < bins; ++i) {
        const double left = x_of(static_cast<double>(i) / static_cast<double>(bins)),
                     right = x_of(static_cast<double>(i + 1) / static_cast<double>(bins)),
                     top = y_of(y.share(counts[i]));
        svg += "<rect x='" + number(left + 0.5) + "' y='" + number(top) + "' width='" +
               number(right - left - 1) + "' height='" + number(y_of(0) - top) + "'/>";
    }
    for (double v = x.low; v <= x.high + x.step / 2; v += x.step) {
        svg += text_at(x_of(x.share(v)), kHeight - kBottom + 16, label(v), "middle");
    }
    const sim::Confidence& c = outcome.means[m];
    svg += line(x_of(x.share(c.mean)), y_of(0), x_of(x.share(c.mean)), kTop, "mean");
    return svg + text_at((kLeft + kWidth - kRight) / 2, kHeight - 6,
                         "replications by value; mean in red", "middle");
}

}  // namespace

std::string sweep_page(const SweepResult& result) {
    std::string out =
        "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
        "content='width=device-width'><title>" +
        io::xml_escaped(result.title) +
        "</title><style>\n"
        "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1320px;padding:0 1em;"
        "color:#222;background:#fff}\n"
        "h1{font-size:1.4em;margin-bottom:.2em}p{color:#666;margin-top:0}\n"
        "main{display:grid;grid-template-columns:repeat(auto-fill,minmax(380px,1fr));gap:18px}\n"
        "figure{margin:0;border:1px solid #ddd;border-radius:8px;padding:10px}\n"
        "figcaption{font-weight:600}svg{width:100%;height:auto}svg text{font-size:11px;fill:#555}\n"
        ".grid{stroke:#e6e6e6}.bar{stroke:#1f77b4;stroke-width:1.5}.mean{stroke:#d62728;"
        "stroke-width:1.5}\n"
        "circle,rect{fill:#1f77b4}path{fill:none;stroke:#1f77b4;stroke-opacity:.5}\n"
        "table{border-collapse:collapse;margin-top:1.5em}td,th{padding:2px 12px 2px 0;"
        "text-align:left;border-bottom:1px solid #eee}td.n{text-align:right;"
        "font-variant-numeric:tabular-nums}\n"
        "</style></head><body>\n<h1>" +
        io::xml_escaped(result.title) + "</h1>\n<p>" + io::xml_escaped(result.scene) +
        " &#183; seed " + std::to_string(result.seed);
    if (result.horizon_s > 0) {
        out += " &#183; " + label(result.horizon_s) + " s each";
    }
    if (result.warm_up_s > 0) {
        out += ", warm-up " + label(result.warm_up_s) + " s";
    }
    if (result.batch_s > 0) {
        out += ", batches of " + label(result.batch_s) + " s of one run";
    }
    out += " &#183; intervals of " + label(100 * result.level) + " %</p>\n<main>\n";
    const bool varied = result.points.size() > 1;
    std::vector<std::size_t> shown;
    for (std::size_t m = 0; m < result.measures.size(); ++m) {
        const bool moves =
            std::any_of(result.points.begin(), result.points.end(), [&](const SweepPoint& p) {
                return std::any_of(p.outcome.numbers.begin(), p.outcome.numbers.end(),
                                   [&, i = std::size_t{0}](std::uint64_t) mutable {
                                       const double x = p.outcome.row(i++)[m];
                                       return x != 0 && !std::isnan(x);
                                   });
            });
        if (moves) {
            shown.push_back(m);
        }
    }
    for (const std::size_t m : shown) {
        out += figure(result.measures[m],
                      varied ? means_plot(result, m) : histogram(result.points[0].outcome, m));
    }
    out += "</main>\n<table><tr>";
    for (const scene::Setting& s : result.points[0].settings) {
        out += "<th>" + io::xml_escaped(s.path) + "</th>";
    }
    out += "<th>measure</th><th>mean</th><th>&#177;</th><th>unit</th><th>replications</th></tr>\n";
    for (const std::size_t m : shown) {
        for (const SweepPoint& point : result.points) {
            out += "<tr>";
            for (const scene::Setting& s : point.settings) {
                out += "<td>" + io::xml_escaped(s.value) + "</td>";
            }
            const sim::Confidence& c = point.outcome.means[m];
            out += "<td>" + io::xml_escaped(result.measures[m].name) + "</td><td class='n'>" +
                   with_precision(c.mean, c.half_width) + "</td><td class='n'>" +
                   with_precision(c.half_width, c.half_width) + "</td><td>" +
                   result.measures[m].unit + "</td><td class='n'>" +
                   std::to_string(point.outcome.numbers.size()) + "</td></tr>\n";
        }
    }
    return out + "</table>\n</body></html>\n";
}

}  // namespace puppetri::cli
