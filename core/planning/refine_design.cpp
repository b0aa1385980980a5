#include "core/planning/refine_design.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

bool alike(const PlanningArm& arm, const Candidate& a, const Candidate& b, double separation) {
  constexpr double kSameWay = 0.9;  // cosine
  if (arm.pull && a.direction.dot(b.direction) < kSameWay) return false;
  for (int joint = arm.pull ? 0 : 1; joint < 6; ++joint) {
    if (std::abs(std::remainder(a.q[joint] - b.q[joint], 2.0 * EIGEN_PI)) >= separation) return false;
  }
  return true;
}

void refineDesign(const PlanningArm& arm, const PostureRules& rules, const Matrix6d& known,
                  const JointMask& unknown, const std::vector<Candidate>& measured,
                  const RefineOptions& options, std::vector<Candidate>& chosen) {
  const std::array<JointLimits, 6> box = postureBox(arm.geometry.arm, rules);
  Matrix6d sum = known;
  for (const Candidate& one : chosen) sum += one.information;
  double value = designValue(sum, unknown, options.reference);
  if (!std::isfinite(value)) return;
  const auto apart = [&](const Candidate& moved, std::size_t place) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (k != place && alike(arm, moved, chosen[k], options.least_separation)) return false;
    }
    return std::none_of(measured.begin(), measured.end(), [&](const Candidate& one) {
      return alike(arm, moved, one, options.least_separation);
    });
  };
  const auto tryMove = [&](std::size_t place, int joint, double step) {
    Vector6d q = chosen[place].q;
    const JointLimits& limits = box[static_cast<std::size_t>(joint)];
    q[joint] = std::clamp(q[joint] + step, limits.lower, limits.upper);
    if (q[joint] == chosen[place].q[joint]) return false;
    const Candidate moved = candidateAt(arm, q, chosen[place].direction);
    const Matrix6d with = sum - chosen[place].information + moved.information;
    const double found = designValue(with, unknown, options.reference);
    constexpr double kWorthwhile = 1e-6;  // of the logarithm
    if (!(found > value + kWorthwhile) || !apart(moved, place)) return false;
    const ArmPosture posture = unloadedPosture(arm.geometry.arm, moved.load_case);
    if (brokenRule(arm, rules, posture, moved.direction) != PostureRule::none) return false;
    chosen[place] = moved, sum = with, value = found;
    return true;
  };
  constexpr int kMostPasses = 30;
  for (double step = options.first_step; step > options.last_step; step *= 0.5) {
    bool moved = true;
    for (int pass = 0; moved && pass < kMostPasses; ++pass) {
      moved = false;
      for (std::size_t place = 0; place < chosen.size(); ++place) {
        for (int joint = 0; joint < 6; ++joint) {
          moved |= tryMove(place, joint, step) || tryMove(place, joint, -step);
        }
      }
    }
  }
}

}  // namespace stiffscope
