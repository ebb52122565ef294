// SPDX-License-Identifier: MIT
// `puppetri sweep SCENE`: many runs with other luck and other parameters, and what they tell.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "commands.h"
#include "horizon.h"
#include "interrupt.h"
#include "measures.h"
#include "puppetri/base/hash.h"
#include "puppetri/base/text.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/net/tables.h"
#include "puppetri/scene/beside.h"
#include "puppetri/scene/scene.h"
#include "puppetri/sim/net_experiment.h"
#include "sweep_grid.h"
#include "sweep_journal.h"
#include "sweep_pilot.h"
#include "sweep_report.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

// The scene's file with other text, all else as on the disk.
class ChangedFiles final : public scene::FileSource {
 public:
    ChangedFiles(std::string path, std::string text)
        : path_(std::move(path)), text_(std::move(text)) {}
    Result<std::string, scene::FileProblem> read(const std::string& path) override {
        return path == path_ ? text_ : disk_.read(path);
    }
    std::string resolve(const std::string& importer, const std::string& written) override {
        return disk_.resolve(importer, written);
    }

 private:
    io::DiskFiles disk_;
    std::string path_, text_;
};

Checked<scene::Scene> load_point(const std::string& path,
                                 const std::vector<scene::Setting>& settings) {
    io::DiskFiles disk;
    if (settings.empty()) {
        return scene::load(disk, path);
    }
    const auto text = disk.read(path);
    if (!text) {
        return scene::load(disk, path);  // says why
    }
    PUP_TRY(std::string changed, scene::with_settings(*text, path, settings));
    ChangedFiles files(path, std::move(changed));
    return scene::load(files, path);
}

// "1%" is a share of the mean, "0.5" a half width in the measure's own unit.
std::optional<sim::Precision> parse_precision(const std::string& text) {
    char* end = nullptr;
    const double x = std::strtod(text.c_str(), &end);
    const std::string rest = end;
    if (end == text.c_str() || !(x > 0) || !std::isfinite(x) || (rest != "" && rest != "%")) {
        return std::nullopt;
    }
    return rest == "%" ? sim::Precision{.share_of_mean = x / 100} : sim::Precision{.half_width = x};
}

struct Request {
    std::vector<Varied> varied;
    sim::Plan plan;
    std::optional<SimTime> until, warm_up;
    bool finds_warm_up = false;            // --warm-up auto
    std::optional<std::uint32_t> batches;  // of one run, instead of replications; 0: auto
    std::optional<std::uint64_t> firings;
    std::vector<std::string> measures;
};

Result<Request, std::string> parse_request(const Arguments& a, const scene::FrameRate& rate) {
    Request r;
    for (const std::string& text : a.texts("--vary")) {
        PUP_TRY(Varied v, parse_varied(text));
        r.varied.push_back(std::move(v));
    }
    r.measures = a.texts("--measure");
    const std::int64_t replications = a.integer("--replications", 100);
    r.plan.antithetic = a.given("--antithetic");
    if (replications < (r.plan.antithetic ? 4 : 2)) {
        return Unexpected(std::string("--replications: give at least ") +
                          (r.plan.antithetic ? "4, since pairs count once" : "2"));
    }
    r.plan.replications = static_cast<std::uint64_t>(replications);
    r.plan.at_most = static_cast<std::uint64_t>(
        std::max<std::int64_t>(replications, a.integer("--at-most", 1'000'000)));
    if (a.given("--until-half-width")) {
        const auto precision = parse_precision(a.text("--until-half-width"));
        if (!precision) {
            return Unexpected(a.text("--until-half-width") +
                              " is no precision: write 1% (of the mean) or 0.5 (in the unit of the "
                              "measure)");
        }
        r.plan.precision = *precision;
    }
    char* end = nullptr;
    const std::string level = a.text("--level", "95%");
    r.plan.level = std::strtod(level.c_str(), &end) / 100;
    if (std::string(end) != "%" || !(r.plan.level > 0 && r.plan.level < 1)) {
        return Unexpected(level + " is no level: write a percentage between 0% and 100%, as 95%");
    }
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    r.plan.threads =
        static_cast<unsigned>(std::clamp<std::int64_t>(a.integer("--threads", cores), 1, 1024));
    if (a.given("--for")) {
        PUP_TRY(const scene::Horizon horizon, parse_horizon(a.text("--for"), rate));
        r.until = horizon.time;
        r.firings = horizon.firings;
    }
    if (a.given("--batches")) {
        const std::string text = a.text("--batches");
        const long count = text == "auto" ? 0 : std::strtol(text.c_str(), &end, 10);
        if (text != "auto" && (*end != '\0' || count < 2 || count > 1'000'000)) {
            return Unexpected(
                std::string("--batches: write how many, from 2 (10 to 30 are usual), or auto"));
        }
        if (r.plan.antithetic || a.given("--replications")) {
            return Unexpected(
                std::string("--batches cut one run: leave out --replications and --antithetic"));
        }
        r.batches = static_cast<std::uint32_t>(count);
    }
    if (a.text("--warm-up") == "auto") {
        r.finds_warm_up = true;
    } else if (a.given("--warm-up")) {
        PUP_TRY(const scene::Horizon horizon, parse_horizon(a.text("--warm-up"), rate));
        if (!horizon.time) {
            return Unexpected(std::string("--warm-up: write a time (40s), frames (960f), or auto"));
        }
        r.warm_up = horizon.time;
    }
    return r;
}

bool needs_stage(const scene::Scene& scene) {
    const net::NetTables& tables = scene.net.tables();
    const bool asks =
        std::any_of(tables.durations.begin(), tables.durations.end(),
                    [](const net::DurationTable& d) { return d.kind == net::DurationKind::kAuto; });
    return asks || !scene.equations.empty() || !scene.sensors.empty() ||
           std::any_of(scene.play.actions.begin(), scene.play.actions.end(),
                       [](const stage::Action& a) { return !a.raises.empty(); });
}

// The stage of one run, with the equations and sensors that go on beside the net.
class Theatre final : public net::MovementHost {
 public:
    explicit Theatre(const scene::Scene& scene)
        : beside_(scene), stage_(scene.play, beside_.quantities()) {}
    SimTime begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                  SimTime duration, std::span<const std::int64_t> attributes) override {
        return stage_.begin(action, activity, at, duration, attributes);
    }
    std::span<const net::RaisedEvent> raised(net::ActivityIndex activity) override {
        return stage_.raised(activity);
    }
    void cut(net::ActivityIndex activity, SimTime at) override { stage_.cut(activity, at); }
    void left(net::ActivityIndex activity, SimTime at) override { stage_.left(activity, at); }
    std::vector<run::Coupled*> coupled() { return beside_.coupled(stage_); }

 private:
    scene::Beside beside_;
    stage::Stage stage_;
};
std::unique_ptr<net::MovementHost> make_stage(const void* context) {
    return std::make_unique<Theatre>(*static_cast<const scene::Scene*>(context));
}
std::vector<run::Coupled*> coupled_to(net::MovementHost& host) {
    return static_cast<Theatre&>(host).coupled();
}

// What all points share in the progress on the terminal.
struct Watch {
    Progress progress{"sweeping"};
    std::size_t point = 0, points = 1;
    static bool go_on(void* context, std::uint64_t done, std::uint64_t needed) {
        auto& w = *static_cast<Watch*>(context);
        const double share = static_cast<double>(done) / static_cast<double>(needed);
        w.progress.show((static_cast<double>(w.point) + share) / static_cast<double>(w.points),
                        "point " + std::to_string(w.point + 1) + " of " + std::to_string(w.points) +
                            ", run " + std::to_string(done) + " of " + std::to_string(needed));
        return !interrupted();
    }
};

bool write_or_say(const std::string& path, const std::string& text) {
    if (auto written = io::write_file(path, text); !written) {
        say_diagnostics(written.error());
        return false;
    }
    return true;
}

std::uint64_t fingerprint(const std::vector<scene::Scene>& scenes, const SweepResult& result,
                          const Request& request) {
    Hash64 h;
    for (const scene::Scene& s : scenes) {
        h.add_u64(s.net.hash());
    }
    for (const MeasureName& m : result.measures) {
        h.add_text(m.name);
    }
    h.add_u64(result.seed).add_f64(result.horizon_s).add_f64(result.warm_up_s);
    h.add_u64(request.firings.value_or(0)).add_u64(request.plan.antithetic ? 1 : 0);
    h.add_f64(result.batch_s);
    return h.value();
}

void tell_failures(const SweepResult& result) {
    constexpr std::size_t kShown = 3;
    for (const SweepPoint& point : result.points) {
        const auto& failures = point.outcome.failures;
        for (std::size_t i = 0; i < std::min(kShown, failures.size()); ++i) {
            Diagnostic d = failures[i].why;
            d.severity = Severity::kWarning;
            d.message = "run " + std::to_string(failures[i].replication.number) + " (--seed " +
                        std::to_string(failures[i].replication.seed) +
                        (failures[i].replication.antithetic ? ", with opposite luck" : "") +
                        ") failed: " + d.message;
            say_diagnostics({d});
        }
        if (failures.size() > kShown) {
            say("  and " + std::to_string(failures.size() - kShown) + " more runs failed");
        }
    }
}

int sweep(const Arguments& arguments) {
    const std::string path = arguments.text("scene");
    io::DiskFiles disk;
    const auto first = scene::load(disk, path);
    if (!first) {
        say_diagnostics(first.error());
        return kBadInput;
    }
    auto request = parse_request(arguments, first->frame_rate);
    if (!request) {
        say_error(request.error());
        return kBadInput;
    }
    sim::Plan& plan = request->plan;
    SweepResult result;
    result.title = first->title;
    result.scene = path;
    result.seed = static_cast<std::uint64_t>(
        arguments.integer("--seed", static_cast<std::int64_t>(first->seed)));
    result.level = plan.level;
    plan.seed = result.seed;
    std::vector<scene::Scene> scenes;
    Diagnostics growing;
    for (const std::vector<scene::Setting>& settings : grid(request->varied)) {
        auto scene = load_point(path, settings);
        if (!scene) {
            say_diagnostics(scene.error());
            return kBadInput;
        }
        for (const Diagnostic& d : scene->notes) {
            const bool told = std::any_of(growing.begin(), growing.end(), [&](const Diagnostic& g) {
                return g.where == d.where && g.message == d.message;
            });
            if (d.code == "grows-without-bound" && !told) {
                growing.push_back(d);
            }
        }
        scenes.push_back(std::move(*scene));
        result.points.push_back({settings, {}});
    }
    if (!request->until && !request->firings && !scenes.front().horizon.given()) {
        for (Diagnostic& d : growing) {  // what would be asked for is a steady state
            d.severity = Severity::kError;
        }
    }
    say_diagnostics(growing);
    // The horizon: asked for, or the scene's
    const scene::Scene& any = scenes.front();
    run::Limits limits;
    if (request->until || request->firings) {
        limits.until = request->until.value_or(SimTime::never());
        limits.firings = request->firings.value_or(limits.firings);
    } else if (any.horizon.given()) {
        limits.until = any.horizon.time.value_or(SimTime::never());
        limits.firings = any.horizon.firings.value_or(limits.firings);
    } else {
        say_error(
            "the scene does not say where a run ends: write `until 8 h` in it, or give --for");
        return kBadInput;
    }
    SimTime warm_up = request->warm_up.value_or(SimTime{0});
    if (warm_up >= limits.until) {
        say_error("the warm-up is not shorter than the run: nothing would be measured");
        return kBadInput;
    }
    if ((request->finds_warm_up || request->batches) && limits.until == SimTime::never()) {
        say_error("--warm-up auto and --batches cut runs by time: give --for a time");
        return kBadInput;
    }
    result.horizon_s = limits.until == SimTime::never() ? 0 : limits.until.seconds();
    const auto metrics_of =
        [&](const net::Net& net) -> Result<std::vector<sim::Metric>, std::string> {
        if (request->measures.empty()) {
            std::vector<sim::Metric> declared = sim::declared_metrics(net);
            return declared.empty() || arguments.given("--all") ? sim::all_metrics(net) : declared;
        }
        std::vector<sim::Metric> metrics;
        for (const std::string& text : request->measures) {
            PUP_TRY(const sim::Metric m, parse_measure(net, text));
            metrics.push_back(m);
        }
        return metrics;
    };
    std::vector<std::vector<sim::Metric>> metrics;
    for (const scene::Scene& scene : scenes) {
        auto list = metrics_of(scene.net);
        if (!list) {
            say_error(list.error());
            return kBadInput;
        }
        std::vector<MeasureName> names;
        for (const sim::Metric& m : *list) {
            names.push_back({sim::name_of(scene.net, m), sim::unit_of(scene.net, m),
                             sim::caption_of(scene.net, m)});
        }
        if (result.measures.empty()) {
            result.measures = std::move(names);
        } else if (names.size() != result.measures.size()) {
            say_error(
                "the points of the sweep have different nets: say with --measure what to "
                "compare");
            return kBadInput;
        }
        metrics.push_back(std::move(*list));
    }
    if (plan.precision.wanted()) {
        if (request->measures.empty()) {
            say_error("--until-half-width: say with --measure of what, as --measure queue.stay");
            return kBadInput;
        }
        for (std::size_t m = 0; m < result.measures.size(); ++m) {
            plan.precise.push_back(m);
        }
    }
    std::vector<PilotPoint> pilots;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        sim::NetExperiment::Options options;
        options.limits = limits;
        options.beat = scenes[i].beat;
        if (needs_stage(scenes[i])) {
            options.host = make_stage;
            options.coupled = coupled_to;
            options.context = &scenes[i];
        }
        pilots.push_back({&scenes[i].net, &metrics[i], options});
    }
    if (request->finds_warm_up) {
        auto found = find_warm_up(pilots, plan.seed, limits.until);
        if (!found) {
            say_diagnostics(found.error());
            return kFailed;
        }
        warm_up = *found;
        say("warm-up: " + number_to_text(warm_up.seconds()) +
            " s, by the marginal standard error rule");
    }
    for (PilotPoint& p : pilots) {
        p.options.warm_up = warm_up;
    }
    result.warm_up_s = warm_up.seconds();
    SimTime batch_length;
    if (request->batches) {
        std::uint32_t count = *request->batches;
        if (count == 0) {
            auto found = find_batches(pilots, plan.seed, warm_up, limits.until);
            if (!found) {
                say_diagnostics(found.error());
                return kFailed;
            }
            count = *found;
        }
        batch_length = {(limits.until.ticks - warm_up.ticks) / count};
        if (batch_length.ticks == 0) {
            say_error("the batches are shorter than a tick: make the run longer, or them fewer");
            return kBadInput;
        }
        result.batch_s = batch_length.seconds();
        plan.replications = count;
        plan.at_most = std::max<std::uint64_t>(plan.at_most, count);
        plan.threads = 1;
        say("batches: " + std::to_string(count) + " of " + number_to_text(result.batch_s) +
            " s each, of one run");
    }
    const Share share = share_of_environment();
    plan.rank = share.rank;
    plan.ranks = share.ranks;
    std::unique_ptr<SweepJournal> journal;
    std::string folder = arguments.text("--journal");
    if (folder.empty() && share.ranks > 1) {
        say_error(
            "several processes share this sweep: name a folder that all of them see with "
            "--journal");
        return kBadInput;
    }
    if (!folder.empty()) {
        auto opened = SweepJournal::open(folder, fingerprint(scenes, result, *request),
                                         scenes.size(), result.measures.size(), share);
        if (!opened) {
            say_diagnostics(opened.error());
            return kBadInput;
        }
        journal = std::move(*opened);
    }
    bool stopped = false, missing = false, precise = true, any_run = false;
    {
        Watch watch;
        watch.points = scenes.size();
        plan.go_on = Watch::go_on;
        plan.context = &watch;
        for (std::size_t i = 0; i < scenes.size() && !stopped; ++i) {
            watch.point = i;
            plan.journal = journal ? &journal->point(i) : nullptr;
            if (request->batches) {
                plan.owner = static_cast<unsigned>(i % share.ranks);
                result.points[i].outcome =
                    sim::replicate(sim::BatchExperiment(scenes[i].net, metrics[i],
                                                        pilots[i].options, batch_length, plan.seed),
                                   plan);
            } else {
                result.points[i].outcome = sim::replicate(
                    sim::NetExperiment(scenes[i].net, metrics[i], pilots[i].options), plan);
            }
            const sim::Outcome& outcome = result.points[i].outcome;
            stopped = outcome.interrupted;
            missing = missing || outcome.missing;
            precise = precise && outcome.precise_enough;
            any_run = any_run || outcome.numbers.size() > 1;
        }
    }
    if (stopped) {  // points that have not begun are left out
        std::erase_if(result.points, [](const SweepPoint& p) { return p.outcome.means.empty(); });
    }
    if (journal && journal->broken()) {
        say_error("the journal in " + folder +
                  " could not be written: what is shown is whole, but "
                  "the sweep could not be resumed");
    }
    if (missing) {
        say("share " + std::to_string(share.rank + 1) + " of " + std::to_string(share.ranks) +
            " is played; the last one tells the result");
        return kFine;
    }
    if (share.ranks > 1 && share.together && share.rank != 0) {
        return kFine;
    }
    bool good = any_run;
    if (arguments.given("--csv")) {
        const std::string csv = sweep_csv(result);
        if (arguments.text("--csv") == "-") {
            std::fwrite(csv.data(), 1, csv.size(), stdout);
        } else {
            good = write_or_say(arguments.text("--csv"), csv) && good;
        }
    }
    if (arguments.given("--html") && !result.points.empty()) {
        good = write_or_say(arguments.text("--html"), sweep_page(result)) && good;
    }
    if (arguments.given("--json")) {
        std::puts(sweep_json(result).c_str());
    } else if (arguments.text("--csv") != "-") {
        const std::string table = sweep_table(result, arguments.given("--all"));
        std::fwrite(table.data(), 1, table.size(), stdout);
    }
    tell_failures(result);
    if (!any_run) {
        say_error("no run came to its end: there is nothing to tell");
    }
    if (!precise) {
        say("note: --at-most " + std::to_string(plan.at_most) +
            " came before the precision was reached");
    }
    if (stopped) {
        say(folder.empty() ? "stopped: what is shown is what was played; with --journal FOLDER it "
                             "could go on"
                           : "stopped: the same command goes on where it was");
        good = false;
    }
    return good ? kFine : kFailed;
}

}  // namespace

Command sweep_command() {
    return {
        "sweep",
        "many runs with other luck and other parameters: means and confidence intervals",
        "Plays the scene again and again, on all cores. Every element has a random stream of its "
        "own, so that\n"
        "run k has the same luck at every point of the sweep (common random numbers), and a new "
        "queue changes\n"
        "nobody else's customers. The numbers do not depend on how many cores or processes there "
        "are.\n\n"
        "Measures:  PLACE.tokens  mean number of tokens over time     PLACE.stay  mean time that "
        "tokens stay\n"
        "           PLACE.most    the largest number                  PLACE.busy  share of the "
        "time "
        "with a token\n"
        "           TRANSITION.rate  firings per second               TRANSITION.firings\n"
        "           or what the scene declares (`measure wait mean of time in queue`), which is "
        "all "
        "that is shown then\n\n"
        "Parameters: a.out is the argument `out` of `use ... as a`; a datum; PLACE.takes; "
        "PLACE.tokens.\n\n"
        "With --until-half-width more runs are made, in stages, until the interval of every "
        "--measure is that\n"
        "narrow; the interval stays valid although the data decide when to stop.\n\n"
        "Under mpirun, and in Slurm jobs and arrays, each process plays its share; --journal names "
        "a folder that\n"
        "all of them see.\n\n"
        "Examples:\n"
        "  puppetri sweep shop.pup --replications 1000\n"
        "  puppetri sweep shop.pup --vary 'shop.barbers=1..3' --measure queue.stay --html "
        "out.html\n"
        "  puppetri sweep shop.pup --vary 'shop.arrival=10 s .. 30 s by 5 s' --vary "
        "'chair.takes=20 s, exponential(20 s)'\n"
        "  puppetri sweep shop.pup --measure queue.stay --until-half-width 1% --warm-up 3600s\n"
        "  puppetri sweep shop.pup --for 1000h --batches auto --warm-up auto\n"
        "  mpirun -n 8 puppetri sweep shop.pup --journal sweep.journal --csv out.csv",
        {{"scene", Value::kText, "SCENE", "a .pup file with a scene", true},
         {"--vary", Value::kTexts, "PARAMETER=VALUES",
          "2..6, `5 s .. 20 s by 5 s`, or a list `1, 2, 5`; several: all combinations", false},
         {"--replications", Value::kInteger, "N",
          "runs per point (100); with --until-half-width, of the first stage", false},
         {"--until-half-width", Value::kText, "W", "1% of the mean, or 0.5 in the measure's unit",
          false},
         {"--at-most", Value::kInteger, "N", "runs per point in all (1000000)", false},
         {"--measure", Value::kTexts, "MEASURE", "what to measure; without: everything", false},
         {"--level", Value::kText, "P", "of the confidence intervals (95%)", false},
         {"--warm-up", Value::kText, "T",
          "leave out what happens before; auto: until the measures have settled", false},
         {"--batches", Value::kText, "N",
          "one long run, cut into so many stretches, instead of replications; auto: as many as do "
          "not depend on each other",
          false},
         {"--for", Value::kText, "HOW LONG", "instead of the scene's horizon: 8h, 960f, 1000x",
          false},
         {"--seed", Value::kInteger, "N", "instead of the scene's seed", false},
         {"--antithetic", Value::kFlag, "",
          "runs in pairs of opposite luck: narrower intervals where measures follow luck", false},
         {"--threads", Value::kInteger, "N", "cores to use (all)", false},
         {"--journal", Value::kText, "FOLDER",
          "keep every run there: a killed sweep goes on, processes share", false},
         {"--csv", Value::kText, "FILE", "the table as CSV; - for stdout", false},
         {"--html", Value::kText, "FILE", "one page with plots, for a browser", false},
         {"--all", Value::kFlag, "",
          "every measure of every place and transition, also those that are 0 in every run", false},
         {"--json", Value::kFlag, "", "everything as JSON on stdout", false}},
        sweep};
}

}  // namespace puppetri::cli
