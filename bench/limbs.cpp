// SPDX-License-Identifier: MIT
// Inverse kinematics of limbs on 2 048 random goals that the arm of the mannequin reaches within
// its limits: time per goal, how many are solved within limits, the largest error by forward
// kinematics, and a hash of the results. Beside it, in the same run, the scan of 720 swivel angles
// that people write instead of exact intervals.
//
// Prints CSV: name, nanoseconds, solved, goals, worst metres, worst radians, hash. Exits 1 when a
// goal that the scan solves is not solved within limits, or an error is above its aim.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "motion/random_limbs.h"
#include "puppetri/base/hash.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/limb_batch.h"
#include "puppetri/motion/limb_ik.h"

namespace {

using namespace puppetri;
using namespace puppetri::motion;

constexpr int kGoals = 2048;
constexpr int kScan = 720;

// Time of the processor that this thread used: other programs on the machine do not count.
double now_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// The least time of one call over several rounds, in seconds.
template <class Work>
double best_of(int rounds, Work work) {
    double best = 1e9;
    for (int i = 0; i < rounds; ++i) {
        const double start = now_s();
        work();
        best = std::min(best, now_s() - start);
    }
    return best;
}

struct Row {
    const char* name;
    double seconds = 0;
    int solved = kGoals;
    double worst_m = 0, worst_rad = 0;
    Hash64 hash = {};

    void add(const LimbShape& shape, const LimbGoal& goal, const LimbPose& pose) {
        const Transform hand = parent_from_end(shape, pose);
        worst_m = std::max(worst_m, length(hand.translation - goal.position_parent));
        if (goal.kind == LimbGoalKind::kPose) {
            worst_rad =
                std::max(worst_rad, angle_between(normalized(hand.rotation), goal.rotation_parent));
        }
        for (const Quat& q : {pose.start, pose.hinge, pose.end}) {
            hash.add_f64(q.x).add_f64(q.y).add_f64(q.z).add_f64(q.w);
        }
    }
    void print() const {
        std::printf("%s,%.1f,%d,%d,%.2g,%.2g,%016llx\n", name, seconds / kGoals * 1e9, solved,
                    kGoals, worst_m, worst_rad, static_cast<unsigned long long>(hash.value()));
    }
};

bool within(const LimbShape& shape, const LimbPose& pose) {
    return figure::limit_excess_rad(shape.start_limit, pose.start) < 1e-9 &&
           figure::limit_excess_rad(shape.hinge, pose.hinge) < 1e-9 &&
           figure::limit_excess_rad(shape.end_limit, pose.end) < 1e-9;
}

template <class T>
struct Batch {
    Batch() : numbers(24 * kGoals) {
        std::size_t next = 0;
        const auto row = [&] { return std::span<T>(numbers).subspan(kGoals * next++, kGoals); };
        for (auto& s : position) {
            s = row();
        }
        for (auto& s : rotation) {
            s = row();
        }
        for (auto& s : zero) {
            s = row();
        }
        for (auto* q : {&poses.start, &poses.hinge, &poses.end}) {
            for (auto& s : *q) {
                s = row();
            }
        }
        poses.residual_m = row();
    }
    void fill(const std::vector<LimbGoal>& goals) {
        for (std::size_t i = 0; i < kGoals; ++i) {
            const Vec3 p = goals[i].position_parent, z = goals[i].swivel_zero_parent;
            const Quat q = goals[i].rotation_parent;
            const double from[] = {p.x, p.y, p.z, z.x, z.y, z.z, q.x, q.y, q.z, q.w};
            for (int k = 0; k < 10; ++k) {
                (k < 3   ? position[k]
                 : k < 6 ? zero[k - 3]
                         : rotation[k - 6])[i] = static_cast<T>(from[k]);
            }
        }
    }
    LimbGoalsSoa<T> goals(bool rotations) const {
        LimbGoalsSoa<T> g;
        std::copy(position.begin(), position.end(), g.position_parent.begin());
        std::copy(zero.begin(), zero.end(), g.swivel_zero.begin());
        if (rotations) {
            std::copy(rotation.begin(), rotation.end(), g.rotation_parent.begin());
        }
        return g;
    }
    LimbPose pose(std::size_t i) const {
        const auto q = [&](const std::array<std::span<T>, 4>& a) {
            return Quat{a[0][i], a[1][i], a[2][i], a[3][i]};
        };
        return {q(poses.start), q(poses.hinge), q(poses.end)};
    }
    std::vector<T> numbers;
    std::array<std::span<T>, 3> position, zero;
    std::array<std::span<T>, 4> rotation;
    LimbPosesSoa<T> poses;
};

template <class T>
Row batch_row(const char* name, const LimbIk& ik, const std::vector<LimbGoal>& goals,
              bool rotations, BatchWidth width) {
    Batch<T> batch;
    batch.fill(goals);
    Row row{name};
    row.seconds =
        best_of(40, [&] { solve_limbs_soa(ik, batch.goals(rotations), batch.poses, width); });
    for (std::size_t i = 0; i < kGoals; ++i) {
        LimbGoal goal = goals[i];
        goal.kind = rotations ? LimbGoalKind::kPose : LimbGoalKind::kPosition;
        row.add(ik.shape(), goal, batch.pose(i));
    }
    return row;
}

}  // namespace

int main() {
    test::LimbSource random(2048);
    const figure::Figure figure = figure::make_mannequin(1.75);
    const LimbShape shape = limb_shape(figure, Limb::kRightArm);
    const LimbIk ik(shape);
    std::vector<LimbGoal> goals;
    std::vector<CirclePoint> swivels;
    for (int i = 0; i < kGoals; ++i) {
        const Transform hand = parent_from_end(shape, random.pose(shape));
        goals.push_back({.kind = LimbGoalKind::kPose,
                         .position_parent = hand.translation,
                         .rotation_parent = hand.rotation,
                         .swivel_zero_parent = random.direction()});
        swivels.push_back(random.circle());
    }
    std::vector<LimbSolution> solved(kGoals);
    std::printf("name,ns,solved,goals,worst_m,worst_rad,hash\n");
    bool good = true;
    const auto print = [&](const Row& row, double most) {
        row.print();
        good = good && row.worst_m < most && row.worst_rad < most;
    };

    Row free{"pose/no limits/one by one"};
    free.seconds = best_of(40, [&] {
        for (int i = 0; i < kGoals; ++i) {
            solved[i] = ik.solve_free(goals[i], swivels[i]);
        }
    });
    for (int i = 0; i < kGoals; ++i) {
        free.add(shape, goals[i], solved[i].pose);
    }
    print(free, 1e-9);
    print(batch_row<double>("pose/no limits/batch/double", ik, goals, true, BatchWidth::kWidest),
          1e-9);
    print(batch_row<double>("pose/no limits/batch/double/base", ik, goals, true, BatchWidth::kBase),
          1e-9);
    print(batch_row<float>("pose/no limits/batch/float", ik, goals, true, BatchWidth::kWidest),
          1e-5);
    print(batch_row<float>("pose/no limits/batch/float/base", ik, goals, true, BatchWidth::kBase),
          1e-5);
    print(batch_row<float>("two bones/crowd/float", ik, goals, false, BatchWidth::kWidest), 1e-5);
    print(batch_row<float>("two bones/crowd/float/base", ik, goals, false, BatchWidth::kBase),
          1e-5);

    // The scan: of 720 swivels the one within limits that is nearest to the wanted one.
    std::vector<bool> scan_solves(kGoals);
    std::vector<CirclePoint> angles;
    for (int k = 0; k < kScan; ++k) {
        angles.push_back(circle_point(2 * kPi * k / kScan));
    }
    Row scan{"pose/all limits/scan of 720"};
    scan.seconds = best_of(1, [&] {
        for (int i = 0; i < kGoals; ++i) {
            double best = -2;
            for (const CirclePoint x : angles) {
                if (dot(x, swivels[i]) <= best) {
                    continue;
                }
                const LimbSolution s = ik.solve_free(goals[i], x);
                if (within(shape, s.pose)) {
                    best = dot(x, swivels[i]);
                    solved[i] = s;
                }
            }
            scan_solves[i] = best > -2;
        }
    });
    scan.solved = static_cast<int>(std::count(scan_solves.begin(), scan_solves.end(), true));
    for (int i = 0; i < kGoals; ++i) {
        if (scan_solves[i]) {
            scan.add(shape, goals[i], solved[i].pose);
        }
    }
    scan.print();

    const struct {
        const char* name;
        SwivelRule rule;
    } rules[] = {{"pose/all limits/nearest swivel", SwivelRule::kNearest},
                 {"pose/all limits/middle of the longest arc", SwivelRule::kMiddle},
                 {"pose/all limits/least motion", SwivelRule::kLeastMotion}};
    for (const auto& [name, rule] : rules) {
        Row row{name};
        row.seconds = best_of(10, [&] {
            for (int i = 0; i < kGoals; ++i) {
                solved[i] = ik.solve(goals[i], {.rule = rule, .swivel = swivels[i]});
            }
        });
        row.solved = 0;
        for (int i = 0; i < kGoals; ++i) {
            const bool ok = within(shape, solved[i].pose) && solved[i].residual_m < 1e-9 &&
                            solved[i].residual_rad < 1e-9;
            row.solved += ok;
            row.add(shape, goals[i], solved[i].pose);
            if (scan_solves[i] && !ok) {
                good = false;
            }
        }
        print(row, 1e-9);
    }
    return good ? 0 : 1;
}
