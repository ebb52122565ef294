// SPDX-License-Identifier: MIT
// Pulse processes on signed, weighted digraphs: each vertex has a value and a pulse, and in every
// step the pulses of all vertices go along the arcs, times their weights, and are added to the
// values where they arrive:
//   p_j(t+1) = sum over i of w_ij p_i(t) + what is given from outside
//   v_j(t+1) = v_j(t) + p_j(t+1),   v_j(0) = its start + p_j(0).
// One transition does this for all vertices at once, from the values before it.
// Source  F. S. Roberts, "Discrete Mathematical Models" (1976), chapter 4; stability by the
//         eigenvalues of the weights, theorem 4.6 and following there.
//   pulses traffic {
//     every 1 s
//     cars starts 10 pulse 1
//     jams
//     cars -> jams: 0.5
//     jams -> cars: -0.3
//   }
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ending.h"
#include "kinds.h"
#include "line.h"
#include "literal.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

// Beyond this many vertices the growth is not looked at.
constexpr std::size_t kMostLookedAt = 80;
constexpr int kSquarings = 40;

// Right after the step, before what scenes write sees it.
constexpr std::int64_t kEnds = 999'999;
constexpr const char* kSteps = "pulses_steps";

constexpr std::string_view kVertexForm =
    "NAME \"caption\" starts VALUE pulse PULSE whole LOW .. HIGH";
constexpr std::string_view kArcForm = "FROM -> TO: WEIGHT";
constexpr std::string_view kGivenForm = "NAME gets PULSE on EVENT, or gets PULSE at TIME";

using Matrix = std::vector<double>;  // row by row

Matrix product(const Matrix& a, const Matrix& b, std::size_t n) {
    Matrix c(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            const double x = a[i * n + k];
            for (std::size_t j = 0; x != 0 && j < n; ++j) {
                c[i * n + j] += x * b[k * n + j];
            }
        }
    }
    return c;
}

// The largest absolute value of an eigenvalue, as the limit of |A^k|^(1/k) for k = 2^40; the
// factors that Jordan blocks add are far below 1e-9 then. 0 of a nilpotent matrix.
// Source  I. M. Gelfand's formula.
double spectral_radius(Matrix a, std::size_t n) {
    double log_scale = 0;  // A^k = exp(log_scale) * a
    double k = 1;
    for (int i = 0; i <= kSquarings; ++i) {
        double norm = 0;
        for (const double x : a) {
            norm = std::fmax(norm, std::fabs(x));
        }
        if (norm == 0) {
            return 0;
        }
        int exponent = 0;
        norm = std::frexp(norm, &exponent);  // a power of two: scaling is exact
        for (double& x : a) {
            x = std::ldexp(x, -exponent);
        }
        log_scale += exponent;
        if (i == kSquarings) {
            break;
        }
        a = product(a, a, n);
        log_scale *= 2;
        k *= 2;
    }
    const double power = log_scale / k;  // of two
    const double whole = std::floor(power);
    // 2^(power - whole) without a library's exp: (1 + x)^m would do, a series is short.
    const double x = (power - whole) * 0.69314718055994530942;
    double term = 1, sum = 1;
    for (int i = 1; i < 30; ++i) {
        term *= x / i;
        sum += term;
    }
    return std::ldexp(sum, static_cast<int>(whole));
}

// Whether 1 is an eigenvalue, up to rounding: A - 1 has no inverse.
bool has_eigenvalue_one(Matrix a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        a[i * n + i] -= 1;
    }
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < n; ++r) {
            pivot = std::fabs(a[r * n + c]) > std::fabs(a[pivot * n + c]) ? r : pivot;
        }
        if (std::fabs(a[pivot * n + c]) < 1e-10) {
            return true;
        }
        for (std::size_t j = 0; j < n; ++j) {
            std::swap(a[c * n + j], a[pivot * n + j]);
        }
        for (std::size_t r = c + 1; r < n; ++r) {
            const double f = a[r * n + c] / a[c * n + c];
            for (std::size_t j = c; j < n; ++j) {
                a[r * n + j] -= f * a[c * n + j];
            }
        }
    }
    return false;
}

class Pulses {
 public:
    Pulses(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        if (!has_plain_lines(block_, teller_)) {
            return;
        }
        const auto each = [this](const auto& wanted, const auto& read) {
            each_line(block_, teller_, wanted, read);
        };
        each(is_period, [this](Line& line) {
            if (const Expr* e = line.value("the time of a step")) {
                period_ = *e;
            }
            line.finish("every TIME");
        });
        each(is_ending,
             [this](Line& line) { read_count(line, "steps", kSteps, teller_, ending_); });
        each(
            [](const lang::Property& p) {
                return !is_period(p) && !has_arrow(p) && !is_given(p) && !is_ending(p);
            },
            [this](Line& line) { vertex(line); });
        each(has_arrow, [this](Line& line) { arc(line); });
        each(is_given, [this](Line& line) { given(line); });
        if (!period_) {
            teller_.error("no-period", block_.name.span, "nothing says how long a step is",
                          "write every 1 s");
            return;
        }
        if (vertices_.empty()) {
            teller_.error("no-states", block_.name.span, "there is no vertex",
                          "give each a line of its own: NAME starts 1 pulse 1");
            return;
        }
        make();
        make_ways("pulses", ending_, kEnds, teller_, body_);
        warn_of_growth();
    }

 private:
    struct Vertex {
        lang::Name name;
        lang::Caption caption;
        Expr starts, pulse, range;
        bool outside = false;  // is given pulses from outside
        lang::Span span;
    };
    struct Arc {
        std::size_t from = 0, to = 0;
        Expr weight;
        lang::Span span;
    };

    static bool begins_with(const lang::Property& p, std::string_view word) {
        return !p.values.empty() && p.values[0].kind == ExprKind::kPath &&
               p.values[0].path.steps.size() == 1 && p.values[0].path.steps[0].text == word;
    }
    static bool is_given(const lang::Property& p) { return begins_with(p, "gets"); }
    static bool is_period(const lang::Property& p) {
        return p.name.steps.size() == 1 && p.name.steps[0].text == "every" && !has_arrow(p);
    }

    void vertex(Line& line) {
        Vertex made{.name = line.name().steps[0],
                    .caption = line.caption(),
                    .starts = {},
                    .pulse = {},
                    .range = {},
                    .span = line.span()};
        while (!line.done()) {
            const bool starts = line.word("starts");
            const bool pulse = !starts && line.word("pulse");
            if (starts || pulse || line.word("whole")) {
                if (const Expr* e = line.value("a number")) {
                    (starts ? made.starts : pulse ? made.pulse : made.range) = *e;
                }
            } else {
                line.finish(kVertexForm);
            }
        }
        if (made.range && made.range.kind != ExprKind::kRange) {
            teller_.error("syntax", made.range.span, "whole values lie in a range",
                          "write whole -100 .. 100");
            return;
        }
        if (!numbers_.emplace(made.name.text, vertices_.size()).second) {
            teller_.error("name-twice", made.span, "there is already a vertex " + made.name.text,
                          "choose another name");
            return;
        }
        vertices_.push_back(std::move(made));
    }

    std::optional<std::size_t> find(const lang::Path& path) {
        const auto found =
            path.steps.size() == 1 ? numbers_.find(path.steps[0].text) : numbers_.end();
        if (found == numbers_.end()) {
            teller_.error("unknown-name", path.span, "there is no vertex " + lang::to_text(path),
                          "give it a line of its own: " + lang::to_text(path) + " starts 1");
            return std::nullopt;
        }
        return found->second;
    }

    void arc(Line& line) {
        line.symbol("->");
        const lang::Path* to = line.path("the name of a vertex");
        if (to == nullptr) {
            return;
        }
        const auto before = find(line.name()), after = find(*to);
        if (!line.symbol(":")) {
            teller_.error("syntax", line.span(), "an arc has a weight with a sign",
                          "write " + std::string(kArcForm));
            return;
        }
        const Expr* weight = line.value("a weight");
        if (weight == nullptr) {
            return;
        }
        line.finish(kArcForm);
        if (before && after) {
            arcs_.push_back({*before, *after, *weight, line.span()});
        }
    }

    // `x_gets: -> on EVENT set x_given := x_given + PULSE`: it enters with the next step.
    void given(Line& line) {
        const auto vertex = find(line.name());
        line.word("gets");
        const Expr* pulse = line.value("a pulse");
        if (!vertex || pulse == nullptr) {
            return;
        }
        const lang::Span span = line.span();
        const std::string& name = vertices_[*vertex].name.text;
        const int number = ++given_[name];
        const std::string verb = name + "_gets" + (number == 1 ? "" : "_" + std::to_string(number));
        lang::Transition t = make_transition(make_name(verb, span), {}, {});
        t.span = span;
        t.is_public = true;
        if (line.word("on")) {
            do {
                if (const lang::Path* event = line.path("the name of an event")) {
                    t.events.push_back(*event);
                }
            } while (line.word("or"));
        } else if (line.word("at")) {
            if (const Expr* time = line.value("a time")) {
                lang::Event event;
                event.name = make_name(verb + "_time", span);
                event.at.push_back(*time);
                event.span = span;
                t.events.push_back(make_path(event.name.text, span));
                body_.events.push_back(std::move(event));
            }
        }
        line.finish(kGivenForm);
        if (t.events.empty()) {
            teller_.error("syntax", span, "it does not say when",
                          "write " + std::string(kGivenForm));
            return;
        }
        vertices_[*vertex].outside = true;
        const std::string datum = name + "_given";
        t.assignments.push_back(make_assignment(
            make_path(datum, span), make_binary(Op::kAdd, make_reference(datum, span), *pulse)));
        body_.transitions.push_back(std::move(t));
    }

    void datum(const Vertex& v, const std::string& name, lang::Caption caption, Expr initial) {
        lang::Data d;
        d.name = make_name(name, v.span);
        d.caption = std::move(caption);
        d.is_public = true;
        d.type = v.range ? v.range : make_reference("real", v.span);
        d.initial = std::move(initial);
        d.span = v.span;
        body_.data.push_back(std::move(d));
    }

    void make() {
        lang::Transition step = make_clock(body_, period_);
        std::vector<Expr> pulse(vertices_.size());  // of the next step
        const auto add = [](Expr& sum, Expr more) {
            sum = sum ? make_binary(Op::kAdd, std::move(sum), std::move(more)) : std::move(more);
        };
        for (const Arc& a : arcs_) {
            add(pulse[a.to],
                make_binary(Op::kMultiply, a.weight,
                            make_reference(vertices_[a.from].name.text + "_pulse", a.span)));
        }
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            const Vertex& v = vertices_[i];
            const std::string& name = v.name.text;
            const Expr zero = make_number(Rational{0}, v.span);
            const Expr first = v.pulse ? v.pulse : zero;
            datum(v, name, v.caption, v.starts ? make_binary(Op::kAdd, v.starts, first) : first);
            datum(v, name + "_pulse", {}, first);
            if (v.outside) {
                datum(v, name + "_given", {}, zero);
                add(pulse[i], make_reference(name + "_given", v.span));
                step.assignments.push_back(
                    make_assignment(make_path(name + "_given", v.span), zero));
            }
            if (!pulse[i]) {
                pulse[i] = zero;
            }
            step.assignments.push_back(
                make_assignment(make_path(name + "_pulse", v.span), pulse[i]));
            step.assignments.push_back(
                make_assignment(make_path(name, v.span),
                                make_binary(Op::kAdd, make_reference(name, v.span), pulse[i])));
        }
        if (ending_) {
            step.outputs.push_back(make_arc(lang::ArcKind::kGive, make_path(kSteps, ending_.span)));
        }
        body_.transitions.push_back(std::move(step));
    }

    void warn_of_growth() {
        const std::size_t n = vertices_.size();
        if (n > kMostLookedAt) {
            return;
        }
        Matrix a(n * n, 0);
        for (const Arc& arc : arcs_) {
            const auto w = literal_number(arc.weight);
            if (!w) {
                return;
            }
            a[arc.from * n + arc.to] += to_double(*w);
        }
        const double radius = spectral_radius(a, n);
        if (radius > 1 + 1e-9) {
            teller_.warn("grows", block_.name.span,
                         "pulses can grow without bound, by a factor of about " +
                             number_text(radius) +
                             " in a step: the weights have an eigenvalue of this size",
                         "make a ring of arcs weaker, or change its sign");
        } else if (radius > 1 - 1e-9 && has_eigenvalue_one(a, n)) {
            teller_.warn("grows", block_.name.span,
                         "pulses stay, so values can grow without bound: the weights have the "
                         "eigenvalue 1",
                         "make a ring of arcs weaker, or change its sign");
        }
    }

    // Three digits after the point, without a locale.
    static std::string number_text(double x) {
        const auto thousandths = static_cast<std::int64_t>(std::fmin(x, 1e12) * 1000 + 0.5);
        std::string rest = std::to_string(thousandths % 1000);
        rest.insert(0, 3 - rest.size(), '0');
        return std::to_string(thousandths / 1000) + "." + rest;
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    Expr period_;
    Ending ending_;
    std::vector<Vertex> vertices_;
    std::map<std::string, std::size_t> numbers_;
    std::map<std::string, int> given_;
    std::vector<Arc> arcs_;
};

}  // namespace

void lower_pulses(const lang::Block& block, const lang::File& file, Lowered& out) {
    Pulses(block, file, out).lower();
}

}  // namespace puppetri::notation
