// SPDX-License-Identifier: MIT
// Movements: `does me.throw(ball, to: other.me)` checked against the signature of the library and
// bound to the cast, and movements as values: `arms: carry(ball)`.
#include <algorithm>

#include "elaboration.h"
#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

using motion::MovementSignature;
using motion::ParameterType;
using motion::SubjectKind;

namespace {

std::string with_article(ParameterType type) {
    switch (type) {
        case ParameterType::kInt:
            return "a whole number";
        case ParameterType::kReal:
            return "a number without unit";
        case ParameterType::kBool:
            return "yes or no";
        case ParameterType::kSide:
            return "left or right";
        case ParameterType::kActor:
            return "an actor";
        case ParameterType::kAngle:
            return "an angle";
        default:
            return "a " + std::string(motion::name_of(type));
    }
}

std::string wanted_types(const motion::TypeSet& types) {
    std::string text;
    for (int i = 0; i <= static_cast<int>(ParameterType::kMovement); ++i) {
        if (types.has(static_cast<ParameterType>(i))) {
            text += (text.empty() ? "" : " or ") + with_article(static_cast<ParameterType>(i));
        }
    }
    return text;
}

const char* name_of(SubjectKind kind) {
    return kind == SubjectKind::kActor  ? "an actor"
           : kind == SubjectKind::kLimb ? "a limb"
                                        : "a prop";
}

// A slot that reads an attribute of the token: its number.
std::optional<std::uint32_t> token_attribute(const Term& term) {
    const Expr* e = std::get_if<Expr>(&term);
    if (e == nullptr || e->nodes().size() != 1 || e->nodes()[0].op != ExprOp::kSlot ||
        e->nodes()[0].slot.kind != static_cast<std::uint32_t>(net::SlotKind::kAttribute)) {
        return std::nullopt;
    }
    return e->nodes()[0].slot.index;
}

const motion::Parameter* side_of(const MovementSignature& signature) {
    const auto found = std::find_if(signature.parameters.begin(), signature.parameters.end(),
                                    [](const motion::Parameter& p) { return p.name == "side"; });
    return found == signature.parameters.end() ? nullptr : &*found;
}

bool takes_attribute(const motion::TypeSet& types, ValueKind kind) {
    return (kind == ValueKind::kActor && types.has(ParameterType::kActor)) ||
           (kind == ValueKind::kProp && types.has(ParameterType::kProp)) ||
           (kind == ValueKind::kInt && types.has(ParameterType::kInt)) ||
           (kind == ValueKind::kBool && types.has(ParameterType::kBool));
}

}  // namespace

std::optional<motion::BoundCall> Elaboration::bind_call(const lang::Expr& call,
                                                        const Scope& scope) {
    if (call.kind != lang::ExprKind::kCall && call.kind != lang::ExprKind::kPath) {
        error("wrong-type", call.span, "this is no movement",
              "write WHO.MOVEMENT(ARGUMENTS), such as `me.step(left)`");
        return std::nullopt;
    }
    const lang::Name& name = call.path.steps.back();
    if (call.path.steps.size() < 2) {
        error("no-subject", call.span, "nobody is said to do " + name.text,
              "write who moves: `me." + name.text + "(...)`");
        return std::nullopt;
    }
    lang::Path who = call.path;
    who.steps.pop_back();
    who.span = {who.steps.front().span.begin, who.steps.back().span.end, who.span.file};
    const Term subject = resolve(who, scope);
    motion::BoundCall out;
    out.movement = name.text;
    if (const auto* actor = std::get_if<ActorTerm>(&subject)) {
        out.subject = {.kind = SubjectKind::kActor, .actor = actor->actor};
    } else if (const auto* limb = std::get_if<LimbTerm>(&subject)) {
        out.subject = {.kind = SubjectKind::kLimb, .actor = limb->actor, .limb = limb->limb};
    } else if (const auto* prop = std::get_if<PropTerm>(&subject)) {
        out.subject = {.kind = SubjectKind::kProp, .prop = prop->prop};
    } else {
        wrong(who.span, "an actor, a limb or a prop that moves", subject,
              token_attribute(subject)
                  ? "who moves must be known before the run; pass it as an argument of the movement"
                  : "");
        if (is_nothing(subject)) {
            check_stand_in_call(call, scope);
        }
        return std::nullopt;
    }
    const SubjectKind kind = out.subject.kind;
    if (const MovementTerm* given = given_movement(call, scope)) {
        return done_by(out.subject, given->call, who.span);
    }
    const MovementSignature* signature = motion::find_movement(name.text, kind);
    const OwnDefinition* own =
        signature == nullptr ? own_movement(name.text, call.span.file) : nullptr;
    if (own != nullptr) {
        if (kind != SubjectKind::kActor) {
            error("wrong-subject", who.span,
                  name.text + " is a movement of an actor, and this is " + name_of(kind),
                  "name an actor");
            return std::nullopt;
        }
        if (own->movement == nullptr) {
            return std::nullopt;  // what is wrong with it has been told
        }
        out.own = own->movement;
        const std::size_t before = diagnostics.size();
        bind_arguments(call, own->movement->signature(), scope, out);
        if (diagnostics.size() == before) {
            check_own_call(*own, out, call.span);
        }
        return out;
    }
    if (const MovementSignature* sided = motion::find_movement(name.text, SubjectKind::kActor);
        signature == nullptr && kind == SubjectKind::kLimb && sided != nullptr &&
        side_of(*sided) != nullptr) {
        bind_arguments(call, *sided, scope, out, true);
        const motion::Subject limb = out.subject;
        return done_by(limb, std::move(out), who.span);
    }
    if (signature == nullptr) {
        std::vector<std::string> known = own_movement_names(call.span.file);
        for (const MovementSignature& m : motion::movement_library()) {
            if (m.subject == kind) {
                known.emplace_back(m.name);
            } else if (m.name == name.text) {
                error("wrong-subject", who.span,
                      name.text + " is a movement of " + name_of(m.subject) + ", and this is " +
                          name_of(kind),
                      m.subject == SubjectKind::kLimb
                          ? "name the limb: `me.left_leg." + name.text + "(...)`"
                          : "name another subject");
                return std::nullopt;
            }
        }
        unknown(name.span, std::string("movement of ") + name_of(kind), name.text, known);
        return std::nullopt;
    }
    if (kind != SubjectKind::kProp && !scene.play.cast.actors[out.subject.actor.value].humanoid()) {
        error("wrong-subject", who.span,
              scene.play.cast.actors[out.subject.actor.value].name + " is a creature, and " +
                  name.text + " is a movement of humanoids",
              "give it a movement of its own that poses its joints, or make it a `character`");
        return std::nullopt;
    }
    if (kind == SubjectKind::kLimb && !signature->on_limbs.has(out.subject.limb)) {
        error("wrong-subject", who.span,
              "a " + std::string(motion::name_of(out.subject.limb)) + " cannot " + name.text,
              "choose a limb that this movement is for");
        return std::nullopt;
    }
    bind_arguments(call, *signature, scope, out);
    return out;
}

// A movement that waits for its subject. `ana.left_leg.step()` is `ana.step(left)`: what an actor
// does with one of two limbs may be asked of the limb.
std::optional<motion::BoundCall> Elaboration::done_by(const motion::Subject& subject,
                                                      motion::BoundCall call, lang::Span where) {
    call.subject = subject;
    const bool limb = subject.kind == SubjectKind::kLimb;
    const motion::Parameter* sided = side_of(motion::signature_of(call, SubjectKind::kActor));
    const auto given = std::find_if(call.arguments.begin(), call.arguments.end(),
                                    [](const auto& a) { return a.parameter == "side"; });
    if (subject.kind == SubjectKind::kProp || (limb && sided == nullptr)) {
        error("wrong-subject", where, "this movement is one of an actor", "name an actor");
        return std::nullopt;
    }
    if (limb) {
        const bool left =
            subject.limb == motion::Limb::kLeftLeg || subject.limb == motion::Limb::kLeftArm;
        const motion::Side side = left ? motion::Side::kLeft : motion::Side::kRight;
        if (given == call.arguments.end()) {
            call.arguments.push_back({"side", side});
        } else if (!(given->value == motion::ArgumentValue{side})) {
            error("wrong-subject", where, "this limb is on the other side",
                  "leave `side` out, or name the other limb");
            return std::nullopt;
        }
        call.subject = {.kind = SubjectKind::kActor, .actor = subject.actor};
    } else if (sided != nullptr && sided->default_text.empty() && !sided->optional &&
               given == call.arguments.end()) {
        error("missing-argument", where, call.movement + " needs its side",
              "write it, or name the limb that does it: ana.left_leg");
        return std::nullopt;
    }
    return call;
}

// `does me.greet()` in a net with the parameter `greet: movement`: what was given there.
const MovementTerm* Elaboration::given_movement(const lang::Expr& call, const Scope& scope) {
    const Instance& instance = instances_[scope.instance];
    if (instance.net == nullptr) {
        return nullptr;
    }
    const auto& parameters = instance.net->parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (parameters[i].name.text != call.path.steps.back().text) {
            continue;
        }
        parameter_value(scope.instance, i);
        const auto* movement = std::get_if<MovementTerm>(&instance.values[i].second);
        if (movement != nullptr && !call.args.empty()) {
            error("too-many-arguments", call.args.front().value.span,
                  "the arguments of a movement that is a parameter are given with it",
                  "write `" + parameters[i].name.text + "()` here");
        }
        return movement;
    }
    return nullptr;
}

// In a net that is checked alone nobody moves yet; but the movement's name can be wrong already.
void Elaboration::check_stand_in_call(const lang::Expr& call, const Scope& scope) {
    const std::string& name = call.path.steps.back().text;
    std::vector<std::string> known = own_movement_names(call.span.file);
    const Instance& instance = instances_[scope.instance];
    if (instance.net != nullptr &&
        std::any_of(instance.net->parameters.begin(), instance.net->parameters.end(),
                    [&](const lang::Parameter& p) { return p.name.text == name; })) {
        return;  // whoever uses the net says what it is
    }
    if (const OwnDefinition* own = own_movement(name, call.span.file)) {
        if (own->movement != nullptr) {
            motion::BoundCall ignored;
            bind_arguments(call, own->movement->signature(), scope, ignored);
        }
        return;
    }
    for (const MovementSignature& m : motion::movement_library()) {
        if (m.name == name) {
            motion::BoundCall ignored;
            bind_arguments(call, m, scope, ignored);
            return;
        }
        known.emplace_back(m.name);
    }
    unknown(call.path.steps.back().span, "movement", name, known);
}

void Elaboration::bind_arguments(const lang::Expr& call, const MovementSignature& signature,
                                 const Scope& scope, motion::BoundCall& out, bool side_later) {
    lang::Signature wanted{.name = std::string(signature.name), .parameters = {}};
    for (const motion::Parameter& p : signature.parameters) {
        wanted.parameters.push_back(
            {.name = std::string(p.name),
             .required = p.default_text.empty() && !p.optional && !(side_later && p.name == "side"),
             .wanted = wanted_types(p.types)});
    }
    const lang::MatchedArguments matched = lang::match_arguments(wanted, call.args, call.span);
    for (const lang::CallDefect& d : matched.defects) {
        error(d.code, d.where, d.message, d.remedy);
    }
    for (std::size_t k = 0; k < call.args.size(); ++k) {
        const std::uint32_t i = matched.parameter_of[k];
        if (i == lang::MatchedArguments::kNone) {
            continue;
        }
        if (auto value = bind_argument(call.args[k].value, signature.parameters[i], scope, out)) {
            out.arguments.push_back({wanted.parameters[i].name, std::move(*value)});
        }
    }
}

std::optional<motion::ArgumentValue> Elaboration::bind_argument(const lang::Expr& value,
                                                                const motion::Parameter& parameter,
                                                                const Scope& scope,
                                                                motion::BoundCall& out) {
    using enum ParameterType;
    const motion::TypeSet types = parameter.types;
    // `left` and `right` are words where a side is wanted, whatever else is called so.
    if (types.has(kSide) && value.kind == lang::ExprKind::kPath && value.path.steps.size() == 1) {
        const std::string& word = value.path.steps[0].text;
        if (word == "left" || word == "right") {
            return word == "left" ? motion::Side::kLeft : motion::Side::kRight;
        }
    }
    Term term = evaluate(value, scope);
    if (is_nothing(term)) {
        return std::nullopt;
    }
    if (const auto* word = std::get_if<Word>(&term); word != nullptr && types.has(kSide)) {
        if (word->text == "left" || word->text == "right") {
            return word->text == "left" ? motion::Side::kLeft : motion::Side::kRight;
        }
    }
    if (const auto* x = std::get_if<ActorTerm>(&term); x != nullptr && types.has(kActor)) {
        return x->actor;
    }
    if (const auto* x = std::get_if<PropTerm>(&term); x != nullptr && types.has(kProp)) {
        return x->prop;
    }
    if (const auto* x = std::get_if<SetTerm>(&term); x != nullptr && types.has(kSet)) {
        return x->set;
    }
    if (const auto* x = std::get_if<bool>(&term); x != nullptr && types.has(kBool)) {
        return *x;
    }
    if (const auto* x = std::get_if<PointTerm>(&term);
        x != nullptr && types.has(kPoint) && x->dimension == lang::dimension::kLength) {
        return Vec3{x->at[0], x->at[1], x->at[2]};
    }
    if (auto* x = std::get_if<MovementTerm>(&term); x != nullptr && types.has(kMovement)) {
        if (!motion::signature_of(x->call, SubjectKind::kActor).as_argument) {
            error("wrong-type", value.span,
                  x->call.movement + " moves more than arms and cannot be an argument",
                  "arguments are movements of arms alone, such as carry(ball)");
            return std::nullopt;
        }
        out.nested.push_back(std::move(x->call));
        return motion::NestedCall{static_cast<std::uint32_t>(out.nested.size() - 1)};
    }
    if (const auto attribute = token_attribute(term)) {
        if (takes_attribute(types, std::get<Expr>(term).type().kind)) {
            return motion::TokenAttribute{*attribute};
        }
    }
    if (const auto* d = std::get_if<DatumTerm>(&term)) {
        error("not-constant", value.span,
              "the arguments of a movement are fixed before the run; " +
                  draft().data[d->datum.value].path + " is data",
              "give the token an attribute with this value, and pass the attribute");
        return std::nullopt;
    }
    if (auto* n = std::get_if<Number>(&term)) {
        if (types.has(kTime)) {
            *n = in_time_unit(*n, value.span);
        }
        if (n->is_integer() && types.has(kInt)) {
            return n->exact.numerator;
        }
        if (n->plain() && types.has(kReal)) {
            return n->value;
        }
        if (n->dimension == lang::dimension::kLength && types.has(kLength)) {
            return n->value;
        }
        if (n->dimension == lang::dimension::kAngle && types.has(kAngle)) {
            return n->value;
        }
        if (n->dimension == lang::dimension::kTime && types.has(kTime)) {
            const auto t = ticks(*n, value.span);
            return t ? std::optional<motion::ArgumentValue>(*t) : std::nullopt;
        }
    }
    wrong(value.span, wanted_types(types) + " (" + std::string(parameter.doc) + ")", term,
          types.has(kLength)  ? "write it with a unit such as m"
          : types.has(kTime)  ? "write it with a unit such as s"
          : types.has(kAngle) ? "write it with a unit such as deg"
                              : "");
    return std::nullopt;
}

Term Elaboration::movement_value(const lang::Expr& e, const lang::Path& path, const Scope& scope) {
    MovementTerm out;
    out.call.movement = path.steps[0].text;
    if (const OwnDefinition* own = own_movement(out.call.movement, e.span.file);
        own != nullptr && own->movement != nullptr) {
        out.call.own = own->movement;
    }
    bind_arguments(e, motion::signature_of(out.call, SubjectKind::kActor), scope, out.call, true);
    return out;
}

}  // namespace puppetri::scene
