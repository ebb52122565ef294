// SPDX-License-Identifier: MIT
// Extended state machines (Camargo, Magalhaes, Raposo 1995, section 2.1, after Ostroff): states,
// variables, guarded actions that assign, send or receive. The language reads a machine as a net
// whose places are states; what remains is to see that it is one, and to write what the net has no
// word for: staying in a state, and looking at certain instants only.
#include <map>
#include <set>
#include <string>

#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

class Machine {
 public:
    Machine(const lang::Net& machine, const lang::File& file, Lowered& out)
        : machine_(machine), teller_("machine " + machine.name.text, file, out), out_(out) {}

    void lower() {
        out_.net = machine_;
        collect(machine_.body, false);
        write(out_.net.body);
        for (auto& [text, event] : polls_) {
            out_.net.body.events.push_back(std::move(event));
        }
        check();
    }

 private:
    struct State {
        lang::Span span;
        std::set<std::string> to;
        bool starts = false;
    };

    void collect(const lang::Body& body, bool in_loop) {
        for (const lang::Place& p : body.places) {
            State& state = states_[p.name.text];
            state.span = p.name.span;
            state.starts = state.starts || p.starts;
            starts_ += p.starts ? 1 : 0;
            starts_in_loop_ = starts_in_loop_ || (p.starts && in_loop);
            taken_.insert(p.name.text);
        }
        for (const lang::Transition& t : body.transitions) {
            taken_.insert(t.name.text);
        }
        for (const lang::Data& d : body.data) {
            taken_.insert(d.name.text);
        }
        for (const lang::Event& e : body.events) {
            taken_.insert(e.name.text);
        }
        for (const lang::For& loop : body.loops) {
            collect(loop.body, true);
        }
    }

    void write(lang::Body& body) {
        const auto publish = [](auto& list) {
            for (auto& item : list) {
                item.is_public = true;
            }
        };
        publish(body.places);
        publish(body.transitions);
        publish(body.states);
        publish(body.data);
        publish(body.channels);
        publish(body.events);
        for (lang::Transition& t : body.transitions) {
            edge(t);
        }
        for (lang::For& loop : body.loops) {
            write(loop.body);
        }
    }

    static bool is_state(const lang::Arc& arc) {
        return (arc.kind == lang::ArcKind::kTake || arc.kind == lang::ArcKind::kTakeNow ||
                arc.kind == lang::ArcKind::kGive) &&
               !arc.weight && arc.pattern.empty() && arc.place.steps.size() == 1;
    }

    void edge(lang::Transition& t) {
        if (t.inputs.size() != 1 || t.outputs.size() != 1 || !is_state(t.inputs[0]) ||
            !is_state(t.outputs[0])) {
            teller_.error("machine-transition", t.span,
                          "a transition of a machine leads from one state to one state",
                          "write " + t.name.text +
                              ": FROM -> TO; what other places have is read by `with` or `while`");
            return;
        }
        const lang::Name& from = t.inputs[0].place.steps[0];
        const lang::Name& to = t.outputs[0].place.steps[0];
        for (const lang::Name* name : {&from, &to}) {
            if (states_.count(name->text) == 0) {
                teller_.error("unknown-name", name->span,
                              "there is no state " + name->text + " in this machine",
                              "declare it: state " + name->text);
                return;
            }
        }
        states_[from.text].to.insert(to.text);
        if (t.poll) {
            poll(t);
        }
        const bool same = lang::to_text(t.inputs[0].place) == lang::to_text(t.outputs[0].place);
        if (same && t.inputs[0].kind == lang::ArcKind::kTake) {
            // Stays: what the state does goes on, and that it has not ended does not matter.
            lang::Arc stays = std::move(t.inputs[0]);
            stays.kind = lang::ArcKind::kWhile;
            t.inputs.clear();
            t.outputs.clear();
            t.tests.insert(t.tests.begin(), std::move(stays));
        }
    }

    // One event for each period.
    void poll(lang::Transition& t) {
        if (t.poll.kind == lang::ExprKind::kNumber && t.poll.number.numerator <= 0) {
            teller_.error("zero-time-poll", t.poll.span,
                          "a poll every 0 s asks for ever in no time",
                          "write a longer period: poll every 40 ms");
            return;
        }
        const std::string text = lang::to_text(t.poll);
        auto found = polls_.find(text);
        if (found == polls_.end()) {
            std::string name = "poll";
            for (int k = 2; !taken_.insert(name).second; ++k) {
                name = "poll_" + std::to_string(k);
            }
            lang::Event event;
            event.name = make_name(std::move(name), t.poll.span);
            event.is_public = true;
            event.every = t.poll;
            event.span = t.span;
            found = polls_.emplace(text, std::move(event)).first;
        }
        t.events.push_back(make_path(found->second.name.text, t.poll.span));
    }

    void check() {
        if (starts_ != 1 && !starts_in_loop_) {
            teller_.error(
                "start-state", machine_.name.span,
                starts_ == 0 ? "no state is the first one" : "a machine is in one state at a time",
                "write `starts` behind exactly one state");
        }
        std::set<std::string> entered;
        std::vector<std::string> open;
        for (const auto& [name, state] : states_) {
            if (state.starts && entered.insert(name).second) {
                open.push_back(name);
            }
        }
        while (!open.empty()) {
            const std::string name = std::move(open.back());
            open.pop_back();
            for (const std::string& next : states_[name].to) {
                if (entered.insert(next).second) {
                    open.push_back(next);
                }
            }
        }
        for (const auto& [name, state] : states_) {
            if (starts_ > 0 && entered.count(name) == 0) {
                teller_.warn("never-entered", state.span,
                             "no way leads from the first state to " + name,
                             "add a transition to it, or remove it");
            }
        }
    }

    const lang::Net& machine_;
    Teller teller_;
    Lowered& out_;
    std::map<std::string, State> states_;
    std::map<std::string, lang::Event> polls_;  // by the period as written
    std::set<std::string> taken_;
    int starts_ = 0;
    bool starts_in_loop_ = false;
};

}  // namespace

Lowered lower_machine(const lang::Net& machine, const lang::File& file) {
    Lowered out;
    Machine(machine, file, out).lower();
    return out;
}

}  // namespace puppetri::notation
