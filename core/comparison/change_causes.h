#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/comparison/geometry_change.h"

namespace stiffscope::comparison {

/// A change that was found: its numbers, their covariance and the degrees of freedom of that.
struct FoundChange {
  Eigen::VectorXd change;
  Eigen::MatrixXd covariance;
  double dof = 1.0;
  double postures = 1.0;  ///< as many pieces of evidence, in Schwarz's criterion
};

/// Each single cause of a change of the machine's numbers `seen`, fitted alone: one joint's zero, one link bent, one
/// axis displaced between its neighbours, all lengths grown by a factor. `moves`: GeometryNumbers::movesOfReflectors of
/// these numbers. Best first.
std::vector<CauseEvidence> causesOfMachine(const GeometryNumbers& numbers, const robot::Robot& arm,
                                           const std::vector<Eigen::Index>& seen, const FoundChange& found,
                                           const Eigen::MatrixXd& moves);

/// Of reflectors that moved: all turned about axis 6 together (`by_turn`, m/rad), which joint 6's zero does too, or
/// each by itself. Best first.
std::vector<CauseEvidence> causesOfReflectors(const Eigen::VectorXd& by_turn, const FoundChange& found);

}  // namespace stiffscope::comparison
