// SPDX-License-Identifier: MIT
// --time, --memory, --threads of commands that explore, a line of progress while they do, and
// Ctrl-C, which ends them with what is known.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "puppetri/proof/budget.h"

namespace puppetri::cli {

// The three options, to be added to a command's own.
std::vector<Option> budget_options();

// A budget that tells its progress on a terminal and ends when the user asks to stop. It has to
// outlive the work, and its budget is not to be copied beyond it.
class WatchedBudget {
 public:
    // Fails  with nothing, after saying which option is wrong.
    static std::unique_ptr<WatchedBudget> from(const Arguments& arguments);
    ~WatchedBudget();  // wipes the line

    const proof::Budget& budget() const { return budget_; }
    void wipe();

 private:
    WatchedBudget() = default;
    static void show(void* context, const proof::Progress& progress);

    proof::Budget budget_;
    std::atomic<bool> cancelled_{false};
    bool drawn_ = false;
};

// "12.3 M", "4.5 k", "17".
std::string short_number(double x);
// "1.2 GiB", "35 MiB".
std::string short_bytes(double bytes);

}  // namespace puppetri::cli
