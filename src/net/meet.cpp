// SPDX-License-Identifier: MIT
// What meets becomes one transition: the lists of a rendezvous each become one, and every send of a
// channel becomes one with every receive of another owner that takes its message. The product of
// two transitions is the union of their arcs, the conjunction of their guards, all their
// assignments at once and the higher priority (Hoare, Communicating Sequential Processes;
// distributed assignment as in Ostroff, Temporal Logic for Real-Time Systems, as Camargo cites it).
#include "check.h"
#include "classes.h"
#include "lower.h"
#include "puppetri/net/net.h"
#include "puppetri/net/visit.h"

namespace puppetri::net {
namespace {

class Meeting {
 public:
    Meeting(NetDraft& net, Diagnostics& defects) : net_(net), defects_(defects) {}

    Met run() {
        std::vector<Meets> meetings = all_meetings();
        const std::vector<std::uint32_t> first = join_lists();
        const std::vector<std::vector<std::uint32_t>> second = join_channels();
        Met out;
        out.products.reserve(first.size());
        for (const std::uint32_t t : first) {
            out.products.push_back(second.empty() ? std::vector<std::uint32_t>{t} : second[t]);
        }
        for (Meets& m : meetings) {
            m.products = out.products[m.transition];
        }
        warn_of_dead_meetings(net_, meetings, defects_);
        return out;
    }

 private:
    // The first of each rendezvous, and the ends of channels that send.
    std::vector<Meets> all_meetings() const {
        std::vector<Meets> out;
        std::uint32_t group = 0;
        const auto add = [&](TransitionIndex t, const SourceSpan& where) {
            out.push_back({t.value, net_.transitions[t.value].path, where, group, {}});
        };
        for (const auto& list : net_.rendezvous) {
            if (list.size() > 1) {
                ++group;
                add(list.front(), net_.transitions[list.front().value].where);
            }
        }
        for (const ChannelDraft& channel : net_.channels) {
            ++group;
            for (const ChannelEnd& end : channel.sends) {
                add(end.transition, end.where);
            }
        }
        return out;
    }

    std::vector<std::uint32_t> join_lists() {
        const auto root = classes(net_.rendezvous, net_.transitions.size());
        for (std::uint32_t i = 0; i < root.size(); ++i) {
            if (root[i] != i) {
                TransitionDraft& keep = net_.transitions[root[i]];
                shift_moments(i, keep.variables.size());
                merge(keep, std::move(net_.transitions[i]));
            }
        }
        std::vector<std::uint32_t> map = compact(net_.transitions, root);
        each_transition_mention(net_, [&](std::uint32_t& t) { t = map[t]; });
        net_.rendezvous.clear();
        return map;
    }

    // By transition before: what it became. Empty when there are no channels.
    std::vector<std::vector<std::uint32_t>> join_channels() {
        if (net_.channels.empty()) {
            return {};
        }
        const auto count = static_cast<std::uint32_t>(net_.transitions.size());
        std::vector<bool> ends(count, false);
        std::vector<std::vector<TransitionDraft>> made(count);    // by send
        std::vector<std::vector<std::uint32_t>> partners(count);  // parallel to `made`
        for (const ChannelDraft& channel : net_.channels) {
            note_ends(channel, ends);
        }
        for (const ChannelDraft& channel : net_.channels) {
            join(channel, made, partners);
        }
        std::vector<std::vector<std::uint32_t>> products(count);
        std::vector<TransitionDraft> list;
        for (std::uint32_t t = 0; t < count; ++t) {
            if (!ends[t]) {
                products[t].push_back(static_cast<std::uint32_t>(list.size()));
                list.push_back(net_.transitions[t]);
                continue;
            }
            for (std::size_t k = 0; k < made[t].size(); ++k) {
                const auto product = static_cast<std::uint32_t>(list.size());
                products[t].push_back(product);
                products[partners[t][k]].push_back(product);
                list.push_back(std::move(made[t][k]));
            }
        }
        std::vector<std::string> paths;
        for (TransitionDraft& t : net_.transitions) {
            paths.push_back(std::move(t.path));
        }
        net_.transitions = std::move(list);
        net_.channels.clear();
        rename(products, paths);
        return products;
    }

    void note_ends(const ChannelDraft& channel, std::vector<bool>& ends) {
        for (const auto* list : {&channel.sends, &channel.receives}) {
            for (const ChannelEnd& end : *list) {
                if (ends[end.transition.value]) {
                    report(defects_, "two-channel-ends", end.where, name(end),
                           "speaks on a channel twice in one firing",
                           "use two transitions, with a place between them");
                }
                ends[end.transition.value] = true;
                const TransitionDraft& t = net_.transitions[end.transition.value];
                if (t.busy.valid()) {  // there is one t.busy, and there may be many products
                    report(defects_, "holding-on-channel", end.where, name(end),
                           "has a holding time, and speaks on a channel",
                           "let it lead to a place that lasts so long");
                }
            }
        }
    }

    std::string name(const ChannelEnd& end) const {
        return "transition " + net_.transitions[end.transition.value].path;
    }

    static bool differ(const std::optional<Expr>& sent, const std::optional<Expr>& wanted) {
        return sent && wanted && sent->is_literal() && wanted->is_literal() && *sent != *wanted;
    }

    // Every pair that can meet; tells what never does.
    void join(const ChannelDraft& channel, std::vector<std::vector<TransitionDraft>>& made,
              std::vector<std::vector<std::uint32_t>>& partners) {
        const std::string element = "channel " + channel.path;
        if (one_to_one(channel, channel.sends, "two-senders", "send") &&
            one_to_one(channel, channel.receives, "two-receivers", "receive") &&
            !channel.sends.empty() && !channel.receives.empty() &&
            channel.sends.front().owner == channel.receives.front().owner) {
            report(defects_, "channel-within", channel.receives.front().where,
                   name(channel.receives.front()),
                   "receives from its own machine, and there is no channel inside of a machine",
                   "give one end of " + channel.path + " to another machine");
            return;
        }
        const auto lonely = [&](const std::vector<ChannelEnd>& here,
                                const std::vector<ChannelEnd>& there, const char* what,
                                const char* remedy) {
            if (!here.empty() && there.empty()) {
                report(defects_, "unmatched-channel-end", here.front().where, name(here.front()),
                       "nobody " + std::string(what) + " channel " + channel.path, remedy);
            }
        };
        lonely(channel.sends, channel.receives, "receives from",
               "let another machine `receive` from it, or remove this `send`");
        lonely(channel.receives, channel.sends, "sends on",
               "let another machine `send` on it, or remove this `receive`");
        if (channel.sends.empty() && channel.receives.empty()) {
            report(defects_, "unmatched-channel-end", channel.where, element,
                   "nobody sends on it and nobody receives from it",
                   "give it to two machines, or remove it", Severity::kWarning);
        }
        std::vector<bool> said(channel.sends.size(), false);
        std::vector<bool> heard(channel.receives.size(), false);
        bool any = false;
        for (std::size_t s = 0; s < channel.sends.size(); ++s) {
            const ChannelEnd& send = channel.sends[s];
            for (std::size_t r = 0; r < channel.receives.size(); ++r) {
                const ChannelEnd& receive = channel.receives[r];
                if (send.owner == receive.owner || differ(send.message, receive.message)) {
                    continue;
                }
                std::optional<TransitionDraft> product = meet(send, receive);
                if (!product) {
                    continue;
                }
                any = said[s] = heard[r] = true;
                made[send.transition.value].push_back(std::move(*product));
                partners[send.transition.value].push_back(receive.transition.value);
            }
        }
        // Where the channel works otherwise, it is a word that this machine knows and the other one
        // does not use.
        const Severity severity = any ? Severity::kNote : Severity::kWarning;
        for (std::size_t s = 0; s < said.size(); ++s) {
            never(said[s], channel, channel.receives, channel.sends[s], severity,
                  "no receive takes the message of this send");
        }
        for (std::size_t r = 0; r < heard.size(); ++r) {
            never(heard[r], channel, channel.sends, channel.receives[r], severity,
                  "no send has the message of this receive");
        }
    }

    void never(bool met, const ChannelDraft& channel, const std::vector<ChannelEnd>& others,
               const ChannelEnd& end, Severity severity, const char* message) {
        if (!met && !others.empty()) {
            report(defects_, "rendezvous-never", end.where, name(end),
                   std::string(message) + ", so that it never fires",
                   "compare the messages on channel " + channel.path, severity);
        }
    }

    // Whether all ends of one kind have the same owner.
    bool one_to_one(const ChannelDraft& channel, const std::vector<ChannelEnd>& ends,
                    const char* code, const char* what) {
        for (const ChannelEnd& end : ends) {
            if (!channel.shared && end.owner != ends.front().owner) {
                report(defects_, code, end.where, name(end),
                       "a channel joins one machine to one other, and " +
                           net_.transitions[ends.front().transition.value].path + " and this one " +
                           what + " on " + channel.path,
                       "declare a channel for each of them");
                return false;
            }
        }
        return true;
    }

    std::optional<TransitionDraft> meet(const ChannelEnd& send, const ChannelEnd& receive) {
        TransitionDraft product = net_.transitions[send.transition.value];
        TransitionDraft other = net_.transitions[receive.transition.value];
        // The message is of the sender, whose variables keep their numbers; what the receiver reads
        // of its own moves with it.
        std::optional<Expr> wanted = receive.message;
        if (wanted) {
            shift_variables(*wanted, product.variables.size());
        }
        if (receive.into.valid() && send.message) {
            other.assignments.push_back({receive.into, Expr::boolean(false), receive.where});
        }
        const bool compare = wanted && send.message && *wanted != *send.message;
        merge(product, std::move(other));
        if (receive.into.valid() && send.message) {
            product.assignments.back().value = *send.message;
        }
        if (compare) {
            Result<Expr, ExprError> equal =
                Expr::binary(ExprOp::kEqual, *send.message, std::move(*wanted));
            if (equal && product.guard) {
                equal =
                    Expr::binary(ExprOp::kAnd, std::move(*product.guard), std::move(equal).value());
            }
            if (!equal) {
                report(defects_, "type-mismatch", receive.where, name(receive),
                       "its message is of another type than that of the send: " +
                           equal.error().message,
                       "make both of one type");
                return std::nullopt;
            }
            product.guard = std::move(equal).value();
        }
        return product;
    }

    static void shift_variables(Expr& e, std::size_t by) {
        e.rename_slots([&](Slot s) {
            if (s.kind == static_cast<std::uint32_t>(SlotKind::kVariable)) {
                s.index += static_cast<std::uint32_t>(by);
            }
            return s;
        });
    }

    void merge(TransitionDraft& keep, TransitionDraft&& other) {
        const auto once = [&](bool mine, bool theirs, const char* what) {
            if (mine && theirs) {
                report(defects_, "rendezvous-disagree", other.where, "transition " + other.path,
                       "meets " + keep.path + ", and both state " + what,
                       std::string("state ") + what + " in one of them");
            }
        };
        once(keep.odds.has_value(), other.odds.has_value(), "odds");
        once(keep.delay.has_value(), other.delay.has_value(), "a delay");
        once(keep.holding.has_value(), other.holding.has_value(), "a holding time");
        once(!keep.events.empty(), !other.events.empty(), "an event");
        const auto shift = static_cast<std::uint32_t>(keep.variables.size());
        each_expr(other, [&](Expr& e) {
            e.rename_slots([&](Slot s) {
                if (s.kind == static_cast<std::uint32_t>(SlotKind::kVariable)) {
                    s.index += shift;
                }
                return s;
            });
        });
        for (ArcDraft& arc : other.inputs) {
            for (PatternDraft& pattern : arc.pattern) {
                if (pattern.binds) {
                    *pattern.binds += shift;
                }
            }
            if (arc.time_left) {
                *arc.time_left += shift;
            }
        }
        const auto append = [](auto& to, auto& from) {
            to.insert(to.end(), std::make_move_iterator(from.begin()),
                      std::make_move_iterator(from.end()));
        };
        append(keep.variables, other.variables);
        append(keep.inputs, other.inputs);
        append(keep.outputs, other.outputs);
        append(keep.assignments, other.assignments);
        append(keep.raises, other.raises);
        append(keep.events, other.events);
        keep.next_event = keep.next_event || other.next_event;
        if (other.guard) {
            if (keep.guard) {
                Result<Expr, ExprError> both =
                    Expr::binary(ExprOp::kAnd, std::move(*keep.guard), std::move(*other.guard));
                if (both) {
                    keep.guard = std::move(both).value();
                } else {
                    report(defects_, "type-mismatch", other.where, "transition " + other.path,
                           both.error().message, "make the guard a bool");
                }
            } else {
                keep.guard = std::move(other.guard);
            }
        }
        keep.priority = std::max(keep.priority, other.priority);
        if (other.odds) {
            keep.odds = std::move(other.odds);
        }
        if (other.delay) {
            keep.delay = std::move(other.delay);
        }
        if (other.holding) {
            keep.holding = std::move(other.holding);
            keep.busy = other.busy;
            keep.end = other.end;
        }
        keep.path += "|" + other.path;
    }

    // Measures at a transition that is merged read its variables behind those of the other.
    void shift_moments(std::uint32_t transition, std::size_t by) {
        for (MeasureDraft& m : net_.measures) {
            for (std::vector<Moment>* list : {&m.from, &m.to}) {
                for (Moment& moment : *list) {
                    if (moment.transition.value == transition) {
                        shift_variables(moment.value, by);
                    }
                }
            }
        }
    }

    void rename_moments(const std::vector<std::vector<std::uint32_t>>& products,
                        const std::vector<std::string>& paths) {
        for (MeasureDraft& m : net_.measures) {
            for (std::vector<Moment>* list : {&m.from, &m.to}) {
                std::vector<Moment> renamed;
                for (const Moment& moment : *list) {
                    const auto& of = products[moment.transition.value];
                    const std::string& path = paths[moment.transition.value];
                    const bool same = of.size() == 1 && net_.transitions[of[0]].path == path;
                    if (moment.keyed && !same) {
                        report(defects_, "measure-at-channel", m.where, "measure " + m.path,
                               path + " is an end of a channel, where values cannot be measured",
                               "measure a place, or a transition beside it");
                        continue;
                    }
                    for (const std::uint32_t p : of) {
                        renamed.push_back(moment);
                        renamed.back().transition = {p};
                    }
                }
                *list = std::move(renamed);
            }
        }
    }

    // Firings of an end are firings of any of its products.
    void rename(const std::vector<std::vector<std::uint32_t>>& products,
                const std::vector<std::string>& paths) {
        each_formula(net_, [&](Formula& f) { f = renamed(f, products); });
        rename_moments(products, paths);
        for (Rule& rule : net_.rules) {
            std::vector<TransitionIndex> transitions;
            for (const TransitionIndex t : rule.transitions) {
                const auto& of = products[t.value];
                if (of.size() == 1) {
                    transitions.push_back({of[0]});
                    continue;
                }
                if (rule.kind == RuleKind::kQuasiLive && rule.transitions.size() == 1) {
                    rule.kind = RuleKind::kPossible;
                    rule.operands = {any_of(of)};
                    continue;
                }
                const std::string& path = paths[t.value];
                std::string names;
                for (const std::uint32_t p : of) {
                    names += (names.empty() ? "" : ", ") + net_.transitions[p].path;
                }
                report(defects_, "rule-of-many", rule.where, "rule " + rule.path,
                       of.empty() ? path + " meets nobody, so that there is no such transition"
                                  : path + " is " + std::to_string(of.size()) +
                                        " transitions of the net: " + names,
                       rule.kind == RuleKind::kQuasiLive
                           ? "give it a rule of its own: quasi_live(" + path + ")"
                           : "ask for `live` of the transitions around it, or without a list: then "
                             "every rendezvous is meant");
            }
            rule.transitions = std::move(transitions);
        }
        for (TransitionDraft& t : net_.transitions) {
            if (t.end.valid()) {
                t.end = {products[t.end.value].front()};
            }
        }
    }

    static Formula any_of(const std::vector<std::uint32_t>& transitions) {
        Formula out = Formula::constant(false);
        for (std::size_t i = 0; i < transitions.size(); ++i) {
            Formula fires = Formula::fires({transitions[i]});
            out = i == 0 ? std::move(fires)
                         : Formula::binary(FormulaOp::kOr, std::move(out), std::move(fires));
        }
        return out;
    }

    // An atom over a transition becomes a disjunction; operands move with what comes before them.
    static Formula renamed(const Formula& f,
                           const std::vector<std::vector<std::uint32_t>>& products) {
        Formula out;
        out.expressions = f.expressions;
        std::vector<std::uint32_t> now(f.nodes.size());
        for (std::size_t i = 0; i < f.nodes.size(); ++i) {
            Formula::Node n = f.nodes[i];
            if (!speaks_of_transition(n.op)) {
                n.a = n.a < i ? now[n.a] : 0;
                n.b = n.b < i ? now[n.b] : 0;
                out.nodes.push_back(n);
            } else if (products[n.index].empty()) {
                out.nodes.push_back({.op = FormulaOp::kConstant, .count = 0});
            } else {
                const FormulaOp op = n.op;
                for (std::size_t k = 0; k < products[n.index].size(); ++k) {
                    const auto before = static_cast<std::uint32_t>(out.nodes.size()) - 1;
                    out.nodes.push_back({.op = op, .index = products[n.index][k]});
                    if (k > 0) {
                        out.nodes.push_back({.op = FormulaOp::kOr, .a = before, .b = before + 1});
                    }
                }
            }
            now[i] = static_cast<std::uint32_t>(out.nodes.size()) - 1;
        }
        return out;
    }

    NetDraft& net_;
    Diagnostics& defects_;
};

}  // namespace

Met meet_transitions(NetDraft& net, Diagnostics& defects) { return Meeting(net, defects).run(); }

void meet(NetDraft& draft, Diagnostics& defects) { meet_transitions(draft, defects); }

}  // namespace puppetri::net
