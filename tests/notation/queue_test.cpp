// SPDX-License-Identifier: MIT
// One station against an event list of its own, event for event; routing, blocking, failures and
// the rest by hand-made cases.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "playing.h"
#include "puppetri/base/random.h"
#include "puppetri/notation/notation.h"

namespace puppetri::notation {
namespace {

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

}  // namespace
}  // namespace puppetri::notation
