#pragma once

#include <array>
#include <vector>

#include "core/calibration/calibrate.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {

/// An unloaded day of a chain arm, measured by the chain's own kinematics: the arm as built differs from the one that
/// the day's URDF would state.
struct UnloadedSpec {
  ChainArm nominal = exampleChain(), built = exampleChain();
  int postures = 60;
  double noise = 20e-6;  ///< m, each coordinate
  std::vector<Eigen::Vector3d> on_flange{{0.1, 0.05, 0.2}, {-0.12, 0.04, 0.15}, {0.03, -0.1, 0.25}};
  Eigen::Isometry3d tracker_from_base = Eigen::Translation3d(3.0, -1.0, 0.5) *
                                        Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
  /// What the joints turn beyond what is reported.
  std::function<Vector6d(const Vector6d& q)> joint_errors = [](const Vector6d&) { return Vector6d(Vector6d::Zero()); };
};

inline campaign::Campaign unloadedCampaign(const UnloadedSpec& spec, Noise& noise) {
  campaign::Campaign campaign;
  campaign.name = "unloaded";
  campaign.robot = spec.nominal.robot();
  campaign.base_link = "base_link";
  campaign.flange_link = "tool0";
  campaign.tracker = campaign::Tracker{"even", spec.noise, 0.0, spec.noise, 0.0, Eigen::Vector3d::Zero()};
  campaign.loading.emplace().file = "loading.csv";
  campaign.states.emplace().file = "states.csv";
  for (std::size_t t = 0; t < spec.on_flange.size(); ++t)
    campaign.targets.push_back({"P" + std::to_string(10 + t), std::nullopt});
  std::size_t line = 2;
  for (int i = 0; i < spec.postures; ++i) {
    campaign.pose_ids.push_back(std::to_string(i + 1));
    campaign::State state;
    state.pose = i;
    state.time_s = 30.0 * i;
    state.q = somePosture(noise);
    campaign.states->rows.push_back(state);
    const Eigen::Isometry3d flange = spec.built.flangeAt(state.q + spec.joint_errors(state.q));
    for (std::size_t t = 0; t < spec.on_flange.size(); ++t) {
      campaign::LoadingReading reading;
      reading.pose = i;
      reading.target = static_cast<int>(t);
      reading.point = spec.tracker_from_base * (flange * spec.on_flange[t]) + spec.noise * noise.normal3();
      reading.line = line++;
      campaign.loading->rows.push_back(reading);
    }
  }
  return campaign;
}

/// A machine as it is built: joint frames off by a millimetre and a third of a milliradian.
inline UnloadedSpec builtOtherwise(Noise& noise) {
  UnloadedSpec spec;
  spec.built = spec.nominal.disturbed(noise, 0.5e-3, 0.3e-3);
  return spec;
}

}  // namespace stiffscope
