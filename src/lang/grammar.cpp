// SPDX-License-Identifier: MIT
// The grammar of statements: a PEG (PEGTL) over the string of token kinds. Rules make flat nodes as
// they match; what was made inside an alternative that fails is dropped with it. Terminals note how
// far the reading came and what they would have taken there, which is all that an error message
// needs.
#include "grammar.h"

#include <tao/pegtl.hpp>

#include "puppetri/lang/parse.h"

namespace puppetri::lang {
namespace {

namespace peg = tao::pegtl;

struct Reader {
    std::span<const Token> tokens;
    const char* base;
    Reading& out;
    std::uint32_t depth = 0;
    std::uint32_t quiet = 0;  // inside look-ahead: nothing is expected

    template <class In>
    std::uint32_t at(const In& in) const {
        return static_cast<std::uint32_t>(in.current() - base);
    }
    void miss(std::uint32_t position, Kind kind) {
        if (quiet > 0 || position < out.furthest) {
            return;
        }
        if (position > out.furthest) {
            out.furthest = position;
            out.expected.reset();
        }
        out.expected.set(static_cast<std::size_t>(kind));
    }
};

// Drops the nodes of what fails.
template <class Rule>
struct control : peg::normal<Rule> {
    template <peg::apply_mode A, peg::rewind_mode M, template <class...> class Action,
              template <class...> class Control, class In>
    static bool match(In& in, Reader& reader) {
        const std::size_t kept = reader.out.nodes.size();
        if (peg::match<Rule, A, M, Action, Control>(in, reader)) {
            return true;
        }
        reader.out.nodes.resize(kept);
        return false;
    }
};

struct terminal {
    using subs_t = peg::empty_list;
};
#define PUP_MATCH                                                                      \
    template <peg::apply_mode A, peg::rewind_mode M, template <class...> class Action, \
              template <class...> class Control, class In>                             \
    static bool match([[maybe_unused]] In& in, [[maybe_unused]] Reader& reader)

// One token of this kind.
template <Kind K>
struct tok : terminal {
    using rule_t = tok;
    PUP_MATCH {
        if (!in.empty() && *in.current() == static_cast<char>(K)) {
            in.bump_in_this_line(1);
            return true;
        }
        reader.miss(reader.at(in), K);
        return false;
    }
};

// Any word but the operators that are written as words.
struct word : terminal {
    using rule_t = word;
    static bool takes(Kind kind) {
        return (is_word(kind) && !is_word_operator(kind)) || kind == Kind::kQuotedName;
    }
    PUP_MATCH {
        if (!in.empty() && takes(reader.tokens[reader.at(in)].kind)) {
            in.bump_in_this_line(1);
            return true;
        }
        reader.miss(reader.at(in), Kind::kWord);
        return false;
    }
};

// The name of a simple unit.
struct unit_word : terminal {
    using rule_t = unit_word;
    PUP_MATCH {
        if (!in.empty() && reader.tokens[reader.at(in)].is_unit) {
            in.bump_in_this_line(1);
            return true;
        }
        reader.miss(reader.at(in), Kind::kUnitWord);
        return false;
    }
};

// No space before the next token: tells f(x) from f (x), m/s from m / s.
struct close : terminal {
    using rule_t = close;
    PUP_MATCH { return !in.empty() && !reader.tokens[reader.at(in)].space_before; }
};

// Not a sign that begins a value of its own: `starts -1` after a word, spaced like this, is two
// values of a property.
struct no_sign : terminal {
    using rule_t = no_sign;
    PUP_MATCH {
        const std::uint32_t i = reader.at(in);
        if (in.size() < 2 || i == 0) {
            return true;
        }
        const Token& sign = reader.tokens[i];
        return !((sign.kind == Kind::kMinus || sign.kind == Kind::kPlus) && sign.space_before &&
                 !reader.tokens[i + 1].space_before && is_word(reader.tokens[i - 1].kind));
    }
};

struct finish : terminal {
    using rule_t = finish;
    PUP_MATCH {
        if (in.empty()) {
            return true;
        }
        reader.miss(reader.at(in), Kind::kStatementEnd);
        return false;
    }
};

// Looks whether R comes, takes nothing, expects nothing.
template <class... R>
struct ahead {
    using rule_t = ahead;
    using subs_t = peg::type_list<R...>;
    PUP_MATCH {
        const std::size_t kept = reader.out.nodes.size();
        ++reader.quiet;
        auto mark = in.template mark<peg::rewind_mode::required>();
        const bool found =
            Control<peg::seq<R...>>::template match<A, peg::rewind_mode::active, Action, Control>(
                in, reader);
        --reader.quiet;
        reader.out.nodes.resize(kept);
        (void)mark;  // rewinds
        return found;
    }
};

template <NodeKind N, class... R>
struct node {
    using rule_t = node;
    using subs_t = peg::type_list<R...>;
    PUP_MATCH {
        const std::size_t here = reader.out.nodes.size();
        reader.out.nodes.push_back({N, reader.at(in), 0, 0});
        if (!Control<peg::seq<R...>>::template match<A, M, Action, Control>(in, reader)) {
            return false;
        }
        reader.out.nodes[here].end = reader.at(in);
        reader.out.nodes[here].next = static_cast<std::uint32_t>(reader.out.nodes.size());
        return true;
    }
};

// Counts recursion, so that no input can exhaust the stack.
template <class... R>
struct deeper {
    using rule_t = deeper;
    using subs_t = peg::type_list<R...>;
    PUP_MATCH {
        if (reader.depth >= kMaxNesting) {
            reader.out.too_deep = true;
            return false;
        }
        ++reader.depth;
        const bool matched =
            Control<peg::seq<R...>>::template match<A, M, Action, Control>(in, reader);
        --reader.depth;
        return matched;
    }
};

// clang-format off
template <class... R> using seq = peg::seq<R...>;
template <class... R> using sor = peg::sor<R...>;
template <class... R> using opt = peg::opt<R...>;
template <class... R> using star = peg::star<R...>;
template <class... R> using plus = peg::plus<R...>;
template <class R, Kind S> using list = peg::list<R, tok<S>>;
using N = NodeKind;
using K = Kind;

// ---- names, units, expressions

struct inner;  // an expression within brackets: `until` is an operator there

struct name : node<N::kName, word, star<close, tok<K::kOpenList>, inner, tok<K::kCloseList>>> {};
struct path : node<N::kPath, list<name, K::kDot>> {};
struct caption : node<N::kCaption, tok<K::kString>> {};

struct unit_power : seq<close, tok<K::kCaret>, close, opt<tok<K::kMinus>, close>, tok<K::kNumber>> {};
struct unit : node<N::kUnit, unit_word, opt<unit_power>,
                   star<close, sor<tok<K::kOver>, tok<K::kTimes>>, close, unit_word, opt<unit_power>>> {};

struct argument : node<N::kArgument, opt<ahead<name, tok<K::kColon>>, node<N::kLabel, name>, tok<K::kColon>>, inner> {};
struct arguments : node<N::kArguments, tok<K::kOpenParen>, opt<list<argument, K::kComma>>, tok<K::kCloseParen>> {};

struct number : node<N::kNumber, tok<K::kNumber>, opt<unit>> {};
struct bare_number : node<N::kNumber, tok<K::kNumber>> {};
struct text : node<N::kString, tok<K::kString>> {};
struct count : node<N::kCount, tok<K::kCount>, sor<seq<tok<K::kReady>, path>, path>> {};
struct parenthesis : node<N::kParen, tok<K::kOpenParen>, list<inner, K::kComma>, tok<K::kCloseParen>, opt<unit>> {};
struct brackets : node<N::kList, tok<K::kOpenList>, opt<list<inner, K::kComma>>, tok<K::kCloseList>, opt<unit>> {};
struct reference : seq<path, opt<close, arguments>> {};
struct operand : sor<number, text, count, parenthesis, brackets, reference> {};

template <Kind... Ks> struct op : node<N::kOp, sor<tok<Ks>...>> {};
struct prefix : op<K::kMinus, K::kPlus, K::kNot> {};
struct sum_op : op<K::kPlus, K::kMinus, K::kTimes, K::kOver, K::kCaret, K::kMod, K::kDiv, K::kDots> {};
struct any_op : op<K::kPlus, K::kMinus, K::kTimes, K::kOver, K::kCaret, K::kMod, K::kDiv, K::kDots, K::kEqual, K::kNotEqual,
                   K::kLess, K::kLessEqual, K::kGreater, K::kGreaterEqual, K::kAnd, K::kOr, K::kImplies> {};
struct path_op : sor<op<K::kUntil, K::kRelease>, node<N::kOp, tok<K::kWeak>, tok<K::kUntil>>> {};

template <class Operator>
struct chain : seq<star<prefix>, operand, star<Operator, star<prefix>, operand>> {};
template <class Self, class Operator>
struct expression : deeper<node<N::kExpr, chain<Operator>, opt<tok<K::kQuestion>, Self, tok<K::kColon>, Self>>> {};

struct expr : expression<expr, any_op> {};
struct inner : expression<inner, sor<any_op, path_op>> {};
struct sum : deeper<node<N::kExpr, chain<sum_op>>> {};  // no comparisons: `= 0` is what follows

// ---- parts of nets

struct binding : node<N::kBinding, path, tok<K::kEqual>, inner> {};
struct bindings : seq<tok<K::kOpenParen>, list<binding, K::kComma>, tok<K::kCloseParen>> {};
struct weight : node<N::kWeight, sor<bare_number, parenthesis, path>> {};
struct arc_term : seq<opt<weight, tok<K::kTimes>>, path, opt<bindings>> {};
struct arc : node<N::kArc, sor<seq<tok<K::kNow>, arc_term>, seq<tok<K::kAll>, tok<K::kNow>, arc_term>,
                               seq<tok<K::kAll>, arc_term>, arc_term>> {};
struct test : node<N::kArc, arc_term> {};
struct unless_test : node<N::kArc, sor<seq<tok<K::kReady>, arc_term>, arc_term>> {};

struct parameter : node<N::kParameter, name, opt<tok<K::kColon>, node<N::kType, sum>>,
                        opt<tok<K::kEqual>, node<N::kDefault, expr>>> {};
struct parameters : seq<tok<K::kOpenParen>, opt<list<parameter, K::kComma>>, tok<K::kCloseParen>> {};

template <class... R> struct clause : node<N::kClause, R...> {};

struct group : node<N::kGroup, expr, opt<bindings>, opt<tok<K::kReady>>> {};
struct duration : sor<tok<K::kAuto>, tok<K::kOpen>, seq<tok<K::kAs>, path>, expr> {};
struct place_clause : sor<
    clause<tok<K::kDoes>, expr>,
    clause<tok<K::kRuns>, expr>,
    clause<tok<K::kTakes>, duration>,
    clause<tok<K::kTokens>, list<group, K::kComma>>,
    clause<tok<K::kHolds>, tok<K::kAt>, tok<K::kMost>, expr>,
    clause<tok<K::kKeeps>, tok<K::kOrder>>,
    clause<tok<K::kDiscipline>, sor<tok<K::kOldest>, tok<K::kNewest>, tok<K::kFirst>, tok<K::kLast>, tok<K::kAny>,
                                    seq<sor<tok<K::kLeast>, tok<K::kMost>>, expr, opt<tok<K::kFirst>>>>>,
    clause<tok<K::kOf>, path, opt<parameters>>,
    clause<tok<K::kIs>, path>> {};

struct assignment : node<N::kBinding, path, tok<K::kAssign>, expr> {};
struct transition_clause : sor<
    clause<tok<K::kPriority>, expr>,
    clause<tok<K::kWhen>, expr>,
    clause<tok<K::kWith>, peg::list<test, sor<tok<K::kAnd>, tok<K::kPlus>>>>,
    clause<tok<K::kWhile>, peg::list<test, sor<tok<K::kAnd>, tok<K::kPlus>>>>,
    clause<tok<K::kUnless>, list<unless_test, K::kOr>>,
    clause<tok<K::kOn>, sor<seq<tok<K::kNext>, list<path, K::kOr>>, list<path, K::kOr>>>,
    clause<tok<K::kAfter>, expr>,
    clause<tok<K::kMemory>, sor<tok<K::kEnabling>, tok<K::kAge>, tok<K::kResample>>>,
    clause<tok<K::kServers>, sor<tok<K::kSingle>, tok<K::kInfinite>, expr>>,
    clause<tok<K::kFor>, sor<tok<K::kLeft>, expr>>,
    clause<tok<K::kSet>, list<assignment, K::kComma>>,
    clause<tok<K::kOdds>, expr>,
    clause<tok<K::kRaises>, list<path, K::kComma>>,
    clause<tok<K::kTogether>, tok<K::kWith>, list<path, K::kComma>>,
    clause<tok<K::kSend>, path, opt<tok<K::kTell>, expr>>,
    clause<tok<K::kReceive>, path, opt<tok<K::kHear>, expr>>,
    clause<tok<K::kPoll>, tok<K::kEvery>, expr>> {};

// ---- rules

template <class... R> struct form : node<N::kForm, R...> {};
struct form_list : seq<tok<K::kOpenParen>, list<inner, K::kComma>, tok<K::kCloseParen>> {};
struct bounded_list : seq<tok<K::kOpenParen>, list<argument, K::kComma>, tok<K::kCloseParen>> {};
struct binary_form : form<expr, sor<seq<tok<K::kOnly>, tok<K::kIf>, expr>,
                                    seq<tok<K::kLeads>, tok<K::kTo>, expr, opt<tok<K::kWithin>, expr>>,
                                    seq<tok<K::kTakes>, tok<K::kAt>, tok<K::kMost>, expr>>> {};
struct rule_end : seq<opt<node<N::kSettled, tok<K::kWhen>, tok<K::kSettled>>>, finish> {};
// A form that begins with a keyword, but only when the whole rule is one: a place may have a keyword's name.
template <class... R> struct whole : seq<form<R...>, rule_end> {};
struct rule_form : sor<
    whole<tok<K::kNever>, expr>,
    whole<tok<K::kAlways>, expr>,
    whole<tok<K::kPossible>, expr>,
    whole<tok<K::kMutex>, form_list>,
    whole<tok<K::kExactlyOne>, form_list>,
    whole<tok<K::kAlternate>, form_list>,
    whole<tok<K::kBounded>, opt<bounded_list>>,
    whole<tok<K::kDeadlockFree>>,
    whole<tok<K::kReversible>>,
    whole<tok<K::kEnds>>,
    whole<tok<K::kLive>, opt<form_list>>,
    whole<tok<K::kQuasiLive>, opt<form_list>>,
    whole<tok<K::kNobodyFreezes>, opt<form_list>>,
    whole<tok<K::kCtl>, inner>,
    whole<tok<K::kLtl>, inner>,
    whole<tok<K::kAfter>, expr, tok<K::kNo>, expr, tok<K::kUntil>, expr>,
    seq<binary_form, rule_end>> {};

// ---- questions

struct question_form : sor<
    form<sor<tok<K::kShortest>, tok<K::kLongest>>, tok<K::kTime>, tok<K::kTo>, expr>,
    form<tok<K::kCycle>, tok<K::kTime>, tok<K::kOf>, expr>> {};

// ---- measures

struct moment : node<N::kMoment, path, opt<tok<K::kOpenParen>, inner, tok<K::kCloseParen>>> {};
struct moments : node<N::kMoments, list<moment, K::kOr>> {};
struct above : opt<tok<K::kGreater>, expr> {};
struct measure_form : form<name, opt<bare_number>, tok<K::kOf>,
                           sor<seq<tok<K::kTime>, tok<K::kIn>, path, above>,
                               seq<tok<K::kTime>, tok<K::kFrom>, moments, tok<K::kTo>, moments, above>,
                               seq<expr, opt<tok<K::kAt>, moments>>>> {};

// ---- statements

template <NodeKind S, class... R> struct statement : node<S, R..., finish> {};
struct is_public : opt<tok<K::kPublic>> {};

struct place : statement<N::kPlace, is_public, opt<sor<tok<K::kStart>, tok<K::kFinish>>>, tok<K::kPlace>, name, opt<caption>,
                         star<place_clause>> {};
struct inputs : node<N::kInputs, opt<list<arc, K::kPlus>>> {};
struct outputs : node<N::kOutputs, opt<list<test, K::kPlus>>> {};
struct no_outputs : node<N::kOutputs> {};
struct transition : node<N::kTransition, is_public, name, opt<caption>, tok<K::kColon>, inputs, tok<K::kArrow>,
                         sor<seq<outputs, star<transition_clause>, finish>,
                             seq<no_outputs, star<transition_clause>, finish>>> {};
struct state : statement<N::kState, is_public, tok<K::kState>, name, opt<caption>, tok<K::kEqual>, expr> {};
struct machine_state : statement<N::kMachineState, is_public, tok<K::kState>, name, opt<caption>,
                                 star<sor<place_clause, clause<tok<K::kStarts>>, clause<tok<K::kFinal>>>>> {};
struct channel : statement<N::kChannel, is_public, tok<K::kChannel>, name, opt<caption>,
                           opt<tok<K::kOf>, node<N::kType, sum>>> {};
struct data : statement<N::kData, is_public, tok<K::kData>, name, opt<caption>, tok<K::kColon>, node<N::kType, sum>,
                        opt<tok<K::kEqual>, node<N::kDefault, expr>>> {};
struct token_type : statement<N::kToken, tok<K::kToken>, name, parameters> {};
struct event : statement<N::kEvent, is_public, opt<tok<K::kConsumed>>, tok<K::kEvent>, name, opt<caption>,
                         opt<sor<clause<tok<K::kAt>, list<expr, K::kComma>>,
                                 seq<clause<tok<K::kEvery>, expr>, opt<clause<tok<K::kFrom>, expr>>,
                                     opt<clause<tok<K::kUntil>, expr>>>>>> {};
struct events : statement<N::kEvents, tok<K::kEvents>, tok<K::kFrom>, text> {};
struct use : statement<N::kUse, tok<K::kUse>, sor<text, seq<path, opt<arguments>>>, opt<tok<K::kAs>, name>> {};
struct rule : node<N::kRule, tok<K::kRule>, name, opt<caption>, rule_form> {};
struct question : statement<N::kQuestion, tok<K::kQuestionWord>, name, opt<caption>, question_form> {};

struct measure : statement<N::kMeasure, tok<K::kMeasure>, name, opt<caption>, measure_form> {};

// What opens a block ends before its brace.
struct loop : statement<N::kFor, tok<K::kFor>, name, tok<K::kIn>, expr> {};
struct net : statement<N::kNet, sor<tok<K::kNet>, tok<K::kMachine>>, name, opt<parameters>, opt<caption>> {};
struct cast : statement<N::kCast, tok<K::kCast>> {};
struct ends : statement<N::kEnds, tok<K::kEnd>> {};
struct enumeration : statement<N::kEnum, tok<K::kEnum>, name> {};
// Its kind is any word that begins no other statement.
struct other_word : terminal {
    using rule_t = other_word;
    PUP_MATCH {
        if (!in.empty() && word::takes(reader.tokens[reader.at(in)].kind) && !begins_statement(reader.tokens[reader.at(in)].kind)) {
            in.bump_in_this_line(1);
            return true;
        }
        return false;
    }
};
struct block : statement<N::kBlock, node<N::kName, other_word>, opt<name>, opt<parameters>> {};

// ---- files

struct horizon : sor<seq<tok<K::kFrame>, expr>, seq<expr, opt<tok<K::kFirings>>>> {};
struct header_clause : sor<
    clause<tok<K::kLanguage>, bare_number>,
    clause<tok<K::kScene>, caption>,
    clause<tok<K::kFrames>, expr, tok<K::kPer>, tok<K::kSecond>>,
    clause<tok<K::kUntil>, horizon>,
    clause<tok<K::kSeed>, expr>,
    clause<tok<K::kPace>, expr>,
    clause<tok<K::kTime>, tok<K::kUnit>, expr>> {};
struct header : statement<N::kHeader, list<header_clause, K::kComma>> {};
struct import : statement<N::kImport, tok<K::kImport>, list<name, K::kComma>, tok<K::kFrom>, text> {};

// A transition is known by its colon; all others by their keywords, and a block by what is left: the driver has seen that
// a brace follows.
struct transition_ahead : ahead<is_public, name, opt<caption>, tok<K::kColon>> {};
struct any_statement : sor<seq<transition_ahead, transition>, place, state, machine_state, channel, data, token_type, event, events, use, rule,
                           question, measure, loop, net, cast, ends, enumeration, header, import, block> {};

struct value_expr : expression<value_expr, seq<no_sign, any_op>> {};
struct value : sor<value_expr, node<N::kSymbol, sor<tok<K::kArrow>, tok<K::kColon>, tok<K::kAssign>, tok<K::kEqual>>>> {};
struct property : statement<N::kProperty, path, star<value>> {};
struct member : statement<N::kMember, name, tok<K::kColon>, name> {};
struct formula : statement<N::kFormula, expr> {};
struct enum_value : statement<N::kValue, name> {};
// clang-format on

#undef PUP_MATCH

template <class Rule>
bool read(std::span<const Token> tokens, std::span<const char> kinds, std::uint32_t begin,
          std::uint32_t end, Reading& out) {
    Reader reader{tokens, kinds.data(), out};
    peg::memory_input<peg::tracking_mode::lazy, peg::eol::lf, const char*> in(
        kinds.data() + begin, kinds.data() + end, "");
    return peg::parse<Rule, peg::nothing, control>(in, reader);
}

}  // namespace

bool read_statement(Entry entry, std::span<const Token> tokens, std::span<const char> kinds,
                    std::uint32_t begin, std::uint32_t end, Reading& out) {
    out.nodes.clear();
    out.furthest = begin;
    out.expected.reset();
    out.too_deep = false;
    bool good = false;
    switch (entry) {
        case Entry::kStatement:
            good = read<any_statement>(tokens, kinds, begin, end, out);
            break;
        case Entry::kProperty:
            good = read<property>(tokens, kinds, begin, end, out);
            break;
        case Entry::kMember:
            good = read<member>(tokens, kinds, begin, end, out);
            break;
        case Entry::kFormula:
            good = read<formula>(tokens, kinds, begin, end, out);
            break;
        case Entry::kEnumValue:
            good = read<enum_value>(tokens, kinds, begin, end, out);
            break;
    }
    if (!good) {
        out.nodes.clear();
    }
    return good;
}

}  // namespace puppetri::lang
