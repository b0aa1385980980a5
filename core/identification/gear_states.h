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
  std::vector<JointVector> torques;
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
  std::vector<JointVector> torquesIn(const frames::LoadingGeometry& geometry, std::vector<LoadCase>& cases,
                                     const JointVector& compliance) const;

  WeightTorques weightTorques(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases) const;

  /// Of those that have both angles of the joint.
  JointStates statesOf(int joint, const std::vector<JointVector>& torques, const WeightTorques& weight) const;

 private:
  const campaign::Campaign& campaign_;
  std::vector<const campaign::State*> states_;  ///< by pose and step
};

// The line of a gear's wind-up over its torque, posture by posture: see transmission.h for the equation. Units rad, Nm.

/// Marks the states that disagree with the line of the others: a first slope is the weighted median over pairs of
/// states (Theil 1950; Sen 1968), which single wrong readings do not move.
void leaveOutWrongReadings(JointStates& joint);

/// The used entries of a column less their mean in each posture; others zero.
std::vector<double> withinPostures(const JointStates& joint, const std::vector<double>& column);

double dot(const std::vector<double>& a, const std::vector<double>& b);

/// a less its part along b.
std::vector<double> acrossOf(std::vector<double> a, const std::vector<double>& b);

/// Columns of a joint's least squares after postures' levels are taken off. With a lost motion its column is taken off
/// too: what is left of the others gives the same slope (Frisch, Waugh and Lovell).
struct JointColumns {
  std::vector<double> torque, windup, reported;
  std::vector<double> side;  ///< empty: no lost motion is fitted
};

JointColumns columnsOf(const JointStates& joint);

/// Slope of least squares of `values` over `column` with its standard deviation by the scatter between postures.
struct Slope {
  double value = 0.0, sd = 0.0;
};

Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values,
              const std::vector<double>& residual);
Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values);

std::vector<double> residualOf(const std::vector<double>& values, const std::vector<double>& column, double slope);

}  // namespace stiffscope::identification
