// SPDX-License-Identifier: MIT
// What goes on beside the net of a scene while it runs: its equations, which props and joints
// follow, and its sensors. One for each run; whoever plays a scene's net gives its parts to the
// stage and to the player.
//   scene::Beside beside(scene);
//   stage::Stage stage(scene.play, beside.quantities());
//   run::Player player(scene.net, {.host = &stage, .coupled = beside.coupled(stage)});
#pragma once
#include <memory>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/time.h"
#include "puppetri/run/coupled.h"
#include "puppetri/scene/scene.h"

namespace puppetri::scene {

class Beside {
 public:
    // `bake`: where courses are written down that the scene would play off files; outlives it.
    explicit Beside(const Scene& scene, run::CourseBook* bake = nullptr);
    ~Beside();

    // Null where nothing is driven. Lives as long as anybody holds it.
    std::shared_ptr<const stage::Quantities> quantities() const;
    // They live as long as this, and as the stage.
    std::vector<run::Coupled*> coupled(stage::Stage& stage);
    // Null without equations.
    const run::Equations* equations() const { return equations_.get(); }
    // The run is over, and nothing changes any more: goes on up to `at`.
    // Gives   false where the equations do not reach so far; `fault` says why.
    bool carry_to(SimTime at, Diagnostic& fault);

 private:
    const Scene& scene_;
    std::shared_ptr<run::Equations> equations_;
    std::unique_ptr<stage::Sensors> sensors_;
    std::shared_ptr<const stage::Quantities> quantities_;
};

}  // namespace puppetri::scene
