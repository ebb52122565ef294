// SPDX-License-Identifier: MIT
// Networks of messages against an interpreter of their own: queues, a list of what is under way,
// shortest ways by search.
#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "playing.h"
#include "puppetri/base/random.h"

namespace puppetri::notation {
namespace {

struct Message {
    int kind = 0, to = 0, from = 0;
};

struct World {
    struct Link {
        int a = 0, b = 0, takes = 0;  // tenths of a second
        bool one_at_a_time = false;
    };
    struct Sending {
        int who = 0, kind = 0, to = 0, every = 0;
    };
    int nodes = 0;
    std::vector<int> handling;  // tenths
    std::vector<Link> links;
    std::vector<std::pair<int, int>> answers;  // node and kind, answered with the next kind
    std::vector<Sending> sendings;

    static constexpr int kKinds = 3;

    int distance(int from, int to) const {
        std::set<int> seen{from};
        for (int far = 0; far <= nodes; ++far) {
            if (seen.count(to) != 0) {
                return far;
            }
            std::set<int> more = seen;
            for (const Link& l : links) {
                if (seen.count(l.a) != 0) {
                    more.insert(l.b);
                }
                if (seen.count(l.b) != 0) {
                    more.insert(l.a);
                }
            }
            seen = more;
        }
        return 1000;
    }
    // Directions: 2 l from a to b, 2 l + 1 back.
    int begin_of(int way) const {
        const Link& l = links[static_cast<std::size_t>(way / 2)];
        return way % 2 == 0 ? l.a : l.b;
    }
    int end_of(int way) const { return begin_of(way ^ 1); }
    bool leads(int way, int to) const {
        const int from = begin_of(way);
        for (int w = 0; w < way; ++w) {
            if (begin_of(w) == from && distance(end_of(w), to) + 1 == distance(from, to)) {
                return false;
            }
        }
        return from != to && distance(end_of(way), to) + 1 == distance(from, to);
    }
    bool answered(int node, int kind) const {
        for (const auto& [n, k] : answers) {
            if (n == node && k == kind) {
                return true;
            }
        }
        return false;
    }

    // "1.5 n2 gets", in order.
    std::vector<std::string> play(int until) const {
        struct UnderWay {
            int ready;
            Message message;
        };
        const auto count = static_cast<std::size_t>(nodes);
        std::vector<std::deque<Message>> inbox(count), outbox(count);
        std::vector<std::deque<UnderWay>> handled(count), way(2 * links.size());
        std::vector<bool> free(count, true), link_free(links.size(), true);
        std::vector<std::string> out;
        const auto say = [&](int now, const std::string& what) {
            char text[60];
            std::snprintf(text, sizeof text, "%.9g s x.", now / 10.0);
            out.push_back(text + what);
        };
        const auto node = [](int n) { return "n" + std::to_string(n); };
        const auto act = [&](int now) {
            for (int n = 0; n < nodes; ++n) {
                auto& h = handled[static_cast<std::size_t>(n)];
                if (!h.empty() && h.front().ready <= now) {
                    const Message m = h.front().message;
                    h.pop_front();
                    free[static_cast<std::size_t>(n)] = true;
                    if (m.to != n) {
                        outbox[static_cast<std::size_t>(n)].push_back(m);
                        say(now, node(n) + "_passes");
                    } else if (answered(n, m.kind)) {
                        outbox[static_cast<std::size_t>(n)].push_back(
                            {(m.kind + 1) % kKinds, m.from, n});
                        say(now, node(n) + "_answers_k" + std::to_string(m.kind));
                    } else {
                        say(now, node(n) + "_gets");
                    }
                    return true;
                }
            }
            for (std::size_t w = 0; w < way.size(); ++w) {
                if (!way[w].empty() && way[w].front().ready <= now) {
                    const int to = end_of(static_cast<int>(w));
                    inbox[static_cast<std::size_t>(to)].push_back(way[w].front().message);
                    way[w].pop_front();
                    link_free[w / 2] = true;
                    say(now, node(begin_of(static_cast<int>(w))) + "_reaches_" + node(to));
                    return true;
                }
            }
            for (int n = 0; n < nodes; ++n) {
                const auto i = static_cast<std::size_t>(n);
                if (free[i] && !inbox[i].empty()) {
                    free[i] = false;
                    handled[i].push_back({now + handling[i], inbox[i].front()});
                    inbox[i].pop_front();
                    say(now, node(n) + "_begins");
                    return true;
                }
            }
            for (std::size_t w = 0; w < way.size(); ++w) {
                auto& box = outbox[static_cast<std::size_t>(begin_of(static_cast<int>(w)))];
                if (links[w / 2].one_at_a_time && !link_free[w / 2]) {
                    continue;
                }
                for (std::size_t i = 0; i < box.size(); ++i) {
                    if (leads(static_cast<int>(w), box[i].to)) {
                        way[w].push_back({now + links[w / 2].takes, box[i]});
                        box.erase(box.begin() + static_cast<std::ptrdiff_t>(i));
                        link_free[w / 2] = false;
                        say(now, node(begin_of(static_cast<int>(w))) + "_sends_to_" +
                                     node(end_of(static_cast<int>(w))));
                        return true;
                    }
                }
            }
            return false;
        };
        for (int now = 0; now <= until; ++now) {
            while (act(now)) {
            }
            std::map<int, int> number;
            for (const Sending& s : sendings) {
                const int which = ++number[s.who];
                if (now != 0 && now % s.every == 0) {
                    say(now,
                        node(s.who) + "_sends" + (which == 1 ? "" : "_" + std::to_string(which)));
                    outbox[static_cast<std::size_t>(s.who)].push_back({s.kind, s.to, s.who});
                    while (act(now)) {
                    }
                }
            }
        }
        return out;
    }

    std::string text() const {
        std::string t = "use w as x\nmessages w {\n";
        for (int k = 0; k < kKinds; ++k) {
            t += " message k" + std::to_string(k) + "\n";
        }
        for (int n = 0; n < nodes; ++n) {
            t += " node n" + std::to_string(n) + " takes " +
                 std::to_string(handling[static_cast<std::size_t>(n)]) + "/10*1 s\n";
        }
        for (const Link& l : links) {
            t += " link n" + std::to_string(l.a) + " n" + std::to_string(l.b) + " takes " +
                 std::to_string(l.takes) + "/10*1 s" + (l.one_at_a_time ? " one at a time" : "") +
                 "\n";
        }
        for (const auto& [n, k] : answers) {
            t += " n" + std::to_string(n) + " answers k" + std::to_string(k) + " with k" +
                 std::to_string((k + 1) % kKinds) + "\n";
        }
        for (const Sending& s : sendings) {
            t += " n" + std::to_string(s.who) + " sends k" + std::to_string(s.kind) + " to n" +
                 std::to_string(s.to) + " every " + std::to_string(s.every) + "/10*1 s\n";
        }
        return t + "}\n";
    }
};

TEST_CASE(
    "random networks: every firing is that of the interpreter, instant for instant [oracle]") {
    RandomStream random(stream_key(5, "messages", "test"));
    const auto pick = [&](int n) { return static_cast<int>(random.bits() % unsigned(n)); };
    for (int round = 0; round < 60; ++round) {
        World w;
        w.nodes = 2 + pick(5);
        for (int n = 0; n < w.nodes; ++n) {
            w.handling.push_back(pick(4));
            if (n > 0) {  // a tree, and some links more
                w.links.push_back({pick(n), n, 1 + pick(4), pick(3) == 0});
            }
        }
        for (int i = pick(3); i > 0; --i) {
            const int a = pick(w.nodes), b = pick(w.nodes);
            bool known = a == b;
            for (const World::Link& l : w.links) {
                known = known || (l.a == a && l.b == b) || (l.a == b && l.b == a);
            }
            if (!known) {
                w.links.push_back({a, b, 1 + pick(4), pick(3) == 0});
            }
        }
        for (int i = pick(4); i > 0; --i) {
            const std::pair<int, int> made{pick(w.nodes), pick(World::kKinds - 1)};
            if (!w.answered(made.first, made.second)) {
                w.answers.push_back(made);
            }
        }
        for (int i = 1 + pick(4); i > 0; --i) {
            const int who = pick(w.nodes), to = (who + 1 + pick(w.nodes - 1)) % w.nodes;
            w.sendings.push_back({who, pick(World::kKinds), to, 5 + pick(20)});
        }
        REQUIRE_MESSAGE(log_of(w.text(), 20) == w.play(200), w.text());
    }
}

TEST_CASE("messages cross on one link, unless it carries one at a time [unit]") {
    const auto log = [](const char* how) {
        std::vector<std::string> got;
        for (const std::string& line :
             log_of(std::string("use w as x\nmessages w {\n node a\n node b\n link a b takes 2 s") +
                        how + "\n a sends message to b at 1 s\n b sends message to a at 1 s\n}\n",
                    9)) {
            if (line.find("_gets") != std::string::npos) {
                got.push_back(line);
            }
        }
        return got;
    };
    CHECK(log("") == std::vector<std::string>{"3 s x.a_gets", "3 s x.b_gets"});
    CHECK(log(" one at a time") == std::vector<std::string>{"3 s x.b_gets", "5 s x.a_gets"});
}

TEST_CASE("defects of networks are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use w as x
messages w {
  message hello
  node a takes 1 s
  node b
  node c
  link a b takes 1 s
  link b a
  link a a
  link a d
  a sends hello to c every 1 s
  a sends goodbye to b
  a answers hello
  b answers hello with hello
  b answers hello with hello
  c wonders
  a sends hello to b one day
}
)");
    CHECK(lines_and_codes(list) == LinesAndCodes{{10, "name-twice"},
                                                 {11, "link-to-itself"},
                                                 {12, "unknown-name"},
                                                 {13, "no-way"},
                                                 {14, "unknown-name"},
                                                 {15, "syntax"},
                                                 {17, "name-twice"},
                                                 {18, "syntax"},
                                                 {19, "syntax"}});
}

}  // namespace
}  // namespace puppetri::notation
