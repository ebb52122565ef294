// SPDX-License-Identifier: MIT
// Damped least squares by priority. Per level k, with the Jacobian J and the error e of its goals:
//   A = J N,  step += A^T (A A^T + w)^-1 (e - J step),  N -= A^+ A,
// N the projector onto what higher levels leave free (at first the identity); w is damping^2 over
// each goal's weight. The projector takes the exact pseudo-inverse, so that lower levels do not
// disturb higher ones; directions of A that are as good as zero are left in N.
#include "puppetri/motion/goal_stack.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

// Longer ways are gone in several steps: linear in the angle, a joint turns by no more than this.
constexpr double kMostTurn_rad = 0.35;
constexpr double kFarthest_m = 0.3;
constexpr double kLost = 1e-8;  // squared length of a row, relative, that is as good as zero

class Solver {
 public:
    Solver(const GoalStack& stack, figure::Pose& pose, GoalScratch& scratch)
        : stack_(stack), pose_(pose), scratch_(scratch) {
        const std::size_t joints = stack.skeleton.joints.size();
        PUP_REQUIRE(pose.parent_from_joint.size() == joints);
        PUP_REQUIRE(stack.limits.empty() || stack.limits.size() == joints);
        PUP_REQUIRE(stack.damping > 0);
        for (const figure::JointIndex joint : stack.movable) {
            PUP_REQUIRE(joint.value < joints);
        }
        for (const SkeletonGoal& goal : stack.goals) {
            PUP_REQUIRE(goal.joint.value < joints && goal.weight > 0);
        }
        scratch.model_from_joint.resize(joints);
        scratch.order.clear();
        for (std::uint32_t i = 0; i < stack.goals.size(); ++i) {
            scratch.order.push_back(i);
        }
        std::sort(scratch.order.begin(), scratch.order.end(),
                  [&](std::uint32_t a, std::uint32_t b) {
                      const int pa = stack.goals[a].priority, pb = stack.goals[b].priority;
                      return pa != pb ? pa < pb : a < b;
                  });
        n_ = 3 * stack.movable.size() + (stack.root_moves ? 3 : 0);
        rows_ = 3 * stack.goals.size();
        // Jacobian, A, the orthonormal rows, projector, Gram matrix; error, step, solution,
        // damping.
        scratch.numbers.assign(3 * rows_ * n_ + n_ * n_ + rows_ * rows_ + 3 * rows_ + 2 * n_, 0);
        double* next = scratch.numbers.data();
        const auto take = [&](std::size_t count) { return std::exchange(next, next + count); };
        jacobian_ = take(rows_ * n_);
        a_ = take(rows_ * n_);
        basis_ = take(rows_ * n_);
        projector_ = take(n_ * n_);
        gram_ = take(rows_ * rows_);
        error_ = take(rows_);
        solution_ = take(rows_);
        damping_ = take(rows_);
        step_ = take(n_);
        free_ = take(n_);
    }

    GoalOutcome run() {
        GoalOutcome outcome;
        measure(outcome);
        for (; outcome.rounds < stack_.rounds; ++outcome.rounds) {
            if (outcome.worst_m <= stack_.tolerance && outcome.worst_rad <= stack_.tolerance) {
                break;
            }
            std::fill(free_, free_ + n_, 1.0);
            // A joint that its limit stops is taken out and the step made again, a few times.
            for (int attempt = 0; attempt < 4; ++attempt) {
                make_step();
                if (!block_limits()) {
                    break;
                }
            }
            if (apply_step() < 1e-10) {
                measure(outcome);
                break;
            }
            measure(outcome);
        }
        return outcome;
    }

 private:
    Vec3 error_of(const SkeletonGoal& goal) const {
        const Transform& joint = scratch_.model_from_joint[goal.joint.value];
        if (goal.kind == SkeletonGoalKind::kPosition) {
            return goal.position_model - joint * goal.point_joint;
        }
        if (goal.kind == SkeletonGoalKind::kRotation) {
            return to_rotation_vector(goal.rotation_model * conjugate(joint.rotation));
        }
        const Vec3 now = rotate(joint.rotation, goal.axis_joint),
                   wanted = normalized(goal.direction_model);
        return to_rotation_vector(shortest_arc(now, wanted, {0, 1, 0}));
    }

    void measure(GoalOutcome& outcome) {
        figure::to_model_space(stack_.skeleton, pose_, scratch_.model_from_joint);
        outcome.worst_m = outcome.worst_rad = 0;
        for (const SkeletonGoal& goal : stack_.goals) {
            double& worst =
                goal.kind == SkeletonGoalKind::kPosition ? outcome.worst_m : outcome.worst_rad;
            worst = std::fmax(worst, length(error_of(goal)));
        }
    }

    bool is_ancestor(figure::JointIndex above, figure::JointIndex joint) const {
        while (joint.valid() && joint.value > above.value) {
            joint = stack_.skeleton.joints[joint.value].parent;
        }
        return joint == above;
    }

    // The axis of degree of freedom k of a joint, in model space; zero where a hinge has none.
    Vec3 axis_model(figure::JointIndex joint, int k) const {
        const figure::JointIndex parent = stack_.skeleton.joints[joint.value].parent;
        const Quat model_from_parent =
            parent.valid() ? scratch_.model_from_joint[parent.value].rotation : Quat{};
        if (!stack_.limits.empty()) {
            const figure::JointLimit& limit = stack_.limits[joint.value];
            if (limit.kind == figure::LimitKind::kHinge) {
                return k == 0 ? rotate(scratch_.model_from_joint[joint.value].rotation,
                                       limit.axis_joint)
                              : Vec3{};
            }
        }
        const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        return rotate(model_from_parent, axes[k]);
    }

    void fill_rows(const SkeletonGoal& goal, double* rows) const {
        std::fill(rows, rows + 3 * n_, 0.0);
        const Transform& joint = scratch_.model_from_joint[goal.joint.value];
        const Vec3 point = joint * goal.point_joint;
        const Vec3 direction = rotate(joint.rotation, goal.axis_joint);
        const auto put = [&](std::size_t column, Vec3 v) {
            rows[column] = v.x * free_[column];
            rows[n_ + column] = v.y * free_[column];
            rows[2 * n_ + column] = v.z * free_[column];
        };
        for (std::size_t m = 0; m < stack_.movable.size(); ++m) {
            const figure::JointIndex mover = stack_.movable[m];
            if (!is_ancestor(mover, goal.joint)) {
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                const Vec3 axis = axis_model(mover, k);
                const Vec3 arm = point - scratch_.model_from_joint[mover.value].translation;
                put(3 * m + k, goal.kind == SkeletonGoalKind::kPosition ? cross(axis, arm)
                               : goal.kind == SkeletonGoalKind::kRotation
                                   ? axis
                                   : axis - direction * dot(axis, direction));
            }
        }
        if (stack_.root_moves && goal.kind == SkeletonGoalKind::kPosition) {
            const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            for (int k = 0; k < 3; ++k) {
                put(n_ - 3 + k, axes[k]);
            }
        }
    }

    double product(const double* a, const double* b) const {
        double sum = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            sum += a[i] * b[i];
        }
        return sum;
    }

    void make_step() {
        std::fill(step_, step_ + n_, 0.0);
        std::fill(projector_, projector_ + n_ * n_, 0.0);
        for (std::size_t i = 0; i < n_; ++i) {
            projector_[i * n_ + i] = free_[i];
        }
        for (std::size_t from = 0; from < scratch_.order.size();) {
            std::size_t to = from;
            const int priority = stack_.goals[scratch_.order[from]].priority;
            std::size_t m = 0;
            double scale = 1;
            for (; to < scratch_.order.size() &&
                   stack_.goals[scratch_.order[to]].priority == priority;
                 ++to, m += 3) {
                const SkeletonGoal& goal = stack_.goals[scratch_.order[to]];
                fill_rows(goal, jacobian_ + m * n_);
                const Vec3 e = error_of(goal);
                const double most =
                    goal.kind == SkeletonGoalKind::kPosition ? kFarthest_m : kMostTurn_rad;
                scale = std::fmin(scale, most / std::fmax(length(e), most));
                const double parts[] = {e.x, e.y, e.z};
                for (int k = 0; k < 3; ++k) {
                    error_[m + k] = parts[k];
                    damping_[m + k] = stack_.damping * stack_.damping / goal.weight;
                }
            }
            // All of a level alike, so that what they agree on does not depend on how far they are.
            for (std::size_t i = 0; i < m; ++i) {
                error_[i] *= scale;
            }
            solve_level(m);
            from = to;
        }
    }

    void solve_level(std::size_t m) {
        for (std::size_t i = 0; i < m; ++i) {
            error_[i] -= product(jacobian_ + i * n_, step_);
            for (std::size_t k = 0; k < n_; ++k) {
                a_[i * n_ + k] = product(jacobian_ + i * n_, projector_ + k * n_);
            }
        }
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t k = 0; k <= i; ++k) {
                gram_[i * m + k] = product(a_ + i * n_, a_ + k * n_);
            }
            gram_[i * m + i] += damping_[i];
        }
        solve_gram(m);
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t k = 0; k < n_; ++k) {
                step_[k] += a_[i * n_ + k] * solution_[i];
            }
        }
        // Take the rows of A out of the projector, orthonormalized one after the other.
        std::size_t kept = 0;
        for (std::size_t i = 0; i < m; ++i) {
            double* row = basis_ + kept * n_;
            std::copy(a_ + i * n_, a_ + (i + 1) * n_, row);
            const double whole = product(jacobian_ + i * n_, jacobian_ + i * n_);
            for (int twice = 0; twice < 2; ++twice) {
                for (std::size_t b = 0; b < kept; ++b) {
                    const double part = product(row, basis_ + b * n_);
                    for (std::size_t k = 0; k < n_; ++k) {
                        row[k] -= part * basis_[b * n_ + k];
                    }
                }
            }
            const double rest = product(row, row);
            if (rest <= kLost * whole || rest == 0) {
                continue;
            }
            const double scale = 1 / std::sqrt(rest);
            for (std::size_t k = 0; k < n_; ++k) {
                row[k] *= scale;
            }
            for (std::size_t r = 0; r < n_; ++r) {
                for (std::size_t c = 0; c < n_; ++c) {
                    projector_[r * n_ + c] -= row[r] * row[c];
                }
            }
            ++kept;
        }
    }

    // Cholesky: the Gram matrix plus a positive diagonal.
    void solve_gram(std::size_t m) {
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t k = 0; k <= i; ++k) {
                double sum = gram_[i * m + k];
                for (std::size_t j = 0; j < k; ++j) {
                    sum -= gram_[i * m + j] * gram_[k * m + j];
                }
                gram_[i * m + k] =
                    i == k ? std::sqrt(std::fmax(sum, 1e-300)) : sum / gram_[k * m + k];
            }
        }
        for (std::size_t i = 0; i < m; ++i) {
            double sum = error_[i];
            for (std::size_t j = 0; j < i; ++j) {
                sum -= gram_[i * m + j] * solution_[j];
            }
            solution_[i] = sum / gram_[i * m + i];
        }
        for (std::size_t i = m; i-- > 0;) {
            double sum = solution_[i];
            for (std::size_t j = i + 1; j < m; ++j) {
                sum -= gram_[j * m + i] * solution_[j];
            }
            solution_[i] = sum / gram_[i * m + i];
        }
    }

    // The rotation of a movable joint after the step, before its limit.
    Quat stepped(std::size_t m, double scale) const {
        const figure::JointIndex joint = stack_.movable[m];
        const Quat now = pose_.parent_from_joint[joint.value].rotation;
        if (!stack_.limits.empty() &&
            stack_.limits[joint.value].kind == figure::LimitKind::kHinge) {
            return normalized(
                now * from_axis_angle(stack_.limits[joint.value].axis_joint, step_[3 * m] * scale));
        }
        const Vec3 turn{step_[3 * m], step_[3 * m + 1], step_[3 * m + 2]};
        return normalized(from_rotation_vector(turn * scale) * now);
    }

    // Takes the degrees of freedom out that would leave their limits and cannot even begin.
    bool block_limits() {
        bool blocked = false;
        for (std::size_t m = 0; !stack_.limits.empty() && m < stack_.movable.size(); ++m) {
            const figure::JointIndex joint = stack_.movable[m];
            const Quat now = pose_.parent_from_joint[joint.value].rotation;
            const Quat next = stepped(m, 1);
            const Quat inside = figure::clamp_to_limit(stack_.limits[joint.value], next);
            const double wanted = angle_between(now, next);
            if (free_[3 * m] != 0 && wanted > 1e-9 && angle_between(now, inside) < 0.05 * wanted) {
                free_[3 * m] = free_[3 * m + 1] = free_[3 * m + 2] = 0;
                blocked = true;
            }
        }
        return blocked;
    }

    // The largest turn or shift made.
    double apply_step() {
        double most = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            most = std::fmax(most, std::fabs(step_[i]));
        }
        const double scale = most > kMostTurn_rad ? kMostTurn_rad / most : 1;
        double moved = 0;
        for (std::size_t m = 0; m < stack_.movable.size(); ++m) {
            const figure::JointIndex joint = stack_.movable[m];
            Quat& rotation = pose_.parent_from_joint[joint.value].rotation;
            Quat next = stepped(m, scale);
            if (!stack_.limits.empty()) {
                next = figure::clamp_to_limit(stack_.limits[joint.value], next);
            }
            moved = std::fmax(moved, angle_between(rotation, next));
            rotation = next;
        }
        if (stack_.root_moves) {
            const Vec3 shift = Vec3{step_[n_ - 3], step_[n_ - 2], step_[n_ - 1]} * scale;
            Transform& root = pose_.parent_from_joint[0];
            root.translation = root.translation + shift;
            moved = std::fmax(moved, length(shift));
        }
        return moved;
    }

    const GoalStack& stack_;
    figure::Pose& pose_;
    GoalScratch& scratch_;
    std::size_t n_ = 0, rows_ = 0;
    double *jacobian_ = nullptr, *a_ = nullptr, *basis_ = nullptr, *projector_ = nullptr,
           *gram_ = nullptr, *error_ = nullptr, *solution_ = nullptr, *damping_ = nullptr,
           *step_ = nullptr, *free_ = nullptr;
};

}  // namespace

GoalOutcome solve_goals(const GoalStack& stack, figure::Pose& pose, GoalScratch& scratch) {
    return Solver(stack, pose, scratch).run();
}

}  // namespace puppetri::motion
