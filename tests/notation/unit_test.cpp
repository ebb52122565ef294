// SPDX-License-Identifier: MIT
// Event units: hand-made cases, and random programs against a direct interpreter of the tree of
// units (it starts, ends and cuts units by recursion and knows no nets).
#include <algorithm>
#include <memory>
#include <set>

#include "playing.h"

namespace puppetri::notation {
namespace {

TEST_CASE("units begin and end one after another, side by side, and as often as is said [unit]") {
    CHECK(log_of(R"(use dance
unit dance {
  one: wait 2 s
  both: parallel {
    short: wait 1 s
    long: wait 3 s
  }
  thrice: repeat 3 { step: wait 1 s }
}
)",
                 100) == std::vector<std::string>{
                             "0 s dance.start", "2 s dance.one_to_both", "5 s dance.both_to_thrice",
                             "5 s dance.thrice_begins_round", "6 s dance.thrice_ends_round",
                             "6 s dance.thrice_begins_round", "7 s dance.thrice_ends_round",
                             "7 s dance.thrice_begins_round", "8 s dance.thrice_ends_round",
                             "8 s dance.thrice_ends", "8 s dance.finish"});
}

TEST_CASE("each wait for an event takes an occurrence of its own [unit]") {
    CHECK(log_of(R"(use u(clap)
event clap at 1 s, 4 s
unit u(clap: event) {
  first: await clap
  second: await clap
}
)",
                 100) == std::vector<std::string>{"0 s u.start", "1 s u.first_hears",
                                                  "1 s u.first_to_second", "4 s u.second_hears",
                                                  "4 s u.finish"});
}

TEST_CASE("an interruption empties what it cuts, whatever is nested in it [unit]") {
    const scene::Scene scene = from_text(R"(use u(bell)
event bell at 2.5 s
net inner {
  start place a takes 10 s
  finish place b
  t: a -> b
}
unit u(bell: event) {
  all: interrupt {
    parallel {
      deep: repeat 5 { tick: wait 1 s }
      net_part: runs inner
      never: repeat { beat: wait 0.4 s }
    }
    on bell { rest: wait 2 s }
  }
}
rule at_rest never (u.rest and (u.deep or u.net_part or u.never))
)");
    run::Player player(scene.net, {});
    player.run({.until = {3 * kTicksPerSecond}});
    std::vector<std::string> marked;
    for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
        if (player.tokens({p}) > 0) {
            marked.emplace_back(scene.net.place(net::PlaceIndex{p}).path);
        }
    }
    CHECK(marked == std::vector<std::string>{"u.rest"});
    player.run({.until = {60 * kTicksPerSecond}});
    CHECK(player.tokens(scene.net.find_place("u.done")) == 1);
}

TEST_CASE("a body that ends in the instant of its time limit has ended [unit]") {
    const std::vector<std::string> log = log_of(R"(use u
unit u {
  all: interrupt {
    work: wait 2 s
    after 2 s { late: wait 1 s }
  }
}
)",
                                                100);
    CHECK(log.back() == "2 s u.finish");
}

TEST_CASE("of two interruptions by one event the outer one goes first [unit]") {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        const std::vector<std::string> log = log_of(R"(use u(bell)
event bell at 1 s
unit u(bell: event) {
  outer: until bell {
    inner: interrupt {
      w: wait 5 s
      on bell { never: wait 1 s }
    }
  }
}
)",
                                                    100, seed);
        CHECK(log == std::vector<std::string>{"0 s u.start", "0 s u.outer_begins",
                                              "0 s u.inner_begins", "1 s u.outer_cut",
                                              "1 s u.finish"});
    }
}

TEST_CASE("a unit refines a place like any net, and may be entered again [unit]") {
    CHECK(log_of(R"(place a runs work tokens 1
place b takes 1 s
t: a -> b
s: b -> a
unit work { w: wait 2 s }
)",
                 6) == std::vector<std::string>{"0 s a.start", "2 s a.finish", "2 s t", "3 s s",
                                                "3 s a.start", "5 s a.finish", "5 s t", "6 s s",
                                                "6 s a.start"});
}

TEST_CASE("defects of units are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use u(x)
unit u(x: event) {
  dose ana.wave()
  repeat { raise x }
  repeat { wait 1 s }
  after_it: wait 1 s
  repeat 0 { wait 1 s }
  choice { wait 1 s }
  parallel { }
  after_it: wait 2 s
}
event x
)");
    std::string got;
    for (const Diagnostic& d : list) {
        got += std::to_string(d.where.line) + " " + d.code + "\n";
        CHECK_FALSE(d.remedy.empty());
    }
    CHECK(got ==
          "5 unknown-unit\n6 zero-time-loop\n7 never-reached\n8 never-reached\n9 out-of-range\n"
          "10 empty-unit\n10 syntax\n11 empty-unit\n12 name-twice\n");
}

// ---------------------------------------------------------------------------------------------------------------------
// An interpreter of its own

struct Node {
    enum Kind {
        kWait,
        kAwait,
        kRaise,
        kSequence,
        kParallel,
        kRace,
        kRepeat,
        kForEver,
        kRepeatUntil,
        kUntil,
        kInterrupt
    } kind;
    std::string name;
    int ms = 0, event = 0, times = 0;
    bool again = false;
    std::vector<Node> kids;  // of kInterrupt: the body's, one; then the handler
};

struct Act {
    const Node* node = nullptr;
    std::vector<std::unique_ptr<Act>> kids;
    std::size_t at = 0;
    bool done = false, asked = false, handling = false;
    int rounds = 0;
    long begun = 0, end = 0;
};

class Interpreter {
 public:
    explicit Interpreter(const Node& root) { root_ = begin(root); }
    bool ambiguous = false;

    // Plays everything before `until`, with these occurrences.
    void play(long until, const std::vector<std::pair<long, int>>& events) {
        progress(*root_);
        raised();
        for (;;) {
            const long next_event = at_ < events.size() ? events[at_].first : until;
            const long next = std::min(next_wait(*root_), next_event);
            if (next >= until) {
                return;
            }
            now_ = next;
            expire(*root_);
            progress(*root_);
            if (at_ < events.size() && events[at_].first == now_) {
                hear(*root_, events[at_++].second);
                progress(*root_);
            }
            raised();
        }
    }

    std::set<std::string> active() const {
        std::set<std::string> out;
        collect(*root_, out);
        return out;
    }
    bool done() const { return root_->done; }

 private:
    std::unique_ptr<Act> begin(const Node& n) {
        auto a = std::make_unique<Act>();
        a->node = &n;
        a->begun = now_;
        switch (n.kind) {
            case Node::kWait:
                a->end = now_ + 1000L * n.ms;
                break;
            case Node::kAwait:
                break;
            case Node::kRaise:
                queue_.push_back(n.event);
                ambiguous = ambiguous || queue_.size() > 1;  // in which order, is drawn
                a->done = true;
                break;
            case Node::kParallel:
            case Node::kRace:
                for (const Node& k : n.kids) {
                    a->kids.push_back(begin(k));
                }
                break;
            default:
                a->kids.push_back(begin(n.kids[0]));
        }
        return a;
    }

    void progress(Act& a) {
        if (a.done) {
            return;
        }
        const Node& n = *a.node;
        for (auto& k : a.kids) {
            progress(*k);
        }
        switch (n.kind) {
            case Node::kSequence:
                while (a.kids[0]->done && a.at + 1 < n.kids.size()) {
                    a.kids[0] = begin(n.kids[++a.at]);
                    progress(*a.kids[0]);
                }
                a.done = a.kids[0]->done;
                break;
            case Node::kParallel:
                a.done = std::all_of(a.kids.begin(), a.kids.end(), [](auto& k) { return k->done; });
                break;
            case Node::kRace: {
                const auto ended =
                    std::count_if(a.kids.begin(), a.kids.end(), [](auto& k) { return k->done; });
                a.done = ended > 0;
                // Who is cut may or may not have done something in this very instant.
                ambiguous = ambiguous || ended > 1 || (ended == 1 && a.begun == now_);
                break;
            }
            case Node::kRepeat:
            case Node::kForEver:
            case Node::kRepeatUntil:
                while (a.kids[0]->done) {
                    ++a.rounds;
                    if ((n.kind == Node::kRepeat && a.rounds == n.times) || a.asked) {
                        a.done = true;
                        break;
                    }
                    a.kids[0] = begin(n.kids[0]);
                    progress(*a.kids[0]);
                }
                break;
            case Node::kUntil:
                a.done = a.kids[0]->done;
                break;
            case Node::kInterrupt:
                if (a.kids[0]->done && a.handling && n.again) {
                    a.handling = false;
                    a.kids[0] = begin(n.kids[0]);
                    progress(*a.kids[0]);
                }
                a.done = a.kids[0]->done;
                break;
            default:
                break;
        }
    }

    void expire(Act& a) {
        if (a.node->kind == Node::kWait && a.end == now_) {
            a.done = true;
        }
        for (auto& k : a.kids) {
            expire(*k);
        }
    }

    long next_wait(const Act& a) const {
        if (a.done) {
            return kNever;
        }
        long least = a.node->kind == Node::kWait ? a.end : kNever;
        for (const auto& k : a.kids) {
            least = std::min(least, next_wait(*k));
        }
        return least;
    }

    void hear(Act& a, int event) {
        if (a.done) {
            return;
        }
        const Node& n = *a.node;
        if (n.event == event) {
            if (n.kind == Node::kAwait || n.kind == Node::kUntil) {
                a.done = true;
                return;
            }
            if (n.kind == Node::kInterrupt && !a.handling) {
                a.handling = true;
                a.kids[0] = begin(n.kids[1]);
                return;
            }
            a.asked = a.asked || n.kind == Node::kRepeatUntil;
        }
        for (auto& k : a.kids) {
            hear(*k, event);
        }
    }

    void raised() {
        while (!queue_.empty()) {
            const int e = queue_.front();
            queue_.erase(queue_.begin());
            hear(*root_, e);
            progress(*root_);
        }
    }

    void collect(const Act& a, std::set<std::string>& out) const {
        if (a.done) {
            return;
        }
        if (a.kids.empty()) {
            out.insert(a.node->name);
        }
        for (const auto& k : a.kids) {
            collect(*k, out);
        }
    }

    static constexpr long kNever = 1L << 60;
    std::unique_ptr<Act> root_;
    long now_ = 0;
    std::size_t at_ = 0;
    std::vector<int> queue_;
};

struct Writer {
    std::uint64_t state;
    int names = 0;
    std::uint32_t below(std::uint32_t n) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>(state >> 33) % n;
    }
    Node leaf() {
        Node n;
        const std::uint32_t k = below(8);
        n.kind = k < 5 ? Node::kWait : k < 7 ? Node::kAwait : Node::kRaise;
        n.name = "n" + std::to_string(names++);
        n.ms = static_cast<int>(1 + below(5000));
        n.event = 1 + static_cast<int>(below(4));
        return n;
    }
    Node row(int depth) {
        Node n;
        n.kind = Node::kSequence;
        n.name = "n" + std::to_string(names++);
        for (std::uint32_t i = 0, count = 1 + below(3); i < count; ++i) {
            n.kids.push_back(make(depth));
        }
        return n;
    }
    // A row that surely takes time, where rounds must.
    Node round(int depth) {
        Node n = row(depth);
        Node w = leaf();
        w.kind = Node::kWait;
        n.kids.push_back(w);
        return n;
    }
    Node make(int depth) {
        if (depth == 0 || below(3) == 0) {
            return leaf();
        }
        Node n;
        static constexpr Node::Kind kKinds[] = {
            Node::kSequence, Node::kParallel, Node::kRace,      Node::kRepeat,   Node::kRepeatUntil,
            Node::kUntil,    Node::kUntil,    Node::kInterrupt, Node::kInterrupt};
        n.kind = kKinds[below(9)];
        n.name = "n" + std::to_string(names++);
        n.event = 1 + static_cast<int>(below(4));
        switch (n.kind) {
            case Node::kSequence:
                n.kids = row(depth - 1).kids;
                break;
            case Node::kParallel:
            case Node::kRace:
                for (std::uint32_t i = 0, count = 2 + below(2); i < count; ++i) {
                    n.kids.push_back(make(depth - 1));
                }
                break;
            case Node::kRepeat:
                n.times = 1 + static_cast<int>(below(3));
                n.kids.push_back(row(depth - 1));
                break;
            case Node::kRepeatUntil:
                n.kids.push_back(round(depth - 1));
                break;
            case Node::kUntil:
                n.kids.push_back(row(depth - 1));
                if (below(2) == 0) {  // for ever, until the event
                    Node loop;
                    loop.kind = Node::kForEver;
                    loop.name = "n" + std::to_string(names++);
                    loop.kids.push_back(round(depth - 1));
                    n.kids[0] = Node{Node::kSequence, "n" + std::to_string(names++), 0, 0, 0, false,
                                     {loop}};
                }
                break;
            default:
                n.again = below(2) == 0;
                n.kids.push_back(row(depth - 1));
                n.kids.push_back(n.again ? round(depth - 1) : row(depth - 1));
        }
        return n;
    }
};

void write(const Node& n, std::string& out, const std::string& indent) {
    const std::string e = "e" + std::to_string(n.event);
    const auto lines = [&](const std::vector<Node>& kids) {
        for (const Node& k : kids) {
            write(k, out, indent + "  ");
        }
    };
    out += indent + n.name + ": ";
    switch (n.kind) {
        case Node::kWait:
            out += "wait " + std::to_string(n.ms) + " ms\n";
            return;
        case Node::kAwait:
            out += "await " + e + "\n";
            return;
        case Node::kRaise:
            out += "raise " + e + "\n";
            return;
        case Node::kSequence:
            out += "sequence {\n";
            lines(n.kids);
            break;
        case Node::kParallel:
            out += "parallel {\n";
            lines(n.kids);
            break;
        case Node::kRace:
            out += "race {\n";
            lines(n.kids);
            break;
        case Node::kRepeat:
            out += "repeat " + std::to_string(n.times) + " {\n";
            lines(n.kids[0].kids);
            break;
        case Node::kForEver:
            out += "repeat {\n";
            lines(n.kids[0].kids);
            break;
        case Node::kRepeatUntil:
            out += "repeat until " + e + " {\n";
            lines(n.kids[0].kids);
            break;
        case Node::kUntil:
            out += "until " + e + " {\n";
            lines(n.kids[0].kids);
            break;
        case Node::kInterrupt:
            out += "interrupt {\n";
            lines(n.kids[0].kids);
            out += indent + "  on " + e + (n.again ? " again {\n" : " {\n");
            lines(n.kids[1].kids);
            out += indent + "  }\n";
            break;
    }
    out += indent + "}\n";
}

TEST_CASE("random units do what an interpreter of the tree of units does [oracle]") {
    int played = 0, units = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        Writer writer{seed};
        const Node root = writer.round(4);  // a net without any time would be paced
        // Odd milliseconds for nothing else: occurrences fall between the ends of waits.
        std::vector<std::pair<long, int>> events;
        for (int i = 0; i < 25; ++i) {
            events.emplace_back(1000 * static_cast<long>(writer.below(40000)) + 500,
                                1 + static_cast<int>(writer.below(4)));
        }
        std::sort(events.begin(), events.end());
        std::string text = "use u(e1, e2, e3, e4)\n";
        for (int e = 1; e <= 4; ++e) {
            text += "event e" + std::to_string(e) + "\n";
        }
        text += "unit u(e1: event, e2: event, e3: event, e4: event) {\n";
        for (const Node& k : root.kids) {
            write(k, text, "  ");
        }
        text += "}\n";
        const scene::Scene scene = from_text(text);
        run::Player player(scene.net, {.seed = seed});
        std::vector<run::OutsideEvent> outside;
        for (const auto& [us, e] : events) {
            outside.push_back({{us * (kTicksPerSecond / 100) / 10000},
                               scene.net.find_event("e" + std::to_string(e))});
        }
        player.schedule(outside);
        bool same = true, ambiguous = false;
        for (int sample = 1; sample <= 60 && same && !ambiguous; ++sample) {
            const long until_us = sample * 700'000L + 250;
            Interpreter interpreter(root);
            // In microseconds; waits are whole milliseconds.
            interpreter.play(until_us, events);
            ambiguous = interpreter.ambiguous;
            player.run({.until = {until_us * (kTicksPerSecond / 100) / 10000}});
            std::set<std::string> active;
            for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
                const std::string_view path = scene.net.place(net::PlaceIndex{p}).path;
                if (player.tokens({p}) > 0 && path.find('_') == path.npos && path != "u.done") {
                    active.insert(std::string(path.substr(2)));
                }
            }
            std::set<std::string> wanted = interpreter.active();
            const bool done = player.tokens(scene.net.find_place("u.done")) == 1;
            if (ambiguous) {
                break;
            }
            // A wait that is over stands in its place until those beside it have ended, too.
            for (const std::string& name : wanted) {
                same = same && active.count(name) == 1;
            }
            for (const std::string& name : active) {
                const net::PlaceIndex p = scene.net.find_place("u." + name);
                same = same && (wanted.count(name) == 1 || player.ready_tokens(p) == 1);
            }
            same = same && done == interpreter.done();
            INFO(text);
            INFO("seed " << seed << " at " << until_us << " us");
            CHECK(same);
        }
        played += ambiguous ? 0 : 1;
        units += writer.names;
    }
    CHECK(played > 200);
    CHECK(units > 4000);
}

}  // namespace
}  // namespace puppetri::notation
