#pragma once

#include <functional>
#include <string>
#include <vector>
#include "core/campaign/campaign.h"
#include "tests/core/chain_arm.h"

namespace stiffscope {

/// A day in a laboratory, noise free, made with the tests' own kinematics and statics: an arm that is not
/// quite the nominal one, joint springs that give under its own weight and under loads, a tracker somewhere.
struct SimulatedLab {
  ChainArm nominal = exampleChain();
  ChainArm actual = exampleChain();
  Eigen::Isometry3d tracker_from_base = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets_in_flange{{0.28, 0.05, 0.12}, {-0.17, 0.27, 0.08}, {-0.1, -0.3, 0.21}};
  Eigen::Vector3d hook_in_flange{0.05, -0.1, 0.4};
  Eigen::Isometry3d flange_from_cell = Eigen::Isometry3d::Identity();
  Vector6d compliance = Vector6d::Zero();

  SimulatedLab() {
    tracker_from_base.linear() =
        (Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    tracker_from_base.translation() << 3.1, -1.2, -0.7;
    flange_from_cell.translation() << 0.0, 0.0, 0.09;
    flange_from_cell.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  }

  void withoutMasses() { nominal.mass.fill(0.0), actual.mass.fill(0.0); }

  /// Joint angles of equilibrium under own weight and a dead force at the hook: springs and loads on the
  /// moved arm.
  Vector6d settled(const Vector6d& q, const Eigen::Vector3d& force) const {
    Vector6d at = q;
    for (int i = 0; i < 40; ++i) {  // contracts a hundredfold a turn
      at = q + compliance.cwiseProduct(actual.weightTorque(at) +
                                       actual.torqueOf(at, 6, actual.flangeAt(at) * hook_in_flange, force,
                                                       Eigen::Vector3d::Zero()));
    }
    return at;
  }
  Vector6d settled(const Vector6d& q) const { return settled(q, Eigen::Vector3d::Zero()); }

  Eigen::Vector3d seen(const Vector6d& settled_q, std::size_t target) const {
    return tracker_from_base * (actual.flangeAt(settled_q) * targets_in_flange[target]);
  }

  /// What the load cell reads: the dead force at the hook, about the cell's point, in the cell's axes as they
  /// stand.
  Vector6d cellReading(const Vector6d& settled_q, const Eigen::Vector3d& force) const {
    const Eigen::Isometry3d flange = actual.flangeAt(settled_q), cell = flange * flange_from_cell;
    const Eigen::Vector3d moment = (flange * hook_in_flange - cell.translation()).cross(force);
    return (Vector6d() << cell.linear().transpose() * force, cell.linear().transpose() * moment).finished();
  }

  campaign::Campaign empty() const {
    campaign::Campaign campaign;
    campaign.name = "simulated";
    campaign.robot = nominal.robot();
    campaign.base_link = "base_link";
    campaign.flange_link = "tool0";
    for (std::size_t k = 0; k < targets_in_flange.size(); ++k)
      campaign.targets.push_back({"P1" + std::to_string(k), {}});
    campaign.load_cell = campaign::LoadCell{"tool0", flange_from_cell, {}, 0.0, 0.0};
    return campaign;
  }

  void addCircleSweeps(campaign::Campaign& campaign) const {
    // Axis 1 with the arm at zero; the others as a lab has the arm, axis 1 turned to face the tracker.
    campaign.circle_sweeps = campaign::CircleSweeps{"circle_sweeps.csv", campaign::PointFrame::tracker, {}};
    constexpr int kStops = 9;
    for (int axis = 0; axis < 6; ++axis) {
      const Vector6d start =
          axis == 0 ? Vector6d(Vector6d::Zero()) : degrees(-14, axis > 2 ? 8 : 0, 0, 0, 0, 0);
      for (int stop = 0; stop < kStops; ++stop) {
        Vector6d q = start;
        q[axis] += radians(-45.0 + 90.0 * stop / (kStops - 1));
        for (std::size_t k = 0; k < targets_in_flange.size(); ++k) {
          campaign.circle_sweeps->rows.push_back(
              {axis, std::to_string(stop), static_cast<int>(k), q, seen(settled(q), k)});
        }
      }
    }
  }

  void addWristSweep(campaign::Campaign& campaign) const {
    campaign.wrist_sweep = campaign::WristSweep{"wrist_sweep.csv", campaign::PointFrame::tracker, {}};
    Noise noise(5);
    for (int i = 0; i < 30; ++i) {
      const Vector6d q = degrees(10, 5, -8, 120 * (2 * noise.uniform() - 1), 80 * (2 * noise.uniform() - 1),
                                 120 * (2 * noise.uniform() - 1));
      for (std::size_t k = 0; k < targets_in_flange.size(); ++k) {
        campaign.wrist_sweep->rows.push_back(
            {std::to_string(i), static_cast<int>(k), q, seen(settled(q), k)});
      }
    }
  }

  /// Loads every posture by `force`, in the base's axes.
  void addLoading(campaign::Campaign& campaign, int postures, const std::function<Eigen::Vector3d(int)>& force) const {
    campaign.loading = campaign::Loading{"loading.csv", campaign::PointFrame::tracker, {}};
    campaign.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
    Noise noise(21);
    for (int pose = 0; pose < postures; ++pose) {
      campaign.pose_ids.push_back(std::to_string(pose + 1));
      const Vector6d q = somePosture(noise);
      const Vector6d unloaded = settled(q), loaded = settled(q, force(pose));
      campaign.states->rows.push_back({pose, 0, 0.0, q, Vector6d::Zero()});
      campaign.states->rows.push_back({pose, 1, 0.0, q, cellReading(loaded, force(pose))});
      for (std::size_t k = 0; k < targets_in_flange.size(); ++k) {
        const int target = static_cast<int>(k);
        campaign.loading->rows.push_back({pose, 0, "1", target, 0.0, seen(unloaded, k)});
        campaign.loading->rows.push_back({pose, 1, "1", target, 0.0, seen(loaded, k)});
      }
    }
  }
};

inline Eigen::Vector3d hangingForce(int) { return {0, 0, -1500}; }

/// Pulled sideways too, another way in every posture.
inline Eigen::Vector3d pulledForce(int pose) {
  const double angle = 2.4 * pose;
  return {900 * std::cos(angle), 900 * std::sin(angle), -800};
}

}  // namespace stiffscope
