// SPDX-License-Identifier: MIT
// Statecharts: small cases in the spirit of the W3C's, random charts against an interpreter that
// follows the Recommendation's algorithm (appendix D) step by step and knows no nets, damaged
// files, and the W3C's own cases where a folder has them (PUPPETRI_SCXML_CASES=DIR).
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "playing.h"

namespace puppetri::notation {
namespace {

Checked<scene::Scene> load_chart(const std::string& xml) {
    scene::MemoryFiles files;
    files.add("c.scxml", xml);
    return scene::load(files, "c.scxml");
}

constexpr const char* kHead =
    "<scxml xmlns=\"http://www.w3.org/2005/07/scxml\" version=\"1.0\" datamodel=\"ecmascript\"";

// All places of states that had a token at some time.
std::set<std::string> visited(const std::string& xml, double seconds = 10) {
    Checked<scene::Scene> scene = load_chart(xml);
    if (!scene) {
        FAIL(told(scene.error()));
    }
    run::Player player(scene->net, {});
    std::set<std::string> out;
    const run::Limits limits{
        .until = {static_cast<std::int64_t>(seconds * static_cast<double>(kTicksPerSecond))}};
    while (player.step(limits) == run::Stop::kNone && player.firings() < 20000) {
        for (std::uint32_t p = 0; p < scene->net.place_count(); ++p) {
            if (player.tokens({p}) > 0) {
                const std::string path(scene->net.place(net::PlaceIndex{p}).path);
                out.insert(path.substr(path.find('.') + 1));
            }
        }
    }
    return out;
}

bool passes(const std::string& body, double seconds = 10) {
    const std::set<std::string> seen = visited(
        std::string(kHead) + ">" + body + "<final id=\"pass\"/><final id=\"fail\"/></scxml>",
        seconds);
    return seen.count("pass") == 1 && seen.count("fail") == 0;
}

TEST_CASE("charts: order, preemption, histories, done events, delays, cancelling [unit]") {
    CHECK(
        passes("<state id='a'><onentry><raise event='one'/><raise event='two'/></onentry>"
               "<transition event='one' target='b'/><transition event='*' target='fail'/></state>"
               "<state id='b'><transition event='two' target='pass'/>"
               "<transition event='*' target='fail'/></state>"));
    // Inner transitions go before outer ones, once per event in each region.
    CHECK(passes(
        "<datamodel><data id='n' expr='0'/></datamodel>"
        "<state id='s'><transition event='e' target='fail'/>"
        "<transition cond='n === 2' target='pass'/>"
        "<parallel id='p'><onentry><raise event='e'/></onentry>"
        "<state id='p1'><state id='a'><transition event='e' target='b'>"
        "<assign location='n' expr='n + 1'/></transition></state><state id='b'/></state>"
        "<state id='p2'><transition event='e'><assign location='n' expr='n + 1'/></transition>"
        "</state></parallel></state>"));
    // Of two regions that leave their parallel, the first in document order does.
    CHECK(
        passes("<state id='s'><parallel id='p'><onentry><raise event='e'/></onentry>"
               "<state id='p1'><transition event='e' target='pass'/></state>"
               "<state id='p2'><transition event='e' target='fail'/></state></parallel></state>"));
    // A deep history brings back the innermost states.
    CHECK(
        passes("<state id='w' initial='s'>"
               "<state id='s' initial='s1'><history id='h' type='deep'>"
               "<transition target='s1'/></history>"
               "<state id='s1'><transition target='s22'/></state>"
               "<state id='s2'><state id='s21'/><state id='s22'>"
               "<transition cond='n == 0' target='out'/>"
               "<transition cond='n == 1' target='pass'/></state></state></state>"
               "<state id='out'><onentry><assign location='n' expr='n + 1'/></onentry>"
               "<transition target='h'/></state></state>"
               "<datamodel><data id='n' expr='0'/></datamodel>"));
    CHECK(
        passes("<parallel id='p'><state id='a'><final id='af'/></state>"
               "<state id='b'><initial><transition target='b1'/></initial><state id='b1'>"
               "<transition target='bf'/></state><final id='bf'/></state>"
               "<transition event='done.state.p' target='pass'/></parallel>"));
    CHECK(
        passes("<state id='a'><onentry><send event='late' delay='2s'/><send event='soon' "
               "delayexpr=\"'1.5s'\"/></onentry><transition event='soon' target='b'/>"
               "<transition event='late' target='fail'/></state>"
               "<state id='b'><transition event='late' target='pass'/></state>"));
    CHECK(
        passes("<state id='a'><onentry><send event='x' id='i' delay='1s'/><send event='end' "
               "delay='2s'/><cancel sendid='i'/></onentry><transition event='x' target='fail'/>"
               "<transition event='end' target='pass'/></state>"));
    CHECK(
        passes("<datamodel><data id='x' expr='-7'/></datamodel><state id='a'>"
               "<onentry><if cond='x % 4 === -3 &amp;&amp; !(x &gt; 0)'><raise event='y'/>"
               "<elseif cond='true'/><raise event='n'/><else/><raise event='n'/></if></onentry>"
               "<transition event='y' cond=\"In('a') &amp;&amp; _event.name == 'y'\" "
               "target='pass'/><transition event='*' target='fail'/></state>"));
    // An internal transition does not leave its source, an external one does.
    CHECK(
        passes("<datamodel><data id='n' expr='0'/></datamodel>"
               "<state id='s'><onexit><assign location='n' expr='n + 1'/></onexit>"
               "<transition event='i' type='internal' target='s2'/>"
               "<transition event='x' target='s3'/>"
               "<state id='s1'><onentry><raise event='i'/></onentry></state>"
               "<state id='s2'><onentry><raise event='x'/></onentry></state>"
               "<state id='s3'><transition cond='n == 1' target='pass'/>"
               "<transition target='fail'/></state></state>"));
}

TEST_CASE("what is outside of the subset is told with its line, and nothing is loaded [unit]") {
    const auto codes = [](const std::string& body) {
        scene::MemoryFiles files;
        files.add("c.scxml", std::string(kHead) + ">\n" + body + "\n</scxml>");
        std::string out;
        for (const Diagnostic& d : scene::check(files, "c.scxml")) {
            CHECK_FALSE(d.remedy.empty());
            if (d.severity == Severity::kError) {
                out += std::to_string(d.where.line) + " " + d.code + ", ";
            }
        }
        return out;
    };
    CHECK(codes("<state id='a'>\n<invoke src='x'/></state>") == "3 outside-subset, ");
    CHECK(codes("<state id='a'><onentry>\n<script>x</script>\n<foreach "
                "array='x'/></onentry></state>") == "3 outside-subset, 4 outside-subset, ");
    CHECK(codes("<state id='a'>\n<transition event='e' cond='x.y'/></state>") ==
          "3 outside-subset, ");
    CHECK(codes("<state id='a'>\n<transition event='e' target='b'/></state>") ==
          "3 unknown-name, ");
    CHECK(codes("<state id='a'/>\n<state id='a'/>") == "3 name-twice, ");
    CHECK(codes("<datamodel><data id='x' expr='1/2'/>\n<data id='y' expr=\"'t'\"/></datamodel>"
                "<state id='a'/>") == "2 outside-subset, 3 outside-subset, ");
    CHECK(codes("<state id='a'>\n<transition/></state>") == "3 zero-time-loop, ");
    CHECK(codes("<state id='a'>\n<transition event='e' target='b c'/><state id='b'/>"
                "<state id='c'/></state>") == "3 targets-exclude-each-other, ");
    CHECK(codes("<state id='a'><onentry>\n<send event='e'><param "
                "name='x'/></send></onentry></state>") == "3 outside-subset, ");
}

TEST_CASE("truncated, damaged and malicious files are told, never played [hostile]") {
    const std::string good =
        std::string("<?xml version=\"1.0\"?><!-- a &amp; b -->") + kHead +
        "><datamodel><data id='n' expr='0'/></datamodel><state id='a'><onentry><send event='x' "
        "delay='1s'/><![CDATA[ ]]></onentry><transition event='x' cond='n &lt; 3' target='a'>"
        "<assign location='n' expr='n + 1'/></transition></state></scxml>";
    REQUIRE(load_chart(good));
    for (std::size_t i = 0; i < good.size(); ++i) {
        CHECK_FALSE(load_chart(good.substr(0, i)));
    }
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const char c : {'<', '&', '\0', '"', '>', '\xff'}) {
            std::string bad = good;
            bad[i] = c;
            (void)load_chart(bad);  // whatever it is: no crash
        }
    }
    CHECK_FALSE(
        load_chart("<!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol2 \"&lol;&lol;\">]>" + good));
    CHECK_FALSE(load_chart(std::string(kHead) + "><state id='&lol;'/></scxml>"));
    std::string deep = kHead;
    deep += ">";
    for (int i = 0; i < 100000; ++i) {
        deep += "<state>";
    }
    CHECK_FALSE(load_chart(deep));
    CHECK_FALSE(load_chart(std::string(kHead) + "><state id='a'><transition event='e' cond='" +
                           std::string(100000, '(') + "'/></state></scxml>"));
    CHECK_FALSE(load_chart(std::string(kHead) + "><state id='a'><transition event='e' cond='" +
                           std::string(100000, '!') + "true'/></state></scxml>"));
}

// ---------------------------------------------------------------------------------------------------------------------
// The Recommendation's algorithm, as it stands there

struct Action {
    enum { kMix, kRaise, kSend, kCancel } what;
    int number;  // what is mixed in; the event; the send
    long ms = 0;
};

struct S {
    std::string id, kind;  // state parallel final history
    int parent = -1;
    bool deep = false;
    std::vector<int> kids, histories, initial;
    bool has_initial = false;
    std::vector<Action> entry, exit, initial_actions;
    std::vector<int> transitions;
};
struct T {
    int source;
    std::string event;  // empty: eventless
    std::string cond;   // "": none; "x3": x % 3 == 0; else In(cond)
    std::vector<int> targets;
    bool internal;
    std::vector<Action> actions;
};
struct Model {
    std::vector<S> states;
    std::vector<T> transitions;
};

class Appendix {
 public:
    explicit Appendix(const Model& m) : m_(m) {}
    bool endless = false;
    long x = 1;
    bool running = true;
    std::set<int> configuration;

    void start() {
        T first{0, "", "", m_.states[0].initial, false, {}};
        extra_ = first;
        enter({-1});
        macrostep();
    }
    // Everything up to `until` (ms, exclusive of outside events later).
    void outside(const std::string& event) { external(event); }
    void play(long until) {
        for (;;) {
            auto next = std::min_element(sends_.begin(), sends_.end(), [](auto& a, auto& b) {
                return a.at != b.at ? a.at < b.at : a.sequence < b.sequence;
            });
            if (next == sends_.end() || next->at > until || !running || endless) {
                now_ = until;
                return;
            }
            now_ = next->at;
            const std::string event = "d" + std::to_string(next->number);
            sends_.erase(next);
            external(event);
        }
    }

 private:
    struct Send {
        long at, sequence;
        int number;
    };
    const S& st(int s) const { return m_.states[static_cast<std::size_t>(s)]; }
    const T& tr(int t) const {
        return t < 0 ? extra_ : m_.transitions[static_cast<std::size_t>(t)];
    }
    bool descendant(int s, int of) const {
        for (int p = st(s).parent; p >= 0; p = st(p).parent) {
            if (p == of) {
                return true;
            }
        }
        return false;
    }
    bool atomic(int s) const {
        return st(s).kind == "final" || (st(s).kind == "state" && st(s).kids.empty());
    }
    bool compound(int s) const { return s != 0 && st(s).kind == "state" && !st(s).kids.empty(); }

    void external(const std::string& event) {
        if (!running || endless) {
            return;
        }
        const std::vector<int> enabled = select(event);
        if (!enabled.empty()) {
            microstep(enabled);
        }
        macrostep();
    }
    void macrostep() {
        for (int steps = 0; running; ++steps) {
            if (steps > 60) {
                endless = true;
                return;
            }
            std::vector<int> enabled = select("");
            if (enabled.empty()) {
                if (internal_.empty()) {
                    break;
                }
                const std::string e = internal_.front();
                internal_.erase(internal_.begin());
                enabled = select(e);
            }
            if (!enabled.empty()) {
                microstep(enabled);
            }
        }
        if (!running) {
            for (int s = static_cast<int>(m_.states.size()) - 1; s > 0; --s) {
                if (configuration.count(s) != 0) {
                    run(st(s).exit);
                    configuration.erase(s);
                }
            }
        }
    }
    bool match(const std::string& d, const std::string& e) const {
        return d == "*" || d == e || e.rfind(d + ".", 0) == 0;
    }
    bool holds(const std::string& c) const {
        if (c.empty()) {
            return true;
        }
        if (c[0] == 'x') {
            return x % std::stol(c.substr(1)) == 0;
        }
        for (const int s : configuration) {
            if (st(s).id == c) {
                return true;
            }
        }
        return false;
    }
    std::vector<int> select(const std::string& event) {
        std::vector<int> enabled;
        for (const int a : configuration) {  // document order
            if (!atomic(a)) {
                continue;
            }
            bool found = false;
            for (int s = a; s > 0 && !found; s = st(s).parent) {
                for (const int t : st(s).transitions) {
                    const bool named = event.empty()
                                           ? tr(t).event.empty()
                                           : !tr(t).event.empty() && match(tr(t).event, event);
                    if (named && holds(tr(t).cond)) {
                        if (std::find(enabled.begin(), enabled.end(), t) == enabled.end()) {
                            enabled.push_back(t);
                        }
                        found = true;
                        break;
                    }
                }
            }
        }
        std::vector<int> filtered;
        for (const int t1 : enabled) {
            bool preempted = false;
            std::vector<int> remove;
            for (const int t2 : filtered) {
                const std::set<int> a = exit_set({t1}), b = exit_set({t2});
                if (std::any_of(a.begin(), a.end(), [&](int s) { return b.count(s) != 0; })) {
                    if (descendant(tr(t1).source, tr(t2).source)) {
                        remove.push_back(t2);
                    } else {
                        preempted = true;
                        break;
                    }
                }
            }
            if (!preempted) {
                for (const int t3 : remove) {
                    filtered.erase(std::find(filtered.begin(), filtered.end(), t3));
                }
                filtered.push_back(t1);
            }
        }
        return filtered;
    }
    std::vector<int> effective(const std::vector<int>& targets) const {
        std::vector<int> out;
        for (const int s : targets) {
            if (st(s).kind != "history") {
                out.push_back(s);
            } else if (history_.count(s) != 0) {
                out.insert(out.end(), history_.at(s).begin(), history_.at(s).end());
            } else {
                for (const int e : effective(st(s).initial)) {
                    out.push_back(e);
                }
            }
        }
        return out;
    }
    int domain(int t) const {
        const std::vector<int> to = effective(tr(t).targets);
        if (to.empty()) {
            return -1;
        }
        const int source = tr(t).source;
        const auto all_below = [&](int s) {
            return std::all_of(to.begin(), to.end(), [&](int d) { return descendant(d, s); });
        };
        if (t < 0) {
            return 0;
        }
        if (tr(t).internal && compound(source) && all_below(source)) {
            return source;
        }
        for (int s = st(source).parent; s > 0; s = st(s).parent) {
            if (compound(s) && all_below(s)) {
                return s;
            }
        }
        return 0;
    }
    std::set<int> exit_set(const std::vector<int>& list) const {
        std::set<int> out;
        for (const int t : list) {
            if (!tr(t).targets.empty()) {
                const int d = domain(t);
                for (const int s : configuration) {
                    if (descendant(s, d)) {
                        out.insert(s);
                    }
                }
            }
        }
        return out;
    }
    void microstep(const std::vector<int>& list) {
        const std::set<int> gone = exit_set(list);
        for (const int s : gone) {
            for (const int h : st(s).histories) {
                std::vector<int> kept;
                for (const int c : configuration) {
                    if (st(h).deep ? atomic(c) && descendant(c, s) : st(c).parent == s) {
                        kept.push_back(c);
                    }
                }
                now_history_[h] = kept;
            }
        }
        for (const auto& [h, kept] : now_history_) {
            history_[h] = kept;
        }
        now_history_.clear();
        for (auto s = gone.rbegin(); s != gone.rend(); ++s) {
            run(st(*s).exit);
            configuration.erase(*s);
        }
        for (const int t : list) {
            run(tr(t).actions);
        }
        enter(list);
    }
    void enter(const std::vector<int>& list) {
        to_enter_.clear();
        defaults_.clear();
        default_history_.clear();
        for (const int t : list) {
            for (const int s : tr(t).targets) {
                descend(s);
            }
            const int d = domain(t);
            for (const int s : effective(tr(t).targets)) {
                ascend(s, d);
            }
        }
        for (const int s : to_enter_) {
            configuration.insert(s);
            run(st(s).entry);
            if (defaults_.count(s) != 0) {
                run(st(s).initial_actions);
            }
            if (default_history_.count(s) != 0) {
                run(st(default_history_.at(s)).initial_actions);
            }
            if (st(s).kind == "final") {
                const int parent = st(s).parent;
                if (parent == 0) {
                    running = false;
                } else {
                    internal_.push_back("done.state." + st(parent).id);
                    const int above = st(parent).parent;
                    if (st(above).kind == "parallel" && in_final(above)) {
                        internal_.push_back("done.state." + st(above).id);
                    }
                }
            }
        }
    }
    bool in_final(int s) const {
        if (st(s).kind == "parallel") {
            return std::all_of(st(s).kids.begin(), st(s).kids.end(),
                               [&](int k) { return in_final(k); });
        }
        return std::any_of(st(s).kids.begin(), st(s).kids.end(), [&](int k) {
            return st(k).kind == "final" && configuration.count(k) != 0;
        });
    }
    void descend(int s) {
        if (st(s).kind == "history") {
            if (history_.count(s) != 0) {
                for (const int k : history_[s]) {
                    descend(k);
                }
                for (const int k : history_[s]) {
                    ascend(k, st(s).parent);
                }
            } else {
                default_history_[st(s).parent] = s;
                for (const int k : st(s).initial) {
                    descend(k);
                }
                for (const int k : st(s).initial) {
                    ascend(k, st(s).parent);
                }
            }
            return;
        }
        to_enter_.insert(s);
        if (compound(s)) {
            defaults_.insert(s);
            for (const int k : st(s).initial) {
                descend(k);
            }
            for (const int k : st(s).initial) {
                ascend(k, s);
            }
        } else if (st(s).kind == "parallel") {
            children(s);
        }
    }
    void children(int s) {
        for (const int k : st(s).kids) {
            if (std::none_of(to_enter_.begin(), to_enter_.end(),
                             [&](int e) { return descendant(e, k); })) {
                descend(k);
            }
        }
    }
    void ascend(int s, int to) {
        for (int a = st(s).parent; a > 0 && a != to; a = st(a).parent) {
            to_enter_.insert(a);
            if (st(a).kind == "parallel") {
                children(a);
            }
        }
    }
    void run(const std::vector<Action>& actions) {
        for (const Action& a : actions) {
            if (a.what == Action::kMix) {
                x = (x * 31 + a.number) % 10007;
            } else if (a.what == Action::kRaise) {
                internal_.push_back("i" + std::to_string(a.number) + ".z");
            } else if (a.what == Action::kSend) {
                sends_.push_back({now_ + a.ms, sequence_++, a.number});
            } else {
                std::erase_if(sends_, [&](const Send& s) { return s.number == a.number; });
            }
        }
    }

    const Model& m_;
    T extra_;
    std::map<int, std::vector<int>> history_, now_history_;
    std::set<int> to_enter_, defaults_;
    std::map<int, int> default_history_;
    std::vector<std::string> internal_;
    std::vector<Send> sends_;
    long now_ = 0, sequence_ = 0;
};

struct Random {
    std::uint64_t state;
    int below(int n) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<int>((state >> 33) % static_cast<std::uint64_t>(n));
    }
};

class Draw {
 public:
    explicit Draw(std::uint64_t seed) : r_{seed} {}
    Model model() {
        m_.states.push_back({"", "root", -1, false, {}, {}, {}, false, {}, {}, {}, {}});
        for (int i = 0, n = 2 + r_.below(2); i < n; ++i) {
            grow(0, 0);
        }
        if (r_.below(4) == 0) {
            add(0, "final");
        }
        const int count = static_cast<int>(m_.states.size());
        for (int s = 0; s < count; ++s) {
            S& st = m_.states[static_cast<std::size_t>(s)];
            if ((st.kind == "state" || st.kind == "root") && !st.kids.empty()) {
                st.initial = {st.kids[0]};
                if (r_.below(2) == 0) {
                    const int any = below(s);
                    st.initial = {any};
                    st.has_initial = true;
                    st.initial_actions =
                        s == 0 || r_.below(2) == 0 ? std::vector<Action>{} : actions();
                }
            }
            if (st.kind == "history") {
                st.initial = {
                    st.deep
                        ? below(st.parent)
                        : m_.states[static_cast<std::size_t>(st.parent)]
                              .kids[static_cast<std::size_t>(r_.below(static_cast<int>(
                                  m_.states[static_cast<std::size_t>(st.parent)].kids.size())))]};
                st.initial_actions = r_.below(2) == 0 ? actions() : std::vector<Action>{};
            }
        }
        for (int s = 1; s < count; ++s) {
            const std::string kind = m_.states[static_cast<std::size_t>(s)].kind;
            if (kind == "final" || kind == "history") {
                continue;
            }
            for (int i = r_.below(4); i > 0; --i) {
                transition(s);
            }
        }
        return std::move(m_);
    }
    Random r_;

 private:
    int add(int parent, const std::string& kind) {
        const int number = static_cast<int>(m_.states.size());
        S s{"s" + std::to_string(number), kind, parent, false, {}, {}, {}, false, {}, {}, {}, {}};
        if (kind != "history") {
            s.entry = actions();
            s.exit = actions();
        }
        m_.states.push_back(std::move(s));
        S& p = m_.states[static_cast<std::size_t>(parent)];
        (kind == "history" ? p.histories : p.kids).push_back(number);
        return number;
    }
    void grow(int parent, int depth) {
        const int k = r_.below(10);
        if (depth >= 3 || k < 4) {
            add(parent, "state");
            return;
        }
        const bool parallel = k < 7;
        const int s = add(parent, parallel ? "parallel" : "state");
        if (r_.below(3) == 0) {
            m_.states[static_cast<std::size_t>(add(s, "history"))].deep = r_.below(2) == 0;
        }
        for (int i = 0, n = parallel ? 2 : 1 + r_.below(3); i < n; ++i) {
            grow(s, depth + 1);
        }
        if (!parallel && r_.below(3) == 0) {
            add(s, "final");
        }
    }
    int below(int s) {  // any state inside that is no history
        std::vector<int> all;
        for (int d = s + 1; d < static_cast<int>(m_.states.size()); ++d) {
            int p = d;
            while (p > s) {
                p = m_.states[static_cast<std::size_t>(p)].parent;
            }
            if (p == s && m_.states[static_cast<std::size_t>(d)].kind != "history") {
                all.push_back(d);
            }
        }
        return all[static_cast<std::size_t>(r_.below(static_cast<int>(all.size())))];
    }
    std::vector<Action> actions() {
        std::vector<Action> out;
        for (int i = r_.below(3); i > 0; --i) {
            const int k = r_.below(12);
            if (k < 9) {
                out.push_back({Action::kMix, 1 + r_.below(100)});
            } else if (k == 9) {
                out.push_back({Action::kRaise, r_.below(3)});
            } else if (k == 10) {
                out.push_back({Action::kSend, r_.below(3), 1 + r_.below(4000)});
            } else {
                out.push_back({Action::kCancel, r_.below(3)});
            }
        }
        return out;
    }
    void transition(int source) {
        T t{source, "", "", {}, false, actions()};
        const int k = r_.below(12);
        t.event = k < 5   ? "o" + std::to_string(r_.below(3))
                  : k < 7 ? "i" + std::to_string(r_.below(3))
                  : k < 8 ? "d" + std::to_string(r_.below(3))
                  : k < 9 ? "*"
                  : k < 10
                      ? "done.state." +
                            m_.states[static_cast<std::size_t>(
                                          1 + r_.below(static_cast<int>(m_.states.size()) - 1))]
                                .id
                      : "";
        if (t.event.empty() || r_.below(3) == 0) {
            t.cond = "x" + std::to_string(2 + r_.below(3));
            const int s = 1 + r_.below(static_cast<int>(m_.states.size()) - 1);
            if (r_.below(2) == 0 && m_.states[static_cast<std::size_t>(s)].kind != "history") {
                t.cond = m_.states[static_cast<std::size_t>(s)].id;
            }
        }
        if (r_.below(6) != 0) {
            t.targets.push_back(1 + r_.below(static_cast<int>(m_.states.size()) - 1));
            if (r_.below(4) == 0) {
                t.targets.push_back(1 + r_.below(static_cast<int>(m_.states.size()) - 1));
            }
        }
        t.internal = r_.below(3) == 0;
        m_.states[static_cast<std::size_t>(source)].transitions.push_back(
            static_cast<int>(m_.transitions.size()));
        m_.transitions.push_back(std::move(t));
    }
    Model m_;
};

std::string actions_text(const std::vector<Action>& list) {
    std::string out;
    for (const Action& a : list) {
        const std::string n = std::to_string(a.number);
        out += a.what == Action::kMix ? "<assign location='x' expr='(x * 31 + " + n + ") % 10007'/>"
               : a.what == Action::kRaise ? "<raise event='i" + n + ".z'/>"
               : a.what == Action::kSend  ? "<send event='d" + n + "' id='d" + n + "' delay='" +
                                               std::to_string(a.ms) + "ms'/>"
                                         : "<cancel sendid='d" + n + "'/>";
    }
    return out;
}

std::string xml_of(const Model& m, int s = 0) {
    const S& st = m.states[static_cast<std::size_t>(s)];
    const auto ids = [&](const std::vector<int>& list) {
        std::string out;
        for (const int t : list) {
            out += (out.empty() ? "" : " ") + m.states[static_cast<std::size_t>(t)].id;
        }
        return out;
    };
    std::string out;
    if (s == 0) {
        out = std::string(kHead) + " initial='" + ids(st.initial) +
              "'><datamodel><data id='x' expr='1'/></datamodel>\n";
    } else {
        out = "<" + st.kind + " id='" + st.id + "'" + (st.deep ? " type='deep'" : "") + ">";
    }
    if (st.kind == "history") {
        return out + "<transition target='" + ids(st.initial) + "'>" +
               actions_text(st.initial_actions) + "</transition></history>\n";
    }
    if (st.has_initial && s != 0) {
        out += "<initial><transition target='" + ids(st.initial) + "'>" +
               actions_text(st.initial_actions) + "</transition></initial>";
    }
    if (!st.entry.empty()) {
        out += "<onentry>" + actions_text(st.entry) + "</onentry>";
    }
    if (!st.exit.empty()) {
        out += "<onexit>" + actions_text(st.exit) + "</onexit>";
    }
    for (const int number : st.transitions) {
        const T& t = m.transitions[static_cast<std::size_t>(number)];
        out += "<transition";
        out += t.event.empty() ? "" : " event='" + t.event + "'";
        out += t.cond.empty()     ? ""
               : t.cond[0] == 'x' ? " cond='x % " + t.cond.substr(1) + " == 0'"
                                  : " cond=\"In('" + t.cond + "')\"";
        out += t.targets.empty() ? "" : " target='" + ids(t.targets) + "'";
        out += t.internal ? " type='internal'>" : ">";
        out += actions_text(t.actions) + "</transition>";
    }
    // In document order: histories and children are numbered in it.
    std::vector<int> kids = st.kids;
    kids.insert(kids.end(), st.histories.begin(), st.histories.end());
    std::sort(kids.begin(), kids.end());
    for (const int k : kids) {
        out += xml_of(m, k);
    }
    return out + (s == 0 ? "</scxml>\n" : "</" + st.kind + ">\n");
}

TEST_CASE("random charts do what the Recommendation's algorithm does [oracle]") {
    const int charts = std::getenv("PUPPETRI_LONG") != nullptr ? 40000 : 800;
    int played = 0, steps = 0, ended = 0, parallels = 0;
    for (int seed = 1; seed <= charts; ++seed) {
        Draw draw(static_cast<std::uint64_t>(seed));
        const Model model = draw.model();
        Appendix wanted(model);
        wanted.start();
        const std::string xml = xml_of(model);
        Checked<scene::Scene> scene = load_chart(xml);
        if (!scene) {  // targets that exclude each other, histories from inside
            for (const Diagnostic& d : scene.error()) {
                INFO(told(scene.error()));
                INFO(xml);
                if (d.severity == Severity::kError) {
                    CHECK((d.code == "targets-exclude-each-other" || d.code == "outside-subset" ||
                           d.code == "too-large"));
                }
            }
            continue;
        }
        run::Player player(scene->net, {.seed = static_cast<std::uint64_t>(seed)});
        bool same = true;
        for (int step = 0; step < 14 && same; ++step) {
            const long at = 600L * step;
            // The outside speaks half a millisecond after `at`.
            if (step > 0) {
                wanted.play(at);
                const std::string event = "o" + std::to_string(draw.r_.below(3));
                const net::EventIndex e = scene->net.find_event("c." + event);
                if (wanted.endless) {
                    break;
                }
                player.advance_to({at * (kTicksPerSecond / 1000)});
                if (e.valid()) {
                    const run::OutsideEvent occurs{
                        {at * (kTicksPerSecond / 1000) + kTicksPerSecond / 2000}, e};
                    player.schedule({&occurs, 1});
                    wanted.outside(event);
                }
            }
            if (wanted.endless) {
                break;
            }
            player.advance_to({at * (kTicksPerSecond / 1000) + kTicksPerSecond / 2000});
            int regions = 0;
            for (std::size_t s = 1; s < model.states.size(); ++s) {
                if (model.states[s].kind == "history") {
                    continue;
                }
                const bool is =
                    player.tokens(scene->net.find_place("c." + model.states[s].id)) == 1;
                same = same && is == (wanted.configuration.count(static_cast<int>(s)) == 1);
                regions += is && model.states[s].kind == "parallel" ? 1 : 0;
            }
            parallels += regions > 0 ? 1 : 0;
            same = same && player.datum(scene->net.find_datum("c.x")) == wanted.x;
            same = same && (player.tokens(scene->net.find_place("c.done")) == 1) == !wanted.running;
            ++steps;
            INFO(xml);
            INFO("seed " << seed << " at " << at << " ms, x = " << wanted.x);
            CHECK(same);
        }
        played += wanted.endless ? 0 : 1;
        ended += wanted.running ? 0 : 1;
    }
    CHECK(played > charts / 20);
    CHECK(steps > 5 * played);
    CHECK(ended > played / 50);
    CHECK(parallels > steps / 20);
}

TEST_CASE("the W3C's cases that are within the subset pass [oracle]") {
    const char* folder = std::getenv("PUPPETRI_SCXML_CASES");
    if (folder == nullptr) {
        MESSAGE("skipped: PUPPETRI_SCXML_CASES names no folder");
        return;
    }
    int passed = 0, outside = 0;
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        all.push_back(entry.path());
    }
    std::sort(all.begin(), all.end());
    for (const auto& path : all) {
        std::ifstream in(path);
        std::stringstream text;
        text << in.rdbuf();
        if (text.str().find("id=\"pass\"") == std::string::npos) {
            continue;
        }
        if (!load_chart(text.str())) {
            ++outside;
            continue;
        }
        const std::set<std::string> seen = visited(text.str(), 100);
        const bool pass = seen.count("pass") == 1 && seen.count("fail") == 0;
        passed += pass ? 1 : 0;
        INFO(path.filename().string());
        CHECK(pass);
    }
    MESSAGE(passed << " passed, " << outside << " outside of the subset");
}

}  // namespace
}  // namespace puppetri::notation
