// SPDX-License-Identifier: MIT
// One system of equations on its way: pieces of solution one after another, each an interpolant,
// made ahead of the net as far as the next crossing and cut where a firing changes something.
// Nothing depends on how far ahead was asked: pieces end at steps of the solver, at updates of
// difference equations, at kinks that come back through delays, and at changes.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/run/equations.h"
#include "puppetri/run/step_source.h"

namespace puppetri::run {

class Equations::Course final : public OdeSystem {
 public:
    // `source` is null but for OdeMethod::kGiven.
    Course(const EquationSystem& system, const EquationsOptions& options,
           std::unique_ptr<StepSource> source);

    void fired(net::TransitionIndex transition);
    bool next(const net::State& state, SimTime until, Diagnostic& fault);
    // Of what next() found.
    SimTime crossing_at() const { return found_.empty() ? SimTime::never() : at_; }
    double root_s() const { return root_s_; }
    void crossings(std::vector<net::EventIndex>& out) const;
    void deliver();
    bool may_cross() const { return !system_.events.empty() && (enabled_ || !begun_); }

    bool carry_to(double t_s, Diagnostic& fault);
    double value(std::uint32_t variable, double t_s) const;
    double output(ProgramIndex program, double t_s) const;
    bool measure(const net::CourseQuantity& quantity, double from_s, double to_s, CourseSum& out,
                 Diagnostic& fault) const;

    void save(std::vector<std::uint8_t>& out) const;
    bool restore(std::span<const std::uint8_t> bytes);
    // Adds all steps of the source up to t_s; false if there are none.
    bool add_given(double t_s, Hash64& hash) const;

    // The right sides.
    std::uint32_t size() const override { return static_cast<std::uint32_t>(n_); }
    bool rates(double t_s, std::span<const double> x, std::span<double> out) override;

 private:
    struct Piece {
        double end_s = 0;  // where it was cut, at most the end of its step
        OdeStep step;
        std::uint32_t data = 0;  // row of data_rows_
        bool jump = false;       // an update of difference equations begins it
    };
    class Measuring;  // equation_measure.cpp
    struct Kink {     // comes back after a delay, one degree smoother each time
        double at_s = 0;
        std::uint32_t degree = 0;
    };
    // What a program reads at one time.
    struct Reader final : Code::Reader {
        const Course* course = nullptr;
        double t_s = 0;
        const double* x = nullptr;
        const double* data = nullptr;
        double* locals = nullptr;
        Value read(std::uint32_t kind, std::uint32_t index) const override;
    };

    bool fill_locals(Reader& reader) const;
    static bool evaluate(const Code& code, ProgramIndex program, const Reader& reader, double& out);
    const Piece& piece_at(double t_s) const;
    static double at(const Piece& piece, double t_s, std::uint32_t variable);
    double past(std::uint32_t variable, double t_s) const;
    bool gap(std::uint32_t event, const Piece& piece, double t_s, double& out) const;

    bool restart(double t_s, bool enabled, bool new_data, Diagnostic& fault);
    bool apply_resets(double t_s, std::vector<double>& x, Diagnostic& fault);
    bool start_solver(double t_s, std::span<const double> x, Diagnostic& fault);
    bool extend(Diagnostic& fault);
    bool update(double t_s, std::vector<double>& x, Diagnostic& fault);
    void push_kinks(double t_s, std::uint32_t degree);
    double next_stop(double t_s) const;
    bool update_due(double t_s) const;
    void forget_before(double t_s);
    bool read_data(const net::State& state);

    bool search(double until_s, Diagnostic& fault);
    bool look_at_jump(const Piece& piece, Diagnostic& fault);
    bool look_after_restart(double t_s, bool first, Diagnostic& fault);
    bool look_between(const Piece& piece, double from, double to, std::uint32_t event, double& root,
                      bool& found);
    double bisect(const Piece& piece, std::uint32_t event, double old_side, double new_side,
                  int side) const;
    double extremum(const Piece& piece, std::uint32_t event, double from, double to,
                    int side) const;
    int side_of(std::uint32_t event, const Piece& piece, double t_s) const;
    int side_after(std::uint32_t event, const Piece& piece) const;
    void pass_roots();
    void crosses(std::uint32_t event, int side, double root_s);
    bool wanted(const EquationSystem::Event& event, int side) const;
    bool step_solver(double begin_s, std::span<const double> x, OdeStep& out, double& end_s,
                     Diagnostic& fault);
    bool begin_segment(Diagnostic& fault);
    bool told(StepSource::Outcome outcome, double t_s, bool begins, std::span<const double> x,
              Diagnostic& fault) const;
    std::string state_text(std::span<const double> x) const;
    Diagnostic problem(const char* code, double t_s, std::string message, std::string remedy) const;

    const EquationSystem& system_;
    EquationsOptions options_;
    // Variables, and then for each event that is more than a variable's passing a number the
    // quantity that it watches: so that no step is so long that it hides a crossing.
    std::size_t n_ = 0;
    std::vector<std::uint32_t> watched_;  // events
    bool has_rates_ = false;
    double longest_delay_s_ = 0;

    bool begun_ = false, enabled_ = false;
    std::vector<Piece> pieces_;
    std::vector<std::vector<double>> data_rows_;
    std::vector<double> data_;  // as they were read last
    OdeSolver solver_;
    // Instead of solver_, and what it began with last: enough to come to the same step again.
    std::unique_ptr<StepSource> source_;
    struct Segment {
        double begin_s = 0, until_s = 0;
        std::uint64_t steps = 0;
        std::vector<double> x, data;
        bool live = false;  // the source stands where this says; else it must come there first
    } segment_;
    std::vector<Kink> kinks_;  // to come, in order of time
    std::vector<int> sides_;   // per event: below -1, above 1, not known yet 0
    double searched_s_ = 0;    // up to here, in piece cursor_, all crossings have been found
    std::size_t cursor_ = 0;

    // What the search found, to be delivered: events, in order of their roots, and their new sides.
    struct Found {
        std::uint32_t event = 0;
        int side = 0;
        double root_s = 0;
    };
    std::vector<Found> found_;
    double root_s_ = 0;  // of the first
    SimTime at_ = SimTime::never();

    // Of the round of the instant that is being played: what the net does in the instant of a
    // crossing acts at the crossing itself.
    bool delivered_ = false;
    double delivered_s_ = 0;
    std::vector<std::uint8_t> just_crossed_;  // per event
    double last_now_s_ = 0;                   // when next() was asked last
    std::vector<net::TransitionIndex> fired_;
    std::int64_t crowded_ms_ = -1;  // the last millisecond with a crossing, and how many
    std::uint32_t crowd_ = 0;
    // The event that was delivered last, and how often in a row within next to no time.
    std::uint32_t last_event_ = ~std::uint32_t{0}, near_ = 0;

    Reader rates_reader_;
    std::vector<double> rates_locals_, ahead_;
};

}  // namespace puppetri::run
