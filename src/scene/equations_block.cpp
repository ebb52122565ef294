// SPDX-License-Identifier: MIT
// Blocks `equations`, one for each instance: lines become programs, units are checked, names are
// those of the instance's parameters. What comes out runs beside the net (run/equations.h).
#include <algorithm>
#include <set>

#include "elaboration.h"
#include "formula_compiler.h"
#include "puppetri/base/text.h"
#include "puppetri/notation/equations.h"
#include "puppetri/run/course_book.h"
#include "puppetri/scene/sundials.h"

namespace puppetri::scene {

using lang::ExprKind;
using notation::EquationLines;
using run::EquationSlot;
using run::EquationSystem;

namespace {

Expr slot(EquationSlot kind, std::uint32_t index) {
    return Expr::slot({static_cast<std::uint32_t>(kind), index}, {ValueKind::kReal});
}

lang::Dimension per_time(lang::Dimension d) {
    d.time = static_cast<std::int8_t>(d.time - 1);
    return d;
}

std::string one_name(const lang::Path& path) {
    return path.steps.size() == 1 && path.steps[0].index.empty() ? path.steps[0].text : "";
}

}  // namespace

class EquationsBlock final : public FormulaNames {
 public:
    EquationsBlock(Elaboration& e, std::uint32_t instance)
        : e_(e), scope_{.instance = instance}, compiler_(e, formula_) {
        compiler_.also_knows(this);
    }

    void compile() {
        const Instance& instance = e_.instances_[scope_.instance];
        system_.path = instance.path.empty() ? instance.net->name.text : instance.path;
        system_.where = e_.at(instance.equations->name.span);
        notation::Lowered ignored;  // what is wrong with the lines has been told
        const EquationLines lines = notation::read_equations(
            *instance.equations, e_.library_.files[instance.file], ignored);
        variables(lines);
        for (const EquationLines::Formula& f : lines.locals) {
            About about(e_, "equations " + system_.path, f.span);
            if (named_before(f.name)) {
                continue;
            }
            compiler_.add_local(f.name, f.value);
            locals_.insert(f.name.text);
        }
        for (const EquationLines::Formula& f : lines.rates) {
            rate(f);
        }
        for (const EquationLines::Formula& f : lines.befores) {
            before(f);
        }
        for (const EquationLines::Next& n : lines.nexts) {
            next(n);
        }
        for (const EquationLines::Event& e : lines.events) {
            event(e);
        }
        for (const EquationLines::Sensor& s : lines.sensors) {
            sensor(s);
        }
        for (const EquationLines::Reset& r : lines.resets) {
            reset(r);
        }
        for (const lang::Path& p : lines.enabled_by) {
            About about(e_, "equations " + system_.path, p.span);
            const Term term = e_.resolve(p, scope_);
            if (const auto* place = std::get_if<PlaceTerm>(&term)) {
                system_.enabled_by.push_back(place->place);
            } else {
                e_.wrong(p.span, "a place", term);
            }
        }
        for (const EquationLines::Driven& d : lines.driven) {
            driven(d);
        }
        options(lines);
        for (const EquationSystem::Variable& v : system_.variables) {
            if (!v.rate.valid() && !v.next.valid() &&
                std::none_of(lines.resets.begin(), lines.resets.end(),
                             [&](const auto& r) { return r.name.text == v.name; })) {
                e_.diagnostics.push_back({Severity::kWarning, "never-changes", v.where,
                                          "equations " + system_.path,
                                          "nothing ever changes " + v.name,
                                          "write `" + v.name +
                                              ".rate = ...`, or make it a "
                                              "parameter"});
            }
        }
        const auto number = static_cast<std::uint32_t>(e_.scene.equations.size());
        for (std::uint32_t i = 0; i < system_.variables.size(); ++i) {
            e_.courses_[{scope_.instance, system_.variables[i].name}] = {{number, i, false},
                                                                         dimensions_[i]};
        }
        for (const std::string& name : locals_) {
            if (const auto local = compiler_.local(name)) {
                e_.courses_[{scope_.instance, name}] = {{number, local->first, true},
                                                        local->second};
            }
        }
        system_.code = std::move(formula_.code);
        system_.locals = std::move(formula_.locals);
        tell_stale();
        e_.scene.equations.push_back(std::move(system_));
    }

    // ---- names of formulas

    Found find(const lang::Expr& e, Formula& out) override {
        const std::string name = one_name(e.path);
        if (name == "t" || name == "pi" || locals_.count(name) != 0) {
            return Found::kNo;
        }
        if (const int v = variable_named(name); v >= 0) {
            if (only_time_) {
                e_.error("wrong-type", e.span,
                         "before the start only the time is known, not " + name,
                         "write a formula of t, which is negative there");
                return Found::kWrong;
            }
            const auto i = static_cast<std::uint32_t>(v);
            out = {slot(EquationSlot::kVariable, i), dimensions_[i]};
            return Found::kYes;
        }
        if (!e_.resolve_first(e.path.steps[0], scope_)) {
            return Found::kNo;
        }
        const Term term = e_.resolve(e.path, scope_);
        if (const Number* n = std::get_if<Number>(&term)) {
            out = {Expr::real(n->value), n->dimension, n->value == 0};
            return Found::kYes;
        }
        if (const bool* b = std::get_if<bool>(&term)) {
            out = {Expr::real(*b ? 1 : 0), {}};
            return Found::kYes;
        }
        if (const auto* value = std::get_if<EnumTerm>(&term)) {
            out = {Expr::real(static_cast<double>(value->ordinal)), {}};
            return Found::kYes;
        }
        if (const auto* datum = std::get_if<DatumTerm>(&term)) {
            return read_datum(datum->datum, e, out);
        }
        if (!is_nothing(term)) {
            e_.wrong(e.span, "a number, or data", term);
        }
        return Found::kWrong;
    }

    // past(x, 2 s)
    Found call(const lang::Expr& e, Formula& out) override {
        if (one_name(e.path) != "past") {
            return Found::kNo;
        }
        const int v = e.args.size() == 2 && e.args[0].value.kind == ExprKind::kPath
                          ? variable_named(one_name(e.args[0].value.path))
                          : -1;
        if (v < 0) {
            e_.error("wrong-type", e.span, "`past` wants a variable and how long ago",
                     "write one such as past(x, 2 s)");
            return Found::kWrong;
        }
        const auto ago =
            e_.constant_number(e.args[1].value, scope_, lang::dimension::kTime, "how long ago");
        if (!ago) {
            return Found::kWrong;
        }
        if (!(ago->value >= 1e-6) || ago->value > 1e9) {
            e_.error("out-of-range", e.args[1].value.span, "a delay is above 0",
                     ago->value == 0 ? "write the variable alone" : "write one such as 0.1 s");
            return Found::kWrong;
        }
        const auto i = static_cast<std::uint32_t>(v);
        out = {slot(EquationSlot::kPast, static_cast<std::uint32_t>(system_.pasts.size())),
               dimensions_[i]};
        for (std::uint32_t k = 0; k < system_.pasts.size(); ++k) {
            if (system_.pasts[k].variable == i && system_.pasts[k].ago_s == ago->value) {
                out.value = slot(EquationSlot::kPast, k);
                return Found::kYes;
            }
        }
        system_.pasts.push_back({i, ago->value});
        return Found::kYes;
    }

    std::vector<std::string> names() const override {
        std::vector<std::string> out;
        for (const EquationSystem::Variable& v : system_.variables) {
            out.push_back(v.name);
        }
        for (const lang::Parameter& p : e_.instances_[scope_.instance].net->parameters) {
            out.push_back(p.name.text);
        }
        return out;
    }

 private:
    int variable_named(const std::string& name) const {
        for (std::size_t i = 0; i < system_.variables.size(); ++i) {
            if (!name.empty() && system_.variables[i].name == name) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }

    // A variable by its name, which other lines speak of; -1 has been told.
    int known_variable(const lang::Name& name) {
        const int v = variable_named(name.text);
        if (v < 0 && broken_.count(name.text) == 0) {
            std::vector<std::string> known;
            for (const EquationSystem::Variable& variable : system_.variables) {
                known.push_back(variable.name);
            }
            const std::string_view meant = nearest_name(name.text, known);
            e_.error("no-start", name.span,
                     "nothing says where the variable " + name.text + " starts",
                     meant.empty() ? "write `" + name.text + " starts at 0 m`, with its unit"
                                   : "did you mean " + std::string(meant) + "? Otherwise write `" +
                                         name.text + " starts at 0 m`, with its unit");
            broken_.insert(name.text);
        }
        return v;
    }

    bool named_before(const lang::Name& name) {
        if (variable_named(name.text) < 0 && locals_.count(name.text) == 0) {
            return false;
        }
        e_.error("name-twice", name.span, name.text + " has a meaning already",
                 "choose another name");
        return true;
    }

    void variables(const EquationLines& lines) {
        for (const EquationLines::Variable& line : lines.variables) {
            About about(e_, "equations " + system_.path, line.span);
            if (line.name.text == "t" || line.name.text == "pi") {
                e_.error("name-twice", line.name.span, line.name.text + " has a meaning already",
                         "choose another name");
                continue;
            }
            if (named_before(line.name)) {
                continue;
            }
            const Term term = e_.evaluate(line.starts, scope_);
            const Number* n = std::get_if<Number>(&term);
            if (n == nullptr) {
                if (!is_nothing(term)) {
                    e_.wrong(line.starts.span, "a number, with its unit", term,
                             "an initial value is made of numbers and parameters");
                }
                broken_.insert(line.name.text);
                continue;
            }
            system_.variables.push_back({.name = line.name.text,
                                         .initial = n->value,
                                         .unit = std::string(lang::example_unit(n->dimension)),
                                         .where = e_.at(line.name.span)});
            dimensions_.push_back(compiler_.counted(n->dimension));
        }
    }

    void rate(const EquationLines::Formula& line) {
        About about(e_, "equations " + system_.path, line.span);
        const int v = known_variable(line.name);
        compiler_.about("the rate of " + line.name.text);
        if (v < 0) {
            compiler_.number(line.value);
            return;
        }
        const auto i = static_cast<std::size_t>(v);
        if (system_.variables[i].rate.valid() || system_.variables[i].next.valid()) {
            e_.error("name-twice", line.name.span, line.name.text + " has a rate already",
                     "add the two in one formula");
            return;
        }
        if (const auto p = compiler_.program(line.value, per_time(dimensions_[i]))) {
            system_.variables[i].rate = *p;
        }
    }

    void before(const EquationLines::Formula& line) {
        About about(e_, "equations " + system_.path, line.span);
        const int v = known_variable(line.name);
        compiler_.about(line.name.text + " before the start");
        if (v < 0) {
            return;
        }
        only_time_ = true;
        if (const auto p =
                compiler_.program(line.value, dimensions_[static_cast<std::size_t>(v)])) {
            system_.variables[static_cast<std::size_t>(v)].before = *p;
        }
        only_time_ = false;
    }

    void next(const EquationLines::Next& line) {
        About about(e_, "equations " + system_.path, line.span);
        const int v = known_variable(line.name);
        const auto every = e_.constant_time(line.every, scope_, "the time between two values");
        if (every && every->ticks < kTicksPerMillisecond / 10) {
            e_.error("out-of-range", line.every.span, "there is some time between two values",
                     "write one such as 0.1 s");
            return;
        }
        compiler_.about("the next " + line.name.text);
        if (v < 0 || !every) {
            return;
        }
        EquationSystem::Variable& variable = system_.variables[static_cast<std::size_t>(v)];
        if (variable.rate.valid() || variable.next.valid()) {
            e_.error("name-twice", line.name.span,
                     line.name.text + " changes in another way already",
                     "a variable has one rate or one next value");
            return;
        }
        if (const auto p =
                compiler_.program(line.value, dimensions_[static_cast<std::size_t>(v)])) {
            variable.next = *p;
            variable.every_ticks = every->ticks;
        }
    }

    // greater - less, and whether it is one variable less a number.
    std::optional<ProgramIndex> difference(const lang::Expr& greater, const lang::Expr& less,
                                           bool& plain) {
        auto a = compiler_.number(greater);
        auto b = compiler_.number(less);
        if (!a || !b) {
            return std::nullopt;
        }
        if (a->dimension != b->dimension && !a->zero && !b->zero) {
            e_.error(
                "wrong-unit", less.span,
                "these are " + lang::to_text(a->dimension) + " and " + lang::to_text(b->dimension),
                "compare quantities of one kind");
            return std::nullopt;
        }
        const auto is_variable = [](const Formula& f) {
            const auto nodes = f.value.nodes();
            return nodes.size() == 1 && nodes[0].op == ExprOp::kSlot &&
                   nodes[0].slot.kind == static_cast<std::uint32_t>(EquationSlot::kVariable);
        };
        plain = (is_variable(*a) && b->value.is_literal()) ||
                (is_variable(*b) && a->value.is_literal());
        auto value =
            e_.apply(ExprOp::kSubtract, {std::move(a->value), std::move(b->value)}, greater.span);
        if (!value) {
            return std::nullopt;
        }
        const auto index = formula_.code.add(*value);
        if (!index) {
            e_.error("too-deep", greater.span, index.error().message,
                     "give a part of it a name of its own");
            return std::nullopt;
        }
        return *index;
    }

    std::optional<net::EventIndex> event_named(const std::string& name) {
        const auto& members = e_.instances_[scope_.instance].members;
        const auto found = members.find(name);
        if (found == members.end() || found->second.kind != MemberKind::kEvent) {
            return std::nullopt;  // a name that was there twice, and has been told
        }
        net::EventDraft& draft = e_.draft().events[found->second.index];
        draft.crossing = true;
        draft.outside = false;
        return net::EventIndex{found->second.index};
    }

    void event(const EquationLines::Event& line) {
        About about(e_, "event " + system_.path + "." + line.name.text, line.span);
        bool plain = false;
        const auto value = difference(line.quantity, line.threshold, plain);
        const auto event = event_named(line.name.text);
        if (!value || !event) {
            return;
        }
        const auto direction =
            line.direction == EquationLines::Direction::kFalls   ? run::CrossingDirection::kFalls
            : line.direction == EquationLines::Direction::kRises ? run::CrossingDirection::kRises
                                                                 : run::CrossingDirection::kPasses;
        system_.events.push_back({.event = *event,
                                  .value = *value,
                                  .direction = direction,
                                  .plain = plain,
                                  .name = system_.path + "." + line.name.text,
                                  .where = e_.at(line.name.span)});
    }

    void sensor(const EquationLines::Sensor& line) {
        About about(e_, "sensor " + system_.path + "." + line.name.text, line.span);
        bool plain = false;
        const auto value = difference(line.greater, line.less, plain);
        const auto& members = e_.instances_[scope_.instance].members;
        const auto found = members.find(line.name.text);
        if (!value || found == members.end() || found->second.kind != MemberKind::kDatum) {
            return;
        }
        e_.draft().data[found->second.index].sensor = true;
        for (const bool begins : {true, false}) {
            const std::string name = line.name.text + std::string(begins ? notation::kSensorBegins
                                                                         : notation::kSensorEnds);
            const auto event = event_named(name);
            if (!event) {
                continue;
            }
            e_.draft().events[event->value].sets = {found->second.index};
            e_.draft().events[event->value].sets_to = begins;
            system_.events.push_back({.event = *event,
                                      .value = *value,
                                      .direction = begins ? run::CrossingDirection::kRises
                                                          : run::CrossingDirection::kFalls,
                                      .jumps = true,
                                      .plain = plain,
                                      .name = system_.path + "." + name,
                                      .where = e_.at(line.name.span)});
        }
    }

    void reset(const EquationLines::Reset& line) {
        About about(e_, "equations " + system_.path, line.span);
        const Term term = e_.resolve(line.transition, scope_);
        const auto* transition = std::get_if<TransitionTerm>(&term);
        if (transition == nullptr) {
            e_.wrong(line.transition.span, "a transition", term);
        }
        const int v = known_variable(line.name);
        compiler_.about(line.name.text);
        const auto value =
            v < 0 ? std::nullopt
                  : compiler_.program(line.value, dimensions_[static_cast<std::size_t>(v)]);
        if (transition == nullptr || !value) {
            return;
        }
        for (const EquationSystem::Reset& r : system_.resets) {
            if (r.transition == transition->transition &&
                r.variable == static_cast<std::uint32_t>(v)) {
                e_.error("written-twice", line.span,
                         "this firing sets " + line.name.text + " twice", "remove one of the two");
                return;
            }
        }
        system_.resets.push_back({transition->transition, static_cast<std::uint32_t>(v), *value});
    }

    Found read_datum(net::DatumIndex datum, const lang::Expr& e, Formula& out) {
        const ValueType type = e_.draft().data[datum.value].type;
        if (type.kind == ValueKind::kActor || type.kind == ValueKind::kProp) {
            e_.error("wrong-type", e.span, lang::to_text(e.path) + " is no number",
                     "equations read numbers, yes or no, times and values of enumerations");
            return Found::kWrong;
        }
        std::uint32_t i = 0;
        while (i < system_.data.size() && system_.data[i].datum != datum) {
            ++i;
        }
        if (i == system_.data.size()) {
            system_.data.push_back({datum, type.kind});
        }
        out = {slot(EquationSlot::kDatum, i),
               type.kind == ValueKind::kTime ? lang::dimension::kTime : lang::dimension::kNone};
        return Found::kYes;
    }

    std::uint32_t add_output(ProgramIndex program) {
        system_.outputs.push_back(program);
        std::uint32_t before = 0;
        for (const EquationSystem& s : e_.scene.equations) {
            before += static_cast<std::uint32_t>(s.outputs.size());
        }
        return before + static_cast<std::uint32_t>(system_.outputs.size()) - 1;
    }

    // ball.position = (0 m, h, 0 m), me.right_shoulder.flex = 20 deg*sin(phase)
    void driven(const EquationLines::Driven& line) {
        About about(e_, "equations " + system_.path, line.span);
        const auto& steps = line.what.steps;
        const lang::Path first{{steps[0]}, steps[0].span};
        const Term term = e_.resolve(first, scope_);
        std::string rest;
        for (std::size_t i = 1; i < steps.size(); ++i) {
            rest += (i > 1 ? "." : "") + steps[i].text;
        }
        compiler_.about(lang::to_text(line.what));
        if (const auto* prop = std::get_if<PropTerm>(&term)) {
            if (rest != "position") {
                e_.unknown(steps.back().span, "property of a prop", rest, {"position"});
                return;
            }
            const auto programs = compiler_.path(line.value, lang::dimension::kLength);
            if (!programs) {
                return;
            }
            for (const stage::DrivenProp& d : e_.scene.play.driven_props) {
                if (d.prop == prop->prop) {
                    driven_twice(line);
                    return;
                }
            }
            stage::DrivenProp d{.prop = prop->prop, .where = e_.at(line.span)};
            for (std::size_t k = 0; k < 3; ++k) {
                d.position[k] = add_output((*programs)[k]);
            }
            e_.scene.play.driven_props.push_back(d);
            return;
        }
        const auto* actor = std::get_if<ActorTerm>(&term);
        if (actor == nullptr) {
            e_.wrong(first.span, "a prop or an actor", term,
                     "a line `x.rate = ...` belongs to a variable; props have `position`, actors "
                     "have degrees of freedom");
            return;
        }
        const stage::Actor& who = e_.scene.play.cast.actors[actor->actor.value];
        const figure::DofSet& dofs = who.humanoid() ? mannequin() : who.character->dofs;
        const figure::DofIndex dof = dofs.find(rest);
        if (!dof.valid()) {
            std::vector<std::string> known;
            for (const figure::Dof& d : dofs.dofs) {
                known.push_back(d.name);
            }
            e_.unknown(steps.back().span, "degree of freedom of " + who.name, rest, known);
            return;
        }
        const bool slides = dofs.dofs[dof.value].kind == figure::DofKind::kSlide;
        const auto program = compiler_.program(
            line.value, slides ? lang::dimension::kLength : lang::dimension::kAngle);
        if (!program) {
            return;
        }
        for (const stage::DrivenDof& d : e_.scene.play.driven_dofs) {
            if (d.actor == actor->actor && d.dof == rest) {
                driven_twice(line);
                return;
            }
        }
        e_.scene.play.driven_dofs.push_back(
            {actor->actor, rest, add_output(*program), e_.at(line.span)});
    }

    void driven_twice(const EquationLines::Driven& line) {
        e_.error("name-twice", line.span, lang::to_text(line.what) + " follows something already",
                 "let one block of equations move it");
    }

    static const figure::DofSet& mannequin() {
        static const figure::DofSet dofs = figure::humanoid_dofs(figure::make_mannequin(1.75));
        return dofs;
    }

    void options(const EquationLines& lines) {
        OdeOptions& o = system_.options;
        if (lines.stiff) {
            o.method = OdeMethod::kRodas;
            o.relative = 1e-7;
            o.absolute = 1e-10;
        }
        if (lines.by_sundials) {
            by_sundials(lines);
        } else if (lines.baked) {
            e_.error("wrong-type", lines.baked.span,
                     "courses are baked of equations that SUNDIALS solves; all others are the same "
                     "everywhere",
                     "write `solver stiff by sundials` as well, or leave this line out");
        }
        if (lines.tolerance) {
            const auto size = e_.constant_number(lines.tolerance, scope_, lang::dimension::kNone,
                                                 "the tolerance");
            if (size && !(size->value >= 1e-13 && size->value <= 0.01)) {
                e_.error("out-of-range", lines.tolerance.span,
                         "a tolerance is between 1e-13 and 0.01", "write one such as 1e-6");
            } else if (size) {
                o.relative = size->value;
                o.absolute = size->value * 1e-3;
            }
        }
        if (lines.longest_step) {
            const auto most = e_.constant_time(lines.longest_step, scope_, "the longest step");
            if (most && most->ticks < kTicksPerMillisecond / 100) {
                e_.error("out-of-range", lines.longest_step.span, "steps are not so short",
                         "write 10 us or more");
            } else if (most) {
                o.most_s = most->seconds();
            }
        }
    }

    void by_sundials(const EquationLines& lines) {
        // Errors of a multistep method add up over many short steps.
        system_.options.method = OdeMethod::kGiven;
        system_.options.relative = OdeOptions().relative;
        system_.options.absolute = OdeOptions().absolute;
        if (!system_.pasts.empty()) {
            e_.error("wrong-type", lines.solver_span,
                     "the method of SUNDIALS does not look back, and `past` does",
                     "write `solver stiff`, which knows delays");
        }
        if (!lines.baked) {
            if (sundials_version().empty()) {
                e_.error("no-sundials", lines.solver_span, "this build has no SUNDIALS",
                         kSundialsRemedy);
            }
            return;
        }
        const lang::File& file = e_.library_.files[lines.baked.span.file];
        system_.baked_in = e_.library_.source->resolve(file.filename, lines.baked.text);
        baked_span_ = lines.baked.span;
        if (const auto bytes = e_.library_.source->read(system_.baked_in); bytes) {
            auto book = run::read_courses(*bytes, system_.baked_in);
            if (!book) {
                for (Diagnostic& d : book.error()) {
                    d.where = e_.at(baked_span_);
                    e_.diagnostics.push_back(std::move(d));
                }
                return;
            }
            system_.baked = std::make_shared<const run::CourseBook>(std::move(*book));
        }
    }

    // Nothing is wrong with the scene: it may be about to be baked.
    void tell_stale() {
        if (system_.baked_in.empty()) {
            return;
        }
        if (auto why = run::not_baked(system_)) {
            e_.diagnostics.push_back({Severity::kWarning, why->code, e_.at(baked_span_),
                                      "equations " + system_.path, std::move(why->message),
                                      std::move(why->remedy)});
        }
    }

    Elaboration& e_;
    Scope scope_;
    lang::Span baked_span_;
    motion::FormulaMovement formula_;
    FormulaCompiler compiler_;
    EquationSystem system_;
    std::vector<lang::Dimension> dimensions_;  // of the variables
    std::set<std::string> locals_, broken_;
    bool only_time_ = false;
};

void Elaboration::complete_equations() {
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        if (instances_[i].equations != nullptr) {
            EquationsBlock(*this, i).compile();
        }
    }
}

bool Elaboration::told_continuous(const Instance& instance, const lang::Name& name) {
    if (instance.equations == nullptr) {
        return false;
    }
    notation::Lowered ignored;
    const EquationLines lines =
        notation::read_equations(*instance.equations, library_.files[instance.file], ignored);
    const bool variable = std::any_of(lines.variables.begin(), lines.variables.end(),
                                      [&](const auto& v) { return v.name.text == name.text; }) ||
                          std::any_of(lines.locals.begin(), lines.locals.end(),
                                      [&](const auto& v) { return v.name.text == name.text; });
    if (variable) {
        error("continuous-variable", name.span,
              name.text + " changes all the time, and nets do not read it",
              "let the equations say when it crosses a value: `event " + name.text + "_low when " +
                  name.text + " falls through ...` and `on`, or `sensor ... when " + name.text +
                  " > ...` and `when`. A measure is `mean`, `most`, `least`, `total` or `final` of "
                  "it, or of a part that has a name in the block");
    }
    return variable;
}

}  // namespace puppetri::scene
