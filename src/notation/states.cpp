// SPDX-License-Identifier: MIT
#include "states.h"

#include "make.h"

namespace puppetri::notation {

std::vector<bool> reachable(const std::vector<std::vector<std::size_t>>& next,
                            std::vector<std::size_t> begins) {
    std::vector<bool> seen(next.size(), false);
    while (!begins.empty()) {
        const std::size_t i = begins.back();
        begins.pop_back();
        if (!seen[i]) {
            seen[i] = true;
            begins.insert(begins.end(), next[i].begin(), next[i].end());
        }
    }
    return seen;
}

lang::Place States::begin(Line& line) {
    lang::Place place = make_place(line.name().steps[0]);
    place.span = line.span();
    place.caption = line.caption();
    place.is_public = true;
    return place;
}

bool States::add(lang::Place place) {
    if (!numbers_.emplace(place.name.text, places_.size()).second) {
        teller_.error("name-twice", place.span, "there is already a state " + place.name.text,
                      "choose another name");
        return false;
    }
    places_.push_back(body_.places.size());
    next_.emplace_back();
    body_.places.push_back(std::move(place));
    return true;
}

std::optional<std::size_t> States::find(const lang::Path& path) {
    const auto found = path.steps.size() == 1 ? numbers_.find(path.steps[0].text) : numbers_.end();
    if (found == numbers_.end()) {
        const std::string name = lang::to_text(path);
        teller_.error("unknown-name", path.span, "there is no state " + name + " in " + whole_,
                      "give it a line of its own: " + name + form_);
        return std::nullopt;
    }
    return found->second;
}

std::optional<States::Edge> States::edge(Line& line) {
    line.symbol("->");
    const lang::Path* to = line.path("the name of a state");
    if (to == nullptr) {
        return std::nullopt;
    }
    const auto before = find(line.name()), after = find(*to);
    if (!before || !after) {
        return std::nullopt;
    }
    next_[*before].push_back(*after);
    Edge made{.from = *before, .to = *after, .transition = {}};
    made.transition = make_transition(
        make_name(line.name().steps[0].text + "_to_" + to->steps[0].text, line.span()),
        {line.name()}, {*to});
    made.transition.span = line.span();
    made.transition.is_public = true;
    return made;
}

void States::end(std::size_t state) {
    ends_.push_back(state);
    lang::End end;
    end.formulas.push_back(make_reference(place(state).name.text, place(state).span));
    end.span = place(state).span;
    body_.ends.push_back(std::move(end));
}

void States::make_ways() {
    if (begins_.size() == 1) {
        place(begins_[0]).role = lang::Role::kStart;
    }
    if (ends_.size() == 1 && (begins_.size() != 1 || ends_ != begins_)) {
        place(ends_[0]).role = lang::Role::kFinish;
    }
}

void States::check() {
    const std::vector<bool> entered = reachable(next_, begins_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const std::string& name = place(i).name.text;
        if (!begins_.empty() && !entered[i]) {
            teller_.warn("never-entered", place(i).span,
                         "no way leads from the first state to " + name,
                         "add a line: ... -> " + name + ", or remove it");
        }
    }
}

}  // namespace puppetri::notation
