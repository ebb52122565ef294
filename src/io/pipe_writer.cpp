// SPDX-License-Identifier: MIT
// PIPE out, as its version 4 writes it. Delays become rates, odds the rates of immediate
// transitions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "loops.h"
#include "net_features.h"
#include "net_writers.h"
#include "puppetri/base/text.h"
#include "puppetri/io/xml_escaped.h"

namespace puppetri::io {
namespace {

// The shortest decimal r with 1/r == mean.
std::string rate_of_mean(double mean) {
    const double about = 1 / mean;
    std::string best;
    double candidate = about;
    for (int i = 0; i < 4; ++i) {
        candidate = std::nextafter(candidate, 0.0);
    }
    for (int i = 0; i < 9; ++i) {
        if (1 / candidate == mean) {
            std::string text = number_to_text(candidate);
            if (best.empty() || text.size() < best.size()) {
                best = std::move(text);
            }
        }
        candidate = std::nextafter(candidate, std::numeric_limits<double>::infinity());
    }
    return best.empty() ? number_to_text(about) : best;
}

class Writer {
 public:
    Writer(const NetFile& file, Diagnostics& notes)
        : draft_(file.draft), look_(file.look), notes_(notes) {}

    std::string run() {
        out_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<pnml>\n<net id=\"" +
               xml_escaped(draft_.name) +
               "\" type=\"P/T net\">\n"
               "<token id=\"Default\" enabled=\"true\" red=\"0\" green=\"0\" blue=\"0\"/>\n";
        for (std::uint32_t i = 0; i < draft_.places.size(); ++i) {
            place(i);
        }
        // Immediate priorities begin at 1; only their order counts.
        std::int64_t least = 1;
        for (const net::TransitionDraft& t : draft_.transitions) {
            least = t.delay ? least : std::min(least, t.priority);
        }
        for (std::uint32_t i = 0; i < draft_.transitions.size(); ++i) {
            transition(i, 1 - least);
        }
        for (const net::TransitionDraft& t : draft_.transitions) {
            arcs(t);
        }
        out_ += "</net>\n</pnml>\n";
        return std::move(out_);
    }

 private:
    std::string position(const std::vector<ElementLook>& looks, std::size_t count, std::uint32_t i,
                         double row) const {
        double x = 60 + 90 * (i % 12), y = 60 + 180 * (i / 12) + row;
        if (looks.size() == count && looks[i].at) {
            x = looks[i].at->x;
            y = looks[i].at->y;
        }
        return "<graphics>\n<position x=\"" + number_to_text(x) + "\" y=\"" + number_to_text(y) +
               "\"/>\n</graphics>\n";
    }

    static std::string value(const char* tag, const std::string& text) {
        return std::string("<") + tag + ">\n<value>" + xml_escaped(text) + "</value>\n</" + tag +
               ">\n";
    }
    static std::string drawn_value(const char* tag, const std::string& text) {
        return std::string("<") + tag + ">\n<value>" + xml_escaped(text) +
               "</value>\n<graphics/>\n</" + tag + ">\n";
    }

    void place(std::uint32_t i) {
        const net::PlaceDraft& p = draft_.places[i];
        out_ += "<place id=\"" + xml_escaped(p.path) + "\">\n" +
                position(look_.places, draft_.places.size(), i, 0) +
                drawn_value("name", p.caption.empty() ? p.path : p.caption) +
                drawn_value("initialMarking", "Default," + std::to_string(initial_tokens(p))) +
                value("capacity", std::to_string(p.capacity.value_or(0))) + "</place>\n";
    }

    void transition(std::uint32_t i, std::int64_t shift) {
        const net::TransitionDraft& t = draft_.transitions[i];
        double mean = 0;
        const bool timed = t.delay && is_exponential(t.delay->duration, mean);
        std::string rate = "1.0";
        if (timed) {
            rate = rate_of_mean(mean);
        } else if (t.odds && t.odds->is_literal()) {
            const Value v = t.odds->literal_value();
            rate = number_to_text(t.odds->type().kind == ValueKind::kReal ? real_of_value(v)
                                                                          : static_cast<double>(v));
        }
        const bool infinite = timed && t.delay->servers == net::DelayDraft::kInfiniteServers;
        out_ += "<transition id=\"" + xml_escaped(t.path) + "\">\n" +
                position(look_.transitions, draft_.transitions.size(), i, 90) +
                drawn_value("name", t.caption.empty() ? t.path : t.caption) +
                value("orientation", "0") + value("rate", rate) +
                value("timed", timed ? "true" : "false") +
                value("infiniteServer", infinite ? "true" : "false") +
                value("priority", std::to_string(timed ? 1 : t.priority + shift)) +
                "</transition>\n";
    }

    void arc(const std::string& source, const std::string& target, std::int64_t weight,
             const char* type) {
        out_ += "<arc id=\"" + xml_escaped(source) + " to " + xml_escaped(target) +
                (arc_ids_ > 0 ? " " + std::to_string(arc_ids_) : "") + "\" source=\"" +
                xml_escaped(source) + "\" target=\"" + xml_escaped(target) + "\">\n<graphics/>\n" +
                drawn_value("inscription", "Default," + std::to_string(weight)) +
                value("tagged", "false") + "<type value=\"" + type + "\"/>\n</arc>\n";
        ++arc_ids_;
    }

    void arcs(const net::TransitionDraft& t) {
        const bool plain = std::all_of(t.inputs.begin(), t.inputs.end(), [](const auto& a) {
            const net::ArcKind kind = plain_kind(a.kind);
            return kind == net::ArcKind::kTake || kind == net::ArcKind::kUnless;
        });
        if (plain) {
            for (const net::ArcDraft& a : t.inputs) {
                arc(draft_.places[a.place.value].path, t.path, a.weight,
                    plain_kind(a.kind) == net::ArcKind::kUnless ? "inhibitor" : "normal");
            }
            for (const net::OutputDraft& o : t.outputs) {
                arc(t.path, draft_.places[o.place.value].path, o.weight, "normal");
            }
            return;
        }
        const Loops loops = with_loops(t);
        for (const auto& [place, weight] : loops.takes) {
            arc(draft_.places[place].path, t.path, weight, "normal");
        }
        for (const auto& [place, weight] : loops.unless) {
            arc(draft_.places[place].path, t.path, weight, "inhibitor");
        }
        for (const auto& [place, weight] : loops.gives) {
            arc(t.path, draft_.places[place].path, weight, "normal");
        }
        if (!told_) {
            notes_.push_back({Severity::kNote, "read-as-loop", t.where, "transition " + t.path,
                              "read arcs are written as a taking and a giving back", ""});
            told_ = true;
        }
    }

    const net::NetDraft& draft_;
    const NetLook& look_;
    Diagnostics& notes_;
    std::string out_;
    std::uint64_t arc_ids_ = 0;
    bool told_ = false;
};

}  // namespace

std::string pipe_text(const NetFile& file, Diagnostics& notes) { return Writer(file, notes).run(); }

}  // namespace puppetri::io
