#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/comparison/geometry_numbers.h"
#include "core/comparison/paired_fit.h"

namespace stiffscope::comparison {

enum class ChangeCause { joint_zero, link, axis, growth, reflectors, turn_about_last };

/// One cause that could have made all of the change, fitted alone by its own unknowns.
struct CauseEvidence {
  ChangeCause cause = {};
  int axis = 0;         ///< of axis, joint_zero and turn_about_last; link `axis` is between axes `axis` and axis + 1
  int joint = 0;        ///< of joint_zero and turn_about_last, from 1; 0: no joint has this axis for its own
  int same_line = 0;    ///< of joint_zero: the axis on the same line, which another joint turns; 0: none
  int unknowns = 0;     ///< directions of it that the days see
  double chi2 = 0.0;    ///< of the change that it explains
  double left_p = 0.0;  ///< probability that chance leaves as much as is left
  double bic = 0.0;     ///< chi2 left + unknowns ln(postures): the lowest is the best
  std::optional<Uncertain> size = {};  ///< of a cause with one unknown: rad; of growth m/m
  double at_targets = 0.0;             ///< rms of the 3-D position by it, m; 0 of reflectors
};

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

/// Causes by reflectors that moved: all turned about the last axis of `axes` together (`by_turn`, m/rad), which its
/// joint's zero does too, or each by itself. Best first.
std::vector<CauseEvidence> causesOfReflectors(const Eigen::VectorXd& by_turn, const robot::ArmAxes& axes,
                                              const FoundChange& found);

}  // namespace stiffscope::comparison
