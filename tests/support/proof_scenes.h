// SPDX-License-Identifier: MIT
// Scenes made by program, for tests and benchmarks of proofs: many pairs that play ball, and a ring
// of players who pass balls that have identity.
#pragma once
#include <string>

namespace puppetri::made {

// n pairs, each the game of Bicho's figure 5 (20 places), side by side in one scene.
inline std::string pairs_of_players(int n) {
    std::string text =
        "language 1\nscene \"Pairs that play ball\"\nframes 24 per second, until 40 s\n";
    text += R"(
net player(me: actor, other: player, ball: prop, starts: bool = no) {
  place with_ball     does me.walk(steps: 3, arms: carry(ball))        takes 60 frames  tokens starts ? 1 : 0
  place to_throw      does me.face(other.me, arms: carry(ball))        takes 12 frames
  place throwing      does me.throw(ball, to: other.me)                takes auto
  place from_throw    does me.face(0 deg)                              takes 12 frames
  place without_ball  does me.walk(steps: 2)                           takes 40 frames  tokens starts ? 0 : 1
  place to_get        does me.ready(ball, from: other.me)              takes 12 frames
  place getting       does me.catch(ball)                              takes auto
  place from_get      does me.face(0 deg, arms: carry(ball))           takes 12 frames
  public place can_grasp                                               takes as to_get
  public place flight does ball.fly(from: me, to: other.me)            takes auto
  stop:    with_ball                  -> to_throw
  throw:   to_throw + other.can_grasp -> throwing
  let_go:  throwing                   -> from_throw + flight
  go:      from_throw                 -> without_ball
  wait:    without_ball               -> to_get + can_grasp
  catch:   to_get + other.flight      -> getting
  turn:    getting                    -> from_get
  walk_on: from_get                   -> with_ball
  public state has = with_ball or to_throw or throwing or getting or from_get
}
cast {
)";
    for (int i = 0; i < n; ++i) {
        const std::string k = std::to_string(i), z = std::to_string(2 * i);
        text += "  ana" + k + ": mannequin { at (-1.5, 0, " + z + ") m }\n";
        text += "  rui" + k + ": mannequin { at (1.5, 0, " + z + ") m }\n";
        text += "  ball" + k + ": sphere { diameter 22 cm, held by ana" + k + ".hands }\n";
    }
    text += "}\n";
    for (int i = 0; i < n; ++i) {
        const std::string k = std::to_string(i);
        text += "use player(ana" + k + ", b" + k + ", ball" + k + ", starts: yes) as a" + k + "\n";
        text += "use player(rui" + k + ", a" + k + ", ball" + k + ") as b" + k + "\n";
        text += "rule one_ball" + k + " exactly_one(a" + k + ".has, b" + k + ".has, a" + k +
                ".flight, b" + k + ".flight)\n";
        text += "rule turns" + k + " alternate(a" + k + ".throw, b" + k + ".throw)\n";
        text += "rule ready" + k + " a" + k + ".throw only if b" + k + ".can_grasp\n";
    }
    return text + "rule goes_on deadlock_free\n";
}

// n players in a ring; every `each`-th begins with a ball. A token says which ball it is.
inline std::string ring_of_players(int n, int each) {
    std::string text = "language 1\nscene \"A ring\"\nframes 24 per second, until 40 s\n";
    text += R"(
token Ball(which: prop)
net player(me: actor, next: player, begins: prop, starts: bool) {
  public place has of Ball  does me.hold(which)  takes 1 s  tokens starts ? 1 : 0 (which = begins)
  public place free         tokens starts ? 0 : 1
  pass: has(which = b) + next.free -> next.has(which = b) + free
}
cast {
)";
    for (int i = 0; i < n; ++i) {
        text +=
            "  p" + std::to_string(i) + ": mannequin { at (" + std::to_string(i) + ", 0, 0) m }\n";
        if (i % each == 0) {
            text += "  ball" + std::to_string(i) + ": sphere { diameter 22 cm, held by p" +
                    std::to_string(i) + ".hands }\n";
        }
    }
    text += "}\n";
    for (int i = 0; i < n; ++i) {
        const std::string k = std::to_string(i), next = std::to_string((i + 1) % n);
        text += "use player(p" + k + ", x" + next + ", ball" + std::to_string(i / each * each) +
                ", " + (i % each == 0 ? "yes" : "no") + ") as x" + k + "\n";
    }
    return text;
}

}  // namespace puppetri::made
