// SPDX-License-Identifier: MIT
// Linkages against the matrices of Denavit and Hartenberg multiplied by hand, and their defects.
#include "puppetri/figure/linkage.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;

namespace {

struct Matrix {
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    Matrix operator*(const Matrix& b) const {
        Matrix c;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                c.m[i][j] = 0;
                for (int k = 0; k < 4; ++k) {
                    c.m[i][j] += m[i][k] * b.m[k][j];
                }
            }
        }
        return c;
    }
};

// The matrix A of a link as textbooks print it.
Matrix matrix_of(double theta, double d, double a, double alpha) {
    const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha),
                 sa = std::sin(alpha);
    return {{{ct, -st * ca, st * sa, a * ct},
             {st, ct * ca, -ct * sa, a * st},
             {0, sa, ca, d},
             {0, 0, 0, 1}}};
}

// Four links, the third of which slides.
std::vector<Link> arm() {
    std::vector<Link> links(4);
    const double pi = kPi;
    const DhParameters dh[] = {{0.05, pi / 2, 0.4, 0.1},
                               {0.5, 0, 0.02, 0.7},
                               {0.1, -pi / 2, 0.3, -0.4},
                               {0.15, 0.3, -0.05, 0.2}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        links[i].name = "l" + std::to_string(i);
        links[i].parent = i == 0 ? Link::kBase : i - 1;
        links[i].dh = dh[i];
        if (i == 2) {
            links[i].dofs = {{"slide", DofKind::kSlide, {0, 0, 1}, 0, 1}};
        } else {
            links[i].dofs = {{"turn", DofKind::kTurn, {0, 0, 1}, -3, 3}};
        }
    }
    return links;
}

std::string code_of(const std::vector<Link>& links) {
    const auto made = make_linkage(links, palettes().front());
    return made ? "" : made.error().front().code + " " + made.error().front().element;
}

}  // namespace

TEST_CASE(
    "a chain ends where the product of its matrices says, for any values of its DOFs [oracle]") {
    const std::vector<Link> links = arm();
    const auto made = make_linkage(links, palettes().front());
    REQUIRE(made.has_value());
    const Character& c = *made;
    CHECK(c.dofs.dofs.size() == 4);
    CHECK(c.dofs.find("l2.slide").valid());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0.1, 0.9);
    for (int round = 0; round < 50; ++round) {
        Pose pose = rest_pose(c.skeleton);
        Matrix product{{{0, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}}};  // z up, x ahead
        for (std::uint32_t i = 0; i < 4; ++i) {
            const double value = round == 0 ? c.dofs.dofs[i].at_rest : any(random);
            const JointIndex joint = c.dofs.dofs[i].joint;
            pose.parent_from_joint[joint.value] =
                transform_of({&c.dofs.dofs[i], 1},
                             c.skeleton.joints[joint.value].parent_from_joint_rest, {&value, 1});
            const DhParameters& p = *links[i].dh;
            product = product * matrix_of(i == 2 ? p.theta_rad : value, i == 2 ? value : p.d_m,
                                          p.a_m, p.alpha_rad);
        }
        std::vector<Transform> model(c.skeleton.joints.size());
        to_model_space(c.skeleton, pose, model);
        const Vec3 end = model.back() * c.skeleton.joints.back().end_site_joint;
        CHECK(std::fabs(end.x - product.m[0][3]) < 1e-12);
        CHECK(std::fabs(end.y - product.m[1][3]) < 1e-12);
        CHECK(std::fabs(end.z - product.m[2][3]) < 1e-12);
    }
}

TEST_CASE("a tree of links hangs where it is said to; its skin is bound to its links [unit]") {
    std::vector<Link> links(3);
    links[0].name = "body";
    links[0].parent_from_joint = {{}, {0, 0.5, 0}};
    links[0].shapes = {{LinkShape::Kind::kBall, {0.2, 0, 0}, {}, {}, false}};
    links[1].name = "leg";
    links[1].parent = 0;
    links[1].parent_from_joint = {about_y(kPi / 2), {0.1, 0, 0}};
    links[1].dofs = {{"swing", DofKind::kTurn, {0, 1, 0}, -1, 1},
                     {"lift", DofKind::kTurn, {1, 0, 0}, -1, 1}};
    links[1].shapes = {{LinkShape::Kind::kBar, {0.02, 0, 0}, {}, {0, 0, 0.4}, true}};
    links[2].name = "foot";
    links[2].parent = 1;
    links[2].parent_from_joint = {{}, {0, 0, 0.4}};
    links[2].shapes = {{LinkShape::Kind::kBox, {0.05, 0.02, 0.1}, {}, {}, false}};
    const auto made = make_linkage(links, palettes().front());
    REQUIRE(made.has_value());
    std::vector<Transform> model(4);
    to_model_space(made->skeleton, rest_pose(made->skeleton), model);
    CHECK(length(model[3].translation - Vec3{0.5, 0.5, 0}) < 1e-12);
    const Mesh& mesh = made->mesh;
    REQUIRE(mesh.joints.size() == mesh.positions.size());
    double far = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        CHECK(mesh.weights[v][0] == 1);
        far = mesh.joints[v][0] == 3 ? std::fmax(far, mesh.positions[v][0]) : far;
    }
    CHECK(far == doctest::Approx(0.55).epsilon(1e-6));
    CHECK(made->dofs.find("leg.lift").valid());
    CHECK(!made->humanoid.has_value());
}

TEST_CASE("what is wrong with a linkage is told by the link [unit]") {
    CHECK(code_of(arm()) == "");
    CHECK(code_of({}) == "no-links linkage");
    const auto with = [](auto change) {
        std::vector<Link> links = arm();
        change(links);
        return code_of(links);
    };
    CHECK(with([](auto& l) { l[1].dofs[0].lo = 4; }) == "min-above-max link l1");
    CHECK(with([](auto& l) { l[1].dofs[0].hi = 0.5; }) == "rest-outside-range link l1");
    CHECK(with([](auto& l) { l[3].name = "l0"; }) == "name-used-twice link l0");
    CHECK(with([](auto& l) { l[1].parent = 2; }) == "wrong-parent link l1");
    CHECK(with([](auto& l) { l[0].dofs[0].axis_joint = {}; }) == "bad-axis link l0");
    CHECK(with([](auto& l) { l[0].dh->a_m = std::numeric_limits<double>::quiet_NaN(); }) ==
          "not-finite link l0");
    CHECK(with([](auto& l) {
              l[0].shapes = {{LinkShape::Kind::kBar, {0.1, 0, 0}, {1, 0, 0}, {1, 0, 0}, false}};
          }) == "zero-length link l0");
    CHECK(with([](auto& l) { l[0].dofs.push_back(l[0].dofs[0]); }) == "name-used-twice link l0");
}
