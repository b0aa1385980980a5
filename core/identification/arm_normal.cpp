#include "core/identification/arm_normal.h"

#include <algorithm>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

struct PointRows {
  Matrix36d rows;
  Eigen::Vector3d values;
};

/// The sum over the points of all cases; `points(i, add)` calls add(rows, values) for each of case i. Of many
/// cases the rows are made on all cores, and added in their order nevertheless, so that rounding does not
/// depend on it.
template <class Points>
NormalEquations sumOver(std::size_t cases, const Points& points) {
  NormalEquations sum;
  if (cases < kWorthThreads) {
    const auto add = [&](const Matrix36d& rows, const Eigen::Vector3d& values) { sum.add(rows, values); };
    for (std::size_t i = 0; i < cases; ++i) points(i, add);
    return sum;
  }
  constexpr std::size_t kBlock = 256;
  std::vector<std::vector<PointRows>> blocks((cases + kBlock - 1) / kBlock);
  onAllCores(blocks.size(), [&](std::size_t block) {
    const auto keep = [&](const Matrix36d& rows, const Eigen::Vector3d& values) {
      blocks[block].push_back({rows, values});
    };
    for (std::size_t i = block * kBlock; i < std::min(cases, (block + 1) * kBlock); ++i) points(i, keep);
  });
  for (const auto& block : blocks) {
    for (const PointRows& one : block) sum.add(one.rows, one.values);
  }
  return sum;
}

}  // namespace

NormalEquations reflectorNormal(const LoadedArm& arm) {
  return sumOver(arm.cases.size(), [&](std::size_t i, const auto& add) {
    const LoadCase& load_case = arm.cases[i];
    const ArmAxes axes = jacobianAxes(arm.geometry, load_case);
    for (const TargetMove& move : load_case.targets) {
      const Eigen::Vector3d point = jacobianPoint(load_case, move.unloaded, move.loaded);
      add(pointRows(axes, point, arm.torques[i]), move.displacement());
    }
  });
}

NormalEquations wristNormal(const LoadedArm& arm) {
  return sumOver(arm.wrist.size(), [&](std::size_t i, const auto& add) {
    const WristMove& move = arm.wrist[i];
    const Eigen::Vector3d point = jacobianPoint(arm.cases[i], move.unloaded, move.loaded);
    add(pointRows(jacobianAxes(arm.geometry, arm.cases[i]), point, arm.torques[i]), move.displacement());
  });
}

PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  PoseNormal sum;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    sum.add(completePoseEquations(arm.geometry, arm.cases[i], tcp_in_flange, arm.torques[i]));
  }
  return sum;
}

}  // namespace stiffscope
