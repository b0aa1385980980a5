#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "core/calibration/fitted_day.h"

namespace stiffscope::calibration {

/// The best order of one joint: by how much sin and cos of it lower the sum of the squared whitened residuals.
struct PeriodicPeak {
  int joint = 0;
  double order = 0.0;  ///< periods a turn of the joint
  double gain = 0.0;
};

/// Least-squares periodogram of residuals over a joint's angle (P. Vanicek; N. R. Lomb 1976; J. D. Scargle 1982), for
/// every joint and orders 1 to 100: what a sin(k q_j) + b cos(k q_j) on joint j explains, with everything in an
/// orthonormal basis projected off both. Parts that are found later are projected off as they come, which costs two
/// products an order.
class Periodogram {
 public:
  static constexpr double kFirst = 1.0, kLast = 100.0, kStep = 0.25;
  static constexpr int kOrders = 397;         ///< (kLast - kFirst) / kStep + 1
  static constexpr int kTried = 6 * kOrders;  ///< for the probability of a false alarm

  /// `basis`: columns are orthonormal; `residual` is across them. Rows posture by posture as in `equations`.
  Periodogram(const std::vector<PostureEquations>& equations, const std::vector<std::size_t>& postures,
              const UnloadedDay& day, const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual);

  /// More orthonormal directions, and the residual's coefficients along them.
  void projectOff(const Eigen::MatrixXd& directions, const Eigen::VectorXd& coefficients);

  /// The best of each joint.
  std::vector<PeriodicPeak> peaks() const;

 private:
  struct OfJoint {
    std::shared_ptr<const Eigen::MatrixXd> waves;  ///< postures x 2 orders: sines, then cosines; copies share them
    Eigen::VectorXd right;                         ///< of each wave with the residual
    Eigen::ArrayXd ss, cc, sc;                     ///< products of sine and cosine of an order, across the basis
    Eigen::ArrayXd ss_all, cc_all;                 ///< before anything was projected off
  };

  /// Products of each wave with columns of rows, by the joint's own columns.
  Eigen::MatrixXd productsOf(std::size_t joint, const Eigen::MatrixXd& columns) const;
  void takeOff(std::size_t joint, const Eigen::MatrixXd& products);

  const std::vector<PostureEquations>* equations_;
  std::array<OfJoint, 6> joints_;
};

}  // namespace stiffscope::calibration
