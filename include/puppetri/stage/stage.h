// SPDX-License-Identifier: MIT
// The stage: where the net's actions become movements. While a run goes on it prepares each
// movement at the instant its token arrives, knows who is in charge of every limb and who holds
// every prop, and answers how long things take. Afterwards it gives the score and the performance.
// It never sees a marking.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/declared_duration.h"
#include "puppetri/net/host.h"
#include "puppetri/stage/cast.h"
#include "puppetri/stage/performance.h"

namespace puppetri::stage {

// An event of the place that the movement may raise: name as in Movement::events ("foot_strike",
// "release").
struct RaisedName {
    std::string name = {};
    net::EventIndex event = {};
};

// What a place does. Its number in Play::actions is its net::ActionIndex.
struct Action {
    motion::BoundCall call = {};
    std::string place = {};     // full path, "a.with_ball.P4"
    std::string instance = {};  // path of the net instance, "a.with_ball"; empty at the top
    std::vector<RaisedName> raises = {};  // the events that the net listens to
    SourceSpan where = {};                // of the call, for diagnostics
};

// Quantities that change by themselves, by number: what equations say. Times may be asked in any
// order, up to the one to which the run has come.
class Quantities {
 public:
    virtual ~Quantities() = default;
    virtual double at(std::uint32_t quantity, SimTime at) const = 0;
};

// A prop whose centre is where three quantities say, in metres of the world, for as long as nobody
// holds or throws it.
struct DrivenProp {
    motion::PropIndex prop = {};
    std::array<std::uint32_t, 3> position = {};
    SourceSpan where = {};
};

// A degree of freedom that a quantity moves, in radians or metres, whatever else the figure does:
// laid over every pose; values beyond its range are taken into it.
struct DrivenDof {
    motion::ActorIndex actor = {};
    std::string dof = {};  // "right_shoulder.flex"; one of the figure's
    std::uint32_t quantity = 0;
    SourceSpan where = {};
};

// Everything the stage needs before the run.
struct Play {
    Cast cast = {};
    std::vector<Action> actions = {};
    std::vector<DrivenProp> driven_props = {};
    std::vector<DrivenDof> driven_dofs = {};
};

// What every action declares for `takes auto`, by net::ActionIndex: for proofs, which cannot
// prepare a movement. Every answer of Stage::begin to a negative duration lies inside.
std::vector<motion::DurationRange> declared_durations(const Play& play);

class Stage final : public net::MovementHost {
 public:
    // Needs check(play.cast) without errors, and calls that fit their signatures.
    // `quantities` where the play has something driven; without it that stays as it is.
    explicit Stage(Play play, std::shared_ptr<const Quantities> quantities = nullptr);
    ~Stage() override;
    Stage(Stage&&) noexcept;
    Stage& operator=(Stage&&) noexcept;

    SimTime begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                  SimTime duration, std::span<const std::int64_t> attributes) override;
    std::span<const net::RaisedEvent> raised(net::ActivityIndex activity) override;
    void cut(net::ActivityIndex activity, SimTime at) override;
    void left(net::ActivityIndex activity, SimTime at) override;

    // Rows in order of start, then of arrival. May be asked while the run goes on.
    std::span<const ScoreEntry> score() const;

    // Time goes on to `at` and nothing is called before: what an instant leaves to be settled
    // (limbs that were cut and that nobody took, ...) is settled for all earlier ones. Needs  `at`
    // not before the last call's time.
    void pass_to(SimTime at);
    // The pose of an actor at any instant, as its movements have it so far; of instants that have
    // passed it stays so. Without the turn of the head after what it looks at, which is laid over
    // when the take ends.
    void pose(ActorIndex actor, SimTime at, figure::Pose& out) const;
    const figure::Figure& figure(ActorIndex actor) const;
    Transform world_from_prop(PropIndex prop, SimTime at) const;

    // What went wrong or deserves a word so far: why begin answered negative, flights above 9 m/s
    // or 6 m, limbs driven by two movements at once.
    const Diagnostics& diagnostics() const;

    // Ends the take at `end` (at least the last call's time) and hands over everything; the stage
    // is empty afterwards.
    std::unique_ptr<const Performance> finish(SimTime end);

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace puppetri::stage
