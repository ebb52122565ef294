// SPDX-License-Identifier: MIT
#include "logs.h"

#include <algorithm>
#include <cstdio>

#include "csv.h"
#include "puppetri/base/text.h"
#include "puppetri/motion/library.h"
#include "score_chart.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

std::string seconds(SimTime t) { return number_to_text(t.seconds()); }

std::string limbs_text(motion::LimbSet limbs) {
    std::string text;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        const auto limb = static_cast<motion::Limb>(i);
        if (limbs.has(limb)) {
            text += (text.empty() ? "" : "+") + std::string(motion::name_of(limb));
        }
    }
    return text;
}

const char* word_of(const scene::Performed& p) {
    if (p.interrupted) {
        return "interrupted";
    }
    switch (p.stop) {
        case run::Stop::kDead:
            return "dead";
        case run::Stop::kFinal:
            return "final";
        case run::Stop::kFault:
            return "fault";
        default:
            return "limit";
    }
}

std::int64_t frames(const scene::Scene& scene, SimTime end) {
    const double exact = end.seconds() * scene.frame_rate.per_second();
    return static_cast<std::int64_t>(exact + 0.5);
}

}  // namespace

Result<CsvLog, Diagnostics> CsvLog::open(const std::string& path, const net::Net& net) {
    PUP_TRY(io::AtomicFile file, io::AtomicFile::open(path));
    CsvLog log(std::move(file), net);
    log.buffer_ = "tick,seconds,transition\n";
    return log;
}

void CsvLog::fired(SimTime at, net::TransitionIndex transition) {
    buffer_ += std::to_string(at.ticks) + "," + seconds(at) + "," +
               csv_field(std::string(net_->transition(transition).path)) + "\n";
    if (buffer_.size() > (1u << 20)) {
        flush();
    }
}

void CsvLog::flush() {
    if (problems_.empty()) {
        if (auto written = file_.write(buffer_); !written) {
            problems_ = std::move(written.error());
        }
    }
    buffer_.clear();
}

Status CsvLog::commit() {
    flush();
    if (!problems_.empty()) {
        return Unexpected(std::move(problems_));
    }
    return file_.commit();
}

std::string score_csv(const stage::Performance& performance) {
    std::string text =
        "start_tick,end_tick,left_tick,start_seconds,end_seconds,place,actor,limbs,movement,prop,"
        "instance\n";
    for (const stage::ScoreEntry& e : performance.score()) {
        const std::string left = e.left == SimTime::never() ? "" : std::to_string(e.left.ticks);
        text += std::to_string(e.start.ticks) + "," + std::to_string(e.end.ticks) + "," + left +
                "," + seconds(e.start) + "," + seconds(e.end) + "," + csv_field(e.place) + "," +
                csv_field(e.actor) + "," + limbs_text(e.limbs) + "," + csv_field(e.movement) + "," +
                csv_field(e.prop) + "," + csv_field(e.instance) + "\n";
    }
    return text;
}

std::string describe(const scene::Performed& p) {
    if (p.interrupted) {
        return "interrupted";
    }
    switch (p.stop) {
        case run::Stop::kDead:
            return "nothing can happen any more";
        case run::Stop::kFinal:
            return "ended in a final marking";
        case run::Stop::kFault:
            return "stopped by an error";
        default:
            return "reached its horizon";
    }
}

std::string hash_text_of(std::uint64_t hash) {
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::string run_json(const scene::Scene& scene, const scene::Performed& p,
                     const std::string& measures) {
    std::string notes;
    for (const Diagnostic& d : p.notes) {
        notes += (notes.empty() ? "\n  " : ",\n  ") + to_json(d);
    }
    return "{\"scene\": \"" + json_escaped(scene.title) +
           "\", \"seed\": " + std::to_string(p.seed) + ", \"stop\": \"" + word_of(p) +
           "\", \"ticks\": " + std::to_string(p.end.ticks) + ", \"seconds\": " + seconds(p.end) +
           ", \"frames\": " + std::to_string(frames(scene, p.end)) +
           ", \"firings\": " + std::to_string(p.firings) +
           ", \"movements\": " + std::to_string(p.performance->score().size()) +
           ", \"log_hash\": \"" + hash_text_of(p.log_hash) + "\", \"measures\": " + measures +
           ", \"fault\": " + (p.fault ? to_json(*p.fault) : "null") + ", \"notes\": [" + notes +
           (notes.empty() ? "]}" : "\n]}");
}

std::string run_summary(const scene::Scene& scene, const scene::Performed& p) {
    std::string text =
        (scene.title.empty() ? scene.path : scene.title) + "\n" +
        score_chart(*p.performance, p.end, 72) + "  " + number_to_text_fixed(p.end.seconds(), 2) +
        " s (" + std::to_string(frames(scene, p.end)) + " frames), " + std::to_string(p.firings) +
        " firings, " + std::to_string(p.performance->score().size()) + " movements, seed " +
        std::to_string(p.seed) + "; " + describe(p);
    return text;
}

}  // namespace puppetri::cli
