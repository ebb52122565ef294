// SPDX-License-Identifier: MIT
// Queries of the contest: every formula of every file against a reader of tags that shares nothing
// with ours, and each construct by hand.
#include "puppetri/io/contest_queries.h"

#include <doctest/doctest.h>

#include <map>
#include <sstream>

#include "puppetri/io/pnml.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;
using net::FormulaOp;
using verdict::ContestQuery;
using verdict::QueryKind;

namespace {

// ------------------------------------------------------------------------------------------------
// Both sides print a formula in one notation.

std::string expression_text(const Expr& e, const net::NetDraft& draft, std::uint32_t at) {
    const Expr::Node& n = e.nodes()[at];
    const auto both = [&](const char* op) {
        return std::string("(") + op + " " + expression_text(e, draft, n.a) + " " +
               expression_text(e, draft, n.b) + ")";
    };
    switch (n.op) {
        case ExprOp::kLiteral:
            return std::to_string(n.literal);
        case ExprOp::kSlot:
            return "#" + draft.places[n.slot.index].path;
        case ExprOp::kAdd:
            return both("+");
        case ExprOp::kSubtract:
            return both("-");
        case ExprOp::kMultiply:
            return both("*");
        case ExprOp::kLessEqual:
            return both("<=");
        case ExprOp::kLess:
            return both("<");
        case ExprOp::kGreaterEqual:
            return both(">=");
        case ExprOp::kGreater:
            return both(">");
        case ExprOp::kEqual:
            return both("==");
        default:
            return both("!=");
    }
}

std::string expression_text(const Expr& e, const net::NetDraft& draft) {
    return expression_text(e, draft, static_cast<std::uint32_t>(e.nodes().size()) - 1);
}

std::string formula_text(const net::Formula& f, const net::NetDraft& draft, std::uint32_t at) {
    const net::Formula::Node& n = f.nodes[at];
    const auto unary = [&](const char* op) {
        return std::string("(") + op + " " + formula_text(f, draft, n.a) + ")";
    };
    const auto binary = [&](const char* op) {
        return std::string("(") + op + " " + formula_text(f, draft, n.a) + " " +
               formula_text(f, draft, n.b) + ")";
    };
    switch (n.op) {
        case FormulaOp::kConstant:
            return n.count != 0 ? "true" : "false";
        case FormulaOp::kExpr:
            return expression_text(f.expressions[n.index], draft);
        case FormulaOp::kFireable:
            return "fireable:" + draft.transitions[n.index].path;
        case FormulaOp::kNot:
            return unary("not");
        case FormulaOp::kAnd:
            return binary("and");
        case FormulaOp::kOr:
            return binary("or");
        case FormulaOp::kImplies:
            return binary("implies");
        case FormulaOp::kIff:
            return binary("iff");
        case FormulaOp::kAllNext:
            return unary("AX");
        case FormulaOp::kAllGlobally:
            return unary("AG");
        case FormulaOp::kAllFinally:
            return unary("AF");
        case FormulaOp::kAllUntil:
            return binary("AU");
        case FormulaOp::kSomeNext:
            return unary("EX");
        case FormulaOp::kSomeGlobally:
            return unary("EG");
        case FormulaOp::kSomeFinally:
            return unary("EF");
        case FormulaOp::kSomeUntil:
            return binary("EU");
        case FormulaOp::kNext:
            return unary("X");
        case FormulaOp::kGlobally:
            return unary("G");
        case FormulaOp::kFinally:
            return unary("F");
        case FormulaOp::kUntil:
            return binary("U");
        default:
            return "?";
    }
}

std::string text_of_query(const ContestQuery& q, const net::NetDraft& draft) {
    if (q.kind == QueryKind::kUpperBound) {
        return expression_text(q.bound, draft);
    }
    return formula_text(q.formula, draft, static_cast<std::uint32_t>(q.formula.nodes.size()) - 1);
}

// ------------------------------------------------------------------------------------------------
// The other reader: a list of tags, walked once.

class Tags {
 public:
    explicit Tags(const std::string& text) : text_(text) {}

    // The text of the next element's formula in the notation above. A path quantifier is joined to
    // the letter of the temporal operator inside it, unless `linear`.
    std::string formula(bool linear) {
        const std::string name = open();
        if (name == "all-paths" || name == "exists-path") {
            std::string inner = formula(linear);
            close();
            if (!linear) {
                inner.insert(1, name == "all-paths" ? "A" : "E");
            }
            return inner;
        }
        static const std::map<std::string, std::string> kNames = {
            {"negation", "not"},  {"conjunction", "and"}, {"disjunction", "or"},
            {"finally", "F"},     {"globally", "G"},      {"next", "X"},
            {"integer-le", "<="}, {"integer-lt", "<"},    {"integer-ge", ">="},
            {"integer-gt", ">"},  {"integer-eq", "=="}};
        if (name == "until") {
            open();
            const std::string before = formula(linear);
            close();
            open();
            const std::string reach = formula(linear);
            close();
            close();
            return "(U " + before + " " + reach + ")";
        }
        if (name == "integer-constant") {
            const std::string number = words();
            close();
            return number;
        }
        if (name == "tokens-count" || name == "place-bound" || name == "is-fireable") {
            const bool counts = name != "is-fireable";
            std::string all;
            while (!at_close()) {
                open();
                const std::string one = (counts ? "#" : "fireable:") + words();
                all = all.empty() ? one : (counts ? "(+ " : "(or ") + all + " " + one + ")";
                close();
            }
            close();
            return all;
        }
        std::vector<std::string> parts;
        while (!at_close()) {
            parts.push_back(formula(linear));
        }
        close();
        const auto known = kNames.find(name);
        REQUIRE_MESSAGE(known != kNames.end(), name);
        if (parts.size() == 1) {
            return name == "conjunction" || name == "disjunction"
                       ? parts[0]
                       : "(" + known->second + " " + parts[0] + ")";
        }
        std::string all = parts[0];
        for (std::size_t i = 1; i < parts.size(); ++i) {
            all = "(" + known->second + " " + all + " " + parts[i] + ")";
        }
        return all;
    }

    // Moves to the next <formula> and into it; false: there is none.
    bool next_formula() {
        const std::size_t found = text_.find("<formula>", at_);
        at_ = found == std::string::npos ? at_ : found + 9;
        return found != std::string::npos;
    }

 private:
    std::string open() {
        const std::size_t begin = text_.find('<', at_);
        const std::size_t end = text_.find('>', begin);
        at_ = end + 1;
        return text_.substr(begin + 1, end - begin - 1);
    }
    bool at_close() const { return text_[text_.find('<', at_) + 1] == '/'; }
    void close() { at_ = text_.find('>', text_.find('<', at_)) + 1; }
    std::string words() {
        const std::size_t end = text_.find('<', at_);
        std::string out = text_.substr(at_, end - at_);
        out.erase(0, out.find_first_not_of(" \n\t\r"));
        out.erase(out.find_last_not_of(" \n\t\r") + 1);
        at_ = end;
        return out;
    }

    const std::string& text_;
    std::size_t at_ = 0;
};

std::size_t check_file(const std::string& model, const std::string& queries, bool linear) {
    CAPTURE(queries);
    const Checked<NetFile> net = read_pnml(file_text(model), model);
    REQUIRE(net.has_value());
    const std::string text = file_text(queries);
    const Checked<ContestQueries> read = read_contest_queries(text, queries, *net);
    if (!read) {
        FAIL(read.error()[0].message);
    }
    Tags tags(text);
    for (const ContestQuery& q : read->queries) {
        CAPTURE(q.id);
        REQUIRE(tags.next_formula());
        if (text.find("<deadlock") != std::string::npos) {
            continue;  // long: by hand below
        }
        std::string expected = tags.formula(linear && q.kind == QueryKind::kLtl);
        REQUIRE(text_of_query(q, net->draft) == expected);
        CHECK(!q.exists);
    }
    CHECK(!tags.next_formula());
    return read->queries.size();
}

// A small net, and one property about it.
constexpr const char* kNet = R"(<pnml><net id="n" type="ptnet">
<place id="p"/><place id="q"><initialMarking><text>2</text></initialMarking></place>
<transition id="t"/><transition id="u"/>
<arc id="a" source="q" target="t"/><arc id="b" source="t" target="p"/>
<arc id="c" source="p" target="u"/></net></pnml>)";

Checked<ContestQueries> ask(const std::string& formula) {
    const Checked<NetFile> net = read_pnml(kNet, "n.pnml");
    REQUIRE(net.has_value());
    return read_contest_queries("<property-set><property><id>x</id><formula>" + formula +
                                    "</formula></property></property-set>",
                                "q.xml", *net);
}

std::string answer(const std::string& formula) {
    const Checked<NetFile> net = read_pnml(kNet, "n.pnml");
    const Checked<ContestQueries> read = ask(formula);
    if (!read) {
        return read.error()[0].code;
    }
    const ContestQuery& q = read->queries.at(0);
    const char* kinds[] = {"reach ", "ctl ", "ltl ", "bound "};
    return kinds[static_cast<int>(q.kind)] + std::string(q.exists ? "E " : "") +
           text_of_query(q, net->draft);
}

const std::string kP = "<tokens-count><place>p</place></tokens-count>";
const std::string kOne = "<integer-constant>1</integer-constant>";
const std::string kAtom = "<integer-le>" + kOne + kP + "</integer-le>";

}  // namespace

TEST_CASE("every query of the contest is read as its tags say [oracle]") {
    std::size_t properties = 0;
    for (const std::string& model : shared_nets("mcc", "model.pnml")) {
        const std::string folder = model.substr(0, model.rfind('/') + 1);
        for (const char* kind :
             {"ReachabilityCardinality", "ReachabilityFireability", "CTLCardinality",
              "CTLFireability", "LTLCardinality", "LTLFireability", "UpperBounds"}) {
            properties += check_file(model, folder + kind + ".xml", kind[0] == 'L');
        }
    }
    CHECK((properties == 0 || properties == 21 * 7 * 16));
}

TEST_CASE("every query of the nets with inhibitor arcs is read as its tags say [oracle]") {
    for (const std::string& model : shared_nets("inhibitor", "model.pnml")) {
        CHECK(check_file(model, model.substr(0, model.rfind('/') + 1) + "query.xml", false) > 0);
    }
}

TEST_CASE("each element of a query means what the contest's manual says [unit]") {
    CHECK(answer("<exists-path><finally>" + kAtom + "</finally></exists-path>") ==
          "reach (EF (<= 1 #p))");
    CHECK(answer("<all-paths><globally><negation>" + kAtom +
                 "</negation></globally></all-paths>") == "reach (AG (not (<= 1 #p)))");
    CHECK(answer("<all-paths><finally>" + kAtom + "</finally></all-paths>") ==
          "ctl (AF (<= 1 #p))");
    CHECK(answer("<all-paths><next><exists-path><globally><true/></globally></exists-path></next>"
                 "</all-paths>") == "ctl (AX (EG true))");
    CHECK(answer("<exists-path><until><before>" + kAtom + "</before><reach><false/></reach>" +
                 "</until></exists-path>") == "ctl (EU (<= 1 #p) false)");
    CHECK(answer(kAtom) == "ctl (<= 1 #p)");
    CHECK(answer("<all-paths>" + kAtom + "</all-paths>") == "ctl (<= 1 #p)");
    CHECK(answer("<integer-gt><tokens-count><place>p</place><place>q</place></tokens-count>" +
                 kOne + "</integer-gt>") == "ctl (> (+ #p #q) 1)");
    CHECK(answer("<integer-ne><integer-sum>" + kP + kOne + "</integer-sum><integer-product>" + kP +
                 kOne + "</integer-product></integer-ne>") == "ctl (!= (+ #p 1) (* #p 1))");
    CHECK(answer("<integer-eq><integer-difference>" + kP + kOne + "</integer-difference>" + kOne +
                 "</integer-eq>") == "ctl (== (- #p 1) 1)");
    CHECK(answer("<integer-lt>" + kOne + kOne + "</integer-lt>") == "ctl false");
    CHECK(answer("<is-fireable><transition>t</transition><transition>u</transition>"
                 "</is-fireable>") == "ctl (or fireable:t fireable:u)");
    CHECK(answer("<exists-path><finally><deadlock/></finally></exists-path>") ==
          "reach (EF (not (or fireable:t fireable:u)))");
    CHECK(answer("<exclusive-disjunction>" + kAtom + "<true/></exclusive-disjunction>") ==
          "ctl (not (iff (<= 1 #p) true))");
    CHECK(answer("<implication><true/><equivalence><true/><false/></equivalence></implication>") ==
          "ctl (implies true (iff true false))");
    CHECK(answer("<place-bound><place>p</place><place>q</place></place-bound>") ==
          "bound (+ #p #q)");
}

TEST_CASE("linear formulas have one quantifier, also behind negations [unit]") {
    const std::string gf = "<globally><finally>" + kAtom + "</finally></globally>";
    CHECK(answer("<all-paths>" + gf + "</all-paths>") == "ltl (G (F (<= 1 #p)))");
    CHECK(answer("<exists-path>" + gf + "</exists-path>") == "ltl E (G (F (<= 1 #p)))");
    CHECK(answer("<negation><all-paths>" + gf + "</all-paths></negation>") ==
          "ltl E (not (G (F (<= 1 #p))))");
    CHECK(answer("<all-paths><disjunction>" + gf +
                 "<next><true/></next></disjunction>"
                 "</all-paths>") == "ltl (or (G (F (<= 1 #p))) (X true))");
}

TEST_CASE("what is neither CTL nor LTL is refused, and so is what is not known [unit]") {
    const std::string gf = "<globally><finally>" + kAtom + "</finally></globally>";
    CHECK(answer("<conjunction><all-paths>" + gf + "</all-paths><true/></conjunction>") ==
          "not-ctl-not-ltl");
    CHECK(answer("<finally>" + kAtom + "</finally>") == "not-ctl-not-ltl");
    CHECK(answer("<possibly><true/></possibly>") == "unknown-element");
    CHECK(answer("<is-fireable><transition>v</transition></is-fireable>") == "unknown-id");
    CHECK(answer("<integer-le>" + kOne + "</integer-le>") == "wrong-operands");
    CHECK(answer("<negation/>") == "wrong-operands");
    CHECK(answer("<until><before><true/></before></until>") == "wrong-operands");
    CHECK(answer("<integer-le><integer-constant>x</integer-constant>" + kP + "</integer-le>") ==
          "not-a-number");
    CHECK(answer("<next steps=\"2\"><true/></next>") == "unknown-attribute");
    std::string deep = "<true/>";
    for (int i = 0; i < 5000; ++i) {
        deep = "<negation>" + deep + "</negation>";
    }
    CHECK(answer(deep) == "nested-too-deep");
}

TEST_CASE("answers are ordered by id as texts, and an id names one property [unit]") {
    const Checked<NetFile> net = read_pnml(kNet, "n.pnml");
    const auto property = [](const std::string& id) {
        return "<property><id>" + id + "</id><formula><true/></formula></property>";
    };
    const Checked<ContestQueries> read = read_contest_queries(
        "<property-set>" + property("x-2") + property("x-10") + property("x-1") + "</property-set>",
        "q.xml", *net);
    REQUIRE(read.has_value());
    CHECK(read->rank == std::vector<std::uint32_t>{2, 1, 0});
    CHECK(!read_contest_queries(
               "<property-set>" + property("x") + property("x") + "</property-set>", "q.xml", *net)
               .has_value());
}
