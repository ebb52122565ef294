// SPDX-License-Identifier: MIT
// The oracle: one class that plays one run from a script of choices, and a loop over all scripts.
#include "support/oracle_net.h"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <limits>
#include <map>

namespace puppetri::test {
namespace {

using namespace net;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

// Answers from a script; beyond its end the first option. Remembers how many options there were.
struct Script {
    struct Turn {
        std::size_t taken = 0;
        std::size_t options = 0;
    };
    std::vector<Turn> turns;
    std::size_t next = 0;

    std::size_t choose(std::size_t options) {
        if (options <= 1) {
            return 0;
        }
        if (next == turns.size()) {
            turns.push_back({.taken = 0, .options = options});
        }
        return turns[next++].taken;
    }
    // The next script in order; false: there is none.
    bool advance() {
        next = 0;
        while (!turns.empty() && turns.back().taken + 1 == turns.back().options) {
            turns.pop_back();
        }
        if (turns.empty()) {
            return false;
        }
        ++turns.back().taken;
        return true;
    }
};

struct Token {
    std::uint64_t serial = 0;
    std::int64_t arrival = 0;
    std::int64_t ready = 0;
    std::vector<Value> attributes;
};

// A way of firing: which token serials go, and the values of variables.
struct Binding {
    std::map<std::uint32_t, std::set<std::uint64_t>> taken;  // place -> serials
    // place and kind of reading -> serials: parallel arcs of one kind add, so they read different
    // tokens
    std::map<std::pair<std::uint32_t, ArcKind>, std::set<std::uint64_t>> read;
    std::vector<std::optional<Value>> variables;
};

struct Occurrence {
    EventIndex event;
    std::set<std::uint32_t> used_by;
    bool used_up = false;
};

class Interpreter {
 public:
    Interpreter(const NetDraft& net, const OracleBounds& bounds, Script& script,
                const std::vector<OracleFiring>* guide)
        : net_(net), bounds_(bounds), script_(script), guide_(guide) {}

    // The firings in firings(); false: the guide asks for what cannot be.
    bool play() {
        begin();
        for (;;) {
            if (log_.size() >= bounds_.firings) {
                end_ = "limit";
                break;
            }
            const std::vector<std::uint32_t> best = highest(fireable());
            if (!best.empty() && paced_ && now_ < next_beat_) {
                if (next_beat_ > bounds_.until) {
                    end_ = "limit";
                    now_ = bounds_.until;
                    break;
                }
                now_ = next_beat_;
                continue;
            }
            if (!best.empty()) {
                next_beat_ = now_ + bounds_.beat;
                std::uint32_t winner = 0;
                if (guide_ != nullptr) {
                    if (log_.size() >= guide_->size() || (*guide_)[log_.size()].tick != now_ ||
                        std::find(best.begin(), best.end(), (*guide_)[log_.size()].transition) ==
                            best.end()) {
                        return false;
                    }
                    winner = (*guide_)[log_.size()].transition;
                } else {
                    winner = best[script_.choose(best.size())];
                }
                fire(winner);
                continue;
            }
            if (offered_) {
                offered_.reset();  // unused: lost
                continue;
            }
            if (!pending_.empty()) {
                offer();
                continue;
            }
            if (!advance_time()) {
                break;
            }
        }
        return guide_ == nullptr || log_ == *guide_;
    }

    OracleRun notation() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;
        for (const auto& tokens : places_) {
            counts.emplace_back(static_cast<std::uint32_t>(tokens.size()), ready_count(tokens));
        }
        return oracle_notation(net_, log_, end_, counts, data_);
    }

 private:
    // A net that declares no time at all.
    static bool is_paced(const NetDraft& net) {
        const auto timeless = [](const PlaceDraft& p) {
            return !p.duration || p.duration->kind == DurationKind::kOpen ||
                   (p.duration->kind == DurationKind::kConstant &&
                    p.duration->a.literal_value() == 0) ||
                   p.duration->kind == DurationKind::kAs;
        };
        const auto immediate = [](const TransitionDraft& t) {
            return !t.delay &&
                   std::none_of(t.outputs.begin(), t.outputs.end(),
                                [](const OutputDraft& o) { return o.lasts.has_value(); });
        };
        return net.schedule.empty() &&
               std::all_of(net.places.begin(), net.places.end(), timeless) &&
               std::all_of(net.transitions.begin(), net.transitions.end(), immediate);
    }

    // ---- the beginning ----
    void begin() {
        paced_ = is_paced(net_);
        places_.resize(net_.places.size());
        clocks_.resize(net_.transitions.size());
        for (const DatumDraft& d : net_.data) {
            data_.push_back(d.initial);
        }
        for (std::uint32_t p = 0; p < net_.places.size(); ++p) {
            for (const InitialToken& token : net_.places[p].tokens) {
                for (std::uint32_t i = 0; i < token.count; ++i) {
                    add_token(p, token.attributes,
                              token.ready ? std::optional<std::int64_t>(0) : std::nullopt, nullptr,
                              token.ready);
                }
            }
        }
        next_scheduled_.resize(net_.schedule.size());
        for (std::size_t i = 0; i < net_.schedule.size(); ++i) {
            next_scheduled_[i] = net_.schedule[i].at.ticks;
        }
        collect_events();
        start_clocks();
    }

    // ---- expressions, straight from the tree ----
    struct Scope {
        const Binding* binding = nullptr;
        const std::vector<Value>* attributes = nullptr;
    };
    Value slot_value(Slot s, const Scope& scope) const {
        switch (static_cast<SlotKind>(s.kind)) {
            case SlotKind::kDatum:
                return data_[s.index];
            case SlotKind::kVariable:
                return scope.binding->variables[s.index].value();
            case SlotKind::kCount:
                return static_cast<Value>(places_[s.index].size());
            case SlotKind::kReady:
                return ready_count(places_[s.index]);
            case SlotKind::kAttribute:
                return (*scope.attributes)[s.index];
        }
        std::abort();
    }
    Value evaluate(const Expr& e, const Scope& scope) const {
        return evaluate(e, static_cast<std::uint32_t>(e.nodes().size()) - 1, scope);
    }
    Value evaluate(const Expr& e, std::uint32_t at, const Scope& scope) const {
        const Expr::Node& n = e.nodes()[at];
        const auto a = [&] { return evaluate(e, n.a, scope); };
        const auto b = [&] { return evaluate(e, n.b, scope); };
        switch (n.op) {
            case ExprOp::kLiteral:
                return n.literal;
            case ExprOp::kSlot:
                return slot_value(n.slot, scope);
            case ExprOp::kNot:
                return a() == 0 ? 1 : 0;
            case ExprOp::kNegate:
                return -a();
            case ExprOp::kAdd:
                return a() + b();
            case ExprOp::kSubtract:
                return a() - b();
            case ExprOp::kMultiply:
                return a() * b();
            case ExprOp::kModulo: {
                const Value divisor = b();
                if (divisor == 0) {
                    std::abort();
                }
                const Value rest = a() % divisor;
                return rest != 0 && (rest < 0) != (divisor < 0) ? rest + divisor : rest;
            }
            case ExprOp::kLess:
                return a() < b() ? 1 : 0;
            case ExprOp::kLessEqual:
                return a() <= b() ? 1 : 0;
            case ExprOp::kGreater:
                return a() > b() ? 1 : 0;
            case ExprOp::kEqual:
                return a() == b() ? 1 : 0;
            case ExprOp::kNotEqual:
                return a() != b() ? 1 : 0;
            case ExprOp::kAnd:
                return a() != 0 && b() != 0 ? 1 : 0;
            case ExprOp::kOr:
                return a() != 0 || b() != 0 ? 1 : 0;
            default:
                std::abort();  // the nets of the tests use no more
        }
    }

    // ---- tokens ----
    std::uint32_t ready_count(const std::vector<Token>& tokens) const {
        return static_cast<std::uint32_t>(std::count_if(
            tokens.begin(), tokens.end(), [&](const Token& t) { return t.ready <= now_; }));
    }
    std::int64_t duration(const DurationDraft& d, const Scope& scope,
                          const std::map<std::uint32_t, std::int64_t>* siblings) {
        switch (d.kind) {
            case DurationKind::kConstant:
            case DurationKind::kExpression:
                return evaluate(d.a, scope);
            case DurationKind::kInterval: {
                const std::int64_t low = evaluate(d.a, scope);
                const std::int64_t high = evaluate(d.b, scope);
                return low == high || script_.choose(2) == 0 ? low : high;
            }
            case DurationKind::kAs:
                return siblings->at(d.sibling.value);
            case DurationKind::kOpen:
                return kNever;
            default:
                std::abort();
        }
    }
    // Gives  the token's duration.
    std::int64_t add_token(std::uint32_t p, const std::vector<Value>& attributes,
                           std::optional<std::int64_t> lasts,
                           const std::map<std::uint32_t, std::int64_t>* siblings,
                           bool starts_ready = false) {
        const PlaceDraft& place = net_.places[p];
        Token token{
            .serial = next_serial_++, .arrival = now_, .ready = now_, .attributes = attributes};
        std::int64_t d = 0;
        if (lasts) {
            d = *lasts;
        } else if (place.duration) {
            d = duration(*place.duration, {.binding = nullptr, .attributes = &attributes},
                         siblings);
        }
        token.ready = d == kNever ? kNever : now_ + d;
        if (place.keeps_order && !starts_ready && token.ready != kNever) {
            for (const Token& other :
                 places_[p]) {  // those that are there; open ones have no time to wait for
                token.ready =
                    other.ready != kNever ? std::max(token.ready, other.ready) : token.ready;
            }
        }
        places_[p].push_back(token);
        return d;
    }

    // The tokens of a place in the order of its discipline.
    std::vector<const Token*> in_order(std::uint32_t p) const {
        const PlaceDraft& place = net_.places[p];
        std::vector<const Token*> order;
        for (const Token& t : places_[p]) {
            order.push_back(&t);
        }
        const auto older = [&](const Token* a, const Token* b) {
            return std::tuple(place.by_arrival ? 0 : a->ready, a->arrival, a->serial) <
                   std::tuple(place.by_arrival ? 0 : b->ready, b->arrival, b->serial);
        };
        std::sort(order.begin(), order.end(), older);
        if (place.discipline == Discipline::kNewest) {
            std::reverse(order.begin(), order.end());
        } else if (place.discipline == Discipline::kLeast ||
                   place.discipline == Discipline::kMost) {
            const auto key = [&](const Token* t) {
                return evaluate(place.key, {.binding = nullptr, .attributes = &t->attributes});
            };
            std::stable_sort(order.begin(), order.end(), [&](const Token* a, const Token* b) {
                return place.discipline == Discipline::kLeast ? key(a) < key(b) : key(a) > key(b);
            });
        }
        return order;
    }

    // ---- marked: arcs, guard, room ----
    static bool takes(ArcKind kind) {
        return kind == ArcKind::kTake || kind == ArcKind::kTakeNow || kind == ArcKind::kTakeAll ||
               kind == ArcKind::kTakeAllNow;
    }
    static bool ready_only(ArcKind kind) {
        return kind == ArcKind::kTake || kind == ArcKind::kTakeAll || kind == ArcKind::kRead ||
               kind == ArcKind::kUnlessReady;
    }
    bool matches(const ArcDraft& arc, const Token& token, Binding& binding) const {
        for (const PatternDraft& pattern : arc.pattern) {
            const Value value = token.attributes[pattern.attribute];
            if (pattern.binds) {
                std::optional<Value>& variable = binding.variables[*pattern.binds];
                if (variable && *variable != value) {
                    return false;
                }
                variable = value;
            } else if (evaluate(pattern.equals, {.binding = &binding, .attributes = nullptr}) !=
                       value) {
                return false;
            }
        }
        return true;
    }
    // All ways of firing from arc number i on; one, unless `any` places leave a choice.
    std::vector<Binding> bindings_from(const TransitionDraft& t, std::size_t i,
                                       const Binding& so_far) const {
        if (i == t.inputs.size()) {
            if (!has_room(t) ||
                (t.guard && evaluate(*t.guard, {.binding = &so_far, .attributes = nullptr}) == 0)) {
                return {};
            }
            return {so_far};
        }
        const ArcDraft& arc = t.inputs[i];
        std::vector<const Token*> candidates;
        for (const Token* token : in_order(arc.place.value)) {
            if (!ready_only(arc.kind) || token->ready <= now_) {
                candidates.push_back(token);
            }
        }
        if (arc.kind == ArcKind::kUnless || arc.kind == ArcKind::kUnlessReady) {
            std::int64_t count = 0;
            for (const Token* token : candidates) {
                Binding scratch = so_far;
                count += matches(arc, *token, scratch) ? 1 : 0;
            }
            // Parallel arcs of one kind add; with patterns each counts its own.
            std::int64_t allowed = 0;
            for (const ArcDraft& other : t.inputs) {
                const bool parallel = other.kind == arc.kind && other.place == arc.place &&
                                      other.pattern.empty() && arc.pattern.empty();
                allowed += parallel || &other == &arc ? other.weight : 0;
            }
            return count < allowed ? bindings_from(t, i + 1, so_far) : std::vector<Binding>{};
        }
        if (arc.kind == ArcKind::kTakeAll || arc.kind == ArcKind::kTakeAllNow) {
            Binding next = so_far;
            for (const Token* token : candidates) {
                Binding scratch = so_far;
                if (matches(arc, *token, scratch)) {
                    next.taken[arc.place.value].insert(token->serial);
                }
            }
            return bindings_from(t, i + 1, next);
        }
        const bool any = net_.places[arc.place.value].discipline == Discipline::kAny;
        return choose_tokens(t, i, so_far, candidates, 0, arc.weight, {}, any);
    }
    // `left` more tokens of candidates[from..] for arc i.
    std::vector<Binding> choose_tokens(const TransitionDraft& t, std::size_t i,
                                       const Binding& so_far,
                                       const std::vector<const Token*>& candidates,
                                       std::size_t from, std::int64_t left,
                                       std::vector<const Token*> chosen, bool any) const {
        const ArcDraft& arc = t.inputs[i];
        if (left == 0) {
            Binding next = so_far;
            if (arc.time_left) {
                const std::int64_t ready = chosen.front()->ready;
                next.variables[*arc.time_left] =
                    ready == kNever ? kNever : std::max<std::int64_t>(0, ready - now_);
            }
            return bindings_from(t, i + 1, next);
        }
        std::vector<Binding> all;
        for (std::size_t k = from; k < candidates.size(); ++k) {
            const Token* token = candidates[k];
            Binding next = so_far;
            std::set<std::uint64_t>& gone = takes(arc.kind)
                                                ? next.taken[arc.place.value]
                                                : next.read[{arc.place.value, arc.kind}];
            if (gone.count(token->serial) != 0 || !matches(arc, *token, next)) {
                continue;
            }
            gone.insert(token->serial);
            std::vector<const Token*> more = chosen;
            more.push_back(token);
            std::vector<Binding> found =
                choose_tokens(t, i, next, candidates, k + 1, left - 1, more, any);
            all.insert(all.end(), found.begin(), found.end());
            if (!any && !all.empty()) {
                return all;
            }
        }
        return all;
    }
    // A full place blocks those who would make it fuller, by the weights of their arcs: what `all`
    // may take is not counted on, `all now` without a pattern empties the place.
    bool has_room(const TransitionDraft& t) const {
        for (std::uint32_t p = 0; p < net_.places.size(); ++p) {
            if (!net_.places[p].capacity) {
                continue;
            }
            std::int64_t gain = 0;
            bool emptied = false;
            for (const OutputDraft& out : t.outputs) {
                gain += out.place.value == p ? out.weight : 0;
            }
            const bool gives = gain > 0;
            for (const ArcDraft& arc : t.inputs) {
                if (arc.place.value == p) {
                    gain -= arc.kind == ArcKind::kTake || arc.kind == ArcKind::kTakeNow ? arc.weight
                                                                                        : 0;
                    emptied = emptied || (arc.kind == ArcKind::kTakeAllNow && arc.pattern.empty());
                }
            }
            const auto before = emptied ? 0 : static_cast<std::int64_t>(places_[p].size());
            if (gives && gain > 0 && before + gain > *net_.places[p].capacity) {
                return false;
            }
        }
        return true;
    }
    std::vector<Binding> bindings(std::uint32_t t) const {
        Binding empty;
        empty.variables.resize(net_.transitions[t].variables.size());
        return bindings_from(net_.transitions[t], 0, empty);
    }
    bool marked(std::uint32_t t) const { return !bindings(t).empty(); }

    // ---- due and fireable ----
    bool due(std::uint32_t t) const {
        if (!net_.transitions[t].delay) {
            return true;
        }
        return std::any_of(clocks_[t].due.begin(), clocks_[t].due.end(),
                           [&](std::int64_t at) { return at <= now_; });
    }
    bool offered_to(std::uint32_t t) const {
        const auto& events = net_.transitions[t].events;
        if (events.empty()) {
            return true;
        }
        return offered_ && !offered_->used_up && offered_->used_by.count(t) == 0 &&
               std::find(events.begin(), events.end(), offered_->event) != events.end();
    }
    std::vector<std::uint32_t> fireable() const {
        std::vector<std::uint32_t> list;
        for (std::uint32_t t = 0; t < net_.transitions.size(); ++t) {
            if (due(t) && offered_to(t) && marked(t)) {
                list.push_back(t);
            }
        }
        return list;
    }
    std::vector<std::uint32_t> highest(std::vector<std::uint32_t> list) const {
        std::int64_t top = std::numeric_limits<std::int64_t>::min();
        for (const std::uint32_t t : list) {
            top = std::max(top, net_.transitions[t].priority);
        }
        std::erase_if(list, [&](std::uint32_t t) { return net_.transitions[t].priority < top; });
        return list;
    }

    // ---- firing ----
    void fire(std::uint32_t index) {
        const TransitionDraft& t = net_.transitions[index];
        const std::vector<Binding> ways = bindings(index);
        const Binding binding = ways[script_.choose(ways.size())];
        const Scope scope{.binding = &binding, .attributes = nullptr};
        // What the firing will give and set is decided on the state before.
        std::vector<std::pair<std::uint32_t, Value>> set;
        for (const AssignmentDraft& a : t.assignments) {
            set.emplace_back(a.datum.value, evaluate(a.value, scope));
        }
        struct Gift {
            std::uint32_t place;
            std::vector<Value> attributes;
            std::optional<std::int64_t> lasts;
        };
        std::vector<Gift> gifts;
        for (const OutputDraft& out : t.outputs) {
            Gift gift{.place = out.place.value, .attributes = {}, .lasts = std::nullopt};
            for (const Expr& e : out.attributes) {
                gift.attributes.push_back(evaluate(e, scope));
            }
            if (out.lasts) {
                gift.lasts = evaluate(*out.lasts, scope);
            }
            gifts.insert(gifts.end(), static_cast<std::size_t>(out.weight), gift);
        }
        for (const auto& [p, serials] : binding.taken) {
            std::erase_if(places_[p], [&s = serials](const Token& token) {
                return s.count(token.serial) != 0;
            });
        }
        // The intermediate marking: here those that are not marked lose their clocks.
        for (std::uint32_t other = 0; other < clocks_.size(); ++other) {
            restart_if_lost(other, index);
        }
        for (const auto& [datum, value] : set) {
            data_[datum] = value;
        }
        std::map<std::uint32_t, std::int64_t> siblings;
        for (const bool as : {false, true}) {  // siblings before those that last as long
            for (const Gift& gift : gifts) {
                const auto& d = net_.places[gift.place].duration;
                const bool is_as = !gift.lasts && d && d->kind == DurationKind::kAs;
                if (is_as == as) {
                    siblings[gift.place] =
                        add_token(gift.place, gift.attributes, gift.lasts, &siblings);
                }
            }
        }
        if (offered_ && !t.events.empty()) {
            offered_->used_by.insert(index);
            offered_->used_up = net_.events[offered_->event.value].consumed;
        }
        for (const EventIndex e : t.raises) {
            pending_.push_back(e);
        }
        log_.push_back({.tick = now_, .transition = index});
        start_clocks();
    }

    // ---- delays ----
    struct Clocks {
        std::vector<std::int64_t> due;  // running or run out, in the order of their starts
        std::optional<std::int64_t>
            left;  // of `age` (single server): what was left when interrupted
    };
    // How many times t could fire side by side with itself, at most once per server: by the tokens
    // that it takes.
    std::uint32_t servers_busy(std::uint32_t t) const {
        const TransitionDraft& transition = net_.transitions[t];
        if (!marked(t)) {
            return 0;
        }
        if (transition.delay->servers == 1) {
            return 1;
        }
        std::map<std::uint32_t, std::int64_t> ready_needed;
        std::map<std::uint32_t, std::int64_t> needed;
        for (const ArcDraft& arc : transition.inputs) {
            if (arc.kind == ArcKind::kTake) {
                ready_needed[arc.place.value] += arc.weight;
            }
            if (arc.kind == ArcKind::kTake || arc.kind == ArcKind::kTakeNow) {
                needed[arc.place.value] += arc.weight;
            }
        }
        std::int64_t times = transition.delay->servers;
        for (const auto& [p, weight] : ready_needed) {
            times = std::min<std::int64_t>(times, ready_count(places_[p]) / weight);
        }
        for (const auto& [p, weight] : needed) {
            times = std::min<std::int64_t>(times,
                                           static_cast<std::int64_t>(places_[p].size()) / weight);
        }
        return static_cast<std::uint32_t>(needed.empty() ? 1 : times);
    }
    // In the intermediate marking: clocks for which there is nothing stop, the youngest first.
    void restart_if_lost(std::uint32_t t, std::uint32_t fired) {
        if (!net_.transitions[t].delay) {
            return;
        }
        Clocks& clocks = clocks_[t];
        if (t == fired) {  // the one that ran out
            clocks.due.erase(std::find_if(clocks.due.begin(), clocks.due.end(),
                                          [&](std::int64_t at) { return at <= now_; }));
        }
        switch (net_.transitions[t].delay->memory) {
            case DelayMemory::kEnabling:
                clocks.due.resize(std::min<std::size_t>(clocks.due.size(), servers_busy(t)));
                break;
            case DelayMemory::kAge:
                break;
            case DelayMemory::kResample:
                clocks.due.clear();
                break;
        }
    }
    // After anything has changed: as many clocks run as there are servers busy.
    void start_clocks() {
        for (std::uint32_t t = 0; t < clocks_.size(); ++t) {
            if (!net_.transitions[t].delay) {
                continue;
            }
            Clocks& clocks = clocks_[t];
            const std::uint32_t wanted = servers_busy(t);
            while (clocks.due.size() > wanted) {
                if (net_.transitions[t].delay->memory == DelayMemory::kAge) {
                    clocks.left = std::max<std::int64_t>(0, clocks.due.back() - now_);
                }
                clocks.due.pop_back();
            }
            while (clocks.due.size() < wanted) {
                const std::int64_t lasts =
                    clocks.left ? *clocks.left
                                : duration(net_.transitions[t].delay->duration, {}, nullptr);
                clocks.left.reset();
                clocks.due.push_back(now_ + lasts);
            }
        }
    }

    // ---- events and time ----
    void collect_events() {
        for (std::size_t i = 0; i < net_.schedule.size(); ++i) {  // in file order
            if (next_scheduled_[i] == now_) {
                pending_.push_back(net_.schedule[i].event);
                next_scheduled_[i] =
                    net_.schedule[i].every ? now_ + net_.schedule[i].every->ticks : kNever;
            }
        }
    }
    void offer() {
        offered_ = Occurrence{.event = pending_.front(), .used_by = {}, .used_up = false};
        pending_.pop_front();
        const EventDraft& event = net_.events[offered_->event.value];
        if (event.sets.valid()) {
            data_[event.sets.value] = event.sets_to ? 1 : 0;
        }
        if (event.makes_ready.valid()) {
            Token* oldest = nullptr;
            for (Token& token : places_[event.makes_ready.value]) {
                if (token.ready == kNever && (oldest == nullptr || token.serial < oldest->serial)) {
                    oldest = &token;
                }
            }
            if (oldest != nullptr) {
                oldest->ready = now_;
            }
        }
        start_clocks();
    }
    bool advance_time() {
        std::int64_t next = kNever;
        const auto consider = [&](std::int64_t at) {
            if (at > now_) {
                next = std::min(next, at);
            }
        };
        for (const auto& tokens : places_) {
            for (const Token& token : tokens) {
                consider(token.ready);
            }
        }
        for (const Clocks& clocks : clocks_) {
            for (const std::int64_t at : clocks.due) {
                consider(at);
            }
        }
        for (const std::int64_t at : next_scheduled_) {
            consider(at);
        }
        if (next == kNever || next > bounds_.until) {
            end_ = next == kNever ? "dead" : "limit";
            now_ = next == kNever ? now_ : bounds_.until;
            return false;
        }
        now_ = next;
        collect_events();
        start_clocks();
        return true;
    }

    const NetDraft& net_;
    const OracleBounds& bounds_;
    Script& script_;
    const std::vector<OracleFiring>* guide_;
    std::int64_t now_ = 0;
    bool paced_ = false;
    std::int64_t next_beat_ = 0;
    std::vector<std::vector<Token>> places_;
    std::vector<Value> data_;
    std::vector<Clocks> clocks_;
    std::deque<EventIndex> pending_;
    std::optional<Occurrence> offered_;
    std::vector<std::int64_t> next_scheduled_;
    std::uint64_t next_serial_ = 0;
    std::vector<OracleFiring> log_;
    std::string end_;
};

}  // namespace

OracleRun oracle_notation(
    const net::NetDraft& draft, const std::vector<OracleFiring>& firings, const std::string& end,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& tokens_and_ready,
    const std::vector<Value>& data) {
    std::string text;
    for (const OracleFiring& f : firings) {
        text += std::to_string(f.tick) + ":" + draft.transitions[f.transition].path + ";";
    }
    text += "|" + end;
    for (std::size_t p = 0; p < draft.places.size(); ++p) {
        text += " " + draft.places[p].path + "=" + std::to_string(tokens_and_ready[p].first) + "/" +
                std::to_string(tokens_and_ready[p].second);
    }
    for (std::size_t d = 0; d < draft.data.size(); ++d) {
        text += " " + draft.data[d].path + "=" + std::to_string(data[d]);
    }
    return text;
}

// Holding times: `t for d` is t.begin -> t.busy (d) -> t.end, where busy carries the variables on.
net::NetDraft without_holdings(net::NetDraft draft) {
    const std::size_t count = draft.transitions.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!draft.transitions[i].holding) {
            continue;
        }
        TransitionDraft t = draft.transitions[i];
        PlaceDraft busy;
        busy.path = t.path + ".busy";
        busy.duration = t.holding;
        TransitionDraft begin = t;
        begin.path = t.path + ".begin";
        begin.holding.reset();
        begin.outputs.clear();
        begin.assignments.clear();
        begin.raises.clear();
        TransitionDraft end;
        end.path = t.path + ".end";
        end.priority = t.priority;
        end.variables = t.variables;
        end.outputs = t.outputs;
        end.assignments = t.assignments;
        end.raises = t.raises;
        OutputDraft in;
        in.place = PlaceIndex{static_cast<std::uint32_t>(draft.places.size())};
        ArcDraft out;
        out.place = in.place;
        for (std::uint32_t v = 0; v < t.variables.size(); ++v) {
            busy.attributes.push_back({t.variables[v].name, t.variables[v].type});
            in.attributes.push_back(Expr::slot(slot(SlotKind::kVariable, v), t.variables[v].type));
            out.pattern.push_back({.attribute = v, .binds = v, .equals = {}});
        }
        begin.outputs.push_back(in);
        end.inputs.push_back(out);
        draft.transitions[i] = begin;
        draft.transitions.push_back(end);
        draft.places.push_back(busy);
    }
    return draft;
}

std::optional<std::set<OracleRun>> oracle_runs(const net::NetDraft& draft,
                                               const OracleBounds& bounds) {
    std::set<OracleRun> runs;
    Script script;
    std::size_t tried = 0;
    do {
        if (++tried > bounds.runs) {
            return std::nullopt;
        }
        Interpreter run(draft, bounds, script, nullptr);
        run.play();
        runs.insert(run.notation());
    } while (script.advance());
    return runs;
}

std::optional<bool> oracle_accepts(const net::NetDraft& draft,
                                   const std::vector<OracleFiring>& firings,
                                   const OracleBounds& bounds) {
    Script script;
    std::size_t tried = 0;
    do {
        if (++tried > bounds.runs) {
            return std::nullopt;
        }
        Interpreter run(draft, bounds, script, &firings);
        if (run.play()) {
            return true;
        }
    } while (script.advance());
    return false;
}

}  // namespace puppetri::test
