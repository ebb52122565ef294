// SPDX-License-Identifier: MIT
// The log and the score as CSV, and what a run has to say in the end.
#pragma once
#include <optional>
#include <string>

#include "puppetri/io/atomic_file.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/perform.h"

namespace puppetri::cli {

// Writes `tick,seconds,transition` while a run goes on, in pieces, to a file that is whole or
// absent.
class CsvLog final : public run::LogSink {
 public:
    static Result<CsvLog, Diagnostics> open(const std::string& path, const net::Net& net);
    void fired(SimTime at, net::TransitionIndex transition) override;
    Status commit();

 private:
    CsvLog(io::AtomicFile file, const net::Net& net) : file_(std::move(file)), net_(&net) {}
    void flush();

    io::AtomicFile file_;
    const net::Net* net_;
    std::string buffer_;
    Diagnostics problems_;
};

// start_tick,end_tick,left_tick,start_seconds,end_seconds,place,actor,limbs,movement,prop,instance;
// left_tick is empty while the token has not left. Limbs stand side by side with + between them.
std::string score_csv(const stage::Performance& performance);

// "at the horizon", "at rest in a final marking", ...
std::string describe(const scene::Performed& performed);

// One JSON object about a run; `measures` is one in it, "{}" for none.
std::string run_json(const scene::Scene& scene, const scene::Performed& performed,
                     const std::string& measures);

// The lines that people read after a run.
std::string run_summary(const scene::Scene& scene, const scene::Performed& performed);

// Sixteen hexadecimal digits.
std::string hash_text_of(std::uint64_t hash);

}  // namespace puppetri::cli
