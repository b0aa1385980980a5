#pragma once

#include <cstddef>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// Of a posture's states only these have both angles of the joint.
struct JointStates {
  std::vector<std::size_t> state;                      ///< places among all states
  std::vector<double> torque, windup, reported, side;  ///< tau, q - m, q, sign(T)/2; one a state
  std::vector<std::size_t> posture_end;                ///< a posture's states stand together and end before this
  std::vector<bool> used;

  std::size_t size() const { return state.size(); }

  /// Calls work(from, to) for each posture.
  template <class Work>
  void byPosture(const Work& work) const {
    std::size_t from = 0;
    for (const std::size_t to : posture_end) work(from, to), from = to;
  }
};

/// Torques of the own weight, by state; zero where masses are not known, and then nobody knows which sign the torque of
/// load and weight together has.
struct WeightTorques {
  bool known = false;
  std::vector<Vector6d> torques;
};

/// The load states of a day with motor-side angles, and the torques on the gears in them. See transmission.h.
class EncoderDay {
 public:
  explicit EncoderDay(const campaign::Campaign& campaign);

  const std::vector<const campaign::State*>& states() const { return states_; }

  /// A case each state, in their order. An unloaded one has the wrench zero by the format, whatever the tared cell
  /// shows.
  std::vector<LoadCase> casesIn(const frames::LoadingGeometry& geometry) const;

  /// Torques of the load in those cases. `compliance`: K_c, and how the load cell turns with the arm, are of it.
  std::vector<Vector6d> torquesIn(const frames::LoadingGeometry& geometry, std::vector<LoadCase>& cases,
                                  const Vector6d& compliance) const;

  WeightTorques weightTorques(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases) const;

  /// Of those that have both angles of the joint.
  JointStates statesOf(int joint, const std::vector<Vector6d>& torques, const WeightTorques& weight) const;

 private:
  const campaign::Campaign& campaign_;
  std::vector<const campaign::State*> states_;  ///< by pose and step
};

}  // namespace stiffscope::identification
