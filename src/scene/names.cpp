// SPDX-License-Identifier: MIT
// Names: what a path stands for where it stands. The first step is looked up from the inside
// outwards (loop variables, variables of the statement, parameters, members of the net, types and
// cast of the file); each further step is asked of what the steps before it stand for.
#include "elaboration.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

const char* const kPhases[] = {"free", "support", "swing"};
const char* const kHolders[] = {"hands", "left_hand", "right_hand"};
// What movements tell while they run (motion::MovementEvent).
const char* const kMovementEvents[] = {"bite",  "catch",     "foot_off", "foot_strike",
                                       "grasp", "hand_over", "release"};

template <std::size_t N>
bool is_one_of(const char* const (&list)[N], std::string_view name) {
    for (const char* item : list) {
        if (name == item) {
            return true;
        }
    }
    return false;
}

}  // namespace

Term Elaboration::resolve(const lang::Path& path, const Scope& scope) {
    if (path.empty()) {
        return Nothing{};
    }
    std::optional<Term> found;
    const Instance& own = instances_[scope.instance];
    if (path.steps.size() > 1 && own.net != nullptr) {
        // What goes on is about the member that hides a parameter of the same name.
        for (const lang::Parameter& p : own.net->parameters) {
            const auto member = own.members.find(path.steps[0].text);
            if (p.hidden && p.name.text == path.steps[0].text && member != own.members.end()) {
                found = member_term(member->second);
            }
        }
    }
    if (!found) {
        found = resolve_first(path.steps[0], scope);
    }
    if (!found) {
        const std::string& name = path.steps[0].text;
        if (own.net != nullptr && instances_[0].net == nullptr &&
            instances_[0].members.count(name) != 0) {
            error("unknown-name", path.steps[0].span,
                  "net " + own.net->name.text + " does not know " + name +
                      ", which belongs to the scene",
                  "give it to the net as a parameter");
        } else {
            unknown(path.steps[0].span, "name", name, names_in(scope));
        }
        return Nothing{};
    }
    Term term = std::move(*found);
    for (std::size_t i = 1; i < path.steps.size(); ++i) {
        term = resolve_next(term, path.steps[i], scope);
    }
    return term;
}

std::optional<Term> Elaboration::resolve_first(const lang::Name& name, const Scope& scope) {
    for (const LoopBinding* b = scope.loop; b != nullptr; b = b->up) {
        if (b->name == name.text) {
            return b->value;
        }
    }
    if (scope.locals != nullptr) {
        for (std::size_t i = 0; i < scope.locals->names.size(); ++i) {
            if (scope.locals->names[i].name == name.text) {
                return Expr::slot(net::slot(scope.locals->kind, static_cast<std::uint32_t>(i)),
                                  scope.locals->names[i].type);
            }
        }
    }
    const Instance& instance = instances_[scope.instance];
    if (instance.net != nullptr) {
        const auto& parameters = instance.net->parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            if (parameters[i].name.text == name.text) {
                return parameter_value(scope.instance, i);
            }
        }
    }
    const auto member = instance.members.find(name.index.empty() ? name.text : key_of(name, scope));
    if (member != instance.members.end()) {
        return member_term(member->second);
    }
    // Values of enumerations: of this net, then of the file.
    const auto value_of = [&](std::uint32_t enumeration) -> std::optional<Term> {
        const net::EnumDraft& e = draft().enums[enumeration];
        for (std::size_t i = 0; i < e.values.size(); ++i) {
            if (e.values[i] == name.text) {
                return EnumTerm{enumeration, static_cast<std::int64_t>(i)};
            }
        }
        return std::nullopt;
    };
    for (const lang::Enumeration& e : instance.body->enumerations) {
        if (auto value = value_of(enumeration_index(e))) {
            return value;
        }
    }
    const auto& visible = library_.visible[name.span.file];
    if (const auto found = visible.find(name.text);
        found != visible.end() && found->second.enumeration != nullptr) {
        return EnumerationTerm{enumeration_index(*found->second.enumeration)};
    }
    for (const auto& [text, d] : visible) {
        if (d.enumeration != nullptr) {
            if (auto value = value_of(enumeration_index(*d.enumeration))) {
                return value;
            }
        }
    }
    return cast_member(name.text, name.span.file);
}

Term Elaboration::member_term(const Member& member) {
    switch (member.kind) {
        case MemberKind::kPlace:
            return PlaceTerm{{member.index}};
        case MemberKind::kTransition:
            return TransitionTerm{{member.index}};
        case MemberKind::kState:
            return state_formula(member.index);
        case MemberKind::kDatum:
            return DatumTerm{{member.index}};
        case MemberKind::kEvent:
            return EventTerm{{member.index}};
        case MemberKind::kChannel:
            return ChannelTerm{member.index};
        case MemberKind::kInstance:
            return member.index == kNoInstance ? Term{Nothing{}} : Term{InstanceTerm{member.index}};
        case MemberKind::kEnumeration:
            return EnumerationTerm{member.index};
    }
    return Nothing{};
}

Term Elaboration::resolve_next(const Term& before, const lang::Name& name, const Scope& scope) {
    if (is_nothing(before)) {
        return Nothing{};
    }
    std::uint32_t in = kNoInstance;
    if (const auto* instance = std::get_if<InstanceTerm>(&before)) {
        in = instance->instance;
    } else if (const auto* place = std::get_if<PlaceTerm>(&before)) {
        const PlaceElement& element = places_[place->place.value];
        if (!element.node->runs) {
            return EventTerm{movement_event(place->place, name)};
        }
        in = element.runs;
        if (in == kNoInstance) {
            return Nothing{};
        }
    }
    if (in != kNoInstance) {
        const Instance& instance = instances_[in];
        std::vector<std::string> known;
        for (std::size_t i = 0; i < instance.values.size(); ++i) {
            const std::string& parameter = instance.net->parameters[i].name.text;
            if (instance.net->parameters[i].hidden) {
                continue;
            }
            if (parameter == name.text) {
                return parameter_value(in, i);
            }
            known.push_back(parameter);
        }
        const auto member =
            instance.members.find(name.index.empty() ? name.text : key_of(name, scope));
        if (member == instance.members.end()) {
            if (told_continuous(instance, name)) {
                return Nothing{};
            }
            for (const auto& [key, m] : instance.members) {
                known.push_back(key);
            }
            unknown(name.span, "member of " + (instance.path.empty() ? "the scene" : instance.path),
                    name.text, known);
            return Nothing{};
        }
        if (!member->second.is_public && !scope.sees_all && in != scope.instance) {
            error("not-public", name.span,
                  name.text + " belongs to net " + instance.net->name.text + " alone",
                  "write `public` before its declaration there");
            return Nothing{};
        }
        return member_term(member->second);
    }
    if (const auto* actor = std::get_if<ActorTerm>(&before)) {
        if (const auto limb = motion::limb_named(name.text)) {
            return LimbTerm{actor->actor, *limb};
        }
        const std::string& who = scene.play.cast.actors[actor->actor.value].name;
        if (is_one_of(kHolders, name.text)) {
            return HolderTerm{who + "." + name.text};
        }
        std::vector<std::string> known(std::begin(kHolders), std::end(kHolders));
        for (int i = 0; i < motion::kLimbCount; ++i) {
            known.emplace_back(motion::name_of(static_cast<motion::Limb>(i)));
        }
        unknown(name.span, "limb of " + who, name.text, known);
        return Nothing{};
    }
    if (const auto* limb = std::get_if<LimbTerm>(&before)) {
        if (is_one_of(kPhases, name.text)) {
            const std::string subject = scene.play.cast.actors[limb->actor.value].name + "." +
                                        std::string(motion::name_of(limb->limb));
            return net::Formula::host(
                host_atom(net::HostAtom::Kind::kPhase, subject, name.text, name.span));
        }
        unknown(name.span, "phase", name.text, {std::begin(kPhases), std::end(kPhases)});
        return Nothing{};
    }
    if (const auto* prop = std::get_if<PropTerm>(&before)) {
        if (name.text == "holder") {
            return HolderOfTerm{prop->prop};
        }
        unknown(name.span, "property of " + scene.play.cast.props[prop->prop.value].name, name.text,
                {"holder"});
        return Nothing{};
    }
    if (const auto* transition = std::get_if<TransitionTerm>(&before)) {
        const net::TransitionDraft& t = draft().transitions[transition->transition.value];
        if (t.busy.valid() && name.text == "begin") {
            return before;
        }
        if (t.busy.valid() && name.text == "busy") {
            return PlaceTerm{t.busy};
        }
        if (t.busy.valid() && name.text == "end") {
            return TransitionTerm{t.end};
        }
        error("no-member", name.span, t.path + " has no " + name.text,
              "a transition with a holding time (`for 2 s`) has begin, busy and end, others have "
              "nothing inside");
        return Nothing{};
    }
    error("no-member", name.span, describe(before) + " has no " + name.text,
          "remove ." + name.text);
    return Nothing{};
}

std::vector<std::string> Elaboration::names_in(const Scope& scope) {
    std::vector<std::string> names;
    for (const LoopBinding* b = scope.loop; b != nullptr; b = b->up) {
        names.push_back(b->name);
    }
    if (scope.locals != nullptr) {
        for (const net::VariableDraft& v : scope.locals->names) {
            names.push_back(v.name);
        }
    }
    const Instance& instance = instances_[scope.instance];
    if (instance.net != nullptr) {
        for (const lang::Parameter& p : instance.net->parameters) {
            names.push_back(p.name.text);
        }
    }
    for (const auto& [key, member] : instance.members) {
        names.push_back(key);
    }
    for (const lang::CastMember& m : library_.files[instance.file].body.cast) {
        names.push_back(m.name.text);
    }
    for (const net::EnumDraft& e : scene.draft.enums) {
        names.insert(names.end(), e.values.begin(), e.values.end());
    }
    return names;
}

net::HostAtomIndex Elaboration::host_atom(net::HostAtom::Kind kind, std::string subject,
                                          std::string value, lang::Span where) {
    std::vector<net::HostAtom>& atoms = draft().host_atoms;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (atoms[i].kind == kind && atoms[i].subject == subject && atoms[i].value == value) {
            return {static_cast<std::uint32_t>(i)};
        }
    }
    atoms.push_back({kind, std::move(subject), std::move(value), at(where)});
    return {static_cast<std::uint32_t>(atoms.size() - 1)};
}

net::EventIndex Elaboration::movement_event(net::PlaceIndex place, const lang::Name& name) {
    PlaceElement& element = places_[place.value];
    if (!element.node->does) {
        error("no-member", name.span, "place " + element.path + " runs no net and does no movement",
              "only a place with `runs` or `does` has something inside");
    } else if (!is_one_of(kMovementEvents, name.text)) {
        std::vector<std::string> known(std::begin(kMovementEvents), std::end(kMovementEvents));
        const lang::Expr& does = element.node->does;
        if (!does.path.empty()) {
            if (const OwnDefinition* own =
                    own_movement(does.path.steps.back().text, does.span.file)) {
                known.insert(known.end(), own->events.begin(), own->events.end());
            }
        }
        if (std::find(known.begin(), known.end(), name.text) == known.end()) {
            unknown(name.span, "event of a movement", name.text, known);
        }
    }
    for (const stage::RaisedName& raised : element.raises) {
        if (raised.name == name.text) {
            return raised.event;
        }
    }
    const net::EventIndex event{static_cast<std::uint32_t>(draft().events.size())};
    draft().events.push_back({.path = element.path + "." + name.text,
                              .where = at(element.node->span),
                              .outside = false});
    events_.push_back({nullptr, element.scope, draft().events.back().path});
    element.raises.push_back({name.text, event});
    return event;
}

}  // namespace puppetri::scene
