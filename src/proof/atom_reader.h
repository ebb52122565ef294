// SPDX-License-Identifier: MIT
// State formulas, read from an engine that stands in the state. What a state cannot know, because
// only a host or a firing could say it, may hold and need not.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/expr.h"
#include "puppetri/net/engine.h"
#include "puppetri/net/formula.h"

namespace puppetri::proof {

class AtomReader final : private Code::Reader {
 public:
    // `trouble` gets what is no state formula.
    AtomReader(const net::Net& net, std::span<const net::Formula> atoms,
               std::vector<std::string>& trouble);

    std::uint32_t count() const { return static_cast<std::uint32_t>(formulas_.size()); }
    std::uint32_t words() const { return (count() + 63) / 64; }
    // Appends a row of words() each.
    void read(const net::Engine& engine, std::vector<std::uint64_t>& may,
              std::vector<std::uint64_t>& must);
    bool mentions_event(std::uint32_t e) const;

 private:
    struct Known {
        bool may = false, must = false;
    };
    struct Program {
        std::span<const net::Formula::Node> nodes;
        std::vector<ProgramIndex> expressions;
    };
    Known value(const Program& p, const net::Engine& engine);
    Value read(std::uint32_t kind, std::uint32_t index) const override;

    Code code_;
    std::vector<Program> formulas_;
    std::vector<Known> values_;  // scratch
    const net::State* state_ = nullptr;
};

}  // namespace puppetri::proof
