// SPDX-License-Identifier: MIT
#include "puppetri/motion/own_movement.h"

#include "puppetri/base/require.h"

namespace puppetri::motion {

OwnMovement::OwnMovement(OwnSignature signature, std::shared_ptr<const MovementMaker> maker)
    : text_(std::move(signature)), maker_(std::move(maker)) {
    PUP_REQUIRE(maker_ != nullptr && !text_.name.empty());
    for (const OwnParameter& p : text_.parameters) {
        parameters_.push_back({.name = p.name,
                               .types = p.types,
                               .default_text = p.default_text,
                               .default_value = p.default_value,
                               .optional = p.optional,
                               .doc = p.doc});
    }
    signature_ = {.name = text_.name,
                  .subject = SubjectKind::kActor,
                  .parameters = parameters_,
                  .limbs = text_.limbs,
                  .as_argument = text_.as_argument,
                  .doc = text_.doc};
    const BoundCall plain{.movement = text_.name};
    const DurationRange range = maker_->declared(Arguments(plain, signature_));
    signature_.shortest = range.shortest;
    signature_.longest = range.longest;
}

const MovementSignature& signature_of(const BoundCall& call, SubjectKind subject) {
    if (call.own != nullptr) {
        return call.own->signature();
    }
    const MovementSignature* signature = find_movement(call.movement, subject);
    PUP_REQUIRE(signature != nullptr);
    return *signature;
}

}  // namespace puppetri::motion
