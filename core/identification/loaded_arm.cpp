#include "core/identification/loaded_arm.h"

#include <algorithm>
#include <optional>

#include "core/identification/complete_pose.h"
#include "core/identification/partial_pose.h"
#include "core/identification/remarks.h"
#include "core/numerics/parallel.h"

namespace stiffscope::identification {

NormalEquations reflectorNormal(const LoadedArm& arm) {
  return numerics::sumInBlocks<NormalEquations>(arm.cases.size(), [&](std::size_t i, NormalEquations& sum) {
    const LoadCase& load_case = arm.cases[i];
    const robot::ArmAxes& axes = jacobianAxes(load_case);
    for (const TargetMove& move : load_case.targets) {
      const Eigen::Vector3d point = jacobianPoint(load_case, move.unloaded, move.loaded);
      sum.add(pointRows(axes, point, arm.torques[i]), move.displacement());
    }
  });
}

NormalEquations wristNormal(const LoadedArm& arm) {
  return numerics::sumInBlocks<NormalEquations>(arm.wrist.size(), [&](std::size_t i, NormalEquations& sum) {
    const WristMove& move = arm.wrist[i];
    const Eigen::Vector3d point = jacobianPoint(arm.cases[i], move.unloaded, move.loaded);
    sum.add(pointRows(jacobianAxes(arm.cases[i]), point, arm.torques[i]), move.displacement());
  });
}

PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  return numerics::sumInBlocks<PoseNormal>(arm.cases.size(), [&](std::size_t i, PoseNormal& sum) {
    sum.add(completePoseEquations(arm.cases[i], tcp_in_flange, arm.torques[i]));
  });
}

namespace {

bool hasPose(const LoadCase& load_case) { return load_case.flange_unloaded && load_case.flange_loaded; }

/// Keeps the cases that have something, if most do: then it is those others that lack it, not the campaign.
void keepMost(const campaign::Campaign& campaign, const std::vector<bool>& has, RemarkId reason,
              std::vector<LoadCase>& cases, std::vector<LeftOutPosture>* left_out) {
  const auto count = static_cast<std::size_t>(std::count(has.begin(), has.end(), true));
  if (count == cases.size() || 2 * count <= cases.size()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (has[i]) {
      if (kept != i) cases[kept] = std::move(cases[i]);
      ++kept;
    } else if (left_out) {
      left_out->push_back({campaign.pose_ids[static_cast<std::size_t>(cases[i].pose)], Remark(reason)});
    }
  }
  cases.resize(kept);
}

/// Of all the steps, by pose. With several steps a case that cannot be used says of which step it is.
std::vector<LoadCase> casesOf(const campaign::Campaign& campaign, const LoadReadings& readings,
                              const frames::LoadingGeometry& geometry, const std::vector<int>& steps,
                              std::vector<LeftOutPosture>* left_out) {
  if (steps.size() == 1) return loadCases(campaign, readings, geometry, steps.front(), left_out);
  std::vector<std::vector<LoadCase>> by_step;
  std::vector<LoadCase*> by_pose;  // a case is large, and moved once
  for (const int step : steps) {
    std::vector<LeftOutPosture> lacking;
    by_step.push_back(loadCases(campaign, readings, geometry, step, &lacking));
    for (LoadCase& one : by_step.back()) by_pose.push_back(&one);
    for (const LeftOutPosture& one : lacking) {
      if (left_out) left_out->push_back({one.pose, Remark(RemarkId::in_step, one.reason, step)});
    }
  }
  std::stable_sort(by_pose.begin(), by_pose.end(), [](const auto* a, const auto* b) { return a->pose < b->pose; });
  std::vector<LoadCase> cases;
  cases.reserve(by_pose.size());
  for (LoadCase* one : by_pose) cases.push_back(std::move(*one));
  return cases;
}

/// P_wrist in all the cases; those that do not give it are left out if most do, else there is none of any.
void addWristMoves(const campaign::Campaign& campaign, const frames::WristCentre& wrist,
                   std::vector<LeftOutPosture>* left_out, LoadedArm& arm) {
  if (arm.cases.empty() || !arm.cases.front().absolute) return;
  std::vector<std::optional<WristMove>> moves(arm.cases.size());
  const Eigen::Isometry3d flange_at_zero_inverse = arm.geometry.arm.base_from_flange_at_zero.inverse();
  numerics::smallWorkOnAllCores(arm.cases.size(), [&](std::size_t i) {
    // Which of two roots, one on each side of the reflectors: where the flange carries the wrist centre tells them
    // apart as well as the model, and is at hand.
    const LoadCase& one = arm.cases[i];
    const Eigen::Vector3d& centre = wrist.centre_at_zero_in_r0;
    const Eigen::Vector3d about = one.flange_unloaded
                                      ? Eigen::Vector3d(*one.flange_unloaded * (flange_at_zero_inverse * centre))
                                      : modelledWrist(arm.geometry.arm, one, centre);
    moves[i] = wristMove(one, wrist.radii, about);
  });
  std::vector<bool> has;
  for (const auto& move : moves) has.push_back(move.has_value());
  keepMost(campaign, has, RemarkId::no_wrist_point, arm.cases, left_out);
  std::erase_if(moves, [](const auto& move) { return !move; });
  if (moves.size() != arm.cases.size()) return;
  arm.wrist.reserve(moves.size());
  for (const auto& move : moves) arm.wrist.push_back(*move);
}

}  // namespace

bool LoadedArm::hasFlangePoses() const { return !cases.empty() && std::all_of(cases.begin(), cases.end(), hasPose); }

LoadedArm loadedArm(const campaign::Campaign& campaign, const LoadReadings& readings,
                    const frames::LoadingGeometry& geometry, const frames::WristCentre& wrist,
                    const std::vector<int>& steps, std::vector<LeftOutPosture>* left_out) {
  LoadedArm arm{geometry, casesOf(campaign, readings, geometry, steps, left_out), {}, {}};
  std::vector<bool> poses;
  for (const LoadCase& load_case : arm.cases) poses.push_back(hasPose(load_case));
  keepMost(campaign, poses, RemarkId::under_three_reflectors, arm.cases, left_out);
  if (wrist.measured) addWristMoves(campaign, wrist, left_out, arm);
  arm.torques = jointTorques(arm.cases);
  return arm;
}

LoadedArm loadedArm(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                    const frames::WristCentre& wrist, const std::vector<int>& steps,
                    std::vector<LeftOutPosture>* left_out) {
  return loadedArm(campaign, LoadReadings(campaign, steps), geometry, wrist, steps, left_out);
}

std::vector<CaseEquations> reflectorEquations(const LoadedArm& arm) {
  std::vector<CaseEquations> equations(arm.cases.size());
  numerics::smallWorkOnAllCores(
      arm.cases.size(), [&](std::size_t i) { equations[i] = partialPoseEquations(arm.cases[i], arm.torques[i]); });
  return equations;
}

std::vector<CaseEquations> wristPointEquations(const LoadedArm& arm) {
  std::vector<CaseEquations> equations(arm.wrist.size());
  numerics::smallWorkOnAllCores(arm.wrist.size(), [&](std::size_t i) {
    equations[i] = wristEquations(arm.cases[i], arm.wrist[i], arm.torques[i]);
  });
  return equations;
}

std::vector<CaseEquations> poseEquations(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  std::vector<CaseEquations> equations(arm.cases.size());
  numerics::smallWorkOnAllCores(arm.cases.size(), [&](std::size_t i) {
    equations[i] = completePoseEquations(arm.cases[i], tcp_in_flange, arm.torques[i]);
  });
  return equations;
}

}  // namespace stiffscope::identification
