// SPDX-License-Identifier: MIT
#include "puppetri/verdict/run_watch.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/require.h"

namespace puppetri::verdict {

using net::Formula;
using net::FormulaOp;

struct AtomReader::Data {
    struct Reader final : Code::Reader {
        const run::Player* player = nullptr;
        Value read(std::uint32_t kind, std::uint32_t index) const override {
            switch (static_cast<net::SlotKind>(kind)) {
                case net::SlotKind::kDatum:
                    return player->datum(net::DatumIndex{index});
                case net::SlotKind::kCount:
                    return player->tokens(net::PlaceIndex{index});
                case net::SlotKind::kReady:
                    return player->ready_tokens(net::PlaceIndex{index});
                default:
                    return 0;
            }
        }
    };
    std::vector<Formula> formulas;
    std::vector<std::vector<ProgramIndex>> programs;  // per formula and expression
    Code code;
};

AtomReader::AtomReader(const net::Net&, std::span<const Formula> formulas)
    : data_(std::make_unique<Data>()) {
    data_->formulas.assign(formulas.begin(), formulas.end());
    for (const Formula& f : formulas) {
        std::vector<ProgramIndex> programs;
        for (const Expr& e : f.expressions) {
            auto program = data_->code.add(e);
            programs.push_back(program ? *program : ProgramIndex{});
        }
        data_->programs.push_back(std::move(programs));
    }
}
AtomReader::~AtomReader() = default;
AtomReader::AtomReader(AtomReader&&) noexcept = default;

Truth AtomReader::read(const run::Player& player, std::uint32_t number) const {
    const Formula& f = data_->formulas[number];
    Data::Reader reader;
    reader.player = &player;
    std::vector<Truth> t(f.nodes.size());
    for (std::size_t i = 0; i < f.nodes.size(); ++i) {
        const Formula::Node& n = f.nodes[i];
        switch (n.op) {
            case FormulaOp::kConstant:
                t[i] = Truth::of(n.count != 0);
                break;
            case FormulaOp::kMarked:
                t[i] = Truth::of(player.tokens(net::PlaceIndex{n.index}) >= n.count);
                break;
            case FormulaOp::kReady:
                t[i] = Truth::of(player.ready_tokens(net::PlaceIndex{n.index}) >= n.count);
                break;
            case FormulaOp::kFireable:
                t[i] = Truth::of(player.fireable(net::TransitionIndex{n.index}));
                break;
            case FormulaOp::kExpr: {
                const ProgramIndex program = data_->programs[number][n.index];
                if (!program.valid()) {
                    t[i] = {true, false};
                    break;
                }
                const Evaluated e = data_->code.evaluate(program, reader);
                t[i] = e.fault == EvalFault::kNone ? Truth::of(e.value != 0) : Truth{true, false};
                break;
            }
            case FormulaOp::kNot:
                t[i] = {!t[n.a].must, !t[n.a].may};
                break;
            case FormulaOp::kAnd:
                t[i] = {t[n.a].may && t[n.b].may, t[n.a].must && t[n.b].must};
                break;
            case FormulaOp::kOr:
                t[i] = {t[n.a].may || t[n.b].may, t[n.a].must || t[n.b].must};
                break;
            case FormulaOp::kImplies:
                t[i] = {!t[n.a].must || t[n.b].may, !t[n.a].may || t[n.b].must};
                break;
            case FormulaOp::kIff: {
                const Truth a = t[n.a], b = t[n.b];
                t[i] = {(a.may && b.may) || (!a.must && !b.must),
                        (a.must && b.must) || (!a.may && !b.may)};
                break;
            }
            default:
                t[i] = {true, false};
                break;
        }
    }
    return t.empty() ? Truth{} : t.back();
}

void AtomReader::read(const run::Player& player, std::vector<std::uint64_t>& may,
                      std::vector<std::uint64_t>& must) const {
    const std::size_t words = (data_->formulas.size() + 63) / 64;
    may.assign(words, 0);
    must.assign(words, 0);
    for (std::uint32_t i = 0; i < data_->formulas.size(); ++i) {
        const Truth t = read(player, i);
        may[i / 64] |= std::uint64_t{t.may ? 1u : 0u} << (i % 64);
        must[i / 64] |= std::uint64_t{t.must ? 1u : 0u} << (i % 64);
    }
}

RunWatch::RunWatch(const Obligation& obligation, const AtomReader& reader,
                   const run::Player& player)
    : o_(obligation), reader_(reader), player_(player) {
    if (Monitor::watches(o_.kind) && (o_.kind != net::RuleKind::kBounded || !o_.operands.empty())) {
        monitor_.emplace(o_);
        states_ = {monitor_->start()};
    }
}

RunWatch::Says RunWatch::begin() {
    reader_.read(player_, may_, must_);
    before_may_ = may_;
    before_must_ = must_;
    if (o_.when_settled) {
        defer(Operand::kNoFiring, true);
        return Says::kGood;
    }
    return moment(Operand::kNoFiring, true, player_.now());
}

// Whether time passes after a moment is known only when it has passed.
void RunWatch::defer(std::uint32_t label, bool start) {
    deferred_ = true;
    deferred_label_ = label;
    deferred_start_ = start;
    deferred_at_ = player_.now();
}
RunWatch::Says RunWatch::time_passes() {
    if (!deferred_) {
        return Says::kGood;
    }
    deferred_ = false;
    reader_.read(player_, may_, must_);  // occurrences may have changed it since the firing
    return moment(deferred_label_, deferred_start_, deferred_at_);
}

RunWatch::Says RunWatch::occurred(std::span<const std::uint32_t> events) {
    for (const std::uint32_t e : events) {
        if (o_.when_settled) {
            break;
        }
        const Says says = moment(0x80000000u | e, false, player_.now());
        if (says != Says::kGood) {
            return says;
        }
    }
    return Says::kGood;
}

RunWatch::Says RunWatch::fired(std::span<const std::uint32_t> events) {
    const Says overdue = late(player_.now());
    if (overdue == Says::kBroken) {
        return overdue;
    }
    if (o_.when_settled) {
        before_may_ = may_;
        before_must_ = must_;
        reader_.read(player_, may_, must_);
        defer(player_.last().value, false);
        return Says::kGood;
    }
    before_may_ = may_;
    before_must_ = must_;
    const Says says = occurred(events);
    if (says != Says::kGood) {
        return says;
    }
    reader_.read(player_, may_, must_);
    return moment(player_.last().value, false, player_.now());
}

RunWatch::Says RunWatch::late(SimTime now) const {
    return owes_since_ && o_.within && *o_.within < now - *owes_since_ ? Says::kBroken
                                                                       : Says::kGood;
}

RunWatch::Says RunWatch::ended(SimTime now, bool rests) {
    const Says settled = time_passes();
    if (settled != Says::kGood) {
        return settled;
    }
    if (rests && owes_since_) {
        return Says::kBroken;
    }
    return late(now);
}

std::optional<SimTime> RunWatch::owes_since() const { return owes_since_; }

RunWatch::Says RunWatch::moment(std::uint32_t label, bool start, SimTime now) {
    if (!monitor_) {
        return Says::kGood;
    }
    const Moment m{.before = {before_may_.data(), before_must_.data()},
                   .now = {may_.data(), must_.data()},
                   .label = label,
                   .settled = true,  // if that matters, it was waited for
                   .start = start};
    std::vector<std::uint32_t> all;
    bool broken = false, good = false;
    for (const std::uint32_t s : states_) {
        monitor_->step(s, m, next_);
        for (const std::uint32_t to : next_) {
            if (to == Monitor::kBad) {
                broken = true;
            } else {
                good = true;
                if (std::find(all.begin(), all.end(), to) == all.end()) {
                    all.push_back(to);
                }
            }
        }
    }
    // A monitor without memory says both "broken" and how it would go on.
    const bool surely = !o_.about_figures;
    if (broken) {
        if (surely || !good) {
            return Says::kBroken;
        }
        states_ = std::move(all);
        return Says::kMaybe;
    }
    states_ = std::move(all);
    const bool owes =
        !states_.empty() && std::all_of(states_.begin(), states_.end(),
                                        [&](std::uint32_t s) { return monitor_->owes(s); });
    if (!owes) {
        owes_since_.reset();
    } else if (!owes_since_) {
        owes_since_ = now;
    }
    return Says::kGood;
}

}  // namespace puppetri::verdict
