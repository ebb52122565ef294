// SPDX-License-Identifier: MIT
// The tree of instances: every `use` and every `runs` makes one, every `for` is unrolled, and every
// statement gets its full path and its entry in the draft. Statements are completed later, when all
// names are known.
#include "elaboration.h"
#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

// Nets that instantiate each other twice grow like powers of two.
constexpr std::size_t kMaxInstances = 200'000;
constexpr std::int64_t kMaxLoop = 1'000'000;
constexpr std::size_t kMaxElements = 8'000'000;

std::string text_of_index(const Term& term) {
    if (const Number* n = std::get_if<Number>(&term); n != nullptr && n->is_integer()) {
        return std::to_string(n->exact.numerator);
    }
    return "";
}

}  // namespace

std::string Elaboration::key_of(const lang::Name& name, const Scope& scope) {
    std::string key = name.text;
    for (const lang::Expr& index : name.index) {
        std::string text;
        // An index may be a loop variable over names: `seat[p]`.
        if (index.kind == lang::ExprKind::kPath && index.path.steps.size() == 1) {
            for (const LoopBinding* b = scope.loop; b != nullptr && text.empty(); b = b->up) {
                if (b->name == index.path.steps[0].text) {
                    text = b->text;
                }
            }
        }
        if (text.empty()) {
            const Term value = evaluate(index, scope);
            text = text_of_index(value);
            if (text.empty()) {
                wrong(index.span, "a whole number", value);
                text = "?";
            }
        }
        key += "[" + text + "]";
    }
    return key;
}

std::string Elaboration::path_of(const lang::Name& name, const Scope& scope) {
    const std::string& up = instances_[scope.instance].path;
    const std::string key = key_of(name, scope);
    return up.empty() ? key : up + "." + key;
}

bool Elaboration::add_member(const Scope& scope, const lang::Name& name, Member member) {
    Instance& instance = instances_[scope.instance];
    std::string key = key_of(name, scope);
    if (instance.net != nullptr) {
        for (const lang::Parameter& p : instance.net->parameters) {
            if (p.name.text == key && !p.hidden) {
                error("name-twice", name.span, key + " is a parameter of this net already",
                      "choose another name");
                return false;
            }
        }
    }
    const std::string shown = key;
    if (!instance.members.emplace(std::move(key), member).second) {
        error(
            "name-twice", name.span, "there is already something named " + shown + " here",
            scope.loop != nullptr && name.index.empty()
                ? "in a `for`, give the name an index: " + name.text + "[" + scope.loop->name + "]"
                : "choose another name");
        return false;
    }
    return true;
}

std::optional<Declaration> Elaboration::find_declaration(const lang::Path& path, std::uint32_t file,
                                                         Wanted kind) {
    const auto& visible = library_.visible[file];
    const auto is_wanted = [&](const Declaration& d) {
        return kind == Wanted::kNet ? d.net != nullptr : d.token_type != nullptr;
    };
    if (path.steps.size() == 1) {
        const auto found = visible.find(path.steps[0].text);
        if (found != visible.end()) {
            const Declaration& d = found->second;
            if (is_wanted(d)) {
                return d;
            }
            if (d.net == nullptr && d.enumeration == nullptr && d.token_type == nullptr) {
                return std::nullopt;  // missing, and told already
            }
        }
    }
    std::vector<std::string> known;
    for (const auto& [name, d] : visible) {
        if (is_wanted(d)) {
            known.push_back(name);
        }
    }
    unknown(path.span, kind == Wanted::kNet ? "net" : "token type", lang::to_text(path), known);
    return std::nullopt;
}

std::uint32_t Elaboration::make_instance(const Declaration& net, std::string path, lang::Span where,
                                         Scope scope, const std::vector<lang::Argument>& arguments,
                                         net::PlaceIndex refines) {
    for (std::uint32_t i = scope.instance; i != kNoInstance; i = instances_[i].up) {
        if (instances_[i].net == net.net) {
            std::string ring = net.net->name.text;
            for (std::uint32_t k = scope.instance; k != i; k = instances_[k].up) {
                ring = instances_[k].net->name.text + " contains " + ring;
            }
            error("module-cycle", where,
                  "net " + net.net->name.text + " contains itself: " + net.net->name.text +
                      " contains " + ring,
                  "remove one of these uses; a net that goes on for ever is a loop of transitions");
            return kNoInstance;
        }
    }
    if (instances_.size() >= kMaxInstances) {
        error("net-too-large", where,
              "more than " + std::to_string(kMaxInstances) + " instances of nets",
              "use fewer, or smaller ranges of `for`");
        return kNoInstance;
    }
    used_.insert(key(net.net->span));
    const auto number = static_cast<std::uint32_t>(instances_.size());
    Instance& made = instances_.emplace_back();
    made.net = net.net;
    made.body = &net.net->body;
    made.equations = library_.equations_of(net.net);
    made.file = net.file;
    made.path = std::move(path);
    made.up = scope.instance;
    made.refines = refines;
    made.where = where;
    made.argument_scope = scope;
    match_arguments(made, arguments);
    to_expand_.push_back(number);
    return number;
}

void Elaboration::match_arguments(Instance& instance,
                                  const std::vector<lang::Argument>& arguments) {
    const std::vector<lang::Parameter>& parameters = instance.net->parameters;
    instance.values.assign(parameters.size(), {Instance::Bound::kNo, Nothing{}});
    lang::Signature wanted{.name = "net " + instance.net->name.text, .parameters = {}};
    for (const lang::Parameter& p : parameters) {
        // A net that is tried alone has stand-ins for its parameters.
        const bool required = !p.default_value && !instance.stand_in;
        wanted.parameters.push_back({.name = p.name.text, .required = required, .wanted = {}});
    }
    lang::MatchedArguments matched = lang::match_arguments(wanted, arguments, instance.where);
    for (const lang::CallDefect& d : matched.defects) {
        error(d.code, d.where, d.message, d.remedy);
    }
    instance.arguments = std::move(matched.values);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (instance.arguments[i] == nullptr && wanted.parameters[i].required) {
            instance.values[i].first = Instance::Bound::kYes;  // Nothing
        }
    }
}

void Elaboration::expand(std::uint32_t number) {
    expand_body(*instances_[number].body, {.instance = number});
}

void Elaboration::expand_body(const lang::Body& body, const Scope& scope) {
    if (draft().places.size() + draft().transitions.size() + rules_.size() + questions_.size() +
            measures_.size() >
        kMaxElements) {
        error("net-too-large", statement_,
              "more than " + std::to_string(kMaxElements) + " elements",
              "use smaller ranges of `for`");
        return;
    }
    for (const lang::Enumeration& e : body.enumerations) {
        About about(*this, "enum " + e.name.text, e.span);
        add_member(scope, e.name, {MemberKind::kEnumeration, enumeration_index(e), true});
    }
    for (const lang::Data& d : body.data) {
        const std::string path = path_of(d.name, scope);
        About about(*this, "data " + path, d.span);
        const auto index = static_cast<std::uint32_t>(draft().data.size());
        add_member(scope, d.name, {MemberKind::kDatum, index, d.is_public});
        draft().data.push_back({.path = path, .caption = d.caption.text, .where = at(d.span)});
        data_.push_back({&d, scope, path});
    }
    for (const lang::Event& e : body.events) {
        const std::string path = path_of(e.name, scope);
        About about(*this, "event " + path, e.span);
        const auto index = static_cast<std::uint32_t>(draft().events.size());
        add_member(scope, e.name, {MemberKind::kEvent, index, e.is_public});
        draft().events.push_back({.path = path,
                                  .caption = e.caption.text,
                                  .where = at(e.span),
                                  .consumed = e.is_consumed});
        events_.push_back({&e, scope, path});
    }
    for (const lang::Channel& c : body.channels) {
        const std::string path = path_of(c.name, scope);
        About about(*this, "channel " + path, c.span);
        const auto index = static_cast<std::uint32_t>(draft().channels.size());
        add_member(scope, c.name, {MemberKind::kChannel, index, c.is_public});
        draft().channels.push_back({.path = path, .caption = c.caption.text, .where = at(c.span)});
        channels_.push_back({&c, scope, path});
    }
    for (const lang::Place& p : body.places) {
        const std::string path = path_of(p.name, scope);
        About about(*this, "place " + path, p.span);
        const auto index = static_cast<std::uint32_t>(draft().places.size());
        add_member(scope, p.name, {MemberKind::kPlace, index, p.is_public});
        draft().places.push_back({.path = path, .caption = p.caption.text, .where = at(p.span)});
        PlaceElement& element = places_.emplace_back();
        element.node = &p;
        element.scope = scope;
        element.path = path;
        if (p.runs) {
            const auto net = find_declaration(p.runs.path, p.span.file, Wanted::kNet);
            if (net) {
                element.runs = make_instance(*net, path, p.runs.span, scope, p.runs.args, {index});
            }
        }
    }
    for (const lang::Transition& t : body.transitions) {
        const std::string path = path_of(t.name, scope);
        About about(*this, "transition " + path, t.span);
        const auto index = static_cast<std::uint32_t>(draft().transitions.size());
        add_member(scope, t.name, {MemberKind::kTransition, index, t.is_public});
        draft().transitions.push_back(
            {.path = path, .caption = t.caption.text, .where = at(t.span)});
        transitions_.push_back({&t, scope, path});
        if (t.holding) {
            declare_holding(index);
        }
    }
    for (const lang::State& s : body.states) {
        const std::string path = path_of(s.name, scope);
        About about(*this, "state " + path, s.span);
        const auto index = static_cast<std::uint32_t>(states_.size());
        add_member(scope, s.name, {MemberKind::kState, index, s.is_public});
        StateElement& element = states_.emplace_back();
        element.node = &s;
        element.scope = scope;
        element.path = path;
    }
    for (const lang::Use& u : body.uses) {
        const std::string path = path_of(u.name, scope);
        About about(*this, "use of " + lang::to_text(u.net), u.span);
        const auto net = find_declaration(u.net, u.span.file, Wanted::kNet);
        const std::uint32_t made =
            net ? make_instance(*net, path, u.span, scope, u.args, {}) : kNoInstance;
        add_member(scope, u.name, {MemberKind::kInstance, made, true});
    }
    // A rule in a loop is named with the turn, unless its name has an index.
    const auto path_of_turn = [&](const lang::Name& name) {
        std::string path = path_of(name, scope);
        if (name.index.empty()) {
            std::string suffix;
            for (const LoopBinding* b = scope.loop; b != nullptr; b = b->up) {
                suffix = "." + b->text + suffix;
            }
            path += suffix;
        }
        return path;
    };
    Scope all_seeing = scope;
    all_seeing.sees_all = true;
    for (const lang::Rule& r : body.rules) {
        rules_.push_back({&r, all_seeing, path_of_turn(r.name)});
    }
    for (const lang::Question& q : body.questions) {
        questions_.push_back({&q, all_seeing, path_of_turn(q.name)});
    }
    for (const lang::Measure& m : body.measures) {
        measures_.push_back({&m, all_seeing, path_of_turn(m.name)});
    }
    for (const lang::End& e : body.ends) {
        ends_.push_back({&e, scope, instances_[scope.instance].path});
    }
    for (const lang::EventFile& e : body.event_files) {
        event_files_.emplace_back(&e, scope);
    }
    for (const lang::Block& b : body.blocks) {
        blocks_.emplace_back(&b, all_seeing);
    }
    for (const lang::For& loop : body.loops) {
        to_unroll_.emplace_back(&loop, scope);
    }
}

void Elaboration::unroll(const lang::For& loop, const Scope& scope) {
    About about(*this, "for " + loop.variable.text, loop.span);
    const auto once = [&](Term value, std::string text) {
        const LoopBinding& binding = loop_bindings_.emplace_back(
            LoopBinding{loop.variable.text, std::move(value), std::move(text), scope.loop});
        Scope inner = scope;
        inner.loop = &binding;
        expand_body(loop.body, inner);
    };
    Scope seeing = scope;  // the loop may be over anything that a rule in it may speak of
    seeing.sees_all = true;
    const lang::Expr& domain = loop.domain;
    if (domain.kind == lang::ExprKind::kRange) {
        const auto low = constant_integer(domain.args[0].value, seeing, "the range of a `for`");
        const auto high = constant_integer(domain.args[1].value, seeing, "the range of a `for`");
        if (!low || !high) {
            return;
        }
        if (*high - *low >= kMaxLoop) {
            error("net-too-large", domain.span,
                  "a `for` of more than " + std::to_string(kMaxLoop) + " turns",
                  "use a smaller range");
            return;
        }
        for (std::int64_t i = *low; i <= *high; ++i) {
            once(Number::whole(i), std::to_string(i));
        }
        return;
    }
    std::vector<const lang::Expr*> items;
    if (domain.kind == lang::ExprKind::kTuple || domain.kind == lang::ExprKind::kList) {
        for (const lang::Argument& a : domain.args) {
            items.push_back(&a.value);
        }
    } else {
        items.push_back(&domain);
    }
    for (const lang::Expr* item : items) {
        Term value = evaluate(*item, seeing);
        if (const auto* all = std::get_if<EnumerationTerm>(&value)) {
            const net::EnumDraft e = draft().enums[all->enumeration];
            for (std::size_t i = 0; i < e.values.size(); ++i) {
                once(EnumTerm{all->enumeration, static_cast<std::int64_t>(i)}, e.values[i]);
            }
            continue;
        }
        once(std::move(value), lang::to_text(*item));
    }
}

// `for d` makes t.begin -> t.busy -> t.end: the last two get their entries now, so that they can be
// named; lower() fills them.
void Elaboration::declare_holding(std::uint32_t index) {
    static const lang::Place kBusy{};
    static const lang::Transition kEnd{};
    const Scope scope = transitions_[index].scope;
    const std::string path = transitions_[index].path;
    const SourceSpan where = draft().transitions[index].where;
    draft().transitions[index].busy = {static_cast<std::uint32_t>(draft().places.size())};
    draft().transitions[index].end = {static_cast<std::uint32_t>(draft().transitions.size())};
    draft().places.push_back({.path = path + ".busy", .where = where});
    PlaceElement& busy = places_.emplace_back();
    busy.node = &kBusy;
    busy.scope = scope;
    busy.path = path + ".busy";
    draft().transitions.push_back({.path = path + ".end", .where = where});
    transitions_.push_back({&kEnd, scope, path + ".end"});
}

std::uint32_t Elaboration::enumeration_index(const lang::Enumeration& e) {
    const auto [found, made] =
        enumerations_.emplace(key(e.span), static_cast<std::uint32_t>(draft().enums.size()));
    if (made) {
        net::EnumDraft& out = draft().enums.emplace_back();
        out.name = e.name.text;
        for (const lang::Name& value : e.values) {
            out.values.push_back(value.text);
        }
    }
    return found->second;
}

void Elaboration::instantiate() {
    std::size_t expanded = 0, unrolled = 0;
    while (expanded < to_expand_.size() || unrolled < to_unroll_.size()) {
        if (expanded < to_expand_.size()) {
            expand(to_expand_[expanded++]);
        } else {
            const auto [loop, scope] = to_unroll_[unrolled++];
            unroll(*loop, scope);
        }
    }
}

}  // namespace puppetri::scene
