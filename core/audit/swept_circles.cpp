#include "core/audit/swept_circles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiffscope {

namespace {

/// Larger standard deviation of (cos, sin) coefficients, the constant to be found too, noise one.
double largestSd(double arc, int readings) {
  Eigen::MatrixXd design(readings, 3);
  for (int i = 0; i < readings; ++i) {
    const double at = arc * (static_cast<double>(i) / (readings - 1) - 0.5);
    design.row(i) << std::cos(at), std::sin(at), 1.0;
  }
  const Eigen::Matrix3d covariance = (design.transpose() * design).inverse();
  const Eigen::Matrix2d block = covariance.topLeftCorner<2, 2>();
  return std::sqrt(block.selfadjointView<Eigen::Lower>().eigenvalues()[1]);
}

}  // namespace

std::array<std::vector<SweptCircle>, 6> sweptCircles(const Evidence& evidence) {
  std::array<std::vector<SweptCircle>, 6> axes;
  if (!evidence.campaign.circle_sweeps) return axes;
  const auto& rows = evidence.campaign.circle_sweeps->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<SweptCircle>& circles = axes[static_cast<std::size_t>(rows[i].axis)];
    auto circle = std::find_if(circles.begin(), circles.end(),
                               [&](const SweptCircle& one) { return one.target == rows[i].target; });
    if (circle == circles.end()) circle = circles.insert(circles.end(), {rows[i].target, {}, {}});
    circle->readings.points.push_back(evidence.rigid.circle_sweeps[i]);
    if (evidence.noise) circle->readings.covariances.push_back(evidence.noise->covarianceAt(rows[i].point));
    circle->lines.push_back(rows[i].line);
  }
  return axes;
}

AxisUncertainty uncertaintyOf(const AxisFit& fit) {
  const auto larger = [](const Eigen::Matrix2d& covariance) {
    return std::sqrt(std::max(0.0, covariance.selfadjointView<Eigen::Lower>().eigenvalues()[1]));
  };
  // The fit's parameters are taken at axis.line.point; the circles' middle is where the place is known best.
  double middle = 0.0;
  for (const AxisCircle& circle : fit.circles)
    middle += circle.height / static_cast<double>(fit.circles.size());
  Eigen::Matrix<double, 2, 4> shift;
  shift << Eigen::Matrix2d::Identity(), middle * Eigen::Matrix2d::Identity();
  return {larger(fit.axis.covariance.bottomRightCorner<2, 2>()),
          larger(shift * fit.axis.covariance * shift.transpose())};
}

double arcCost(double arc, int readings) {
  constexpr int kLeast = 4;  // three readings make a circle without a residual: nothing to compare
  const int count = std::max(kLeast, readings);
  return largestSd(arc, count) / largestSd(0.5 * std::numbers::pi, count);
}

}  // namespace stiffscope
