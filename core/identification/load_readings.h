#pragma once

#include <span>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

/// Readings of one reflector in one state.
struct ReadingSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< in the table's frame, m
  int readings = 0;

  Eigen::Vector3d mean() const { return sum / readings; }
};

/// What the tables say of some load steps, posture by posture: all of a load case that does not depend on the geometry, so
/// that it is gathered once for the many geometries in which an uncertainty asks. Refers to rows of the campaign, which
/// must stay.
class LoadReadings {
 public:
  LoadReadings(const Campaign& campaign, std::vector<int> steps);

  const std::vector<int>& steps() const { return steps_; }
  std::size_t poses() const { return poses_; }

  /// Of one of the steps, or of 0; null where the posture has none.
  const State* state(std::size_t pose, int step) const { return states_[at(pose, step)]; }
  /// Of `loading` in that state, by target; empty without the table.
  std::span<const ReadingSum> points(std::size_t pose, int step) const { return of(points_, pose, step); }
  /// Of `displacements` to that step, by target; empty without the table.
  std::span<const ReadingSum> differences(std::size_t pose, int step) const { return of(differences_, pose, step); }

 private:
  /// Place of a step among 0 and the steps; past them where it is none of these.
  std::size_t slot(int step) const;
  std::size_t at(std::size_t pose, int step) const { return slot(step) * poses_ + pose; }
  std::span<const ReadingSum> of(const std::vector<ReadingSum>& table, std::size_t pose, int step) const;

  std::vector<int> steps_;
  std::size_t poses_, targets_;
  std::vector<const State*> states_;  // by slot, then pose
  std::vector<ReadingSum> points_, differences_;  // by slot, then pose, then target
};

}  // namespace stiffscope
