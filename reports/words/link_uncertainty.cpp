#include "reports/words/link_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiffscope::reports {

namespace {

using calibration::LinkParameters;

constexpr Eigen::Index kOfLink = 5;

/// Angles first: of them a full turn is no difference.
Eigen::Matrix<double, kOfLink, 1> numbersOf(const LinkParameters& link) {
  return {link.theta, link.alpha, link.beta, link.d, link.a};
}

Eigen::VectorXd numbersOf(const calibration::ArmFit& fit, const robot::Robot& nominal) {
  const calibration::DenavitHartenberg parameters = calibration::denavitHartenberg(fit.arm(nominal), nominal);
  Eigen::VectorXd numbers(kOfLink * static_cast<Eigen::Index>(parameters.links.size()));
  for (std::size_t i = 0; i < parameters.links.size(); ++i)
    numbers.segment<kOfLink>(kOfLink * static_cast<Eigen::Index>(i)) = numbersOf(parameters.links[i]);
  return numbers;
}

}  // namespace

PerJoint<LinkParameters> linkUncertainties(const calibration::ArmFit& fit, const robot::Robot& nominal) {
  constexpr Eigen::Index kAngles = 3;
  const Eigen::VectorXd middle = numbersOf(fit, nominal);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(middle.size(), static_cast<Eigen::Index>(fit.free.size()));
  for (std::size_t k = 0; k < fit.free.size(); ++k) {
    const int at = fit.free[k];
    const double step = fit.sd(at);
    if (at >= fit.steps.size() || !(step > 0.0)) continue;
    calibration::ArmFit low = fit, high = fit;
    low.steps[at] -= step;
    high.steps[at] += step;
    Eigen::VectorXd change = numbersOf(high, nominal) - numbersOf(low, nominal);
    for (Eigen::Index i = 0; i < change.size(); ++i)
      if (i % kOfLink < kAngles) change[i] = std::remainder(change[i], 2.0 * std::numbers::pi);
    slopes.col(static_cast<Eigen::Index>(k)) = change / (2.0 * step);
  }
  const Eigen::MatrixXd covariance = slopes * fit.covariance * slopes.transpose();
  PerJoint<LinkParameters> links(static_cast<std::size_t>(middle.size() / kOfLink));
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto sd = [&](Eigen::Index k) {
      const Eigen::Index at = kOfLink * static_cast<Eigen::Index>(i) + k;
      return std::sqrt(std::max(0.0, covariance(at, at)));
    };
    links[i].theta = sd(0), links[i].alpha = sd(1), links[i].beta = sd(2), links[i].d = sd(3), links[i].a = sd(4);
  }
  return links;
}

}  // namespace stiffscope::reports
