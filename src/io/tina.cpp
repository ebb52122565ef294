// SPDX-License-Identifier: MIT
// One pass over the words makes raw transitions and places (declarations superpose); what they mean
// together (time, priorities) is settled at the end.
#include "puppetri/io/tina.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "defects.h"
#include "puppetri/base/text.h"
#include "test_arcs.h"
#include "tina_lexer.h"
#include "tina_priorities.h"

namespace puppetri::io {
namespace {

constexpr std::int64_t kMostCount = 0x3FFF'FFFF;
constexpr std::int64_t kMostTime = std::numeric_limits<std::int64_t>::max() / 4;

// In ticks, open ends already moved by a tick; no high: w.
struct Interval {
    std::int64_t low = 0;
    std::optional<std::int64_t> high;
    bool operator==(const Interval&) const = default;
};

class Reader {
 public:
    Reader(std::string_view text, const std::string& path, const NetLimits& limits, NetFile& out,
           Defects& defects)
        : path_(path), limits_(limits), out_(out), defects_(defects) {
        TinaWords words = tina_words(text, path, defects);
        tokens_ = std::move(words.tokens);
        read_unit(words.comments);
    }

    void run() {
        out_.draft.sources_on_beats = true;
        while (!at_end()) {
            declaration();
        }
        for (net::PlaceDraft& p : out_.draft.places) {
            out_.ids.add_place(p.path, {places_.at(p.path)});
        }
        for (std::uint32_t i = 0; i < out_.draft.transitions.size(); ++i) {
            out_.ids.add_transition(out_.draft.transitions[i].path, {{i}});
        }
        out_.ids.sort();
        for (const auto& [name, at] : transitions_) {
            if (places_.count(name) != 0) {
                defects_.error("duplicate-id", out_.draft.transitions[at.value].where,
                               "transition " + name, "a place has the same name",
                               "give one of them another name");
            }
        }
        settle_time();
        join_parallel_tests(out_, defects_);
        settle_priorities(out_.draft, higher_, defects_);
    }

 private:
    const TinaToken& peek() const { return tokens_[at_]; }
    bool at_end() const { return peek().kind == TinaToken::kEnd; }
    bool sign(const char* text) const {
        return peek().kind == TinaToken::kSign && peek().text == text;
    }
    bool take(const char* text) {
        const bool found = sign(text);
        at_ += found ? 1 : 0;
        return found;
    }
    SourceSpan where(const TinaToken& t) const { return {path_, t.line, t.column, t.length}; }
    void error(const char* code, const TinaToken& t, std::string message, std::string remedy) {
        defects_.error(code, where(t), element_, std::move(message), std::move(remedy));
    }

    // A declaration begins with its keyword at the beginning of a line.
    bool keyword() const {
        const TinaToken& t = peek();
        return t.kind == TinaToken::kEnd ||
               (t.kind == TinaToken::kName && !t.quoted && t.line_start &&
                (t.text == "tr" || t.text == "pl" || t.text == "lb" || t.text == "pr" ||
                 t.text == "nt" || t.text == "net"));
    }
    void skip() {
        while (!keyword()) {
            ++at_;
        }
    }

    // `# unit 250 us`, as our writer says it.
    void read_unit(const std::vector<std::string>& comments) {
        for (const std::string& comment : comments) {
            const std::size_t begin = comment.find_first_not_of(" \t");
            if (begin == std::string::npos || comment.compare(begin, 5, "unit ") != 0) {
                continue;
            }
            std::string rest = comment.substr(begin + 5);
            while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ')) {
                rest.pop_back();
            }
            const std::size_t space = rest.find(' ');
            const std::string name = space == std::string::npos ? "" : rest.substr(space + 1);
            const std::int64_t base = name == "s"       ? kTicksPerSecond
                                      : name == "ms"    ? kTicksPerMillisecond
                                      : name == "us"    ? 0
                                      : name == "ticks" ? 1
                                                        : -1;
            const std::optional<double> many = parse_number(rest.substr(0, space));
            // A microsecond is 705.6 ticks: only multiples of 5 of it are whole numbers.
            const double ticks = many ? *many * (base == 0 ? 705.6 : static_cast<double>(base)) : 0;
            if (base < 0 || !many || !(ticks >= 1 && ticks < 1e15) ||
                ticks != static_cast<double>(static_cast<std::int64_t>(ticks))) {
                continue;
            }
            unit_ = static_cast<std::int64_t>(ticks);
            return;
        }
    }

    void declaration() {
        element_.clear();
        const TinaToken& word = peek();
        if (!keyword()) {
            error("unknown-element", word, "expected tr, pl, lb, pr, nt or net",
                  "begin each declaration on a line of its own");
            skip();
            return;
        }
        ++at_;
        bool fine = true;
        if (word.text == "tr") {
            fine = transition();
        } else if (word.text == "pl") {
            fine = place();
        } else if (word.text == "lb") {
            fine = label();
        } else if (word.text == "pr") {
            fine = priority();
        } else if (word.text == "net") {
            const TinaToken* name = this->name("net");
            fine = name != nullptr;
            if (fine) {
                out_.draft.name = name->text;
            }
        } else {
            skip();  // nt: a note
            return;
        }
        if (fine && !keyword()) {
            error("unknown-element", peek(),
                  "\"" + peek().text.substr(0, 20) + "\" is out of place",
                  "begin each declaration on a line of its own");
        }
        skip();
    }

    const TinaToken* name(const char* what) {
        if (peek().kind == TinaToken::kName && !keyword()) {
            return &tokens_[at_++];
        }
        error("missing-id", peek(), std::string("expected the name of a ") + what,
              "names are letters, digits, _ and ', or anything in braces");
        return nullptr;
    }

    net::PlaceIndex place_of(const TinaToken& name) {
        const auto [at, is_new] = places_.emplace(
            name.text, net::PlaceIndex{static_cast<std::uint32_t>(out_.draft.places.size())});
        if (is_new) {
            net::PlaceDraft place;
            place.path = name.text;
            place.where = where(name);
            out_.draft.places.push_back(std::move(place));
        }
        return at->second;
    }
    net::TransitionIndex transition_of(const TinaToken& name) {
        const auto [at, is_new] = transitions_.emplace(
            name.text,
            net::TransitionIndex{static_cast<std::uint32_t>(out_.draft.transitions.size())});
        if (is_new) {
            net::TransitionDraft t;
            t.path = name.text;
            t.where = where(name);
            out_.draft.transitions.push_back(std::move(t));
            intervals_.emplace_back();
        }
        return at->second;
    }

    // INT with K, M, G, T, P or E.
    std::optional<std::int64_t> number(const char* what) {
        const TinaToken& t = peek();
        if (t.kind != TinaToken::kName || t.quoted || t.text[0] < '0' || t.text[0] > '9') {
            error("not-a-number", t, std::string("expected ") + what, "write a whole number");
            return std::nullopt;
        }
        ++at_;
        std::string_view digits = t.text;
        constexpr std::string_view kSuffixes = "KMGTPE";
        const std::size_t suffix = kSuffixes.find(digits.back());
        if (suffix != std::string_view::npos) {
            digits.remove_suffix(1);
        }
        const ParsedNumber parsed = parse(digits);
        if (!parsed.fine) {
            error("not-a-number", t, "\"" + t.text.substr(0, 30) + "\" is no whole number",
                  "write digits, and K or M for thousands and millions");
            return std::nullopt;
        }
        std::int64_t value = parsed.value;
        for (std::size_t i = 0; suffix != std::string_view::npos && i <= suffix; ++i) {
            value = value > kMostTime / 1000 ? kMostTime : value * 1000;
        }
        return value;
    }

    struct ParsedNumber {
        bool fine = false;
        std::int64_t value = 0;
    };
    static ParsedNumber parse(std::string_view digits) {
        ParsedNumber out{.fine = !digits.empty()};
        for (const char c : digits) {
            if (c < '0' || c > '9') {
                return {};
            }
            out.value = out.value > kMostTime / 10 - 10 ? kMostTime : out.value * 10 + (c - '0');
        }
        return out;
    }

    std::optional<std::int64_t> count(const char* what, std::int64_t least) {
        const TinaToken& t = peek();
        const std::optional<std::int64_t> value = number(what);
        if (value && *value > kMostCount) {
            error("number-too-large", t,
                  std::string(what) + " is larger than " + std::to_string(kMostCount),
                  "use fewer tokens");
            return std::nullopt;
        }
        if (value && *value < least) {
            error("number-too-small", t, std::string(what) + " is 0", "write 1 or more");
            return std::nullopt;
        }
        return value;
    }

    std::optional<Interval> interval() {
        const TinaToken& start = peek();
        const bool open_low = sign("]");
        ++at_;
        std::optional<std::int64_t> low = number("the lower end of an interval");
        if (!low || !take(",")) {
            if (low) {
                error("bad-interval", peek(), "expected a comma", "write [a,b] or [a,w[");
            }
            return std::nullopt;
        }
        Interval out;
        const bool infinite = peek().kind == TinaToken::kName && peek().text == "w";
        std::optional<std::int64_t> high;
        if (infinite) {
            ++at_;
        } else {
            high = number("the upper end of an interval");
            if (!high) {
                return std::nullopt;
            }
        }
        const bool open_high = sign("[");
        if (!take("[") && !take("]")) {
            error("bad-interval", peek(), "the interval does not end", "write ] or [ after it");
            return std::nullopt;
        }
        if (*low > kMostTime / unit_ || (high && *high > kMostTime / unit_)) {
            error("number-too-large", start, "the time lies beyond the end of time",
                  "use a larger unit");
            return std::nullopt;
        }
        out.low = *low * unit_ + (open_low ? 1 : 0);
        if (high) {
            out.high = *high * unit_ - (open_high ? 1 : 0);
        }
        if (out.high && *out.high < out.low) {
            error("bad-interval", start, "the interval is empty", "write the smaller end first");
            return std::nullopt;
        }
        return out;
    }

    struct Arc {
        net::ArcKind kind = net::ArcKind::kTake;
        std::int64_t weight = 1;
    };
    // What follows a name in a list of arcs.
    std::optional<Arc> arc(bool tests_allowed) {
        Arc out;
        const TinaToken& t = peek();
        if (take("*")) {
            const auto weight = count("a weight", 1);
            return weight ? std::optional(Arc{net::ArcKind::kTake, *weight}) : std::nullopt;
        }
        if (sign("!")) {
            error("unknown-arc-type", t, "a stopwatch arc, which stops a clock, is not read",
                  "known are normal arcs, test arcs ?n and inhibitor arcs ?-n");
            return std::nullopt;
        }
        if (take("?")) {
            out.kind = take("-") ? net::ArcKind::kUnless : net::ArcKind::kRead;
            const auto weight = count("a weight", 1);
            if (!tests_allowed) {
                error("arc-type-backwards", t,
                      "a test or inhibitor arc cannot lead from a transition to a place",
                      "write it before the arrow");
                return std::nullopt;
            }
            if (!weight) {
                return std::nullopt;
            }
            out.weight = *weight;
        }
        return out;
    }

    bool transition() {
        const TinaToken* word = name("transition");
        if (word == nullptr) {
            return false;
        }
        element_ = "transition " + word->text;
        const net::TransitionIndex t = transition_of(*word);
        if (!label_of(out_.draft.transitions[t.value].caption)) {
            return false;
        }
        if (sign("[") || sign("]")) {
            const TinaToken& start = peek();
            const std::optional<Interval> found = interval();
            if (!found) {
                return false;
            }
            std::optional<Interval>& known = intervals_[t.value];
            if (known && *known != *found) {
                error("bad-interval", start, "the transition has another interval already",
                      "keep one of them");
            }
            known = *found;
        }
        if (keyword()) {
            return true;
        }
        return arcs([&](bool output) {
            const TinaToken* p = name("place");
            if (p == nullptr) {
                return false;
            }
            const net::PlaceIndex place = place_of(*p);
            const std::optional<Arc> a = arc(!output);
            if (a) {
                add(t, place, *a, output, where(*p));
            }
            return a.has_value();
        });
    }

    // `: label`, where there is one.
    bool label_of(std::string& caption) {
        if (!take(":")) {
            return true;
        }
        const TinaToken* label = name("label");
        if (label != nullptr) {
            caption = label->text;
        }
        return label != nullptr;
    }

    // INPUTS -> OUTPUTS: `one` reads one of them, told on which side it stands.
    template <class F>
    bool arcs(F one) {
        bool output = false;
        while (!keyword()) {
            if (!take("->")) {
                if (!one(output)) {
                    return false;
                }
            } else if (output) {
                error("unknown-element", peek(), "a second arrow", "write one arrow");
                return false;
            } else {
                output = true;
            }
        }
        if (!output) {
            error("unknown-element", peek(), "the arrow is missing", "write INPUTS -> OUTPUTS");
        }
        return output;
    }

    void add(net::TransitionIndex t, net::PlaceIndex p, const Arc& a, bool output, SourceSpan at) {
        if (++arcs_ > limits_.elements) {
            return;  // told at the end
        }
        net::TransitionDraft& transition = out_.draft.transitions[t.value];
        if (output) {
            transition.outputs.push_back({.place = p, .weight = a.weight, .where = std::move(at)});
        } else {
            transition.inputs.push_back(
                {.kind = a.kind, .place = p, .weight = a.weight, .where = std::move(at)});
        }
    }

    bool place() {
        const TinaToken* word = name("place");
        if (word == nullptr) {
            return false;
        }
        element_ = "place " + word->text;
        const net::PlaceIndex p = place_of(*word);
        if (!label_of(out_.draft.places[p.value].caption)) {
            return false;
        }
        if (sign("(")) {
            const TinaToken& start = tokens_[at_++];
            const std::optional<std::int64_t> tokens = count("the marking", 0);
            if (!tokens) {
                return false;
            }
            if (!take(")")) {
                error("unknown-element", peek(), "the marking does not end", "write ) after it");
                return false;
            }
            if (!marked_.emplace(p.value, *tokens).second && marked_[p.value] != *tokens) {
                error("duplicate-label", start, "the place has another marking already",
                      "keep one of them");
            } else if (*tokens > 0 && out_.draft.places[p.value].tokens.empty()) {
                out_.draft.places[p.value].tokens.push_back(
                    {.count = static_cast<std::uint32_t>(*tokens)});
            }
        }
        if (keyword()) {
            return true;
        }
        return arcs([&](bool output) {
            const TinaToken* t = name("transition");
            if (t == nullptr) {
                return false;
            }
            const net::TransitionIndex transition = transition_of(*t);
            const std::optional<Arc> a = arc(output);  // place -> transition: tests are allowed
            if (a) {
                add(transition, p, *a, !output, where(*t));
            }
            return a.has_value();
        });
    }

    bool label() {
        const TinaToken* word = name("place or transition");
        const TinaToken* text = word != nullptr ? name("label") : nullptr;
        if (text == nullptr) {
            return false;
        }
        const auto p = places_.find(word->text);
        const auto t = transitions_.find(word->text);
        if (p != places_.end()) {
            out_.draft.places[p->second.value].caption = text->text;
        } else if (t != transitions_.end()) {
            out_.draft.transitions[t->second.value].caption = text->text;
        } else {
            error("unknown-id", *word, "there is no place or transition " + word->text,
                  "declare it before its label");
        }
        return true;
    }

    bool priority() {
        std::vector<std::uint32_t> left, right;
        bool greater = false, seen = false;
        while (!keyword()) {
            if (sign("<") || sign(">")) {
                if (seen) {
                    error("unknown-element", peek(), "a second sign of comparison",
                          "write one comparison per line");
                    return false;
                }
                greater = sign(">");
                seen = true;
                ++at_;
                continue;
            }
            const TinaToken* t = name("transition");
            if (t == nullptr) {
                return false;
            }
            (seen ? right : left).push_back(transition_of(*t).value);
        }
        if (!seen || left.empty() || right.empty()) {
            error("unknown-element", peek(), "a priority compares transitions",
                  "write pr t1 t2 > u1 u2");
            return false;
        }
        if (left.size() * right.size() + higher_.size() > limits_.elements) {
            error("net-too-large", peek(), "too many priorities", "write fewer");
            return false;
        }
        for (const std::uint32_t a : left) {
            for (const std::uint32_t b : right) {
                higher_.push_back(greater ? std::pair(a, b) : std::pair(b, a));
            }
        }
        return true;
    }

    // If any interval is another than [0,w[, the net has time and all of them count.
    void settle_time() {
        if (arcs_ + out_.draft.places.size() + out_.draft.transitions.size() > limits_.elements) {
            defects_.error("net-too-large", {path_, 0, 0, 1}, "",
                           "more than " + std::to_string(limits_.elements) + " elements",
                           "split the model, or ask for more");
        }
        const bool timed = std::any_of(intervals_.begin(), intervals_.end(),
                                       [](const auto& i) { return i && *i != Interval{}; });
        if (!timed) {
            return;
        }
        for (std::size_t i = 0; i < intervals_.size(); ++i) {
            const Interval interval = intervals_[i].value_or(Interval{});
            net::TransitionDraft& t = out_.draft.transitions[i];
            net::DelayDraft delay;
            if (!interval.high) {
                delay.duration = at_least({interval.low}, {unit_});
            } else if (*interval.high == 0) {
                continue;
            } else if (*interval.high == interval.low) {
                delay.duration = net::DurationDraft::constant({interval.low});
            } else {
                delay.duration.kind = net::DurationKind::kInterval;
                delay.duration.a = Expr::time({interval.low});
                delay.duration.b = Expr::time({*interval.high});
            }
            t.delay = std::move(delay);
        }
    }

    std::string path_;
    const NetLimits& limits_;
    NetFile& out_;
    Defects& defects_;
    std::vector<TinaToken> tokens_;
    std::size_t at_ = 0;
    std::int64_t unit_ = kTicksPerSecond;
    std::string element_;
    std::map<std::string, net::PlaceIndex> places_;
    std::map<std::string, net::TransitionIndex> transitions_;
    std::map<std::uint32_t, std::int64_t> marked_;
    std::vector<std::optional<Interval>> intervals_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> higher_;  // first before second
    std::uint64_t arcs_ = 0;
};

}  // namespace

net::DurationDraft at_least(SimTime low, SimTime unit) {
    net::DurationDraft out;
    out.kind = net::DurationKind::kDistribution;
    out.distribution = DistributionKind::kNormal;
    // The deviation, one unit, only shapes runs.
    out.parameters = {Expr::time(low), Expr::time(unit), Expr::time(low),
                      Expr::real(std::numeric_limits<double>::infinity())};
    return out;
}

bool is_at_least(const net::DurationDraft& delay, SimTime& low) {
    if (delay.kind != net::DurationKind::kDistribution ||
        delay.distribution != DistributionKind::kNormal || delay.parameters.size() != 4) {
        return false;
    }
    for (const Expr& p : delay.parameters) {
        if (!p.is_literal()) {
            return false;
        }
    }
    const Expr& bound = delay.parameters[2];
    const Expr& high = delay.parameters[3];
    if (bound.type().kind != ValueKind::kTime || !(delay.parameters[0] == bound) ||
        high.type().kind != ValueKind::kReal ||
        !(real_of_value(high.literal_value()) > std::numeric_limits<double>::max())) {
        return false;
    }
    low = {bound.literal_value()};
    return true;
}

Checked<NetFile> read_tina(std::string_view text, const std::string& path,
                           const NetLimits& limits) {
    Defects defects;
    NetFile out;
    out.format = NetFormat::kTina;
    if (text.size() > limits.bytes) {
        defects.error("file-too-large", {path, 0, 0, 1}, "",
                      "the file has more than " + std::to_string(limits.bytes) + " bytes",
                      "split the model, or ask for more");
    } else if (const auto invalid = find_invalid_utf8(text)) {
        const std::string_view before = text.substr(0, *invalid);
        const auto line =
            static_cast<std::uint32_t>(1 + std::count(before.begin(), before.end(), '\n'));
        defects.error("bad-encoding", {path, line, 1, 1}, "", "a byte that is not UTF-8",
                      "save the file as UTF-8");
    } else {
        Reader(text, path, limits, out, defects).run();
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    out.notes = defects.take();
    return out;
}

}  // namespace puppetri::io
