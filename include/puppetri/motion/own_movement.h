// SPDX-License-Identifier: MIT
// Movements that are not of the library: what a scene defines by formula, keyframes or a clip, and
// what a program that embeds Puppetri registers as a callback. To the language, the stage and the
// proofs they are movements like any other: a signature, a declared duration, and somebody who
// makes the Movement when a token arrives. A BoundCall carries its own definition along, so nobody
// looks names up but the scene.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "puppetri/motion/arguments.h"
#include "puppetri/motion/declared_duration.h"
#include "puppetri/motion/prepare.h"

namespace puppetri::motion {

// One call, at the instant when its token arrives.
struct OwnCall {
    const Arguments& arguments;
    const MotionContext& context;
    const Surroundings& around;
    Diagnostics& notes;  // warnings that name the remedy
};

// What makes movements of one name.
class MovementMaker {
 public:
    virtual ~MovementMaker() = default;

    // A movement that starts from the state of the context in position and velocity. With a
    // prescribed duration in the context that is its duration, otherwise one of `declared`.
    virtual MovementPtr make(const OwnCall& call) const = 0;
    // Every `takes auto` of this call lies between these: proofs rely on it.
    virtual DurationRange declared(const Arguments& arguments) const = 0;
};

struct OwnParameter {
    std::string name;
    TypeSet types = {};
    std::string default_text;  // empty: the argument must be given, unless optional
    double default_value = 0;  // in metres, seconds, radians
    bool optional = false;
    std::string doc;
};

// What a definition says; see MovementSignature.
struct OwnSignature {
    std::string name;
    std::vector<OwnParameter> parameters;
    LimbSet limbs = kAllLimbs;  // what it drives
    bool as_argument = false;   // it drives arms alone and may stand after `arms:`
    std::string doc;
};

// A definition: immutable, shared by the calls that were bound to it.
class OwnMovement {
 public:
    OwnMovement(OwnSignature signature, std::shared_ptr<const MovementMaker> maker);
    OwnMovement(const OwnMovement&) = delete;
    OwnMovement& operator=(const OwnMovement&) = delete;

    // shortest and longest there are those of a call without arguments.
    const MovementSignature& signature() const { return signature_; }
    const MovementMaker& maker() const { return *maker_; }

 private:
    OwnSignature text_;
    std::vector<Parameter> parameters_;
    MovementSignature signature_;
    std::shared_ptr<const MovementMaker> maker_;
};

using OwnMovementPtr = std::shared_ptr<const OwnMovement>;

// The signature behind a call: its own definition's, or the library's. Needs a call that was bound.
const MovementSignature& signature_of(const BoundCall& call, SubjectKind subject);

}  // namespace puppetri::motion
