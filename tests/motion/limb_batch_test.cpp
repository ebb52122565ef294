// SPDX-License-Identifier: MIT
// Batches of limbs: the same bits at every width and one by one, exact against forward kinematics.
#include "puppetri/motion/limb_batch.h"

#include <doctest/doctest.h>

#include <cstring>
#include <vector>

#include "random_limbs.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

template <class T>
struct Batch {
    explicit Batch(std::size_t n, bool rotations) : numbers(25 * n) {
        std::size_t next = 0;
        const auto row = [&] { return std::span<T>(numbers).subspan(n * next++, n); };
        for (auto& s : goals.position_parent) {
            s = row();
        }
        for (auto& s : goals.swivel_zero) {
            s = row();
        }
        for (auto& s : goals.swivel) {
            s = row();
        }
        for (auto& s : goals.rotation_parent) {
            s = rotations ? row() : std::span<T>();
        }
        for (auto* q : {&poses.start, &poses.hinge, &poses.end}) {
            for (auto& s : *q) {
                s = q == &poses.end && !rotations ? std::span<T>() : row();
            }
        }
        poses.residual_m = row();
    }
    void set(std::span<const T> to, std::size_t i, double x) {
        const_cast<T*>(to.data())[i] = static_cast<T>(x);
    }
    Quat quat(const std::array<std::span<T>, 4>& q, std::size_t i) const {
        return {q[0][i], q[1][i], q[2][i], q[3][i]};
    }
    std::vector<T> numbers;
    LimbGoalsSoa<T> goals;
    LimbPosesSoa<T> poses;
};

template <class T>
void fill(Batch<T>& batch, test::LimbSource& random, const LimbShape& shape, std::size_t n) {
    const auto set3 = [&](const auto& to, std::size_t i, Vec3 v) {
        batch.set(to[0], i, v.x);
        batch.set(to[1], i, v.y);
        batch.set(to[2], i, v.z);
    };
    for (std::size_t i = 0; i < n; ++i) {
        const Transform hand = parent_from_end(shape, random.pose(shape));
        // Some out of reach, some on the first joint itself.
        const Vec3 p = i % 7 == 0    ? shape.start + random.vector()
                       : i % 11 == 3 ? shape.start
                                     : hand.translation;
        set3(batch.goals.position_parent, i, p);
        set3(batch.goals.swivel_zero, i, i % 13 == 0 ? p - shape.start : random.direction());
        const CirclePoint x = random.circle();
        batch.set(batch.goals.swivel[0], i, x.cos);
        batch.set(batch.goals.swivel[1], i, x.sin);
        if (!batch.goals.rotation_parent[0].empty()) {
            const Quat q = hand.rotation;
            const double parts[] = {q.x, q.y, q.z, q.w};
            for (int k = 0; k < 4; ++k) {
                batch.set(batch.goals.rotation_parent[k], i, parts[k]);
            }
        }
    }
}

template <class T>
void check_widths(double tolerance) {
    test::LimbSource random(7);
    for (int round = 0; round < 60; ++round) {
        const LimbShape shape = random.shape({.limits = round % 2 == 0, .crooked = round % 3 == 0});
        const LimbIk ik(shape);
        const std::size_t n = 1 + round * 3;  // tails of every length
        const bool rotations = round % 4 != 0;
        Batch<T> one(n, rotations), base(n, rotations), widest(n, rotations);
        fill(one, random, shape, n);
        base.numbers = widest.numbers = one.numbers;
        const auto before = test::allocations();
        solve_limbs_soa(ik, one.goals, one.poses, BatchWidth::kOne);
        solve_limbs_soa(ik, base.goals, base.poses, BatchWidth::kBase);
        solve_limbs_soa(ik, widest.goals, widest.poses);
        CHECK(test::allocations() == before);
        const std::size_t bytes = one.numbers.size() * sizeof(T);
        CHECK(std::memcmp(one.numbers.data(), base.numbers.data(), bytes) == 0);
        CHECK(std::memcmp(one.numbers.data(), widest.numbers.data(), bytes) == 0);
        for (std::size_t i = 0; i < n; ++i) {
            const auto& p = one.goals.position_parent;
            const Vec3 goal{p[0][i], p[1][i], p[2][i]};
            LimbPose pose{one.quat(one.poses.start, i), one.quat(one.poses.hinge, i), {}};
            if (rotations) {
                pose.end = one.quat(one.poses.end, i);
                const auto& r = one.goals.rotation_parent;
                CHECK(angle_between(normalized(pose.start * pose.hinge * pose.end),
                                    normalized(Quat{r[0][i], r[1][i], r[2][i], r[3][i]})) <
                      tolerance);
            }
            const Vec3 at = parent_from_end(shape, pose).translation;
            const double distance = length(goal - shape.start);
            const double missing =
                std::fmax(0, std::fmax(distance - ik.farthest_m(), ik.nearest_m() - distance));
            CHECK(std::fabs(length(at - goal) - missing) < tolerance);
            CHECK(std::fabs(one.poses.residual_m[i] - missing) < tolerance);
        }
    }
}

}  // namespace

TEST_CASE(
    "batches in double have the same bits at every width, and miss goals by below 1e-9 [law]") {
    check_widths<double>(1e-9);
}

TEST_CASE(
    "batches in float have the same bits at every width, and miss goals by below 1e-5 [law]") {
    check_widths<float>(1e-5);
}

TEST_CASE("a batch in double has the bits of limbs solved one by one [law]") {
    test::LimbSource random(8);
    const LimbShape shape = random.shape({.limits = true, .crooked = true});
    const LimbIk ik(shape);
    Batch<double> batch(501, true);
    fill(batch, random, shape, 501);
    solve_limbs_soa(ik, batch.goals, batch.poses);
    for (std::size_t i = 0; i < 501; ++i) {
        const auto& g = batch.goals;
        const LimbSolution s = ik.solve_free(
            {.kind = LimbGoalKind::kPose,
             .position_parent = {g.position_parent[0][i], g.position_parent[1][i],
                                 g.position_parent[2][i]},
             .rotation_parent = {g.rotation_parent[0][i], g.rotation_parent[1][i],
                                 g.rotation_parent[2][i], g.rotation_parent[3][i]},
             .swivel_zero_parent = {g.swivel_zero[0][i], g.swivel_zero[1][i], g.swivel_zero[2][i]}},
            {g.swivel[0][i], g.swivel[1][i]});
        CHECK(s.pose.start == batch.quat(batch.poses.start, i));
        CHECK(s.pose.hinge == batch.quat(batch.poses.hinge, i));
        CHECK(s.pose.end == batch.quat(batch.poses.end, i));
        CHECK(s.residual_m == batch.poses.residual_m[i]);
    }
}
