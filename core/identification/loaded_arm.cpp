#include "core/identification/loaded_arm.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/identification/complete_pose.h"
#include "core/identification/partial_pose.h"

namespace stiffscope {

namespace {

bool hasPose(const LoadCase& load_case) { return load_case.flange_unloaded && load_case.flange_loaded; }

/// Keeps the cases for which `has` holds, if most do: then it is those others that lack something, not the
/// campaign.
template <class Has>
void keepMost(const Campaign& campaign, const Has& has, const char* reason, std::vector<LoadCase>& cases,
              std::vector<std::string>* left_out) {
  const auto count = static_cast<std::size_t>(std::count_if(cases.begin(), cases.end(), has));
  if (count == cases.size() || 2 * count <= cases.size()) return;
  std::erase_if(cases, [&](const LoadCase& load_case) {
    if (has(load_case)) return false;
    if (left_out) {
      left_out->push_back(
          fmt::format("pose {}: {}", campaign.pose_ids[static_cast<std::size_t>(load_case.pose)], reason));
    }
    return true;
  });
}

/// Of all the steps, by pose. With several steps a case that cannot be used says of which step it is.
std::vector<LoadCase> casesOf(const Campaign& campaign, const LoadingGeometry& geometry, const std::vector<int>& steps,
                              std::vector<std::string>* left_out) {
  std::vector<LoadCase> cases;
  for (const int step : steps) {
    std::vector<std::string> lacking;
    for (LoadCase& one : loadCases(campaign, geometry, step, &lacking)) cases.push_back(std::move(one));
    for (const std::string& reason : lacking) {
      if (left_out) left_out->push_back(steps.size() == 1 ? reason : fmt::format("{} (step {})", reason, step));
    }
  }
  if (steps.size() > 1) {
    std::stable_sort(cases.begin(), cases.end(), [](const LoadCase& a, const LoadCase& b) { return a.pose < b.pose; });
  }
  return cases;
}

}  // namespace

bool LoadedArm::hasFlangePoses() const {
  return !cases.empty() && std::all_of(cases.begin(), cases.end(), hasPose);
}

LoadedArm loadedArm(const Campaign& campaign, const LoadingGeometry& geometry, const WristCentre& wrist,
                    const std::vector<int>& steps, std::vector<std::string>* left_out) {
  LoadedArm arm{geometry, casesOf(campaign, geometry, steps, left_out), {}, {}};
  keepMost(campaign, hasPose, "fewer than three reflectors read in both states", arm.cases, left_out);
  const auto moveOf = [&](const LoadCase& load_case) {
    return wristMove(load_case, wrist.radii, wrist.centre_at_zero_in_r0);
  };
  if (wrist.measured) {
    keepMost(
        campaign, [&](const LoadCase& load_case) { return moveOf(load_case).has_value(); },
        "no P_wrist from reflectors of known radius", arm.cases, left_out);
    for (const LoadCase& load_case : arm.cases) {
      const auto move = moveOf(load_case);
      if (!move) {
        arm.wrist.clear();
        break;
      }
      arm.wrist.push_back(*move);
    }
  }
  arm.torques = jointTorques(geometry, arm.cases);
  return arm;
}

std::vector<CaseEquations> reflectorEquations(const LoadedArm& arm) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    equations.push_back(partialPoseEquations(arm.geometry, arm.cases[i], arm.torques[i]));
  }
  return equations;
}

std::vector<CaseEquations> wristPointEquations(const LoadedArm& arm) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < arm.wrist.size(); ++i) {
    equations.push_back(wristEquations(arm.geometry, arm.cases[i], arm.wrist[i], arm.torques[i]));
  }
  return equations;
}

std::vector<CaseEquations> poseEquations(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    equations.push_back(completePoseEquations(arm.geometry, arm.cases[i], tcp_in_flange, arm.torques[i]));
  }
  return equations;
}

}  // namespace stiffscope
