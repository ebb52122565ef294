// SPDX-License-Identifier: MIT
// Typed signatures of everything that is called by name with arguments: movements, distributions,
// nets, kinds of cast. Who knows them (the scene, the movement library) hands them in as data;
// checking and the remedies come from here, so that every wrong call of the language is told in the
// same words.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"
#include "puppetri/lang/units.h"

namespace puppetri::lang {

// What a parameter takes. Quantities have a dimension; things of the scene (actor, prop, place,
// event, movement, net, and the name of a net for its instances) are checked by a Resolver.
enum class TypeKind : std::uint8_t {
    kNumber,
    kInteger,
    kBool,
    kQuantity,
    kPoint,
    kText,
    kWord,
    kThing,
    kAny
};

struct Type {
    TypeKind kind = TypeKind::kAny;
    Dimension dimension;             // of kQuantity and kPoint (three of them)
    std::string thing;               // of kThing: "actor", "prop", "movement"
    std::vector<std::string> words;  // of kWord: the choices ("left", "right")
    bool operator==(const Type&) const = default;
};

struct ParameterSignature {
    std::string name;
    Type type;
    bool required = false;
    std::string default_text;  // for messages, completion and documents
};

struct Signature {
    std::string name;  // "throw"
    std::vector<ParameterSignature> parameters;
    std::string summary;    // one sentence for completion and documents
    bool variadic = false;  // the last parameter may be given any number of times
};

// Answers what a name stands for where a call is checked. Nobody else knows the scene.
class Resolver {
 public:
    virtual ~Resolver() = default;
    // The type of the value of a path; nullopt when there is no such name.
    virtual std::optional<Type> type_of(const Path& path) const = 0;
    // The signature of a call used as a value: `carry(ball)`; nullptr when there is none.
    virtual const Signature* signature_of(const Path& callee) const = 0;
    // Names that could have been meant, for remedies.
    virtual std::vector<std::string> names_near(const Path& path) const = 0;
};

// The argument given for each parameter, by position in the signature; nullptr: the default.
struct BoundArguments {
    std::vector<const Expr*> values;
    std::vector<const Expr*> rest;  // further ones of a variadic signature
};

// Matches positional and named arguments with parameters, and values with types.
// Fails   with all of: unknown-argument (nearest name), repeated-argument, missing-argument,
// too-many-arguments,
//         wrong-type, wrong-unit, unknown-name. `element` is what the caller is about: "place
//         a.throwing".
Checked<BoundArguments> check_call(const File& file, const Expr& call, const Signature& signature,
                                   const Resolver& resolver, const std::string& element);

// One value against one type; appends what is wrong. True when nothing is.
bool check_value(const File& file, const Expr& value, const Type& type, const Resolver& resolver,
                 const std::string& element, Diagnostics& out);

// "a time", "an actor", "one of left, right".
std::string to_text(const Type& type);

// `unknown` with the remedy "did you mean X?", or the list of what there is when nothing is near.
Diagnostic unknown_name(SourceSpan where, std::string_view kind, std::string_view unknown,
                        std::span<const std::string> known, std::string element);

}  // namespace puppetri::lang
