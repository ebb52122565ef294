// SPDX-License-Identifier: MIT
// One station against an event list of its own, event for event; routing, blocking, failures and
// the rest by hand-made cases.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "playing.h"
#include "puppetri/base/random.h"
#include "puppetri/notation/notation.h"

namespace puppetri::notation {
namespace {

std::string read_text(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    REQUIRE(in.good());
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Client {
    int comes = 0, work = 1, patient = 0, rank = 0;
};

struct Rules {
    int servers = 1, room = 0;   // room 0: endless
    std::string order = "fifo";  // fifo, lifo, least, most
    bool preempts = false, patience = false;
};

// A station, simulated by looking at all that may come next. At one instant services begin before
// anything else, then services end, then customers come, then they give up.
std::vector<std::string> by_event_list(const std::vector<Client>& clients, const Rules& rules) {
    struct Waiting {
        std::size_t who;
        int left, since, cut;
    };
    struct Served {
        std::size_t who;
        int ends, number;
    };
    std::vector<std::string> log;
    std::vector<Waiting> line;
    std::vector<Served> busy;
    std::vector<std::size_t> to_come;
    for (std::size_t i = 0; i < clients.size(); ++i) {
        to_come.push_back(i);
    }
    std::stable_sort(to_come.begin(), to_come.end(), [&](std::size_t a, std::size_t b) {
        return clients[a].comes < clients[b].comes;
    });
    std::reverse(to_come.begin(), to_come.end());
    int now = 0, steps = 0;
    const auto say = [&](const char* what) { log.push_back(std::to_string(now) + " s " + what); };
    const auto rank = [&](std::size_t who) {  // higher goes before lower
        return rules.order == "most"    ? clients[who].rank
               : rules.order == "least" ? -clients[who].rank
                                        : 0;
    };
    const auto next_in_line = [&] {
        return std::min_element(line.begin(), line.end(), [&](const Waiting& a, const Waiting& b) {
            if (rank(a.who) != rank(b.who)) {
                return rank(a.who) > rank(b.who);
            }
            if (rules.order == "lifo") {
                return a.since > b.since;
            }
            return a.cut != b.cut ? a.cut > b.cut : a.since < b.since;
        });
    };
    const auto begin = [&](std::vector<Waiting>::iterator next) {
        busy.push_back({next->who, now + next->left, ++steps});
        line.erase(next);
    };
    for (;;) {
        const auto next = next_in_line();
        if (next != line.end() && busy.size() < static_cast<std::size_t>(rules.servers)) {
            begin(next);
            say("start");
            continue;
        }
        if (next != line.end() && rules.preempts) {
            const auto worst =
                std::min_element(busy.begin(), busy.end(), [&](const Served& a, const Served& b) {
                    return rank(a.who) != rank(b.who) ? rank(a.who) < rank(b.who)
                           : a.ends != b.ends         ? a.ends < b.ends
                                                      : a.number < b.number;
                });
            const auto who = rules.order == "lifo"
                                 ? std::find_if(line.begin(), line.end(),
                                                [](const Waiting& w) { return w.cut == 0; })
                                 : next;
            if (who != line.end() && (rules.order == "lifo" || rank(who->who) > rank(worst->who))) {
                const Waiting back{worst->who, worst->ends - now, ++steps, 1};
                busy.erase(worst);
                begin(who);
                line.push_back(back);
                say("interrupts");
                continue;
            }
        }
        const auto ends =
            std::min_element(busy.begin(), busy.end(),
                             [](const Served& a, const Served& b) { return a.ends < b.ends; });
        if (ends != busy.end() && ends->ends <= now) {
            busy.erase(ends);
            say("end");
            continue;
        }
        if (!to_come.empty() && clients[to_come.back()].comes <= now) {
            const std::size_t who = to_come.back();
            to_come.pop_back();
            if (rules.room != 0 &&
                line.size() + busy.size() >= static_cast<std::size_t>(rules.room)) {
                say("full");
                continue;
            }
            line.push_back({who, clients[who].work, ++steps, 0});
            say("comes");
            continue;
        }
        const auto patience_of = [&](const Waiting& w) {
            return rules.patience ? clients[w.who].comes + clients[w.who].patient
                                  : std::numeric_limits<int>::max();
        };
        const auto gone = std::min_element(
            line.begin(), line.end(),
            [&](const Waiting& a, const Waiting& b) { return patience_of(a) < patience_of(b); });
        if (gone != line.end() && patience_of(*gone) <= now) {
            line.erase(gone);
            say("gives up");
            continue;
        }
        int then = std::numeric_limits<int>::max();
        if (!to_come.empty()) {
            then = std::min(then, clients[to_come.back()].comes);
        }
        if (ends != busy.end()) {
            then = std::min(then, ends->ends);
        }
        if (gone != line.end()) {
            then = std::min(then, patience_of(*gone));
        }
        if (then == std::numeric_limits<int>::max()) {
            return log;
        }
        now = then;
    }
}

// The same as a block: who comes is on the way there, as long as his attribute says.
std::string as_block(const std::vector<Client>& clients, const Rules& rules) {
    std::string text =
        "until 100000 s\nuse shop\nqueue shop {\n  customer Client(comes: time, work: time, "
        "patient: time, rank: 0 .. 9)\n  delay street takes comes";
    for (const Client& c : clients) {
        text += " customers 1 (comes = " + std::to_string(c.comes) +
                " s, work = " + std::to_string(c.work) +
                " s, patient = " + std::to_string(c.patient) +
                " s, rank = " + std::to_string(c.rank) + ")";
    }
    text += "\n  station chair serves work servers " + std::to_string(rules.servers) + " order " +
            rules.order;
    text += rules.order == "least" || rules.order == "most" ? " rank" : "";
    text += rules.preempts ? " preempts" : "";
    text += rules.patience ? " patience patient" : "";
    text += rules.room != 0 ? " room " + std::to_string(rules.room) + " lost" : "";
    return text + "\n  sink home\n  street -> chair\n  chair -> home\n}\n";
}

std::vector<std::string> in_words(const std::vector<std::string>& log) {
    const std::pair<const char*, const char*> words[] = {
        {"shop.chair_start", "start"},         {"shop.chair_interrupts", "interrupts"},
        {"shop.chair_to_home", "end"},         {"shop.street_to_chair", "comes"},
        {"shop.street_to_chair_full", "full"}, {"shop.chair_gives_up", "gives up"}};
    std::vector<std::string> out;
    for (const std::string& line : log) {
        const std::size_t at = line.find(" s ") + 3;
        for (const auto& [path, word] : words) {
            if (line.substr(at) == path) {
                out.push_back(line.substr(0, at) + word);
            }
        }
        if (line.find("fault") != std::string::npos) {
            out.push_back(line);
        }
    }
    return out;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += line + "\n";
    }
    return text;
}

TEST_CASE("one station does what an event list does, in every order [oracle]") {
    RandomStream random{stream_key(11, "clients", "test"), 0};
    const auto below = [&](int n) {
        return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
    };
    int cases = 0, interrupted = 0, lost = 0, given_up = 0;
    for (const char* order : {"fifo", "lifo", "least", "most"}) {
        for (int servers = 1; servers <= 3; ++servers) {
            for (int variant = 0; variant < 5; ++variant) {
                for (int again = 0; again < 12; ++again) {
                    Rules rules{.servers = servers, .order = order};
                    rules.preempts = variant == 1 && rules.order != "fifo";
                    rules.patience = variant == 2 || variant == 4;
                    rules.room = variant >= 3 ? servers + below(3) : 0;
                    std::vector<Client> clients(static_cast<std::size_t>(3 + below(14)));
                    for (Client& c : clients) {
                        c = {below(30), 1 + below(12), 1 + below(15), below(4)};
                    }
                    const std::string text = as_block(clients, rules);
                    const auto wanted = by_event_list(clients, rules);
                    const auto got = in_words(log_of(text, 10000));
                    if (got != wanted) {
                        FAIL(text << joined(wanted) << "but the block says\n" << joined(got));
                    }
                    ++cases;
                    for (const std::string& line : wanted) {
                        interrupted += line.find("interrupts") != std::string::npos ? 1 : 0;
                        lost += line.find("full") != std::string::npos ? 1 : 0;
                        given_up += line.find("gives") != std::string::npos ? 1 : 0;
                    }
                }
            }
        }
    }
    CHECK(cases == 720);
    CHECK(interrupted > 100);
    CHECK(lost > 100);
    CHECK(given_up > 100);
}

// Lines of the log that speak of one of these transitions of `shop`.
std::vector<std::string> only(const std::string& body, std::vector<std::string> names,
                              double seconds) {
    std::vector<std::string> out;
    for (const std::string& line :
         log_of("until 1000 s\nuse shop\nqueue shop {\n" + body + "}\n", seconds)) {
        const std::size_t at = line.find(" s shop.");
        const std::string name = at == std::string::npos ? line : line.substr(at + 8);
        if (at == std::string::npos || std::find(names.begin(), names.end(), name) != names.end()) {
            out.push_back(at == std::string::npos ? line : line.substr(0, at) + " " + name);
        }
    }
    return out;
}

using Lines = std::vector<std::string>;

TEST_CASE("who has no room at the next station keeps his server [oracle]") {
    // D1(n) = max(max(A(n), D1(n - 1)) + S1(n), D2(n - K)), D2(n) = max(D1(n), D2(n - 1)) + S2(n)
    RandomStream random{stream_key(3, "tandem", "test"), 0};
    for (int again = 0; again < 60; ++again) {
        const std::size_t n = 4 + random.below(12);
        const std::size_t room = 1 + random.below(3);
        std::string customers;
        std::vector<int> comes(n), first(n), second(n), leaves_a(n), leaves_b(n);
        int at = 0;
        for (std::size_t i = 0; i < n; ++i) {
            comes[i] = at += static_cast<int>(random.below(6));
            first[i] = 1 + static_cast<int>(random.below(8));
            second[i] = 1 + static_cast<int>(random.below(8));
            customers += " customers 1 (comes = " + std::to_string(comes[i]) +
                         " s, one = " + std::to_string(first[i]) +
                         " s, two = " + std::to_string(second[i]) + " s)";
            const int begins = i == 0 ? comes[i] : std::max(comes[i], leaves_a[i - 1]);
            leaves_a[i] = begins + first[i];
            if (i >= room) {
                leaves_a[i] = std::max(leaves_a[i], leaves_b[i - room]);
            }
            leaves_b[i] =
                (i == 0 ? leaves_a[i] : std::max(leaves_a[i], leaves_b[i - 1])) + second[i];
        }
        const std::string body =
            "  customer Part(comes: time, one: time, two: time)\n  delay yard "
            "takes comes" +
            customers + "\n  station a serves one\n  station b serves two room " +
            std::to_string(room) + "\n  sink out\n  yard -> a\n  a -> b\n  b -> out\n";
        Lines a, b;
        for (std::size_t i = 0; i < n; ++i) {
            a.push_back(std::to_string(leaves_a[i]) + " a_to_b");
            b.push_back(std::to_string(leaves_b[i]) + " b_to_out");
        }
        INFO(body);
        CHECK(only(body, {"a_to_b"}, 1000) == a);
        CHECK(only(body, {"b_to_out"}, 1000) == b);
    }
}

TEST_CASE("a customer who waits for room has decided where to go [unit]") {
    // b is full for ever; whoever is to go there blocks the server, though c has room.
    const std::string body =
        "  source door every 1 s\n  station a serves 1 s\n  station b serves 1 h room 1\n  station "
        "c serves 1 s\n  sink out\n  door -> a\n  a -> b probability 0.5\n  a -> c\n  b -> out\n"
        "  c -> out\n";
    const Lines log = only(body, {"a_to_b", "a_picks_b", "a_picks_c"}, 900);
    Lines picks;
    for (const std::string& line : log) {
        picks.push_back(line.substr(line.find(' ') + 1));
    }
    REQUIRE(picks.size() >= 3);
    CHECK(std::count(picks.begin(), picks.end(), "a_picks_b") == 2);  // the second one waits
    CHECK(picks.back() == "a_picks_b");
}

TEST_CASE("breaks begin when a service has ended, before the next [unit]") {
    CHECK(only("  source door every 10 s first 0 s\n  station chair serves 10 s breaks every 100 "
               "s first 25 s for 30 s\n  sink out\n  door -> chair\n  chair -> out\n",
               {"chair_start", "chair_break_begins", "chair_break_ends"}, 75) ==
          Lines{"0 chair_start", "10 chair_start", "20 chair_start", "30 chair_break_begins",
                "60 chair_break_ends", "60 chair_start", "70 chair_start"});
}

TEST_CASE("periods of the day: each has its own intervals, and some are closed [unit]") {
    Lines wanted;
    for (const int t : {1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15, 20, 21}) {
        wanted.push_back(std::to_string(t) + " door_to_out");
    }
    Lines got = only(
        "  source door repeats 10 s {\n    at 0 s every 1 s\n    at 5 s closed\n    "
        "at 8 s every 2 s\n  }\n  sink out\n  door -> out\n",
        {"door_to_out", "door_to_out_2"}, 21.5);
    for (std::string& line : got) {
        line = line.substr(0, line.find("_2"));
    }
    CHECK(got == wanted);
    // Without a day: closed before the first period; and `closes` ends them all.
    CHECK(only("  source door closes 7 s {\n    at 2 s every 2 s\n  }\n  sink out\n  door -> out\n",
               {"door_to_out"}, 20) == Lines{"4 door_to_out", "6 door_to_out"});
}

TEST_CASE("batches, gathering, pools, the shortest line, jockeying [unit]") {
    CHECK(only("  source door every 4 s batch 3\n  station bus serves 5 s gathers 2\n  sink out\n"
               "  door -> bus\n  bus -> out\n",
               {"door_to_bus", "bus_start", "bus_to_out"}, 16) ==
          Lines{"4 door_to_bus", "4 bus_start", "8 door_to_bus", "9 bus_to_out", "9 bus_start",
                "12 door_to_bus", "14 bus_to_out", "14 bus_start", "16 door_to_bus"});
    CHECK(only("  pool street customers 2\n  source door every 3 s from street\n  station chair "
               "serves 7 s\n  door -> chair\n  chair -> street\n",
               {"door_to_chair", "door_nobody", "chair_to_street"},
               16) == Lines{"3 door_to_chair", "6 door_to_chair", "9 door_nobody",
                            "10 chair_to_street", "12 door_to_chair", "15 door_nobody"});
    const Lines shortest = only(
        "  source door every 1 s\n  station a serves 1 h\n  station b serves 1 h\n  sink "
        "out\n  door -> shortest(a, b)\n  a -> out\n  b -> out\n",
        {"door_to_a", "door_to_b"}, 6);
    REQUIRE(shortest.size() == 6);
    for (std::size_t i = 0; i < 6; i += 2) {
        CHECK(shortest[i].substr(2) != shortest[i + 1].substr(2));
    }
    // Five at a; two may go before the lines differ by less than two.
    CHECK(only("  station a serves 1 h customers 5\n  station b serves 1 h\n  sink out\n  a -> "
               "out\n  b -> out\n  a -> b on jockeying\n",
               {"a_jockeys_to_b"}, 10) == Lines{"0 a_jockeys_to_b", "0 a_jockeys_to_b"});
}

TEST_CASE("those turned away go where the routes say [unit]") {
    // Full: to b. There they balk at more than one, and go to c, each by chance or condition.
    CHECK(
        only("  data sent: int = 0\n  source door every 1 s\n  station a serves 1 h room 1 lost\n"
             "  station b serves 1 h balks when #b >= 1\n  station c serves 1 h patience 2 s\n"
             "  sink out\n  door -> a\n  a -> b on full\n  b -> c on balking when sent < 2 { sent "
             ":= sent + 1 }\n  b -> out on balking\n  c -> out on impatience\n  a -> out\n  b -> "
             "out\n  c -> out\n",
             {"door_to_a", "a_full_to_b", "b_balks_to_c", "b_balks_to_out", "c_gives_up_to_out"},
             6) == Lines{"1 door_to_a", "2 a_full_to_b", "3 b_balks_to_c", "4 b_balks_to_c",
                         "5 b_balks_to_out", "6 b_balks_to_out", "6 c_gives_up_to_out"});
}

TEST_CASE("failures: the customer waits at the head of the line and goes on where he was [unit]") {
    CHECK(only("  source door every 4 s first 0 s\n  station chair serves 10 s fails 7 s repairs 2 "
               "s\n  sink out\n  door -> chair\n  chair -> out\n",
               {"chair_start", "chair_fails", "chair_fails_idle", "chair_repaired", "chair_to_out"},
               21) == Lines{"0 chair_start", "7 chair_fails", "9 chair_repaired", "9 chair_start",
                            "12 chair_to_out", "12 chair_start", "16 chair_fails",
                            "18 chair_repaired", "18 chair_start"});
}

TEST_CASE("defects of a queue are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use shop
queue shop(p = 0.5, q = 0.5) {
  customer Client(rank: 0 .. 9, p: real = 0)
  source door every 10 s
  station a serves 5 s order fifo preempts
  station b serves 5 s balks 0.2 room 3
  station lonely serves 5 s
  delay c takes 5 s
  sink out
  door -> a { rank := 1 }
  a -> b probability 0.3
  a -> c probability 0.6
  b -> out probability p
  b -> a probability q
  b -> d
  c -> out on full
  lonely -> out
}
)");
    // What cannot be read is told first.
    CHECK(lines_and_codes(list, "queue shop") == LinesAndCodes{{17, "unknown-name"}});
}

TEST_CASE("defects of a queue's sense are told all at once [unit]") {
    const Diagnostics list = defects_of(R"(use shop
queue shop(p = 0.5, q = 0.5) {
  customer Client(rank: 0 .. 9, p: real = 0)
  source door every 10 s
  station a serves 5 s order fifo preempts
  station b serves 5 s balks 0.2 room 3
  station lonely serves 5 s
  delay c takes 5 s
  sink out
  door -> a { rank := 1 }
  a -> b probability 0.3
  a -> c probability 0.6
  b -> out probability p
  b -> a probability q
  c -> out on full
  lonely -> out
}
)");
    CHECK(lines_and_codes(list) == LinesAndCodes{{5, "name-twice"},
                                                 {7, "not-together"},
                                                 {8, "not-together"},
                                                 {9, "never-entered"},
                                                 {10, "wrong-routing"},
                                                 {13, "not-together"},
                                                 {14, "wrong-routing"},
                                                 {16, "wrong-routing"},
                                                 {17, "wrong-routing"}});
}

TEST_CASE("probabilities that sum to one whatever the parameters are [unit]") {
    const auto fine = [](const std::string& routes) {
        return defects_of(
                   "use shop\nqueue shop(p = 0.3) {\n  source door every 10 s\n  sink a\n  "
                   "sink b\n  sink c\n" +
                   routes + "}\n")
            .empty();
    };
    CHECK(fine("  door -> a probability p\n  door -> b probability 1 - p\n  door -> c probability "
               "0\n") == false);  // nobody comes to c
    CHECK(
        fine("  door -> a probability p/2\n  door -> b probability 1 - p\n  door -> c "
             "probability p/2\n"));
    CHECK(fine("  door -> a probability p\n  door -> b probability 30 percent\n  door -> c\n"));
    CHECK_FALSE(
        fine("  door -> a probability p\n  door -> b probability 0.3\n  door -> c "
             "probability 0.4\n"));
}

TEST_CASE("one log: the barber shop as queue, as state transitions, as event graph [oracle]") {
    // By hand: arrivals at 10, 20, ...; services of 20 from 10 on.
    Lines wanted;
    for (int t = 10; t <= 100; t += 10) {
        const std::string at = std::to_string(t) + " s shop.";
        if (t >= 30 && t % 20 == 10) {
            wanted.push_back(at + "chair_to_street");
            wanted.push_back(at + "chair_start");
        }
        wanted.push_back(at + "door_to_chair");
        if (t == 10) {
            wanted.push_back(at + "chair_start");
        }
    }
    for (const char* name : {"queue", "states", "event_graph"}) {
        scene::MemoryFiles files;
        files.add("shop.pup", read_text(PUP_SOURCE_DIR "/examples/11_barber_shop/" +
                                        std::string(name) + ".pup"));
        const auto scene = scene::load(files, "shop.pup");
        REQUIRE(scene.has_value());
        Lines log = log_of(*scene, 100);
        std::erase_if(log, [](const std::string& line) {  // edges that were looked at
            const std::string what = line.substr(line.find("shop.") + 5);
            return what != "door_to_chair" && what != "chair_start" && what != "chair_to_street";
        });
        INFO(name, "\n", joined(log), "but by hand\n", joined(wanted));
        CHECK(log == wanted);
        if (std::string(name) != "event_graph") {
            const bool grows =
                std::any_of(scene->notes.begin(), scene->notes.end(),
                            [](const Diagnostic& d) { return d.code == "grows-without-bound"; });
            CHECK(grows);
        }
    }
}

}  // namespace
}  // namespace puppetri::notation
