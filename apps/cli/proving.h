// SPDX-License-Identifier: MIT
// What `prove` and `explain` share: the options of a proof, the subject (a scene or a foreign net),
// budgets as people write them, progress, witnesses as files.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "puppetri/io/net_file.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/prove.h"

namespace puppetri::cli {

// --time, --memory, --threads, --events-at-most, -o.
std::vector<Option> with_proving_options(std::vector<Option> options);

// A scene, or the net of another file.
struct Subject {
    std::unique_ptr<const scene::Scene> scene;
    std::unique_ptr<const io::NetFile> file;
    std::unique_ptr<const net::Net> net;  // of `file`
};
// Says what is wrong and gives the exit code otherwise.
Result<Subject, int> load_subject(const std::string& path, const Arguments& arguments);

// "30", "30s", "5min"; "500M", "2G" (powers of 1024; without letter MiB).
std::optional<double> parse_seconds(const std::string& text);
std::optional<std::uint64_t> parse_bytes(const std::string& text);

Result<verdict::ProveOptions, int> proving_options(const Arguments& arguments);

// Shows states, rate and memory on a terminal while it lives, and makes Ctrl-C stop the proof.
class ProvingProgress {
 public:
    explicit ProvingProgress(verdict::ProveOptions& options);
    ~ProvingProgress();
    ProvingProgress(const ProvingProgress&) = delete;
    ProvingProgress& operator=(const ProvingProgress&) = delete;

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

std::vector<verdict::Verdict> prove_subject(const Subject& subject,
                                            const verdict::ProveOptions& options);

// FOLDER/RULE.witness.json, with odd characters of the rule's path replaced.
std::string witness_path(const std::string& folder, const std::string& rule);

// Seconds of a clock that only goes on.
double clock_s();

// "1.2 s", "3 ms".
std::string seconds_text(double seconds);

}  // namespace puppetri::cli
