// SPDX-License-Identifier: MIT
// Reading the arguments of a call against its signature: what is missing takes the default of the
// table. Types were checked when the call was bound; a wrong one here is a bug of the caller.
#pragma once
#include "puppetri/base/require.h"
#include "puppetri/motion/library.h"

namespace puppetri::motion {

class Arguments {
 public:
    // Needs `call` to outlive the object.
    Arguments(const BoundCall& call, const MovementSignature& signature)
        : call_(call), signature_(signature) {}

    const ArgumentValue* find(std::string_view name) const {
        for (const Argument& a : call_.arguments) {
            if (a.parameter == name) {
                return &a.value;
            }
        }
        return nullptr;
    }
    template <class T>
    const T* get(std::string_view name) const {
        const ArgumentValue* value = find(name);
        return value == nullptr ? nullptr : std::get_if<T>(value);
    }
    // A length, an angle, a time or a plain number, in SI units.
    double number(std::string_view name) const {
        if (const double* d = get<double>(name)) {
            return *d;
        }
        if (const std::int64_t* i = get<std::int64_t>(name)) {
            return static_cast<double>(*i);
        }
        if (const SimTime* t = get<SimTime>(name)) {
            return t->seconds();
        }
        return parameter(name).default_value;
    }
    bool flag(std::string_view name) const {
        const bool* b = get<bool>(name);
        return b != nullptr ? *b : parameter(name).default_value != 0;
    }
    Side side(std::string_view name) const {
        const Side* s = get<Side>(name);
        return s != nullptr ? *s : static_cast<Side>(parameter(name).default_value != 0);
    }
    PropIndex prop(std::string_view name) const {
        const PropIndex* p = get<PropIndex>(name);
        return p != nullptr ? *p : PropIndex{};
    }
    // The movement that the arms are left to; null when they are not.
    const BoundCall* nested(std::string_view name) const {
        const NestedCall* n = get<NestedCall>(name);
        if (n == nullptr) {
            return nullptr;
        }
        PUP_REQUIRE(n->index < call_.nested.size());
        return &call_.nested[n->index];
    }

 private:
    const Parameter& parameter(std::string_view name) const {
        for (const Parameter& p : signature_.parameters) {
            if (p.name == name) {
                return p;
            }
        }
        fail_requirement("the signature has the parameter", __FILE__, __LINE__);
    }
    const BoundCall& call_;
    const MovementSignature& signature_;
};

}  // namespace puppetri::motion
