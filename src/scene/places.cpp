// SPDX-License-Identifier: MIT
// Places: durations, disciplines, tokens, the movement they do, the net they run, the place they
// are.
#include "elaboration.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

std::optional<net::PlaceIndex> Elaboration::place_of(const lang::Path& path, const Scope& scope) {
    const Term term = resolve(path, scope);
    if (const auto* p = std::get_if<PlaceTerm>(&term)) {
        return p->place;
    }
    wrong(path.span, "a place", term);
    return std::nullopt;
}

void Elaboration::complete_places() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        About about(*this, "place " + places_[i].path, places_[i].node->span);
        complete_place(i);
        complete_tokens(i);
    }
    // Aliases, when all places are complete: what is not said follows the place itself.
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const PlaceElement& place = places_[i];
        const lang::Place& node = *place.node;
        if (node.same_as.empty()) {
            continue;
        }
        About about(*this, "place " + place.path, node.span);
        std::set<std::uint32_t> ring;
        std::size_t end = i;
        while (!places_[end].node->same_as.empty()) {
            if (!ring.insert(static_cast<std::uint32_t>(end)).second) {
                error("place-cycle", node.same_as.span,
                      "these places are each other, and none is a place of its own",
                      "remove `is` from one of them");
                break;
            }
            const auto next = place_of(places_[end].node->same_as, places_[end].scope);
            if (!next) {
                break;
            }
            end = next->value;
        }
        if (end == i || !places_[end].node->same_as.empty()) {
            continue;
        }
        net::PlaceDraft& out = draft().places[i];
        const net::PlaceDraft& itself = draft().places[end];
        if (node.takes.kind == lang::DurationKind::kDefault) {
            out.duration = itself.duration;
        }
        if (node.discipline == lang::Discipline::kDefault) {
            out.discipline = itself.discipline;
            out.by_arrival = itself.by_arrival;
            out.key = itself.key;
        }
        if (out.attributes.empty()) {
            out.attributes = itself.attributes;
        }
        if (!node.does) {
            out.action = itself.action;
        }
        out.keeps_order = out.keeps_order || itself.keeps_order;
        if (!node.capacity) {
            out.capacity = itself.capacity;
        }
        draft().fusions.push_back(
            {{static_cast<std::uint32_t>(end)}, {static_cast<std::uint32_t>(i)}});
    }
}

void Elaboration::complete_place(std::size_t i) {
    PlaceElement& place = places_[i];
    const lang::Place& node = *place.node;
    Scope scope = place.scope;
    scope.locals = &place.attributes;
    net::PlaceDraft& out = draft().places[i];
    switch (node.takes.kind) {
        case lang::DurationKind::kDefault:
            break;
        case lang::DurationKind::kValue:
            out.duration = duration_of(node.takes.value, scope);
            break;
        case lang::DurationKind::kAuto:
            out.duration =
                net::DurationDraft{.kind = net::DurationKind::kAuto, .where = at(node.takes.span)};
            if (!node.does) {
                error("auto-without-movement", node.takes.span,
                      "auto asks a movement, and this place does none",
                      "write a time, or `does` a movement");
                out.duration.reset();
            }
            break;
        case lang::DurationKind::kOpen:
            out.duration =
                net::DurationDraft{.kind = net::DurationKind::kOpen, .where = at(node.takes.span)};
            break;
        case lang::DurationKind::kAs:
            if (const auto sibling = place_of(node.takes.as, place.scope)) {
                out.duration = net::DurationDraft{.kind = net::DurationKind::kAs,
                                                  .sibling = *sibling,
                                                  .where = at(node.takes.span)};
            }
            break;
    }
    switch (node.discipline) {
        case lang::Discipline::kDefault:
        case lang::Discipline::kOldest:
            break;
        case lang::Discipline::kNewest:
            out.discipline = net::Discipline::kNewest;
            break;
        case lang::Discipline::kAny:
            out.discipline = net::Discipline::kAny;
            break;
        case lang::Discipline::kLeast:
        case lang::Discipline::kMost:
            out.discipline = node.discipline == lang::Discipline::kLeast ? net::Discipline::kLeast
                                                                         : net::Discipline::kMost;
            if (auto key =
                    as_expr(evaluate(node.discipline_key, scope), node.discipline_key.span)) {
                out.key = std::move(*key);
            }
            break;
    }
    out.by_arrival = node.by_arrival;
    out.keeps_order = node.keeps_order;
    if (node.capacity) {
        const auto k = constant_integer(node.capacity, place.scope, "how many a place holds");
        if (k && (*k < 1 || *k > 1'000'000'000)) {
            error("out-of-range", node.capacity.span, "a place holds at least one token",
                  "write 1 or more");
        } else if (k) {
            out.capacity = static_cast<std::uint32_t>(*k);
        }
    }
    if (node.does && node.runs) {
        error("does-and-runs", node.does.span, "a place either does a movement or runs a net",
              "remove one of them");
    } else if (node.does) {
        if (auto call = bind_call(node.does, scope)) {
            place.action = {static_cast<std::uint32_t>(scene.play.actions.size())};
            out.action = place.action;
            scene.play.actions.push_back({.call = std::move(*call),
                                          .place = place.path,
                                          .instance = instances_[place.scope.instance].path,
                                          .where = at(node.does.span)});
        }
    }
}

void Elaboration::complete_tokens(std::size_t i) {
    const PlaceElement& place = places_[i];
    net::PlaceDraft& out = draft().places[i];
    const bool run_by_place = instances_[place.scope.instance].refines.valid();
    if (place.node->role == lang::Role::kStart && run_by_place) {
        return;  // a place that runs the net marks its start itself
    }
    if (place.node->starts && !run_by_place) {
        out.tokens.push_back({.count = 1});
    }
    for (const lang::InitialTokens& group : place.node->tokens) {
        const auto count = group.count
                               ? constant_integer(group.count, place.scope, "the number of tokens")
                               : std::optional<std::int64_t>(1);
        if (!count) {
            continue;
        }
        if (*count < 0 || *count > 1'000'000'000) {
            error("out-of-range", group.span,
                  "a place cannot begin with " + std::to_string(*count) + " tokens",
                  "write 0 or more");
            continue;
        }
        const auto attributes = bind_attributes(group.attributes, {static_cast<std::uint32_t>(i)},
                                                place.scope, group.span);
        if (!attributes || *count == 0) {
            continue;
        }
        net::InitialToken token{.count = static_cast<std::uint32_t>(*count), .ready = group.ready};
        for (std::size_t k = 0; k < attributes->size(); ++k) {
            const Expr& value = (*attributes)[k];
            if (!value.is_literal()) {
                error("not-constant", group.span,
                      "the attributes of a token at the start must be known before the run",
                      "use numbers and parameters only");
                break;
            }
            token.attributes.push_back(value.literal_value());
        }
        out.tokens.push_back(std::move(token));
    }
}

void Elaboration::complete_refinements() {
    std::vector<std::uint32_t> refinement_of(instances_.size(), kNoInstance);  // by instance
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i].runs != kNoInstance) {
            refinement_of[places_[i].runs] = static_cast<std::uint32_t>(draft().refinements.size());
            draft().refinements.push_back(
                {.place = {static_cast<std::uint32_t>(i)}, .where = at(places_[i].node->span)});
        }
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const net::PlaceIndex place{static_cast<std::uint32_t>(i)};
        const std::uint32_t own = places_[i].scope.instance;
        // A place belongs to the activity of every net around it that a place runs.
        for (std::uint32_t k = own; k != kNoInstance; k = instances_[k].up) {
            if (refinement_of[k] == kNoInstance) {
                continue;
            }
            net::RefinementDraft& out = draft().refinements[refinement_of[k]];
            out.inside.push_back(place);
            const lang::Place& node = *places_[i].node;
            if (k == own && (node.role == lang::Role::kStart || node.starts)) {
                out.start.push_back(place);
            } else if (k == own && (node.role == lang::Role::kFinish || node.final)) {
                out.finish.push_back(place);
            }
        }
    }
    for (const net::RefinementDraft& out : draft().refinements) {
        const PlaceElement& place = places_[out.place.value];
        About about(*this, "place " + place.path, place.node->span);
        const lang::Net& inner = *instances_[place.runs].net;
        const std::string net = (inner.is_machine ? "machine " : "net ") + inner.name.text;
        const lang::Block* block = library_.block_of(&inner);
        if (block != nullptr && (out.start.empty() || out.finish.empty())) {
            const std::string& kind = block->kind.text;
            error("no-finish", place.node->runs.span,
                  kind + " " + inner.name.text + " goes on for ever, or has several ways in or out",
                  "let it end, as docs/notations/" + kind + ".md says, and begin and end one way");
            continue;
        }
        if (out.start.empty()) {
            error("no-start", place.node->runs.span, net + " has no way in",
                  inner.is_machine ? "write `starts` behind the state where it begins"
                                   : "write `start place NAME` where it begins");
        }
        if (out.finish.empty()) {
            error("no-finish", place.node->runs.span, net + " has no way out",
                  inner.is_machine ? "write `final` behind the state where it ends"
                                   : "write `finish place NAME` where it ends");
        }
        if (inner.is_machine && out.finish.size() > 1) {
            error("many-finals", place.node->runs.span,
                  net + " has more than one final state, and is in one at a time",
                  "let one of them be final, and lead the others to it");
        }
    }
}

}  // namespace puppetri::scene
