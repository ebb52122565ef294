// SPDX-License-Identifier: MIT
// What a sweep has played, line by line on the disk, so that a killed one goes on, and so that
// several processes share one: each writes a file of its own and reads those of the others.
#pragma once
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/sim/replicate.h"

namespace puppetri::cli {

// The part of the replications that this process plays: those whose number (or pair) is `rank`
// modulo `ranks`.
struct Share {
    unsigned rank = 0, ranks = 1;
    // Its fellows run at the same time (mpirun), so that waiting for them makes sense; else they
    // may run one after another (a Slurm array).
    bool together = false;
};

// From the environment: Open MPI's, Slurm's (srun and arrays); otherwise all of it.
Share share_of_environment();

// The rows of one point of a sweep.
class PointJournal final : public sim::Journal {
 public:
    Known recall(std::uint64_t number, std::span<double> values, Diagnostic& fault) override;
    void keep(std::uint64_t number, std::span<const double> values) override;
    void keep_failure(std::uint64_t number, const Diagnostic& fault) override;
    void settle() override;
    bool wait() override;

 private:
    friend class SweepJournal;
    class SweepJournal* owner_ = nullptr;
    std::size_t point_ = 0;
    std::map<std::uint64_t, std::vector<double>> rows_;
    std::map<std::uint64_t, Diagnostic> failures_;
};

class SweepJournal {
 public:
    // In the folder, which is made if it is not there. `fingerprint` says which experiment it is:
    // another one's folder is refused.
    // Fails   "other-sweep", "cannot-write".
    static Checked<std::unique_ptr<SweepJournal>> open(const std::string& folder,
                                                       std::uint64_t fingerprint,
                                                       std::size_t points, std::size_t width,
                                                       const Share& share);
    ~SweepJournal();
    SweepJournal(const SweepJournal&) = delete;
    SweepJournal& operator=(const SweepJournal&) = delete;

    PointJournal& point(std::size_t i) { return points_[i]; }
    // Reads what the others have written meanwhile. Gives whether there was any.
    bool refresh();
    // Writing failed, once (a full disk): the sweep goes on, but could not be resumed.
    bool broken() const { return broken_; }

 private:
    friend class PointJournal;
    SweepJournal() = default;
    void read(const std::string& path, std::uint64_t& offset);
    void write(const std::string& line);
    void settle();

    std::string folder_;
    std::uint64_t fingerprint_ = 0;
    std::size_t width_ = 0;
    std::vector<PointJournal> points_;
    std::map<std::string, std::uint64_t> offsets_;  // read so far, by file
    std::FILE* file_ = nullptr;
    std::string own_;
    bool broken_ = false, together_ = false;
};

}  // namespace puppetri::cli
