// SPDX-License-Identifier: MIT
// Differential, difference and delay-differential equations beside a net. A system is data: what
// its variables start at, programs for their rates, what enables it, what firings reset, which
// crossings are events. One Equations runs several systems, each on its own; it is the Coupled part
// of a player and afterwards the record of how every variable went.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/math/ode.h"
#include "puppetri/run/coupled.h"

namespace puppetri::run {

class StepSource;
class StepSources;
struct CourseBook;

// What slots of the programs stand for; every value is a real number in SI units. The first three
// are those of formulas of movements (motion/formula_movement.h), which the same compiler makes.
enum class EquationSlot : std::uint32_t {
    kTime,      // since the run began
    kInput,     // not used
    kLocal,     // number in `locals`
    kVariable,  // number in `variables`
    kPast,      // number in `pasts`
    kDatum,     // number in `data`
};

enum class CrossingDirection : std::uint8_t { kFalls, kRises, kPasses };

struct EquationSystem {
    struct Variable {
        std::string name;
        double initial = 0;
        ProgramIndex rate;             // none: it changes only by resets and by `next`
        ProgramIndex next;             // what it becomes, every so often
        std::int64_t every_ticks = 0;  // of `next`
        ProgramIndex before;           // before the start; none: as it starts. Reads the time only
        std::string unit;              // for messages
        SourceSpan where;
    };
    // `past(x, 2 s)`: a variable as it was so long ago.
    struct Past {
        std::uint32_t variable = 0;
        double ago_s = 0;  // above 0
    };
    struct Datum {
        net::DatumIndex datum;
        ValueKind kind = ValueKind::kReal;
    };
    struct Event {
        net::EventIndex event;
        ProgramIndex value;  // crosses 0
        CrossingDirection direction = CrossingDirection::kFalls;
        // Of a sensor: where a reset jumps over 0 is a crossing, too, and the start, if it is
        // beyond already.
        bool jumps = false;
        bool plain = false;  // the value is one variable less a number
        std::string name;
        SourceSpan where;
    };
    struct Reset {
        net::TransitionIndex transition;
        std::uint32_t variable = 0;
        ProgramIndex value;
    };

    std::string path;  // of the instance
    SourceSpan where;
    std::vector<Variable> variables;
    std::vector<ProgramIndex> locals;  // each may read those before it
    std::vector<Past> pasts;
    std::vector<Datum> data;
    std::vector<Event> events;
    std::vector<Reset> resets;
    // It goes on while one of these has a token, ready or not, and stands still otherwise. Empty:
    // always.
    std::vector<net::PlaceIndex> enabled_by;
    std::vector<ProgramIndex> outputs;  // what figures and props follow
    Code code;
    OdeOptions options;
    // With OdeMethod::kGiven: the file of baked courses, as the scene names it, and what it holds;
    // null if there is no such file. Without a name the steps come from EquationsOptions::sources.
    std::string baked_in;
    std::shared_ptr<const CourseBook> baked;
};

struct EquationsOptions {
    bool record = true;  // keep everything for value() and output(); else as far as delays look
    std::uint32_t crossings_per_ms = 1000;  // of one system; more is an accumulation
    StepSources* sources = nullptr;         // of systems with OdeMethod::kGiven; while it is made
    // Where courses of systems that name a file are written down instead of read; outlives it.
    CourseBook* bake = nullptr;
};

class Equations final : public Coupled {
 public:
    explicit Equations(std::vector<EquationSystem> systems, const EquationsOptions& options = {});
    ~Equations() override;

    void fired(SimTime at, net::TransitionIndex transition) override;
    // Faults  "equations-blow-up": the solution ends, or has no value; "crossings-accumulate": more
    //         than EquationsOptions::crossings_per_ms within a millisecond.
    bool next(const net::State& state, SimTime until, Crossings& out, Diagnostic& fault) override;
    void deliver() override;
    bool may_cross() const override;
    void save(std::vector<std::uint8_t>& out) const override;
    bool restore(std::span<const std::uint8_t> bytes) override;
    // Integrals are those of the interpolants: of variables exact but for rounding, of parts to
    // 1e-10 of their size. Extremes are found to rounding where a step, which follows the variables
    // closely, has no more than a few of them. Needs `record`. Fails   "evaluation-fault": a part
    // has no value somewhere. Cost: about 20 evaluations per step.
    // Source  nodes and weights: Kronrod's 15-point rule, as in Piessens et al., QUADPACK (1983).
    bool measure(const net::CourseQuantity& quantity, SimTime from, SimTime to, CourseSum& out,
                 Diagnostic& fault) override;

    // The run is over, and nothing changes any more: goes on up to `at`, whatever it crosses.
    bool carry_to(SimTime at, Diagnostic& fault);

    // Of all steps up to `end` that came from elsewhere (OdeMethod::kGiven); 0 if there are none.
    std::uint64_t given_hash(SimTime end) const;

    const std::vector<EquationSystem>& systems() const;
    // A variable, or an output, at any time that next() has gone through; before it as the history
    // says, after it as it was last known. Safe from several threads once the run is over.
    double value(std::uint32_t system, std::uint32_t variable, SimTime at) const;
    double output(std::uint32_t system, std::uint32_t output, SimTime at) const;

 private:
    class Course;
    std::vector<EquationSystem> systems_;
    EquationsOptions options_;
    std::vector<std::unique_ptr<Course>> courses_;
    std::uint32_t found_ = ~std::uint32_t{0};  // whose crossings next() gave
};

}  // namespace puppetri::run
