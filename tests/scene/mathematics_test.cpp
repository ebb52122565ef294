// SPDX-License-Identifier: MIT
#include "puppetri/scene/mathematics.h"

#include "files.h"

namespace puppetri::scene {

TEST_CASE("figure 2 of the paper is printed as the paper prints it [unit]") {
    // Bicho, Raposo, Magalhaes (2001), figure 2; and C = post - pre by hand.
    CHECK(to_mathematics(example("04_three_arcs/three_arcs.pup").draft) ==
          "P = {P1, P2, P3, P4}\n"
          "T = {t1, t2}\n"
          "F = {(P1, t1), (P2, t2), (P3, t2), (t1, P4), (t2, P4)}\n"
          "w(P1, t1) = 2; w(P2, t2) = w(P3, t2) = w(t1, P4) = w(t2, P4) = 1\n"
          "M0 = [1 1 1 0]^T\n"
          "\n"
          "C    t1   t2\n"
          "P1   -2    0\n"
          "P2    0   -1\n"
          "P3    0   -1\n"
          "P4    1    1\n");
}

TEST_CASE("inhibitors and the like follow by name [unit]") {
    const std::string text = to_mathematics(example("02_walk/figure.pup").draft);
    CHECK(text.find("t2 unless P5\nt3 unless P5\nt4 unless P5\n") != std::string::npos);
    CHECK(text.find("w(P3, t5) = 3;") != std::string::npos);
}

}  // namespace puppetri::scene
