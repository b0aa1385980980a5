#pragma once

#include <vector>

#include "core/identification/gear_states.h"

namespace stiffscope::identification {

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
