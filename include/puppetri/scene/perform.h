// SPDX-License-Identifier: MIT
// Performing a scene: the player runs its net, the stage prepares its movements, and out come a
// log, a score and a performance. What the commands run, export and render and the benchmarks
// share.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/net/chooser.h"
#include "puppetri/run/course_book.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/beside.h"
#include "puppetri/scene/scene.h"

namespace puppetri::scene {

struct PerformOptions {
    std::optional<std::uint64_t> seed;      // instead of the scene's
    Horizon horizon;                        // instead of the scene's, where given
    std::vector<run::OutsideEvent> events;  // beside those that the scene schedules
    run::LogSink* sink = nullptr;           // hears of every firing
    run::Observer* observer = nullptr;      // measures
    // The answers to all choices, as a witness or a recorded session has them; when they are used
    // up, the first option, or what the stream says. Left out: chance decides, from the seed.
    std::optional<std::vector<std::int64_t>> script;
    bool record = false;  // keep the outside events in Performed::recording
    // Where the courses of equations are written down that the scene would read from files, in one
    // slice: whoever plays the same later asks for no more.
    run::CourseBook* bake = nullptr;
    // Asked now and then with the share done: after a twentieth of a second of model time, then,
    // while that takes no time, at ever longer intervals; answering false ends the run cleanly.
    bool (*go_on)(void* context, double share_done) = nullptr;
    void* context = nullptr;
};

struct Performed {
    std::uint64_t seed = 0;
    run::Stop stop = run::Stop::kLimit;
    bool interrupted = false;  // go_on said no
    SimTime end;               // of the take
    std::uint64_t firings = 0;
    // Of the log; and of the courses of equations that another integrator than our own has made.
    std::uint64_t log_hash = 0;
    std::optional<Diagnostic> fault;  // with kFault: why; the performance reaches to there
    Diagnostics notes;                // of the player and of the stage
    std::vector<run::OutsideEvent> recording;
    std::unique_ptr<const stage::Performance> performance;
};

// A run under way, for those who feed it while it goes on. The scene and what the options point to
// must outlive it.
class Session {
 public:
    Session(const Scene& scene, const PerformOptions& options);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // An event at a time (now, if that has passed), or in the next tick.
    void schedule(const run::OutsideEvent& event);
    void push(net::EventIndex event);

    // Plays up to this instant, never beyond the horizon. Gives whether the run can go on.
    bool advance_to(SimTime at);
    // Plays to the horizon, or until nothing can happen any more.
    void run();
    void interrupt() { interrupted_ = true; }
    SimTime now() const;

    // Ends the run and hands over everything; the session is empty afterwards.
    // Fails   "no-horizon": see perform.
    Checked<Performed> finish();

 private:
    bool slice(SimTime until, std::uint64_t firings);
    double share_done() const;

    const Scene& scene_;
    PerformOptions options_;
    Horizon horizon_;
    run::Limits limits_;
    Beside beside_;
    stage::Stage stage_;
    std::optional<net::ScriptedChooser> script_;
    run::Player player_;
    run::Stop stop_ = run::Stop::kLimit;
    bool interrupted_ = false;
};

// Plays from time 0 to the horizon, or until nothing can happen any more. A time that was given as
// horizon is the end of the take even when the net rests earlier; otherwise the take ends with its
// last movement. Fails   "no-horizon" when neither the options nor the scene give one and the net
// has not come to rest after an hour of
//         model time.
Checked<Performed> perform(const Scene& scene, const PerformOptions& options = {});

}  // namespace puppetri::scene
