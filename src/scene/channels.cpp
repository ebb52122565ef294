// SPDX-License-Identifier: MIT
// Channels: which transition sends on which and receives from which, what they say, and to which
// machine each end belongs. What meets whom is the kernel's business (net::meet).
#include <algorithm>

#include "elaboration.h"

namespace puppetri::scene {

void Elaboration::declare_channels() {
    channel_types_.assign(channels_.size(), std::nullopt);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        About about(*this, "channel " + channels_[i].path, channels_[i].node->span);
        if (channels_[i].node->type) {
            std::optional<Value> low, high;
            channel_types_[i] =
                value_type(channels_[i].node->type, channels_[i].scope, &low, &high);
        }
    }
}

void Elaboration::complete_channels() {
    for (std::uint32_t i = 0; i < transitions_.size(); ++i) {
        const lang::Transition& node = *transitions_[i].node;
        About about(*this, "transition " + transitions_[i].path, node.span);
        if (!node.send.empty()) {
            complete_send(i);
        } else if (!node.receive.empty()) {
            complete_receive(i);
        }
    }
    find_polls();
}

// Nets that the places of a machine run belong to it.
std::uint32_t Elaboration::machine_of(std::uint32_t instance) const {
    while (instances_[instance].refines.valid() && instances_[instance].up != kNoInstance) {
        instance = instances_[instance].up;
    }
    return instance;
}

const ChannelTerm* Elaboration::channel_of(const lang::Path& path, const Scope& scope, Term& term) {
    term = resolve(path, scope);
    const auto* channel = std::get_if<ChannelTerm>(&term);
    if (channel == nullptr) {
        wrong(path.span, "a channel", term, "declare it: channel " + lang::to_text(path));
    }
    return channel;
}

// An end that is wrong is kept without its message, so that the other side is not blamed.
void Elaboration::complete_send(std::uint32_t index) {
    const lang::Transition& node = *transitions_[index].node;
    Locals locals{.names = draft().transitions[index].variables};
    Scope scope = transitions_[index].scope;
    Term term;
    const ChannelTerm* channel = channel_of(node.send, scope, term);
    if (channel == nullptr) {
        return;
    }
    net::ChannelDraft& draft_channel = draft().channels[channel->channel];
    net::ChannelEnd end{
        .transition = {index}, .owner = machine_of(scope.instance), .where = at(node.send.span)};
    const bool typed = static_cast<bool>(channels_[channel->channel].node->type);
    const std::optional<ValueType> type = channel_types_[channel->channel];
    if (node.message && !typed) {
        error("message-on-signal", node.message.span,
              draft_channel.path + " carries signals without a message",
              "declare what it carries: channel " + draft_channel.path + " of TYPE");
    } else if (!node.message && typed) {
        error("missing-message", node.send.span,
              draft_channel.path + " carries messages, and none is sent",
              "write send " + lang::to_text(node.send) + "!MESSAGE");
    } else if (node.message && type) {
        scope.locals = &locals;
        end.message = expr_of(node.message, scope, *type);
    }
    draft_channel.sends.push_back(std::move(end));
}

void Elaboration::complete_receive(std::uint32_t index) {
    const lang::Transition& node = *transitions_[index].node;
    Locals locals{.names = draft().transitions[index].variables};
    Scope scope = transitions_[index].scope;
    Term term;
    const ChannelTerm* channel = channel_of(node.receive, scope, term);
    if (channel == nullptr) {
        return;
    }
    net::ChannelDraft& draft_channel = draft().channels[channel->channel];
    net::ChannelEnd end{
        .transition = {index}, .owner = machine_of(scope.instance), .where = at(node.receive.span)};
    const bool typed = static_cast<bool>(channels_[channel->channel].node->type);
    const std::optional<ValueType> type = channel_types_[channel->channel];
    if (node.received && !typed) {
        error("message-on-signal", node.received.span,
              draft_channel.path + " carries signals without a message",
              "write receive " + lang::to_text(node.receive) + ", or declare what it carries");
    } else if (node.received && type) {
        const lang::Expr& e = node.received;
        if (e.kind == lang::ExprKind::kPath) {
            const std::optional<Term> first = resolve_first(e.path.steps[0], scope);
            const Term target = first ? resolve(e.path, scope) : Term{};
            if (const auto* datum = std::get_if<DatumTerm>(&target)) {
                const net::DatumDraft& d = draft().data[datum->datum.value];
                if (d.type != *type) {
                    error("wrong-type", e.span,
                          d.path + " is of another type than the messages on " + draft_channel.path,
                          "declare both with one type");
                } else {
                    end.into = datum->datum;
                }
                draft_channel.receives.push_back(std::move(end));
                return;
            }
        }
        scope.locals = &locals;
        end.message = expr_of(e, scope, *type);
    }
    draft_channel.receives.push_back(std::move(end));
}

}  // namespace puppetri::scene
