// SPDX-License-Identifier: MIT
// Queue blocks against closed forms: solved as Markov chains and by their product form to the last
// digits, simulated within confidence intervals. PUPPETRI_LONG=1 simulates 25 times as much.
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "playing.h"
#include "puppetri/proof/markov_net.h"
#include "puppetri/sim/net_experiment.h"
#include "puppetri/sim/solved_queues.h"

namespace puppetri::notation {
namespace {

std::string shop(const std::string& lines, const std::string& before = "") {
    return "until 1 h\n" + before + "use shop\nqueue shop {\n" + lines + "}\n";
}

// A place's mean number of tokens in the long run, by the Markov chain.
class Chain {
 public:
    explicit Chain(const std::string& body)
        : scene_(from_text(body)), markov_(proof::markov_net({scene_.net, {}, {}, 0, 1, budget_})) {
        for (const std::string& why : markov_.why_not) {
            FAIL(why);
        }
        REQUIRE(markov_.graph.graph.ended == proof::Ended::kDone);
        const proof::ChainSolution s = proof::long_run(markov_.chain);
        REQUIRE(s.residual < 1e-9);
        shares_ = s.values;
    }
    double tokens(const std::string& place) const {
        const net::PlaceIndex p = scene_.net.find_place("shop." + place);
        REQUIRE(p.valid());
        return markov_.mean_tokens(shares_, p);
    }
    double rate(const std::string& transition) const {
        const net::TransitionIndex t = scene_.net.find_transition("shop." + transition);
        REQUIRE(t.valid());
        return markov_.rate(shares_, t);
    }

 private:
    proof::Budget budget_{.seconds = 60};
    scene::Scene scene_;
    proof::MarkovNet markov_;
    std::vector<double> shares_;
};

// Birth and death: the mean of f(n) in the long run.
double birth_death(int most, const std::function<double(int)>& birth,
                   const std::function<double(int)>& death, const std::function<double(int)>& f) {
    double p = 1, sum = 0, mean = 0;
    for (int n = 0; n <= most; ++n) {
        sum += p;
        mean += p * f(n);
        p *= n < most ? birth(n) / death(n + 1) : 0;
    }
    return mean / sum;
}

double product_form(const std::string& body, const std::string& element, sim::MetricKind kind) {
    const scene::Scene scene = from_text(body);
    const auto solved = sim::solve_queues(scene.draft);
    if (!solved) {
        FAIL(told(solved.error()));
    }
    CHECK(solved->residual < 1e-9);
    const std::string path = "shop." + element;
    std::uint32_t number = 0;
    if (sim::of_transition(kind)) {
        while (scene.draft.transitions.at(number).path != path) {
            ++number;
        }
    } else {
        while (scene.draft.places.at(number).path != path) {
            ++number;
        }
    }
    const auto value = solved->value({kind, number});
    REQUIRE(value.has_value());
    return *value;
}

// The mean of a measure over independent runs; must cover the truth, give or take, and be precise.
void simulated(const std::string& body, const std::string& element, sim::MetricKind kind,
               double truth, double hours = 40, double precision = 0.03) {
    const scene::Scene scene = from_text(body);
    const std::string path = "shop." + element;
    const std::uint32_t number = sim::of_transition(kind) ? scene.net.find_transition(path).value
                                                          : scene.net.find_place(path).value;
    const bool longer = std::getenv("PUPPETRI_LONG") != nullptr;
    const double run_s = hours * 3600 * (longer ? 25 : 1);
    const auto ticks = [](double s) {
        return SimTime{static_cast<std::int64_t>(s * static_cast<double>(kTicksPerSecond))};
    };
    sim::NetExperiment::Options options;
    options.limits.until = ticks(run_s);
    options.warm_up = ticks(run_s / 20);
    const sim::NetExperiment experiment(scene.net, {{kind, number}}, options);
    const sim::Outcome out = sim::replicate(experiment, {.seed = 3, .replications = 20});
    REQUIRE(out.failures.empty());
    const sim::Confidence c = out.means.at(0);
    INFO(body, path, ": ", c.mean, " +- ", c.half_width, ", truth ", truth);
    CHECK(std::abs(c.mean - truth) < 2 * c.half_width);
    CHECK(c.half_width < precision * (longer ? 0.3 : 1) * truth);
}

constexpr auto kTokens = sim::MetricKind::kTokens;
constexpr auto kStay = sim::MetricKind::kStay;
constexpr auto kRate = sim::MetricKind::kRate;

const char* kOpen = "  sink home\n  door -> chair\n  chair -> home\n";

TEST_CASE("M/M/1/K, M/M/c/K and Erlang's B, solved [oracle]") {
    struct Case {
        int servers, room;
        double comes, serves;
    };
    for (const Case& c :
         {Case{1, 4, 10, 7}, Case{1, 6, 5, 9}, Case{3, 3, 4, 10}, Case{2, 7, 6, 8}}) {
        const Chain chain(shop("  source door every exponential(" + std::to_string(c.comes) +
                               " s)\n  station chair serves exponential(" +
                               std::to_string(c.serves) + " s) servers " +
                               std::to_string(c.servers) + " room " + std::to_string(c.room) +
                               " lost\n  inside here\n" + kOpen));
        const auto birth = [&](int) { return 1 / c.comes; };
        const auto death = [&](int n) { return std::min(n, c.servers) / c.serves; };
        const double mean = birth_death(c.room, birth, death, [](int n) { return n; });
        const double full =
            birth_death(c.room, birth, death, [&](int n) { return n == c.room ? 1 : 0; });
        CHECK(chain.tokens("here") == doctest::Approx(mean).epsilon(1e-9));
        CHECK(chain.rate("door_to_chair_full") == doctest::Approx(full / c.comes).epsilon(1e-9));
        CHECK(chain.rate("chair_to_home") == doctest::Approx((1 - full) / c.comes).epsilon(1e-9));
    }
    // Erlang's B by its recursion: 3 servers, 2.5 offered.
    double b = 1;
    for (int k = 1; k <= 3; ++k) {
        b = 2.5 * b / (k + 2.5 * b);
    }
    const Chain erlang(
        shop("  source door every exponential(4 s)\n  station chair serves "
             "exponential(10 s) servers 3 room 3 lost\n" +
             std::string(kOpen)));
    CHECK(erlang.rate("door_to_chair_full") == doctest::Approx(b / 4).epsilon(1e-9));
}

TEST_CASE("impatience (Erlang's A) and balking, solved [oracle]") {
    const auto birth = [](int) { return 1 / 5.0; };
    const auto death = [](int n) { return std::min(n, 2) / 9.0 + std::max(0, n - 2) / 20.0; };
    const int most = 9;
    const Chain chain(
        shop("  source door every exponential(5 s)\n  station chair serves exponential(9 s) "
             "servers 2 patience exponential(20 s) room 9 lost\n  inside here\n" +
             std::string(kOpen)));
    CHECK(chain.tokens("here") ==
          doctest::Approx(birth_death(most, birth, death, [](int n) { return n; })).epsilon(1e-9));
    const double gone =
        birth_death(most, birth, death, [](int n) { return std::max(0, n - 2) / 20.0; });
    CHECK(chain.rate("chair_gives_up") == doctest::Approx(gone).epsilon(1e-9));

    // Half of those go away who find three waiting or more; none come in to more than six.
    const Chain balking(
        shop("  source door every exponential(5 s)\n  station chair serves exponential(9 s) room "
             "7 lost balks (#chair_queue >= 3 ? 0.5 : 0)\n  inside here\n" +
             std::string(kOpen)));
    const auto comes_in = [](int n) { return (n - 1 >= 3 ? 0.5 : 1) / 5.0; };
    const auto served = [](int) { return 1 / 9.0; };
    CHECK(balking.tokens("here") ==
          doctest::Approx(birth_death(7, comes_in, served, [](int n) { return n; })).epsilon(1e-9));
}

TEST_CASE("M/M/1, M/M/c and Jackson's networks by their product form [oracle]") {
    const std::string one = shop(
        "  source door every exponential(10 s)\n  station chair serves "
        "exponential(8 s)\n  inside here\n" +
        std::string(kOpen));
    CHECK(product_form(one, "here", kTokens) == doctest::Approx(4).epsilon(1e-12));
    CHECK(product_form(one, "here", kStay) == doctest::Approx(40).epsilon(1e-12));
    CHECK(product_form(one, "chair_queue", kStay) == doctest::Approx(32).epsilon(1e-12));
    CHECK(product_form(one, "chair_to_home", kRate) == doctest::Approx(0.1).epsilon(1e-12));
    // Erlang's C: 2 servers, offered a = 1.5; C = 9/14, waiting C/(2 - a) of a service.
    const std::string two = shop(
        "  source door every exponential(10 s)\n  station chair serves "
        "exponential(15 s) servers 2\n" +
        std::string(kOpen));
    CHECK(product_form(two, "chair_queue", kStay) ==
          doctest::Approx(9.0 / 14 * 15 / 0.5).epsilon(1e-12));
    // Feedback: a quarter comes again, so that 2/15 per second come to the first.
    const std::string jackson = shop(
        "  source door every exponential(10 s)\n  station a serves exponential(6 s)\n  station b "
        "servers 3 serves exponential(20 s)\n  delay rest takes 5 s\n  sink home\n  door -> a\n"
        "  a -> b probability 0.5\n  a -> home probability 0.25\n  a -> rest\n  rest -> a\n  b -> "
        "home\n");
    const double x = 0.1 / 0.75;
    CHECK(product_form(jackson, "a_start", kRate) == doctest::Approx(x).epsilon(1e-12));
    CHECK(product_form(jackson, "a_queue", kTokens) ==
          doctest::Approx(x * 6 * x * 6 / (1 - x * 6)).epsilon(1e-12));
    CHECK(product_form(jackson, "rest", kTokens) == doctest::Approx(x / 4 * 5).epsilon(1e-12));
}

TEST_CASE("closed networks: product form and Markov chain agree with birth and death [oracle]") {
    const std::string lines =
        "  delay thinks takes exponential(30 s) customers 6\n  station cpu servers 2 serves "
        "exponential(12 s)\n  thinks -> cpu\n  cpu -> thinks\n";
    const auto birth = [](int n) { return (6 - n) / 30.0; };
    const auto death = [](int n) { return std::min(n, 2) / 12.0; };
    const double at_cpu = birth_death(6, birth, death, [](int n) { return n; });
    const double rate = birth_death(6, birth, death, death);
    const Chain chain(shop(lines));
    CHECK(chain.tokens("cpu") + chain.tokens("cpu_queue") == doctest::Approx(at_cpu).epsilon(1e-9));
    CHECK(chain.rate("cpu_start") == doctest::Approx(rate).epsilon(1e-9));
    CHECK(product_form(shop(lines), "thinks", kTokens) ==
          doctest::Approx(6 - at_cpu).epsilon(1e-9));
    CHECK(product_form(shop(lines), "cpu_to_thinks", kRate) == doctest::Approx(rate).epsilon(1e-9));
    // Three stations with routing: the chain is the judge of the product form.
    const std::string three =
        "  station a serves exponential(3 s) customers 5\n  station b servers 2 serves "
        "exponential(8 s)\n  delay c takes exponential(10 s)\n  a -> b probability 0.6\n  a -> c\n"
        "  b -> a probability 0.7\n  b -> c\n  c -> a\n";
    const Chain judge(shop(three));
    CHECK(judge.tokens("a") + judge.tokens("a_queue") ==
          doctest::Approx(product_form(shop(three), "a", kTokens) +
                          product_form(shop(three), "a_queue", kTokens))
              .epsilon(1e-9));
    CHECK(judge.rate("b_start") ==
          doctest::Approx(product_form(shop(three), "b_start", kRate)).epsilon(1e-9));
}

TEST_CASE("M/D/1, M/G/1 and M/M/c, simulated [oracle]") {
    const auto block = [](const std::string& law, const std::string& more = "") {
        return shop("  source door every exponential(10 s)\n  station chair serves " + law + more +
                    "\n" + kOpen);
    };
    // Pollaczek and Khinchine: waiting = rho (1 + c^2) / (1 - rho) / 2 services.
    simulated(block("6 s"), "chair_queue", kStay, 0.6 / 0.4 / 2 * 6);
    simulated(block("exponential(6 s)"), "chair_queue", kStay, 9);
    simulated(block("erlang(3, 6 s)"), "chair_queue", kStay, 0.6 * (1 + 1.0 / 3) / 0.4 / 2 * 6);
    simulated(block("2 .. 10 s"), "chair_queue", kStay, 0.6 * (1 + 16.0 / 3 / 36) / 0.4 / 2 * 6);
    simulated(block("exponential(15 s)", " servers 2"), "chair_queue", kStay, 9.0 / 14 * 15 / 0.5,
              80, 0.05);
    simulated(block("exponential(6 s)", " servers 2 order lifo"), "chair", kTokens, 0.6, 40, 0.02);
}

TEST_CASE("priorities with preemption, simulated [oracle]") {
    // Two classes, exponential services: W_1 = S_1/(1 - r_1), and for the second
    // S_2/(1 - r_1) + (r_1 S_1 + r_2 S_2)/((1 - r_1)(1 - r_1 - r_2)) (Cobham's formula with
    // preemptive resume; White and Christie 1958).
    const double s1 = 4, s2 = 6, r1 = 0.2, r2 = 0.4;
    const double w1 = s1 / (1 - r1);
    const double w2 = s2 / (1 - r1) + (r1 * s1 + r2 * s2) / ((1 - r1) * (1 - r1 - r2));
    const std::string body = shop(
        "  customer Client(rank: 0 .. 1 = 0)\n  source vips every exponential(20 s)\n  source "
        "all every exponential(15 s)\n  station chair serves exponential(rank = 1 ? 4 s : 6 s) "
        "order most rank preempts\n  sink home\n  inside here\n  vips -> chair { rank := 1 }\n"
        "  all -> chair\n  chair -> home\n");
    simulated(body, "here", kTokens, w1 / 20 + w2 / 15, 60);
    // Last come, first served with preemption is M/M/1 whatever the law: L = rho/(1 - rho).
    const std::string lifo = shop(
        "  source door every exponential(10 s)\n  station chair serves erlang(2, 6 s) order lifo "
        "preempts\n  inside here\n" +
        std::string(kOpen));
    simulated(lifo, "here", kTokens, 1.5, 60);
}

TEST_CASE("failures and repairs, against the equations of the two phases [oracle]") {
    // States (customers, up or down), solved by Gauss and Seidel on 80 customers at most.
    const double l = 1 / 20.0, m = 1 / 8.0, f = 1 / 60.0, r = 1 / 15.0;
    const int most = 80;
    std::vector<double> up(most + 1, 1), down(most + 1, 1);
    for (int round = 0; round < 6000; ++round) {
        double sum = 0;
        for (int n = 0; n <= most; ++n) {
            const auto at = [&](const std::vector<double>& p, int k) {
                return k < 0 || k > most ? 0 : p[static_cast<std::size_t>(k)];
            };
            const double in = n < most ? l : 0;
            up[static_cast<std::size_t>(n)] =
                (at(up, n - 1) * l + at(up, n + 1) * m + at(down, n) * r) /
                (in + (n > 0 ? m : 0) + f);
            down[static_cast<std::size_t>(n)] = (at(down, n - 1) * l + at(up, n) * f) / (in + r);
            sum += up[static_cast<std::size_t>(n)] + down[static_cast<std::size_t>(n)];
        }
        for (int n = 0; n <= most; ++n) {
            up[static_cast<std::size_t>(n)] /= sum;
            down[static_cast<std::size_t>(n)] /= sum;
        }
    }
    double mean = 0;
    for (int n = 0; n <= most; ++n) {
        mean += n * (up[static_cast<std::size_t>(n)] + down[static_cast<std::size_t>(n)]);
    }
    simulated(shop("  source door every exponential(20 s)\n  station chair serves exponential(8 "
                   "s) fails exponential(60 s) repairs exponential(15 s)\n  inside here\n" +
                   std::string(kOpen)),
              "here", kTokens, mean, 100);
}

TEST_CASE("a queue that grows without bound is told [unit]") {
    const auto codes = [](const std::string& lines) {
        std::vector<std::string> out;
        for (const Diagnostic& d : defects_of(shop(lines))) {
            CHECK_FALSE(d.remedy.empty());
            CHECK(d.where.line == 7);
            out.push_back(d.code);
        }
        return out;
    };
    const std::vector<std::string> grows = {"grows-without-bound"}, fine;
    const std::string end = kOpen;
    CHECK(codes("  source door every 10 s\n  station chair serves 20 s\n" + end) == grows);
    CHECK(codes("  source door every 10 s\n  station chair serves 10 s\n" + end) == fine);
    CHECK(codes("  source door every 10 s\n  station chair serves exponential(10 s)\n" + end) ==
          grows);
    CHECK(codes("  source door every exponential(10 s)\n  station chair serves 10 s\n" + end) ==
          grows);
    CHECK(codes("  source door every 10 s\n  station chair serves 20 s servers 3\n" + end) == fine);
    CHECK(codes("  source door every 10 s\n  station chair serves 20 s room 5 lost\n" + end) ==
          fine);
    CHECK(codes("  source door every 10 s batch 3\n  station chair serves 4 s\n" + end) == grows);
    CHECK(codes("  source door every 10 s first 0 s\n  station chair serves 12 s\n" + end) ==
          grows);
    CHECK(codes("  source door every 10 s\n  station chair serves 12 s order lifo preempts\n" +
                end) == grows);
    CHECK(codes("  source door every 10 s\n  station chair serves 12 s patience 30 s\n" + end) ==
          fine);
    // Feedback: each customer comes five times in the mean.
    CHECK(codes("  source door every 10 s\n  station chair serves 3 s\n  sink home\n  door -> "
                "chair\n  chair -> home probability 0.2\n  chair -> chair\n") == grows);
    // The second station is fed by what the first can do, not by what comes to it.
    CHECK(codes("  source door every 10 s\n  station a serves 20 s\n  station b serves 19 s\n  "
                "sink home\n  door -> a\n  a -> b\n  b -> home\n") == grows);
}

}  // namespace
}  // namespace puppetri::notation
