// SPDX-License-Identifier: MIT
// Lines `POINT NUMBER VALUE ...` or `POINT NUMBER ! CODE MESSAGE`, values as hexadecimal floats so
// that they come back bit for bit. A last line without its end was cut off and does not count.
#include "sweep_journal.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "interrupt.h"

namespace puppetri::cli {
namespace {

namespace fs = std::filesystem;

std::string header_of(std::uint64_t fingerprint) {
    char text[64];
    std::snprintf(text, sizeof text, "puppetri sweep 1 %016llx\n",
                  static_cast<unsigned long long>(fingerprint));
    return text;
}

Diagnostic problem(const char* code, const std::string& path, std::string message,
                   std::string remedy) {
    Diagnostic d;
    d.code = code;
    d.where.file = path;
    d.message = std::move(message);
    d.remedy = std::move(remedy);
    return d;
}

// A whole number from the environment, or -1.
long environment(const char* name) {
    const char* text = std::getenv(name);
    if (text == nullptr || *text == '\0') {
        return -1;
    }
    char* end = nullptr;
    const long value = std::strtol(text, &end, 10);
    return *end == '\0' && value >= 0 ? value : -1;
}

}  // namespace

Share share_of_environment() {
    struct Names {
        const char *rank, *ranks, *first;
        bool together;
    };
    // The tasks of an array count from SLURM_ARRAY_TASK_MIN; inside of a task there is one process.
    static constexpr Names kNames[] = {
        {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr, true},
        {"PMI_RANK", "PMI_SIZE", nullptr, true},
        {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN", false},
        {"SLURM_PROCID", "SLURM_NTASKS", nullptr, true},
    };
    for (const Names& n : kNames) {
        const long first = n.first == nullptr ? 0 : std::max(0L, environment(n.first));
        const long rank = environment(n.rank) - first, ranks = environment(n.ranks);
        if (rank >= 0 && ranks > 1 && rank < ranks) {
            return {static_cast<unsigned>(rank), static_cast<unsigned>(ranks), n.together};
        }
    }
    return {};
}

Checked<std::unique_ptr<SweepJournal>> SweepJournal::open(const std::string& folder,
                                                          std::uint64_t fingerprint,
                                                          std::size_t points, std::size_t width,
                                                          const Share& share) {
    std::unique_ptr<SweepJournal> journal(new SweepJournal);
    journal->folder_ = folder;
    journal->fingerprint_ = fingerprint;
    journal->width_ = width;
    journal->together_ = share.together;
    journal->points_.resize(points);
    for (std::size_t i = 0; i < points; ++i) {
        journal->points_[i].owner_ = journal.get();
        journal->points_[i].point_ = i;
    }
    std::error_code failed;
    fs::create_directories(folder, failed);
    journal->own_ = (fs::path(folder) / ("rank-" + std::to_string(share.rank) + ".txt")).string();
    const std::string header = header_of(fingerprint);
    for (const auto& entry : fs::directory_iterator(folder, failed)) {
        std::ifstream in(entry.path(), std::ios::binary);
        std::string line;
        if (entry.path().extension() == ".txt" && std::getline(in, line) && line + "\n" != header) {
            return Unexpected(Diagnostics{
                problem("other-sweep", entry.path().string(),
                        "this folder has the replications of another sweep: another scene, other "
                        "values, measures, seed or horizon",
                        "name another folder, or remove this one")});
        }
    }
    journal->refresh();
    // What was cut off in the middle of a line goes
    std::error_code none;
    if (fs::exists(journal->own_, none)) {
        fs::resize_file(journal->own_, journal->offsets_[journal->own_], none);
    }
    journal->file_ = std::fopen(journal->own_.c_str(), "ab");
    if (journal->file_ == nullptr) {
        return Unexpected(Diagnostics{
            problem("cannot-write", journal->own_,
                    "the journal cannot be written: " + std::string(std::strerror(errno)),
                    "name a folder that can be written")});
    }
    if (std::fseek(journal->file_, 0, SEEK_END) == 0 && std::ftell(journal->file_) == 0) {
        std::fputs(header.c_str(), journal->file_);
        std::fflush(journal->file_);
    }
    return journal;
}

SweepJournal::~SweepJournal() {
    if (file_ != nullptr) {
        std::fclose(file_);
    }
}

bool SweepJournal::refresh() {
    bool more = false;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder_, failed)) {
        if (entry.path().extension() == ".txt") {
            const std::string path = entry.path().string();
            std::uint64_t& offset = offsets_[path];
            const std::uint64_t before = offset;
            read(path, offset);
            more = more || (offset != before && path != own_);
        }
    }
    return more;
}

void SweepJournal::read(const std::string& path, std::uint64_t& offset) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(offset));
    std::string line;
    while (std::getline(in, line) && !in.eof()) {
        const bool header = offset == 0;
        offset += line.size() + 1;
        if (header) {
            continue;
        }
        const char* at = line.c_str();
        char* end = nullptr;
        const unsigned long long point = std::strtoull(at, &end, 10);
        const unsigned long long number = std::strtoull(end, &end, 10);
        if (point >= points_.size()) {
            continue;
        }
        PointJournal& journal = points_[point];
        if (std::strncmp(end, " ! ", 3) == 0) {
            const std::string rest = end + 3;
            const std::size_t space = rest.find(' ');
            Diagnostic& fault = journal.failures_[number];
            fault.code = rest.substr(0, space);
            fault.message = space == std::string::npos ? "" : rest.substr(space + 1);
            continue;
        }
        std::vector<double> row;
        while (*end == ' ') {
            at = end;
            row.push_back(std::strtod(at, &end));
            if (end == at) {
                break;
            }
        }
        if (row.size() == width_ && *end == '\0') {
            journal.rows_[number] = std::move(row);
        }
    }
}

void SweepJournal::write(const std::string& line) {
    broken_ |= std::fputs(line.c_str(), file_) < 0;
}

void SweepJournal::settle() { broken_ |= std::fflush(file_) != 0; }

void PointJournal::settle() { owner_->settle(); }

sim::Journal::Known PointJournal::recall(std::uint64_t number, std::span<double> values,
                                         Diagnostic& fault) {
    if (const auto failed = failures_.find(number); failed != failures_.end()) {
        fault = failed->second;
        return Known::kFailed;
    }
    const auto row = rows_.find(number);
    if (row == rows_.end()) {
        return Known::kNo;
    }
    std::copy(row->second.begin(), row->second.end(), values.begin());
    return Known::kFinished;
}

void PointJournal::keep(std::uint64_t number, std::span<const double> values) {
    std::string line = std::to_string(point_) + " " + std::to_string(number);
    for (const double x : values) {
        char text[40];
        const auto end =
            std::to_chars(text, text + sizeof text, std::abs(x), std::chars_format::hex).ptr;
        line += std::signbit(x) ? " -" : " ";
        line += std::isfinite(x) ? "0x" : "";
        line.append(text, end);
    }
    owner_->write(line + "\n");
}

void PointJournal::keep_failure(std::uint64_t number, const Diagnostic& fault) {
    std::string message = fault.message;
    for (char& c : message) {
        c = c == '\n' || c == '\r' ? ' ' : c;
    }
    owner_->write(std::to_string(point_) + " " + std::to_string(number) + " ! " + fault.code + " " +
                  message + "\n");
}

bool PointJournal::wait() {
    if (interrupted()) {
        return false;
    }
    if (owner_->together_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return owner_->refresh() || owner_->together_;
}

}  // namespace puppetri::cli
