// SPDX-License-Identifier: MIT
// Two threads of one sweep against two processes of one thread, each with as many replications:
// days of the stochastic barber shop, with every measure of every place and transition, from the
// compiled net to the means. The forms take turns and medians count; every form must give the same
// numbers, bit for bit.
//   bench_sweep [replications] [rounds]
//
// Prints CSV: form, replications, seconds, hash of the values and means; then the share of the
// speed of two processes that two threads have (0.85 is the aim). Exits 1 when hashes differ.
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "models.h"
#include "puppetri/base/hash.h"
#include "puppetri/net/net.h"
#include "puppetri/sim/net_experiment.h"

namespace {

using namespace puppetri;

double now_s() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::uint64_t hash_of(const sim::Outcome& outcome) {
    Hash64 h;
    for (const double x : outcome.values) {
        h.add_f64(x);
    }
    for (const sim::Confidence& c : outcome.means) {
        h.add_f64(c.mean).add_f64(c.half_width);
    }
    return h.value();
}

struct Form {
    const char* name;
    unsigned threads, processes;
    std::vector<double> seconds;
    std::uint64_t hash = 0;
};

// Gives   false where a process went wrong.
bool play(const sim::Experiment& experiment, std::uint64_t replications, Form& form) {
    const auto work = [&] {
        return hash_of(sim::replicate(
            experiment, {.seed = 7, .replications = replications, .threads = form.threads}));
    };
    // Also the single process is a child: all forms begin with the same memory
    const double start = now_s();
    std::vector<int> pipes;
    for (unsigned i = 0; i < form.processes; ++i) {
        int ends[2];
        if (pipe(ends) != 0) {
            return false;
        }
        const pid_t child = fork();
        if (child == 0) {
            const std::uint64_t hash = work();
            _exit(write(ends[1], &hash, sizeof hash) == sizeof hash ? 0 : 1);
        }
        close(ends[1]);
        pipes.push_back(ends[0]);
        if (child < 0) {
            return false;
        }
    }
    bool good = true;
    for (const int end : pipes) {
        std::uint64_t hash = 0;
        good = read(end, &hash, sizeof hash) == sizeof hash && good;
        good = (form.hash == 0 || form.hash == hash) && good;
        form.hash = hash;
        close(end);
        int status = 0;
        wait(&status);
    }
    form.seconds.push_back(now_s() - start);
    return good;
}

double median(std::vector<double> x) {
    std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
    return x[x.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint64_t replications = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000;
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 7;
    const auto net = net::compile(bench::barber_day());
    if (!net || replications < 2 || rounds < 1) {
        return 2;
    }
    const sim::NetExperiment experiment(*net, sim::all_metrics(*net),
                                        {.limits = {.until = {8 * 3600 * kTicksPerSecond}}});
    Form forms[] = {
        {"one thread", 1, 1, {}}, {"two threads", 2, 1, {}}, {"two processes", 1, 2, {}}};
    bool good = true;
    for (int i = 0; i < rounds; ++i) {
        for (Form& form : forms) {
            good = play(experiment, replications, form) && good;
        }
    }
    std::puts("form,replications,seconds,hash");
    for (const Form& form : forms) {
        std::printf("%s,%llu,%.4f,%016llx\n", form.name,
                    static_cast<unsigned long long>(replications * form.processes),
                    median(form.seconds), static_cast<unsigned long long>(form.hash));
        good = good && form.hash == forms[0].hash;
    }
    std::printf("share of two processes,,%.3f,\n",
                median(forms[2].seconds) / 2 / median(forms[1].seconds));
    return good ? 0 : 1;
}
