// SPDX-License-Identifier: MIT
#include "puppetri/scene/perform.h"

#include <algorithm>
#include <chrono>  // allowed: how often the asker is heard

#include "puppetri/base/hash.h"

namespace puppetri::scene {
namespace {

// Between two questions whether to go on: the first slice, and how many firings one may have. A
// slice that took no time is followed by one twice as long.
constexpr SimTime kSlice{kTicksPerSecond / 20};
constexpr std::uint64_t kSliceFirings = 10'000;
constexpr auto kShort = std::chrono::milliseconds(10);  // allowed: how often the asker is heard
constexpr SimTime kLongest{3600 * kTicksPerSecond};

run::Limits limits_of(const Horizon& horizon) {
    run::Limits limits;
    limits.until = horizon.time ? *horizon.time : horizon.firings ? SimTime::never() : kLongest;
    if (horizon.firings) {
        limits.firings = *horizon.firings;
    }
    return limits;
}

// The end of the last movement that has an end.
SimTime last_end(const stage::Stage& stage) {
    SimTime end{0};
    for (const stage::ScoreEntry& entry : stage.score()) {
        const SimTime last = std::min(entry.end, entry.left);
        if (last != SimTime::never()) {
            end = std::max(end, last);
        }
    }
    return end;
}

}  // namespace

Session::Session(const Scene& scene, const PerformOptions& options)
    : scene_(scene),
      options_(options),
      horizon_(options.horizon.given() ? options.horizon : scene.horizon),
      limits_(limits_of(horizon_)),
      beside_(scene, options.bake),
      stage_(scene.play, beside_.quantities()),
      script_(options.script ? std::optional<net::ScriptedChooser>(*options.script) : std::nullopt),
      player_(scene.net, {.seed = options.seed.value_or(scene.seed),
                          .host = &stage_,
                          .chooser = script_ ? &*script_ : nullptr,
                          .sink = options.sink,
                          .observer = options.observer,
                          .beat = scene.beat,
                          .coupled = beside_.coupled(stage_),
                          .record = options.record}) {
    player_.schedule(options.events);
}

Session::~Session() = default;

void Session::schedule(const run::OutsideEvent& event) {
    player_.schedule(std::span<const run::OutsideEvent>(&event, 1));
}

void Session::push(net::EventIndex event) { player_.push(event); }

SimTime Session::now() const { return player_.now(); }

double Session::share_done() const {
    if (horizon_.firings && *horizon_.firings > 0) {
        return static_cast<double>(player_.firings()) / static_cast<double>(*horizon_.firings);
    }
    if (horizon_.time && horizon_.time->ticks > 0) {
        return static_cast<double>(player_.now().ticks) / static_cast<double>(horizon_.time->ticks);
    }
    return 0;
}

bool Session::slice(SimTime until, std::uint64_t firings) {
    run::Limits limits = limits_;
    limits.until = std::min(limits_.until, until);
    limits.firings = std::min(limits_.firings, firings);
    stop_ = player_.run(limits);
    return stop_ == run::Stop::kLimit && player_.now() < limits_.until &&
           player_.firings() < limits_.firings;
}

bool Session::advance_to(SimTime at) {
    slice(at, limits_.firings);
    // At rest now; an event from outside may wake it.
    return stop_ != run::Stop::kFault && player_.now() < limits_.until &&
           player_.firings() < limits_.firings;
}

void Session::run() {
    if (options_.go_on == nullptr || options_.bake != nullptr) {
        slice(SimTime::never(), limits_.firings);
        return;
    }
    // In slices, so that the asker is heard; slices do not change what happens.
    using Clock = std::chrono::steady_clock;  // allowed: how often the asker is heard
    SimTime length = kSlice;
    Clock::time_point begun = Clock::now();
    for (;;) {
        const SimTime now = player_.now();
        const bool longer = now.ticks < SimTime::never().ticks - length.ticks;
        if (!slice(longer ? now + length : SimTime::never(), player_.firings() + kSliceFirings)) {
            return;
        }
        if (!options_.go_on(options_.context, share_done())) {
            interrupted_ = true;
            return;
        }
        const Clock::time_point ended = Clock::now();
        if (ended - begun < kShort && length.ticks < SimTime::never().ticks / 4) {
            length.ticks *= 2;
        } else if (length > kSlice) {
            length.ticks /= 2;
        }
        begun = ended;
    }
}

Checked<Performed> Session::finish() {
    if (!horizon_.given() && stop_ == run::Stop::kLimit && !interrupted_) {
        return Unexpected(Diagnostics{
            {.code = "no-horizon",
             .where = {.file = scene_.path},
             .element = "scene " + scene_.title,
             .message = "the net goes on for ever and the scene does not say when to stop",
             .remedy = "write `until 40 s` or `until frame 960` in the header, or give --for"}});
    }
    Performed out;
    out.seed = options_.seed.value_or(scene_.seed);
    out.stop = stop_;
    out.interrupted = interrupted_;
    out.end = player_.now();
    if (stop_ == run::Stop::kDead || stop_ == run::Stop::kFinal) {
        // At rest: the horizon, if it is a time, else the end of the last movement.
        out.end = horizon_.time && !interrupted_ ? *horizon_.time
                                                 : std::max(player_.now(), last_end(stage_));
    }
    if (stop_ == run::Stop::kFault) {
        out.fault = player_.fault();
    }
    out.firings = player_.firings();
    out.log_hash = player_.log_hash();
    out.notes = player_.notes();
    out.notes.insert(out.notes.end(), stage_.diagnostics().begin(), stage_.diagnostics().end());
    if (options_.record) {
        out.recording = player_.recording();
    }
    Diagnostic fault;
    if (!out.fault && !beside_.carry_to(out.end, fault)) {
        out.stop = run::Stop::kFault;
        out.fault = std::move(fault);
    }
    if (const std::uint64_t given =
            beside_.equations() == nullptr ? 0 : beside_.equations()->given_hash(out.end)) {
        out.log_hash = Hash64().add_u64(out.log_hash).add_u64(given).value();
    }
    out.performance = stage_.finish(out.end);
    return out;
}

Checked<Performed> perform(const Scene& scene, const PerformOptions& options) {
    Session session(scene, options);
    session.run();
    return session.finish();
}

}  // namespace puppetri::scene
