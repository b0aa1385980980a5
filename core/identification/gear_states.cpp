#include "core/identification/gear_states.h"

#include <algorithm>
#include <cmath>

#include "core/identification/equations.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::identification {

EncoderDay::EncoderDay(const campaign::Campaign& campaign) : campaign_(campaign) {
  std::vector<std::vector<const campaign::State*>> by_pose(campaign.pose_ids.size());
  for (const campaign::State& row : campaign.states->rows) {
    if (row.hasExtras() && !row.extras().motor_side.array().isNaN().all())
      by_pose[static_cast<std::size_t>(row.pose)].push_back(&row);
  }
  for (auto& rows : by_pose) {
    std::sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->step < b->step; });
    states_.insert(states_.end(), rows.begin(), rows.end());
  }
}

std::vector<LoadCase> EncoderDay::casesIn(const frames::LoadingGeometry& geometry) const {
  std::vector<LoadCase> cases;
  const campaign::State* first = nullptr;
  for (const campaign::State* state : states_) {
    if (first == nullptr || first->pose != state->pose) first = state;
    cases.push_back(caseOfState(campaign_, geometry, *first, *state));
  }
  return cases;
}

std::vector<JointVector> EncoderDay::torquesIn(const frames::LoadingGeometry& geometry, std::vector<LoadCase>& cases,
                                               const JointVector& compliance) const {
  std::vector<JointVector> torques = jointTorques(cases);
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds && !compliance.isZero(0.0); ++round) {
    updateLoadedConfiguration(geometry, compliance, cases, torques);
  }
  return torques;
}

WeightTorques EncoderDay::weightTorques(const frames::LoadingGeometry& geometry,
                                        const std::vector<LoadCase>& cases) const {
  WeightTorques weight{geometry.weight.links_known,
                       std::vector<JointVector>(cases.size(), JointVector::Zero(geometry.arm.joints()))};
  for (std::size_t i = 0; weight.known && i < cases.size(); ++i) {
    weight.torques[i] = robot::weightTorque(geometry.arm, unloadedPosture(geometry.arm, cases[i]), geometry.weight);
  }
  return weight;
}

JointStates EncoderDay::statesOf(int joint, const std::vector<JointVector>& torques,
                                 const WeightTorques& weight) const {
  JointStates all;
  int pose = -1;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const campaign::State& row = *states_[i];
    if (std::isnan(row.extras().motor_side[joint])) continue;
    if (row.pose != pose && all.size() > 0) all.posture_end.push_back(all.size());
    pose = row.pose;
    all.state.push_back(i);
    const double reported = std::isnan(row.extras().link_side[joint]) ? row.q[joint] : row.extras().link_side[joint];
    const double torque = torques[i][joint];
    const double whole = weight.known ? torque + weight.torques[i][joint] : 0.0;
    all.torque.push_back(torque);
    all.windup.push_back(reported - row.extras().motor_side[joint]);
    all.reported.push_back(reported);
    all.side.push_back(whole > 0.0 ? 0.5 : whole < 0.0 ? -0.5 : 0.0);
  }
  if (all.size() > 0) all.posture_end.push_back(all.size());
  all.used.assign(all.size(), true);
  return all;
}

}  // namespace stiffscope::identification
