// SPDX-License-Identifier: MIT
// Evaluating formulas, and finding their poles: a divisor that changes its sign between two
// samples, or comes down to 0 in a dip, is followed to the instant where it is 0.
#include "puppetri/motion/formula_movement.h"

#include <algorithm>
#include <limits>

#include "puppetri/base/require.h"
#include "times.h"

namespace puppetri::motion {
namespace {

constexpr double kRate_hz = 480;

class Slots final : public Code::Reader {
 public:
    double t_s = 0;
    std::span<const double> inputs;
    std::span<double> locals;

    Value read(std::uint32_t kind, std::uint32_t index) const override {
        switch (static_cast<FormulaSlot>(kind)) {
            case FormulaSlot::kInput:
                return value_of_real(inputs[index]);
            case FormulaSlot::kLocal:
                return value_of_real(locals[index]);
            default:
                return value_of_real(t_s);
        }
    }
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class Evaluator {
 public:
    Evaluator(const FormulaMovement& formula, std::span<const double> inputs,
              std::span<double> locals)
        : f_(formula) {
        slots_.inputs = inputs;
        slots_.locals = locals;
    }
    // Moves to that time.
    void to(double t_s) {
        slots_.t_s = t_s;
        for (std::size_t i = 0; i < f_.locals.size(); ++i) {
            slots_.locals[i] = value(f_.locals[i]);
        }
    }
    // NaN where there is no value.
    double value(ProgramIndex program) const {
        const Evaluated e = f_.code.evaluate(program, slots_);
        return e.fault == EvalFault::kNone ? real_of_value(e.value) : kNone;
    }
    double value_at(ProgramIndex program, double t_s) {
        to(t_s);
        return value(program);
    }

 private:
    const FormulaMovement& f_;
    Slots slots_;
};

template <class Key>
Key key_of(const FormulaKey& from) {
    Key key;
    key.t_s = from.t_s;
    key.interpolation = from.interpolation;
    key.shape = from.shape;
    key.easing = from.easing;
    return key;
}

class FormulaSource final : public PoseSource {
 public:
    FormulaSource(std::shared_ptr<const FormulaMovement> formula, std::vector<double> inputs,
                  double duration_s)
        : formula_(std::move(formula)), inputs_(std::move(inputs)), duration_s_(duration_s) {
        std::vector<double> locals(formula_->locals.size());
        Evaluator evaluator(*formula_, inputs_, locals);
        evaluator.to(0);
        for (const std::vector<FormulaKey>& keys : formula_->dof_keys) {
            NumberTrack& track = numbers_.emplace_back();
            for (const FormulaKey& k : keys) {
                NumberKey& key = track.keys.emplace_back(key_of<NumberKey>(k));
                key.value = evaluator.value(k.value[0]);
                key.in = rate(evaluator, k.in[0]);
                key.out = rate(evaluator, k.out[0]);
            }
            close(track.keys);
        }
        for (const std::vector<FormulaKey>& keys : formula_->path_keys) {
            VectorTrack& track = places_.emplace_back();
            for (const FormulaKey& k : keys) {
                const auto three = [&](const std::array<ProgramIndex, 3>& p) {
                    return Vec3{rate(evaluator, p[0]), rate(evaluator, p[1]),
                                rate(evaluator, p[2])};
                };
                VectorKey& key = track.keys.emplace_back(key_of<VectorKey>(k));
                key.value = three(k.value);
                key.in = three(k.in);
                key.out = three(k.out);
            }
            close(track.keys);
        }
    }

    void sample(double t_s, PoseFrame& frame) const override {
        static thread_local std::vector<double> locals;
        locals.resize(formula_->locals.size());
        Evaluator evaluator(*formula_, inputs_, locals);
        evaluator.to(t_s);
        const bool loops = formula_->spec.loops;
        for (std::size_t i = 0; i < formula_->dofs.size(); ++i) {
            frame.dofs[i] = numbers_[i].keys.empty()
                                ? evaluator.value(formula_->dofs[i])
                                : motion::sample(numbers_[i], t_s, loops, duration_s_);
        }
        for (std::size_t i = 0; i < formula_->paths.size(); ++i) {
            if (!places_[i].keys.empty()) {
                frame.paths[i] = motion::sample(places_[i], t_s, loops, duration_s_);
                continue;
            }
            const auto& path = formula_->paths[i];
            frame.paths[i] = {evaluator.value(path[0]), evaluator.value(path[1]),
                              evaluator.value(path[2])};
        }
    }

 private:
    // Rates that are not said are 0.
    static double rate(const Evaluator& evaluator, ProgramIndex program) {
        return program.valid() ? evaluator.value(program) : 0;
    }
    // What loops ends where it began.
    template <class Key>
    void close(std::vector<Key>& keys) const {
        if (formula_->spec.loops && !keys.empty() && keys.back().t_s < duration_s_) {
            keys.push_back(keys.front());
            keys.back().t_s = duration_s_;
        }
    }

    std::shared_ptr<const FormulaMovement> formula_;
    std::vector<double> inputs_;
    double duration_s_ = 0;
    std::vector<NumberTrack> numbers_;  // by DOF; without keys: a formula
    std::vector<VectorTrack> places_;   // by path
};

// Where |x| is least in [a, b], by golden section.
template <class F>
double least_between(F f, double a, double b) {
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < 60; ++i) {
        const double u = b - (b - a) * kGolden, v = a + (b - a) * kGolden;
        if (std::fabs(f(u)) < std::fabs(f(v))) {
            b = v;
        } else {
            a = u;
        }
    }
    return (a + b) / 2;
}
template <class F>
double root_between(F f, double a, double b) {
    const bool rising = f(a) < 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (a + b) / 2;
        ((f(middle) < 0) == rising ? a : b) = middle;
    }
    return (a + b) / 2;
}

// The instant at which the danger strikes; negative: never.
double pole_of(const FormulaDanger& danger, Evaluator& evaluator, double duration_s) {
    const auto f = [&](double t) { return evaluator.value_at(danger.program, t); };
    const int count = static_cast<int>(std::ceil(duration_s * kRate_hz)) + 1;
    double before = 0, last = 0, largest = 0;
    std::vector<double> values;
    for (int i = 0; i <= count; ++i) {
        values.push_back(f(duration_s * i / count));
        largest = std::fmax(largest, std::fabs(values.back()));
    }
    const double nothing = 1e-12 * largest;
    for (int i = 0; i <= count; ++i) {
        const double x = values[static_cast<std::size_t>(i)], t = duration_s * i / count;
        const double earlier = duration_s * (i - 1) / count;
        if (!(x - x == 0)) {
            return -1;  // what it reads has no value: that is told there
        }
        if (danger.negative ? x < 0 : std::fabs(x) <= nothing) {
            return t;
        }
        if (!danger.negative && i > 0 && (x < 0) != (last < 0)) {
            return root_between(f, earlier, t);
        }
        // A dip that does not change sign.
        if (!danger.negative && i > 1 && std::fabs(last) < std::fabs(before) &&
            std::fabs(last) < std::fabs(x) && std::fabs(last) < 1e-3 * largest) {
            const double at = least_between(f, duration_s * (i - 2) / count, t);
            if (std::fabs(f(at)) <= 1e-9 * largest) {
                return at;
            }
        }
        before = last;
        last = x;
    }
    return -1;
}

}  // namespace

FormulaMaker::FormulaMaker(FormulaMovement formula)
    : formula_(std::make_shared<const FormulaMovement>(std::move(formula))) {}

std::vector<double> FormulaMaker::inputs_of(const Arguments& arguments, const Surroundings* around,
                                            Vec3 stand_in) const {
    std::vector<double> values;
    for (const FormulaInput& input : formula_->inputs) {
        if (input.coordinate < 0) {
            const auto* flag = arguments.get<bool>(input.parameter);
            const auto* side = arguments.get<Side>(input.parameter);
            values.push_back(flag != nullptr   ? (*flag ? 1 : 0)
                             : side != nullptr ? (*side == Side::kLeft ? 1 : -1)
                                               : arguments.number(input.parameter));
            continue;
        }
        Vec3 at = stand_in;
        if (const auto* point = arguments.get<Vec3>(input.parameter)) {
            at = *point;
        } else if (around != nullptr) {
            if (const auto* prop = arguments.get<PropIndex>(input.parameter)) {
                at = around->props[prop->value].position_world;
            } else if (const auto* actor = arguments.get<ActorIndex>(input.parameter)) {
                at = around->actors[actor->value].controls.pelvis.position_world;
                at.y = 0;
            }
        }
        values.push_back(input.coordinate == 0 ? at.x : input.coordinate == 1 ? at.y : at.z);
    }
    return values;
}

FormulaMaker::Takes FormulaMaker::takes(const Arguments& arguments) const {
    std::vector<double> locals(formula_->locals.size());
    const std::vector<double> inputs = inputs_of(arguments, nullptr, {1, 1, 1});
    Evaluator evaluator(*formula_, inputs, locals);
    evaluator.to(0);
    const double s = evaluator.value(formula_->takes);
    return s >= 0.001 && s <= 86'400 ? Takes{s, true} : Takes{1, false};
}

DurationRange FormulaMaker::declared(const Arguments& arguments) const {
    const SimTime duration = whole_milliseconds(takes(arguments).seconds);
    return {duration, duration};
}

MovementPtr FormulaMaker::make(const OwnCall& call) const {
    PosedSpec spec = formula_->spec;
    spec.duration_s = declared(call.arguments).shortest.seconds();
    auto source = std::make_shared<FormulaSource>(
        formula_, inputs_of(call.arguments, &call.around, {1, 1, 1}), spec.duration_s);
    return make_posed(call.context, spec, std::move(source));
}

Diagnostics FormulaMaker::check(const Arguments& arguments, const figure::DofSet& dofs) const {
    Diagnostics list;
    const bool things = std::any_of(formula_->inputs.begin(), formula_->inputs.end(),
                                    [](const FormulaInput& i) { return i.coordinate >= 0; });
    PosedSpec spec = formula_->spec;
    spec.duration_s = takes(arguments).seconds;
    for (const auto* tracks : {&formula_->dof_keys, &formula_->path_keys}) {
        for (const std::vector<FormulaKey>& keys : *tracks) {
            if (!keys.empty() && keys.back().t_s > spec.duration_s + 1e-9) {
                list.push_back({Severity::kError, "key-after-end", keys.back().where,
                                "movement " + spec.name + " at " + told_seconds(keys.back().t_s),
                                "this key comes after the end, at " + told_seconds(spec.duration_s),
                                "let it take longer, or move the key"});
                return list;
            }
        }
    }
    for (std::size_t i = 0; i < spec.contacts.size(); ++i) {
        if (spec.contacts[i].end_s > spec.duration_s + 1e-9) {
            list.push_back({Severity::kError, "key-after-end", formula_->contact_where[i],
                            "movement " + spec.name + ", contact until " +
                                told_seconds(spec.contacts[i].end_s),
                            "this contact ends after the end, at " + told_seconds(spec.duration_s),
                            "let it take longer, or end the contact before"});
            return list;
        }
    }
    std::vector<double> locals(formula_->locals.size());
    for (const Vec3 stand_in : {Vec3{1, 1, 1}, Vec3{0.3, 0.2, -1}}) {
        const std::vector<double> inputs = inputs_of(arguments, nullptr, stand_in);
        Evaluator evaluator(*formula_, inputs, locals);
        for (const FormulaDanger& danger : formula_->dangers) {
            const double at = pole_of(danger, evaluator, spec.duration_s);
            if (at >= 0) {
                list.push_back(
                    {Severity::kError, "formula-pole", danger.where,
                     "movement " + spec.name + ", " + danger.element + " at " + told_seconds(at),
                     "the formula has no value there: " + danger.what,
                     "change the formula so that this cannot happen between 0 s and "
                     "the end of the movement"});
                break;
            }
        }
        if (list.empty()) {
            list = check_posed(dofs, spec, FormulaSource(formula_, inputs, spec.duration_s));
            for (Diagnostic& d : list) {
                for (std::size_t i = 0; i < spec.dofs.size() && i < formula_->dof_where.size();
                     ++i) {
                    if (d.element.find(", " + spec.dofs[i] + " ") != std::string::npos) {
                        d.where = formula_->dof_where[i];
                    }
                }
            }
        }
        if (!things || !list.empty()) {
            break;
        }
    }
    return list;
}

}  // namespace puppetri::motion
