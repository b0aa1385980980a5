#pragma once

#include <random>
#include <vector>

#include "core/fleet/campaign_result.h"

namespace stiffscope::fleet {

/// A day with loads by Partial Pose whose joint 2 alone is seen, with these influences and this compliance. Units are
/// the test's own.
inline CampaignResult dayOf(const std::vector<double>& influences, double compliance) {
  CampaignResult day(6);
  day.audit = preparation::AuditVerdict::pass;
  day.method = day.springs_method = identification::Method::partial_pose;
  SpringsOfDay& springs = day.springs[static_cast<std::size_t>(identification::Method::partial_pose)];
  springs.available = true;
  springs.identifiable[1] = true;
  springs.compliance[1] = compliance;
  springs.dof.setConstant(static_cast<double>(influences.size()));
  for (std::size_t p = 0; p < influences.size(); ++p) {
    springs.influences.push_back(JointVector::Unit(6, 1) * influences[p]);
    day.loaded_postures.push_back({std::to_string(p), JointVector::Constant(6, 0.1 * static_cast<double>(p)),
                                   Eigen::Vector3d(0.0, 0.0, -1500.0)});
  }
  day.postures = static_cast<int>(influences.size());
  return day;
}

/// Days of one machine with compliance 100 and standard deviation 1, of which the influences of each day are an
/// estimate: normal numbers independent of the error, their squares summing to 1 on average.
inline std::vector<CampaignResult> unchangedDays(std::mt19937_64& draws, std::size_t count, std::size_t postures) {
  std::normal_distribution<double> normal;
  std::vector<CampaignResult> days;
  for (std::size_t t = 0; t < count; ++t) {
    std::vector<double> influences(postures);
    for (double& one : influences) one = normal(draws) / std::sqrt(static_cast<double>(postures));
    days.push_back(dayOf(influences, 100.0 + normal(draws)));
  }
  return days;
}

}  // namespace stiffscope::fleet
