#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/compensation/elastic_arm.h"

namespace stiffscope {

/// base_from_flange at rest with these joint commands under the load (one without force: the own weight alone). Empty where
/// the arm does not come to rest.
using RestingFlange = std::function<std::optional<Eigen::Isometry3d>(const Vector6d& commands, const FlangeLoad& load)>;

/// An arm that gives at more than its joint springs.
struct FurtherGive {
  RestingFlange flange;
  Matrix6d spring_covariance = Matrix6d::Zero();  ///< of the joint compliances, what gives besides taken as known
  /// The arm moved by one standard deviation along each independent direction of what else is uncertain, joint springs
  /// following: what such a move changes in a result is a standard uncertainty of it.
  std::vector<RestingFlange> varied;
};

}  // namespace stiffscope
