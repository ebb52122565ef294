// SPDX-License-Identifier: MIT
// Who holds a prop: claimed before anything moves, and true of what is performed.
#include <set>
#include <string>

#include "proved_scene.h"
#include "puppetri/scene/perform.h"

namespace puppetri::verdict {
namespace {

const char* const kTwo = R"(
cast {
  ana:  mannequin { at (-1.5, 0, 0) m, facing 90 deg }
  rui:  mannequin { at (1.5, 0, 0) m, facing -90 deg }
  ball: sphere    { diameter 22 cm, held by ana.hands }
}
place a_has     does ana.hold(ball)              takes 1 s    tokens 1
place a_throws  does ana.throw(ball, to: rui)
place a_free
place a_waits   does ana.ready(ball, from: rui)  takes 0.5 s
place a_catches does ana.catch(ball)
place r_has     does rui.hold(ball)              takes 1 s
place r_throws  does rui.throw(ball, to: ana)
place r_free                                                  tokens 1
place r_waits   does rui.ready(ball, from: ana)  takes 0.5 s
place r_catches does rui.catch(ball)
place fly_over  does ball.fly(from: ana, to: rui)
place fly_back  does ball.fly(from: rui, to: ana)
a_throw:  a_has              -> a_throws  with r_waits
a_let_go: a_throws           -> fly_over + a_free
r_wait:   r_free             -> r_waits
r_catch:  r_waits + fly_over -> r_catches
r_got:    r_catches          -> r_has
r_throw:  r_has              -> r_throws  with a_waits
r_let_go: r_throws           -> fly_back + r_free
a_wait:   a_free             -> a_waits
a_catch:  a_waits + fly_back -> a_catches
a_got:    a_catches          -> a_has
)";

TEST_CASE("who must hold the ball is proved from catches, throws and flights [oracle]") {
    const ProvedScene s(std::string(kTwo) + R"(
rule apart     never (ball.holder = ana.hands and ball.holder = rui.hands)
rule somewhere exactly_one(ball.holder = ana.hands, ball.holder = rui.hands, ball.holder = air)
rule dry       never (ball.holder = floor)
rule has       always (a_has implies ball.holder = ana.hands)
rule caught    always (r_catches implies ball.holder = rui.hands)
rule flying    always (fly_over implies ball.holder = air)
rule free      never (a_free and ball.holder = ana.hands)
rule gets      ball.holder = ana.hands leads to ball.holder = rui.hands
rule again     ctl AG(AF(ball.holder = rui.hands))
rule always_a  always (ball.holder = ana.hands)
rule still     always (a_throws implies ball.holder = ana.hands)
rule in_air    possible (ball.holder = air)
)");
    for (const char* rule :
         {"apart", "somewhere", "dry", "has", "caught", "flying", "free", "again"}) {
        CHECK(s.says(rule) == "PROVED");
    }
    CHECK(s.says("gets") == "PROVED for every choice");
    CHECK(s.says("always_a") == "REFUTED");
    CHECK(s.says("in_air") == "PROVED");
    // A release comes up to a millisecond before the token is ready: nobody claims that it does
    // not.
    CHECK(s.of("still").answer != Answer::kProved);
    CHECK(std::any_of(s.of("caught").assumptions.begin(), s.of("caught").assumptions.end(),
                      [](const std::string& a) { return a.find("r_catches") != a.npos; }));
}

TEST_CASE("what nobody catches may lie on the floor [oracle]") {
    const ProvedScene s(R"(
cast {
  ana:  mannequin { at (-1.5, 0, 0) m, facing 90 deg }
  rui:  mannequin { at (1.5, 0, 0) m, facing -90 deg }
  ball: sphere    { diameter 22 cm, held by ana.hands }
}
place has    does ana.hold(ball)           takes 1 s  tokens 1
place throws does ana.throw(ball, to: rui)
place flies  does ball.fly(from: ana, to: rui)
place other  does rui.face(90 deg)         takes 9 s  tokens 1
place over
throw:  has           -> throws
let_go: throws        -> flies
late:   flies + other -> over
rule up     always (flies implies ball.holder = air)
rule floor  never (ball.holder = floor)
rule caught possible (ball.holder = rui.hands)
)");
    CHECK(s.says("floor") == "REFUTED");
    CHECK(s.says("up") == "REFUTED");
    CHECK(s.says("caught") == "REFUTED");  // nobody catches
}

TEST_CASE("two tokens for one ball: nothing is claimed of its holder [oracle]") {
    const ProvedScene s(R"(
cast {
  ana:  mannequin { at (-1.5, 0, 0) m, facing 90 deg }
  rui:  mannequin { at (1.5, 0, 0) m, facing -90 deg }
  ball: sphere    { diameter 22 cm, held by ana.hands }
}
place a      does ana.catch(ball)          takes 1 s  tokens 1
place r      does rui.catch(ball)          takes 1 s  tokens 1
place done
ad: a -> done
rd: r -> done
rule hers always (a implies ball.holder = ana.hands)
rule his  always (r implies ball.holder = rui.hands)
)");
    CHECK(s.of("hers").answer != Answer::kProved);
    CHECK(s.of("his").answer != Answer::kProved);
}

TEST_CASE("performances keep what is claimed of holders [law]") {
    scene::MemoryFiles files;
    files.add("test.pup",
              std::string("language 1\nscene \"two\"\nframes 24 per second, until 20 s\n") + kTwo);
    const auto scene = scene::load(files, "test.pup");
    REQUIRE(scene.has_value());
    const auto performed = scene::perform(*scene, {});
    REQUIRE(performed.has_value());
    const stage::Performance& p = *performed->performance;
    std::set<std::string> seen;
    for (std::int64_t t = 0; t < p.duration().ticks; t += kTicksPerSecond / 480) {
        const std::string holder = p.holder(stage::PropIndex{0}, SimTime{t});
        seen.insert(holder);
        CHECK(holder != "floor");
        for (const stage::ScoreEntry& entry : p.score()) {
            if (entry.start > SimTime{t} || entry.left <= SimTime{t}) {
                continue;
            }
            const std::string& place = entry.place;
            if (place == "a_has" || place == "a_catches") {
                CHECK(holder == "ana.hands");
            } else if (place == "r_has" || place == "r_catches") {
                CHECK(holder == "rui.hands");
            } else if (place == "fly_over" || place == "fly_back") {
                CHECK(holder == "air");
            }
        }
    }
    CHECK(seen.size() == 3);
}

}  // namespace
}  // namespace puppetri::verdict
