// SPDX-License-Identifier: MIT
// What a statechart moves: `use "guard.scxml" as head { there: rui.walk() }`. For each state that
// is bound there are three places and four transitions beside the use, of priority 0, so that the
// chart has settled before a figure follows it: the movement begins with the state, is cut with it,
// and where it ends before, the chart's event `ended.STATE` occurs, if it names one.
#include <algorithm>
#include <string>
#include <vector>

#include "foreign_formats.h"
#include "make.h"
#include "puppetri/base/text.h"

namespace puppetri::notation {
namespace {

using lang::ArcKind;
using lang::Path;
using lang::Span;

class Binding {
 public:
    Binding(lang::Body& body, const lang::Use& use, const lang::Argument& state, Span where)
        : body_(body),
          use_(use),
          state_(state),
          where_(where),
          name_(use.name.text + "_" + state.name.text) {}

    void write(bool hears_end) {
        const std::string off = name_ + "_off", over = name_ + "_over";
        give_token(place(off));
        place(name_).does = state_.value;
        place(over);
        lang::Transition& begins = transition("_begins", ArcKind::kTake, off, name_);
        begins.priority = make_number(Rational{-1}, where_);
        begins.tests.push_back(make_arc(ArcKind::kWith, member(state_.name.text)));
        lang::Transition& cut = transition("_cut", ArcKind::kTakeNow, name_, off);
        cut.tests.push_back(make_arc(ArcKind::kUnless, member(state_.name.text)));
        lang::Transition& ends = transition("_ends", ArcKind::kTake, name_, over);
        ends.tests.push_back(make_arc(ArcKind::kWith, member(state_.name.text)));
        if (hears_end) {
            ends.raises.push_back(member("ended." + state_.name.text));
        }
        lang::Transition& left = transition("_left", ArcKind::kTake, over, off);
        left.tests.push_back(make_arc(ArcKind::kUnless, member(state_.name.text)));
    }

 private:
    Path member(std::string name) const {
        return make_path({use_.name, make_name(std::move(name), where_)}, where_);
    }
    // In a loop the use has an index, and so has what stands beside it.
    lang::Name named(std::string text) const { return {std::move(text), use_.name.index, where_}; }
    lang::Place& place(const std::string& name) {
        body_.places.push_back(make_place(named(name)));
        return body_.places.back();
    }
    lang::Transition& transition(const char* what, ArcKind take, const std::string& from,
                                 const std::string& to) {
        lang::Transition t =
            make_transition(named(name_ + what), {}, {make_path({named(to)}, where_)});
        t.inputs.push_back(make_arc(take, make_path({named(from)}, where_)));
        t.priority = make_number(Rational{0}, where_);
        t.span = where_;
        body_.transitions.push_back(std::move(t));
        return body_.transitions.back();
    }

    lang::Body& body_;
    const lang::Use& use_;
    const lang::Argument& state_;
    const Span where_;
    const std::string name_;
};

}  // namespace

void bind_scxml(lang::Body& body, lang::Use& use, const lang::Net& chart, const lang::File& file,
                Diagnostics& diagnostics) {
    std::vector<std::string> states, bound;
    for (const lang::Place& p : chart.body.places) {
        if (p.is_public && p.role == lang::Role::kInner) {
            states.push_back(p.name.text);
        }
    }
    for (const lang::Argument& a : use.args) {
        const auto tell = [&](const char* code, std::string message, std::string remedy) {
            diagnostics.push_back({.code = code,
                                   .where = file.where(a.name.span),
                                   .element = "use of " + use.path,
                                   .message = std::move(message),
                                   .remedy = std::move(remedy)});
        };
        if (std::find(states.begin(), states.end(), a.name.text) == states.end()) {
            const std::string_view nearest = nearest_name(a.name.text, states);
            tell("unknown-name", "the chart has no state " + a.name.text,
                 nearest.empty() ? "write the id of one of its states"
                                 : "did you mean " + std::string(nearest) + "?");
            continue;
        }
        if (std::find(bound.begin(), bound.end(), a.name.text) != bound.end()) {
            tell("name-twice", a.name.text + " is bound already", "remove one of the lines");
            continue;
        }
        bound.push_back(a.name.text);
        const bool hears = std::any_of(
            chart.body.events.begin(), chart.body.events.end(),
            [&](const lang::Event& e) { return e.name.text == "ended." + a.name.text; });
        Binding(body, use, a, a.name.span).write(hears);
    }
    use.args.clear();
}

}  // namespace puppetri::notation
