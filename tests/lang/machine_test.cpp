// SPDX-License-Identifier: MIT
// Machines and channels as the parser reads them and the formatter writes them.
#include <doctest/doctest.h>

#include "lang/dump.h"
#include "puppetri/lang/format.h"
#include "puppetri/lang/parse.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

constexpr const char* kText = R"(enum Phase { up, down }
channel 'to left' "what the leg is told" of Phase
public channel bell
machine leg(me: actor, orders: channel) "one leg" {
  data seen: Phase = down
  state standing "it stands"                      starts final
  state lifted                does me.step(left)  takes 20 frames
  state moved = lifted

  lift: standing -> lifted    receive orders?up
  any:  lifted   -> standing  when seen = up receive row[2].orders?seen set seen := up
  ring: lifted   -> lifted    send bell poll every 40 ms
  tell: standing -> standing  send orders!seen = up ? down : up
}
use "legs.tookima" as legs {
  LEFT_LEG:  ana.left_leg
  RIGHT_LEG: ana.right_leg
}
use 'leg' as l
)";

std::string codes(const std::string& text) {
    std::string out;
    for (const Diagnostic& d : parse(text, "t.pup").diagnostics) {
        out += std::to_string(d.where.line) + " " + d.code + "\n";
        CHECK_FALSE(d.remedy.empty());
    }
    return out;
}

}  // namespace

TEST_CASE("a machine is a net whose states are places, with ends of channels [unit]") {
    const Parsed result = parse(kText, "t.pup");
    REQUIRE(result.diagnostics.empty());
    const Body& file = result.file.body;
    REQUIRE(file.channels.size() == 2);
    CHECK(file.channels[0].name.text == "to left");
    CHECK(to_text(file.channels[0].type) == "Phase");
    CHECK(file.channels[1].is_public);
    CHECK(file.channels[1].type.kind == ExprKind::kNone);
    REQUIRE(file.nets.size() == 1);
    const Net& leg = file.nets[0];
    CHECK(leg.is_machine);
    REQUIRE(leg.body.places.size() == 2);
    CHECK(leg.body.places[0].starts);
    CHECK(leg.body.places[0].final);
    CHECK_FALSE(leg.body.places[1].starts);
    CHECK(leg.body.states.size() == 1);
    REQUIRE(leg.body.transitions.size() == 4);
    const auto& t = leg.body.transitions;
    CHECK(to_text(t[0].receive) == "orders");
    CHECK(to_text(t[0].received) == "up");
    CHECK(to_text(t[1].receive) == "row[2].orders");
    CHECK(t[1].assignments.size() == 1);
    CHECK(to_text(t[2].send) == "bell");
    CHECK_FALSE(t[2].message);
    CHECK(to_text(t[2].poll) == "40 ms");
    CHECK(t[3].message.kind == ExprKind::kConditional);
    // A file in another notation is imported and used in one line.
    REQUIRE(result.file.imports.size() == 1);
    CHECK(result.file.imports[0].path == "legs.tookima");
    CHECK(result.file.imports[0].names[0].text == "legs");
    REQUIRE(file.uses.size() == 2);
    REQUIRE(file.uses[0].args.size() == 2);
    CHECK(file.uses[0].args[1].name.text == "RIGHT_LEG");
    CHECK(to_text(file.uses[0].args[1].value) == "ana.right_leg");
}

TEST_CASE("machines have a canonical form, and it says the same [unit]") {
    const auto once = format(kText, "t.pup");
    REQUIRE(once.has_value());
    CHECK(*once == std::string(kText));
    std::string loose = kText;
    for (const char* tight : {"orders?up", "orders!seen"}) {
        const std::size_t at = loose.find(tight);
        loose.replace(at + 6, 1, std::string(" ") + loose[at + 6] + " ");
    }
    CHECK(testing::Dump::of(parse(loose, "t.pup").file) ==
          testing::Dump::of(parse(kText, "t.pup").file));
    CHECK(format(loose, "t.pup").value() == std::string(kText));
}

TEST_CASE("what a machine cannot say is told where it stands [unit]") {
    const auto within = [](const std::string& line) {
        return codes("machine m(c: channel) {\n  state s starts\n" + line + "\n}\n");
    };
    CHECK(within("  t: s -> s send c!1").empty());
    CHECK(within("  place p") == "3 misplaced\n");
    CHECK(within("  t: s -> s send c!1 receive c?x") == "3 conflicting-clauses\n");
    CHECK(within("  t: s -> s send c!1 send c!2") == "3 repeated-clause\n");
    CHECK(within("  t: s -> s poll every 1 s on e") == "3 conflicting-clauses\n");
    CHECK(within("  t: s -> s recieve c?x") == "3 unknown-keyword\n");
    CHECK(within("  t: s -> s when !x") == "3 invalid-character\n");
    // Of nets.
    CHECK(codes("net n {\n  state s takes 2 s\n}\n") == "2 syntax\n");
    CHECK(codes("state s\n") == "1 syntax\n");
    CHECK(codes("t: a -> b poll every 2 s\n") == "1 misplaced\n");
    CHECK(codes("machin m {\n  state s starts\n}\n") == "1 unknown-keyword\n");
    CHECK(codes("use \"x.tookima\" as x {\n  A b\n}\n") == "2 syntax\n");
}
