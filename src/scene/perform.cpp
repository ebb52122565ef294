// SPDX-License-Identifier: MIT
#include "puppetri/scene/perform.h"

#include <algorithm>

namespace puppetri::scene {
namespace {

constexpr SimTime kSlice{kTicksPerSecond / 20};  // between two questions whether to go on
constexpr SimTime kLongest{3600 * kTicksPerSecond};

double share_done(const Horizon& horizon, const run::Player& player) {
    if (horizon.firings && *horizon.firings > 0) {
        return static_cast<double>(player.firings()) / static_cast<double>(*horizon.firings);
    }
    if (horizon.time && horizon.time->ticks > 0) {
        return static_cast<double>(player.now().ticks) / static_cast<double>(horizon.time->ticks);
    }
    return 0;
}

// The end of the last movement that has an end.
SimTime last_end(const stage::Stage& stage) {
    SimTime end{0};
    for (const stage::ScoreEntry& entry : stage.score()) {
        const SimTime left = std::min(entry.end, entry.left);
        if (left != SimTime::never()) {
            end = std::max(end, left);
        }
    }
    return end;
}

}  // namespace

Checked<Performed> perform(const Scene& scene, const PerformOptions& options) {
    const Horizon horizon = options.horizon.given() ? options.horizon : scene.horizon;
    Performed out;
    out.seed = options.seed.value_or(scene.seed);
    stage::Stage stage(scene.play);
    run::Player player(scene.net, {.seed = out.seed,
                                   .host = &stage,
                                   .sink = options.sink,
                                   .beat = scene.beat,
                                   .record = options.record});
    player.schedule(options.events);

    run::Limits limits{.until = horizon.time.value_or(kLongest)};
    if (horizon.firings) {
        limits.firings = *horizon.firings;
    }
    // In slices, so that the asker is heard; slices do not change what happens.
    while (true) {
        run::Limits slice = limits;
        slice.until = std::min(limits.until, player.now() + kSlice);
        out.stop = player.run(slice);
        const bool all = out.stop != run::Stop::kLimit || player.now() >= limits.until ||
                         player.firings() >= limits.firings;
        if (all) {
            break;
        }
        if (options.go_on != nullptr && !options.go_on(options.context, share_done(horizon, player))) {
            out.interrupted = true;
            break;
        }
    }
    if (!horizon.given() && out.stop == run::Stop::kLimit && !out.interrupted) {
        return Unexpected(Diagnostics{{.code = "no-horizon",
                                       .where = {.file = scene.path},
                                       .element = "scene " + scene.title,
                                       .message = "the net goes on for ever and the scene does not say when to stop",
                                       .remedy = "write `until 40 s` or `until frame 960` in the header, or give --for"}});
    }
    out.end = player.now();
    if (out.stop == run::Stop::kDead || out.stop == run::Stop::kFinal) {
        // At rest: the horizon, if it is a time, else the end of the last movement.
        out.end = horizon.time ? *horizon.time : std::max(player.now(), last_end(stage));
    }
    if (out.stop == run::Stop::kFault) {
        out.fault = player.fault();
    }
    out.firings = player.firings();
    out.log_hash = player.log_hash();
    out.notes = player.notes();
    out.notes.insert(out.notes.end(), stage.diagnostics().begin(), stage.diagnostics().end());
    if (options.record) {
        out.recording = player.recording();
    }
    out.performance = stage.finish(out.end);
    return out;
}

}  // namespace puppetri::scene
