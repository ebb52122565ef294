// SPDX-License-Identifier: MIT
// `puppetri solve SCENE`: what a simulation would estimate, computed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "budget_arguments.h"
#include "commands.h"
#include "horizon.h"
#include "measures.h"
#include "proving.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/markov_net.h"
#include "puppetri/scene/scene.h"
#include "puppetri/sim/solved_queues.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using proof::ChainSolution;
using proof::MarkovNet;

// Above this a solution is not told as one.
constexpr double kMostResidual = 1e-8;

struct Row {
    std::string name;
    double value = 0;
    std::string unit;
};

// What makes sense of a distribution: no largest numbers, no counts.
bool solvable(const net::Net& net, const sim::Metric& metric, bool long_run) {
    using enum sim::MetricKind;
    if (metric.kind != kMeasure) {
        return metric.kind == kTokens || metric.kind == kBusy ||
               (long_run && (metric.kind == kStay || metric.kind == kRate));
    }
    const net::MeasureDraft& m = net.declarations().measures[metric.element];
    switch (m.seen) {
        case net::Seen::kState:
            return m.statistic == net::Statistic::kMean || m.statistic == net::Statistic::kShare;
        case net::Seen::kFirings:
            return long_run && m.statistic == net::Statistic::kRate && !m.from.empty() &&
                   !m.from[0].keyed;
        case net::Seen::kStays:
            return long_run && m.statistic == net::Statistic::kMean;
        default:
            return false;
    }
}

// Reads one state of the chain.
class StateReader final : public Code::Reader {
 public:
    explicit StateReader(const proof::TimedGraph& graph) : graph_(graph) {}
    std::uint32_t state = 0;  // of the graph
    puppetri::Value read(std::uint32_t kind, std::uint32_t index) const override {
        switch (static_cast<net::SlotKind>(kind)) {
            case net::SlotKind::kDatum:
                return graph_.datum(state, {index});
            case net::SlotKind::kCount:
                return graph_.tokens(state, {index}).total;
            case net::SlotKind::kReady:
                return graph_.tokens(state, {index}).ready;
            default:
                return 0;
        }
    }

 private:
    const proof::TimedGraph& graph_;
};

double mean_value(const net::Net& net, const MarkovNet& markov, const std::vector<double>& shares,
                  std::uint32_t measure) {
    const net::MeasureDraft& m = net.declarations().measures[measure];
    const net::NetTables& tables = net.tables();
    StateReader reader(markov.graph);
    double mean = 0;
    for (std::uint32_t i = 0; i < markov.chain.size(); ++i) {
        reader.state = markov.state[i];
        const Evaluated e = tables.measure_code.evaluate(tables.measures[measure].value, reader);
        if (e.fault != EvalFault::kNone) {
            return std::nan("");
        }
        const auto value = static_cast<double>(e.value);
        mean += shares[i] * (m.value.type().kind == ValueKind::kReal   ? real_of_value(e.value)
                             : m.value.type().kind == ValueKind::kTime ? value / kTicksPerSecond
                                                                       : value);
    }
    return mean;
}

double stay_in(const MarkovNet& markov, const std::vector<double>& shares, net::PlaceIndex place) {
    const double arrivals = markov.arrivals(shares, place);  // Little's law
    return arrivals > 0 ? markov.mean_tokens(shares, place) / arrivals : std::nan("");
}

double value_of(const net::Net& net, const MarkovNet& markov, const std::vector<double>& shares,
                const sim::Metric& m) {
    switch (m.kind) {
        case sim::MetricKind::kTokens:
            return markov.mean_tokens(shares, {m.element});
        case sim::MetricKind::kBusy:
            return markov.share_marked(shares, {m.element});
        case sim::MetricKind::kRate:
            return markov.rate(shares, {m.element});
        case sim::MetricKind::kMeasure:
            break;
        default:
            return stay_in(markov, shares, {m.element});
    }
    const net::MeasureDraft& measure = net.declarations().measures[m.element];
    if (measure.seen == net::Seen::kState) {
        return mean_value(net, markov, shares, m.element);
    }
    if (measure.seen == net::Seen::kStays) {
        return stay_in(markov, shares, measure.place);
    }
    double rate = 0;
    for (const net::Moment& moment : measure.from) {
        rate += markov.rate(shares, moment.transition);
    }
    return rate;
}

std::optional<SimTime> time_argument(const Arguments& arguments, const char* name,
                                     FrameRate frame_rate, bool& good) {
    if (!arguments.given(name)) {
        return std::nullopt;
    }
    const auto horizon = parse_horizon(arguments.text(name), frame_rate);
    if (!horizon || !horizon->time) {
        say_error(std::string(name) + ": write a time, as 40s");
        good = false;
        return std::nullopt;
    }
    return horizon->time;
}

// A named state of the scene, or a place that has a token.
std::optional<net::Formula> state_named(const net::Net& net, const std::string& name) {
    for (const net::NamedState& s : net.declarations().states) {
        if (s.path == name) {
            return s.condition;
        }
    }
    if (const net::PlaceIndex place = net.find_place(name); place.valid()) {
        return net::Formula::marked(place);
    }
    return std::nullopt;
}

// `of`: "7 states", "3 stations by their product form".
int tell(const Arguments& arguments, const std::vector<Row>& rows, const char* count_name,
         std::size_t count, const char* of, double residual) {
    const bool solved = residual <= kMostResidual;
    if (arguments.given("--json")) {
        io::JsonWriter json;
        json.begin_object();
        json.member(count_name, static_cast<std::int64_t>(count));
        json.member("residual", residual);
        json.member("solved", solved);
        json.key("values").begin_object();
        for (const Row& r : rows) {
            json.member(r.name, r.value);
        }
        json.end_object();
        json.end_object();
        std::puts(json.take().c_str());
    } else if (solved) {
        std::size_t width = 0;
        for (const Row& r : rows) {
            width = std::max(width, r.name.size());
        }
        for (const Row& r : rows) {
            std::printf("%-*s  %12.8g %s\n", static_cast<int>(width), r.name.c_str(), r.value,
                        r.unit.c_str());
        }
        char text[80];
        std::snprintf(text, sizeof text, "%zu %s%s, residual %.1e", count, count_name, of,
                      residual);
        say(text);
    }
    if (!solved) {
        say("UNKNOWN: the equations of the chain did not come to rest");
        return kUnknown;
    }
    return kFine;
}

// The draft's number of what the net calls by the same path.
template <class List>
std::uint32_t number_in(const List& list, std::string_view path) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const auto& element) { return element.path == path; });
    return static_cast<std::uint32_t>(found - list.begin());
}

// The long run as a product over stations. Nothing where it has no such form, or where the form
// does not tell a measure that was asked for: then the chain is to be solved.
std::optional<int> solve_as_queues(const Arguments& arguments, const scene::Scene& scene,
                                   const std::vector<sim::Metric>& metrics) {
    Diagnostics growing = net::growing_queues(scene.draft);
    if (!growing.empty()) {
        for (Diagnostic& d : growing) {
            d.severity = Severity::kError;
            d.message += ", and there is no long run";
        }
        say_diagnostics(growing);
        return kBadInput;
    }
    const auto solved = sim::solve_queues(scene.draft);
    if (!solved) {
        return std::nullopt;
    }
    std::vector<Row> rows;
    for (const sim::Metric& m : metrics) {
        if (m.kind == sim::MetricKind::kMeasure) {  // the chain knows those
            if (arguments.given("--measure")) {
                return std::nullopt;
            }
            continue;
        }
        sim::Metric in_draft = m;
        in_draft.element =
            sim::of_transition(m.kind)
                ? number_in(scene.draft.transitions, scene.net.transition({m.element}).path)
                : number_in(scene.draft.places, scene.net.place({m.element}).path);
        const std::optional<double> value = solved->value(in_draft);
        if (value) {
            rows.push_back({sim::name_of(scene.net, m), *value, sim::unit_of(scene.net, m)});
        } else if (arguments.given("--measure")) {
            return std::nullopt;
        }
    }
    return tell(arguments, rows, "stations", solved->loads.size(), " by their product form",
                solved->residual);
}

int solve(const Arguments& arguments) {
    const auto watched = WatchedBudget::from(arguments);
    if (!watched) {
        return kBadInput;
    }
    const auto subject = load_subject(arguments.text("scene"), arguments);
    if (!subject) {
        return subject.error();
    }
    const scene::Scene* scene = subject->scene.get();
    const net::Net& net = scene != nullptr ? scene->net : *subject->net;
    const FrameRate rate = scene != nullptr ? scene->frame_rate : FrameRate{};
    bool good = true;
    const std::optional<SimTime> at = time_argument(arguments, "--at", rate, good),
                                 within = time_argument(arguments, "--within", rate, good);
    if (!good) {
        return kBadInput;
    }
    std::vector<net::Formula> atoms;
    if (arguments.given("--reach")) {
        auto formula = state_named(net, arguments.text("--reach"));
        if (!formula) {
            say_error("there is no state or place " + arguments.text("--reach"));
            return kBadInput;
        }
        atoms.push_back(std::move(*formula));
    } else if (within) {
        say_error("--within: say with --reach what is to be reached");
        return kBadInput;
    }
    std::vector<sim::Metric> metrics;
    for (const std::string& text : arguments.texts("--measure")) {
        auto metric = parse_measure(net, text);
        if (!metric) {
            say_error(metric.error());
            return kBadInput;
        }
        if (!solvable(net, *metric, !at)) {
            say_error(text +
                      (at ? " is no measure of an instant: PLACE.tokens and PLACE.busy are, and "
                            "declared means and shares of the state"
                          : " cannot be solved: PLACE.tokens, .busy, .stay and "
                            "TRANSITION.rate can, and declared means and shares of the "
                            "state, mean times in places, and rates"));
            return kBadInput;
        }
        metrics.push_back(*metric);
    }
    if (metrics.empty()) {
        metrics = sim::all_metrics(net);
        std::erase_if(metrics, [&](const sim::Metric& m) { return !solvable(net, m, !at); });
    }
    if (scene != nullptr && !at && atoms.empty()) {
        if (const std::optional<int> told = solve_as_queues(arguments, *scene, metrics)) {
            return *told;
        }
    }
    const MarkovNet markov =
        proof::markov_net({net,
                           atoms,
                           {},
                           0,
                           scene != nullptr ? scene->beat.ticks : kTicksPerSecond,
                           watched->budget()});
    watched->wipe();
    if (!markov.available()) {
        say("UNKNOWN: this net is no finite Markov chain:");
        for (const std::string& why : markov.why_not) {
            say("  " + why);
        }
        say("  help: `puppetri sweep` estimates the same by simulation");
        return kUnknown;
    }
    if (markov.graph.graph.ended != proof::Ended::kDone) {
        say(std::string("UNKNOWN: not all states were found: ") +
            name_of(markov.graph.graph.ended) +
            "; a queue without bound has infinitely many: give it a room (`holds at most`)");
        return kUnknown;
    }
    std::vector<Row> rows;
    double residual = 0;
    if (!atoms.empty()) {
        proof::StateBits goal(markov.chain.size());
        for (std::uint32_t i = 0; i < markov.chain.size(); ++i) {
            if (markov.graph.graph.atoms.must_hold(markov.state[i], 0)) {
                goal.add(i);
            }
        }
        const std::string name = arguments.text("--reach");
        if (within) {
            const ChainSolution s = proof::reached_by(markov.chain, goal, within->seconds());
            rows.push_back(
                {"P(" + name + " within " + arguments.text("--within") + ")", s.values[0], ""});
            residual = std::max(residual, s.residual);
        }
        const ChainSolution ever = proof::ever_reached(markov.chain, goal);
        rows.push_back({"P(" + name + " ever)", ever.values[0], ""});
        residual = std::max(residual, ever.residual);
        const ChainSolution s = proof::mean_time_to(markov.chain, goal);
        rows.push_back({"mean time to " + name, s.values[0], "s"});
        residual = std::max(residual, s.residual);
    } else {
        const ChainSolution s =
            at ? proof::at_time(markov.chain, at->seconds()) : proof::long_run(markov.chain);
        residual = s.residual;
        for (const sim::Metric& m : metrics) {
            rows.push_back(
                {sim::name_of(net, m), value_of(net, markov, s.values, m), sim::unit_of(net, m)});
        }
    }
    return tell(arguments, rows, "states", markov.chain.size(), "", residual);
}

}  // namespace

Command solve_command() {
    std::vector<Option> options = {
        {"scene", Value::kText, "SCENE", "a .pup file with a scene, or a net of PIPE (.xml)", true},
        {"--measure", Value::kTexts, "MEASURE", "what to compute; without: everything", false},
        {"--at", Value::kText, "T", "at this time instead of in the long run", false},
        {"--reach", Value::kText, "STATE",
         "a named state or a place: how probable and how soon it is", false},
        {"--within", Value::kText, "T", "and the probability that it does within T", false},
        {"--json", Value::kFlag, "", "as one JSON object on stdout", false}};
    for (Option& option : budget_options()) {
        options.push_back(std::move(option));
    }
    return {
        "solve", "means and probabilities of a Markov chain or net, computed instead of estimated",
        "Where all durations and delays are exponential or none, a net is a Markov chain; where "
        "all are constant, one\n"
        "in steps. Its long run, its state at an instant, the time until something happens and the "
        "probability that it\n"
        "ever does are solved, and the residual of the equations is printed. Ties go by `odds`, "
        "priorities hold,\n"
        "`servers` count. The long run of a network of queues that is a product over its stations "
        "(Jackson; closed:\n"
        "mean value analysis) is told in that form. What is in the way is named; exit 3 then.\n\n"
        "Measures are those of `puppetri sweep`: PLACE.tokens, PLACE.busy, PLACE.stay, "
        "TRANSITION.rate,\n"
        "and what the scene declares of means and shares of the state, mean times in places, "
        "rates.\n\n"
        "Examples:\n"
        "  puppetri solve shop.pup\n"
        "  puppetri solve shop.pup --measure shop.queue.stay --json\n"
        "  puppetri solve shop.pup --at 60s\n"
        "  puppetri solve gspn1.xml\n"
        "  puppetri solve shop.pup --reach full --within 1h",
        std::move(options), solve};
}

}  // namespace puppetri::cli
