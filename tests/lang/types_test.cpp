// SPDX-License-Identifier: MIT
// Calls against signatures: every way of being wrong has its code, its place and its remedy.
#include "puppetri/lang/types.h"

#include <doctest/doctest.h>

#include <map>

#include "puppetri/lang/parse.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

Type thing(const char* name) { return {TypeKind::kThing, {}, name, {}}; }
Type quantity(Dimension d) { return {TypeKind::kQuantity, d, {}, {}}; }

// A scene of one actor, one ball, a time and two movements.
struct Scene : Resolver {
    std::map<std::string, Type> names = {{"ana", thing("actor")},
                                         {"rui", thing("actor")},
                                         {"ball", thing("prop")},
                                         {"n", quantity(dimension::kTime)},
                                         {"k", {TypeKind::kInteger, {}, {}, {}}}};
    Signature carry{"carry", {{"object", thing("prop"), true, ""}}, "carries", false};

    std::optional<Type> type_of(const Path& path) const override {
        const auto found = names.find(to_text(path));
        return found == names.end() ? std::nullopt : std::optional(found->second);
    }
    const Signature* signature_of(const Path& callee) const override {
        return to_text(callee) == "carry" ? &carry : nullptr;
    }
    std::vector<std::string> names_near(const Path&) const override {
        std::vector<std::string> out;
        for (const auto& [name, type] : names) {
            out.push_back(name);
        }
        return out;
    }
};

const Signature kThrow{"throw",
                       {{"object", thing("prop"), true, ""},
                        {"to", thing("actor"), true, ""},
                        {"speed", quantity(dimension::kSpeed), false, "5 m/s"},
                        {"within", quantity(dimension::kTime), false, ""},
                        {"hand", {TypeKind::kWord, {}, {}, {"left", "right"}}, false, "right"},
                        {"arms", thing("movement"), false, ""},
                        {"at", {TypeKind::kPoint, dimension::kLength, {}, {}}, false, ""},
                        {"count", {TypeKind::kInteger, {}, {}, {}}, false, "1"},
                        {"high", {TypeKind::kBool, {}, {}, {}}, false, "no"},
                        {"label", {TypeKind::kText, {}, {}, {}}, false, ""}},
                       "throws",
                       false};

// "COLUMN code" of each defect of a call; "" when there is none.
std::string defects(const std::string& call, const Signature& signature = kThrow) {
    const Parsed parsed = parse("state s = " + call, "t.pup");
    REQUIRE(parsed.diagnostics.empty());
    const Checked<BoundArguments> bound = check_call(
        parsed.file, parsed.file.body.states[0].formula, signature, Scene(), "place a.throwing");
    std::string out;
    if (!bound) {
        for (const Diagnostic& d : bound.error()) {
            CHECK(d.element == "place a.throwing");
            CHECK(!d.remedy.empty());
            out += (out.empty() ? "" : ", ") + std::to_string(d.where.column) + " " + d.code;
        }
    }
    return out;
}
std::string remedy(const std::string& call) {
    const Parsed parsed = parse("state s = " + call, "t.pup");
    return check_call(parsed.file, parsed.file.body.states[0].formula, kThrow, Scene(), "x")
        .error()[0]
        .remedy;
}

}  // namespace

TEST_CASE("arguments are bound by place and by name [unit]") {
    const Parsed parsed = parse("state s = throw(ball, speed: 3 m/s, to: rui)", "t.pup");
    const Checked<BoundArguments> bound =
        check_call(parsed.file, parsed.file.body.states[0].formula, kThrow, Scene(), "x");
    REQUIRE(bound.has_value());
    CHECK(to_text(*bound.value().values[0]) == "ball");
    CHECK(to_text(*bound.value().values[1]) == "rui");
    CHECK(to_text(*bound.value().values[2]) == "3 m/s");
    CHECK(bound.value().values[3] == nullptr);
}

TEST_CASE("good arguments of every type [unit]") {
    CHECK(defects("throw(ball, rui, 2*3 m/s, n/2 + 12 ms, left, carry(ball), (1, 2, 3) m, k + 1, "
                  "yes, \"x\")") == "");
    CHECK(defects("throw(ball, rui, within: 12 frames)") ==
          "");  // frames are a time once a rate is known
    CHECK(defects("throw(ball, rui, within: k*n, high: k > 2)") == "");
    CHECK(defects("throw(ball, rui, speed: 3 m / (2 s))") == "");
    CHECK(defects("throw(ball, rui, at: (1 m, 2 cm, 0 m))") == "");
}

TEST_CASE("each slip has its code and its place [unit]") {
    CHECK(defects("throw(ball)") == "11 missing-argument");
    CHECK(defects("throw(ball, rui, sped: 3 m/s)") == "28 unknown-argument");
    CHECK(defects("throw(ball, rui, object: ball)") == "36 repeated-argument");
    CHECK(defects("throw(ball, rui, speed: 3 s)") == "35 wrong-unit");
    CHECK(defects("throw(ball, rui, within: 3)") == "36 wrong-unit");
    CHECK(defects("throw(ball, rui, within: n + 3 m)") == "40 wrong-unit");
    CHECK(defects("throw(rui, ball)") == "17 wrong-type, 22 wrong-type");
    CHECK(defects("throw(bal, rui)") == "17 unknown-name");
    CHECK(defects("throw(ball, rui, hand: lefft)") == "34 unknown-name");
    CHECK(defects("throw(ball, rui, arms: cary(ball))") == "34 unknown-name");
    CHECK(defects("throw(ball, rui, arms: carry(rui))") == "40 wrong-type");
    CHECK(defects("throw(ball, rui, arms: carry())") == "34 missing-argument");
    CHECK(defects("throw(ball, rui, at: (1, 2) m)") == "32 wrong-type");
    CHECK(defects("throw(ball, rui, at: (1, 2, 3) s)") == "42 wrong-unit");
    CHECK(defects("throw(ball, rui, at: (1 m, 2, 3) m)") == "33 wrong-unit");
    CHECK(defects("throw(ball, rui, count: 1.5)") == "35 wrong-type");
    CHECK(defects("throw(ball, rui, high: 3)") == "34 wrong-type");
    CHECK(defects("throw(ball, rui, label: 3)") == "35 wrong-type");
    CHECK(defects("throw(ball, rui, 1 m/s, 1 s, left, carry(ball), (0, 0, 0) m, 1, no, \"\", 3)") ==
          "83 too-many-arguments");
    CHECK(defects("throw(sped: 3, to: ball, foo: 1)") ==
          "17 unknown-argument, 30 wrong-type, 36 unknown-argument, 11 missing-argument");
}

TEST_CASE("remedies say what to write [unit]") {
    CHECK(remedy("throw(bal, rui)") == "did you mean ball?");
    CHECK(remedy("throw(ball, rui, sped: 3 m/s)") == "did you mean speed?");
    CHECK(remedy("throw(ball, rui, hand: lefft)") == "did you mean left?");
    CHECK(remedy("throw(ball, rui, speed: 3 s)") == "write it in m/s");
}

TEST_CASE("the last parameter of a variadic signature repeats [unit]") {
    const Signature look{"look", {{"at", thing("actor"), true, ""}}, "looks", true};
    CHECK(defects("look(ana, rui, rui)", look) == "");
    CHECK(defects("look(ana, ball)", look) == "21 wrong-type");
}
