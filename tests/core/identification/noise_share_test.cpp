#include "core/identification/noise_share.h"

#include <gtest/gtest.h>

#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace noise_share_test {

TEST(NoiseShare, AgreesWithMonteCarlo) {
  // The same tracker noise drawn many times: what it puts into the norm of displacements, at reflectors and
  // at P_wrist.
  LinearMachine machine(6, 1.0);
  machine.geometry.r0_from_loading = Eigen::Isometry3d::Identity();
  campaign::Campaign campaign;
  campaign.tracker = campaign::Tracker{"", 4e-6, 0.6e-6, 6e-6, 2.2e-6, {4.0, -2.0, 0.5}};
  std::vector<identification::WristMove> moves;
  for (identification::LoadCase& one : machine.cases) {
    for (identification::TargetMove& move : one.targets) move.unloaded_readings = 1, move.loaded_readings = 3;
    moves.push_back(machine.wristMoveOf(one));
  }
  const auto stated = identification::noiseShare(campaign, machine.geometry, machine.cases, moves, machine.radii,
                                                 machine.wrist_at_zero);
  ASSERT_TRUE(stated);

  Noise noise(6);
  constexpr int kDraws = 1500;
  double wrist_error = 0.0, wrist_whole = 0.0, target_error = 0.0, target_whole = 0.0;
  const auto drawAt = [&](const Eigen::Vector3d& point, int readings) {
    const Eigen::Vector3d sight = point - campaign.tracker->station;
    const double distance = sight.norm(), along = 4e-6 + 0.6e-6 * distance, across = 6e-6 + 2.2e-6 * distance;
    return Eigen::Vector3d(noise.draw(seenFromOrigin(sight, along, across)) / std::sqrt(readings));
  };
  for (int k = 0; k < kDraws; ++k) {
    for (std::size_t i = 0; i < machine.cases.size(); ++i) {
      identification::LoadCase noisy = machine.cases[i];
      for (identification::TargetMove& move : noisy.targets) {
        const Eigen::Vector3d clean = move.displacement();
        move.unloaded += drawAt(move.unloaded, 1);
        move.loaded += drawAt(move.loaded, 3);
        target_error += (move.displacement() - clean).norm();
        target_whole += clean.norm();
      }
      const identification::WristMove moved = machine.wristMoveOf(noisy);
      wrist_error += (moved.displacement() - moves[i].displacement()).norm();
      wrist_whole += moves[i].displacement().norm();
    }
  }
  // E|error| from the trace is exact for an isotropic error; a flat one, as a tracker's, is some per cent
  // less. For P_wrist the loaded and unloaded states are taken to magnify alike.
  EXPECT_NEAR(stated->at_targets, target_error / target_whole, 0.05 * stated->at_targets);
  EXPECT_NEAR(*stated->at_wrist, wrist_error / wrist_whole, 0.08 * *stated->at_wrist);
}

TEST(NoiseShare, NeedsATrackerAndAbsolutePoints) {
  LinearMachine machine(2, 1.0);
  machine.geometry.r0_from_loading = Eigen::Isometry3d::Identity();
  campaign::Campaign campaign;
  EXPECT_FALSE(
      identification::noiseShare(campaign, machine.geometry, machine.cases, {}, machine.radii, machine.wrist_at_zero));
  campaign.tracker = campaign::Tracker{};
  machine.cases.front().absolute = false;
  EXPECT_FALSE(
      identification::noiseShare(campaign, machine.geometry, machine.cases, {}, machine.radii, machine.wrist_at_zero));
}

}  // namespace noise_share_test
}  // namespace stiffscope
