// SPDX-License-Identifier: MIT
// Pulse processes against their closed form: P(t) = P(0) A^t, V(t) = V(start) + P(0) (1 + A + ... +
// A^t), in whole numbers.
#include "playing.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/random.h"

namespace puppetri::notation {
namespace {

using Row = std::vector<std::int64_t>;

Row times(const Row& p, const std::vector<Row>& a) {
    Row out(p.size(), 0);
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = 0; j < p.size(); ++j) {
            out[j] += p[i] * a[i][j];
        }
    }
    return out;
}

TEST_CASE("random pulse processes have the values of the matrix power [oracle]") {
    RandomStream random(stream_key(3, "pulses", "test"));
    const auto pick = [&](int n) { return static_cast<std::int64_t>(random.bits() % unsigned(n)); };
    for (int round = 0; round < 60; ++round) {
        const auto n = static_cast<std::size_t>(1 + pick(6));
        const bool whole = pick(2) == 1;
        std::vector<Row> a(n, Row(n, 0));
        Row start(n, 0), first(n, 0);
        std::string text = "use p as x\npulses p {\n every 0.5 s\n";
        for (std::size_t i = 0; i < n; ++i) {
            start[i] = pick(9) - 4;
            first[i] = pick(5) - 2;
            text += " v" + std::to_string(i) + " starts " + std::to_string(start[i]) + " pulse " +
                    std::to_string(first[i]) + (whole ? " whole -10000000 .. 10000000" : "") + "\n";
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                a[i][j] = pick(3) == 0 ? pick(5) - 2 : 0;
                if (a[i][j] != 0) {
                    text += " v" + std::to_string(i) + " -> v" + std::to_string(j) + ": " +
                            std::to_string(a[i][j]) + "\n";
                }
            }
        }
        text += "}\n";
        const scene::Scene scene = from_text(text);
        run::Player player(scene.net);
        Row power = first, value = start;
        for (int t = 0; t <= 8; ++t) {
            player.run({.until = {t * (kTicksPerSecond / 2)}});
            for (std::size_t i = 0; i < n; ++i) {
                value[i] += power[i];
                const std::string name = "x.v" + std::to_string(i);
                const Value v = player.datum(scene.net.find_datum(name));
                const Value p = player.datum(scene.net.find_datum(name + "_pulse"));
                CHECK((whole ? static_cast<double>(v) : real_of_value(v)) ==
                      static_cast<double>(value[i]));
                CHECK((whole ? static_cast<double>(p) : real_of_value(p)) ==
                      static_cast<double>(power[i]));
            }
            power = times(power, a);
        }
    }
}

TEST_CASE("a pulse from outside enters with the next step [unit]") {
    const scene::Scene scene = from_text(R"(use p(push) as x
event push at 1.5 s, 1.6 s
pulses p(push: event) {
  every 1 s
  a whole -100 .. 100
  b whole -100 .. 100
  a -> b: -1
  a gets 3 on push
  b gets 10 at 0.5 s
}
)");
    run::Player player(scene.net);
    const auto at = [&](int seconds) {
        player.run({.until = {seconds * kTicksPerSecond}});
        return std::pair(player.datum(scene.net.find_datum("x.a")),
                         player.datum(scene.net.find_datum("x.b")));
    };
    CHECK(at(0) == std::pair<Value, Value>{0, 0});
    CHECK(at(1) == std::pair<Value, Value>{0, 10});
    CHECK(at(2) == std::pair<Value, Value>{6, 10});
    CHECK(at(3) == std::pair<Value, Value>{6, 4});
    CHECK(at(9) == std::pair<Value, Value>{6, 4});
}

std::vector<std::string> codes(const std::string& arcs) {
    std::vector<std::string> out;
    for (const Diagnostic& d :
         defects_of("use p as x\npulses p {\n every 1 s\n a pulse 1\n b\n c\n" + arcs + "}\n")) {
        CHECK_FALSE(d.remedy.empty());
        out.push_back(d.code);
    }
    return out;
}

TEST_CASE("growth without bound is warned of, by the eigenvalues of the weights [law]") {
    using Codes = std::vector<std::string>;
    CHECK(codes(" a -> b: 2\n b -> c: 3\n") == Codes{});           // no ring: all eigenvalues are 0
    CHECK(codes(" a -> b: 1\n b -> a: 1.1\n") == Codes{"grows"});  // sqrt(1.1)
    CHECK(codes(" a -> b: 1\n b -> a: -1.1\n") == Codes{"grows"});     // i sqrt(1.1)
    CHECK(codes(" a -> b: 0.9\n b -> a: 1.1\n") == Codes{});           // sqrt(0.99)
    CHECK(codes(" a -> b: 1\n b -> a: 1\n") == Codes{"grows"});        // 1: values
    CHECK(codes(" a -> b: 1\n b -> a: -1\n") == Codes{});              // i: they come back
    CHECK(codes(" a -> b: 1\n b -> c: 1\n c -> a: -1\n") == Codes{});  // sixth roots of 1
    CHECK(codes(" a -> a: 1.000001\n") == Codes{"grows"});
    CHECK(codes(" a -> d: 1\n") == Codes{"unknown-name"});
    CHECK(codes(" a -> b 1\n") == Codes{"syntax"});
}

}  // namespace
}  // namespace puppetri::notation
